"""What runs and campaigns show while they work, on stderr: something live on a terminal, JSON lines otherwise."""
import json
import sys
import time
from contextlib import contextmanager

from rich.console import Console
from rich.live import Live
from rich.text import Text


def time_text(seconds):
    if seconds is None:
        return "?"
    minutes, seconds = divmod(int(round(seconds)), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02d} min" if hours else f"{minutes} min {seconds:02d} s" if minutes else f"{seconds} s"


def bar(fraction, width):
    """Parts of a line of text."""
    filled = int(fraction * width)
    return ("━" * filled, "cyan"), ("━" * (width - filled), "bright_black")


def line(*parts):
    """One line, cut where the terminal ends."""
    return Text.assemble(*parts, no_wrap=True, overflow="ellipsis")


class JsonLines:
    """One JSON object per line; messages for people as they are."""

    def __init__(self, stream=None):
        self._stream = stream or sys.stderr

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def write(self, event):
        self.message(json.dumps(event))

    def message(self, text):
        self._stream.write(text + "\n")
        self._stream.flush()


class LiveDisplay:
    """Lines that are drawn anew in place; messages scroll above them. It can be entered again after its end."""

    def __init__(self, refresh_per_second):
        self._console = Console(stderr=True)
        self._live = Live(Text("starting"), console=self._console, refresh_per_second=refresh_per_second,
                          transient=True)
        self._start = time.monotonic()

    def __enter__(self):
        self._live.__enter__()
        return self

    def __exit__(self, *args):
        self._live.__exit__(*args)

    def elapsed(self):
        return time_text(time.monotonic() - self._start)

    def show(self, content):
        self._live.update(content)

    def message(self, text):
        self._console.print(text, markup=False, highlight=False)


def for_stderr(on_terminal, otherwise):
    """Makes what fits stderr."""
    return on_terminal() if sys.stderr.isatty() else otherwise()


@contextmanager
def doing(what):
    """Says what takes some time."""
    if sys.stderr.isatty():
        with Console(stderr=True).status(what):
            yield
    else:
        JsonLines().write({"event": "progress", "stage": what})
        yield
