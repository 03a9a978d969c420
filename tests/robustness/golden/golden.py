"""Golden hashes: what they cover, how they are made and compared.

golden.json holds for each dataset of the coupled run one XXH3-128 over that dataset in all frames (or splits), and for
each laboratory test one for each dataset of result.h5. Attributes are left out, config_hash among them, and a dataset that
golden.json does not name is no difference: a new key of the scene or a new column of the history changes nothing here, other
results do.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[2]
sys.path.insert(0, str(REPOSITORY / "pipeline"))
from rockbreak.run.payload_hash import xxh3_128  # noqa: E402
from rockbreak.run.run_directory import RunDirectory  # noqa: E402
from rockbreak.sealed import open_sealed  # noqa: E402

GOLDEN = HERE / "golden.json"
LABORATORY = REPOSITORY / "configs" / "lab"
WAYS = (("resident", 1), ("resident", 2), ("resident", 4), ("oneshot", 1), ("oneshot", 2))
FIRST_WAY = WAYS[0]  # what --write takes


def bytes_of(dataset):
    """Type, shape and values of a dataset."""
    if h5py.check_string_dtype(dataset.dtype) is not None:
        values = [text.encode() for text in dataset.asstr()[()].ravel()]
        kind, data = "string", b"".join(len(text).to_bytes(8, "little") + text for text in values)
    else:
        array = np.ascontiguousarray(dataset[()])
        kind, data = array.dtype.name, array.astype(array.dtype.newbyteorder("<")).tobytes()
    return f"{kind} {dataset.shape}\n".encode() + data


def dataset_hashes(files):
    """Name -> hash over the dataset of that name in all files, in their order."""
    found = {}
    for number, path in enumerate(files):
        with open_sealed(path) as file:
            def visit(name, node, number=number):
                if isinstance(node, h5py.Dataset) and not name.startswith("provenance/"):
                    found.setdefault(name, []).append(f"{number}: ".encode() + bytes_of(node))
            file.visititems(visit)
    return {name: xxh3_128(b"".join(parts)) for name, parts in sorted(found.items())}


def coupled(binaries, folder, mode, threads):
    """Hashes of a coupled run."""
    out = folder / f"{mode}_{threads}"
    command = [REPOSITORY / "pipeline" / "run", HERE / "scene.yaml", "--out", out, "--no-report", "--mode", mode,
               "--threads", str(threads)]
    run(command, binaries)
    directory = RunDirectory(out)
    return {"frames": dataset_hashes([directory.frame_file(k) for k in directory.frame_numbers()]),
            "splits": dataset_hashes([directory.split_file(k) for k in directory.split_numbers()])}


def laboratory(binaries, folder, test):
    out = folder / test.stem
    run([binaries / "xfem", "lab", test, "--out", out], binaries)
    return dataset_hashes([out / "result.h5"])


def laboratory_tests():
    return sorted(LABORATORY.glob("*.yaml"))


def run(command, binaries):
    process = subprocess.run(command, env={**os.environ, "ROCKBREAK_BIN": str(binaries)}, capture_output=True, text=True,
                             check=False)
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: exit code {process.returncode}: {process.stderr[-2000:]}")


def differences(found, golden):
    """Paths of golden.json whose hash is another one, or that are gone."""
    if isinstance(golden, dict):
        return [f"{name}{'/' if isinstance(value, dict) else ''}{rest}" for name, value in golden.items()
                for rest in differences((found or {}).get(name), value)]
    return [] if found == golden else [""]


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="tests/robustness/golden/check")
    parser.add_argument("--preset", default="release", help="build/PRESET holds dem and xfem")
    parser.add_argument("--write", action="store_true", help="replace the golden hashes by those of this build")
    options = parser.parse_args(arguments)
    binaries = REPOSITORY / "build" / options.preset
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if options.write:
            new = {"coupled": coupled(binaries, folder, *FIRST_WAY),
                   "lab": {test.stem: laboratory(binaries, folder, test) for test in laboratory_tests()}}
            GOLDEN.write_text(json.dumps(new, indent=1) + "\n", encoding="utf-8")
            return 0
        golden = json.loads(GOLDEN.read_text(encoding="utf-8"))
        wrong = 0
        for mode, threads in WAYS:
            wrong += report(f"coupled, {mode}, {threads} threads",
                            differences(coupled(binaries, folder, mode, threads), golden["coupled"]))
        for test in laboratory_tests():
            wrong += report(f"lab, {test.stem}", differences(laboratory(binaries, folder, test),
                                                             golden["lab"].get(test.stem, {})))
    return 1 if wrong else 0


def report(what, different):
    print(f"{what}: {'as ever' if not different else 'OTHER: ' + ', '.join(different)}", flush=True)
    return len(different)
