use super::block_file::{BlockFile, read_rows};
use super::merge::MergedNumbers;
use super::{BlocksError, Merged, Plan};
use walpha_points::WeightedPoints;
use walpha_shape::{
    AlphaShape, Assembled, Class, Complex, Engine, NO_COMPONENT, ShapeOptions, Sheets, Simplices,
};

/// Computes the shape of all blocks in one piece, equal to that of [`alpha_shape`](walpha_shape::alpha_shape), for results that
/// fit the memory.
///
/// # Errors
/// A file cannot be read or does not verify, or there are more points than 32-bit indices.
#[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
pub fn whole(plan: &Plan, merged: &Merged) -> Result<AlphaShape, BlocksError> {
    if merged.points > u64::from(u32::MAX) {
        return Err(BlocksError::TooLarge { what: format!("{} points", merged.points) });
    }
    let mut rows = Gathered::default();
    let mut points: Vec<(u64, f64, f64)> = Vec::new();
    for block in 0..plan.blocks.len() {
        let file = BlockFile::open(plan, block)?;
        let own = file.read::<u8>("own")?;
        let numbers = file.read::<f64>("values")?.into_iter().zip(file.read::<f64>("weights")?);
        let all = file.voxels()?.into_iter().zip(numbers).zip(own);
        points.extend(all.filter(|(_, own)| *own == 1).map(|((voxel, (f, w)), _)| (voxel, f, w)));
    }
    points.sort_unstable_by_key(|&(voxel, ..)| voxel);
    let indices = |file: &BlockFile, voxels: Vec<u64>| -> Result<Vec<u32>, BlocksError> {
        let index = |voxel: u64| {
            let found = points.binary_search_by_key(&voxel, |&(voxel, ..)| voxel);
            // Each corner is a block's own point.
            found.map(|index| index as u32).map_err(|_| file.damaged("has points of no block"))
        };
        voxels.into_iter().map(index).collect()
    };
    for (block, numbers) in merged.numbers.iter().enumerate() {
        let file = BlockFile::open(plan, block)?;
        rows.take(&file, &indices(&file, file.voxels()?)?, &numbers.sheets)?;
    }
    let (complex, sheets) = rows.finish(merged.sheets);
    let job = &plan.job;
    let place = |voxel: u64| job.units.place(&job.frame, job.dims, voxel);
    let positions = points.iter().map(|&(voxel, ..)| place(voxel)).collect();
    let weights = points.iter().map(|&(.., weight)| weight).collect();
    let values: Vec<f64> = points.iter().map(|&(_, value, _)| value).collect();
    let points = WeightedPoints::new(positions, weights).and_then(|all| all.with_values(values));
    let points = points.expect("columns of one list");
    let assembled = Assembled {
        points,
        coordinates: job.units.coordinates_of(&job.frame),
        options: ShapeOptions::new(plan.alpha())
            .balls(job.recipe.balls)
            .engine(Engine::Native)
            .refuse_flat(true),
        complex,
        hidden: None,
        betti: merged.betti,
        sheets: (!merged.is_flat).then_some(sheets),
    };
    Ok(AlphaShape::assembled(assembled)?)
}

/// The rows of all blocks.
#[derive(Default)]
struct Gathered {
    cells: Vec<[u32; 4]>,
    /// The facets, with the sheets of their sides.
    facets: Vec<([u32; 3], Class, [u32; 2])>,
    edges: Vec<([u32; 2], Class, u32)>,
    vertices: Vec<([u32; 1], Class)>,
}

impl Gathered {
    fn take(
        &mut self,
        file: &BlockFile,
        indices: &[u32],
        sheets: &[u32],
    ) -> Result<(), BlocksError> {
        let (complex, sheets) = read_rows(file, indices.len(), sheets)?;
        let index = |v: &u32| indices[*v as usize];
        self.cells.extend(complex.cells.rows().iter().map(|row| row.each_ref().map(index)));
        let (mut regular, mut singular) = (sheets.regular.iter(), sheets.singular.iter());
        for (row, class) in complex.facets.iter() {
            let sides = match class {
                Class::Regular => regular.next().map(|&sheet| [sheet, 0]),
                Class::Singular => singular.next().copied(),
                _ => None,
            };
            self.facets.push((row.each_ref().map(index), class, sides.unwrap_or_default()));
        }
        let mut names = sheets.edges.iter();
        for (row, class) in complex.edges.iter() {
            let name = if class == Class::Singular { names.next() } else { None };
            self.edges.push((row.each_ref().map(index), class, name.copied().unwrap_or_default()));
        }
        let vertices = complex.vertices.iter();
        self.vertices.extend(vertices.map(|(row, class)| (row.each_ref().map(index), class)));
        Ok(())
    }

    /// Sorts the rows into canonical order.
    fn finish(mut self, count: u32) -> (Complex, Sheets) {
        self.cells.sort_unstable();
        self.facets.sort_unstable_by_key(|facet| facet.0);
        self.edges.sort_unstable_by_key(|edge| edge.0);
        self.vertices.sort_unstable_by_key(|vertex| vertex.0);
        let mut complex = Complex::default();
        let mut sheets = Sheets { count, ..Sheets::default() };
        self.cells.into_iter().for_each(|row| complex.cells.push(row, Class::Interior));
        for (row, class, sides) in self.facets {
            complex.facets.push(row, class);
            match class {
                Class::Regular => sheets.regular.push(sides[0]),
                Class::Singular => sheets.singular.push(sides),
                _ => {}
            }
        }
        for (row, class, sheet) in self.edges {
            complex.edges.push(row, class);
            if class == Class::Singular {
                sheets.edges.push(sheet);
            }
        }
        let mut vertices = Simplices::default();
        self.vertices.into_iter().for_each(|(row, class)| vertices.push(row, class));
        complex.vertices = vertices;
        (complex, sheets)
    }
}

/// The simplices and points of a block, with the numbers of the merged shape.
pub(super) struct MergedBlock {
    pub complex: Complex,
    pub voxels: Vec<u64>,
    pub positions: Vec<[f64; 3]>,
    pub weights: Vec<f64>,
    pub values: Vec<f64>,
    pub components: Vec<u32>,
    pub sheets: Sheets,
}

impl MergedBlock {
    pub(super) fn read(
        plan: &Plan,
        block: usize,
        numbers: &MergedNumbers,
    ) -> Result<Self, BlocksError> {
        let file = BlockFile::open(plan, block)?;
        let job = &plan.job;
        let voxels = file.voxels()?;
        let place = |&voxel: &u64| job.units.place(&job.frame, job.dims, voxel);
        let common = |component: u32| {
            numbers.components.get(component as usize).copied().unwrap_or(NO_COMPONENT)
        };
        let (complex, sheets) = read_rows(&file, voxels.len(), &numbers.sheets)?;
        Ok(Self {
            positions: voxels.iter().map(place).collect(),
            weights: file.read("weights")?,
            values: file.read("values")?,
            components: file.read::<u32>("components")?.into_iter().map(common).collect(),
            complex,
            voxels,
            sheets,
        })
    }
}
