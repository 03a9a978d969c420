"""What ParaView needs of a frame and the frame does not hold: outlines in the world, connectivity, vectors of three
components, stresses one by one. Small files DIR/paraview/000000.h5, each from one frame; `xdmf.py` refers to them.

Real numbers are float32, which is enough to be looked at (1e-6 m in an assembly of 16 m); what is computed from a run
is computed from its frames.
"""
import h5py
import numpy as np

from ..measures.classes import particle_stresses

POLYGON = 3  # XDMF's number of this type of cell
SCHEMA = "paraview/1"


def world_outlines(position, angle, vertex_offset, vertices):
    """V x 2 [m]: position + R(angle) vertex of every vertex; N particles, N+1 offsets, V vertices in body frames."""
    row = np.repeat(np.arange(len(position)), np.diff(vertex_offset))
    cosine, sine = np.cos(angle)[row], np.sin(angle)[row]
    x, y = vertices.T
    return position[row] + np.column_stack([cosine * x - sine * y, sine * x + cosine * y])


def mixed_topology(vertex_offset):
    """XDMF's list of mixed cells, here polygons over consecutive points: type, number of points, the points, ..."""
    cells = len(vertex_offset) - 1
    topology = np.empty(int(vertex_offset[-1]) + 2 * cells, dtype=np.int32)
    head = vertex_offset[:-1] + 2 * np.arange(cells)
    topology[head] = POLYGON
    topology[head + 1] = np.diff(vertex_offset)
    points = np.ones(len(topology), dtype=bool)
    points[head] = points[head + 1] = False
    topology[points] = np.arange(int(vertex_offset[-1]))
    return topology


def spatial(vectors):
    """N x 2 as N x 3: ParaView's glyphs and warps take no others."""
    return np.column_stack([vectors, np.zeros(len(vectors))])


def arrays_of(frame, split=None):
    """Name -> array. `frame`, `split`: open files; without a split, stress is the virial of the contact forces."""
    particles, contacts = frame["particles"], frame["contacts"]
    ids, position = particles["id"][:], particles["position"][:]
    offset, force = particles["vertex_offset"][:], contacts["force"][:]
    rows = np.searchsorted(ids, contacts["a"][:]), np.searchsorted(ids, contacts["b"][:])
    stress = split["particles/mean_stress"][:] if split else particle_stresses(
        position, particles["area"][:], *rows, contacts["point"][:], force)
    reals = {"points": world_outlines(position, particles["angle"][:], offset, particles["vertices"][:]),
             "displacement": spatial(particles["displacement"][:]), "force": spatial(force),
             **{f"stress_{name}": stress[:, i] for i, name in enumerate(("xx", "yy", "xy"))}}
    return {"topology": mixed_topology(offset), "contact_points": np.arange(len(force), dtype=np.int32),
            "contact_lines": np.column_stack(rows).astype(np.int32),
            **{name: values.astype(np.float32) for name, values in reals.items()}}


def file_image(arrays, attributes):
    """An HDF5 file of these arrays as bytes. Connectivity, which is regular, is compressed."""
    with h5py.File("paraview", "w", driver="core", backing_store=False) as file:
        for name, values in arrays.items():
            regular = values.dtype == np.int32 and len(values) > 0
            file.create_dataset(name, data=values, **({"shuffle": True, "compression": 1, "chunks": values.shape}
                                                      if regular else {}))
        file.attrs.update(attributes)
        file.flush()
        return file.id.get_file_image()
