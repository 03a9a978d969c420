"""`dem` and `xfem` that speak the protocols of INTERFACES over synthetic files, for tests of the driver.

A call is logged, one line each, in $FAKE_LOG. The scene (YAML) steers them: shear.frames, effects, and `fake` with
`dem_dies_at` (frame) and `xfem_error_at` (frame), `slow` (seconds per frame), `break_per_split`, `peak` (of sin phi).
"""
import json
import os
import signal
import stat
import sys
import time
from pathlib import Path

import numpy as np
import yaml

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "pipeline")]
import synthetic  # noqa: E402
from fake_explain import resolved  # noqa: E402
from rockbreak.run.run_directory import RunDirectory, attributes, broken_in, is_valid  # noqa: E402
from rockbreak.sealed import seal_of  # noqa: E402


def install(folder):
    """Puts executables `dem` and `xfem` there."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("dem", "xfem"):
        path = folder / name
        path.write_text(f"#!/bin/sh\n[ \"$1\" != explain ] || exec /usr/bin/python3 {HERE / 'fake_explain.py'} \"$@\"\n"
                        f"exec /usr/bin/python3 {HERE / 'fake_children.py'} {name} \"$@\"\n")
        path.chmod(path.stat().st_mode | stat.S_IXUSR)


def log(*words):
    with open(os.environ["FAKE_LOG"], "a", encoding="utf-8") as file:
        file.write(" ".join(str(word) for word in words) + "\n")


def option(arguments, name, default=None):
    return arguments[arguments.index(name) + 1] if name in arguments else default


def tell_profile(arguments, **seconds):
    if option(arguments, "--profile") == "-":
        print(json.dumps({"event": "profile", "seconds": seconds, "counts": {}}), file=sys.stderr)


class FakeDem:
    def __init__(self, arguments):
        self.arguments = arguments
        self.serve = "--serve" in arguments
        self.until = int(option(arguments, "--until-frame", -1))
        self.case = resolved(arguments)
        self.fake = self.case.get("fake", {})
        self.run = RunDirectory(option(arguments, "--out"))
        self.breakable = "breakage" in self.case["effects"]
        self.run.path.mkdir(parents=True, exist_ok=True)
        in_order = sorted(self.case.items(), key=lambda item: item[0] == "output")  # the last section, as dem writes it
        if not self.run.case_file.exists():
            self.run.case_file.write_text(yaml.safe_dump(dict(in_order), sort_keys=False))
        self.last = self.case["shear"]["frames"] - 1
        unlogged = ("--out", "--set", "--profile")
        log("dem", *(word for word in arguments[2:] if word.startswith("--") and word not in unlogged),
            *([self.until] if self.until >= 0 else []))

    def write(self, k):
        """Frame k: an assembly that has lost as many particles as the splits before say."""
        if k == self.fake.get("dem_dies_at"):
            print("dem: error: particle 7, frame 3: flew off", file=sys.stderr)
            sys.exit(3)
        time.sleep(self.fake.get("slow", 0))
        assembly = synthetic.Assembly()
        for j in range(k if self.breakable else 0):
            for _ in range(broken_in(self.run.split_file(j))):
                inside = np.flatnonzero((assembly.boundary == 0) & (assembly.parent < 0))
                assembly.break_one(int(inside[0]))
        strain = self.case["shear"]["axial_strain"] * k / self.last
        contacts = synthetic.contacts_of_known_anisotropy(80, 0.3, 0.5, 0.2)
        history = synthetic.history_rows(k, np.array([strain]), 2e6, len(assembly.id), 80)
        if "peak" in self.fake:
            history["stress_yy"] = history["stress_xx"] * (1 + self.fake["peak"]) / (1 - self.fake["peak"])
        if k == 0 and not self.case["preparation"].get("from"):
            (self.run.path / "prepared").mkdir(exist_ok=True)
            (self.run.path / "prepared" / "sample.h5").write_bytes(b"a sample" + seal_of(b"a sample"))
        path = self.run.frame_file(k)
        value = synthetic.write_frame(path, assembly, k, strain, k == self.last, contacts, history, step=k)
        print(json.dumps({"event": "progress", "stage": "shear", "step": k}), file=sys.stderr)
        return f"frame {k} {path} {path.stat().st_size} {value}"

    def main(self):
        code = self.work()
        tell_profile(self.arguments, preparation=0.25, shear=0.5, write=7.0, exchange=7.0)
        return code

    def work(self):
        newest = self.run.newest_valid_frame()
        if newest is not None and attributes(self.run.frame_file(newest))["final"]:
            return 0
        if newest is not None and 0 <= self.until <= newest:
            return 0
        if newest is not None and self.breakable and not is_valid(self.run.split_file(newest)):
            print(f"dem: error: split {newest} is missing", file=sys.stderr)
            return 2
        k = 0 if newest is None else newest + 1
        while True:
            line = self.write(k)
            if self.serve:
                print(line, flush=True)
                answer = sys.stdin.readline().strip()
                log("dem <", answer.replace(str(self.run.path) + "/", ""))
                if not answer.startswith("resume "):
                    return 0
            elif k == self.until:
                return 0
            if k == self.last:
                if self.serve:
                    print("done", flush=True)
                return 0
            k += 1


def solve(frame, previous, out, fake):
    k = int(Path(frame).stem)
    if k == fake.get("xfem_error_at"):
        return None
    expected = Path(f"splits/{k - 1:06d}.h5") if k else None
    assert (Path(previous) if previous else None) == expected, "the previous split is that of the frame before"
    import h5py
    with h5py.File(frame, "r") as file:
        ids = file["particles/id"][:]
        inside = ids[(file["particles/boundary"][:] == 0) & (file["particles/parent"][:] < 0)]
        frame_hash = file.attrs["payload_hash"]
    made = [{"parent": i, "path": np.zeros((2, 2)), "id": [0, 0], "halves": []}
            for i in inside[:fake.get("break_per_split", 1)]]
    value = synthetic.write_split(Path(out), k, frame_hash, ids, made,
                                  refusals=[(5, "the mesh is too coarse")] if k == 1 else [])
    return f"split {out} {Path(out).stat().st_size} {value}"


def xfem(arguments):
    fake = yaml.safe_load(Path(option(arguments, "--config")).read_text()).get("fake", {})
    if arguments[0] == "solve":
        log("xfem solve", Path(arguments[1]).stem, Path(option(arguments, "--previous", "-")).stem)
        if solve(arguments[1], option(arguments, "--previous"), option(arguments, "--out"), fake) is None:
            print("xfem: error: particle 3: singular matrix", file=sys.stderr)
            return 3
        tell_profile(arguments, analysis=0.125, read=7.0, write=7.0, total=7.0)
        return 0
    log("xfem serve")
    for line in sys.stdin:
        _, frame, previous, out = line.split()
        log("xfem < solve", Path(frame).stem, Path(previous).stem)
        answer = solve(frame, None if previous == "-" else previous, out, fake)
        if answer is None:
            print("error 3 particle 3: singular matrix", flush=True)
            return 3
        print(answer, flush=True)
    tell_profile(arguments, analysis=0.125, read=7.0, write=7.0, total=7.0)
    return 0


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    signal.signal(signal.SIGINT, lambda *_: sys.exit(130))
    sys.exit(FakeDem(sys.argv[2:]).main() if sys.argv[1] == "dem" else xfem(sys.argv[2:]))
