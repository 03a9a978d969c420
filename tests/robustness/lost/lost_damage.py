"""Damaged frames and splits before the programs as users start them: what is damaged, who reads it, what must come out.

`tests/damage` (damage.cpp) does the same to the readers alone, by the ten thousand.
"""
import argparse
import random
import shutil
import subprocess
from collections import Counter
from pathlib import Path

from lost_runs import HERE, REPOSITORY, RunDirectory, command, differences, immutable_files, patience, results
from rockbreak.run.child import executable
from rockbreak.run.run_directory import attributes, is_valid

SCENE = HERE.parent / "golden" / "scene.yaml"
SEAL_BYTES = 24
PATIENCE = 60.0
REFUSED = (2, 4)
PROGRAMS = ("dem", "xfem", "driver", "report")


def flipped(content, draw):
    at = draw.randrange(len(content))
    return content[:at] + bytes([content[at] ^ 1 << draw.randrange(8)]) + content[at + 1:]


def flipped_often(content, draw):
    for _ in range(draw.randint(2, 20)):
        content = flipped(content, draw)
    return content


def block(content, draw):
    length = draw.randint(1, min(4096, len(content) // 2))
    begin = draw.randrange(len(content) - length)
    return begin, begin + length


def zeroed(content, draw):
    begin, end = block(content, draw)
    return content[:begin] + bytes(end - begin) + content[end:]


def noisy(content, draw):
    begin, end = block(content, draw)
    return content[:begin] + draw.randbytes(end - begin) + content[end:]


def truncated(content, draw):
    return content[:draw.randrange(len(content))]


def emptied(content, draw):
    return b""


def lengthened(content, draw):
    return content + draw.randbytes(draw.randint(1, 100))


def unsealed(content, draw):
    return content[:-SEAL_BYTES]


def unsealed_and_flipped(content, draw):
    return flipped(content[:-SEAL_BYTES], draw)


KINDS = {"bit flipped": flipped, "bits flipped": flipped_often, "zeros in a block": zeroed, "noise in a block": noisy,
         "truncated": truncated, "empty": emptied, "bytes appended": lengthened, "seal cut off": unsealed,
         "seal cut off and bit flipped": unsealed_and_flipped}


class Bench:
    """A finished run, and copies of its directory with one file damaged."""

    def __init__(self, folder, seed, say=print):
        self.folder, self.random, self.say = folder, random.Random(seed), say
        self.whole = folder / "whole" / "run"
        self.out = folder / "damaged" / "run"
        made = [str(word) for word in command(self.whole, report=False)]
        made[1] = str(SCENE)
        subprocess.run(made, check=True, capture_output=True)
        self.expected = results(self.whole)
        self.last = max(RunDirectory(self.whole).frame_numbers())
        self.faults, self.counts = [], Counter()

    def one(self, program, kind):
        shutil.rmtree(self.out.parent, ignore_errors=True)
        shutil.copytree(self.whole, self.out)
        file, words, cwd = getattr(self, program)()
        content = file.read_bytes()
        damaged = KINDS[kind](content, self.random)
        if damaged == content:
            return
        file.write_bytes(damaged)
        name = f"{file.parent.name}/{file.name}"
        what = f"{program}, {name}, {kind}"
        try:
            ended = subprocess.run(words, cwd=cwd, capture_output=True, text=True, errors="replace", timeout=patience(PATIENCE),
                                   stdin=subprocess.DEVNULL, check=False)
        except subprocess.TimeoutExpired:
            self.wrong(what, "hangs")
            return
        if ended.returncode == 0:
            self.judge_success(what, program, name)
            self.counts[f"{program}: made anew" if file.read_bytes() == content or file.read_bytes() != damaged else
                        f"{program}: read as written"] += 1
        elif ended.returncode not in REFUSED:
            self.wrong(what, f"exit code {ended.returncode}: {ended.stderr[-600:]}")
        elif file.name not in ended.stderr or "Traceback" in ended.stderr:
            self.wrong(what, f"not named: {ended.stderr[-1500:]}")
        else:
            self.counts[f"{program}: refused"] += 1
            self.judge_refusal(what, name)

    def wrong(self, what, text):
        self.faults.append(f"{what}: {text}")
        self.say(f"WRONG: {self.faults[-1]}")

    def judge_success(self, what, program, name):
        """All that stands there now is that of the whole run."""
        found = {one: attributes(self.out / one)["payload_hash"] for one in immutable_files(self.out)
                 if is_valid(self.out / one)}
        other = [one for one, payload in found.items() if self.expected[one] != payload]
        if other:
            self.wrong(what, f"exit code 0, but other than the whole run: {other}")
        if program == "xfem" and "splits/made.h5" in found or program != "driver":
            return
        different = differences(results(self.out), self.expected)
        if different:
            self.wrong(what, f"exit code 0, but other than the whole run: {different}")

    def judge_refusal(self, what, name):
        """Nothing but the damaged file is other than it was."""
        other = [one for one in immutable_files(self.out)
                 if one != name and attributes(self.out / one)["payload_hash"] != self.expected.get(one)]
        if other:
            self.wrong(what, f"refused, but changed: {other}")

    def cut(self, k):
        """As if the run had been ended at split k."""
        directory = RunDirectory(self.out)
        for number in range(k + 1, self.last + 1):
            directory.frame_file(number).unlink()
            directory.split_file(number).unlink(missing_ok=True)
        directory.summary_file.unlink()
        return directory

    # -- each program: the file to damage, its command, where it is started

    def dem(self):
        k = self.random.randrange(self.last)
        directory = self.cut(k)
        file = self.random.choice((directory.frame_file(k), directory.split_file(k)))
        return file, [executable("dem"), "run", str(SCENE), "--out", str(self.out), "--resume", "--until-frame",
                      str(k + 1)], None

    def xfem(self):
        k = self.random.randrange(1, self.last + 1)
        directory = RunDirectory(self.out)
        for number in range(k, self.last + 1):
            directory.split_file(number).unlink(missing_ok=True)
        file = self.random.choice((directory.frame_file(k), directory.split_file(k - 1)))
        return file, [executable("xfem"), "solve", str(directory.frame_file(k)), "--config", str(directory.case_file),
                      "--previous", str(directory.split_file(k - 1)), "--out", str(directory.split_file(k))], None

    def driver(self):
        k = self.random.randrange(self.last)
        directory = self.cut(k)
        file = self.random.choice((directory.frame_file(k), directory.split_file(k)))
        words = command(self.out, self.random.choice(("resident", "oneshot")), True, False)
        words[1] = str(SCENE)
        return file, words, None

    def report(self):
        directory = RunDirectory(self.out)
        k = self.random.randrange(self.last + 1)
        file = self.random.choice((directory.frame_file(k), directory.split_file(k)))
        return file, [str(REPOSITORY / "pipeline" / "report"), str(self.out)], None


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="tests/robustness/lost/damaged")
    parser.add_argument("--count", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--programs", default=",".join(PROGRAMS), help="which read the damaged files, in turn")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "lost" / "damaged")
    options = parser.parse_args(arguments)
    folder = options.out.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    bench = Bench(folder, options.seed, lambda text: print(text, flush=True))
    programs = options.programs.split(",")
    for n in range(options.count):
        bench.one(programs[n % len(programs)], bench.random.choice(list(KINDS)))
    for name, count in sorted(bench.counts.items()):
        print(f"{name}: {count}")
    print(f"{sum(bench.counts.values())} damaged files judged, {len(bench.faults)} faults")
    return 1 if bench.faults else 0
