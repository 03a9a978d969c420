"""The campaign of kills: who is killed and when, what must hold after each kill and at the end of each run.

A victim is dem, xfem, the driver alone, or the whole process group, by SIGKILL, or by SIGTERM or SIGINT if so told. The
moment is drawn uniformly over three quarters of the uninterrupted run's time, every fourth over its start alone; a resumed run is killed again until one gets
to its end. The mode is drawn anew for each start.
"""
import argparse
import os
import random
import shutil
import signal
import time
from collections import Counter
from pathlib import Path

from lost_runs import (REPOSITORY, RunDirectory, Started, command, differences, immutable_files, patience,
                       phase_of, processes_in, results, seconds_until_free, step_of_newest_checkpoint, temporary_files)

VICTIMS = ("dem", "xfem", "driver", "group")
START_SECONDS = 1.0        # in which every fourth kill falls
PATIENCE = 60.0            # for a driver whose child was killed
SIGNALS = {"kill": signal.SIGKILL, "term": signal.SIGTERM, "int": signal.SIGINT}


class Campaign:
    def __init__(self, folder, seed, modes, report, overrides=(), say=print, signals=("kill",)):
        self.folder, self.modes, self.report, self.overrides, self.say = folder, modes, report, overrides, say
        self.random, self.signals = random.Random(seed), signals
        self.out = folder / "killed" / "run"  # the name of a run stands in its tables
        self.counts = {"victim": Counter(), "phase": Counter(), "mode": Counter(), "signal": Counter()}
        self.kills = self.starts = self.runs = 0
        self.slowest_release = 0.0
        self.faults = []

    def start(self, out, mode, resume):
        self.starts += 1
        return Started(command(out, mode, resume, self.report, self.overrides),
                       self.folder / "messages.txt")

    def uninterrupted(self):
        out = self.folder / "uninterrupted" / "run"
        begin = time.monotonic()
        run = self.start(out, "resident", resume=False)
        if run.process.wait() != 0:
            raise SystemExit(f"the uninterrupted run fails: {run.log.read_text()[-2000:]}")
        self.seconds = time.monotonic() - begin
        self.expected = results(out)

    def wrong(self, text):
        self.faults.append(f"kill {self.kills}: {text}")
        self.say(f"WRONG: {self.faults[-1]}")

    def kill(self, run):
        """Waits for the moment, kills the victim. Returns the signal, None if the run ended before."""
        longest = START_SECONDS if self.random.random() < 0.25 else 0.75 * self.seconds
        moment = time.monotonic() + self.random.uniform(0, longest)
        victim, sent = self.random.choice(VICTIMS), self.random.choice(self.signals)
        while run.process.poll() is None:
            if time.monotonic() >= moment:
                target = {**run.children(), "driver": run.pid, "group": -run.pid}.get(victim)
                if target is not None and kill_now(target, SIGNALS[sent]):
                    self.counts["victim"][victim] += 1
                    self.counts["signal"][sent] += 1
                    return SIGNALS[sent]
            time.sleep(0.001)
        return None

    def after_kill(self, run, before, signum):
        """Nobody is left, nothing is gone, nothing has changed."""
        try:
            code = run.process.wait(patience(PATIENCE))
        except Exception:
            self.wrong("the driver goes on without its child")
            os.killpg(run.pid, signal.SIGKILL)
            code = run.process.wait()
        if code not in (128 + signum, -signum, 0):
            self.wrong(f"{signum.name}: exit code {code}: {run.log.read_text()[-500:]}")
        if "Traceback" in run.log.read_text(errors="replace"):
            self.wrong(f"{signum.name}: {run.log.read_text(errors='replace')[-1500:]}")
        released = seconds_until_free(self.out)
        if released is None:
            self.wrong(f"somebody holds the directory: {processes_in(self.out)}")
        else:
            self.slowest_release = max(self.slowest_release, released)
        left = processes_in(self.out)
        if left:
            self.wrong(f"still at work: {left}")
        time.sleep(0.02)
        files = immutable_files(self.out)
        gone = [name for name, value in before.items() if files.get(name) != value]
        if gone:
            self.wrong(f"gone or changed: {gone}")
        if signum != signal.SIGKILL and temporary_files(self.out):
            self.wrong(f"{signum.name}: left behind: {temporary_files(self.out)}")
        return files

    def check_loss(self, run, files, checkpoint):
        """What a resumed run computes anew lies after the newest checkpoint that it found."""
        frames = sum(name.startswith("frames/") for name in files)
        event = run.first_progress()
        if event is None:
            return
        if event["stage"] == "shear":
            if event.get("frame", frames) < frames:
                self.wrong(f"frame {event['frame']} was computed anew, there were {frames}")
        elif frames or event["step"] < checkpoint:
            self.wrong(f"went back to step {event['step']} of the preparation; there were {frames} frames, and a "
                       f"checkpoint of step {checkpoint}")

    def one_run(self, enough):
        """Killed and resumed to its end, or until there were enough kills, then resumed to its end."""
        shutil.rmtree(self.out.parent, ignore_errors=True)
        files, checkpoint, resume = {}, 0, False
        while True:
            mode = self.random.choice(self.modes)
            begin = time.monotonic()
            run = self.start(self.out, mode, resume)
            signum = self.kill(run) if self.kills < enough else None
            if signum is not None:
                self.kills += 1
                self.counts["mode"][mode] += 1
                new = self.after_kill(run, files, signum)
                self.check_loss(run, files, checkpoint)
                phase = phase_of(self.out) if self.out.exists() else "before the first checkpoint"
                self.counts["phase"][phase] += 1
                files, checkpoint = new, step_of_newest_checkpoint(self.out)
                resume = True
                continue
            code = run.process.wait()
            if code != 0:
                self.wrong(f"exit code {code}: {run.log.read_text()[-2000:]}")
                return
            if not resume:
                self.seconds = min(self.seconds, time.monotonic() - begin)
            self.check_loss(run, files, checkpoint)
            self.runs += 1
            self.check_end(files)
            return

    def check_end(self, files):
        different = differences(results(self.out), self.expected)
        if different:
            self.wrong(f"other than uninterrupted: {different}")
        changed = [name for name, value in files.items() if immutable_files(self.out).get(name) != value]
        if changed:
            self.wrong(f"rewritten: {changed}")
        if temporary_files(self.out):
            self.wrong(f"left behind: {temporary_files(self.out)}")
        missing = missing_events(self.out)
        if missing:
            self.wrong(f"the ledger does not know of {missing}")


def missing_events(out):
    """Frames and splits that the ledger does not have with their present hash."""
    from rockbreak.run.ledger import read_ledger
    known = {event["path"]: event["payload_hash"] for event in read_ledger(RunDirectory(out).ledger_file)
             if event["event"] in ("frame", "split")}
    payloads = {name: value for name, value in results(out).items() if name.startswith(("frames/", "splits/"))}
    return sorted(name for name, value in payloads.items() if known.get(name) != value)


def kill_now(target, signum):
    try:
        os.killpg(-target, signum) if target < 0 else os.kill(target, signum)
    except ProcessLookupError:
        return False
    return True


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="tests/robustness/lost/kills")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--modes", default="resident,oneshot", help="drawn from for each start")
    parser.add_argument("--signals", default="kill", help="drawn from for each kill: " + ", ".join(SIGNALS))
    parser.add_argument("--no-report", action="store_true", help="end each run with its summary")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "lost" / "kills")
    options = parser.parse_args(arguments)
    options.out = options.out.resolve()

    shutil.rmtree(options.out, ignore_errors=True)
    options.out.mkdir(parents=True)
    campaign = Campaign(options.out, options.seed, options.modes.split(","), not options.no_report,
                        signals=options.signals.split(","))
    campaign.uninterrupted()
    print(f"uninterrupted: {campaign.seconds:.1f} s, {len(campaign.expected)} results", flush=True)
    while campaign.kills < options.kills and len(campaign.faults) < 20:
        campaign.one_run(options.kills)
        print(f"{campaign.kills} kills, {campaign.runs} runs to the end, {len(campaign.faults)} faults", flush=True)
    for name, counts in campaign.counts.items():
        print(f"{name}: " + ", ".join(f"{key} {count}" for key, count in counts.most_common()))
    print(f"{campaign.kills} kills, {campaign.starts} starts, {campaign.runs} runs to the end; the directory was free "
          f"within {campaign.slowest_release:.2f} s; {len(campaign.faults)} faults")
    return 1 if campaign.faults else 0
