//! The contestants.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use serde_json::Value;

use super::Result;
use super::processes::{Run, output, run};

/// A program with its arguments.
pub(super) struct Contestant {
    pub name: String,
    pub run: Box<dyn Fn() -> Result<Run>>,
}

impl Contestant {
    fn new(program: &str, threads: usize, command: impl Fn() -> Command + 'static) -> Self {
        Self { name: named(program, threads), run: Box::new(move || run(&mut command())) }
    }
}

fn named(program: &str, threads: usize) -> String {
    format!("{program}, {threads} thread{}", if threads == 1 { "" } else { "s" })
}

/// Our engine, in this program ([`engine`](super::engine)).
pub(super) fn native(what: &'static str, points: &Path, alpha: &str, threads: usize) -> Contestant {
    let (points, alpha) = (points.to_owned(), alpha.to_owned());
    Contestant::new(what, threads, move || {
        let mut command =
            Command::new(std::env::current_exe().expect("the program knows its file"));
        command.args(["run", what]).arg(&points).args([&alpha, &threads.to_string()]);
        command
    })
}

/// `walpha shape` with its default report, as JSON; `None` where it was not built.
pub(super) fn command(points: &Path, alpha: &str, threads: usize) -> Option<Contestant> {
    let walpha = std::env::current_exe().ok()?.with_file_name("walpha");
    if !walpha.is_file() {
        return None;
    }
    let (points, alpha) = (points.with_extension("npy"), alpha.to_owned());
    let run = move || {
        let mut command = Command::new(&walpha);
        command.arg("shape").arg(&points).args(["--columns", "x,y,z,weight"]);
        command.args(["--alpha", &alpha, "--json", "--threads"]);
        let (text, process) = output(command.arg(threads.to_string()))?;
        let report: Value = serde_json::from_str(&text)?;
        let shape = &report["shape"];
        let mut counts = vec![shape["cells"]["interior"].to_string()];
        for kind in ["facets", "edges", "vertices"] {
            let of = |class| shape[kind][class].to_string();
            counts.extend(["interior", "regular", "singular"].map(of));
        }
        let number = |value: &Value| value.as_f64().ok_or("a report has seconds and a peak");
        Ok(Run {
            process,
            work: number(&report["seconds"]["total"])?,
            peak: number(&report["peak_memory_bytes"])? as u64,
            counts: counts.join(" "),
        })
    };
    Some(Contestant { name: named("walpha shape", threads), run: Box::new(run) })
}

/// Programs of others, compiled.
pub(super) struct Peers {
    plain: PathBuf,
    parallel: Option<PathBuf>,
    geogram: Option<PathBuf>,
    _folder: tempfile::TempDir,
}

impl Peers {
    /// Compiles them, and says which cannot be had.
    pub(super) fn new() -> Result<Self> {
        let folder = tempfile::tempdir()?;
        let program = |name: &str| folder.path().join(name);
        let flags = ["-DNDEBUG", "-frounding-math"];
        let plain = program("plain_cgal");
        compile("plain_cgal.cc", &plain, &flags, &["-lmpfr", "-lgmp"])?;
        let parallel = Some(program("parallel_cgal")).filter(|program| {
            let flags = [&flags[..], &["-DCGAL_LINKED_WITH_TBB"]].concat();
            let libraries = ["-lmpfr", "-lgmp", "-ltbb", "-ltbbmalloc"];
            take_part("CGAL with TBB", compile("plain_cgal.cc", program, &flags, &libraries))
        });
        let geogram = std::env::var_os("GEOGRAM").map(PathBuf::from);
        let geogram = geogram
            .map(|wheel| (wheel, program("geogram")))
            .filter(|(wheel, program)| take_part("Geogram", compile_geogram(wheel, program)));
        let geogram = geogram.map(|(_, program)| program);
        Ok(Self { plain, parallel, geogram, _folder: folder })
    }

    /// Plain CGAL; `what` is α, or `triangulation`.
    pub(super) fn plain(&self, points: &Path, what: &str) -> Contestant {
        Self::cgal("plain CGAL", &self.plain, points, what, 1)
    }

    /// Plain CGAL with its parallel triangulation.
    pub(super) fn parallel(&self, points: &Path, what: &str, threads: usize) -> Option<Contestant> {
        let program = self.parallel.as_ref()?;
        Some(Self::cgal("plain CGAL with TBB", program, points, what, threads))
    }

    fn cgal(name: &str, program: &Path, points: &Path, what: &str, threads: usize) -> Contestant {
        let (program, points, what) = (program.to_owned(), points.to_owned(), what.to_owned());
        Contestant::new(name, threads, move || {
            let mut command = Command::new(&program);
            command.arg(&points).args([&what, &threads.to_string()]);
            command
        })
    }

    /// Geogram's regular triangulation, whose lifting rounds weights: its parallel one on several threads.
    pub(super) fn geogram(&self, points: &Path, threads: usize) -> Option<Contestant> {
        let (program, points) = (self.geogram.clone()?, points.to_owned());
        Some(Contestant::new("Geogram", threads, move || {
            let mut command = Command::new(&program);
            command.arg(&points).arg(threads.to_string());
            command
        }))
    }

    /// Voronota-LT in Rust: contacts, areas and volumes of balls, without bounds. It writes them as JSON, which takes most of its process; its
    /// seconds of work leave that out.
    pub(super) fn voronota(points: &Path, threads: usize) -> Option<Contestant> {
        let (program, points) = (std::env::var_os("VORONOTA")?, points.with_extension("xyzr"));
        let run = move || {
            let mut command = Command::new(&program);
            command.args(["--measure-running-time", "-o", "/dev/null", "--processors"]);
            let started = Instant::now();
            let output = command.arg(threads.to_string()).arg(&points).output()?;
            let process = started.elapsed().as_secs_f64();
            let log = String::from_utf8_lossy(&output.stderr);
            let work =
                log.split("Tessellation time: ").nth(1).and_then(|rest| rest.split(' ').next());
            let work: f64 = work.ok_or_else(|| format!("no time in {log}"))?.parse()?;
            Ok(Run { process, work: work / 1000.0, peak: 0, counts: String::new() })
        };
        Some(Contestant { name: named("voronota-ltr", threads), run: Box::new(run) })
    }

    /// Gmsh's triangulation (HXT), without weights.
    pub(super) fn hxt(points: &Path, threads: usize) -> Option<Contestant> {
        let (python, points) = (std::env::var_os("GMSH_PYTHON")?, points.to_owned());
        Some(Contestant::new("HXT (Gmsh)", threads, move || {
            let mut command = Command::new(&python);
            command.arg(bench("race_gmsh.py")).arg(&points).arg(threads.to_string());
            command
        }))
    }
}

fn bench(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn take_part(name: &str, compiled: Result<()>) -> bool {
    if let Err(error) = &compiled {
        eprintln!("{name} does not take part: {error}");
    }
    compiled.is_ok()
}

fn compile(
    source: &str,
    program: &Path,
    flags: &[&str],
    libraries: &[impl AsRef<std::ffi::OsStr>],
) -> Result<()> {
    let mut compiler = Command::new(std::env::var_os("CXX").unwrap_or("c++".into()));
    compiler.args(["-std=c++17", "-O3", "-pthread"]).args(flags).arg("-o").arg(program);
    let output = compiler.arg(bench(source)).args(libraries).output()?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        let first = text.lines().find(|line| line.contains("error")).unwrap_or(&text);
        return Err(format!("{source} does not compile: {first}").into());
    }
    Ok(())
}

/// The wheel has headers, a static library, and TBB.
fn compile_geogram(wheel: &Path, program: &Path) -> Result<()> {
    let libraries = wheel.join("geogram.libs");
    let tbb = std::fs::read_dir(&libraries)?.flatten().map(|entry| entry.path());
    let tbb = tbb.into_iter().find(|path| path.to_string_lossy().contains("libtbb-"));
    let include = format!("-I{}", wheel.join("include/geogram1").display());
    let flags = ["-march=native", "-fopenmp", "-DGEOGRAM_WITH_PDEL", &include];
    let rpath = format!("-Wl,-rpath,{}", libraries.display());
    let mut libraries = vec![wheel.join("lib64/libgeogram.a")];
    libraries.extend(tbb);
    libraries.extend([&rpath, "-ldl"].map(PathBuf::from));
    compile("race_geogram.cc", program, &flags, &libraries)
}
