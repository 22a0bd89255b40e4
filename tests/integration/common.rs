//! Helpers that several tests need.

use std::alloc::{GlobalAlloc, Layout, System};
use std::any::type_name;
use std::env;
use std::ops::Range;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};

use proptest::prelude::*;
use walpha::WeightedPoints;
use walpha::advice::Advise;

/// Whether `sample:skull` can be read. It comes with CGAL's demo package, which a machine need
/// not have; where `WALPHA_REQUIRE_SKULL` is set, its absence is a failure and not an excuse.
pub fn has_skull() -> bool {
    let there = walpha::volume::sample("sample:skull");
    if let Err(error) = &there {
        assert!(env::var_os("WALPHA_REQUIRE_SKULL").is_none(), "{error}");
        eprintln!("skipped: {error}");
    }
    there.is_ok()
}

/// The built command, in a folder.
pub fn walpha(folder: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_walpha"));
    command.args(args).current_dir(folder).output().expect("the command starts")
}

/// Runs the command, and returns its exit code, standard output and standard error.
pub fn run(folder: &Path, args: &[&str]) -> (i32, String, String) {
    let output = walpha(folder, args);
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("no signal"), text(output.stdout), text(output.stderr))
}

/// Runs and expects success; gives standard output.
pub fn ok(folder: &Path, args: &[&str]) -> String {
    let (code, stdout, stderr) = run(folder, args);
    assert_eq!(code, 0, "walpha {args:?}\n{stdout}\n{stderr}");
    stdout
}

/// Runs with `--json` and expects one object.
pub fn json(folder: &Path, args: &[&str]) -> serde_json::Value {
    let stdout = ok(folder, &[args, &["--json"]].concat());
    let value: serde_json::Value = serde_json::from_str(&stdout).expect("one JSON object");
    assert!(value.is_object());
    value
}

/// Asserts that a text has all these words.
#[track_caller]
pub fn names(text: &str, words: &[&str]) {
    for word in words {
        assert!(text.contains(word), "no {word:?} in\n{text}");
    }
}

/// Runs, expects this exit code, an error that names every word, nothing on standard output, and
/// nothing new in the folder.
pub fn fails(folder: &Path, code: i32, args: &str, words: &[&str]) {
    let entries = |folder| std::fs::read_dir(folder).unwrap().count();
    let before = entries(folder);
    let (got, stdout, stderr) = run(folder, &args.split(' ').collect::<Vec<_>>());
    assert_eq!(got, code, "walpha {args}\n{stderr}");
    assert_eq!(stdout, "", "walpha {args}");
    assert!(!stderr.contains("panicked"), "walpha {args}\n{stderr}");
    for word in words {
        assert!(stderr.contains(word), "walpha {args}: no {word:?} in\n{stderr}");
    }
    assert_eq!(entries(folder), before, "walpha {args} left something behind");
}

/// Whether points are in no plane; exact where coordinates are small whole numbers or halves.
pub fn spans_a_volume(positions: &[[f64; 3]]) -> bool {
    let minus = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k] - b[k]);
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let mut rays = positions.iter().map(|&p| minus(p, positions[0]));
    let Some(along) = rays.find(|&ray| ray != [0.0; 3]) else { return false };
    let Some(normal) = rays.map(|ray| cross(along, ray)).find(|&n| n != [0.0; 3]) else {
        return false;
    };
    let height =
        |p: [f64; 3]| minus(p, positions[0]).iter().zip(normal).map(|(x, n)| x * n).sum::<f64>();
    positions.iter().any(|&p| height(p) != 0.0)
}

/// Set in the process of one test.
const ALONE: &str = "WALPHA_TEST_ALONE";

/// Runs a closure of a test in a process where no other test runs: the program of tests once more, with
/// the name of this test.
#[track_caller]
pub fn alone<F: FnOnce()>(test: F) {
    if env::var_os(ALONE).is_some() {
        return test();
    }
    // The name is like `integration::module::test::{{closure}}`.
    let path = type_name::<F>();
    let name = path.split_once("::").and_then(|(_, rest)| rest.rsplit_once("::"));
    let (name, _) = name.expect("a closure of a test");
    let mut command = Command::new(env::current_exe().unwrap());
    let output = command.args([name, "--exact"]).env(ALONE, "1").output().unwrap();
    let [told, errors] =
        [output.stdout, output.stderr].map(|b| String::from_utf8_lossy(&b).into_owned());
    assert!(output.status.success(), "{told}{errors}");
    assert!(told.contains("1 passed"), "there is no test {name}: {told}{errors}");
}

/// The size of the largest request so far, in bytes.
pub fn largest() -> usize {
    LARGEST.load(Ordering::Relaxed)
}

/// The system's allocator, which remembers the size of the largest request.
struct Remembering;

/// The size of the largest request, in bytes.
static LARGEST: AtomicUsize = AtomicUsize::new(0);

impl Remembering {
    /// Nearly always there is nothing to write, and threads need not wait for each other.
    fn remember(size: usize) {
        if size > LARGEST.load(Ordering::Relaxed) {
            LARGEST.fetch_max(size, Ordering::Relaxed);
        }
    }
}

// SAFETY: everything is handed to the system's allocator as it came.
unsafe impl GlobalAlloc for Remembering {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::remember(layout.size());
        // SAFETY: the caller's promises are those the system's allocator asks for.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        Self::remember(layout.size());
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        Self::remember(size);
        // SAFETY: as above.
        unsafe { System.realloc(at, layout, size) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Remembering = Remembering;

/// Positions with their weights.
pub fn weighted(sites: impl IntoIterator<Item = ([f64; 3], f64)>) -> WeightedPoints {
    let (positions, weights) = sites.into_iter().unzip();
    WeightedPoints::new(positions, weights).unwrap()
}

/// Points of a 4 × 4 × `height` lattice: everything that can be degenerate is.
pub fn lattice(height: i32, count: Range<usize>) -> impl Strategy<Value = WeightedPoints> {
    let weight = prop_oneof![
        4 => Just(0.0),
        2 => (0..8i32).prop_map(|w| f64::from(w) / 2.0),
        1 => -2.0..4.0f64,
    ];
    let site = ([0..4, 0..4, 0..height], weight).prop_map(|(p, w)| (p.map(f64::from), w));
    prop::collection::vec(site, count).prop_map(weighted)
}

/// The message and the advice in one text.
pub trait Told: Advise {
    fn told(&self) -> String {
        self.advice().map_or(self.to_string(), |advice| format!("{self}; {advice}"))
    }
}

impl<E: Advise> Told for E {}
