"""Local processes of a campaign: at most so many at a time, each after the one that it needs; of those that could
start, the one whose work, with what waits for it, takes longest. One that fails stops nobody but those that need it."""
import json
import signal
import time
from dataclasses import dataclass, field
from pathlib import Path

from ..run.child import Child, exit_code, user_seconds_of_ended_children
from ..errors import Interrupted

PAUSE = 0.05  # seconds between two looks at the processes
QUIET_EVENTS = ("progress", "frame")  # not kept in the log
SHEARED = 0.95  # of a run's way at its final strain; the rest is summary and report


@dataclass
class Job:
    name: str
    command: list
    log: Path
    after: "Job | None" = None
    effort: float = 1.0     # how long it takes, relative to the others
    state: str = "waiting"  # waiting, running, done, failed
    code: int = 0
    reason: str = ""
    user_seconds: float = 0.0
    started: float = 0.0
    fraction: float = 0.0   # of its way
    began_at: float = 0.0   # fraction that stood there when it was started
    stage: str = ""
    said: list = field(default_factory=list)
    child: Child | None = None

    # -- what the process says on stderr (heard on a thread of its own)

    def child_event(self, _, event):
        if event["event"] == "frame":
            share = min(1.0, event["axial_strain"] / event["target_strain"]) if event.get("target_strain") else 0.0
            if self.stage != "shear":
                self.began_at = SHEARED * share
            self.stage, self.fraction = "shear", SHEARED * share
        elif event["event"] == "progress":
            self.stage = event.get("stage", self.stage)
        if event["event"] not in QUIET_EVENTS:
            self._keep(json.dumps(event))

    def child_message(self, _, text):
        self.said.append(text)
        self._keep(text)

    def _keep(self, line):
        with open(self.log, "a", encoding="utf-8") as file:
            file.write(line + "\n")

    # -- its life

    def never_started(self):
        return self.child is None and self.state == "failed"

    def start(self, lock):
        self.log.parent.mkdir(parents=True, exist_ok=True)
        self.state, self.stage, self.started = "running", "starting", time.monotonic()
        self.child = Child(self.name, self.command[1:], lock, self, program=self.command[0])

    def poll(self):
        """True if it has just ended."""
        before = user_seconds_of_ended_children()
        if self.child.is_alive():
            return False
        self.code = exit_code(self.child.wait())
        self.user_seconds = user_seconds_of_ended_children() - before
        self.state, self.fraction = ("done", 1.0) if self.code == 0 else ("failed", self.fraction)
        self.reason = "" if self.code == 0 else self._last_error()
        return True

    def _last_error(self):
        errors = [text for text in self.said if "error:" in text] or self.said
        return errors[-1] if errors else f"ended with exit code {self.code} and no message"


def path_lengths(jobs):
    """Name -> effort of a job and of the longest chain that waits for it."""
    waiting = {}
    for job in jobs:
        if job.after:
            waiting.setdefault(job.after.name, []).append(job)

    def length(job):
        return job.effort + max((length(one) for one in waiting.get(job.name, [])), default=0.0)

    return {job.name: length(job) for job in jobs}


def next_jobs(jobs, slots):
    """Those to start now, longest path first, in their order where paths are equal: no slot stays empty while a job is
    ready, and no long run is left for the end."""
    ready = [job for job in jobs if job.state == "waiting" and (job.after is None or job.after.state == "done")]
    lengths = path_lengths([job for job in jobs if job.state == "waiting"])
    ready.sort(key=lambda job: -lengths[job.name])
    return ready[:slots - sum(job.state == "running" for job in jobs)]


def run_jobs(jobs, slots, lock, on_change):
    """Runs all jobs; `on_change(job)` is told of each start and end, `on_change(None)` that time goes by.
    Children are started on this thread: the kernel ends them when the thread that started them is gone."""
    try:
        while True:
            for job in jobs:
                if job.state == "running" and job.poll():
                    on_change(job)
            for job in jobs:
                if job.state == "waiting" and job.after and job.after.state == "failed":
                    job.state, job.code = "failed", job.after.code
                    job.reason = f"its sample could not be prepared: {job.after.reason}"
                    on_change(job)
            for job in next_jobs(jobs, slots):
                job.start(lock)
                on_change(job)
            if all(job.state in ("done", "failed") for job in jobs):
                return
            on_change(None)
            time.sleep(PAUSE)
    except Interrupted as interrupt:
        stop(jobs, interrupt.signum)
        raise
    finally:
        stop(jobs, signal.SIGTERM)


def stop(jobs, signum):
    for job in jobs:
        if job.state == "running" and job.child.is_alive():
            job.child.stop(signum)
