use super::bench::{Bench, figure};
use super::bench::{Claim, judge};
use crate::export::{ExportOptions, Exporter, Off};
use crate::render::{Figure, Panel, Picture};
use crate::reproduce::compare::{PixelDifference, same_set};
use crate::reproduce::off::OffMesh;
use crate::reproduce::study::{ALPHA, Eye, panel};
use crate::reproduce::study::{Shaped, Shared};
use crate::reproduce::{Fact, Item, ReproduceError, Verdict};
use crate::shape::{Betti, Surface};

/// The pair, read back from its files.
struct Evidence {
    /// Left and right.
    sides: [Side; 2],
    /// The difference of their pictures.
    pixels: PixelDifference,
    /// Whether they are the same set of points in space.
    same: bool,
    /// Left and right.
    betti: [Betti; 2],
}

impl Evidence {
    fn of(bench: &mut Bench<'_>) -> Result<Self, ReproduceError> {
        let (plain, barycentric) =
            (&bench.shapes[Shared::Plain], &bench.shapes[Shared::Barycentric]);
        let left = Side::new(bench, "ω = 0", plain, LEFT)?;
        let right = Side::new(bench, "barycentric, equation 4.2", barycentric, RIGHT)?;
        Ok(Self {
            pixels: PixelDifference::between(&left.picture, &right.picture),
            same: same_set(&plain.shape, &barycentric.shape),
            betti: [plain.numbers.betti, barycentric.numbers.betti],
            sides: [left, right],
        })
    }

    /// Whether both files contain exactly the surfaces of the shapes.
    fn agrees(&self) -> bool {
        self.sides.iter().all(|side| side.agrees)
    }

    /// Whether the right shape differs and has fewer tunnels or voids.
    fn filled(&self) -> bool {
        let [left, right] = &self.betti;
        !self.same && (right.b1 < left.b1 || right.b2 < left.b2)
    }

    fn facts(&self) -> Vec<Fact> {
        let [left, right] = &self.sides;
        vec![
            Fact::count("vertices, left", left.mesh.positions.len()),
            Fact::count("vertices, right", right.mesh.positions.len()),
            Fact::count("facets, left", left.mesh.facets.len()),
            Fact::count("facets, right", right.mesh.facets.len()),
            Fact::count("pixels that differ", self.pixels.pixels),
            Fact::new("largest difference of a pixel (of 255)", self.pixels.largest.into()),
        ]
    }
}

const LEFT: &str = "figure-11-left.off";
const RIGHT: &str = "figure-11-right.off";

const CLAIMS: [Claim<Evidence>; 2] = [
    Claim {
        text: "The shapes can be shown by a second program, Geomview.",
        decide: |e| {
            let reason = format!(
                "written as OFF and read back by a reader of its own, {}",
                if e.agrees() {
                    "both files have the vertices and facets of their shapes, number by number"
                } else {
                    "a file differs from its shape"
                }
            );
            (Verdict::of(e.agrees()), reason)
        },
    },
    Claim {
        text: "The right image differs from the left: its hole is filled.",
        decide: |e| {
            let [left, right] = &e.betti;
            let reason = format!(
                "the two surfaces are {}; {} of {} pixels differ, by {} of 255 at most; b₁ and b₂ are \
                 {} and {} on the left, {} and {} on the right",
                if e.same {
                    "the same set of points in space, cut into triangles along other diagonals"
                } else {
                    "not the same set of points in space"
                },
                e.pixels.pixels,
                e.sides[0].picture.pixels().len(),
                e.pixels.largest,
                left.b1,
                left.b2,
                right.b1,
                right.b2
            );
            (Verdict::of(e.filled()), reason)
        },
    },
];

/// Figure 11: the pair of Figure 10 as files for Geomview, drawn from these files.
pub(super) fn figure_11(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let evidence = Evidence::of(bench)?;
    let title = format!("Figure 11. The pair as OFF files, read back; α = {ALPHA}");
    let panels = evidence.sides.iter().map(Side::panel).collect();
    let drawn = Figure { legend: Vec::new(), ..figure(&title, panels) };
    let shown = [Shared::Plain, Shared::Barycentric].map(|shared| &bench.shapes[shared]);
    Ok(Item {
        title: "Figure 11. The pair in Geomview".into(),
        paper: "The pair of Figure 10, shown by Geomview, the paper's second viewer.".into(),
        ours:
            "Drawn from the OFF files themselves, each facet in its own plane, as Geomview does. \
               The format knows facets only: singular edges and vertices are left out."
                .into(),
        picture: Some(bench.file("figure-11.png", drawn.to_png()?)),
        files: evidence.sides.iter().map(|side| side.file.clone()).collect(),
        commands: shown
            .iter()
            .zip([LEFT, RIGHT])
            .map(|(shaped, file)| shaped.makes(file) + " --groups")
            .collect(),
        shapes: shown.map(|shaped| shaped.numbers.clone()).into(),
        facts: evidence.facts(),
        findings: judge(&CLAIMS, &evidence),
        ..Item::default()
    })
}

/// One of the pair.
struct Side {
    title: &'static str,
    file: String,
    mesh: OffMesh,
    picture: Picture,
    /// Whether the file contains exactly the surface of the shape.
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
        Off(ExportOptions::default().groups(true)).write(&shaped.shape, &mut bytes)?;
        let mesh = OffMesh::parse(&String::from_utf8_lossy(&bytes))?;
        let surface = Surface::of(&shaped.shape);
        let positions = shaped.shape.points().positions();
        let places = surface.vertices.iter().map(|&v| positions[v as usize]);
        let agrees = places.eq(mesh.positions.iter().copied()) && surface.facets().eq(&mesh.facets);
        let picture = bench.study.cameras.render(&mesh.scene(), Eye::Portrait)?;
        Ok(Self { title, file: bench.file(name, bytes), mesh, picture, agrees })
    }

    fn panel(&self) -> Panel {
        let Self { file, mesh, .. } = self;
        let (vertices, facets) = (mesh.positions.len(), mesh.facets.len());
        let caption = format!("{file}: {vertices} vertices, {facets} facets");
        panel(self.title, self.picture.clone(), vec![caption])
    }
}
