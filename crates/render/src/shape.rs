use walpha_shape::{Class, Complex, Simplices};

use crate::colour::{ColourMap, PALETTE, Rgb};
use crate::error::RenderError;
use crate::normals::{orient, smoothed, vertex_normals};
use crate::scene::{Ball, Colours, Mesh, Scene, Shading, Tube};

/// The meaning of the colours of a drawn shape.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Colouring<'a> {
    /// No values: the boundary in the colour of bone, singular simplices in another tint.
    Plain,
    /// A value at each input point, such as F, through a colour map.
    Values(&'a [f64], ColourMap),
    /// A colour at each input point.
    Points(&'a [Rgb]),
    /// The classes: boundary facets, singular facets, singular edges and lone vertices each have their colour of
    /// [`class_colours`].
    Classes,
}

/// The look of a shape in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeStyle<'a> {
    /// The meaning of the colours.
    pub colouring: Colouring<'a>,
    /// Smooth shading suits shapes with steps at the scale of the point spacing; flat shading
    /// shows each facet.
    pub shading: Shading,
    /// Half the thickness of singular edges, and half the radius of lone vertices, in the units of
    /// the points. 0 leaves both out.
    pub edge_radius: f64,
    /// 1 for solid facets; a smaller value makes the inside visible, and shows the backs of facets.
    pub opacity: f64,
}

impl Default for ShapeStyle<'_> {
    /// Plain, smooth and solid, with edges fit for points about 1 apart.
    fn default() -> Self {
        Self {
            colouring: Colouring::Plain,
            shading: Shading::Smooth,
            edge_radius: 0.12,
            opacity: 1.0,
        }
    }
}

/// A class of simplices that is drawn, with its colour: for the legend of a figure coloured by
/// [`Colouring::Classes`]. Boundary facets, singular facets, singular edges, lone vertices.
pub fn class_colours() -> [(&'static str, Rgb); 4] {
    [
        ("regular facets", PALETTE[1]),
        ("singular facets", PALETTE[0]),
        ("singular edges", PALETTE[3]),
        ("singular vertices", PALETTE[0]),
    ]
}

/// The parts that are drawn with [`Colouring::Plain`], each with its colour: the boundary, and everything singular.
pub fn plain_colours() -> [(&'static str, Rgb); 2] {
    [("boundary", Rgb::BONE), ("singular: part of no cell", SINGULAR_TINT)]
}

/// The tint of singular facets among plain ones.
const SINGULAR_TINT: Rgb = Rgb([214, 138, 92]);

/// The number of rounds of blending that remove the steps of a voxel lattice from the normals, and preserve orbits a few voxels
/// wide.
const LATTICE_ROUNDS: usize = 2;

impl Scene {
    /// The boundary of a shape: regular facets seen from outside, singular facets from both
    /// sides, singular edges as tubes and singular vertices as balls. Interior and exterior
    /// simplices are not drawn.
    ///
    /// `positions` are the input points by index, (x, y, z), in the units of the picture.
    ///
    /// # Errors
    /// [`RenderError::Values`] when the number of values to colour by is not that of the points,
    /// [`RenderError::Point`] when the complex has a vertex that is not a point.
    pub fn of_shape(
        positions: &[[f64; 3]],
        complex: &Complex,
        style: &ShapeStyle<'_>,
    ) -> Result<Self, RenderError> {
        let given = match style.colouring {
            Colouring::Values(values, _) => Some(values.len()),
            Colouring::Points(colours) => Some(colours.len()),
            Colouring::Plain | Colouring::Classes => None,
        };
        if let Some(got) = given.filter(|&got| got != positions.len()) {
            return Err(RenderError::Values { got, points: positions.len() });
        }
        let facets = complex.facets.rows().as_flattened().iter();
        let edges = complex.edges.rows().as_flattened().iter();
        let all = facets.chain(edges).chain(complex.vertices.rows().as_flattened());
        if let Some(&vertex) = all.max().filter(|&&v| v as usize >= positions.len()) {
            return Err(RenderError::Point { vertex, points: positions.len() });
        }
        let mut scene = Self::default();
        let counts = complex.facets.counts();
        let is_sheet =
            style.colouring != Colouring::Classes && 2 * counts.singular > counts.regular;
        let parts: &[Part] =
            if is_sheet { &[Part::Sheet] } else { &[Part::Regular, Part::Singular] };
        for &part in parts {
            scene.meshes.extend(surface(positions, &complex.facets, part, style));
        }
        if style.edge_radius > 0.0 {
            let place = |v: u32| positions[v as usize];
            let colour = |v: u32, kind| style.colour(v, kind);
            scene.tubes.extend(complex.edges.of(Class::Singular).map(|&[a, b]| Tube {
                ends: [place(a), place(b)],
                radius: style.edge_radius,
                colour: colour(a, Kind::Edge),
            }));
            scene.balls.extend(complex.vertices.of(Class::Singular).map(|&[v]| Ball {
                centre: place(v),
                radius: 2.0 * style.edge_radius,
                colour: colour(v, Kind::Vertex),
            }));
        }
        Ok(scene)
    }
}

/// What a mesh shows.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    /// The regular facets, from outside.
    Regular,
    /// The singular facets, from both sides.
    Singular,
    /// Both, of a surface that most of its points are on, as of a scan: it is not told apart where it happens to have cells.
    Sheet,
}

#[derive(Clone, Copy)]
enum Kind {
    Regular,
    Singular,
    Edge,
    Vertex,
}

impl ShapeStyle<'_> {
    fn colour(&self, vertex: u32, kind: Kind) -> Rgb {
        match (self.colouring, kind) {
            (Colouring::Values(values, map), _) => map.colour(values[vertex as usize]),
            (Colouring::Points(colours), _) => colours[vertex as usize],
            (Colouring::Classes, kind) => class_colours()[kind as usize].1,
            (Colouring::Plain, Kind::Regular) => Rgb::BONE,
            (Colouring::Plain, _) => SINGULAR_TINT,
        }
    }
}

/// The facets of a part over the points they use; `None` if there are none.
fn surface(
    positions: &[[f64; 3]],
    facets: &Simplices<3>,
    part: Part,
    style: &ShapeStyle<'_>,
) -> Option<Mesh> {
    let is_of = |class| match part {
        Part::Regular => class == Class::Regular,
        Part::Singular => class == Class::Singular,
        Part::Sheet => matches!(class, Class::Regular | Class::Singular),
    };
    let mut triangles: Vec<[u32; 3]> =
        facets.iter().filter(|&(_, class)| is_of(class)).map(|(row, _)| *row).collect();
    let mut numbers = vec![u32::MAX; positions.len()];
    triangles.as_flattened().iter().for_each(|&v| numbers[v as usize] = 0);
    let mut used: Vec<u32> = Vec::new();
    for (vertex, number) in (0..).zip(&mut numbers).filter(|(_, number)| **number == 0) {
        *number = used.len() as u32;
        used.push(vertex);
    }
    triangles.as_flattened_mut().iter_mut().for_each(|v| *v = numbers[*v as usize]);
    let positions: Vec<[f64; 3]> = used.iter().map(|&v| positions[v as usize]).collect();
    let (kind, shading) = match part {
        // Singular facets meet at any angle; blending their normals would only blur them.
        Part::Singular => (Kind::Singular, Shading::Flat),
        _ => (Kind::Regular, style.shading),
    };
    if part == Part::Sheet {
        orient(&positions, &mut triangles);
    }
    let normals = (shading == Shading::Smooth)
        .then(|| smoothed(vertex_normals(&positions, &triangles), &triangles, LATTICE_ROUNDS));
    let colours = match style.colouring {
        Colouring::Values(..) | Colouring::Points(_) => {
            Colours::Vertex(used.iter().map(|&v| style.colour(v, kind)).collect())
        }
        _ => Colours::Uniform(style.colour(0, kind)),
    };
    (!triangles.is_empty()).then_some(Mesh {
        positions,
        triangles,
        normals,
        colours,
        two_sided: part != Part::Regular || style.opacity < 1.0,
        shading,
        opacity: style.opacity,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn simplices<const N: usize>(rows: Vec<[u32; N]>, classes: Vec<Class>) -> Simplices<N> {
        Simplices::new(rows, classes).unwrap()
    }

    /// A tetrahedron, a singular triangle, a singular edge and a lone vertex, far apart.
    fn shape() -> (Vec<[f64; 3]>, Complex) {
        let positions = (0..12).map(|k| [f64::from(k % 3), f64::from(k / 3), f64::from(k * k % 5)]);
        let complex = Complex {
            facets: simplices(
                vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2], [4, 5, 6], [6, 7, 8]],
                [vec![Class::Regular; 4], vec![Class::Singular, Class::Exterior]].concat(),
            ),
            edges: simplices(vec![[0, 1], [7, 8]], vec![Class::Regular, Class::Singular]),
            vertices: simplices(vec![[0], [9]], vec![Class::Regular, Class::Singular]),
            ..Complex::default()
        };
        (positions.collect(), complex)
    }

    #[test]
    fn each_class_becomes_what_it_should() {
        let (positions, complex) = shape();
        let style = ShapeStyle { colouring: Colouring::Classes, ..ShapeStyle::default() };
        let scene = Scene::of_shape(&positions, &complex, &style).unwrap();
        let [regular, singular] = &scene.meshes[..] else {
            panic!("{} meshes", scene.meshes.len())
        };
        assert_eq!(regular.triangles, complex.facets.rows()[..4]);
        assert_eq!(regular.positions, positions[..4]);
        assert!(!regular.two_sided && singular.two_sided);
        assert_eq!(singular.triangles, [[0, 1, 2]]);
        assert_eq!(singular.positions, positions[4..7]);
        let [facets, singular_facets, edges, vertices] = class_colours().map(|(_, colour)| colour);
        assert_eq!(regular.colours, Colours::Uniform(facets));
        assert_eq!(singular.colours, Colours::Uniform(singular_facets));
        let [tube] = scene.tubes[..] else { panic!("{} tubes", scene.tubes.len()) };
        assert_eq!((tube.ends, tube.colour), ([positions[7], positions[8]], edges));
        let [ball] = scene.balls[..] else { panic!("{} balls", scene.balls.len()) };
        assert_eq!((ball.centre, ball.colour), (positions[9], vertices));
    }

    #[test]
    fn a_surface_is_one_mesh() {
        let (positions, mut complex) = shape();
        complex.facets = simplices(
            vec![[0, 2, 1], [1, 2, 3], [2, 3, 4], [6, 7, 8]],
            vec![Class::Regular, Class::Singular, Class::Singular, Class::Interior],
        );
        let scene = Scene::of_shape(&positions, &complex, &ShapeStyle::default()).unwrap();
        let [sheet] = &scene.meshes[..] else { panic!("{} meshes", scene.meshes.len()) };
        assert!(sheet.triangles.len() == 3 && sheet.two_sided);
        assert_eq!(
            (&sheet.colours, sheet.shading),
            (&Colours::Uniform(Rgb::BONE), Shading::Smooth)
        );
        let style = ShapeStyle { colouring: Colouring::Classes, ..ShapeStyle::default() };
        assert_eq!(Scene::of_shape(&positions, &complex, &style).unwrap().meshes.len(), 2);
    }

    #[test]
    fn values_colour_the_points_they_belong_to() {
        let (positions, complex) = shape();
        let values: Vec<f64> = (0..12).map(f64::from).collect();
        let map = ColourMap::over(&values);
        let colouring = Colouring::Values(&values, map);
        let style =
            ShapeStyle { colouring, opacity: 0.5, edge_radius: 0.0, ..ShapeStyle::default() };
        let scene = Scene::of_shape(&positions, &complex, &style).unwrap();
        let expected = [4.0, 5.0, 6.0].map(|v| map.colour(v)).to_vec();
        assert_eq!(scene.meshes[1].colours, Colours::Vertex(expected.clone()));
        let colours: Vec<Rgb> = values.iter().map(|&value| map.colour(value)).collect();
        let by_points = ShapeStyle { colouring: Colouring::Points(&colours), ..style };
        let same = Scene::of_shape(&positions, &complex, &by_points).unwrap();
        assert_eq!(same.meshes[1].colours, Colours::Vertex(expected));
        assert!(scene.meshes.iter().all(|m| m.two_sided && m.opacity == 0.5));
        assert!(scene.tubes.is_empty() && scene.balls.is_empty());
    }

    #[test]
    fn empty_shapes_are_empty_scenes_and_wrong_points_are_refused() {
        let style = ShapeStyle::default();
        let empty = Scene::of_shape(&[], &Complex::default(), &style).unwrap();
        assert_eq!(empty, Scene::default());
        let (positions, complex) = shape();
        let error = Scene::of_shape(&positions[..5], &complex, &style).unwrap_err();
        assert!(matches!(error, RenderError::Point { vertex: 9, points: 5 }), "{error}");
        let colouring = Colouring::Values(&[1.0], ColourMap::new(0.0, 1.0));
        let style = ShapeStyle { colouring, ..style };
        let error = Scene::of_shape(&positions, &complex, &style).unwrap_err();
        assert!(matches!(error, RenderError::Values { got: 1, points: 12 }), "{error}");
    }
}
