//! Pictures of a shape as a whole: as PNG, and as the interactive page of `walpha view`.

use crate::ladder::Filtration;
use crate::points::bounding_box;
use crate::render::{
    Background, Camera, Colouring, Detail, Page, Picture, Projection, RenderError, Scene,
    ShapeStyle, Size, Subject, View,
};
use crate::shape::{Alpha, AlphaShape, Class, ShapeError, suggested};
use walpha_base::advice::{Advice, Advise, Category, wrapped};

/// Where a picture is seen from.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Look {
    /// From this side, all of the shape in view.
    View(View),
    /// From a place of choice.
    Camera(Camera),
}

/// The boundary of a shape on white, as PNG: bone-coloured and smooth, unless colours show more. That of a torus is laid out in
/// space.
///
/// # Errors
/// [`RenderError`] if there are not as many values as points, or the camera has no view.
pub fn png(
    shape: &AlphaShape,
    look: Look,
    colouring: Colouring<'_>,
    size: Size,
) -> Result<Vec<u8>, RenderError> {
    picture(shape, look, colouring, size)?.to_png()
}

/// The pixels of [`png`].
///
/// # Errors
/// The errors of [`png`].
pub fn picture(
    shape: &AlphaShape,
    look: Look,
    colouring: Colouring<'_>,
    size: Size,
) -> Result<Picture, RenderError> {
    let positions = shape.points().positions();
    let drawn: Vec<[f64; 3]> = drawn_vertices(shape).map(|v| positions[v as usize]).collect();
    let [low, high] = bounding_box(&drawn);
    let diagonal = (0..3).map(|k| (high[k] - low[k]).powi(2)).sum::<f64>().sqrt();
    // The edges are thin compared with the shape, in any unit: 0.12 for 64³ voxels, as in the figures. A single point is as thick as it
    // needs to be to differ from its centre.
    let edge_radius = if diagonal > 0.0 {
        diagonal * 0.0011
    } else {
        drawn.as_flattened().iter().fold(1.0, |most: f64, x| most.max(x.abs() * 1e-3))
    };
    let style = ShapeStyle { colouring, edge_radius, ..ShapeStyle::default() };
    let scene = Scene::of_shape(positions, shape.complex(), &style)?;
    let camera = match look {
        Look::Camera(camera) => camera,
        Look::View(view) => scene.camera(view, Projection::Perspective, size)?,
    };
    scene.render(&camera, size, Background::White)
}

/// The vertices of a shape, which are in its pictures: points outside it are not.
pub(crate) fn drawn_vertices(shape: &AlphaShape) -> impl Iterator<Item = u32> + '_ {
    let vertices = shape.complex().vertices.iter();
    vertices.filter(|&(_, class)| class != Class::Exterior).map(|(&[v], _)| v)
}

/// Why there is no page of a shape.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PageError {
    /// The cells of a solid of labels or inside an isosurface do not depend on α.
    #[error("a page moves through α, on which the cells of this shape do not depend")]
    WithoutAlpha,
    /// The shape of a periodic box that was unwrapped into space has copies of points in it.
    #[error("a page moves through α, and this shape is unwrapped from a periodic box at one α")]
    Unwrapped,
    /// The points have no filtration.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// The page cannot be made.
    #[error(transparent)]
    Render(#[from] RenderError),
}

impl Advise for PageError {
    fn advice(&self) -> Option<Advice> {
        match self {
            Self::WithoutAlpha => Some("write a picture, as .png".into()),
            Self::Unwrapped => Some("make the page of the shape in its box".into()),
            other => other.wrapped()?.advice(),
        }
    }

    fn category(&self) -> Category {
        self.wrapped().map_or(Category::Usage, Advise::category)
    }

    wrapped!(Shape, Render);
}

/// The interactive page of the points of a shape, which opens at its α: that of `walpha view` for points.
///
/// Computes the filtration of the points.
///
/// # Errors
/// The shape has no α, or it is unwrapped from a periodic box.
pub fn page(
    shape: &AlphaShape,
    title: &str,
    facts: &[(String, String)],
) -> Result<Page, PageError> {
    let torus = shape.options().periodic;
    if torus.is_none() && !shape.copies().is_empty() {
        return Err(PageError::Unwrapped);
    }
    if shape.voxels().is_some() || shape.isovalue().is_some() {
        return Err(PageError::WithoutAlpha);
    }
    let opening = shape.options().alpha;
    let filtration = Filtration::on(torus, shape.without_copies())?;
    let levels = filtration.levels(&stops(&filtration, opening));
    let [low, high] = bounding_box(shape.points().positions());
    let of_box = torus.and_then(|torus| torus.volume());
    let domain = of_box.unwrap_or_else(|| (0..3).map(|k| high[k] - low[k]).product());
    let ladder = levels.ladder(domain);
    let first = levels.alphas().partition_point(|alpha| *alpha <= opening).saturating_sub(1);
    let detail = Detail::new(&levels, &ladder, first);
    let page = Page::new(&Subject {
        title,
        facts,
        coordinates: shape.coordinates(),
        value: "the values of the points",
        difference: "values",
        details: &[detail],
        original: None,
    })?;
    Ok(page)
}

/// The number of levels of a page, besides the suggested ones.
const STOPS: usize = 28;
/// The number of critical values that are considered: all of them would take longer than the shape.
const CANDIDATES: usize = 1024;

/// The stops of the slider of a page: the one to open at, the suggested ones, and others between. Each is not empty and differs
/// from the previous one.
pub fn stops(filtration: &Filtration, opening: Alpha) -> Vec<Alpha> {
    let curve = filtration.coarse_curve(CANDIDATES);
    let mut alphas = filtration.stops(&curve, STOPS);
    alphas.push(opening);
    alphas.extend(suggested(filtration, &curve));
    let distinct = filtration.levels(&alphas).distinct(opening);
    if distinct.is_empty() { vec![opening] } else { distinct }
}
