//! The pores between the balls of a periodic box.

use walpha_shape::ladder::{Filtration, PoreSphere, Pores};
use walpha_shape::{Alpha, Torus, WeightedPoints};

use crate::{BallUnion, BallsError, Bounded};

/// Balls in a box that repeats along all three vectors, between which spheres and channels are looked for.
///
/// ```
/// use walpha_balls::PeriodicBalls;
/// use walpha_shape::Torus;
///
/// // One ball in a cube: from window to window of its lattice a sphere of diameter √2 − 0.6 can pass.
/// let balls = PeriodicBalls::new(Torus::new([1.0; 3])?, vec![[0.0; 3]], vec![0.3])?;
/// let pores = balls.pores()?;
/// assert!((pores.included.diameter - (3f64.sqrt() - 0.6)).abs() < 1e-15);
/// assert!((pores.free.diameter - (2f64.sqrt() - 0.6)).abs() < 1e-15);
/// let probed = balls.probed(0.2)?;
/// assert_eq!((probed.channels, probed.pockets), (vec![3], 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PeriodicBalls {
    torus: Torus,
    positions: Vec<[f64; 3]>,
    radii: Vec<f64>,
    /// The radius of all of them, if they have the same.
    common: Option<f64>,
}

/// A sphere that touches balls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeSphere {
    /// Its diameter; negative where the balls leave no way, down to twice the smallest radius where they leave none if all are smaller by that.
    pub diameter: f64,
    /// Its centre, in the box.
    pub center: [f64; 3],
}

/// The largest spheres between balls.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BallPores {
    /// The largest that fits.
    pub included: FreeSphere,
    /// The largest that can move to another copy of its place: the narrowest place on its way.
    pub free: FreeSphere,
    /// The same along each vector of the box.
    pub free_along: [FreeSphere; 3],
    /// The largest on the way of the free one.
    pub included_along_free: FreeSphere,
}

/// What the centre of a probe can reach between balls.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ProbedPores {
    /// In how many independent directions each channel winds round the box.
    pub channels: Vec<usize>,
    /// The number of parts without a way out.
    pub pockets: usize,
    /// The share of the box in which the centre of the probe can be, of channels and pockets together.
    pub void_fraction: Bounded,
}

/// A filtration, and the α at which its balls are those that were asked for.
struct Frame {
    filtration: Filtration,
    alpha: Alpha,
}

impl PeriodicBalls {
    /// Balls by their centres and radii.
    ///
    /// # Errors
    /// [`BallsError::Slab`] for a box that does not repeat along all three vectors; [`BallsError::Radius`]; other numbers of radii than of centres.
    pub fn new(
        torus: Torus,
        positions: Vec<[f64; 3]>,
        radii: Vec<f64>,
    ) -> Result<Self, BallsError> {
        let is_length = |radius: &f64| *radius >= 0.0 && radius.powi(2).is_finite();
        if let Some(row) = radii.iter().position(|radius| !is_length(radius)) {
            return Err(BallsError::Radius { row, radius: radii[row] });
        }
        if radii.len() != positions.len() {
            let (weights, points) = (radii.len(), positions.len());
            return Err(BallsError::Weights { weights, points });
        }
        if torus.dimension() < 3 {
            return Err(BallsError::Slab);
        }
        let first = radii.first().copied();
        let common = first.filter(|first| radii.iter().all(|radius| radius == first));
        Ok(Self { torus, positions, radii, common })
    }

    /// The box.
    pub fn torus(&self) -> Torus {
        self.torus
    }

    /// The radii.
    pub fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// The largest spheres between the balls. O(n log n), expected, for evenly distributed balls; where radii differ, some thirty times as long.
    ///
    /// A sphere of radius p fits where balls enlarged by p leave a gap, and passes where they leave a path, which is decided exactly for
    /// any p. Where radii differ, the largest p is found by Newton's method, between bounds.
    ///
    /// # Errors
    /// The errors of [`Filtration::on`].
    #[expect(clippy::missing_panics_doc, reason = "an invariant")]
    pub fn pores(&self) -> Result<BallPores, BallsError> {
        let found = self.between(0.0)?;
        let Some(radius) = self.common else {
            // Each begins where a similar one has ended.
            let mut known = (0.0, found.clone());
            let included = self.largest(&mut known, |found| &found.included)?;
            let included_along_free =
                self.largest(&mut known, |found| &found.included_along_free)?;
            known = (0.0, found);
            let free_along = [
                self.largest(&mut known, |found| &found.free_along[0])?,
                self.largest(&mut known, |found| &found.free_along[1])?,
                self.largest(&mut known, |found| &found.free_along[2])?,
            ];
            // Every way to another copy leads along one of the vectors.
            let widest = free_along.into_iter().max_by(|a, b| a.diameter.total_cmp(&b.diameter));
            let free = widest.expect("three directions");
            return Ok(BallPores { included, free, free_along, included_along_free });
        };
        let sphere = |sphere: &PoreSphere| FreeSphere {
            diameter: 2.0 * (sphere.alpha.max(0.0).sqrt() - radius),
            center: sphere.center,
        };
        Ok(BallPores {
            included: sphere(&found.included),
            free: sphere(&found.free),
            free_along: found.free_along.each_ref().map(sphere),
            included_along_free: sphere(&found.included_along_free),
        })
    }

    /// The spheres of the power distance to the balls, whose radii are enlarged.
    fn between(&self, by: f64) -> Result<Pores, BallsError> {
        let Frame { filtration, .. } = self.filtration(by)?;
        Ok(filtration.simplices()?.pores().expect("the box repeats along all vectors"))
    }

    /// The sphere that vanishes where the balls are larger by its radius. It is looked for from a radius for which the spheres are known, and the last
    /// of these is left there.
    fn largest(
        &self,
        known: &mut (f64, Pores),
        of: impl Fn(&Pores) -> &PoreSphere,
    ) -> Result<FreeSphere, BallsError> {
        const MOST_STEPS: usize = 60;
        let ends = self.radii.iter().copied();
        let (least, most) =
            ends.fold((f64::INFINITY, 0.0), |(low, high), r| (f64::min(low, r), f64::max(high, r)));
        // The radius is between these.
        let (mut low, mut high) = (-least, f64::INFINITY);
        for _ in 0..MOST_STEPS {
            let (radius, sphere) = (known.0, of(&known.1));
            // How far the surface of a ball of this radius is from that of a sphere of the present radius around a place of this power.
            let room = |ball: f64| {
                let from = ball + radius;
                let to = (sphere.alpha + from * from).max(0.0).sqrt();
                if sphere.alpha == 0.0 { 0.0 } else { (sphere.alpha / (to + from)).max(-from) }
            };
            let bounds = [least, most].map(|ball| radius + room(ball));
            low = low.max(bounds[0].min(bounds[1]));
            high = high.min(bounds[0].max(bounds[1]));
            let touched = sphere.points.iter().map(|&v| room(self.radii[v as usize]));
            let mut next = radius + touched.fold(f64::INFINITY, f64::min);
            if !(low..=high).contains(&next) {
                next = f64::midpoint(low, high);
            }
            let step = (next - radius).abs();
            if step.min(high - low) <= 16.0 * f64::EPSILON * (most + next.abs()) {
                return Ok(FreeSphere { diameter: 2.0 * next, center: sphere.center });
            }
            *known = (next, self.between(next)?);
        }
        Ok(FreeSphere { diameter: 2.0 * known.0, center: of(&known.1).center })
    }

    /// Channels, pockets and void fraction for a probe of this radius. O(n log n), expected, for evenly distributed balls.
    ///
    /// # Errors
    /// [`BallsError::Probe`], and those of [`Filtration::on`] and [`BallUnion::new`].
    #[expect(clippy::missing_panics_doc, reason = "an invariant")]
    pub fn probed(&self, radius: f64) -> Result<ProbedPores, BallsError> {
        let Frame { filtration, alpha } = self.filtration(radius)?;
        let parts = filtration.pore_parts(alpha).expect("the box repeats along all vectors");
        let shape = filtration.shape(alpha);
        let filled = BallUnion::new(&shape)?.box_fraction().expect("a shape of a torus");
        let dimensions = parts.iter().map(|part| part.dimension);
        let void_fraction =
            Bounded { value: 1.0 - filled.value, bound: filled.bound + f64::EPSILON };
        Ok(ProbedPores {
            channels: dimensions.clone().filter(|&dimension| dimension > 0).collect(),
            pockets: dimensions.filter(|&dimension| dimension == 0).count(),
            void_fraction,
        })
    }

    /// The filtration whose balls, at its α, have radii larger by a probe's. Of balls of one radius it is the one without weights, in which nothing
    /// is rounded.
    fn filtration(&self, probe: f64) -> Result<Frame, BallsError> {
        if self.radii.iter().any(|radius| !(radius + probe).powi(2).is_finite()) {
            return Err(BallsError::Probe { radius: probe });
        }
        let (weights, alpha) = match self.common {
            Some(radius) => (vec![0.0; self.radii.len()], (radius + probe).powi(2)),
            None => (self.radii.iter().map(|radius| (radius + probe).powi(2)).collect(), 0.0),
        };
        let points = WeightedPoints::new(self.positions.clone(), weights);
        let points = points.expect("a weight for each point");
        let filtration = Filtration::on(Some(self.torus), points)?;
        let alpha = Alpha::from_squared(alpha).expect("a square that is a number");
        Ok(Frame { filtration, alpha })
    }
}
