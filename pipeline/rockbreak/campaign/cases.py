"""Resolved cases: nested dictionaries whose keys have dotted names, as on the command line."""
import copy
import json
import subprocess

from ..run.child import executable, exit_code
from ..errors import RockbreakError
from ..run.payload_hash import xxh3_128


def as_words(keys):
    return [word for key, value in keys.items() for word in ("--set", f"{key}={value}")]


def explained(program, file, keys, where):
    """What `PROGRAM explain` prints of a file with its keys, which validates it; `where` names the row of the table for
    a message. Its exit code passes through."""
    process = subprocess.run([executable(program), "explain", str(file), *as_words(keys)], capture_output=True,
                             text=True, check=False)
    if process.returncode != 0:
        said = process.stderr.strip().removeprefix(f"{program}: error: ") or \
            f"`{program} explain` failed without a message"
        raise RockbreakError(exit_code(process.returncode), f"{where}: {said}")
    return process.stdout


def value_at(case, key):
    """The value of a dotted key; None if there is none."""
    for name in key.split("."):
        case = case.get(name) if isinstance(case, dict) else None
    return case


def without(case, keys):
    case = copy.deepcopy(case)
    for key in keys:
        section, _, name = key.rpartition(".")
        ((value_at(case, section) if section else case) or {}).pop(name, None)
    return case


def hash_of(content):
    return xxh3_128(json.dumps(content, sort_keys=True).encode())
