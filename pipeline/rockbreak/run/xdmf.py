"""run.xdmf: a run as ParaView sees it. Light data only: it refers to frames/*.h5, splits/*.h5 and, for what those do
not hold, to paraview/*.h5 (paraview_arrays.py). Three blocks, each with a grid per frame:

  particles     polygons; id, root, generation, ..., displacement, stress_xx, ...; with breakage status, ...
  contacts      points; force on b, its normal and shear part
  force_chains  lines between the centroids of the two particles of a contact; its forces again

Times are the frames'. The file keeps to what all three XDMF readers of ParaView 5.11 (Debian 12) understand: no
hyperslabs, no functions, explicit connectivity. A collection over time for each block, not a block for each time, gives
the blocks names that do not change with time in the one reader that knows names (XDMF Reader).
"""
from contextlib import ExitStack

import h5py

from ..errors import IO_FAILURE, RockbreakError
from ..sealed import open_sealed
from .paraview_arrays import SCHEMA, arrays_of, file_image
from .run_directory import make_folder, plain, write_text, write_whole

BLOCKS = ("particles", "contacts", "force_chains")
KINDS = {"i": "Int", "u": "UChar", "f": "Float"}  # by numpy's kind; the unsigned ones of a frame have 8 bits
OF_PARTICLES = ("id", "root", "generation", "boundary", "area")
OF_SPLITS = ("status", "failure_mode")  # safety factors can be infinite, which no colour scale shows
STRESSES = ("stress_xx", "stress_yy", "stress_xy")
FORCES = ("normal_force", "shear_force")


def write_xdmf(directory):
    """Writes run.xdmf of all frames that a run directory holds, and of paraview/ what is missing or of another frame.
    Returns its path."""
    folder = directory.path / "paraview"
    make_folder(folder)
    numbers = directory.frame_numbers()
    forms = {}
    grids = [frame_grids(directory, k, forms) for k in numbers]
    for file in folder.glob("*.h5"):
        if not (file.stem.isdigit() and int(file.stem) in numbers):
            file.unlink()
    write_text(directory.xdmf_file, "\n".join([
        '<?xml version="1.0" encoding="utf-8"?>', '<Xdmf Version="3.0">', "<Domain>",
        *(over_time(name, [one[name] for one in grids if name in one]) for name in BLOCKS),
        "</Domain>", "</Xdmf>", ""]))
    return directory.xdmf_file


def over_time(name, grids):
    """The collection of a block, nothing if no frame has it."""
    return "\n".join([f'<Grid Name="{name}" GridType="Collection" CollectionType="Temporal">', *grids, "</Grid>"]
                     if grids else [])


def frame_grids(directory, k, forms):
    """Block -> XML of frame k; `forms` remembers types and shapes of datasets, all but the length, from frame to
    frame."""
    with ExitStack() as opened:
        def open_one(path):
            return opened.enter_context(open_sealed(path))
        try:
            frame, split = open_one(directory.frame_file(k)), None
            if directory.split_file(k).exists():
                split = open_one(directory.split_file(k))
                split = split if split.attrs["frame_hash"] == frame.attrs["payload_hash"] else None
            made = made_arrays(directory.path / "paraview" / f"{k:06d}.h5", frame, split)
            return blocks_of(k, frame, split, made, forms)
        except (OSError, KeyError) as error:
            raise RockbreakError(IO_FAILURE,
                                 f"{directory.frame_file(k)}, or its split: not complete: {error}") from error


def made_arrays(path, frame, split):
    """Name -> (shape, type) of the arrays in paraview/K.h5; writes that file unless it is of this frame and split."""
    source = {"schema": SCHEMA, "frame_hash": plain(frame.attrs["payload_hash"]),
              "split_hash": plain(split.attrs["payload_hash"]) if split else ""}
    try:
        with h5py.File(path, "r") as file:
            if {key: plain(value) for key, value in file.attrs.items()} == source:
                return {name: (dataset.shape, dataset.dtype) for name, dataset in file.items()}
    except OSError:
        pass  # none, or a damaged one
    arrays = arrays_of(frame, split)
    write_whole(path, file_image(arrays, source), durable=False)  # made anew from the frames
    return {name: (values.shape, values.dtype) for name, values in arrays.items()}


def blocks_of(k, frame, split, made, forms):
    """Block -> grid of frame k; without contacts the particles alone. `made`: as from made_arrays."""
    time = plain(frame.attrs["time"])
    count = {"particles": made["displacement"][0][0], "contacts": made["force"][0][0]}

    def of(file, folder, group, names):
        for name in names:
            if (path := f"{group}/{name}") not in forms:
                forms[path] = file[path].shape[1:], file[path].dtype
        return {name: item(f"{folder}/{k:06d}.h5:/{group}/{name}", (count[group], *forms[f"{group}/{name}"][0]),
                           forms[f"{group}/{name}"][1]) for name in names}

    heavy = {name: item(f"paraview/{k:06d}.h5:/{name}", *form) for name, form in made.items()}
    position = of(frame, "frames", "particles", ["position"])["position"]
    point = of(frame, "frames", "contacts", ["point"])["point"]
    forces = of(frame, "frames", "contacts", FORCES) | {"force": heavy["force"]}
    grids = {"particles": grid(
        "particles", time, f'TopologyType="Mixed" NumberOfElements="{count["particles"]}"', heavy["topology"],
        heavy["points"], "Cell", of(frame, "frames", "particles", OF_PARTICLES)
        | {name: heavy[name] for name in ("displacement", *STRESSES)}
        | (of(split, "splits", "particles", OF_SPLITS) if split else {}))}
    if count["contacts"]:
        of_contacts = f'NumberOfElements="{count["contacts"]}"'
        grids["contacts"] = grid("contacts", time, f'TopologyType="Polyvertex" NodesPerElement="1" {of_contacts}',
                                 heavy["contact_points"], point, "Node", forces)
        grids["force_chains"] = grid("force_chains", time, f'TopologyType="Polyline" NodesPerElement="2" {of_contacts}',
                                     heavy["contact_lines"], position, "Cell", forces)
    return grids


def grid(name, time, topology, cells, points, center, attributes):
    return "\n".join([f'<Grid Name="{name}" GridType="Uniform">', f'<Time Value="{time!r}"/>',
                      f"<Topology {topology}>{cells}</Topology>", f'<Geometry GeometryType="XY">{points}</Geometry>',
                      *(attribute(*one, center) for one in attributes.items()), "</Grid>"])


def attribute(name, data, center):
    kind = "Vector" if name in ("displacement", "force") else "Scalar"
    return f'<Attribute Name="{name}" AttributeType="{kind}" Center="{center}">{data}</Attribute>'


def item(place, shape, dtype):
    """A reference to a dataset, relative to the run directory."""
    return (f'<DataItem Format="HDF" NumberType="{KINDS[dtype.kind]}" Precision="{dtype.itemsize}" '
            f'Dimensions="{" ".join(map(str, shape))}">{place}</DataItem>')
