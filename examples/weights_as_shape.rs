//! Whether weights make a triangulation that fits a volume better than the unweighted one.
//!
//! For points chosen adaptively: the RMSE of the filled interpolant, with the samples' own values and with
//! fitted ones, for each kind of weights at several α, and for weights found by a search without
//! gradients. A step of the search changes, in each block of 8³ voxels, the weight of one point at
//! random, and keeps the changes of those blocks whose error fell most, if the whole error fell.
//!
//! `cargo run --release --example weights_as_shape [SAMPLE [COUNT [STEPS]]]`

use std::error::Error;

use walpha::haar::{HaarOptions, smooth};
use walpha::interpolate::{
    Adaptive, Deviation, Grid, Interpolant, Refit, adaptive_voxels, fill, refit,
};
use walpha::points::{difference, points_at, weigh};
use walpha::shape::{Engine, ShapeOptions};
use walpha::{Alpha, Gray, Points, Units, Volume, WeightedPoints, Weighting, alpha_shape, volume};

/// Voxels along the side of a block.
const BLOCK: usize = 8;
/// Steps told together.
const TOLD: usize = 20;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let name = args.next().unwrap_or_else(|| "sample:phantom".into());
    let count: u64 = args.next().map_or(Ok(5035), |count| count.parse())?;
    let steps: usize = args.next().map_or(Ok(100), |steps| steps.parse())?;
    let (volume, _) = volume::sample(&name)?.into_gray(Gray::Automatic)?;
    let (smoothed, _) = smooth(&volume, &HaarOptions::default())?;
    let goal = Adaptive::new(count);
    let voxels = adaptive_voxels(&volume, &goal, Units::Voxel)?;
    let points = points_at(&volume, &difference(&smoothed), &voxels, Units::Voxel);
    println!("{name}, {count} points\nweights         factor   RMSE, own values   fitted   hidden");
    for (kind, factor) in kinds() {
        let alpha = Alpha::from_squared(factor.abs())?;
        let mut weighted = weigh(points.clone(), kind, alpha)?;
        weighted.weights_mut().iter_mut().for_each(|weight| *weight *= factor.signum());
        let Judged { own, fitted, hidden, .. } = Judged::new(&volume, weighted)?;
        println!("{:<15} {factor:<8} {own:<18.4} {fitted:<8.4} {hidden}", kind.to_string());
    }
    search(&volume, &points, steps)
}

/// Kinds of weights, each with the α they are in proportion to, or its negative: then samples of large
/// differences are the light ones.
fn kinds() -> Vec<(Weighting, f64)> {
    let mut kinds = vec![(Weighting::Common(0.0), 1.0)];
    for kind in [Weighting::MinMax, Weighting::BarycentricN] {
        for factor in [0.1, 0.3, 1.0, 3.0, 10.0] {
            kinds.extend([(kind, factor), (kind, -factor)]);
        }
    }
    kinds
}

/// The search, from weights of 0.
fn search(volume: &Volume, points: &Points, steps: usize) -> Result<(), Box<dyn Error>> {
    let mut random = Random(1);
    let mut best = weigh(points.clone(), Weighting::Common(0.0), Alpha::INFINITE)?;
    let blocks = in_blocks(volume, best.positions());
    let mut judged = Judged::new(volume, best.clone())?;
    for step in 1..=steps {
        let picked: Vec<(usize, f64)> = (blocks.iter())
            .map(|points| (points[random.below(points.len())], random.change()))
            .collect();
        let with = |changes: &[(usize, f64)]| {
            let mut changed = best.clone();
            changes.iter().for_each(|&(point, change)| changed.weights_mut()[point] += change);
            changed
        };
        let tried = Judged::new(volume, with(&picked))?;
        let fall = |point: usize| {
            let block = block_at(volume, best.positions()[point]);
            judged.blocks[block] - tried.blocks[block]
        };
        let mut better: Vec<(usize, f64)> =
            picked.into_iter().filter(|&(point, _)| fall(point) > 0.0).collect();
        better.sort_by(|a, b| fall(b.0).total_cmp(&fall(a.0)));
        while !better.is_empty() {
            let changed = with(&better);
            let now = Judged::new(volume, changed.clone())?;
            if now.fitted < judged.fitted {
                (best, judged) = (changed, now);
                break;
            }
            better.truncate(better.len() / 2);
        }
        if step % TOLD == 0 {
            println!(
                "search, {step:>4} steps {:>17.4} {:>8.4}   {}",
                judged.own, judged.fitted, judged.hidden
            );
        }
    }
    Ok(())
}

/// The interpolant that weights give for points.
struct Judged {
    own: f64,
    fitted: f64,
    hidden: usize,
    /// The squared error of each block, with fitted values.
    blocks: Vec<f64>,
}

impl Judged {
    fn new(volume: &Volume, points: WeightedPoints) -> Result<Self, Box<dyn Error>> {
        let options = ShapeOptions::new(Alpha::INFINITE).engine(Engine::Native);
        let shape = alpha_shape(points, &options)?;
        let whole = fill(&shape, Some(volume), Units::Voxel)?;
        let grid = Grid::of(volume, Units::Voxel);
        let own = Deviation::of(volume, &Interpolant::new(&whole)?.resample(&grid)?);
        let values = refit(&whole, volume, Units::Voxel, Refit::Whole)?.values;
        let resampled = Interpolant::with_values(&whole, &values)?.resample(&grid)?;
        let fitted = Deviation::of(volume, &resampled);
        let mut blocks = vec![0.0; blocks_along(volume).iter().product()];
        let pairs = volume.as_slice().iter().zip(resampled.volume().as_slice());
        for (voxel, (f, g)) in pairs.enumerate() {
            let at = block_at(volume, Units::Voxel.position(volume, voxel as u32));
            blocks[at] += f64::from(f - g).powi(2);
        }
        let hidden = whole.hidden().map_or(0, <[u32]>::len);
        let rmse = |deviation: Deviation| deviation.rmse.unwrap_or(0.0);
        Ok(Self { own: rmse(own), fitted: rmse(fitted), hidden, blocks })
    }
}

fn blocks_along(volume: &Volume) -> [usize; 3] {
    volume.dims().xyz().map(|n| n.div_ceil(BLOCK))
}

fn block_at(volume: &Volume, position: [f64; 3]) -> usize {
    let [nx, ny, _] = blocks_along(volume);
    let [x, y, z] = position.map(|x| x as usize / BLOCK);
    x + nx * (y + ny * z)
}

/// The points of each block that has some.
fn in_blocks(volume: &Volume, positions: &[[f64; 3]]) -> Vec<Vec<usize>> {
    let mut blocks = vec![Vec::new(); blocks_along(volume).iter().product()];
    for (point, &position) in positions.iter().enumerate() {
        blocks[block_at(volume, position)].push(point);
    }
    blocks.retain(|points| !points.is_empty());
    blocks
}

/// Numbers without order, the same in each run (Steele, Lea and Flood 2014,
/// doi:10.1145/2714064.2660195).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// A change of a weight in squared voxels: from 1/8 to 8 up or down.
    fn change(&mut self) -> f64 {
        let size = 2f64.powi(self.below(7) as i32 - 3);
        if self.below(2) == 0 { size } else { -size }
    }
}
