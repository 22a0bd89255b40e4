//! Races the engines against plain CGAL on the same points and prints a table.
//!
//! `cargo run --release --example race` (about half an hour); `-- quick` for sets of up to 128 k points,
//! `-- large` for the others; `-- alpha` raises α instead; `-- triangulation` races triangulations
//! alone, against that of Gmsh (HXT), too, where `GMSH_PYTHON` names a Python that has it; `-- filtration`
//! races filtrations against whole shapes of our own (add `quick` for the small sets).
//!
//! *Plain CGAL* is `benches/plain_cgal.cc`, which this program compiles with `c++ -O3 -DNDEBUG`
//! (`CXX` names another compiler). Our engines are timed with everything they give: classes, canonical
//! order, Betti numbers, sheets, measures. Every run is a process of its own that reads the points from
//! a file, and counts must agree. Runs are interleaved, times are medians of five, ratios those of the
//! medians, and peaks the largest memory of the process, its input included.

mod engine;
mod processes;
mod sets;

use std::path::{Path, PathBuf};
use std::process::Command;

use engine::run;
use processes::{Run, medians, output};
use sets::weighted;

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
        ["filtration"] => filtrations(&[&SMALL[..], &LARGE].concat()),
        ["filtration", "quick"] => filtrations(&SMALL),
        _ => Err("usage: race [quick|large|alpha|triangulation|filtration [quick]]".into()),
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

/// A filtration, and with it the order of all simplices, against the shape of the whole triangulation.
fn filtrations(sets: &[&str]) -> Result<()> {
    let race = Race::new()?;
    println!("| set | weights | whole shape | filtration | in order | peak: whole | in order |");
    println!("|---|---|--:|--:|--:|--:|--:|");
    for set in sets {
        let weighting = if set.starts_with("skull") { "min-max" } else { "common=0" };
        let points = race.points(set, weighting, 10.0)?;
        let by = |what: &'static str| {
            let points = &points;
            move || run_engine(what, points, f64::INFINITY, THREADS, None)
        };
        let runs = medians(&[&by("whole"), &by("filtration"), &by("order")])?;
        let [whole, filtration, order] = &runs[..] else { unreachable!("three were run") };
        let time =
            |run: &Run| format!("{:.2} s ({:.2}×)", run.seconds, run.seconds / whole.seconds);
        println!(
            "| {set} | {weighting} | {:.2} s | {} | {} | {} MiB | {} MiB |",
            whole.seconds,
            time(filtration),
            time(order),
            whole.peak >> 20,
            order.peak >> 20,
        );
    }
    Ok(())
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
            "| set | points | weights | α | plain CGAL | cgal | native, 1 thread | native, {THREADS} | \
             peak: plain | cgal | native | native with --memory of a quarter |"
        );
        println!("|---|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    }

    fn shape(&self, set: &str, weighting: &str, alpha: f64) -> Result<()> {
        let points = self.points(set, weighting, alpha)?;
        let count = std::fs::metadata(&points)?.len() / 32;
        let plain = || self.plain(&points, &alpha.to_string());
        let points = &points;
        let by = |engine: &'static str, threads| {
            move || run_engine(engine, points, alpha, threads, None)
        };
        let (cgal, native, natives) = (by("cgal", THREADS), by("native", 1), by("native", THREADS));
        let runs = medians(&[&plain, &cgal, &native, &natives])?;
        let base = runs[0].seconds;
        let time = |k: usize| format!("{:.2} s ({:.1}×)", runs[k].seconds, base / runs[k].seconds);
        let mebibytes = |bytes: u64| format!("{} MiB", bytes >> 20);
        // A small set may not do with so little: threads and code take some, too.
        let least = run_engine("native", points, alpha, THREADS, Some(runs[0].peak / 4));
        println!(
            "| {set} | {count} | {weighting} | {alpha} | {base:.2} s | {} | {} | {} | {} | {} | {} | {} |",
            time(1),
            time(2),
            time(3),
            mebibytes(runs[0].peak),
            mebibytes(runs[1].peak),
            mebibytes(runs[3].peak),
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
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/race_gmsh.py");
    output(Command::new(python).arg(script).arg(points))
}
