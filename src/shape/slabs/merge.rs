//! The rows of all slabs as one complex, in canonical order.

use super::partition::Partition;
use super::{Answer, common_sheets};
use crate::cgal::{HIDDEN, RawSlab, Sites};
use crate::shape::{Class, Complex, Simplices};

/// Puts the rows of slabs in order of their smallest vertices. Each slab's rows are so already, so
/// this is a walk over the sites.
pub(super) fn merge(
    sites: &Sites,
    partition: &Partition,
    slabs: Vec<RawSlab>,
    exterior: bool,
) -> Answer {
    let sheets = common_sheets(&slabs);
    let walk = Walk { owner: partition.owner(), slabs: &slabs };
    let mut complex =
        Complex { vertices: walk.vertices(sites.input(), exterior), ..Complex::default() };
    let (mut facet_sheets, mut edge_sheets) = (Vec::new(), Vec::new());
    rayon::scope(|scope| {
        scope.spawn(|_| complex.cells = walk.rows(0, RawSlab::cells));
        scope.spawn(|_| {
            complex.facets = walk.rows(1, RawSlab::facets);
            facet_sheets = walk.sheets(1, RawSlab::facets, RawSlab::facet_sheets, &sheets);
        });
        scope.spawn(|_| {
            complex.edges = walk.rows(2, RawSlab::edges);
            edge_sheets = walk.sheets(2, RawSlab::edges, RawSlab::edge_sheets, &sheets);
        });
    });
    Answer { complex, facet_sheets, edge_sheets }
}

struct Walk<'a> {
    owner: &'a [u32],
    slabs: &'a [RawSlab],
}

impl Walk<'_> {
    /// Calls `visit(slab, ordinal)` for each site in turn, the ordinal counting the slab's own.
    fn sites(&self, mut visit: impl FnMut(usize, usize)) {
        let mut next = vec![0; self.slabs.len()];
        for &slab in self.owner {
            let slab = slab as usize;
            visit(slab, next[slab]);
            next[slab] += 1;
        }
    }

    fn rows<const N: usize>(
        &self,
        dimension: usize,
        of: impl Fn(&RawSlab) -> (&[[u32; N]], &[u8]),
    ) -> Simplices<N> {
        let parts: Vec<_> = self.slabs.iter().map(of).collect();
        let total = parts.iter().map(|part| part.0.len()).sum();
        let mut vertices = Vec::with_capacity(total);
        let mut classes = Vec::with_capacity(total);
        let mut at = vec![0; self.slabs.len()];
        self.sites(|slab, ordinal| {
            let end = at[slab] + self.slabs[slab].counts()[ordinal][dimension] as usize;
            vertices.extend_from_slice(&parts[slab].0[at[slab]..end]);
            let numbers = &parts[slab].1[at[slab]..end];
            classes.extend(numbers.iter().map(|&number| Class::from_number(number)));
            at[slab] = end;
        });
        Simplices { vertices, classes }
    }

    /// The common numbers of the sheets that boundary rows lie on: one for each regular facet, two
    /// for each singular facet, one for each singular edge.
    fn sheets<const N: usize>(
        &self,
        dimension: usize,
        rows: impl Fn(&RawSlab) -> (&[[u32; N]], &[u8]),
        sheets: impl Fn(&RawSlab) -> &[u32],
        common: &[Vec<u32>],
    ) -> Vec<u32> {
        let classes: Vec<_> = self.slabs.iter().map(|slab| rows(slab).1).collect();
        let sheets: Vec<_> = self.slabs.iter().map(sheets).collect();
        let mut merged = Vec::with_capacity(sheets.iter().map(|part| part.len()).sum());
        let mut at = vec![(0, 0); self.slabs.len()];
        self.sites(|slab, ordinal| {
            let (row, sheet) = &mut at[slab];
            let rows = self.slabs[slab].counts()[ordinal][dimension] as usize;
            for &number in &classes[slab][*row..*row + rows] {
                let sides = match Class::from_number(number) {
                    Class::Regular if N == 3 => 1,
                    Class::Singular => N - 1,
                    _ => 0,
                };
                let names = &sheets[slab][*sheet..*sheet + sides];
                merged.extend(names.iter().map(|&name| common[slab][name as usize]));
                *sheet += sides;
            }
            *row += rows;
        });
        merged
    }

    fn vertices(&self, input: &[u32], exterior: bool) -> Simplices<1> {
        let classes: Vec<_> = self.slabs.iter().map(RawSlab::vertex_classes).collect();
        let mut simplices = Simplices::default();
        let mut input = input.iter();
        self.sites(|slab, ordinal| {
            let site = *input.next().expect("an owner for each site");
            let number = classes[slab][ordinal];
            if number != HIDDEN && (exterior || Class::from_number(number) != Class::Exterior) {
                simplices.vertices.push([site]);
                simplices.classes.push(Class::from_number(number));
            }
        });
        simplices
    }
}
