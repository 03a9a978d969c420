"""The two programs as the driver sees them, in either mode: it gives an order (`begin`, `proceed`, `ask`), has its own
work to do, and then waits for what came of it (`frame`, `answer`)."""
import re

from ..errors import IO_FAILURE, RockbreakError


class ResidentDem:
    """`dem run --serve`: one process for the whole run."""

    def __init__(self, run):
        self._run = run
        self._child = None

    def begin(self, newest):
        self._child = self._run.start("dem", [*self._run.dem_arguments(), "--serve"])

    def proceed(self, k, split):
        self._child.send(f"resume {split or '-'}")

    def frame(self):
        """Waits for the next frame; its number, None at an end before the final frame."""
        line = self._child.receive()
        if line == "done":
            self._child.finish()
            return None
        match = re.fullmatch(r"frame (\d+) (.+) (\d+) ([0-9a-f]+)", line)
        if not match:
            raise RockbreakError(IO_FAILURE, f"dem: expected `frame K PATH BYTES HASH`, found `{line}`")
        return int(match[1])

    def finish(self, k):
        """After the final frame; its split is not applied."""
        self._child.send("resume -")
        line = self._child.receive()
        if line != "done":
            raise RockbreakError(IO_FAILURE, f"dem: expected `done` after the final frame {k}, found `{line}`")
        self._child.finish()


class OneShotDem:
    """`dem run --until-frame K --resume`: one process per frame; it finds the split of the frame before by itself."""

    def __init__(self, run):
        self._run = run
        self._k = None
        self._child = None

    def begin(self, newest):
        self._start(0 if newest is None else newest + 1)

    def proceed(self, k, split):
        self._start(k + 1)

    def _start(self, k):
        self._k = k
        self._child = self._run.start("dem", [*self._run.dem_arguments(), "--until-frame", str(k)])

    def frame(self):
        self._child.finish()
        return self._k if self._run.directory.frame_file(self._k).exists() else None

    def finish(self, k):
        pass


class ResidentXfem:
    """`xfem serve`. It works inside the run directory, so that no path of its protocol can hold a blank."""

    def __init__(self, run):
        self._run = run
        self._child = None

    def ask(self, frame, previous, out):
        if self._child is None:
            self._child = self._run.start("xfem", ["serve", "--config", "case.yaml", *self._run.threads(),
                                                   "--profile", "-"], cwd=self._run.directory.path)
        self._child.send(f"solve {frame} {previous or '-'} {out}")

    def answer(self):
        """Waits until the split stands."""
        line = self._child.receive()
        if not re.fullmatch(r"split (.+) (\d+) ([0-9a-f]+)", line):
            raise RockbreakError(IO_FAILURE, f"xfem: expected `split OUT BYTES HASH`, found `{line}`")

    def finish(self):
        if self._child is not None:
            self._child.finish()


class OneShotXfem:
    """`xfem solve`: one process per split."""

    def __init__(self, run):
        self._run = run
        self._child = None

    def ask(self, frame, previous, out):
        self._child = self._run.start("xfem", ["solve", frame, "--config", "case.yaml", "--out", out,
                                               *(["--previous", previous] if previous else []),
                                               *self._run.threads(), "--profile", "-"],
                                      cwd=self._run.directory.path)

    def answer(self):
        self._child.finish()

    def finish(self):
        pass
