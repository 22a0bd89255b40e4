use std::collections::HashMap;
use std::collections::hash_map::Entry;

use serde::{Deserialize, Serialize};
use walpha_base::{Monitor, Sum, UnionFind};
use walpha_regular::internals::spanning;

use super::block_file::BlockFile;
use super::block_file::{BlockComponent, BlockSheet, BlockSummary, Met, Weights};
use super::{BlocksError, Plan};
use walpha_points::WeightSummary;
use walpha_shape::{
    Betti, ByClass, Component, ComponentSums, Measures, SheetSums, components_of_sums,
};

/// The whole shape, merged from its blocks.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Merged {
    /// The number of selected points.
    pub points: u64,
    /// The weights ω.
    pub weights: WeightSummary,
    /// The number of cells in the shape.
    pub cells: usize,
    /// The numbers of facets by class; exterior ones are not counted.
    pub facets: ByClass<usize>,
    /// The numbers of edges by class.
    pub edges: ByClass<usize>,
    /// The numbers of vertices by class.
    pub vertices: ByClass<usize>,
    /// The Betti numbers.
    pub betti: Betti,
    /// The volume and areas.
    pub measures: Measures,
    /// The components, in the order of their smallest vertices.
    pub components: Vec<Component>,
    /// The number of halo points, summed over all blocks.
    pub halo: u64,
    /// For each block, the common numbers of its components and of its sheets.
    pub(super) numbers: Vec<MergedNumbers>,
    /// The number of sheets.
    pub(super) sheets: u32,
    /// Whether the points span no volume: their shape then has no sheets.
    pub(super) is_flat: bool,
}

/// The common numbers of a block's components and sheets.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct MergedNumbers {
    pub components: Vec<u32>,
    pub sheets: Vec<u32>,
}

/// Merges the blocks of a plan: unites components and sheets across borders, and adds up everything else. Rows of simplices are
/// not read; [`Plan::check`] also verifies these.
///
/// Takes memory for the keys of the borders, about 50 bytes for each point there.
///
/// # Errors
/// Blocks are missing, belong to another plan, or do not verify.
pub fn merge(plan: &Plan) -> Result<Merged, BlocksError> {
    let monitor = &*Monitor::current();
    let all = plan.blocks.len();
    let mut missing = Vec::new();
    let mut union = Union::default();
    for block in 0..all {
        match BlockFile::open(plan, block) {
            Ok(file) if missing.is_empty() => union.take(&file)?,
            Ok(_) => {}
            Err(BlocksError::Io { source, .. })
                if source.kind() == std::io::ErrorKind::NotFound =>
            {
                missing.push(block);
            }
            Err(error) => return Err(error),
        }
        monitor.report(block as u64 + 1, all as u64)?;
    }
    if !missing.is_empty() {
        return Err(BlocksError::Missing { missing, all });
    }
    let folder = plan.folder();
    let what = || "has blocks that do not fit together".to_owned();
    union.merged().ok_or_else(|| BlocksError::Damaged { path: folder.into(), what: what() })
}

/// The summaries of all blocks, with pairs of components and sheets that belong together.
#[derive(Default)]
struct Union {
    summaries: Vec<BlockSummary>,
    /// The number of components of all blocks, and the pairs that are one component.
    components: u32,
    sheets: u32,
    same_components: Vec<[u32; 2]>,
    same_sheets: Vec<[u32; 2]>,
    /// The component of the block that first named a point; and the sheet that first named a side of a facet or an edge.
    points: HashMap<u64, u32>,
    sides: HashMap<([u64; 3], u32), u32>,
}

impl Union {
    fn take(&mut self, file: &BlockFile) -> Result<(), BlocksError> {
        let summary = &file.summary;
        let added = |before: u32, more: usize, what: &str| {
            let sum = u32::try_from(more).ok().and_then(|more| before.checked_add(more));
            sum.ok_or_else(|| BlocksError::TooLarge { what: format!("{what} of all blocks") })
        };
        let components = added(self.components, summary.components.len(), "components")?;
        let sheets = added(self.sheets, summary.sheets.len(), "sheets")?;
        let points = file.read::<u64>("border_points")?;
        let of_points = file.below("border_components", summary.components.len() as u32)?;
        for (point, component) in points.into_iter().zip(of_points) {
            let component = self.components + component;
            same(self.points.entry(point), component, &mut self.same_components);
        }
        let simplices = file.read::<[u64; 3]>("shared_simplices")?;
        let sides = simplices.into_iter().zip(file.read::<u32>("shared_sides")?);
        for (side, sheet) in sides.zip(file.below("shared_sheets", summary.sheets.len() as u32)?) {
            same(self.sides.entry(side), self.sheets + sheet, &mut self.same_sheets);
        }
        (self.components, self.sheets) = (components, sheets);
        self.summaries.push(summary.clone());
        Ok(())
    }

    /// The merged shape; `None` if the numbers of the blocks cannot belong to a shape.
    fn merged(self) -> Option<Merged> {
        let Self { summaries, components: all_components, sheets: all_sheets, .. } = &self;
        let components = united(*all_components, &self.same_components);
        let sheets = united(*all_sheets, &self.same_sheets);
        let parts = summaries.iter().flat_map(|summary| &summary.components);
        let (component_numbers, components) = number_components(parts, components);
        // The components of a block's sheets are numbered within the block.
        let mut offset = 0;
        let mut parts = Vec::new();
        for summary in summaries {
            parts.extend(summary.sheets.iter().map(|sheet| (sheet, offset)));
            offset += summary.components.len();
        }
        let (sheet_numbers, sheets) = number_sheets(&parts, sheets, &component_numbers);
        let count = sheets.len() as u32;
        let mut numbers = Vec::new();
        let (mut a, mut b) = (component_numbers.into_iter(), sheet_numbers.into_iter());
        for summary in summaries {
            let components = a.by_ref().take(summary.components.len()).collect();
            let sheets = b.by_ref().take(summary.sheets.len()).collect();
            numbers.push(MergedNumbers { components, sheets });
        }
        let totals = Totals::of(summaries);
        let measures = ComponentSums::measures(components.iter());
        let lone = totals.vertices.singular as u64;
        let b0 = components.len() as u64;
        let b2 = (u64::from(count) + lone).checked_sub(b0)?;
        let euler = totals.vertices.in_shape() as i64 - totals.edges.in_shape() as i64
            + totals.facets.in_shape() as i64
            - totals.cells as i64;
        let b1 = u64::try_from((b0 + b2) as i64 - euler).ok()?;
        let with_facets = sheets.into_iter().filter(|(_, _, sums)| *sums != SheetSums::default());
        let places: Vec<_> =
            summaries.iter().flat_map(|summary| &summary.spanning).copied().collect();
        let is_flat = spanning(&places).len() < 4;
        Some(Merged {
            points: totals.points,
            weights: totals.weights,
            cells: totals.cells,
            facets: totals.facets,
            edges: totals.edges,
            vertices: totals.vertices,
            betti: Betti::in_space(b0, b1, b2),
            measures,
            components: components_of_sums(&components, (!is_flat).then(|| with_facets.collect())),
            halo: totals.halo,
            numbers,
            sheets: count,
            is_flat,
        })
    }
}

/// Records that two numbers denote the same component or sheet.
fn same<K>(entry: Entry<'_, K, u32>, now: u32, pairs: &mut Vec<[u32; 2]>) {
    match entry {
        Entry::Vacant(vacant) => _ = vacant.insert(now),
        Entry::Occupied(before) => pairs.push([*before.get(), now]),
    }
}

fn united(count: u32, pairs: &[[u32; 2]]) -> UnionFind {
    let sets = UnionFind::new(count as usize);
    pairs.iter().for_each(|&[a, b]| _ = sets.unite(a, b));
    sets
}

/// Numbers components in the order of their smallest vertices. Returns the number of each part, and the components. A part
/// without vertices does not define a component.
fn number_components<'a>(
    parts: impl Iterator<Item = &'a BlockComponent>,
    sets: UnionFind,
) -> (Vec<u32>, Vec<ComponentSums>) {
    let mut whole: Vec<Option<BlockComponent>> = vec![None; sets.members()];
    for (part, i) in parts.zip(0..) {
        match &mut whole[sets.find(i) as usize] {
            Some(whole) => {
                whole.first = whole.first.min(part.first);
                whole.sums.join(&part.sums);
            }
            none => *none = Some(part.clone()),
        }
    }
    let mut order: Vec<(u64, u32, ComponentSums)> = (0..)
        .zip(whole)
        .filter_map(|(root, whole)| whole.map(|whole| (whole.first, root, whole.sums)))
        .collect();
    order.sort_unstable_by_key(|&(first, ..)| first);
    let mut numbers = vec![0; sets.members()];
    order.iter().zip(0..).for_each(|(&(_, root, _), number)| numbers[root as usize] = number);
    let numbers = (0..sets.members() as u32).map(|i| numbers[sets.find(i) as usize]).collect();
    (numbers, order.into_iter().map(|(_, _, sums)| sums).collect())
}

/// Numbers sheets in the order of their first occurrence. Returns the number of each part, and the sheets with their components.
/// A part comes with the number of the first component of its block.
fn number_sheets(
    parts: &[(&BlockSheet, usize)],
    sets: UnionFind,
    components: &[u32],
) -> (Vec<u32>, Vec<(u32, usize, SheetSums)>) {
    let mut whole: Vec<Option<(Met, usize, SheetSums)>> = vec![None; sets.members()];
    for (&(part, offset), i) in parts.iter().zip(0..) {
        // A part without rows was named by a neighbour that has some.
        let Some(met) = part.met else { continue };
        let component = components[offset + met.component as usize] as usize;
        match &mut whole[sets.find(i) as usize] {
            Some((first, _, sums)) => {
                *first = (*first).min(met);
                sums.join(&part.sums);
            }
            none => *none = Some((met, component, part.sums.clone())),
        }
    }
    let mut order: Vec<(Met, u32, usize, SheetSums)> = (0..)
        .zip(whole)
        .filter_map(|(root, whole)| whole.map(|(met, c, sums)| (met, root, c, sums)))
        .collect();
    order.sort_unstable_by_key(|&(met, ..)| met);
    let mut numbers = vec![0; sets.members()];
    order.iter().zip(0..).for_each(|(&(_, root, ..), number)| numbers[root as usize] = number);
    let numbers = (0..sets.members() as u32).map(|i| numbers[sets.find(i) as usize]).collect();
    let sheets =
        (0..).zip(order).map(|(number, (_, _, component, sums))| (number, component, sums));
    (numbers, sheets.collect())
}

/// The sums over all blocks.
#[derive(Default)]
struct Totals {
    points: u64,
    halo: u64,
    cells: usize,
    facets: ByClass<usize>,
    edges: ByClass<usize>,
    vertices: ByClass<usize>,
    weights: WeightSummary,
}

impl Totals {
    fn of(all: &[BlockSummary]) -> Self {
        let mut totals = Self::default();
        let (mut min, mut max, mut sum) = (f64::INFINITY, f64::NEG_INFINITY, Sum::default());
        let add = |to: &mut ByClass<usize>, [interior, regular, singular]: [usize; 3]| {
            to.interior += interior;
            to.regular += regular;
            to.singular += singular;
        };
        for summaries in all {
            totals.points += summaries.points;
            totals.halo += summaries.halo;
            totals.cells += summaries.cells;
            add(&mut totals.facets, summaries.facets);
            add(&mut totals.edges, summaries.edges);
            add(&mut totals.vertices, summaries.vertices);
            if let Some(Weights { min: least, max: most, sum: more }) = &summaries.weights {
                (min, max) = (min.min(*least), max.max(*most));
                sum.join(more);
            }
        }
        if totals.points > 0 {
            totals.weights = WeightSummary { min, mean: sum.value() / totals.points as f64, max };
        }
        totals
    }
}
