"""The coupled loop: frame K from `dem`, split K from `xfem`, back to `dem`, until the final frame.

In resident mode both programs stay, in one-shot mode a process is started per frame and per split (programs.py). Both
give the same payloads; so does a run that was killed and resumed. While a program works, the driver writes its ledger.
"""
import contextlib
import signal
import time
from dataclasses import dataclass, field
from pathlib import Path

from .child import Child, user_seconds_of_ended_children
from ..errors import BAD_INPUT, IO_FAILURE, Interrupted, RockbreakError
from .ledger import Ledger, read_ledger
from .payload_hash import xxh3_128
from .programs import OneShotDem, OneShotXfem, ResidentDem, ResidentXfem
from .restore import require_same, restore_frame
from .run_directory import RunDirectory, attributes, make_folder, open_written, refusals_of, state_of
from ..sealed import open_sealed


@dataclass
class Options:
    case: Path
    out: Path
    mode: str = "resident"
    resume: bool = False
    overrides: list = field(default_factory=list)
    threads: int | None = None


class Run:
    """One coupled run, from an empty or an interrupted directory to the split of its final frame."""

    def __init__(self, options, directory, lock, ledger, progress):
        self.options = options
        self.directory = directory
        self._lock = lock
        self._ledger = ledger
        self._progress = progress
        self._children = []
        self._broken = None
        self._breakable = None
        self._target_strain = None
        self.phases = {}  # program -> phase -> seconds, as told by children that came to their end
        self._dem = ResidentDem(self) if options.mode == "resident" else OneShotDem(self)
        self._xfem = ResidentXfem(self) if options.mode == "resident" else OneShotXfem(self)

    # -- what the two front ends need

    def threads(self):
        return [] if self.options.threads is None else ["--threads", str(self.options.threads)]

    def dem_arguments(self, out=None):
        """Always --resume: whether the directory may be used has been settled here. `out`: another directory."""
        overrides = [word for override in self.options.overrides for word in ("--set", override)]
        return ["run", str(self.options.case), "--out", str(out or self.options.out), "--resume", *overrides,
                *self.threads(), "--profile", "-"]

    def start(self, name, arguments, cwd=None):
        self._children = [child for child in self._children if child.is_alive()]
        child = Child(name, arguments, self._lock, self, cwd)
        self._children.append(child)
        return child

    def child_event(self, name, event):
        if event["event"] == "profile":
            spent = self.phases.setdefault(name, {})
            for phase, seconds in event["seconds"].items():
                spent[phase] = round(spent.get(phase, 0.0) + seconds, 6)
            return
        if event["event"] == "warning":
            self._ledger.write("warning", **{"source": name, **{k: v for k, v in event.items()
                                                                if k not in ("event", "time")}})
        self._progress.child_event(name, event)

    def child_message(self, name, text):
        """Text for people; `NAME: warning: TEXT` goes into the ledger as well."""
        mark = f"{name}: warning: "
        if text.startswith(mark):
            self.child_event(name, {"event": "warning", "text": text.removeprefix(mark)})
        else:
            self._progress.message(text)

    # -- the loop

    def execute(self):
        begin = time.perf_counter()
        try:
            self._loop()
            self.phases["wall"] = round(time.perf_counter() - begin, 6)
        except Interrupted as interrupt:
            self._stop_children(interrupt.signum)
            raise
        finally:
            self._stop_children(signal.SIGTERM)

    def _stop_children(self, signum):
        for child in self._children:
            child.stop(signum)

    def _loop(self):
        if not self.directory.has_case():
            self.directory.case_file.unlink(missing_ok=True)  # the head of one reads as a case with defaults
        newest = self.directory.newest_valid_frame()
        self.directory.clear_after(newest)
        if newest is not None:
            hashes = [self.directory.frame_hash(k) for k in range(newest + 1)]
            lost = None in hashes
            if lost or not self.directory.case_file.exists():
                self._settle_case(newest)
            self._learn_case()
            if lost:
                self._tell(newest)
            self._make_whole(hashes)
            self._tell(newest)
            if self._is_final(newest):
                return
        clock = time.perf_counter()
        self._dem.begin(newest)
        while (k := self._dem.frame()) is not None:
            arrived = asked = answered = time.perf_counter()
            self._learn_case()
            if self._breakable:
                asked = time.perf_counter()
                self._ask(k)
            final = self._register_frame(k, dem_seconds=arrived - clock)  # meanwhile xfem is at work
            if self._breakable:
                self._xfem.answer()
                answered = time.perf_counter()
            if not final:
                self._dem.proceed(k, self.directory.split_file(k) if self._breakable else None)
            clock = time.perf_counter()
            waited = answered - asked
            self._register_split(k, waited, handover=clock - arrived - waited)  # meanwhile dem is
            if final:
                self._dem.finish(k)
                self._xfem.finish()
                return
        raise RockbreakError(IO_FAILURE, "dem ended before the final frame")

    def _learn_case(self):
        """`dem` writes the resolved case.yaml before its first frame."""
        if self._breakable is not None:
            return
        case = self.directory.case()
        self._breakable = "breakage" in (case.get("effects") or [])
        self._target_strain = (case.get("shear") or {}).get("axial_strain")
        if self._breakable:
            make_folder(self.directory.path / "splits")
            self._broken = 0

    def _settle_case(self, newest):
        """A `dem` that has nothing left to do but to refuse another scene, and to write a case.yaml that is missing."""
        self.start("dem", [*self.dem_arguments(), "--until-frame", str(newest)]).finish()

    def _is_final(self, k):
        return bool(attributes(self.directory.frame_file(k)).get("final", 0))

    def _make_whole(self, hashes):
        """Every frame and split up to the newest frame stands, and the ledger has it: also those that a machine lost as
        it went down, and those that the driver had not written down when it was killed. `hashes`: of the frames, None
        for those that do not stand."""
        known = {event.get("path"): event.get("payload_hash") for event in read_ledger(self.directory.ledger_file)
                 if event["event"] in ("frame", "split")}
        for k, frame_hash in enumerate(hashes):
            frame, split = f"frames/{k:06d}.h5", f"splits/{k:06d}.h5"
            answered, broken = self.directory.answer(k)
            begin = time.perf_counter()
            lost = frame_hash is None
            if lost:
                frame_hash = restore_frame(self, k, known.get(frame) or answered)
            if lost or frame not in known:
                self._register_frame(k, dem_seconds=time.perf_counter() - begin if lost else 0.0)
            if not self._breakable:
                continue
            begin = time.perf_counter()
            stands = answered == frame_hash
            if not stands:
                self.directory.split_file(k).unlink(missing_ok=True)
                self._ask(k)
                self._xfem.answer()
                if k + 1 < len(hashes):  # the frame after it stands on it
                    require_same(self.directory.split_file(k), known.get(split))
            if stands and split in known:
                self._broken += broken
            else:
                self._register_split(k, waited=0.0 if stands else time.perf_counter() - begin, handover=0.0)

    def _ask(self, k):
        self._xfem.ask(f"frames/{k:06d}.h5", f"splits/{k - 1:06d}.h5" if k > 0 else None, f"splits/{k:06d}.h5")

    def _register_frame(self, k, dem_seconds):
        with open_written(self.directory.frame_file(k), "frame") as (file, written):
            state, final = state_of(k, file), bool(file.attrs["final"])
        self._ledger.write("frame", **state, final=final, **written, seconds={"dem": round(dem_seconds, 6)})
        self._show(state)
        return final

    def _tell(self, newest):
        """Where a resumed run stands."""
        with open_sealed(self.directory.frame_file(newest)) as file:
            self._show(state_of(newest, file))

    def _show(self, state):
        self._progress.frame({**state, "broken": self._broken, "target_strain": self._target_strain})

    def _register_split(self, k, waited, handover):
        if not self._breakable:
            return
        with open_written(self.directory.split_file(k), "split") as (file, written):
            broken, refusals = len(file["broken/parent"]), refusals_of(file)
        self._broken += broken
        self._ledger.write("split", frame=k, broken=broken, **written,
                           seconds={"xfem": round(waited, 6), "handover": round(handover, 6)})
        for particle, reason in refusals:
            self.child_event("xfem", {"event": "warning", "frame": k, "particle": particle,
                                      "text": f"frame {k}: particle {particle}: analysis refused: {reason}"})


def catch_signals():
    """SIGINT and SIGTERM raise Interrupted, once."""
    for one in (signal.SIGINT, signal.SIGTERM):
        signal.signal(one, _raise_interrupted)


def _raise_interrupted(signum, _):
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise Interrupted(signum)


def cpu_seconds():
    return {"cpu_seconds": round(user_seconds_of_ended_children(), 3)}


def drive(options, progress):
    """Runs to the end or raises. Returns the run directory."""
    if not options.case.is_file():
        raise RockbreakError(BAD_INPUT, f"{options.case}: no such file; expected a scene (YAML), for example "
                             "configs/demo.yaml")
    directory = RunDirectory(options.out)
    with directory.lock() as lock:
        if not options.resume and not directory.is_empty():
            raise RockbreakError(BAD_INPUT, f"{options.out}: is not empty; go on with --resume, or choose another "
                                 "--out")
        catch_signals()
        with Ledger(directory.ledger_file) as ledger, progress:
            scene = {"scene_hash": xxh3_128(options.case.read_bytes()), "overrides": options.overrides}
            starts = [event for event in read_ledger(directory.ledger_file) if event["event"] == "start"]
            ledger.write("start", case=str(options.case), **scene, mode=options.mode, resume=options.resume,
                         threads=options.threads)
            run = Run(options, directory, lock, ledger, progress)
            if starts and directory.case_file.exists() and {key: starts[0].get(key) for key in scene} != scene:
                run.child_event("driver", {"event": "warning", "text": f"{options.case} or its --set is not what "
                                           f"{directory.path} was started with; {directory.case_file} stays in force, "
                                           "but for its guards"})
            try:
                run.execute()
            except (RockbreakError, Interrupted) as end:
                with contextlib.suppress(RockbreakError):  # the ledger may be what fails
                    ledger.write("end", code=end.code, reason=end.reason, **cpu_seconds())
                raise
            ledger.write("end", code=0, phases=run.phases, **cpu_seconds())
    return directory
