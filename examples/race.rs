//! Races the engines on the same points and prints a table.
//!
//! `cargo run --release --example race` (about a quarter of an hour); `-- quick` for sets of up to
//! 128 k points, `-- large` for the others; `-- alpha` raises α instead, until slabs stop paying.
//!
//! Both engines are timed with everything they give: classes, canonical order, Betti numbers,
//! measures. The reference engine is CGAL's `Fixed_alpha_shape_3` with these added; of its time
//! nine tenths are CGAL's. Runs are interleaved, times are medians of five, ratios are of these
//! medians. Peak memory is that of a process of its own, less what the input took.

use std::process::Command;
use std::time::Instant;

use walpha::points::{Points, Selection, Units, difference, select, weigh};
use walpha::shape::{Engine, ShapeOptions};
use walpha::{Alpha, Gray, Volume, WeightedPoints, Weighting, alpha_shape, memory, volume};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error + Send + Sync>>;

const RUNS: usize = 5;
const THREADS: usize = 2;
const SMALL: [&str; 3] = ["skull@64", "skull@128", "random@128000"];
const LARGE: [&str; 2] = ["skull@256", "random@1000000"];

fn main() -> Result<()> {
    rayon::ThreadPoolBuilder::new().num_threads(THREADS).build_global()?;
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["memory", engine, set, weighting, alpha] => memory_of(engine, set, weighting, alpha),
        [] => races(&[&SMALL[..], &LARGE].concat()),
        ["quick"] => races(&SMALL),
        ["large"] => races(&LARGE),
        ["alpha"] => {
            header();
            let race = |alpha| race("skull@128", "common=0", alpha);
            [2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0].into_iter().try_for_each(race)
        }
        _ => Err("usage: race [quick|large|alpha]".into()),
    }
}

fn races(sets: &[&str]) -> Result<()> {
    header();
    for set in sets {
        for weighting in ["common=0", "min-max", "barycentric"] {
            if weighting == "common=0" || set.starts_with("skull") {
                race(set, weighting, if set.starts_with("skull") { 10.0 } else { 1.0 })?;
            }
        }
    }
    Ok(())
}

fn header() {
    println!(
        "| set | points | weights | α | reference | slabs, 1 thread | ratio | slabs, {THREADS} threads | ratio \
         | reference peak | slabs peak | peak with --memory of a third |"
    );
    println!("|---|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
}

fn race(set: &str, weighting: &str, alpha: f64) -> Result<()> {
    let points = weighted(set, weighting, alpha)?;
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let mut times = [const { Vec::new() }; 3];
    for _ in 0..RUNS {
        times[0].push(seconds(|| run(Engine::Reference, &points, alpha, None))?);
        times[1].push(one_thread.install(|| seconds(|| run(Engine::Slabs, &points, alpha, None)))?);
        times[2].push(seconds(|| run(Engine::Slabs, &points, alpha, None))?);
    }
    let [reference, one, two] = times.map(|mut runs| {
        runs.sort_by(f64::total_cmp);
        runs[RUNS / 2]
    });
    let peak = |engine: &str| -> Result<u64> {
        let arguments = ["memory", engine, set, weighting, &alpha.to_string()];
        let output = Command::new(std::env::current_exe()?).args(arguments).output()?;
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into());
        }
        Ok(String::from_utf8(output.stdout)?.trim().parse()?)
    };
    let whole = peak("reference")?;
    let mebibytes = |bytes: u64| bytes >> 20;
    // A small set may not do with a third: threads and code take some, too.
    let third = peak(&(whole / 3).to_string());
    println!(
        "| {set} | {} | {weighting} | {alpha} | {reference:.2} s | {one:.2} s | {:.2} | {two:.2} s | {:.2} \
         | {} MiB | {} MiB | {} |",
        points.len(),
        reference / one,
        reference / two,
        mebibytes(whole),
        mebibytes(peak("slabs")?),
        third.map_or("refused".to_owned(), |bytes| format!("{} MiB", mebibytes(bytes))),
    );
    Ok(())
}

fn seconds(work: impl FnOnce() -> Result<()>) -> Result<f64> {
    let started = Instant::now();
    work()?;
    Ok(started.elapsed().as_secs_f64())
}

fn run(engine: Engine, points: &WeightedPoints, alpha: f64, memory: Option<u64>) -> Result<()> {
    let alpha = Alpha::from_squared(alpha)?;
    let options = ShapeOptions { engine, memory, ..ShapeOptions::new(alpha) };
    let shape = alpha_shape(points.clone(), &options)?;
    assert!(shape.betti().is_some());
    Ok(())
}

/// Prints the bytes that one engine adds to those of the input at its peak.
fn memory_of(engine: &str, set: &str, weighting: &str, alpha: &str) -> Result<()> {
    let alpha: f64 = alpha.parse()?;
    let points = weighted(set, weighting, alpha)?;
    let before = memory::resident_bytes().unwrap_or(0);
    match engine {
        "reference" => run(Engine::Reference, &points, alpha, None)?,
        "slabs" => run(Engine::Slabs, &points, alpha, None)?,
        // As with --memory: so many bytes more than now.
        bytes => run(Engine::Slabs, &points, alpha, Some(before + bytes.parse::<u64>()?))?,
    }
    println!("{}", memory::peak_bytes().unwrap_or(0).saturating_sub(before));
    Ok(())
}

/// A set by name: `skull@N` (the skull upsampled to N³ samples) or `random@N` (N random points).
fn weighted(set: &str, weighting: &str, alpha: f64) -> Result<WeightedPoints> {
    let weighting: Weighting = weighting.parse()?;
    let points = match set.split_once('@') {
        Some(("skull", size)) => skull(size.parse()?)?,
        Some((_, count)) => random(count.parse()?),
        None => return Err("no such set".into()),
    };
    Ok(weigh(&points, weighting, alpha)?)
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
    Points { positions, ..Points::default() }
}
