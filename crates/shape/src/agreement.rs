//! Whether two engines computed the same complex ([`Engine::Both`](crate::Engine::Both)).

use std::fmt;

use walpha_base::advice::{Advice, Advise, Category};
use walpha_complex::canonical::{ByRow, sorted};

use crate::{Class, Complex, Simplices};

/// A difference between the complexes of two engines, which is a fault of one of them.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the engines differ in {count} simplices: {} {simplex:?} is {} by cgal and {} by native",
    NAMES[simplex.len() - 1],
    Named(*cgal),
    Named(*native)
)]
pub struct Disagreement {
    /// The number of simplices that only one engine lists, or that have another class.
    pub count: u64,
    /// The input indices of the first of these, of the highest dimension.
    pub simplex: Vec<u32>,
    /// Its class by CGAL; `None` if CGAL does not list it.
    pub cgal: Option<Class>,
    /// Its class by the native engine; `None` if that engine does not list it.
    pub native: Option<Class>,
}

impl Advise for Disagreement {
    fn advice(&self) -> Option<Advice> {
        Some("this is a fault of walpha or of CGAL: please report it with the points".into())
    }

    fn category(&self) -> Category {
        Category::Different
    }
}

const NAMES: [&str; 4] = ["vertex", "edge", "triangle", "tetrahedron"];

/// The class of a simplex, if it is listed.
struct Named(Option<Class>);

impl fmt::Display for Named {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(class) => class.fmt(f),
            None => f.write_str("not listed"),
        }
    }
}

/// Compares the complexes of two engines: their simplices as sets of points, with their classes. O(n log n).
pub(crate) fn agree(cgal: &Complex, native: &Complex) -> Result<(), Box<Disagreement>> {
    let mut found = None;
    compare(&cgal.cells, &native.cells, &mut found);
    compare(&cgal.facets, &native.facets, &mut found);
    compare(&cgal.edges, &native.edges, &mut found);
    compare(&cgal.vertices, &native.vertices, &mut found);
    found.map_or(Ok(()), |found| Err(Box::new(found)))
}

fn compare<const N: usize>(
    cgal: &Simplices<N>,
    native: &Simplices<N>,
    found: &mut Option<Disagreement>,
) where
    [([u32; N], Class)]: ByRow,
{
    let ascending = |simplices: &Simplices<N>| {
        let mut all: Vec<_> = simplices.iter().map(|(row, class)| (sorted(*row), class)).collect();
        all.sort_by_row();
        all.into_iter().peekable()
    };
    let (mut cgal, mut native) = (ascending(cgal), ascending(native));
    while let Some(simplex) =
        cgal.peek().into_iter().chain(native.peek()).map(|(row, _)| *row).min()
    {
        let cgal = cgal.next_if(|(row, _)| *row == simplex).map(|(_, class)| class);
        let native = native.next_if(|(row, _)| *row == simplex).map(|(_, class)| class);
        if cgal != native {
            let first = || Disagreement { count: 0, simplex: simplex.to_vec(), cgal, native };
            found.get_or_insert_with(first).count += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use walpha_regular::internals::Sites;

    use super::*;
    use crate::{Alpha, Classifier, Engine, ShapeError, ShapeOptions, WeightedPoints, alpha_shape};

    fn cube() -> WeightedPoints {
        let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2].map(f64::from);
        WeightedPoints::unweighted((0..8).map(corner).collect())
    }

    /// An engine for tests: the native one, on sites in their own order, which calls all cells singular if α is 1.
    fn classify(sites: &Sites<'_>, alpha: f64) -> Result<Complex, ShapeError> {
        let points = WeightedPoints::unweighted(sites.positions().to_vec());
        let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap()).exterior(true);
        let mut complex = alpha_shape(points, &options)?.complex().clone();
        let input = |row: &mut [u32]| row.iter_mut().for_each(|i| *i = sites.input()[*i as usize]);
        complex.cells.rows_mut().iter_mut().for_each(|row| input(row));
        complex.facets.rows_mut().iter_mut().for_each(|row| input(row));
        complex.edges.rows_mut().iter_mut().for_each(|row| input(row));
        complex.vertices.rows_mut().iter_mut().for_each(|row| input(row));
        if alpha == 1.0 {
            complex.cells.classes_mut().fill(Class::Singular);
        }
        Ok(complex)
    }

    #[test]
    fn engines_that_differ_are_an_error() {
        let both = |alpha| {
            let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap());
            alpha_shape(
                cube(),
                &options.engine(Engine::Both).classifier(Some(Classifier(classify))),
            )
        };
        let shape = both(2.0).unwrap();
        assert_eq!((shape.options().engine, shape.complex().cells.len()), (Engine::Both, 6));
        let ShapeError::Differ(differ) = both(1.0).unwrap_err() else { panic!("another error") };
        assert_eq!((differ.count, differ.cgal), (6, Some(Class::Singular)));
        assert_eq!(
            (differ.native, differ.category()),
            (Some(Class::Interior), Category::Different)
        );
    }

    /// A missing simplex, another class, and an extra row are each found and counted.
    #[test]
    fn what_differs_is_found() {
        let options = ShapeOptions::new(Alpha::from_squared(1.0).unwrap()).engine(Engine::Native);
        let whole = alpha_shape(cube(), &options).unwrap().complex().clone();
        assert_eq!(agree(&whole, &whole), Ok(()));
        let cells = whole.cells.clone();
        let without =
            Complex { cells: cells.clone().into_iter().skip(1).collect(), ..whole.clone() };
        let lost = agree(&without, &whole).unwrap_err();
        assert_eq!((lost.count, lost.cgal, lost.native), (1, None, Some(Class::Interior)));
        assert_eq!(lost.simplex, sorted(cells.rows()[0]));
        assert!(
            lost.to_string().contains("is not listed by cgal and interior by native"),
            "{lost}"
        );
        let mut other = whole.clone();
        other.facets.classes_mut()[3] = Class::Singular;
        other.edges.classes_mut()[0] = Class::Singular;
        let changed = agree(&whole, &other).unwrap_err();
        assert_eq!((changed.count, &changed.simplex[..]), (2, &sorted(whole.facets.rows()[3])[..]));
    }
}
