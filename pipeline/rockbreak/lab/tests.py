"""Which laboratory tests to run: files of a folder, each at all combinations of the values in its `sweep`.

  test: confined
  ...
  sweep:
    loading.confining_stress: [0.0, 4.0e+6]      # any key of the test, with its values
    mesh.nodes: [150, 300]
    rock:                                        # or a name of its own: label -> keys
      hard: {material.rock: ../rocks/granite.yaml}
      soft: {material.rock: ../rocks/marble.yaml, material.m_i: 8}

Values go to `xfem lab` word by word (`--set key=value`). A file named by a swept `material.rock` is sought from the
test's folder, like one that the test names.
"""
import itertools
from dataclasses import dataclass, field
from pathlib import Path

from ..campaign.table import axis_values, file_name, merged
from ..errors import BAD_INPUT, RockbreakError
from ..text_yaml import Section, read_mapping

FILE_KEYS = ("material.rock",)


@dataclass
class LabRun:
    """One test at one point of its sweep."""
    name: str                 # file's stem, and the labels of the sweep
    file: Path
    labels: tuple             # of (axis, label)
    keys: tuple               # of (key, text), from the sweep
    out: Path
    command: list = field(default_factory=list)
    summary: dict | None = None
    failure: str = ""
    code: int = 0


def find_tests(paths):
    """The YAML files that are named or stand in a named folder, each once."""
    files = []
    for path in paths:
        if path.is_dir():
            found = sorted(path.glob("*.yaml"))
            if not found:
                raise RockbreakError(BAD_INPUT, f"{path}: found no *.yaml, expected laboratory tests")
            files += found
        elif path.is_file():
            files.append(path)
        else:
            raise RockbreakError(BAD_INPUT, f"{path}: no such file or folder; expected a laboratory test or a folder "
                                 "of them")
    files = list(dict.fromkeys(file.resolve() for file in files))
    stems = {}
    for file in files:
        if file.stem in stems:
            raise RockbreakError(BAD_INPUT, f"{file}: its results would stand in the same directory as those of "
                                 f"{stems[file.stem]}; expected files of different names")
        stems[file.stem] = file
    return files


def plan_tests(paths, out, overrides):
    """All runs, in order. A key that is overridden is swept no more."""
    fixed = {override.partition("=")[0] for override in overrides}
    return [run for file in find_tests(paths) for run in runs_of(file, out, fixed)]


def runs_of(path, out, fixed):
    file = Section(path, read_mapping(path))
    if "test" not in file.content:
        file.fail("test", "found nothing, expected the kind of a laboratory test")
    sweep = file.mapping("sweep") if file.content.get("sweep") else Section(path, {}, "sweep")
    axes = [name for name in sweep.content if name not in fixed]
    points = itertools.product(*([(name, label, keys) for label, keys in axis_values(sweep, name)] for name in axes))
    runs = []
    for point in points:
        keys = tuple((key, absolute(key, value, path)) for key, value in merged(sweep, [keys for _, _, keys in point])
                     if key not in fixed)
        labels = tuple((name, Path(label).stem if name in FILE_KEYS else label) for name, label, _ in point)
        words = [file_name(f"{name.rpartition('.')[2]}-{label}") for name, label in labels]
        folder = out / path.stem / "_".join(words) if words else out / path.stem
        runs.append(LabRun(" ".join([path.stem, *words]), path, labels, keys, folder))
    return runs


def absolute(key, value, path):
    return str((path.parent / value).resolve()) if key in FILE_KEYS and value else value
