"""What a run shows while it works: one live line on a terminal, JSON lines otherwise. Both on stderr."""
import time

from ..live import JsonLines, LiveDisplay, bar, for_stderr, line, time_text
from .ledger import kind_of


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


class JsonProgress(JsonLines):
    """Every frame, every event of the children, but their progress at most once a second."""

    def __init__(self, stream=None):
        super().__init__(stream)
        self._time_left = TimeLeft()
        self._last_progress = -1.0

    def frame(self, state):
        left = self._time_left(state["axial_strain"], state["target_strain"])
        self.write({"event": "frame", **state, "seconds_left": None if left is None else round(left, 1)})

    def stage(self, name):
        self.write({"source": "driver", "event": "progress", "stage": name})

    def child_event(self, name, event):
        if event["event"] == "progress":
            now = time.monotonic()
            if now - self._last_progress < 1.0:
                return
            self._last_progress = now
        self.write({"source": name, **event})


class TerminalProgress(LiveDisplay):
    """A live line with strain, contacts, particles, broken and the time left; messages scroll above it."""

    BAR = 10
    PREPARATION = ("step", "void_ratio", "friction", "contacts")  # what fits into 80 columns

    def __init__(self):
        super().__init__(refresh_per_second=8)
        self._time_left = TimeLeft()
        self._warned = set()

    def frame(self, state):
        strain, target = state["axial_strain"], state["target_strain"]
        left = self._time_left(strain, target)
        parts = [("strain ", "bold"), *bar(min(1.0, strain / target) if target else 0, self.BAR),
                 f" {strain:.1%}  {state['contacts']} contacts  {state['particles']} particles"]
        if state["broken"] is not None:
            parts.append(f"  {state['broken']} broken")
        self.show(line(*parts, (f"  {time_text(left)} left", "bright_black")))

    def stage(self, name, fields=()):
        self.show(line((f"{name}  ", "bold"), "  ".join(fields), (f"  {self.elapsed()}", "bright_black")))

    def child_event(self, name, event):
        if event["event"] == "progress" and event.get("stage") != "shear":
            self.stage(event.get("stage", name), [
                f"{key.replace('_', ' ')} {value:.4g}" if isinstance(value, float) else f"{key} {value}"
                for key, value in event.items() if key in self.PREPARATION])
        elif event["event"] == "warning":
            text = f"{name}: warning: {event.get('text', '')}"
            if kind_of(text) not in self._warned:  # the others like it are in run.jsonl
                self._warned.add(kind_of(text))
                self.message(text)


def make_progress():
    return for_stderr(TerminalProgress, JsonProgress)
