"""What a run shows while it works: one live line on a terminal, JSON lines otherwise. Both on stderr."""
import json
import sys
import time

from rich.console import Console
from rich.live import Live
from rich.text import Text

from .ledger import kind_of


def time_text(seconds):
    if seconds is None:
        return "?"
    minutes, seconds = divmod(int(round(seconds)), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02d} min" if hours else f"{minutes} min {seconds:02d} s" if minutes else f"{seconds} s"


class TimeLeft:
    """Seconds to the target strain, from the pace of the last frames."""

    def __init__(self, window=40):
        self._window = window
        self._points = []

    def __call__(self, strain, target):
        self._points = (self._points + [(time.monotonic(), strain)])[-self._window:]
        (t0, s0), (t1, s1) = self._points[0], self._points[-1]
        if target is None or s1 <= s0:
            return None
        return max(0.0, (target - s1) * (t1 - t0) / (s1 - s0))


class JsonProgress:
    """One JSON object per line: every frame, every event of the children, but their progress at most once a second."""

    def __init__(self, stream=None):
        self._stream = stream or sys.stderr
        self._time_left = TimeLeft()
        self._last_progress = -1.0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def _print(self, event):
        self._stream.write(json.dumps(event) + "\n")
        self._stream.flush()

    def frame(self, state):
        left = self._time_left(state["axial_strain"], state["target_strain"])
        self._print({"event": "frame", **state, "seconds_left": None if left is None else round(left, 1)})

    def child_event(self, name, event):
        if event["event"] == "progress":
            now = time.monotonic()
            if now - self._last_progress < 1.0:
                return
            self._last_progress = now
        self._print({"source": name, **event})

    def message(self, text):
        self._stream.write(text + "\n")
        self._stream.flush()


class TerminalProgress:
    """A live line with strain, contacts, particles, broken and the time left; messages scroll above it."""

    BAR = 10
    PREPARATION = ("step", "void_ratio", "friction", "contacts")  # what fits into 80 columns

    def __init__(self):
        self._console = Console(stderr=True)
        self._live = Live(Text("starting"), console=self._console, refresh_per_second=8, transient=True)
        self._time_left = TimeLeft()
        self._warned = set()
        self._start = time.monotonic()

    def __enter__(self):
        self._live.__enter__()
        return self

    def __exit__(self, *args):
        self._live.__exit__(*args)

    def frame(self, state):
        strain, target = state["axial_strain"], state["target_strain"]
        left = self._time_left(strain, target)
        done = 0 if not target else min(1.0, strain / target)
        filled = int(done * self.BAR)
        parts = [("strain ", "bold"), ("━" * filled, "cyan"), ("━" * (self.BAR - filled), "bright_black"),
                 f" {strain:.1%}  {state['contacts']} contacts  {state['particles']} particles"]
        if state["broken"] is not None:
            parts.append(f"  {state['broken']} broken")
        parts.append((f"  {time_text(left)} left", "bright_black"))
        self._live.update(Text.assemble(*parts, no_wrap=True, overflow="ellipsis"))

    def child_event(self, name, event):
        if event["event"] == "progress" and event.get("stage") != "shear":
            fields = [f"{key.replace('_', ' ')} {value:.4g}" if isinstance(value, float) else f"{key} {value}"
                      for key, value in event.items() if key in self.PREPARATION]
            elapsed = time_text(time.monotonic() - self._start)
            self._live.update(Text.assemble((f"{event.get('stage', name)}  ", "bold"), "  ".join(fields),
                                            (f"  {elapsed}", "bright_black"), no_wrap=True, overflow="ellipsis"))
        elif event["event"] == "warning":
            text = f"{name}: warning: {event.get('text', '')}"
            if kind_of(text) not in self._warned:  # the others like it are in run.jsonl
                self._warned.add(kind_of(text))
                self.message(text)

    def message(self, text):
        self._console.print(text, markup=False, highlight=False)


def make_progress():
    return TerminalProgress() if sys.stderr.isatty() else JsonProgress()
