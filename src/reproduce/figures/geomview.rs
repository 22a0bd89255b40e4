use super::super::compare::{PixelDifference, same_set};
use super::super::off::OffMesh;
use super::super::stage::{Eye, panel};
use super::super::study::{ALPHA, Shaped};
use super::super::{Fact, Finding, Item, ReproduceError, Verdict};
use super::{Bench, figure};
use crate::export::{ExportOptions, Exporter, Off};
use crate::render::{Figure, Picture};
use crate::shape::Surface;

/// Figure 11: the pair of Figure 10 as files for Geomview, drawn from these files.
pub(super) fn figure_11(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let shapes = bench.shapes;
    let pair = [
        ("ω = 0", &shapes.plain, "figure-11-left.off"),
        ("barycentric, equation 4.2", &shapes.barycentric, "figure-11-right.off"),
    ];
    let mut sides = Vec::new();
    for (title, shaped, name) in pair {
        sides.push(Side::new(bench, title, shaped, name)?);
    }
    let panels = sides.iter().map(|side| {
        let caption = format!(
            "{}: {} vertices, {} facets",
            side.file,
            side.mesh.positions.len(),
            side.mesh.facets.len()
        );
        panel(side.title, side.picture.clone(), vec![caption])
    });
    let title = format!("Figure 11. The pair as OFF files, read back; α = {ALPHA}");
    let drawn = Figure { legend: Vec::new(), ..figure(&title, panels.collect()) };
    let picture = bench.file("figure-11.png", drawn.to_png()?);

    let pixels = PixelDifference::between(&sides[0].picture, &sides[1].picture);
    let same = same_set(&shapes.plain.shape, &shapes.barycentric.shape);
    let findings = vec![
        Finding {
            claim: "The shapes can be shown by a second program, Geomview.".into(),
            verdict: Verdict::of(sides.iter().all(|side| side.agrees)),
            reason: format!(
                "written as OFF and read back by a reader of its own, {}",
                if sides.iter().all(|side| side.agrees) {
                    "both files have the vertices and facets of their shapes, number by number"
                } else {
                    "a file differs from its shape"
                }
            ),
        },
        Finding {
            claim: "The right image differs from the left: its hole is filled.".into(),
            verdict: Verdict::of(!same && filled(&shapes.plain, &shapes.barycentric)),
            reason: format!(
                "the two surfaces are {}; {} of {} pixels differ, by {} of 255 at most; b₁ and b₂ are \
                 {} and {} on the left, {} and {} on the right",
                if same {
                    "the same set of points in space, cut into triangles along other diagonals"
                } else {
                    "not the same set of points in space"
                },
                pixels.pixels,
                sides[0].picture.pixels().len(),
                pixels.largest,
                shapes.plain.numbers.betti.b1,
                shapes.plain.numbers.betti.b2,
                shapes.barycentric.numbers.betti.b1,
                shapes.barycentric.numbers.betti.b2
            ),
        },
    ];
    let commands = pair.map(|(_, shaped, name)| format!("{} -o {name}", shaped.numbers.command));
    Ok(Item {
        id: "figure-11",
        title: "Figure 11. The pair in Geomview".into(),
        paper: "The pair of Figure 10, shown by Geomview, the paper's second viewer.".into(),
        ours:
            "Drawn from the OFF files themselves, each facet in its own plane, as Geomview does. \
               The format knows facets only: singular edges and vertices are left out."
                .into(),
        picture: Some(picture),
        files: sides.iter().map(|side| side.file.clone()).collect(),
        commands: commands.into(),
        shapes: [&shapes.plain, &shapes.barycentric].map(|s| s.numbers.clone()).into(),
        facts: vec![
            Fact::count("vertices, left", sides[0].mesh.positions.len()),
            Fact::count("vertices, right", sides[1].mesh.positions.len()),
            Fact::count("facets, left", sides[0].mesh.facets.len()),
            Fact::count("facets, right", sides[1].mesh.facets.len()),
            Fact::count("pixels that differ", pixels.pixels),
            Fact::new("largest difference of a pixel (of 255)", pixels.largest.into()),
        ],
        findings,
        ..Item::default()
    })
}

fn filled(left: &Shaped, right: &Shaped) -> bool {
    let (l, r) = (left.numbers.betti, right.numbers.betti);
    r.b1 < l.b1 || r.b2 < l.b2
}

/// One of the pair.
struct Side {
    title: &'static str,
    file: String,
    mesh: OffMesh,
    picture: Picture,
    /// Whether the file says just what the shape's surface is.
    agrees: bool,
}

impl Side {
    fn new(
        bench: &mut Bench<'_>,
        title: &'static str,
        shaped: &Shaped,
        name: &str,
    ) -> Result<Self, ReproduceError> {
        let mut bytes = Vec::new();
        Off(ExportOptions { groups: true, ..ExportOptions::default() })
            .write(&shaped.shape, &mut bytes)?;
        let mesh = OffMesh::parse(&String::from_utf8_lossy(&bytes))?;
        let surface = Surface::of(&shaped.shape);
        let positions = &shaped.shape.points().positions;
        let places = surface.vertices.iter().map(|&v| positions[v as usize]);
        let agrees = places.eq(mesh.positions.iter().copied()) && surface.facets().eq(&mesh.facets);
        let picture = bench.study.stage.render(&mesh.scene(), Eye::Portrait)?;
        Ok(Self { title, file: bench.file(name, bytes), mesh, picture, agrees })
    }
}
