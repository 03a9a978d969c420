"""Child processes, `dem` and `xfem` before all: lines on stdin and stdout, events and messages on stderr."""
import json
import os
import resource
import shutil
import signal
import subprocess
import threading
import time
from pathlib import Path

from ..errors import BAD_INPUT, IO_FAILURE, RockbreakError

REPOSITORY = Path(__file__).resolve().parents[3]


def binaries():
    """Folder of the build whose programs run: $ROCKBREAK_BIN if that is set, else build/release."""
    return Path(os.environ.get("ROCKBREAK_BIN") or REPOSITORY / "build" / "release").resolve()


def executable(name):
    """Path of `dem` or `xfem`."""
    path = binaries() / name
    if not os.access(path, os.X_OK):
        raise RockbreakError(BAD_INPUT, f"{path}: no such executable; build it with pipeline/setup")
    return str(path)


def exit_code(returncode):
    """Of a process: its own, or 128 + the signal that ended it."""
    return returncode if returncode >= 0 else 128 - returncode


def user_seconds_of_ended_children():
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


class Child:
    """One running executable. It stays in this process group and inherits the lock of the run directory (its
    descriptor stands in ROCKBREAK_LOCK, so that `dem` knows that it need not wait for it), and the kernel ends it
    should this process be killed: nothing writes to a directory that nobody holds."""

    def __init__(self, name, arguments, lock, listener, cwd=None, program=None):
        """`program`: its path; without one, `name` is that of an executable of ours."""
        self.name = name
        self._listener = listener
        self._said = []  # messages for people, as heard on stderr
        self._trouble = None  # what went wrong on our side while listening
        command = [program or executable(name), *arguments]
        if shutil.which("setpriv"):
            command = ["setpriv", "--pdeathsig", "KILL", *command]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=cwd,
                                         stderr=subprocess.PIPE, text=True, bufsize=1, errors="replace",
                                         pass_fds=[lock.fileno()],
                                         env={**os.environ, "ROCKBREAK_LOCK": str(lock.fileno())})
        self._stderr = threading.Thread(target=self._listen, daemon=True)
        self._stderr.start()

    def _listen(self):
        """Events go to the listener as dictionaries, any other line as text."""
        for line in self._process.stderr:
            line = line.rstrip("\n")
            try:
                event = json.loads(line)
            except json.JSONDecodeError:
                event = None
            try:
                if isinstance(event, dict) and "event" in event:
                    self._listener.child_event(self.name, event)
                elif line:
                    self._said.append(line)
                    self._listener.child_message(self.name, line)
            except RockbreakError as error:  # the child must not stand still over a full pipe
                self._trouble = self._trouble or error

    def send(self, line):
        try:
            self._process.stdin.write(line + "\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            self.fail()

    def receive(self):
        """The next line of its stdout, `done` at an orderly end. Raises what a failure says."""
        line = self._process.stdout.readline().rstrip("\n")
        if self._trouble:
            raise self._trouble
        if line.startswith("error "):
            _, code, text = (line.split(" ", 2) + [""])[:3]
            self.wait()
            said = text in " ".join(self._said)
            raise RockbreakError(int(code) if code.isdigit() else IO_FAILURE,
                                 f"{self.name} failed; its message stands above" if said else f"{self.name}: {text}",
                                 f"{self.name}: {text}")
        if not line:
            if self.wait() != 0:
                self.fail()
            return "done"
        return line

    def wait(self):
        """Exit code, after everything that it had to say has been heard."""
        self._close_stdin()
        self._process.stdout.read()
        code = self._process.wait()
        self._stderr.join()
        return code

    def fail(self):
        """Raises the error that its death stands for."""
        code = self.wait()
        if code < 0:
            name = signal.Signals(-code).name
            raise RockbreakError(exit_code(code), f"{self.name} was ended by signal {-code} ({name})")
        if code == 0:
            raise RockbreakError(IO_FAILURE, f"{self.name} ended before its work was done")
        raise RockbreakError(code, f"{self.name} failed with exit code {code}"
                             + ("; its message stands above" if self._said else ""), self._last_words())

    def _last_words(self):
        """All that it said from its last error on."""
        errors = [i for i, text in enumerate(self._said) if "error:" in text]
        return " ".join(self._said[errors[-1]:]) if errors else None

    def finish(self):
        """Waits for an orderly end."""
        if self.wait() != 0:
            self.fail()
        if self._trouble:
            raise self._trouble

    def stop(self, signum=signal.SIGTERM, patience=10.0):
        """Ends it: a closed stdin, then the signal, then (after `patience` seconds) by force."""
        self._close_stdin()
        if not self._gone_within(0.2):
            self._process.send_signal(signum)
        if not self._gone_within(patience):
            self._process.kill()
            self._process.wait()
        self._stderr.join(1.0)

    def is_alive(self):
        return self._process.poll() is None

    def _gone_within(self, seconds):
        end = time.monotonic() + seconds
        while self._process.poll() is None:
            if time.monotonic() > end:
                return False
            time.sleep(0.01)
        return True

    def _close_stdin(self):
        try:
            self._process.stdin.close()
        except BrokenPipeError:
            pass
