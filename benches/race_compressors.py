#!/usr/bin/env python3
"""Races `.wvm` against compressors of volumes on the same samples.

    benches/race_compressors.py [INPUT…] [--walpha target/release/walpha] [--out race] [--env DIR]

INPUT is what walpha reads; by default sample:skull and sample:phantom@128. Everyone gets the same gray
levels 0..255 as float32 (JPEG 2000: as 16-bit integers of 1/256 gray level). Whole files count, headers
too. Each compressor runs over a range of its parameter; bits per sample at an RMSE, and PSNR (peak 255)
at a rate, are read off its curve, straight between measured points on logarithmic axes. What lies
beyond the curve is left empty. Times are medians of three, of one thread where the program lets us choose.

Writes race.json, race.csv, race.md and race.svg to --out. Makes a Python environment for each package,
because some exclude each other; a package that cannot be had is left out, and told.
"""

import argparse
import csv
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
import venv

RUNS = 3
RMSES = [1.0, 2.0, 4.0]
RATES = [0.25, 0.5, 1.0]
# Gray levels: the parameters of the compressors run over these, as tolerances of their kind.
LADDER = [0.25 * 2 ** (k / 2) for k in range(16)]
PACKAGES = {
    "zfp": "zfpy",
    "SZ3": "pysz",
    "SPERR": "numcodecs-wasm-sperr",
    "TTHRESH": "numcodecs-wasm-tthresh",
    "zfp (WebAssembly)": "numcodecs-wasm-zfp",
    "SZ3 (WebAssembly)": "numcodecs-wasm-sz3",
    # Later versions of blosc2 tell the codec nothing of the shape.
    "JPEG 2000, by slices": "blosc2-grok==0.3.5 blosc2==4.0.0",
}
OURS = "walpha .wvm"
# The errors that our models are made for.
TARGETS = [8.0, 5.6, 4.0, 2.8, 2.0, 1.4, 1.0]


def rmse(a, b):
    import numpy

    return float(numpy.sqrt(numpy.mean((a.astype("f8") - b.astype("f8")) ** 2)))


def timed(work):
    """The result and the median time."""
    times = []
    for _ in range(RUNS):
        started = time.perf_counter()
        result = work()
        times.append(time.perf_counter() - started)
    return result, statistics.median(times)


def measure(samples, write, read, lossless=False):
    data, wrote = timed(lambda: write(samples))
    back, took = timed(lambda: read(data))
    error = rmse(samples, back)
    if lossless and error != 0:
        return None
    return {"bytes": len(data), "rmse": error, "write": wrote, "read": took, "lossless": lossless}


def zfp(samples):
    import zfpy

    for tolerance in LADDER:
        yield measure(
            samples, lambda s: zfpy.compress_numpy(s, tolerance=8 * tolerance), zfpy.decompress_numpy
        )
    yield measure(samples, zfpy.compress_numpy, zfpy.decompress_numpy, True)


def sz3(samples):
    from pysz import sz, szConfig, szErrorBoundMode

    def write(tolerance):
        config = szConfig(samples.shape)
        config.errorBoundMode = szErrorBoundMode.ABS
        config.absErrorBound = tolerance
        return lambda s: sz.compress(s, config)[0]

    for tolerance in LADDER:
        yield measure(samples, write(2 * tolerance), lambda d: sz.decompress(d, samples.dtype, samples.shape)[0])


def numcodecs(samples, make, parameters):
    import numpy

    for parameter in parameters:
        codec = make(parameter)
        read = lambda data: numpy.asarray(codec.decode(data)).reshape(samples.shape)
        yield measure(samples, lambda s: numpy.frombuffer(codec.encode(s), dtype="u1"), read)


def wasm_zfp(samples):
    from numcodecs_wasm_zfp import Zfp

    yield from numcodecs(samples, lambda t: Zfp(mode="fixed-accuracy", tolerance=8 * t), LADDER)


def wasm_sz3(samples):
    from numcodecs_wasm_sz3 import Sz3

    yield from numcodecs(samples, lambda t: Sz3(eb_mode="abs", eb_abs=2 * t), LADDER)


def sperr(samples):
    from numcodecs_wasm_sperr import Sperr

    peak = float(samples.max() - samples.min())
    psnr = lambda error: 20 * math.log10(peak / error)
    yield from numcodecs(samples, lambda t: Sperr(mode="psnr", psnr=psnr(t)), LADDER)


def tthresh(samples):
    from numcodecs_wasm_tthresh import Tthresh

    yield from numcodecs(samples, lambda t: Tthresh(eb_mode="rmse", eb_rmse=t), LADDER)


def jpeg2000(samples):
    import blosc2
    import blosc2_grok
    import numpy

    whole = numpy.round(samples * 256).clip(0, 65535).astype("u2")

    def write(rate):
        blosc2_grok.set_params_defaults(
            cod_format=blosc2_grok.GrkFileFmt.GRK_FMT_J2K,
            quality_mode="rates",
            quality_layers=numpy.array([rate], dtype="f8"),
            irreversible=True,
        )
        cparams = {"codec": blosc2.Codec.GROK, "filters": [], "splitmode": blosc2.SplitMode.NEVER_SPLIT}
        slices = (1, *whole.shape[1:])
        return lambda _: blosc2.asarray(whole, chunks=slices, blocks=slices, cparams=cparams).to_cframe()

    for rate in [4 * 2 ** (k / 2) for k in range(14)]:
        read = lambda data: blosc2.ndarray_from_cframe(data)[...].astype("f4") / 256
        yield measure(samples, write(rate), read)


WORKERS = {
    "zfp": zfp,
    "SZ3": sz3,
    "SPERR": sperr,
    "TTHRESH": tthresh,
    "zfp (WebAssembly)": wasm_zfp,
    "SZ3 (WebAssembly)": wasm_sz3,
    "JPEG 2000, by slices": jpeg2000,
}


def worker(name, file):
    """Prints one JSON object a line: what a compressor made of a volume."""
    import numpy

    samples = numpy.ascontiguousarray(numpy.load(file), dtype="f4")
    for row in WORKERS[name](samples):
        if row is not None:
            print(json.dumps(row), flush=True)


def environment(folder, package):
    """The Python of an environment with a package; None where it cannot be had."""
    wanted = package.split()
    place = pathlib.Path(folder) / wanted[0].split("=")[0]
    python = place / "bin" / "python"
    try:
        if not python.exists():
            venv.create(place, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "-q", "numpy", *wanted], check=True)
        return python
    except (OSError, subprocess.SubprocessError) as error:
        print(f"skipped: {package} cannot be had ({error})", file=sys.stderr)
        return None


def theirs(python, name, file):
    command = [python, __file__, "--worker", name, file]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        print(f"{name} stopped early (status {done.returncode})", file=sys.stderr)
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def ours(python, walpha, file, folder):
    """Points chosen for an RMSE, exchanged and fitted, their values rounded in proportion to it.

    Exchanging and fitting lower the RMSE of adaptive points to about 0.57 of it, so we take as many as
    reach 1.75 times the target by themselves. Both selections count as time.
    """
    rows = []
    model, back = os.path.join(folder, "model.wvm"), os.path.join(folder, "back.npy")
    select = [walpha, "points", file, "--gray", "0..255", "--select", "adaptive"]
    script = "import numpy, sys; a, b = (numpy.load(f).astype('f8') for f in sys.argv[1:]); print(((a - b) ** 2).mean() ** .5)"
    for target in TARGETS:
        started = time.perf_counter()
        told = subprocess.run([*select, "--target-rmse", str(1.75 * target), "--json"], check=True, capture_output=True)
        count = json.loads(told.stdout)["points"]["selected"]
        options = ["--count", str(count), "--refit", "--exchange", "--value-error", str(0.5 * target)]
        subprocess.run([*select, *options, "-o", model, "--quiet"], check=True)
        wrote = time.perf_counter() - started
        _, read = timed(lambda: subprocess.run([walpha, "interpolate", model, "--fill", "-o", back, "--quiet"], check=True))
        error = subprocess.run([python, "-c", script, file, back], check=True, capture_output=True, text=True)
        row = {"bytes": os.path.getsize(model), "rmse": float(error.stdout), "write": wrote, "read": read, "lossless": False}
        print(f"  {count} points: {row['bytes']} bytes, RMSE {row['rmse']:.3f}", file=sys.stderr)
        rows.append(row)
    return rows


def read_off(curve, x):
    """y at x, straight between the logarithms of measured points; None beyond them."""
    curve = sorted(curve)
    for (x0, y0), (x1, y1) in zip(curve, curve[1:]):
        if x0 <= x <= x1 and x0 < x1:
            share = (math.log(x) - math.log(x0)) / (math.log(x1) - math.log(x0))
            return math.exp(math.log(y0) * (1 - share) + math.log(y1) * share)
    return None


def best(curve):
    """The points that no other beats in both error and size, from small errors to large ones."""
    kept = []
    for error, rate in sorted(set(curve)):
        if not kept or rate < kept[-1][1]:
            kept.append((error, rate))
    return kept


def summary(name, rows, samples):
    lossy = [row for row in rows if not row["lossless"] and row["rmse"] > 0]
    curve = best([(row["rmse"], 8 * row["bytes"] / samples) for row in lossy])
    lossless = [8 * row["bytes"] / samples for row in rows if row["lossless"]]
    near = min(lossy, key=lambda row: abs(row["rmse"] - 2), default=None)
    rate_of = [(rate, error) for error, rate in curve]
    at = lambda rate: read_off(rate_of, rate)
    psnr = lambda error: None if error is None else 20 * math.log10(255 / error)
    return {
        "compressor": name,
        "bits_at_rmse": {str(error): read_off(curve, error) for error in RMSES},
        "psnr_at_bits": {str(rate): psnr(at(rate)) for rate in RATES},
        "lossless_bits": min(lossless, default=None),
        "write_seconds": near and near["write"],
        "read_seconds": near and near["read"],
        "curve": curve,
    }


def markdown(volume, rows):
    def cell(value, digits):
        return "–" if value is None else f"{value:.{digits}f}"

    lines = [
        f"{volume}:",
        "",
        "| | bits at RMSE 1 | at 2 | at 4 | PSNR at ¼ bit | at ½ | at 1 | lossless, bits | write, s | read, s |",
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|",
    ]
    for row in rows:
        cells = [cell(row["bits_at_rmse"][str(e)], 3) for e in RMSES]
        cells += [cell(row["psnr_at_bits"][str(r)], 1) for r in RATES]
        cells += [cell(row["lossless_bits"], 2), cell(row["write_seconds"], 3), cell(row["read_seconds"], 3)]
        lines.append(f"| {row['compressor']} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


COLOURS = ["#d62728", "#1f77b4", "#2ca02c", "#9467bd", "#ff7f0e", "#17becf", "#bcbd22", "#7f7f7f"]


def chart(volumes):
    """Bits per sample over RMSE, on logarithmic axes, one panel a volume."""
    wide, high, left, top = 520, 400, 70, 40
    spans = [(0.5, 10.0), (0.05, 6.0)]

    def place(value, span, length):
        low, up = (math.log(v) for v in span)
        return (math.log(value) - low) / (up - low) * length

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{max(len(volumes) * (wide + 40) + 40, left + 4 * 220 + 10)}" height="{high + 120}" font-family="sans-serif" font-size="12">']
    out.append('<rect width="100%" height="100%" fill="white"/>')
    for k, (volume, rows) in enumerate(volumes.items()):
        x0, y0 = left + k * (wide + 40), top
        plot_wide = wide - left
        x = lambda v: x0 + place(v, spans[0], plot_wide)
        y = lambda v: y0 + high - place(v, spans[1], high)
        out.append(f'<text x="{x0}" y="{y0 - 14}" font-size="14">{volume}</text>')
        for tick in [0.5, 1, 2, 4, 8]:
            out.append(f'<path d="M{x(tick):.1f} {y0}v{high}" stroke="#ddd"/><text x="{x(tick):.1f}" y="{y0 + high + 16}" text-anchor="middle">{tick:g}</text>')
        for tick in [0.1, 0.25, 0.5, 1, 2, 4]:
            out.append(f'<path d="M{x0} {y(tick):.1f}h{plot_wide}" stroke="#ddd"/><text x="{x0 - 6}" y="{y(tick) + 4:.1f}" text-anchor="end">{tick:g}</text>')
        for colour, row in zip(COLOURS, rows):
            inside = [(e, b) for e, b in row["curve"] if spans[0][0] <= e <= spans[0][1] and spans[1][0] <= b <= spans[1][1]]
            points = " ".join(f"{x(e):.1f},{y(b):.1f}" for e, b in inside)
            width = 2.5 if row["compressor"] == OURS else 1.2
            out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}"/>')
        out.append(f'<text x="{x0 + plot_wide / 2}" y="{y0 + high + 34}" text-anchor="middle">RMSE, gray levels of 0..255</text>')
        out.append(f'<text transform="translate({x0 - 40} {y0 + high / 2}) rotate(-90)" text-anchor="middle">bits per sample</text>')
    names = [row["compressor"] for row in next(iter(volumes.values()))]
    for k, (colour, name) in enumerate(zip(COLOURS, names)):
        x, y = left + k % 4 * 220, top + high + 54 + 18 * (k // 4)
        out.append(f'<path d="M{x} {y - 4}h22" stroke="{colour}" stroke-width="2.5"/><text x="{x + 28}" y="{y}">{name}</text>')
    return "\n".join(out) + "\n</svg>\n"


def race(volume, walpha, pythons, folder):
    file = os.path.join(folder, "gray.npy")
    command = [walpha, "haar", volume, "--rms", "0", "--gray-out", "-o", file, "--quiet"]
    subprocess.run(command, check=True)
    told = json.loads(subprocess.run([walpha, "info", file, "--json"], check=True, capture_output=True).stdout)
    samples = math.prod(told["dims"])
    python = next(iter(pythons.values()))
    print(f"{volume}: {OURS}", file=sys.stderr)
    rows = [summary(OURS, ours(python, walpha, file, folder), samples)]
    for name, python in pythons.items():
        print(f"{volume}: {name}", file=sys.stderr)
        rows.append(summary(name, theirs(python, name, file), samples))
    return rows


def write(folder, volumes):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "race.json").write_text(json.dumps({"date": time.strftime("%Y-%m-%d"), "volumes": volumes}, indent=1))
    (folder / "race.md").write_text("\n".join(markdown(*item) for item in volumes.items()))
    (folder / "race.svg").write_text(chart(volumes))
    with open(folder / "race.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["volume", "compressor", "rmse", "bits_per_sample"])
        for volume, rows in volumes.items():
            table.writerows([volume, row["compressor"], *point] for row in rows for point in row["curve"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("volumes", nargs="*", default=["sample:skull", "sample:phantom@128"])
    parser.add_argument("--walpha", default="target/release/walpha")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("race"))
    parser.add_argument("--env", default=os.path.join(tempfile.gettempdir(), "walpha-compressors"))
    parser.add_argument("--worker", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.worker:
        return worker(arguments.worker, arguments.volumes[0])
    found = {name: environment(arguments.env, package) for name, package in PACKAGES.items()}
    pythons = {name: python for name, python in found.items() if python}
    if not pythons:
        print("skipped: no compressor can be had")
        return 77
    walpha = os.path.abspath(arguments.walpha)
    volumes = {}
    for volume in arguments.volumes:
        with tempfile.TemporaryDirectory() as folder:
            volumes[volume] = race(volume, walpha, pythons, folder)
        write(arguments.out, volumes)
    print((arguments.out / "race.md").read_text(), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
