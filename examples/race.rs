//! Races the engines against plain CGAL on the same points and prints a table.
//!
//! `cargo run --release --example race` (about half an hour); `-- quick` for sets of up to 128 k points,
//! `-- large` for the others; `-- alpha` raises α instead; `-- triangulation` races triangulations
//! alone, against that of Gmsh (HXT), too, where `GMSH_PYTHON` names a Python that has it.
//!
//! *Plain CGAL* is `benches/plain_cgal.cc`, which this program compiles with `c++ -O3 -DNDEBUG`
//! (`CXX` names another compiler). Our engines are timed with everything they give: classes, canonical
//! order, Betti numbers, sheets, measures. Every run is a process of its own that reads the points from
//! a file, and counts must agree. Runs are interleaved, times are medians of five, ratios those of the
//! medians, and peaks the largest memory of the process, its input included.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use walpha::points::{Points, Selection, Units, difference, select, weigh};
use walpha::shape::{Engine, ShapeOptions};
use walpha::triangulation::{Maker, Sites, triangulate};
use walpha::{Alpha, Gray, Simplices, Volume, WeightedPoints, Weighting};
use walpha::{alpha_shape, volume};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error + Send + Sync>>;

const RUNS: usize = 5;
const THREADS: usize = 2;
const SMALL: [&str; 2] = ["skull@128", "random@128000"];
const LARGE: [&str; 2] = ["skull@256", "random@1000000"];

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["run", engine, points, alpha, threads, memory] => {
            run(engine, points, alpha, threads.parse()?, memory.parse().ok())
        }
        [] => shapes(&[&SMALL[..], &LARGE].concat()),
        ["quick"] => shapes(&SMALL),
        ["large"] => shapes(&LARGE),
        ["alpha"] => sweep(),
        ["triangulation"] => triangulations(),
        _ => Err("usage: race [quick|large|alpha|triangulation]".into()),
    }
}

fn shapes(sets: &[&str]) -> Result<()> {
    let race = Race::new()?;
    Race::header();
    for set in sets {
        for weighting in ["common=0", "min-max", "barycentric"] {
            if weighting == "common=0" || set.starts_with("skull") {
                race.shape(set, weighting, if set.starts_with("skull") { 10.0 } else { 1.0 })?;
            }
        }
    }
    Ok(())
}

fn sweep() -> Result<()> {
    let race = Race::new()?;
    Race::header();
    let alphas = [2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0];
    alphas.into_iter().try_for_each(|alpha| race.shape("skull@128", "common=0", alpha))
}

fn triangulations() -> Result<()> {
    let race = Race::new()?;
    println!("| set | plain CGAL | HXT | native | CGAL / native | HXT / native |");
    println!("|---|--:|--:|--:|--:|--:|");
    for set in ["skull@128", "random@128000", "skull@256", "random@1000000"] {
        let points = race.points(set, "common=0", 1.0)?;
        let plain = || race.plain(&points, "triangulation");
        let native = || run_engine("triangulation", &points, 0.0, 1, None);
        let hxt = || hxt(&points);
        let gmsh = std::env::var_os("GMSH_PYTHON").is_some();
        let runs: Vec<&dyn Fn() -> Result<Run>> =
            if gmsh { vec![&plain, &native, &hxt] } else { vec![&plain, &native] };
        let seconds: Vec<f64> = medians(&runs)?.iter().map(|run| run.seconds).collect();
        let [plain, native] = [seconds[0], seconds[1]];
        let text = |seconds: f64| format!("{seconds:.2} s");
        let hxt = seconds.get(2);
        println!(
            "| {set} | {} | {} | {} | {:.2} | {} |",
            text(plain),
            hxt.map_or("–".to_owned(), |&s| text(s)),
            text(native),
            plain / native,
            hxt.map_or("–".to_owned(), |s| format!("{:.2}", s / native)),
        );
    }
    Ok(())
}

/// What one process says.
struct Run {
    seconds: f64,
    peak: u64,
    counts: String,
}

/// Where the runners are.
struct Race {
    folder: tempfile::TempDir,
    plain: PathBuf,
}

impl Race {
    /// Compiles plain CGAL.
    fn new() -> Result<Self> {
        let folder = tempfile::tempdir()?;
        let plain = folder.path().join("plain_cgal");
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/plain_cgal.cc");
        let compiler = std::env::var_os("CXX").unwrap_or("c++".into());
        let flags = ["-std=c++17", "-O3", "-DNDEBUG", "-frounding-math", "-pthread", "-o"];
        let status = Command::new(compiler)
            .args(flags)
            .args([&plain, &source])
            .args(["-lmpfr", "-lgmp"])
            .status()?;
        if !status.success() {
            return Err("plain CGAL was not compiled".into());
        }
        Ok(Self { folder, plain })
    }

    fn header() {
        println!(
            "| set | points | weights | α | plain CGAL | cgal, 1 thread | cgal, {THREADS} | \
             native, 1 thread | native, {THREADS} | peak: plain | cgal | native | \
             native with --memory of a quarter |"
        );
        println!("|---|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    }

    fn shape(&self, set: &str, weighting: &str, alpha: f64) -> Result<()> {
        let points = self.points(set, weighting, alpha)?;
        let count = std::fs::metadata(&points)?.len() / 32;
        let plain = || self.plain(&points, &alpha.to_string());
        let points = &points;
        let by = |engine: &'static str, threads| {
            move || run_engine(engine, points, alpha, threads, None)
        };
        let (cgal, cgals) = (by("cgal", 1), by("cgal", THREADS));
        let (native, natives) = (by("native", 1), by("native", THREADS));
        let runs = medians(&[&plain, &cgal, &cgals, &native, &natives])?;
        let base = runs[0].seconds;
        let time = |k: usize| format!("{:.2} s ({:.1}×)", runs[k].seconds, base / runs[k].seconds);
        let mebibytes = |bytes: u64| format!("{} MiB", bytes >> 20);
        // A small set may not do with so little: threads and code take some, too.
        let least = run_engine("native", points, alpha, THREADS, Some(runs[0].peak / 4));
        println!(
            "| {set} | {count} | {weighting} | {alpha} | {base:.2} s | {} | {} | {} | {} | {} | {} | {} | {} |",
            time(1),
            time(2),
            time(3),
            time(4),
            mebibytes(runs[0].peak),
            mebibytes(runs[2].peak),
            mebibytes(runs[4].peak),
            least.map_or("refused".to_owned(), |run| mebibytes(run.peak)),
        );
        Ok(())
    }

    /// Writes a set as plain CGAL reads it.
    fn points(&self, set: &str, weighting: &str, alpha: f64) -> Result<PathBuf> {
        let points = weighted(set, weighting, alpha)?;
        let rows = points.positions.iter().zip(&points.weights);
        let numbers = rows.flat_map(|(p, w)| [p[0], p[1], p[2], *w]);
        let path = self.folder.path().join("points");
        std::fs::write(&path, numbers.flat_map(f64::to_le_bytes).collect::<Vec<u8>>())?;
        Ok(path)
    }

    fn plain(&self, points: &Path, what: &str) -> Result<Run> {
        output(Command::new(&self.plain).arg(points).arg(what))
    }
}

fn run_engine(
    engine: &str,
    points: &Path,
    alpha: f64,
    threads: usize,
    memory: Option<u64>,
) -> Result<Run> {
    let memory = memory.map_or("-".to_owned(), |bytes| bytes.to_string());
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["run", engine]).arg(points);
    output(command.args([alpha.to_string(), threads.to_string(), memory]))
}

/// Gmsh's parallel Delaunay triangulation, on one thread.
fn hxt(points: &Path) -> Result<Run> {
    let python = std::env::var_os("GMSH_PYTHON").ok_or("GMSH_PYTHON is not set")?;
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/race_gmsh.py");
    output(Command::new(python).arg(script).arg(points))
}

/// Runs everything in turn, several times; gives the medians of times and peaks.
fn medians(runs: &[&dyn Fn() -> Result<Run>]) -> Result<Vec<Run>> {
    let mut done: Vec<Vec<Run>> = runs.iter().map(|_| Vec::new()).collect();
    for _ in 0..RUNS {
        for (run, done) in runs.iter().zip(&mut done) {
            done.push(run()?);
        }
    }
    let counts = done[0][0].counts.clone();
    let median = |mut of: Vec<Run>| {
        assert!(of.iter().all(|run| run.counts == counts), "counts differ");
        of.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let peak = of.iter().map(|run| run.peak).max().unwrap_or(0);
        Run { peak, ..of.swap_remove(RUNS / 2) }
    };
    Ok(done.into_iter().map(median).collect())
}

/// Seconds, peak KiB, counts.
fn output(command: &mut Command) -> Result<Run> {
    let output = command.output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    let text = String::from_utf8(output.stdout)?;
    let mut words = text.split_whitespace();
    let mut word = || words.next().ok_or("seconds and a peak");
    let (seconds, peak) = (word()?.parse()?, word()?.parse::<u64>()? << 10);
    Ok(Run { seconds, peak, counts: words.collect::<Vec<_>>().join(" ") })
}

/// One engine on points from a file: prints what plain CGAL prints.
fn run(engine: &str, points: &str, alpha: &str, threads: usize, memory: Option<u64>) -> Result<()> {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    let bytes = std::fs::read(points)?;
    let number = |bytes: &[u8; 8]| f64::from_le_bytes(*bytes);
    let rows = bytes.as_chunks::<8>().0.as_chunks::<4>().0;
    let positions = rows.iter().map(|[x, y, z, _]| [x, y, z].map(number)).collect();
    let weights = rows.iter().map(|[.., w]| number(w)).collect();
    let points = WeightedPoints::new(positions, weights).unwrap();
    drop(bytes);
    let started = Instant::now();
    let engine = match engine {
        "cgal" => Engine::Cgal,
        "native" => Engine::Native,
        _ => {
            let sites = Sites::new(&points.positions, &points.weights)?;
            let made = triangulate(&sites, Maker::Native)?;
            assert!(!made.cells().is_empty());
            let seconds = started.elapsed().as_secs_f64();
            println!("{seconds} {} 0 0 0 0 0 0 0 0 0 0", peak());
            return Ok(());
        }
    };
    let alpha = Alpha::from_squared(alpha.parse()?)?;
    let options = ShapeOptions::new(alpha).engine(engine).memory(memory);
    let shape = alpha_shape(points, &options)?;
    assert!(shape.betti().is_some());
    let seconds = started.elapsed().as_secs_f64();
    let complex = shape.complex();
    println!(
        "{seconds} {} {} {} {} {}",
        peak(),
        complex.cells.len(),
        by_class(&complex.facets),
        by_class(&complex.edges),
        by_class(&complex.vertices)
    );
    Ok(())
}

fn by_class<const N: usize>(simplices: &Simplices<N>) -> String {
    let counts = simplices.counts();
    format!("{} {} {}", counts.interior, counts.regular, counts.singular)
}

/// A set by name: `skull@N` (the skull upsampled to N³ samples) or `random@N` (N random points).
fn weighted(set: &str, weighting: &str, alpha: f64) -> Result<WeightedPoints> {
    let weighting: Weighting = weighting.parse()?;
    let points = match set.split_once('@') {
        Some(("skull", size)) => skull(size.parse()?)?,
        Some((_, count)) => random(count.parse()?),
        None => return Err("no such set".into()),
    };
    Ok(weigh(&points, weighting, Alpha::from_squared(alpha)?)?)
}

fn skull(size: usize) -> Result<Points> {
    let (skull, _) = volume::sample("sample:skull")?.into_gray(Gray::Automatic)?;
    let skull = upsampled(&skull, size)?;
    let selection = Selection::default();
    Ok(select(&skull, &skull, &difference(&skull), &selection, Units::Voxel)?)
}

/// Trilinear, the first and last samples of each axis staying where they are.
fn upsampled(volume: &Volume, size: usize) -> Result<Volume> {
    let samples = volume.samples();
    let place = |i: usize, n: usize| {
        let at = i as f64 * (n - 1) as f64 / (size - 1) as f64;
        let low = (at as usize).min(n - 2);
        (low, at - low as f64)
    };
    let [nx, ny, nz] = volume.dims().xyz();
    let upsampled = ndarray::Array3::from_shape_fn((size, size, size), |(z, y, x)| {
        let ((z, fz), (y, fy), (x, fx)) = (place(z, nz), place(y, ny), place(x, nx));
        let mut sum = 0.0;
        for (dz, wz) in [(0, 1.0 - fz), (1, fz)] {
            for (dy, wy) in [(0, 1.0 - fy), (1, fy)] {
                for (dx, wx) in [(0, 1.0 - fx), (1, fx)] {
                    sum += wz * wy * wx * f64::from(samples[[z + dz, y + dy, x + dx]]);
                }
            }
        }
        sum as f32
    });
    Ok(Volume::new(upsampled, *volume.frame())?.with_gray_levels())
}

/// Points in a cube, one in each unit of volume on average, from a fixed linear congruence.
fn random(count: usize) -> Points {
    let side = (count as f64).cbrt();
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64 * side
    };
    let positions = (0..count).map(|_| [next(), next(), next()]).collect();
    Points::new(positions)
}

/// The most memory this process ever held, in KiB; 0 where the system does not say.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse().ok()).unwrap_or(0)
}
