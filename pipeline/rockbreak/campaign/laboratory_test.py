"""What a study needs to know of `xfem lab`, as biaxial_test.py says it of a scene. A laboratory test prepares no
sample; its outcome has no randomness, so that its specimens are what scatters.
"""
import json

import yaml

from ..accuracy.measures import Measure
from .cases import as_words, explained, hash_of, value_at, without
from ..run.child import executable

# These say where numbers are from or what another program does with the test, not what it is.
PLACES = ("sweep", "material.name", "material.source", "material.rock")

MEASURES = {  # of an accuracy study, unless it names its own
    "initiation load": "initiation_load",
    "breakage load": "breakage_load",
    "path": "path",
    "angle [deg]": "angle",
    "smaller fragment": "fragment",
    "other verdict": "verdict",
    "stress field": "stress_field",
    "averaged stress": "averaged_stress",
}
# Name of an error measure: whether it is relative to a load, whether it is a share of specimens.
ERRORS = {"initiation_load": (True, False), "breakage_load": (True, False), "path": (False, False),
          "angle": (False, False), "fragment": (False, False), "verdict": (False, True), "stress_field": (False, False),
          "averaged_stress": (False, False)}

COSTS = (  # heading, column of accuracy.csv, number of the summary, factor; errors are held against the first
    ("particle [ms]", "particle_cpu_seconds", "cpu_seconds.particle", 1e3),
    ("set-up [ms]", "set_up_cpu_seconds", "cpu_seconds.set_up", 1e3),
    ("analysis [ms]", "analysis_cpu_seconds", "cpu_seconds.analysis", 1e3),
    ("analyses", "load_levels", "load_levels", 1),
    ("elements", "elements", "mesh.elements", 1),
)
COST_AXIS, COST_UNIT = "CPU time per particle [ms]", "ms"
COST_NOTE = ("Time per particle: CPU time of a thread for the set-up of a new particle (mesh, factor, averages) and "
             "one analysis, which is the mean over the test's load levels; median of three runs.")
TOTAL = "seconds"
REPEATS = 3  # of which the times are the medians
THEORY_NOTE = ", or from theory where a test has one (then the first rung has an error too)"
SPECIMENS = "specimens"


def error_measure(label, name):
    from . import laboratory_errors  # numpy, h5py and matplotlib are slow to load
    relative, is_share = ERRORS[name]
    return Measure(label, getattr(laboratory_errors, f"{name}_value", laboratory_errors.no_value),
                   getattr(laboratory_errors, name), relative, is_share)


def resolve(test, keys, where):
    """The test with every default, validated by `xfem`."""
    return yaml.safe_load(explained("xfem", test, keys, where).partition("# model of the specimen")[0])


def prepared_elsewhere(case):
    """There is nothing to prepare."""
    return ""


def identity(case, sample_hash):
    """Hash of all that decides the results of a run."""
    return hash_of([without(case, PLACES), sample_hash])


def effort(case):
    """How long a test takes, relative to others, so that long ones start first: about as its mesh has nodes."""
    return value_at(case, "mesh.nodes") or 1


def run_command(test, keys, out, report, threads):
    return [executable("xfem"), "lab", str(test), "--out", str(out), "--repeat", str(REPEATS), *as_words(keys)]


def read_summary(out):
    """The numbers of a test; None of one that has not been run to its end."""
    try:
        return json.loads((out / "summary.json").read_text(encoding="utf-8"))
    except (FileNotFoundError, json.JSONDecodeError):
        return None


def is_finished(out, report):
    return read_summary(out) is not None
