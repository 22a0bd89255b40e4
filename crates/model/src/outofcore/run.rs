//! Computes blocks from file to file, several at a time: on one machine, or shared by a team.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use walpha_base::Monitor;
use walpha_base::sort::sort_by_key;
use walpha_regular::internals::spanning;

use super::block_file::{
    Arrays, BlockComponent, BlockFile, BlockSheet, BlockSummary, Met, Weights,
};
use super::field::{Field, Truncated};
use super::job::Stamp;
use super::truncate::SMOOTHED;
use super::{BlockPlan, BlocksError, Plan, Team};
use walpha_shape::{
    BlockShape, ByClass, Class, ComponentSums, Own, ShapeError, SheetSums, Side, block_shape,
};

/// The points of a block and those around it, in order of their index in the volume.
#[derive(Default)]
struct Points {
    voxels: Vec<u64>,
    positions: Vec<[f64; 3]>,
    values: Vec<f64>,
    weights: Vec<f64>,
    own: Vec<bool>,
}

/// Computes the part of the shape that a block owns, and writes it into the folder of the plan. An existing block is kept, unless
/// it does not verify or belongs to another plan. Files that the plan keeps are recreated if they do not verify. Needs no other
/// block.
///
/// # Errors
/// The errors of the stages, an input that has changed since the plan was made, or a folder that cannot be written to.
pub fn run(plan: &Plan, block: usize) -> Result<(), BlocksError> {
    let count = plan.blocks.len();
    let Some(planned) = plan.blocks.get(block) else {
        return Err(BlocksError::NoBlock { index: block, count });
    };
    if BlockFile::open(plan, block).and_then(|file| file.verify()).is_ok() {
        return Ok(());
    }
    let points = match points(plan, block) {
        // A kept file may be missing or damaged: restore it, and retry once.
        Err(_) if plan.verify_kept().is_err() => {
            plan.restore()?;
            points(plan, block)?
        }
        other => other?,
    };
    let found = points.own.iter().filter(|&&own| own).count() as u64;
    if found != planned.points {
        let planned = planned.points;
        let what = format!("block {block} has {found} points where {planned} were counted");
        return Err(BlocksError::changed(&plan.job.input, what));
    }
    let job = &plan.job;
    // Errors name a point by its index in the volume.
    let named = |error| match error {
        ShapeError::Radius { index, radius } => {
            ShapeError::Radius { index: points.voxels[index] as usize, radius }
        }
        other => other,
    };
    let squared = job.recipe.balls.power_weights(&points.weights, job.alpha()).map_err(named)?;
    let weights = squared.as_deref().unwrap_or(&points.weights);
    let own = Own { positions: &points.positions, weights, own: &points.own };
    let shape = block_shape(own, job.recipe.balls.power_alpha(job.alpha()).squared())?;
    write(plan, block, &points, shape)
}

/// Selects the points of a block and those that may be in its halo, from the samples there.
fn points(plan: &Plan, block: usize) -> Result<Points, BlocksError> {
    let (job, survey) = (&plan.job, &plan.survey);
    let (BlockPlan { part, reads, .. }, margin) = (plan.blocks[block], plan.margin()?);
    let dims = job.dims.xyz();
    let (around, read) = (part.grown(margin, dims), Plan::read_around(&part, margin, dims));
    let mut field = Field::open(job, Some(&read))?;
    (field.range, field.least) = (survey.range, survey.least);
    let truncated = plan.truncated(&read)?;
    let mut found = Vec::new();
    for tile in around.tiles(field.tile()) {
        field.samples(&tile, &truncated, |sample| {
            if survey.choice.is_point(&sample) {
                found.push((sample.voxel, sample.difference, sample.gray));
            }
        })?;
    }
    if !reads.input.is(field.digests.digest(&read)) {
        let same = Stamp::of(job) == plan.stamp;
        let files = if same { "" } else { ", and so do sizes or times of files" };
        return Err(BlocksError::changed(
            &job.input,
            format!("the samples of block {block} differ from the planned ones{files}"),
        ));
    }
    if let Truncated::File(_, digests) = &truncated
        && !reads.truncated.is_some_and(|planned| planned.is(digests.digest(&read)))
    {
        let path = plan.folder().join(SMOOTHED);
        return Err(BlocksError::Damaged { path, what: "is damaged".into() });
    }
    found.sort_unstable_by_key(|&(voxel, ..)| voxel);
    let shares = plan.shares()?;
    let written = job.recipe.written(survey.range);
    let [nx, ny, _] = field.dims;
    let mut points = Points::default();
    for (voxel, difference, gray) in found {
        let i = voxel as usize;
        points.voxels.push(voxel);
        points.positions.push(job.units.place(&job.frame, job.dims, voxel));
        points.values.push(written.value(gray.into()));
        points.weights.push(plan.weight(shares, difference));
        points.own.push(part.holds([i % nx, i / nx % ny, i / (nx * ny)]));
    }
    Ok(points)
}

/// Numbers keys from 0 in the order of their first occurrence.
struct Numbering(Vec<u32>, u32);

const NONE: u32 = u32::MAX;

impl Numbering {
    fn of(&mut self, key: u32) -> u32 {
        let number = &mut self.0[key as usize];
        if *number == NONE {
            *number = self.1;
            self.1 += 1;
        }
        *number
    }
}

fn write(plan: &Plan, block: usize, points: &Points, shape: BlockShape) -> Result<(), BlocksError> {
    let complex = &shape.complex;
    let position = |v: u32| points.positions[v as usize];
    let voxel = |v: u32| points.voxels[v as usize];
    let mut numbers = Numbering(vec![NONE; points.voxels.len()], 0);
    let mut number = |v: u32| numbers.of(shape.components[v as usize]);
    let mut components: Vec<BlockComponent> = Vec::new();
    let mut component_of = vec![NONE; points.voxels.len()];
    // The block's own points come first in each component: they are its vertices.
    for &[v] in complex.vertices.rows() {
        let component = number(v);
        component_of[v as usize] = component;
        match components.get_mut(component as usize) {
            Some(known) => known.sums.add_vertex(position(v)),
            None => components
                .push(BlockComponent { first: voxel(v), sums: ComponentSums::at(position(v)) }),
        }
    }
    for cell in complex.cells.rows() {
        let component = component_of[cell[0] as usize] as usize;
        components[component].sums.add_cell(cell.map(position));
    }
    for (facet, class) in complex.facets.iter() {
        let component = component_of[facet[0] as usize] as usize;
        components[component].sums.add_facet(facet.map(position), class);
    }
    let border: Vec<(u64, u32)> = shape.border.iter().map(|&v| (voxel(v), number(v))).collect();
    let sheets = sheets(plan, points, &shape, &component_of);
    let counts = |counts: ByClass<usize>| {
        [Class::Interior, Class::Regular, Class::Singular].map(|class| counts[class])
    };
    let own = || points.own.iter().zip(&points.weights).filter(|(own, _)| **own).map(|(_, w)| *w);
    let summary = BlockSummary {
        points: own().count() as u64,
        halo: shape.halo,
        cells: complex.cells.len(),
        facets: counts(complex.facets.counts()),
        edges: counts(complex.edges.counts()),
        vertices: counts(complex.vertices.counts()),
        weights: own().next().map(|_| Weights {
            min: own().fold(f64::INFINITY, f64::min),
            max: own().fold(f64::NEG_INFINITY, f64::max),
            sum: own().collect(),
        }),
        components,
        sheets,
        spanning: spanning(&points.positions),
    };
    arrays(points, &shape, &component_of, &border).write(plan, block, summary)
}

/// The parts of sheets in the block.
fn sheets(
    plan: &Plan,
    points: &Points,
    shape: &BlockShape,
    component_of: &[u32],
) -> Vec<BlockSheet> {
    let apex = plan.job.units.place(&plan.job.frame, plan.job.dims, plan.survey.first);
    let empty = BlockSheet { met: None, sums: SheetSums::default() };
    let mut sheets = vec![empty; shape.sheets as usize];
    let mut names = shape.facet_sheets.iter();
    let mut add = |row: [u32; 3], side: [u32; 3], is_second: bool| {
        let sheet = &mut sheets[*names.next().expect("one for each side") as usize];
        let component = component_of[row[0] as usize];
        let row = row.map(|v| points.voxels[v as usize]);
        sheet.met.get_or_insert(Met { is_edge: false, row, is_second, component });
        sheet.sums.add(apex, side.map(|v| points.positions[v as usize]));
    };
    for (&row, class) in shape.complex.facets.iter() {
        let [a, b, c] = row;
        match class {
            Class::Regular => add(row, row, false),
            Class::Singular => {
                // The side on which the sorted row turns clockwise comes first.
                add(row, [a, c, b], false);
                add(row, row, true);
            }
            _ => {}
        }
    }
    for (&[a, b], &name) in shape.complex.edges.of(Class::Singular).zip(&shape.edge_sheets) {
        let component = component_of[a as usize];
        let row = [points.voxels[a as usize], points.voxels[b as usize], 0];
        let met = Met { is_edge: true, row, is_second: false, component };
        sheets[name as usize].met.get_or_insert(met);
    }
    sheets
}

/// The arrays of a block: the points that are its own or corners of its rows, the rows, and the keys that blocks share.
fn arrays(
    points: &Points,
    shape: &BlockShape,
    component_of: &[u32],
    border: &[(u64, u32)],
) -> Arrays {
    let complex = &shape.complex;
    let mut used = points.own.clone();
    let corners = (complex.cells.rows().as_flattened().iter())
        .chain(complex.facets.rows().as_flattened())
        .chain(complex.edges.rows().as_flattened());
    corners.for_each(|&v| used[v as usize] = true);
    let kept: Vec<usize> = (0..used.len()).filter(|&v| used[v]).collect();
    let mut numbers = vec![NONE; used.len()];
    kept.iter().zip(0..).for_each(|(&v, number)| numbers[v] = number);
    let number = |v: u32| numbers[v as usize];
    let voxel = |v: u32| points.voxels[v as usize];
    let class = |class: &Class| *class as u8;

    let mut arrays = Arrays::default();
    arrays.add("voxels", kept.iter().map(|&v| points.voxels[v]));
    arrays.add("own", kept.iter().map(|&v| u8::from(points.own[v])));
    arrays.add("values", kept.iter().map(|&v| points.values[v]));
    arrays.add("weights", kept.iter().map(|&v| points.weights[v]));
    arrays.add("components", kept.iter().map(|&v| component_of[v]));
    arrays.add("cells", complex.cells.rows().iter().map(|row| row.map(number)));
    arrays.add("facets", complex.facets.rows().iter().map(|row| row.map(number)));
    arrays.add("facet_classes", complex.facets.classes().iter().map(class));
    arrays.add("facet_sheets", shape.facet_sheets.iter().copied());
    arrays.add("edges", complex.edges.rows().iter().map(|row| row.map(number)));
    arrays.add("edge_classes", complex.edges.classes().iter().map(class));
    arrays.add("edge_sheets", shape.edge_sheets.iter().copied());
    arrays.add("vertices", complex.vertices.rows().iter().map(|row| row.map(number)));
    arrays.add("vertex_classes", complex.vertices.classes().iter().map(class));
    arrays.add("border_points", border.iter().map(|&(voxel, _)| voxel));
    arrays.add("border_components", border.iter().map(|&(_, component)| component));
    arrays.add("shared_simplices", shape.shared.iter().map(|side| side.simplex.map(voxel)));
    arrays.add("shared_sides", shape.shared.iter().map(|side: &Side| side.side));
    arrays.add("shared_sheets", shape.shared.iter().map(|side| side.sheet));
    arrays
}

/// Runs some blocks of a plan, one per thread at a time. Existing blocks are kept.
///
/// # Errors
/// The error of [`run()`] for the first block that fails; [`BlocksError::Cancelled`]. Finished blocks stay.
pub fn run_all(plan: &Plan, blocks: &[usize]) -> Result<(), BlocksError> {
    let monitor = &*Monitor::current();
    let size =
        |&block: &usize| plan.blocks.get(block).map_or(0, |planned| planned.points + planned.halo);
    let work = monitor.units(blocks.iter().map(size).sum());
    let next = AtomicUsize::new(0);
    let failed = Mutex::new(None);
    let is_over = || failed.lock().is_ok_and(|failed| failed.is_some());
    // These are not rayon's threads: one of those that waits within a block might begin with another.
    std::thread::scope(|scope| {
        for _ in 0..rayon::current_num_threads().min(blocks.len()) {
            scope.spawn(|| {
                while let Some(block) = blocks.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let done = run(plan, *block).and_then(|()| Ok(work.add(size(block))?));
                    if let Err(error) = done {
                        failed
                            .lock()
                            .unwrap_or_else(std::sync::PoisonError::into_inner)
                            .get_or_insert(error);
                    }
                    if is_over() {
                        break;
                    }
                }
            });
        }
    });
    failed.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).map_or(Ok(()), Err)
}

/// Runs the missing blocks of a plan, as one process of a team, and waits until all exist. Each process gets blocks with about
/// the same number of points, in and around them.
///
/// # Errors
/// See [`run_all`]. A process that returns an error leaves the rest of the team waiting.
pub fn run_missing(plan: &Plan, team: &dyn Team) -> Result<(), BlocksError> {
    let missing = if team.is_first() { Some(plan.missing()?) } else { None };
    let missing = team.broadcast(missing);
    let size = |block: usize| plan.blocks[block].points + plan.blocks[block].halo;
    run_all(plan, &shared(missing, size, team.size())[team.rank()])?;
    team.barrier();
    Ok(())
}

/// Shares blocks among processes: the largest first, each to the process with the least work (Graham, "Bounds on multiprocessing
/// timing anomalies", 1969, doi:10.1137/0117039). No share exceeds 4/3 of the optimum.
fn shared(
    mut blocks: Vec<usize>,
    size: impl Fn(usize) -> u64,
    processes: usize,
) -> Vec<Vec<usize>> {
    sort_by_key(&mut blocks, |&block| Reverse(size(block)));
    let mut shares = vec![Vec::new(); processes];
    let mut least: BinaryHeap<Reverse<(u64, usize)>> =
        (0..processes).map(|process| Reverse((0, process))).collect();
    for block in blocks {
        let Some(Reverse((load, process))) = least.pop() else { break };
        shares[process].push(block);
        least.push(Reverse((load + size(block), process)));
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_about_equal() {
        let sizes = [7, 1, 4, 0, 9, 3, 3];
        let shares = shared((0..7).collect(), |block| sizes[block], 3);
        let loads: Vec<u64> =
            shares.iter().map(|share| share.iter().map(|&block| sizes[block]).sum()).collect();
        assert_eq!(loads, [9, 10, 8], "{shares:?}");
        let mut all = shares.concat();
        all.sort_unstable();
        assert_eq!(all, [0, 1, 2, 3, 4, 5, 6]);
        assert_eq!(shared(vec![2], |_| 0, 3), [vec![2], vec![], vec![]]);
    }
}
