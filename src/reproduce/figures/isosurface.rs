use super::bench::{Bench, VIEWS, figure};
use super::bench::{Claim, judge};
use crate::pipeline::paper;
use crate::points::difference;
use crate::render::{Figure, Isosurface, Scene};
use crate::reproduce::study::{Eye, panel};
use crate::reproduce::study::{Shared, Study};
use crate::reproduce::{Fact, Item, ReproduceError, Table, Verdict};
use crate::volume::Volume;

/// The paper's threshold, in gray levels.
const THRESHOLD: f64 = 50.0;
/// The data reduction rate the paper prints, in percent.
const PRINTED_PERCENT: &str = "6.07";
/// The rate that follows from its own numbers.
const COMPUTED_PERCENT: f64 = 100.0 * paper::POINTS as f64 / paper::SAMPLES as f64;

/// Numbers of the isosurface and of the shape.
struct Evidence {
    samples: usize,
    /// Samples that marching cubes reads.
    read: usize,
    /// The read samples that are next to the surface.
    beside: usize,
    vertices: usize,
    triangles: usize,
    /// Area of the isosurface in squared voxels.
    area: f64,
    points: usize,
    points_in_shape: usize,
    /// The quantities that the threshold may refer to, and the number of samples that each leaves.
    readings: [(&'static str, usize); 5],
}

impl Evidence {
    fn of(bench: &Bench<'_>, surface: &Isosurface) -> Self {
        let study = bench.study;
        Self {
            samples: study.subject.volume.dims().samples(),
            read: surface.samples_read,
            beside: surface.samples_at_surface,
            vertices: surface.positions.len(),
            triangles: surface.triangles.len(),
            area: surface.area(),
            points: study.points.len(),
            points_in_shape: bench.shapes[Shared::Plain].numbers.points_in_shape,
            readings: readings(study),
        }
    }

    /// A count of samples as a share of them all.
    fn percent(&self, samples: usize) -> f64 {
        100.0 * samples as f64 / self.samples as f64
    }

    /// Whether one interpretation of the threshold leaves as many samples as the paper states.
    fn is_as_printed(&self) -> bool {
        let paper: f64 = PRINTED_PERCENT.parse().expect("a number");
        let near =
            |n| [paper, COMPUTED_PERCENT].iter().any(|p| (self.percent(n) - p).abs() < 0.005);
        self.readings.iter().any(|&(_, n)| near(n))
    }

    fn table(&self) -> Table {
        let row = |&(name, n): &(&str, usize)| {
            vec![name.into(), n.to_string(), format!("{:.3}", self.percent(n))]
        };
        Table {
            caption: format!("Samples of at least {THRESHOLD}, by what that may mean"),
            head: ["quantity", "samples", "share (%)"].map(String::from).into(),
            rows: self.readings.iter().map(row).collect(),
        }
    }

    fn facts(&self) -> Vec<Fact> {
        vec![
            Fact::count("samples that marching cubes reads", self.read),
            Fact::count("samples beside the surface", self.beside),
            Fact::count("points that the shape is made of", self.points),
            Fact::count("points in the shape of Figure 6", self.points_in_shape),
            Fact::count("triangles of the isosurface", self.triangles),
            Fact::new("area of the isosurface (voxels²)", self.area),
        ]
    }
}

const CLAIMS: [Claim<Evidence>; 3] = [
    Claim {
        text: "Marching cubes needs all of the data points, alpha shapes only the selected ones.",
        decide: |&Evidence { samples, read, beside, points, .. }| {
            let reason = format!(
                "marching cubes reads {read} of {samples} samples, and even if it knew where the \
                 surface is it would need {beside}; the shape is made of {points} points. Selecting \
                 them reads every sample once, though: the saving is in what is kept and \
                 triangulated"
            );
            (Verdict::of(read == samples && points < samples), reason)
        },
    },
    Claim {
        text: "The data reduction rate is 15956/262144 = 6.07 %.",
        decide: |_| {
            let rounded = format!("{COMPUTED_PERCENT:.2}");
            let reason = format!(
                "{}/{} is {COMPUTED_PERCENT:.3} %, which rounds to {rounded} %",
                paper::POINTS,
                paper::SAMPLES
            );
            (Verdict::of(rounded == PRINTED_PERCENT), reason)
        },
    },
    Claim {
        text: "The threshold value is 50 in the range from 0 to 255.",
        decide: |e| {
            if e.is_as_printed() {
                let reason = format!(
                    "one reading of it leaves {COMPUTED_PERCENT:.2} % of the samples, see the table"
                );
                return (Verdict::Reproduced, reason);
            }
            let reason = format!(
                "the paper does not say what is held against {THRESHOLD}, and no reading we tried \
                 leaves {PRINTED_PERCENT} or {COMPUTED_PERCENT:.2} % of the samples of this volume, \
                 see the table"
            );
            (Verdict::Undecided, reason)
        },
    },
];

/// Figure 5: the volume itself, as an isosurface, and what it costs in samples.
pub(super) fn figure_5(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let surface = Isosurface::new(bench.study.subject.volume.samples(), THRESHOLD)?;
    let evidence = Evidence::of(bench, &surface);
    let drawn = draw(bench.study, &evidence, surface)?;
    Ok(Item {
        title: "Figure 5. The original image".into(),
        paper: format!(
            "The skull of 64 × 64 × 64 samples. The threshold value is {THRESHOLD} in the range from \
             0 to 255. Marching cubes needs all of the data points, alpha shapes {PRINTED_PERCENT} % \
             only."
        ),
        ours: format!(
            "The isosurface of the original gray levels at {THRESHOLD}, by marching cubes: \
             {} vertices, {} triangles.",
            evidence.vertices, evidence.triangles
        ),
        picture: Some(bench.file("figure-05.png", drawn.to_png()?)),
        facts: evidence.facts(),
        tables: vec![evidence.table()],
        findings: judge(&CLAIMS, &evidence),
        ..Item::default()
    })
}

fn draw(
    study: &Study<'_>,
    &Evidence { triangles, read, beside, .. }: &Evidence,
    surface: Isosurface,
) -> Result<Figure, ReproduceError> {
    let scene = Scene { meshes: vec![surface.into_mesh()], ..Scene::default() };
    let front = study.cameras.render(&scene, Eye::Portrait)?;
    let side = study.cameras.render(&scene, Eye::Side)?;
    let captions = vec![
        format!("marching cubes: {triangles} triangles, from all {read} samples"),
        format!("{beside} of them lie beside the surface"),
    ];
    let panels = vec![panel(VIEWS[0], front, captions), panel(VIEWS[1], side, Vec::new())];
    let title = format!("Figure 5. The volume: isosurface at gray level {THRESHOLD}");
    Ok(Figure { legend: Vec::new(), ..figure(&title, panels) })
}

/// The quantities that a threshold of 50 may refer to, and the number of samples that each leaves.
fn readings(study: &Study<'_>) -> [(&'static str, usize); 5] {
    let least = THRESHOLD;
    let differences = difference(&study.smoothed);
    let squares = root_mean_square_difference(&study.smoothed);
    let count = |values: &mut dyn Iterator<Item = f64>| values.filter(|&v| v >= least).count();
    let gray = |volume: &Volume| count(&mut volume.as_slice().iter().map(|&v| f64::from(v)));
    [
        ("original gray level", gray(study.subject.volume)),
        ("gray level after truncation", gray(&study.smoothed)),
        ("L, the mean of the six differences", count(&mut differences.iter().copied())),
        ("the sum of the six differences", count(&mut differences.iter().map(|l| 6.0 * l))),
        ("the root mean square of the six differences", count(&mut squares.iter().copied())),
    ]
}

/// √(Σ d²/6) over the differences to the six neighbours: "averaged L² norm" taken literally.
fn root_mean_square_difference(volume: &Volume) -> Vec<f64> {
    let samples = volume.samples();
    let of = |((z, y, x), &here): ((usize, usize, usize), &f32)| {
        let neighbours = [
            (z.wrapping_sub(1), y, x),
            (z + 1, y, x),
            (z, y.wrapping_sub(1), x),
            (z, y + 1, x),
            (z, y, x.wrapping_sub(1)),
            (z, y, x + 1),
        ];
        let square =
            |at| samples.get(at).map_or(0.0, |&v| (f64::from(v) - f64::from(here)).powi(2));
        (neighbours.into_iter().map(square).sum::<f64>() / 6.0).sqrt()
    };
    samples.indexed_iter().map(of).collect()
}
