//! The angle of a direction, by a table and a series: no mathematical library, so no assumption on one, and the same bits everywhere.
//!
//! For 0 ≤ t ≤ 1 and c the multiple of 1/64 nearest to t, arctan t = arctan c + arctan s with s = (t − c)/(1 + tc), and |s| ≤ 1/128.

use walpha_regular::internals::Twofold;
use walpha_regular::internals::number::Number;

const fn twofold(high: f64, low: f64) -> Twofold {
    Twofold { high, low }
}

pub(super) const PI: Twofold = twofold(std::f64::consts::PI, 1.2246467991473532e-16);
const HALF_PI: Twofold = twofold(std::f64::consts::FRAC_PI_2, 6.123233995736766e-17);

/// Relative error of [`of`]: 2⁻⁴⁹, where u = 2⁻⁵³ is the unit of rounding. The quotient t errs by u. Of s, the difference is exact
/// (Sterbenz; c is 0, or within a factor of two of t), and the other three operations err by u each, relative to |s|, which is no more than the angle. The
/// terms that the series leaves out are below s⁹/9 < 2⁻⁵⁹ |s|, and those after the first err by less than u |s|. The table errs by less
/// than u/2 and the sum by u, each relative to the angle. So does the difference from π/2 or π, twice, and it is no less than π/4.
/// Together less than 12 u.
pub(super) const ROUNDING: f64 = 16.0 * (f64::EPSILON / 2.0);

/// Relative error of [`of_twofold`]: 2⁻⁹⁴. As above, with 2⁻⁹⁸ for quotients and 2⁻¹⁰³ for sums and products; the terms that the series leaves
/// out are below s¹⁵/15 < 2⁻¹⁰¹ |s|.
pub(super) const ROUNDING_OF_TWOFOLD: f64 = 1.0 / (1u128 << 94) as f64;

/// The arctangent of y/x for y ≥ 0, in the range from 0 to π. Not both are 0.
#[inline(always)]
pub(super) fn of(y: f64, x: f64) -> f64 {
    let width = x.abs();
    let steep = y > width;
    let (less, more) = if steep { (width, y) } else { (y, width) };
    let t = less / more;
    let row = (t * 64.0 + 0.5) as usize;
    let c = row as f64 * (1.0 / 64.0);
    let s = (t - c) / (1.0 + t * c);
    let q = s * s;
    let rest = s * q * (-1.0 / 3.0 + q * (1.0 / 5.0 - q * (1.0 / 7.0)));
    let part = TABLE[row.min(64)];
    let angle = part.high + (s + (part.low + rest));
    let angle = if steep { (HALF_PI.high - angle) + HALF_PI.low } else { angle };
    if x < 0.0 { (PI.high - angle) + PI.low } else { angle }
}

/// [`of`] for numbers of two doubles.
pub(super) fn of_twofold(y: Twofold, x: Twofold) -> Twofold {
    let minus = |number: Twofold| twofold(-number.high, -number.low);
    let width = if x.high < 0.0 { minus(x) } else { x };
    let steep = y.high > width.high;
    let t = if steep { width.over(y) } else { y.over(width) };
    let row = ((t.high.clamp(0.0, 1.0) * 64.0 + 0.5) as usize).min(64);
    let c = twofold(row as f64 * (1.0 / 64.0), 0.0);
    let one = twofold(1.0, 0.0);
    let s = t.minus(&c).over(one.plus(&t.times(&c)));
    let q = minus(s.times(&s));
    // 1 − s²/3 + s⁴/5 − …, from the last term, s¹²/13.
    let mut series = one.over(twofold(13.0, 0.0));
    for odd in [11.0, 9.0, 7.0, 5.0, 3.0, 1.0] {
        series = one.over(twofold(odd, 0.0)).plus(&q.times(&series));
    }
    let angle = TABLE[row].plus(&s.times(&series));
    let angle = if steep { HALF_PI.minus(&angle) } else { angle };
    if x.high < 0.0 { PI.minus(&angle) } else { angle }
}

/// The arctangents of k/64, each as a sum of two doubles.
const TABLE: [Twofold; 65] = [
    twofold(0.0, 0.0),
    twofold(0.015623728620476831, -4.913600136566304e-19),
    twofold(0.031239833430268277, -1.188442711587748e-18),
    twofold(0.046840712915969654, -1.655677442254952e-19),
    twofold(0.06241880999595735, -1.5490756308295046e-18),
    twofold(0.0779666338315423, 5.804551873143357e-18),
    twofold(0.09347678115858947, -6.2844725995420954e-18),
    twofold(0.10894195698986579, 6.8267122072409585e-18),
    twofold(0.12435499454676144, -3.1253241424539383e-18),
    twofold(0.13970887428916365, -2.9579864247315813e-18),
    twofold(0.15499674192394097, 9.585415594114324e-18),
    twofold(0.1702119252854744, -3.541164079802125e-18),
    twofold(0.18534794999569476, 4.180692268843079e-18),
    twofold(0.2003985538258785, 3.1399542871844493e-18),
    twofold(0.21535769969773805, 4.738160130078733e-19),
    twofold(0.23021958727684372, 1.2313404529142703e-17),
    twofold(0.24497866312686414, 1.0698755618734451e-17),
    twofold(0.2596296294082575, 1.9238754924615304e-17),
    twofold(0.2741674511196588, 8.261353575163773e-18),
    twofold(0.2885873618940774, -1.428369957377257e-17),
    twofold(0.3028848683749714, -1.1010827903001369e-17),
    twofold(0.31705575320914703, -1.893928924292642e-17),
    twofold(0.3310960767041321, -7.952610375793799e-18),
    twofold(0.34500217720710513, -2.2938804755578304e-17),
    twofold(0.35877067027057225, -2.4623815582638635e-17),
    twofold(0.3723984466767542, 1.9612311504845653e-17),
    twofold(0.38588266939807375, 2.378822732491941e-17),
    twofold(0.39922076957525254, 2.246598105617042e-17),
    twofold(0.4124104415973873, -1.587652227770689e-17),
    twofold(0.42544963737004227, 2.3315530741892885e-17),
    twofold(0.43833655985795783, -2.494277030626541e-17),
    twofold(0.4510696559885235, -2.2703795229420475e-17),
    twofold(0.4636476090008061, 2.2698777452961687e-17),
    twofold(0.4760693303227612, 1.4654487332256713e-17),
    twofold(0.48833395105640554, -1.1373236189329585e-17),
    twofold(0.5004408131472942, -4.7181675085518756e-17),
    twofold(0.5123894603107377, -2.5462781472855804e-17),
    twofold(0.5241796287829132, 5.520094119641666e-18),
    twofold(0.5358112379604637, -4.0637956834825575e-18),
    twofold(0.5472843809874369, 4.923709671396255e-17),
    twofold(0.5585993153435624, -5.4556305485916264e-18),
    twofold(0.5697564534829784, 1.2255062085054184e-17),
    twofold(0.5807563535676704, -1.441464378193067e-17),
    twofold(0.5915997103351114, 4.920495453686772e-17),
    twofold(0.6022873461349642, 2.950430737228402e-17),
    twofold(0.6128202021652414, -3.1552061848586226e-17),
    twofold(0.6231993299340659, 2.672403885140095e-17),
    twofold(0.6334258829691446, -2.7290767436015276e-17),
    twofold(0.6435011087932844, 1.5834785051444286e-17),
    twofold(0.6534263411807619, 3.5800634857340095e-17),
    twofold(0.6632029927060933, -3.076054864429649e-17),
    twofold(0.6728325475937632, -1.899315009714705e-17),
    twofold(0.6823165548747481, 6.943223671560008e-18),
    twofold(0.6916566218531999, -8.117151192285796e-18),
    twofold(0.7008544078844502, -1.987626234335816e-17),
    twofold(0.7099116184635249, -4.597166450584887e-17),
    twofold(0.7188299996216245, -2.1478388444456983e-17),
    twofold(0.7276113326265107, 2.569325697391839e-18),
    twofold(0.7362574289814281, 3.473937648299457e-17),
    twofold(0.7447701257160751, 3.708315849135547e-17),
    twofold(0.7531512809621944, -2.4256934659182068e-17),
    twofold(0.7614027698055784, 9.850030332752822e-18),
    twofold(0.7695264804056583, -3.704991905602721e-17),
    twofold(0.7775243103733478, -2.6676490951944502e-17),
    twofold(std::f64::consts::FRAC_PI_4, 3.061616997868383e-17),
];
