"""What is watched during a soak, and the verdict over it."""
import argparse
import csv
import json
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[2]
sys.path.insert(0, str(REPOSITORY / "pipeline"))
from rockbreak.run.child import executable  # noqa: E402
from rockbreak.run.history import read_history, shear_rows  # noqa: E402
from rockbreak.run.ledger import read_ledger  # noqa: E402
from rockbreak.run.payload_hash import xxh3_128  # noqa: E402
from rockbreak.run.run_directory import RunDirectory  # noqa: E402
from rockbreak.sealed import open_sealed  # noqa: E402

SECONDS_BETWEEN = 0.5
NOISE = 1.0                # [MiB] what an allocator may come and go by
SPARE = 1.1                # of a process that has freed and made models for 10^6 steps over a new one
ENERGY_RESIDUAL = 1e-3     # of the boundary work
SERVO_ERROR = 0.02         # rms, relative


def memory_of(driver):
    """Name -> resident memory [MiB] of the children dem and xfem."""
    found = {}
    try:
        children = Path(f"/proc/{driver}/task/{driver}/children").read_text(encoding="ascii").split()
        for number in children:
            lines = Path(f"/proc/{number}/status").read_text(encoding="ascii").splitlines()
            status = dict(line.split(":", 1) for line in lines if ":" in line)
            if "VmRSS" in status:
                found[status["Name"].strip()] = int(status["VmRSS"].split()[0]) / 1024
    except OSError:
        pass
    return {name: value for name, value in found.items() if name in ("dem", "xfem")}


def watch(out, scene, overrides):
    """Runs the scene; memory.csv holds frame and memory of both processes over time. Returns the driver's exit code."""
    command = [REPOSITORY / "pipeline" / "run", scene, "--out", out, "--no-report", "--threads", "1",
               *(word for override in overrides for word in ("--set", override))]
    with open(out.parent / f"{out.name}.log", "w", encoding="utf-8") as log:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=log)
    rows, begin = [], time.monotonic()
    while process.poll() is None:
        frames = len(list((out / "frames").glob("*.h5")))
        memory = memory_of(process.pid)
        if frames and len(memory) == 2:
            rows.append((time.monotonic() - begin, frames - 1, memory["dem"], memory["xfem"]))
        time.sleep(SECONDS_BETWEEN)
    with open(out / "memory.csv", "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([("seconds", "frame", "dem_mib", "xfem_mib"), *rows])
    return process.returncode


def growth(frames, memory, particles):
    """Of the second half of a run: growth of the line through the memory [MiB], and what the growth of the number of
    particles explains if all memory were theirs."""
    half = frames >= (frames[0] + frames[-1]) / 2
    x, y = frames[half], memory[half]
    slope, start = np.polyfit(x, y, 1)
    grown = slope * (x[-1] - x[0])
    explained = (start + slope * x[0]) * (particles[x[-1]] / particles[x[0]] - 1)
    return grown, explained


def fresh_memory(directory, threads=1, repeats=50):
    """Resident memory [MiB] of a new xfem that has solved the last frame once, and then as often as `repeats`. Its need grows
    with the number of different outlines, one for each fragment, so the number of particles alone does not tell it."""
    last = directory.split_numbers()[-1]
    line = f"solve frames/{last:06d}.h5 splits/{last - 1:06d}.h5 "
    with tempfile.TemporaryDirectory() as folder, subprocess.Popen(
            [executable("xfem"), "serve", "--config", "case.yaml", "--threads", str(threads)], cwd=directory.path,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, bufsize=1) as process:
        memory = []
        for number in range(1 + repeats):
            process.stdin.write(f"{line}{folder}/{number % 2}.h5\n")
            answer = process.stdout.readline()
            if not answer.startswith("split "):
                raise SystemExit(f"xfem: {answer}")
            status = Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
            memory.append(int(status.split("VmRSS:")[1].split()[0]) / 1024)
        process.stdin.close()
    return memory[0], memory[-1]


def ledger_faults(directory):
    """Files that the ledger does not have as they stand here, and numbers that are missing."""
    known = {event["path"]: event for event in read_ledger(directory.ledger_file)
             if event["event"] in ("frame", "split")}
    faults = []
    for folder, numbers in (("frames", directory.frame_numbers()), ("splits", directory.split_numbers())):
        if numbers != list(range(len(numbers))):
            faults.append(f"{folder}: numbers are missing")
        for k in numbers:
            name = f"{folder}/{k:06d}.h5"
            event, content = known.get(name), (directory.path / name).read_bytes()
            if event is None or event["bytes"] != len(content) or event["file_hash"] != xxh3_128(content):
                faults.append(name)
    return faults


def refusals(directory):
    total = 0
    for k in directory.split_numbers():
        with open_sealed(directory.split_file(k)) as file:
            total += len(file["refusals/particle"]) if "refusals" in file else 0
    return total


def verdict(out, code, steps):
    """(what, found, wanted, passed) of everything that is watched."""
    directory = RunDirectory(out)
    summary = json.loads(directory.summary_file.read_text(encoding="utf-8"))
    history = read_history(directory)
    shear = shear_rows(history)
    table = np.genfromtxt(out / "memory.csv", delimiter=",", names=True)
    particles = []
    for k in directory.frame_numbers():
        with open_sealed(directory.frame_file(k)) as file:
            particles.append(len(file["particles/id"]))
    frames = table["frame"].astype(int)
    work = summary["energy"]["boundary_work"]
    residual = float(np.max(np.abs(shear["energy_residual"]))) / work
    refused, faults = refusals(directory), ledger_faults(directory)
    final_split = directory.split_numbers()[-1]
    with open_sealed(directory.split_file(final_split)) as file:
        pending = len(file["broken/parent"])
    balance = summary["particles_initial"] + summary["broken_total"] - pending - summary["particles_final"]
    rows = [
        ("exit code", str(code), "0", code == 0 and summary["complete"]),
        ("steps", f"{summary['steps']:,}", f">= {steps:,}", summary["steps"] >= steps),
        ("frames, splits", f"{len(particles)}, {len(directory.split_numbers())}", "as many",
         len(particles) == len(directory.split_numbers())),
        ("particles", f"{particles[0]} to {particles[-1]}", "more", particles[-1] > particles[0]),
        ("particles less fragments", str(balance), "0", balance == 0),
        ("analyses refused", str(refused), "0", refused == 0),
        ("escaped", f"{np.max(shear['escaped']):.0f}", "0", np.max(shear["escaped"]) == 0),
        ("largest energy residual / work", f"{residual:.1e}", f"<= {ENERGY_RESIDUAL:g}", residual <= ENERGY_RESIDUAL),
        ("lateral stress error, rms", f"{summary['lateral_stress_error_rms']:.2%}", f"<= {SERVO_ERROR:.0%}",
         summary["lateral_stress_error_rms"] <= SERVO_ERROR),
        ("solid area, relative change", f"{summary['solid_area_error']:.1e}", "<= 1e-12",
         summary["solid_area_error"] <= 1e-12),
        ("files unlike their ledger", str(len(faults)), "0", not faults),
    ]
    grown, explained = growth(frames, table["dem_mib"], particles)
    first, again = fresh_memory(directory)
    at_end = table["xfem_mib"][-1]
    return rows + [
        ("memory of dem, second half", f"{table['dem_mib'][-1]:.1f} MiB, {grown:+.2f} MiB",
         f"<= +{explained + NOISE:.1f} MiB", grown <= explained + NOISE),
        ("memory of xfem at the end", f"{at_end:.1f} MiB", f"<= {SPARE * first + NOISE:.1f} MiB",
         at_end <= SPARE * first + NOISE),
        ("the same of a new xfem", f"{first:.1f} MiB, {again - first:+.2f} MiB", f"<= +{NOISE:.1f} MiB",
         again - first <= NOISE)]


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="tests/robustness/soak/run")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--scene", type=Path, default=HERE / "scene.yaml")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", dest="overrides")
    parser.add_argument("--steps", type=int, default=1_000_000, help="fewer are not a soak")
    parser.add_argument("--verdict", action="store_true", help="of the run that stands in --out")
    options = parser.parse_args(arguments)
    code = 0
    if not options.verdict:
        shutil.rmtree(options.out, ignore_errors=True)
        options.out.parent.mkdir(parents=True, exist_ok=True)
        code = watch(options.out, options.scene, options.overrides)
        if code != 0:
            print((options.out.parent / f"{options.out.name}.log").read_text(encoding="utf-8")[-2000:])
            return 1
    rows = verdict(options.out, code, options.steps)
    width = max(len(row[0]) for row in rows)
    for what, found, wanted, passed in rows:
        print(f"{what:{width}}  {found:28} wanted {wanted:16} {'ok' if passed else 'NOT MET'}")
    return 0 if all(row[3] for row in rows) else 1
