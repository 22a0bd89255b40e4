//! Complexes from files, ready to be judged. The contents and formats of files are those of [`walpha_complex::schema`].

pub use walpha_complex::schema::*;

use walpha_base::parallel::prelude::*;
use walpha_complex::canonical::{outward_facets, smallest_even, sort, sorted};

use crate::exact::orientation;
use crate::index::Index;
use crate::period::Period;
use crate::repeated::repeated;
use crate::{Alpha, Class, Complex, Placed, Simplices, Voxels};

/// A complex with its points, in canonical order, ready to be judged.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedComplex {
    /// x, y, z of each point.
    pub positions: Vec<[f64; 3]>,
    /// Power weights.
    pub weights: Vec<f64>,
    /// α.
    pub alpha: Alpha,
    /// The complex.
    pub complex: Complex,
    /// Points listed as hidden, if they are listed.
    pub hidden: Option<Vec<u32>>,
    /// Duplicates, if they are listed.
    pub duplicates: Option<Vec<[u32; 2]>>,
    /// The vectors of the periodic box, if there is one.
    pub periodic: Option<BoxVectors>,
    /// The lowest dimension of which it lists all simplices: 0, unless the file leaves a dimension out. That dimension and those
    /// below have only faces.
    pub lowest: usize,
    /// The number of copies of the box of which this is the complex: several where rows of the file [name copies](ComplexFile::copies). Each
    /// simplex of the file then has so many rows; the points of the file come first.
    pub copies: usize,
    /// The voxels that the cells fill, if the complex is of labels.
    pub voxels: Option<Voxels>,
    /// The value at whose isosurface the cells end, if the complex is the solid inside one.
    pub isovalue: Option<f64>,
}

impl PlacedComplex {
    /// The complex, borrowed for comparison.
    pub fn placed(&self) -> Placed<'_> {
        Placed::new(&self.positions, &self.weights, self.alpha, &self.complex)
    }

    /// The number of points in the box.
    pub fn points_in_box(&self) -> usize {
        self.positions.len() / self.copies
    }

    /// Returns this complex in a periodic box, or in space.
    #[must_use]
    pub fn with_periodic(self, periodic: Option<BoxVectors>) -> Self {
        Self { periodic, ..self }
    }

    /// Returns this complex as one of labels, whose cells fill these voxels, or as one of α.
    #[must_use]
    pub fn with_voxels(self, voxels: Option<Voxels>) -> Self {
        Self { voxels, ..self }
    }

    /// The same complex as the solid inside the isosurface of a value, or as one of α.
    #[must_use]
    pub fn with_isovalue(self, isovalue: Option<f64>) -> Self {
        Self { isovalue, ..self }
    }
}

impl TryFrom<ComplexFile> for PlacedComplex {
    type Error = SchemaError;

    /// Derives missing data, orients cells and regular facets canonically, and sorts. Flat cells and repeated rows are kept for
    /// the checker to find.
    ///
    /// # Errors
    /// Fields of different lengths, point numbers out of range, no points or no simplices, copies of points without a box or too far from it.
    fn try_from(file: ComplexFile) -> Result<Self, SchemaError> {
        let n = file.points.len();
        if n == 0 {
            return Err(SchemaError::NoPoints);
        }
        if [
            file.cells.is_none(),
            file.facets.is_none(),
            file.edges.is_none(),
            file.vertices.is_none(),
        ] == [true; 4]
        {
            return Err(SchemaError::NoSimplices);
        }
        if let Some(vectors) = file.periodic.filter(|vectors| !Period::is_sound(*vectors)) {
            let BoxVectors(vectors) = vectors;
            return Err(SchemaError::Value {
                name: "periodic",
                value: format!("{vectors:?}"),
                expected: "positive sides or independent vectors, and 0 where points do not repeat",
            });
        }
        let lowest = lowest_listed(&file);
        let (file, copies) = repeated(file)?;
        let n = file.points.len();
        if file.voxels.as_ref().is_some_and(|voxels| !voxels.is_sound()) {
            return Err(SchemaError::Value {
                name: "voxels",
                value: "runs that overlap, are not in order or leave the grid".into(),
                expected: "ascending runs of voxels of the grid",
            });
        }
        let is_solid = file.voxels.is_some() || file.isovalue.is_some();
        if is_solid && file.periodic.is_some() {
            return Err(SchemaError::Value {
                name: "periodic",
                value: "the sides of a box".into(),
                expected: "none, as the complex is of labels or inside an isosurface",
            });
        }
        if file.voxels.is_some() && file.isovalue.is_some() {
            return Err(SchemaError::Value {
                name: "isovalue",
                value: "a value".into(),
                expected: "none, as the complex is of labels",
            });
        }
        let weights = file.weights.unwrap_or_else(|| vec![0.0; n]);
        SchemaError::paired("weights", weights.len(), "points", n)?;
        let numbers = file.hidden.iter().flatten();
        SchemaError::in_range("hidden", numbers, n)?;
        SchemaError::in_range("duplicates", file.duplicates.iter().flatten().flatten(), n)?;

        let vertices = file.vertices.map(|list| list.into_iter().map(|v| [v]).collect());
        let classes = file.classes;
        let cells = given_simplices(
            FieldNames("cells", "classes.cells"),
            file.cells.or(Some(Vec::new())),
            classes.cells,
            n,
        )?;
        let facets = given_simplices(
            FieldNames("facets", "classes.facets"),
            file.facets,
            classes.facets,
            n,
        )?;
        let edges =
            given_simplices(FieldNames("edges", "classes.edges"), file.edges, classes.edges, n)?;
        let vertices = given_simplices(
            FieldNames("vertices", "classes.vertices"),
            vertices,
            classes.vertices,
            n,
        )?;

        let cells = of_cells(cells);
        let facets = complete(facets, |&cell| outward_facets(cell), &cells);
        let of_facet = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [a, c]];
        let edges = complete(edges, of_facet, &facets);
        let vertices = complete(vertices, |&[a, b]: &[u32; 2]| [[a], [b]], &edges);
        let mut complex = Complex { cells, facets, edges, vertices };
        orient(&mut complex, &file.points, file.periodic);
        sort(&mut complex);
        Ok(Self {
            positions: file.points,
            weights,
            alpha: file.alpha,
            complex,
            hidden: file.hidden,
            duplicates: file.duplicates,
            periodic: file.periodic,
            copies,
            lowest,
            voxels: file.voxels,
            isovalue: file.isovalue,
        })
    }
}

/// The lowest of the dimensions that the file lists without a gap, from the highest listed one down.
fn lowest_listed(file: &ComplexFile) -> usize {
    let lower = [file.facets.is_some(), file.edges.is_some(), file.vertices.is_some()];
    let listed = [file.cells.is_some()].into_iter().chain(lower);
    let from_highest = listed.skip_while(|is_listed| !is_listed).collect::<Vec<_>>();
    from_highest.iter().skip_while(|is_listed| **is_listed).count()
}

/// The names of the fields of a dimension: its simplices and their classes.
struct FieldNames(&'static str, &'static str);

/// The rows and classes of a dimension, as far as the file has them.
struct Given<const N: usize> {
    rows: Option<Vec<[u32; N]>>,
    classes: Option<Vec<Class>>,
}

/// The simplices of a dimension in the file, checked.
fn given_simplices<const N: usize>(
    FieldNames(name, of_classes): FieldNames,
    rows: Option<Vec<[u32; N]>>,
    classes: Option<Vec<Class>>,
    points: usize,
) -> Result<Given<N>, SchemaError> {
    SchemaError::in_range(name, rows.iter().flatten().flatten(), points)?;
    if let Some(classes) = &classes {
        SchemaError::paired(of_classes, classes.len(), name, rows.as_ref().map_or(0, Vec::len))?;
    }
    // An empty list of classes has no meaning for derived rows.
    let classes = classes.filter(|_| rows.is_some());
    Ok(Given { rows, classes })
}

/// The cells of the file; in the shape without classes.
fn of_cells(given: Given<4>) -> Simplices<4> {
    let rows = given.rows.unwrap_or_default();
    let classes = given.classes.unwrap_or_else(|| vec![Class::Interior; rows.len()]);
    with_classes(rows, classes)
}

fn with_classes<const N: usize>(rows: Vec<[u32; N]>, classes: Vec<Class>) -> Simplices<N> {
    Simplices::new(rows, classes).expect("as many classes as rows")
}

/// The cofaces of a simplex, one dimension up.
#[derive(Clone, Copy)]
struct Cofaces {
    count: usize,
    in_shape: bool,
    all_interior: bool,
}

/// Rows and classes of a dimension: those of the file if it has them, otherwise derived from the dimension above.
fn complete<const N: usize, const M: usize, const F: usize>(
    given: Given<M>,
    faces: impl Fn(&[u32; N]) -> [[u32; M]; F] + Sync,
    higher: &Simplices<N>,
) -> Simplices<M> {
    let (rows, classes) = match given {
        Given { rows: Some(rows), classes: Some(classes) } => {
            return with_classes(rows, classes);
        }
        Given { rows, classes } => (rows, classes),
    };
    let of_rows = higher.rows().par_iter().zip(higher.classes());
    let mut faces: Vec<([u32; M], Class)> = of_rows
        .flat_map_iter(|(row, &class)| faces(row).map(|face| (sorted(face), class)))
        .collect();
    faces.par_sort_unstable();
    let cofaces: Vec<([u32; M], Cofaces)> = faces
        .chunk_by(|(face, _), (next, _)| face == next)
        .map(|of_face| {
            let cofaces = Cofaces {
                count: of_face.len(),
                in_shape: of_face.iter().any(|&(_, class)| class != Class::Exterior),
                all_interior: of_face.iter().all(|&(_, class)| class == Class::Interior),
            };
            (of_face[0].0, cofaces)
        })
        .collect();
    drop(faces);
    let derived = rows.is_none();
    let rows = rows.unwrap_or_else(|| cofaces.iter().map(|&(face, _)| face).collect());
    let implied = |row: &[u32; M]| {
        let at = cofaces.binary_search_by_key(&sorted(*row), |&(face, _)| face);
        match at.map(|at| cofaces[at].1) {
            // A facet has two sides; for an edge or vertex all cofaces must be interior.
            Ok(cofaces) if cofaces.in_shape => {
                let closed = cofaces.all_interior && (M < 3 || cofaces.count == 2);
                if closed { Class::Interior } else { Class::Regular }
            }
            _ if derived => Class::Exterior,
            _ => Class::Singular,
        }
    };
    let classes = classes.unwrap_or_else(|| rows.par_iter().map(implied).collect());
    with_classes(rows, classes)
}

/// Orients cells positively and regular facets outward, and sorts the vertices of other rows.
pub(crate) fn orient(complex: &mut Complex, points: &[[f64; 3]], periodic: Option<BoxVectors>) {
    let period = periodic.map(Period::new);
    complex.cells.rows_mut().par_iter_mut().for_each(|cell| {
        let mut corners = cell.map(|v| points[v as usize]);
        if let Some(period) = &period {
            let first = corners[0];
            let near = |corner| period.moved(corner, period.nearest_copy(first, corner));
            if finite(&corners) {
                corners = corners.map(near);
            }
        }
        let [a, b, c, d] = corners;
        if finite(&[a, b, c, d]) && orientation(a, b, c, d).is_lt() {
            cell.swap(2, 3);
        }
        *cell = smallest_even(*cell);
    });
    complex.facets.rows_mut().par_iter_mut().for_each(|facet| *facet = sorted(*facet));
    complex.edges.rows_mut().par_iter_mut().for_each(|edge| *edge = sorted(*edge));
    let regular: Vec<[u32; 3]> = complex.facets.of(Class::Regular).copied().collect();
    let index = Index::new(&regular, points.len());
    let cells = complex.cells.rows().par_iter().zip(complex.cells.classes());
    let outward =
        cells.filter(|(_, class)| **class == Class::Interior).flat_map_iter(|(cell, _)| {
            let facets = outward_facets(*cell).into_iter();
            facets.filter(|facet| index.contains(*facet)).map(smallest_even)
        });
    // A facet that is listed several times, or that has two such cells, is oriented as in the last of them.
    let mut outward: Vec<[u32; 3]> = outward.collect();
    outward.par_sort_by_key(|facet| sorted(*facet));
    drop(index);
    let (facets, classes) = complex.facets.rows_mut_with_classes();
    facets.par_iter_mut().zip(classes).filter(|(_, class)| **class == Class::Regular).for_each(
        |(facet, _)| {
            let after = outward.partition_point(|other| sorted(*other) <= *facet);
            let last = after.checked_sub(1).map(|at| outward[at]);
            *facet = last.filter(|other| sorted(*other) == *facet).unwrap_or(*facet);
        },
    );
}

/// Whether coordinates are finite. The checker reports those that are not.
fn finite(positions: &[[f64; 3]]) -> bool {
    positions.as_flattened().iter().all(|x| x.is_finite())
}
