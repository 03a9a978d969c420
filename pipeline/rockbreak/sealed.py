"""The HDF5 files of `dem` and `xfem`, opened only where the seal at their end fits the bytes before it.

HDF5 1.10 crashes, hangs or reads something else over damaged metadata; common/io/immutable_file.hpp says what the seal
is.
"""
import h5py

from .errors import IO_FAILURE, RockbreakError
from .run.payload_hash import xxh3_128

MAGIC = b"RBSEAL01"
SEAL_BYTES = len(MAGIC) + 16


def seal_of(image):
    """The bytes that follow an image."""
    return MAGIC + bytes.fromhex(xxh3_128(image))


def open_sealed(path):
    """An open h5py.File to read from. Raises RockbreakError if the file is missing, damaged or not sealed."""
    sealed_content(path)
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise RockbreakError(IO_FAILURE, f"{path}: unreadable: {error}") from error


def sealed_content(path):
    """The bytes of a file. Raises as open_sealed."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise RockbreakError(IO_FAILURE, f"{path}: unreadable: {error.strerror}") from error
    image, seal = content[:-SEAL_BYTES], content[-SEAL_BYTES:]
    if not seal.startswith(MAGIC) or len(seal) < SEAL_BYTES:
        raise RockbreakError(IO_FAILURE, f"{path}: unreadable: does not end with a checksum, as files of dem and xfem "
                             "do; it was cut short or written by another program")
    if seal != seal_of(image):
        raise RockbreakError(IO_FAILURE, f"{path}: unreadable: damaged, its bytes do not match the checksum at its end")
    return content


def is_sealed(path):
    """Whether a file is there with the bytes that were written."""
    try:
        sealed_content(path)
    except RockbreakError:
        return False
    return True
