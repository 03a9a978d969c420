"""A fault at every call that changes files: in dem, in xfem and in the driver, one after the other until a run meets none.

After a call that fails (no space, quota, device error) the run must end with exit code 4 and name a file and the reason; none of
its files may be half; resumed without faults it must yield what the uninterrupted run does. Short writes and interrupted
calls must not be noticed at all.
"""
import argparse
import errno
import os
import shutil
import subprocess
import time
from collections import Counter
from pathlib import Path

from lost_runs import (HERE, REPOSITORY, Started, command, differences, immutable_files, patience, processes_in,
                       results, seconds_until_free, temporary_files)
from rockbreak.run.run_directory import is_valid

SCENE = HERE.parent / "golden" / "scene.yaml"  # the smallest
PROCESSES = {"dem": "dem", "xfem": "xfem", "driver": "python3"}
KINDS = {"nospace": (errno.ENOSPC, True), "quota": (errno.EDQUOT, True), "device": (errno.EIO, False),
         "short": ("short", False), "again": ("again", False), "kill": ("kill", False)}
FAILING = ("nospace", "quota", "device")
IO_FAILURE = 4


def build(folder):
    """The library that makes calls fail."""
    library = folder / "faults.so"
    subprocess.run(["gcc", "-O1", "-Wall", "-Wextra", "-shared", "-fPIC", "-o", library, HERE / "faults.c", "-ldl"],
                   check=True)
    return library


class Sweep:
    def __init__(self, folder, report=False, durability="none", say=print, overrides=()):
        self.folder, self.report, self.say = folder, report, say
        self.overrides = [f"output.durability={durability}", *overrides]
        self.library = build(folder)
        self.out = folder / "faulty" / "run"
        self.faults, self.counts = [], Counter()
        reference = folder / "uninterrupted" / "run"
        self.start(reference, resume=False).process.wait()
        self.expected = results(reference)

    def start(self, out, resume, mode="resident", environment=None):
        arguments = command(out, mode, resume, self.report, self.overrides)
        arguments[1] = str(SCENE)
        return Started(arguments, self.folder / "messages.txt", environment)

    def wrong(self, what, text):
        self.faults.append(f"{what}: {text}")
        self.say(f"WRONG: {self.faults[-1]}")

    def one(self, name, kind, n, mode):
        """Call n of a process goes wrong. False if the run made fewer calls."""
        code, stays = KINDS[kind]
        log = self.folder / "fault.txt"
        log.unlink(missing_ok=True)
        shutil.rmtree(self.out.parent, ignore_errors=True)
        environment = {"LD_PRELOAD": str(self.library), "FAULT_UNDER": str(self.out.parent), "FAULT_AT": str(n),
                       "FAULT_NAME": PROCESSES[name], "FAULT_CALL": str(code), "FAULT_LOG": str(log),
                       **({"FAULT_STAYS": "1"} if stays else {})}
        run = self.start(self.out, False, mode, environment)
        try:
            ended = run.process.wait(patience(120))
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, 9)
            self.wrong(f"{name} {kind} {n}", "hangs")
            return True
        if not log.exists():
            return False
        call = log.read_text().strip()
        what = f"{name}, {mode}, {kind} at call {n} ({call})"
        said = run.log.read_text(encoding="utf-8", errors="replace")
        self.counts[f"{kind}: {call.split()[0]}"] += 1
        if kind in FAILING:
            file, reason = Path(call.split(" ", 1)[1]).name.removesuffix(".tmp"), os.strerror(code)
            if ended != IO_FAILURE:
                self.wrong(what, f"exit code {ended}: {said[-600:]}")
            elif not any(file in line and reason in line for line in said.splitlines()):
                self.wrong(what, f"no line with {file} and `{reason}` in {said[-600:]}")
        elif kind != "kill" and ended != 0:
            self.wrong(what, f"exit code {ended}: {said[-600:]}")
        if "Traceback" in said:
            self.wrong(what, said[-1500:])
        if seconds_until_free(self.out) is None or processes_in(self.out):
            self.wrong(what, f"still at work: {processes_in(self.out)}")
        half = [file for file in immutable_files(self.out) if not is_valid(self.out / file)]
        if half:
            self.wrong(what, f"half files: {half}")
        if kind != "kill" and [one for one in temporary_files(self.out)]:
            self.wrong(what, f"left behind: {temporary_files(self.out)}")
        if kind in FAILING or kind == "kill":
            again = self.start(self.out, True)
            if again.process.wait() != 0:
                self.wrong(what, f"resumed: exit code {again.process.returncode}: {again.log.read_text()[-600:]}")
                return True
        different = differences(results(self.out), self.expected)
        if different:
            self.wrong(what, f"other than uninterrupted: {different}")
        return True

    def all(self, names, kinds, modes, every=1, first=1):
        """Each call of each process, or every so many-th of them. Returns the number of calls of each process."""
        for name in names:
            for kind in kinds:
                for mode in modes:
                    n, begin = first, time.monotonic()
                    while self.one(name, kind, n, mode) and len(self.faults) < 20:
                        n += every
                    self.say(f"{name}, {kind}, {mode}: calls {first} to {n - 1}, every {every}; {len(self.faults)} "
                             f"faults; {time.monotonic() - begin:.0f} s")


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="tests/robustness/lost/faults")
    parser.add_argument("--processes", default="dem,xfem,driver")
    parser.add_argument("--kinds", default=",".join(KINDS), help="of faults")
    parser.add_argument("--modes", default="resident")
    parser.add_argument("--every", type=int, default=1, help="of the calls, only every so many-th")
    parser.add_argument("--durability", default="every", help="of the scene; `every` brings fsync into the sweep")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", dest="overrides",
                        help="of the scene, for example --set shear.axial_strain=0.006: fewer frames")
    parser.add_argument("--report", action="store_true", help="with the report and its figures")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "lost" / "faults")
    options = parser.parse_args(arguments)
    folder = options.out.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    sweep = Sweep(folder, options.report, options.durability, lambda text: print(text, flush=True),
                  options.overrides)
    sweep.all(options.processes.split(","), options.kinds.split(","), options.modes.split(","), options.every)
    for name, count in sorted(sweep.counts.items()):
        print(f"{name}: {count}")
    print(f"{sum(sweep.counts.values())} calls went wrong; {len(sweep.faults)} faults")
    return 1 if sweep.faults else 0
