"""Numbers that a case names by a path, read from what its commands left.

    FILE:NAME[:REDUCTION]    NAME a dataset, a root attribute (@name) or a key of a JSON file (a.b.c)
FILE is relative to the case's folder; `history` stands for the history of all frames, `frames/last.h5` for the newest
frame (and `splits/last.h5` for the newest split), `stdout` for the JSON that the last command printed.
REDUCTION: last (default), first, min, max, max_abs, sum, mean, size, count=VALUE, or at=INDEX (from 0, rows one after
another). Two paths, or a path and a number,
may be joined by ` / `, ` - ` or ` + `, worked off from left to right.
"""
import json
import re

import h5py
import numpy as np

REDUCTIONS = {
    "first": lambda a: a.flat[0], "last": lambda a: a.flat[-1], "min": np.min, "max": np.max, "sum": np.sum,
    "mean": np.mean, "max_abs": lambda a: np.max(np.abs(a)), "size": lambda a: a.shape[0],
}
OPERATIONS = {"/": lambda a, b: a / b if b else float("nan"), "-": lambda a, b: a - b, "+": lambda a, b: a + b}


class NoNumber(Exception):
    """What a path names does not exist or is no number."""


def value_of(path, out, stdout):
    """The number that a path names."""
    words = re.split(r" ([/+-]) ", path)
    value = term(words[0], out, stdout)
    for operation, word in zip(words[1::2], words[2::2]):
        value = OPERATIONS[operation](value, term(word, out, stdout))
    return value


def term(word, out, stdout):
    try:
        return float(word)
    except ValueError:
        pass
    parts = word.strip().split(":")
    if len(parts) not in (2, 3):
        raise NoNumber(f"{word}: expected FILE:NAME or FILE:NAME:REDUCTION")
    values = np.asarray(read(parts[0], parts[1], out, stdout))
    reduction = parts[2] if len(parts) == 3 else "last"
    if values.dtype.kind not in "biuf":
        raise NoNumber(f"{word}: found {values.dtype}, expected numbers")
    if reduction.startswith("count="):
        return float(np.sum(values == float(reduction.removeprefix("count="))))
    if reduction.startswith("at="):
        index = int(reduction.removeprefix("at="))
        if not 0 <= index < values.size:
            raise NoNumber(f"{word}: has {values.size} numbers")
        return float(values.flat[index])
    if reduction not in REDUCTIONS:
        raise NoNumber(f"{word}: found {reduction}, expected " + ", ".join([*REDUCTIONS, "count=VALUE", "at=INDEX"]))
    if values.size == 0:
        if reduction in ("size", "sum"):
            return 0.0
        raise NoNumber(f"{word}: is empty")
    return float(REDUCTIONS[reduction](np.atleast_1d(values)))


def read(file, name, out, stdout):
    try:
        if file == "stdout":
            return key_of(json.loads(stdout), name)
        if file == "history":
            frames = sorted((out / "frames").glob("*.h5"))
            return np.concatenate([dataset(frame, f"history/{name}") for frame in frames])
        path = newest(out / file)
        return key_of(json.loads(path.read_text()), name) if path.suffix == ".json" else dataset(path, name)
    except (OSError, ValueError, KeyError, IndexError, TypeError) as error:
        raise NoNumber(f"{file}:{name}: {type(error).__name__}: {error}") from error


def newest(path):
    return sorted(path.parent.glob("*.h5"))[-1] if path.name == "last.h5" else path


def dataset(path, name):
    with h5py.File(path, "r") as file:
        return file.attrs[name[1:]] if name.startswith("@") else file[name][()]


def key_of(data, name):
    for key in name.split("."):
        data = data[int(key)] if isinstance(data, list) else data[key]
    return data
