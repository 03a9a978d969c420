"""What a campaign shows while it works: one live line per running process and one for the whole on a terminal, JSON
lines otherwise. Both on stderr."""
import json
import sys
import time

from rich.console import Console, Group
from rich.live import Live
from rich.text import Text

from ..run.progress import time_text

JSON_INTERVAL = 5.0  # seconds between two lines on the whole campaign


class Tally:
    """Counts of runs, and the time left at the pace so far. Samples count through the runs that wait for them."""

    def __init__(self, jobs, runs, kept):
        self._jobs = jobs
        self._runs = runs
        self.kept = kept
        self._start = time.monotonic()

    def running(self):
        return [job for job in self._jobs if job.state == "running"]

    def counts(self):
        states = [job.state for job in self._runs]
        return {"runs": self.kept + len(states), "kept": self.kept, "done": states.count("done"),
                "failed": states.count("failed"), "running": len(self.running())}

    def elapsed(self):
        return time.monotonic() - self._start

    def seconds_left(self):
        ended = ("done", "failed")
        progress = sum(1.0 if job.state in ended else job.fraction for job in self._runs)
        if progress < 0.02:
            return None
        return self.elapsed() * (len(self._runs) - progress) / progress


class JsonCampaignProgress:
    def __init__(self, tally, stream=None):
        self._tally = tally
        self._stream = stream or sys.stderr
        self._last = 0.0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def _print(self, event):
        self._stream.write(json.dumps(event) + "\n")
        self._stream.flush()

    def changed(self, job):
        now = time.monotonic()
        if job is not None:
            self._print({"event": "job", "name": job.name, "state": job.state,
                         **({"code": job.code, "reason": job.reason} if job.state == "failed" else {}),
                         **({} if job.state == "running" else {"user_seconds": round(job.user_seconds, 2)})})
        elif now - self._last < JSON_INTERVAL:
            return
        self._last = now
        left = self._tally.seconds_left()
        self._print({"event": "campaign", **self._tally.counts(),
                     "seconds_left": None if left is None else round(left, 1)})

    def message(self, text):
        self._stream.write(text + "\n")
        self._stream.flush()


class TerminalCampaignProgress:
    BAR = 16
    NAME = 40

    def __init__(self, tally):
        self._tally = tally
        self._console = Console(stderr=True)
        self._live = Live(Text("starting"), console=self._console, refresh_per_second=4, transient=True)

    def __enter__(self):
        self._live.__enter__()
        return self

    def __exit__(self, *args):
        self._live.__exit__(*args)

    def changed(self, job):
        if job is not None and job.state == "failed":
            self.message(f"{job.name}: failed with exit code {job.code}: {job.reason}")
        self._live.update(Group(*(self._line(one) for one in self._tally.running()), self._whole()))

    def _line(self, job):
        filled = int(job.fraction * self.BAR)
        name = job.name if len(job.name) <= self.NAME else "…" + job.name[1 - self.NAME:]
        return Text.assemble((f"{name:<{self.NAME}} ", "bold"), ("━" * filled, "cyan"),
                             ("━" * (self.BAR - filled), "bright_black"), f" {job.stage}",
                             (f" {time_text(time.monotonic() - job.started)}", "bright_black"),
                             no_wrap=True, overflow="ellipsis")

    def _whole(self):
        count = self._tally.counts()
        parts = [(f"{count['done'] + count['kept']} of {count['runs']} runs done", "bold")]
        if count["failed"]:
            parts.append((f", {count['failed']} failed", "bold red"))
        parts.append((f"  {time_text(self._tally.seconds_left())} left", "bright_black"))
        return Text.assemble(*parts, no_wrap=True, overflow="ellipsis")

    def message(self, text):
        self._console.print(text, markup=False, highlight=False)


def make_campaign_progress(tally):
    return TerminalCampaignProgress(tally) if sys.stderr.isatty() else JsonCampaignProgress(tally)
