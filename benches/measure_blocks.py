#!/usr/bin/env python3
"""Measures what a shape in blocks costs, beside what `walpha blocks plan --dry-run` predicts.

    cargo build --release --features zarr,mpi
    benches/measure_blocks.py steps 512 --blocks 8 --folder /scratch    # plan, run and merge, one thread
    benches/measure_blocks.py ranks 512 --blocks 16 --folder /scratch   # `mpirun -n 1 … 8 walpha shape`
    benches/measure_blocks.py prices 1024 2048 4096 8192                # the table of docs/clusters.md, by the model alone

The phantom is converted to Zarr first, once. Prints lines of the tables of docs/clusters.md: CPU time is that of user and system
together, which other work on the machine hardly changes; memory is the largest resident set of a process.
"""

import argparse
import json
import os
import shutil
import struct
import subprocess
import sys
import time
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
OPTIONS = ["--weights", "min-max", "--alpha", "10"]


def measured(command, **options):
    """Runs a command: its output, seconds, CPU seconds and peak memory in bytes, those of its children included."""
    begun = time.monotonic()
    process = subprocess.Popen([str(part) for part in command], stdout=subprocess.PIPE, text=True, **options)
    out = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} failed with {process.returncode}")
    return out, time.monotonic() - begun, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def told(folder):
    """Bytes of the arrays that merging reads, and the points looked at around blocks, as headers tell them: see `A block's
    file` in docs/clusters.md."""
    keys = halo = 0
    for path in folder.glob("block-*.walpha"):
        with open(path, "rb") as file:
            (length,) = struct.unpack("<16xQ", file.read(24))
            header = json.loads(file.read(length))
        keys += sum(size for name, size in header["arrays"] if name.startswith(("border_", "shared_")))
        halo += header["facts"]["halo"]
    return keys, halo


def steps(args, volume):
    work, out = args.folder / "work", args.folder / "steps.pvtu"
    shutil.rmtree(work, ignore_errors=True)
    job = [*OPTIONS, "--blocks", args.blocks]
    price = json.loads(measured([args.walpha, "blocks", "plan", volume, *job, "--dry-run", "--json"])[0])
    common = ["--threads", "1", "--json"]
    plan, plan_wall, plan_cpu, plan_peak = measured([args.walpha, "blocks", "plan", volume, *job, "-o", work, *common])
    _, run_wall, run_cpu, run_peak = measured([args.walpha, "blocks", "run", work, *common])
    _, merge_wall, merge_cpu, merge_peak = measured([args.walpha, "blocks", "merge", work, *common])
    rows = sum(path.stat().st_size for path in work.glob("block-*"))
    keys, halo = told(work)
    write_cpu = pieces = 0.0
    if not args.no_pieces:
        _, _, write_cpu, _ = measured([args.walpha, "blocks", "merge", work, "-o", out, *common])
        write_cpu -= merge_cpu
        pieces = sum(path.stat().st_size for path in out.with_suffix("").iterdir())
        shutil.rmtree(out.with_suffix(""))
        out.unlink()
    shutil.rmtree(work)
    plan = json.loads(plan)
    found = {
        "points": plan["points"],
        "halo share": halo / plan["points"],
        "memory of a block, MB": run_peak / 1e6,
        "written by blocks, MB": rows / 1e6,
        "keys, MB": keys / 1e6,
        "plan, s": plan_cpu,
        "blocks, s": run_cpu,
        "merge, s": merge_cpu,
        "all, s": plan_cpu + run_cpu + merge_cpu,
    }
    core = price["core_seconds"]
    predicted = [price["points"], price["halo_share"], price["memory_per_block"] / 1e6]
    predicted += [price["bytes_written"][0] / 1e6, price["bytes_written"][1] / 1e6, *core, sum(core)]
    print(f"phantom@{args.size}, {plan['blocks']} blocks: CPU time, one thread")
    print("| | predicted | measured | ratio |\n|---|---|---|---|")
    for (name, value), model in zip(found.items(), predicted):
        print(f"| {name} | {model:.4g} | {value:.4g} | {model / value if value else 0:.2f} |")
    print(f"wall: plan {plan_wall:.0f} s, blocks {run_wall:.0f} s, merge {merge_wall:.0f} s; pieces {pieces / 1e6:.0f} MB in {write_cpu:.0f} s of a core")
    print(f"peak: plan {plan_peak / 1e6:.0f} MB, blocks {run_peak / 1e6:.0f} MB, merge {merge_peak / 1e6:.0f} MB", flush=True)


def ranks(args, volume):
    print(f"phantom@{args.size}, at most {args.blocks} blocks: mpirun, one thread for each rank")
    print("| ranks | wall, s | CPU of the slowest rank, s | CPU of all, s | peak of a rank, MB |\n|---|---|---|---|---|")
    for count in args.ranks:
        out = args.folder / f"ranks.{args.output}"
        usage = args.folder / "usage"
        usage.mkdir(exist_ok=True)
        launch = ["mpirun", "--oversubscribe", "--allow-run-as-root", "--bind-to", "none", "-n", count]
        shape = [args.walpha, "shape", volume, *OPTIONS, "--blocks", args.blocks, "--threads", "1", "-o", out, "--json"]
        report, wall, _, _ = measured([*launch, sys.executable, __file__, "rank", usage, *shape])
        each = [json.loads(path.read_text()) for path in sorted(usage.iterdir())]
        cpu = [rank["cpu"] for rank in each]
        peak = json.loads(report)["peak_memory_bytes"]
        print(f"| {count} | {wall:.0f} | {max(cpu):.0f} | {sum(cpu):.0f} | {peak / 1e6:.0f} |", flush=True)
        for folder in (usage, out.with_suffix("")):
            shutil.rmtree(folder)
        out.unlink()


def readable(seconds):
    units = ((1, "s"), (60, "min"), (3600, "h"))
    size, name = [unit for unit in units if seconds >= 2 * unit[0] or unit[0] == 1][-1]
    return f"{seconds / size:.0f} {name}"


def prices(args):
    print("| volume | points | blocks | memory of a rank | read | written | core-hours | 1 rank | 64 ranks | 4096 ranks |\n" + "|---" * 10 + "|")
    for size in args.size:
        blocks = max(8, (size // 256) ** 3)
        # Of values that are no gray levels yet, as in a file of floats.
        job = [*OPTIONS, "--gray", "0..255", "--blocks", blocks, "--dry-run", "--json"]
        price = json.loads(measured([args.walpha, "blocks", "plan", f"sample:phantom@{size}", *job])[0])
        plan, run, merge = price["core_seconds"]
        hours = [(plan + run) / min(ranks, blocks) / 3600 + merge / 3600 for ranks in (1, 64, 4096)]
        read, written = sum(price["bytes_read"]) / 1e9, price["bytes_written"][0] / 1e9
        print(
            f"| {size}³ | {price['points'] / 1e6:.0f}·10⁶ | {blocks} | {price['memory_per_block'] / 1e9:.1f} GB | {read:.0f} GB | {written:.0f} GB "
            f"| {(plan + run + merge) / 3600:.1f} | " + " | ".join(readable(3600 * h) for h in hours) + " |"
        )


def rank():
    """One rank of `ranks`: runs a command and leaves its CPU time in a folder."""
    folder, *command = sys.argv[2:]
    out, _, cpu, _ = measured(command)
    sys.stdout.write(out)
    (Path(folder) / os.environ.get("OMPI_COMM_WORLD_RANK", os.environ.get("PMI_RANK", "0"))).write_text(json.dumps({"cpu": cpu}))


def main():
    if sys.argv[1:2] == ["rank"]:
        return rank()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["steps", "ranks", "prices"])
    parser.add_argument("size", type=int, nargs="+", help="samples along each edge")
    parser.add_argument("--blocks", type=int, default=8)
    parser.add_argument("--folder", type=Path, default=Path("."), help="for the volume and the results")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2, 4, 8])
    parser.add_argument("--output", choices=["pvtu", "pvtp"], default="pvtp", help="what `ranks` writes")
    parser.add_argument("--no-pieces", action="store_true", help="`steps` writes no pieces")
    parser.add_argument("--walpha", type=Path, default=REPOSITORY / "target/release/walpha")
    args = parser.parse_args()
    if args.what == "prices":
        return prices(args)
    [args.size] = args.size
    volume = args.folder / f"phantom{args.size}.zarr"
    if not volume.exists():
        _, wall, cpu, peak = measured([args.walpha, "convert", f"sample:phantom@{args.size}", "-o", volume, "--json"])
        size = sum(path.stat().st_size for path in volume.rglob("*") if path.is_file())
        print(f"convert: {wall:.0f} s, CPU {cpu:.0f} s, peak {peak / 1e6:.0f} MB, {size / 1e6:.0f} MB of files")
    {"steps": steps, "ranks": ranks}[args.what](args, volume)


if __name__ == "__main__":
    main()
