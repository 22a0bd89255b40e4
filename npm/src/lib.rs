//! What the npm package `walpha` computes with: one call, whose arguments and answer are numbers in this memory. `index.js` makes them arrays.

use std::sync::{Mutex, PoisonError};

use walpha_base::advice::Advise;
use walpha_shape::ladder::Filtration;
use walpha_shape::{
    Alpha, AlphaShape, Class, Engine, ShapeError, ShapeOptions, WeightedPoints, alpha_shape,
};

/// What the last call answered, until the next one.
static LAST: Mutex<Option<Answer>> = Mutex::new(None);
/// Why the program ended, if it did.
static PANIC: Mutex<String> = Mutex::new(String::new());

/// What a call answers: the text of an error, or numbers, and lists of indices.
struct Answer {
    _kept: (String, Vec<f64>, Vec<Vec<u32>>),
    /// Address and length of each: of the text, of the numbers, and of the lists.
    places: Vec<[usize; 2]>,
}

impl Answer {
    fn of(found: Result<(Vec<f64>, Vec<Vec<u32>>), String>) -> Self {
        let (error, (numbers, lists)) = match found {
            Ok(found) => (String::new(), found),
            Err(error) => (error, Default::default()),
        };
        let mut places = vec![
            [error.as_ptr() as usize, error.len()],
            [numbers.as_ptr() as usize, numbers.len()],
        ];
        places.extend(lists.iter().map(|list| [list.as_ptr() as usize, list.len()]));
        Self { _kept: (error, numbers, lists), places }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Memory for this many doubles. [`compute`] takes it back.
#[unsafe(no_mangle)]
pub extern "C" fn reserve(doubles: usize) -> *mut f64 {
    Box::leak(vec![0.0; doubles].into_boxed_slice()).as_mut_ptr()
}

/// Keeps what a panic says, for [`message`].
#[unsafe(no_mangle)]
pub extern "C" fn begin() {
    std::panic::set_hook(Box::new(|panic| *lock(&PANIC) = panic.to_string()));
}

/// Where the message of a panic is, and its length.
#[unsafe(no_mangle)]
pub extern "C" fn message() -> *const [usize; 2] {
    let text = lock(&PANIC).clone();
    let mut last = lock(&LAST);
    last.insert(Answer::of(Err(text))).places.as_ptr()
}

/// Computes the shape of points at α, a squared length; NaN takes the least at which all points are in one solid component. Numbers are x, y and z of each point and then, if they are weighted, the weight of
/// each. Returns the places of the answer, until the next call.
///
/// # Safety
/// `numbers` is what [`reserve`] returned for three or four doubles a point, which have been written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn compute(
    numbers: *mut f64,
    points: usize,
    is_weighted: bool,
    alpha: f64,
) -> *const [usize; 2] {
    let length = points * if is_weighted { 4 } else { 3 };
    // SAFETY: a slice of this place and length was leaked by `reserve`.
    let numbers = unsafe { Box::from_raw(std::ptr::slice_from_raw_parts_mut(numbers, length)) };
    // The last answer, which may be large, goes before the next one is made.
    *lock(&LAST) = None;
    let found = found(&numbers, points, alpha).map_err(|error| match error.advice() {
        Some(advice) => {
            format!("{error}; {}", advice.with_names(|setting| setting.name().to_owned()))
        }
        None => error.to_string(),
    });
    lock(&LAST).insert(Answer::of(found)).places.as_ptr()
}

fn found(
    numbers: &[f64],
    points: usize,
    alpha: f64,
) -> Result<(Vec<f64>, Vec<Vec<u32>>), ShapeError> {
    let (positions, weights) = numbers.split_at(3 * points);
    let positions = positions.as_chunks().0.to_vec();
    let weights = if weights.is_empty() { vec![0.0; points] } else { weights.to_vec() };
    let points = WeightedPoints::new(positions, weights).expect("as many weights as points");
    let shape = if alpha.is_nan() {
        let filtration = Filtration::new(points)?;
        filtration.shape(filtration.one_region())
    } else {
        let alpha = Alpha::from_squared(alpha).expect("a number");
        alpha_shape(points, &ShapeOptions::new(alpha).engine(Engine::Native))?
    };
    Ok(described(&shape))
}

/// The numbers and lists that `index.js` expects, in this order.
fn described(shape: &AlphaShape) -> (Vec<f64>, Vec<Vec<u32>>) {
    let (measures, complex) = (shape.measures(), shape.complex());
    let betti = shape.betti().unwrap_or_default();
    let outline = shape.outline().ok();
    let (in_plane, perimeter) = match outline {
        Some(outline) => (outline.area, outline.perimeter),
        None => (measures.area, 0.0),
    };
    let numbers = vec![
        shape.options().alpha.squared(),
        shape.dimension() as f64,
        measures.volume,
        in_plane,
        perimeter,
        betti.b0 as f64,
        betti.b1 as f64,
        betti.b2 as f64,
    ];
    let rows = |rows: &[[u32; 3]]| rows.as_flattened().to_vec();
    let of_class = |class| complex.facets.of(class).copied().collect::<Vec<_>>();
    let (boundary, triangles) = match outline {
        Some(outline) => {
            let boundary: Vec<[u32; 2]> =
                outline.complex.edges.of(Class::Regular).copied().collect();
            let triangles: Vec<[u32; 3]> = outline.complex.facets.rows().to_vec();
            (boundary.into_flattened(), triangles)
        }
        None => (rows(&of_class(Class::Regular)), of_class(Class::Singular)),
    };
    let (edges, lone): (Vec<[u32; 2]>, Vec<u32>) = if let Some(outline) = outline {
        (outline.edges.clone(), outline.points.clone())
    } else {
        let lone = complex.vertices.of(Class::Singular).map(|&[v]| v).collect();
        (complex.edges.of(Class::Singular).copied().collect(), lone)
    };
    // Rings one after the other; how long each is; and how many rings each polygon has.
    let (mut corners, mut lengths, mut rings) = (Vec::new(), Vec::new(), Vec::new());
    for polygon in outline.into_iter().flat_map(|outline| &outline.polygons) {
        rings.push(1 + polygon.holes.len() as u32);
        for ring in [&polygon.outer].into_iter().chain(&polygon.holes) {
            lengths.push(ring.len() as u32);
            corners.extend(ring);
        }
    }
    let tetrahedra = complex.cells.rows().as_flattened().to_vec();
    let lists = vec![
        tetrahedra,
        boundary,
        triangles.into_flattened(),
        edges.into_flattened(),
        lone,
        corners,
        lengths,
        rings,
    ];
    (numbers, lists)
}
