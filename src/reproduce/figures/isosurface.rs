use super::super::stage::{Eye, panel};
use super::super::study::{PAPER_POINTS, PAPER_SAMPLES, Study};
use super::super::{Fact, Finding, Item, ReproduceError, Table, Verdict};
use super::{Bench, VIEWS, figure};
use crate::points::difference;
use crate::render::{Figure, Isosurface, Scene};
use crate::volume::Volume;

/// The paper's threshold, in gray levels.
const THRESHOLD: f64 = 50.0;
/// The data reduction rate the paper prints, in percent.
const PRINTED_PERCENT: &str = "6.07";

/// Figure 5: the volume itself, as an isosurface, and what it costs in samples.
pub(super) fn figure_5(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let study = bench.study;
    let volume = study.subject.volume;
    let surface = Isosurface::new(volume.samples(), THRESHOLD)?;
    let (vertices, triangles) = (surface.positions.len(), surface.triangles.len());
    let (read, beside, area) = (surface.samples_read, surface.samples_beside, surface.area());
    let scene = Scene { meshes: vec![surface.into_mesh()], ..Scene::default() };
    let front = study.stage.render(&scene, Eye::Portrait)?;
    let side = study.stage.render(&scene, Eye::Side)?;
    let title = format!("Figure 5. The volume: isosurface at gray level {THRESHOLD}");
    let captions = vec![
        format!("marching cubes: {triangles} triangles, from all {read} samples"),
        format!("{beside} of them lie beside the surface"),
    ];
    let panels = vec![panel(VIEWS[0], front, captions), panel(VIEWS[1], side, Vec::new())];
    let drawn = Figure { legend: Vec::new(), ..figure(&title, panels) };
    let picture = bench.file("figure-05.png", drawn.to_png()?);

    let points = study.points.len();
    let in_shape = bench.shapes.plain.numbers.points_in_shape;
    let samples = volume.dims().samples();
    let fraction = 100.0 * PAPER_POINTS as f64 / PAPER_SAMPLES as f64;
    let rounded = format!("{fraction:.2}");
    let (readings, any) = readings(study, fraction);
    let findings = vec![
        Finding {
            claim:
                "Marching cubes needs all of the data points, alpha shapes only the selected ones."
                    .into(),
            verdict: Verdict::of(read == samples && points < samples),
            reason: format!(
                "marching cubes reads {read} of {samples} samples, and even if it knew where the \
                 surface is it would need {beside}; the shape is made of {points} points. Selecting \
                 them reads every sample once, though: the saving is in what is kept and \
                 triangulated"
            ),
        },
        Finding {
            claim: format!(
                "The data reduction rate is {PAPER_POINTS}/{PAPER_SAMPLES} = {PRINTED_PERCENT} %."
            ),
            verdict: Verdict::of(rounded == PRINTED_PERCENT),
            reason: format!(
                "{PAPER_POINTS}/{PAPER_SAMPLES} is {fraction:.3} %, which rounds to {rounded} %"
            ),
        },
        Finding {
            claim: format!("The threshold value is {THRESHOLD} in the range from 0 to 255."),
            verdict: if any { Verdict::Reproduced } else { Verdict::Undecided },
            reason: if any {
                format!("one reading of it leaves {fraction:.2} % of the samples, see the table")
            } else {
                format!(
                    "the paper does not say what is held against {THRESHOLD}, and no reading we \
                     tried leaves {PRINTED_PERCENT} or {fraction:.2} % of the samples of this \
                     volume, see the table"
                )
            },
        },
    ];
    Ok(Item {
        id: "figure-5",
        title: "Figure 5. The original image".into(),
        paper: format!(
            "The skull of 64 × 64 × 64 samples. The threshold value is {THRESHOLD} in the range from \
             0 to 255. Marching cubes needs all of the data points, alpha shapes {PRINTED_PERCENT} % \
             only."
        ),
        ours: format!(
            "The isosurface of the original gray levels at {THRESHOLD}, by marching cubes: \
             {vertices} vertices, {triangles} triangles."
        ),
        picture: Some(picture),
        commands: vec![bench.reproduce_command()],
        facts: vec![
            Fact::count("samples that marching cubes reads", read),
            Fact::count("samples beside the surface", beside),
            Fact::count("points that the shape is made of", points),
            Fact::count("points in the shape of Figure 6", in_shape),
            Fact::count("triangles of the isosurface", triangles),
            Fact::new("area of the isosurface (voxels²)", area),
        ],
        tables: vec![readings],
        findings,
        ..Item::default()
    })
}

/// What a threshold of 50 may be held against, how much each leaves, and whether one leaves as
/// much as the paper says.
fn readings(study: &Study<'_>, fraction: f64) -> (Table, bool) {
    let samples = study.subject.volume.as_slice().len();
    let least = THRESHOLD;
    let differences = difference(&study.smoothed);
    let squares = root_mean_square_difference(&study.smoothed);
    let count = |values: &mut dyn Iterator<Item = f64>| values.filter(|&v| v >= least).count();
    let gray = |volume: &Volume| count(&mut volume.as_slice().iter().map(|&v| f64::from(v)));
    let readings = [
        ("original gray level", gray(study.subject.volume)),
        ("gray level after truncation", gray(&study.smoothed)),
        ("L, the mean of the six differences", count(&mut differences.iter().copied())),
        ("the sum of the six differences", count(&mut differences.iter().map(|l| 6.0 * l))),
        ("the root mean square of the six differences", count(&mut squares.iter().copied())),
    ];
    let percent = |n: usize| 100.0 * n as f64 / samples as f64;
    let paper: f64 = PRINTED_PERCENT.parse().expect("a number");
    let near = |n: usize| [paper, fraction].iter().any(|p| (percent(n) - p).abs() < 0.005);
    let table = Table {
        caption: format!("Samples of at least {THRESHOLD}, by what that may mean"),
        head: ["quantity", "samples", "share (%)"].map(String::from).into(),
        rows: readings
            .iter()
            .map(|&(name, n)| vec![name.into(), n.to_string(), format!("{:.3}", percent(n))])
            .collect(),
    };
    (table, readings.iter().any(|&(_, n)| near(n)))
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
