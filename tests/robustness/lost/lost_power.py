"""Power cuts: what a file system leaves of files that it had not yet brought to the disk, in any order.

No program can cut the power; a cut is made of a finished run by what ext4 and its like are known to leave behind a
rename without fsync: no name, an empty file, zeros of the right length, the first part only, or the file.
"""
import argparse
import random
import shutil
import subprocess
from collections import Counter
from pathlib import Path

from lost_damage import SCENE
from lost_kills import missing_events
from lost_runs import REPOSITORY, RunDirectory, command, differences, results

OVERRIDES = ["shear.axial_strain=0.008"]
PAGE = 4096
WHOLE = "whole"
LEFT = {
    WHOLE: lambda content: content,
    "gone": None,
    "empty": lambda content: b"",
    "zeros": lambda content: bytes(len(content)),
    "first pages": lambda content: content[:(len(content) // PAGE + 1) // 2 * PAGE].ljust(len(content), b"\0"),
    "shorter": lambda content: content[:content.find(b"\n", len(content) // 3) + 1],  # of YAML, whole lines
}


class PowerCuts:
    def __init__(self, folder, seed, say=print):
        self.folder, self.random, self.say = folder, random.Random(seed), say
        self.whole = folder / "uninterrupted" / "run"
        self.counts, self.faults, self.cuts = Counter(), [], 0
        self.go(self.whole, "resident", resume=False).check_returncode()
        self.expected = results(self.whole)

    def go(self, out, mode, resume=True):
        words = command(out, mode, resume, report=False, overrides=OVERRIDES)
        words[1] = str(SCENE)
        return subprocess.run(words, capture_output=True, text=True, check=False)

    def one(self):
        """A cut, and the run that goes on after it."""
        self.cuts += 1
        out = self.folder / f"{self.cuts}" / "run"
        shutil.copytree(self.whole, out)
        found = self.leave(out)
        resumed = self.go(out, self.random.choice(("resident", "oneshot")))
        problem = (resumed.stderr[-500:] if resumed.returncode else
                   differences(results(out), self.expected) + missing_events(out))
        if problem or RunDirectory(out).restoring.exists():
            self.faults.append(f"cut {self.cuts}: {problem or 'a folder is left'}; {', '.join(found)}")
            self.say(f"WRONG: {self.faults[-1]}")
        else:
            shutil.rmtree(out.parent)

    def leave(self, out):
        """Spoils what was written after some frame; every tenth time also what is always brought to the disk."""
        run = RunDirectory(out)
        numbers = run.frame_numbers()
        durable = self.random.choice(numbers[:-1]) if self.random.random() < 0.9 else -1
        files = [run.frame_file(k) for k in numbers if k > durable]
        files += [run.split_file(k) for k in numbers if k >= durable]
        if durable < 0:
            files += [run.case_file, *(out / "prepared").glob("*.h5")]
        run.summary_file.unlink()
        said = [f"after frame {durable}"]
        for file in filter(Path.exists, files):
            kind = self.random.choice(list(LEFT))
            self.counts[kind] += 1
            if kind == "gone":
                file.unlink()
            elif kind != WHOLE:
                file.write_bytes(LEFT[kind](file.read_bytes()))
            said.append(f"{file.relative_to(out)} {kind}")
        content = run.ledger_file.read_bytes()
        end = self.random.randrange(len(content))
        run.ledger_file.write_bytes(content[:end].ljust(self.random.choice((end, len(content))), b"\0"))
        return said


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="tests/robustness/lost/power")
    parser.add_argument("--cuts", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "lost" / "power")
    options = parser.parse_args(arguments)
    options.out = options.out.resolve()
    shutil.rmtree(options.out, ignore_errors=True)
    cuts = PowerCuts(options.out, options.seed, lambda text: print(text, flush=True))
    while cuts.cuts < options.cuts and len(cuts.faults) < 20:
        cuts.one()
    print("left: " + ", ".join(f"{kind} {count}" for kind, count in cuts.counts.most_common()))
    print(f"{cuts.cuts} cuts, {len(cuts.faults)} faults")
    return 1 if cuts.faults else 0
