"""What a campaign needs to know of its kind of run: how `pipeline/run` is called for a biaxial test, what identifies
it, which part of it its preparation sees, where its numbers stand. Another kind of run has the same functions.
"""
from pathlib import Path

import yaml

from .cases import as_words, explained, hash_of, value_at, without
from ..run.child import REPOSITORY, executable
from ..run.run_directory import RunDirectory, attributes, plain
from ..sealed import is_sealed, open_sealed

# Preparation sees the other keys; so does it any key that is new.
UNSEEN_SECTIONS = ("shear", "breakage", "output")
SEEN_OF_MATERIAL = ("density",)
UNSEEN_EFFECTS = ("breakage", "toughness", "face_friction")
# These say where things stand, not what they are.
PLACES = ("output", "preparation.from", "assembly.shapes.file")
FROM = "preparation.from"

OVERVIEW = (  # columns of a campaign's page: heading, number of the summary, format
    ("particles, end", "particles_final", "{:.0f}"),
    ("broken", "broken_total", "{:.0f}"),
    ("contacts, start", "contacts_initial", "{:.0f}"),
    ("contacts, peak", "contacts_peak", "{:.0f}"),
    ("contacts, end", "contacts_final", "{:.0f}"),
    ("e, start", "initial_void_ratio", "{:.3f}"),
    ("e, end", "final_void_ratio", "{:.3f}"),
    ("peak sin φ", "peak_sin_phi", "{:.3f}"),
    ("at strain", "peak_strain", "{:.1%}"),
    ("residual sin φ", "residual_sin_phi", "{:.3f}"),
    ("CPU [s]", "cpu_seconds", "{:.1f}"),
)
TRENDS = (  # of these, against an axis with numbers
    ("peak sin φ", "peak_sin_phi"), ("residual sin φ", "residual_sin_phi"), ("void ratio, end", "final_void_ratio"),
    ("contacts, end", "contacts_final"),
)

COSTS = (  # heading, column of accuracy.csv, number of the summary, factor; errors are held against the first
    ("CPU [s]", "cpu_seconds", "cpu_seconds", 1),
    ("contact-steps", "contact_steps", "contact_steps", 1),
)
COST_AXIS, COST_UNIT = "CPU time [s]", "s"
TOTAL = "cpu_seconds"
COST_NOTE = ("CPU time: user seconds of the shear stage; the prepared sample is counted apart. Contact-steps do not "
             "depend on the machine.")
THEORY_NOTE = ""
SPECIMENS = "seeds"
ERRORS = ()  # measures beyond the numbers of summary.json
MEASURES = {  # of an accuracy study, unless it names its own
    "peak sin φ": "peak_sin_phi",
    "residual sin φ": "residual_sin_phi",
    "final void ratio": "final_void_ratio",
    "contacts per particle, peak": "contacts_peak / particles_initial",
    "contacts per particle, end": "contacts_final / particles_initial",
}


def resolve(scene, keys, where):
    """The scene with every default, validated by `dem`; `where` names the row of the table for a message."""
    return yaml.safe_load(explained("dem", scene, keys, where))


def prepared_elsewhere(case):
    """Payload hash of the sample that the scene itself starts from; None if it prepares its own."""
    file = value_at(case, FROM)
    return attributes(Path(file)).get("payload_hash") if file else None


def seen_by_preparation(key):
    section, _, name = key.partition(".")
    return section not in UNSEEN_SECTIONS and key not in PLACES and (section != "material" or name in SEEN_OF_MATERIAL)


def breaks(case):
    return "breakage" in (case.get("effects") or [])


def without_rock(case):
    """A scene without what only breakage sees."""
    seen = without(case, ("breakage",))
    seen["material"] = {key: value for key, value in seen.get("material", {}).items() if key in SEEN_OF_MATERIAL}
    seen["effects"] = sorted(effect for effect in seen["effects"] if effect not in UNSEEN_EFFECTS)
    return seen


def sample_case(case, base_case, shared_keys):
    """What the preparation sees of a resolved scene; shared keys have the values of the base."""
    seen = without_rock(without(case, (*PLACES, *UNSEEN_SECTIONS)))
    for key in shared_keys:
        section, _, name = key.rpartition(".")
        (value_at(seen, section) if section else seen)[name] = value_at(base_case, key)
    return seen


def identity(case, sample_hash):
    """Hash of all that decides the results of a run: without breakage, the rock does not."""
    seen = without(case, PLACES)
    return hash_of([seen if breaks(case) else without_rock(seen), sample_hash])


def effort(case):
    """How long a run takes from its sample, relative to others, so that long ones start first: particles times
    duration, and more with breakage, the higher the pressure (3.2 times as long at 2 MPa in
    configs/biaxial_2MPa_breakable.yaml)."""
    shear = case.get("shear") or {}
    duration = shear.get("axial_strain", 1.0) / shear.get("strain_rate", 1.0)
    breakage = 1.1e-6 * (value_at(case, "preparation.confining_pressure") or 0.0) * breaks(case)
    return (value_at(case, "assembly.particles") or 1) * duration * (1.0 + breakage)


def sample_effort(case):
    """As effort(), of the preparation."""
    return 0.3 * effort({**case, "effects": []})


def run_command(scene, keys, out, report, threads):
    return [str(REPOSITORY / "pipeline" / "run"), str(scene), "--out", str(out), "--resume", *as_words(keys),
            *([] if report else ["--no-report"]), *([] if threads is None else ["--threads", str(threads)])]


def sample_command(scene, keys, case, shared_keys, out, threads):
    """Prepares a sample and stops before shear."""
    seen = {key: value for key, value in keys.items() if seen_by_preparation(key) and key not in shared_keys}
    seen["effects"] = f"[{', '.join(effect for effect in case['effects'] if effect not in UNSEEN_EFFECTS)}]"
    return [executable("dem"), "run", str(scene), "--out", str(out), "--resume", "--until-frame", "0", *as_words(seen),
            *([] if threads is None else ["--threads", str(threads)])]


def sample_file(out):
    return out / "prepared" / "sample.h5"


def sample_is_finished(out):
    """Frame 0 is written after the sample."""
    return all(map(is_sealed, sample_results(out)))


def clear_sample(out):
    """Makes way for a sample to be prepared: `dem` does not where a frame 0 stands, as if from a damaged one."""
    if not is_sealed(sample_file(out)):
        RunDirectory(out).frame_file(0).unlink(missing_ok=True)


def sample_results(out):
    """What a finished sample has written."""
    return [sample_file(out), RunDirectory(out).frame_file(0)]


def results(out, report):
    """What a finished run has written last."""
    directory = RunDirectory(out)
    return [directory.summary_file, *([directory.report_file] if report else [])]


def read_summary(out):
    """The numbers of a run that has reached its end; None of any other."""
    summary = RunDirectory(out).summary()
    return summary if summary and summary.get("complete") else None


def made_by(out):
    """The version of `dem` that began a run, as its first frame tells; None if it does not."""
    with open_sealed(RunDirectory(out).frame_file(0)) as frame:
        return plain(frame["provenance"].attrs.get("git")) if "provenance" in frame else None


def is_finished(out, report):
    return read_summary(out) is not None and (not report or RunDirectory(out).report_file.exists())
