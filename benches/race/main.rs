//! Races our engine against other programs on the same points, and prints tables:
//!
//! ```text
//! cargo build --release && cargo run --release -p walpha-benches -- shapes
//! cargo run --release -p walpha-benches -- triangulations
//! cargo run --release -p walpha-benches -- filtrations
//! cargo run --release -p walpha-benches -- balls
//! ```
//!
//! Sets follow, of those in `sets.rs`; without any, those of the README. `alpha` races shapes at growing α, `scale` our
//! engine on 1 to 16 threads and 10⁴ to 10⁷ points.
//!
//! - *plain CGAL* is `benches/plain_cgal.cc`, compiled here with `c++ -O3 -DNDEBUG` (`CXX` names another compiler); *with TBB* is
//!   the same on CGAL's parallel triangulation (Debian: `libtbb-dev`).
//! - *Geogram* is `benches/race_geogram.cc`, where `GEOGRAM` names the folder that its wheel was unzipped to.
//! - *HXT* is Gmsh's triangulation, where `GMSH_PYTHON` names a Python that has Gmsh.
//! - *voronota-ltr* is Voronota-LT in Rust, where `VORONOTA` names the program (`cargo install voronota-ltr`).
//! - *walpha shape* is the command, where `target/release/walpha` was built.
//!
//! Every run is a separate process that reads the points from a file. The time is that of the process, by the clock, and in
//! brackets the time of the work alone: from points in memory to the result, for us with everything that a shape has (classes,
//! canonical order, Betti numbers, sheets, measures). If two contestants give counts of simplices, these must agree. Runs are
//! interleaved, times are medians of five, and peaks the most memory of a process, including its input.

mod engine;
mod peers;
mod processes;
mod sets;

use std::path::Path;

use engine::run;
use peers::{Contestant, Peers, command, native};
use processes::{Run, medians};
use sets::{Set, write};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error + Send + Sync>>;

const THREADS: usize = 2;

const USAGE: &str = "usage: race shapes|triangulations|filtrations|balls|alpha|scale [SET…], where SET is skull@N, scan@N, random@N, \
     terrain@N, atoms@N or sphere@N, with :min-max, :barycentric or :common=C for weights";

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (race, sets) = arguments.split_first().ok_or(USAGE)?;
    let sets = |default: &[&str]| -> Result<Vec<Set>> {
        let named: Vec<&str> = sets.iter().map(String::as_str).collect();
        (if named.is_empty() { default } else { &named }).iter().map(|set| set.parse()).collect()
    };
    match race.as_str() {
        // A process of its own.
        "run" => run(&arguments[1..]),
        "shapes" => {
            shapes(&sets(&["skull@256:min-max", "skull@256", "scan@256", "random@1000000"])?)
        }
        "triangulations" => triangulations(&sets(&[
            "skull@256:min-max",
            "skull@256",
            "random@1000000",
            "terrain@1000000",
            "sphere@100000",
        ])?),
        "filtrations" => filtrations(&sets(&["skull@256:min-max", "random@1000000"])?),
        "balls" => balls(&sets(&["atoms@3545", "atoms@9745", "atoms@341075"])?),
        "alpha" => alpha(&sets(&["skull@128"])?),
        "scale" => {
            scale(&sets(&["random@10000", "random@100000", "random@1000000", "random@10000000"])?)
        }
        _ => Err(USAGE.into()),
    }
}

/// Shapes at the α of each set: the command, our engine, CGAL on one thread and on all.
fn shapes(sets: &[Set]) -> Result<()> {
    let peers = Peers::new()?;
    table(sets, |set, points| {
        let alpha = set.alpha().to_string();
        let mut contestants = vec![
            native("native", points, &alpha, THREADS),
            native("native", points, &alpha, 1),
            peers.plain(points, &alpha),
        ];
        contestants.extend(command(points, &alpha, THREADS));
        contestants.extend(peers.parallel(points, &alpha, THREADS));
        contestants
    })
}

/// Triangulations alone. HXT and Geogram break ties otherwise; HXT takes no weights.
fn triangulations(sets: &[Set]) -> Result<()> {
    let peers = Peers::new()?;
    table(sets, |set, points| {
        let mut contestants = vec![
            native("triangulation", points, "0", THREADS),
            native("triangulation", points, "0", 1),
            peers.plain(points, "triangulation"),
        ];
        contestants.extend(peers.parallel(points, "triangulation", THREADS));
        for threads in [1, THREADS] {
            contestants.extend(peers.geogram(points, threads));
            contestants.extend(Peers::hxt(points, threads).filter(|_| !set.has_weights()));
        }
        contestants
    })
}

/// A filtration, and then the order of all simplices, compared with the shape of the whole triangulation.
fn filtrations(sets: &[Set]) -> Result<()> {
    table(sets, |_, points| {
        ["whole", "filtration", "order"]
            .into_iter()
            .flat_map(|what| [THREADS, 1].map(|threads| native(what, points, "inf", threads)))
            .collect()
    })
}

/// Unions of balls with all that is known of them: parts, contacts, and for us bounds.
fn balls(sets: &[Set]) -> Result<()> {
    table(sets, |_, points| {
        let ours = [THREADS, 1].map(|threads| native("balls", points, "0", threads));
        let others =
            [THREADS, 1].into_iter().filter_map(|threads| Peers::voronota(points, threads));
        ours.into_iter().chain(others).collect()
    })
}

/// Shapes at growing α.
fn alpha(sets: &[Set]) -> Result<()> {
    let peers = Peers::new()?;
    for alpha in [2, 5, 10, 20, 50, 100, 200, 500] {
        println!("\nα = {alpha}");
        let alpha = alpha.to_string();
        table(sets, |_, points| {
            vec![native("native", points, &alpha, THREADS), peers.plain(points, &alpha)]
        })?;
    }
    Ok(())
}

/// Our engine on more and more threads.
fn scale(sets: &[Set]) -> Result<()> {
    table(sets, |set, points| {
        let alpha = set.alpha().to_string();
        let threads = [1, 2, 4, 8, 16];
        ["native", "whole"]
            .into_iter()
            .flat_map(|what| threads.map(|threads| native(what, points, &alpha, threads)))
            .collect()
    })
}

/// Prints a table for each set: a row for each contestant, and how many times as long as the first it takes.
fn table(sets: &[Set], contestants: impl Fn(&Set, &Path) -> Vec<Contestant>) -> Result<()> {
    let folder = tempfile::tempdir()?;
    for set in sets {
        let points = folder.path().join("points");
        let count = write(set, &points)?;
        println!("\n{set}, {count} points");
        println!("| | process (work alone) | × the first | peak |");
        println!("|---|--:|--:|--:|");
        let contestants = contestants(set, &points);
        let runs = medians(&contestants)?;
        let first = runs[0].process;
        for (Contestant { name, .. }, Run { process, work, peak, .. }) in
            contestants.iter().zip(&runs)
        {
            let ratio = process / first;
            let peak = if *peak == 0 { "–".into() } else { format!("{} MiB", peak >> 20) };
            println!("| {name} | {process:.3} s ({work:.3} s) | {ratio:.2} | {peak} |");
        }
    }
    Ok(())
}
