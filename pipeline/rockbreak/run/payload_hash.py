#!/usr/bin/env python3
"""Recompute the payload hash of a frame or a split, independently of the C++ code.

Sample runs:
    python3 pipeline/rockbreak/run/payload_hash.py runs/demo/frames/000000.h5

The hash is XXH3-128 over every dataset and attribute outside `/provenance` except the root attribute `payload_hash`,
in the order of the bytes of their paths ("particles/id" a dataset, "particles/id@unit" its attribute, "@frame" one of
the root). Each item contributes: path, a zero byte, numpy's name of its type ("string" for strings), a zero byte, its
rank and dimensions (uint64), its row-major little-endian values; of strings each one's length (uint64) and UTF-8 bytes.
"""
import ctypes
import struct
import sys
from functools import cache

import h5py
import numpy as np

NUMBERS = {"int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64", "float32", "float64"}


class _Hash128(ctypes.Structure):
    _fields_ = [("low", ctypes.c_uint64), ("high", ctypes.c_uint64)]


@cache
def _library_function():
    function = ctypes.CDLL("libxxhash.so.0").XXH3_128bits
    function.restype = _Hash128
    function.argtypes = [ctypes.c_char_p, ctypes.c_size_t]
    return function


def xxh3_128(data):
    """Hex XXH3-128 of some bytes."""
    value = _library_function()(data, len(data))
    return f"{value.high:016x}{value.low:016x}"


def _encode(path, value, is_text):
    """The hashed bytes of one item; None for types that the hash leaves out."""
    if is_text:
        texts = [value] if isinstance(value, (str, bytes)) else list(np.asarray(value).ravel())
        texts = [t.encode() if isinstance(t, str) else bytes(t) for t in texts]
        shape = () if isinstance(value, (str, bytes)) else np.shape(value)
        kind, data = "string", b"".join(struct.pack("<Q", len(t)) + t for t in texts)
    else:
        array = np.asarray(value)
        if array.dtype == bool:  # stored as an enumeration of int8
            array = array.astype(np.int8)
        kind, shape = array.dtype.name, array.shape
        if kind not in NUMBERS:
            return None
        data = array.astype(array.dtype.newbyteorder("<")).tobytes()
    head = path.encode() + b"\0" + kind.encode() + b"\0"
    return head + struct.pack(f"<{1 + len(shape)}Q", len(shape), *shape) + data


def payload_hash(file):
    """The payload hash of an open h5py.File."""
    items = {}

    def add_attributes(name, node):
        for key in node.attrs:
            is_text = h5py.check_string_dtype(node.attrs.get_id(key).dtype) is not None
            items[f"{name}@{key}"] = _encode(f"{name}@{key}", node.attrs[key], is_text)

    def visit(name, node):
        if isinstance(node, h5py.Dataset):
            items[name] = _encode(name, node[()], h5py.check_string_dtype(node.dtype) is not None)
        add_attributes(name, node)

    add_attributes("", file)
    file.visititems(visit)
    covered = [
        path
        for path in items
        if items[path] is not None
        and path != "@payload_hash"
        and not path.startswith(("provenance/", "provenance@"))
    ]
    return xxh3_128(b"".join(items[path] for path in sorted(covered, key=str.encode)))


def main():
    """Prints the recomputed hash of each file; exits with 1 if one differs from the stored hash."""
    differ = False
    for name in sys.argv[1:]:
        with h5py.File(name, "r") as file:
            found, stored = payload_hash(file), file.attrs.get("payload_hash")
        differ = differ or stored not in (None, found)
        print(found, name, "" if stored in (None, found) else f"differs from the stored {stored}")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
