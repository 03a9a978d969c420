"""What a campaign shows while it works: one live line per running process and one for the whole on a terminal, JSON
lines otherwise. Both on stderr."""
import time

from rich.console import Group

from ..live import JsonLines, LiveDisplay, bar, for_stderr, line, time_text

JSON_INTERVAL = 5.0  # seconds between two lines on the whole campaign
KNOWN = 0.02         # part of the work from which on its pace says something


class Tally:
    """Counts of runs, and the time left at the pace so far."""

    def __init__(self, jobs, runs, kept, clock=time.monotonic):
        self._jobs = jobs
        self._runs = runs
        self.kept = kept
        self._clock = clock
        self._start = clock()

    def running(self):
        return [job for job in self._jobs if job.state == "running"]

    def counts(self):
        states = [job.state for job in self._runs]
        return {"runs": self.kept + len(states), "kept": self.kept, "done": states.count("done"),
                "failed": states.count("failed"), "running": len(self.running())}

    def seconds_left(self):
        """Of all jobs, samples too, by their efforts; never less than the running one that is last at its own pace.
        What stood there before this start (a resumed run's frames) took no time; None while too little is done to
        tell."""
        now = self._clock()
        jobs = [job for job in self._jobs if job.state != "failed"]
        done = sum(job.effort * (job.fraction - job.began_at) for job in jobs)
        left = sum(job.effort * (1.0 - job.fraction) for job in jobs)
        if done < KNOWN * (done + left) or not jobs:
            return None
        return max([(now - self._start) * left / done if done else 0.0,
                    *((now - job.started) * (1.0 - job.fraction) / (job.fraction - job.began_at)
                      for job in self.running() if job.fraction - job.began_at > KNOWN)])


class JsonCampaignProgress(JsonLines):
    def __init__(self, tally, stream=None):
        super().__init__(stream)
        self._tally = tally
        self._last = 0.0

    def changed(self, job):
        now = time.monotonic()
        if job is not None:
            self.write({"event": "job", "name": job.name, "state": job.state,
                        **({"code": job.code, "reason": job.reason} if job.state == "failed" else {}),
                        **({} if job.state == "running" else {"user_seconds": round(job.user_seconds, 2)})})
        elif now - self._last < JSON_INTERVAL:
            return
        self._last = now
        left = self._tally.seconds_left()
        self.write({"event": "campaign", **self._tally.counts(),
                    "seconds_left": None if left is None else round(left, 1)})


class TerminalCampaignProgress(LiveDisplay):
    BAR = 16
    BESIDE = 29  # columns for stage and time: "densification 12 min 30 s"

    def __init__(self, tally):
        super().__init__(refresh_per_second=4)
        self._tally = tally

    def changed(self, job):
        if job is not None and job.state == "failed":
            self.message(f"{job.name}: not started, its sample could not be prepared" if job.never_started() else
                         f"{job.name}: failed with exit code {job.code}: {job.reason}")
        running = self._tally.running()
        width = min(max((len(one.name) for one in running), default=0),
                    max(20, self._console.width - self.BAR - self.BESIDE))
        self.show(Group(*(self._line(one, width) for one in running), self._whole()))

    def _line(self, job, width):
        name = job.name if len(job.name) <= width else "…" + job.name[1 - width:]
        return line((f"{name:<{width}} ", "bold"), *bar(job.fraction, self.BAR), f" {job.stage}",
                    (f" {time_text(time.monotonic() - job.started)}", "bright_black"))

    def _whole(self):
        count = self._tally.counts()
        parts = [(f"{count['done'] + count['kept']} of {count['runs']} runs done", "bold")]
        if count["failed"]:
            parts.append((f", {count['failed']} failed", "bold red"))
        if count["done"] + count["kept"] + count["failed"] < count["runs"]:
            parts.append((f"  {time_text(self._tally.seconds_left())} left", "bright_black"))
        return line(*parts)


def make_campaign_progress(tally):
    return for_stderr(lambda: TerminalCampaignProgress(tally), lambda: JsonCampaignProgress(tally))
