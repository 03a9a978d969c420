"""The frames of one run as compact numbers, for the script that plays them on the page (report/templates/animation.js).

Everything is one block of little-endian integers, in base64, cut into arrays by the header: outlines of every particle
that ever was, once, in its own axes; for each frame its particles (which, where, how far turned, how far displaced) and
its contacts (rows of the two particles, normal force). Coordinates have 16 bits of the picture's width.
"""
import base64

import numpy as np

from ..measures.frame import read_frame

MOST_FRAMES, FEWEST_FRAMES = 60, 12
BUDGET = 2.4e6      # bytes before base64, from which on fewer frames are shown
FORCE_QUANTILE = 0.995  # of the last frame's forces: that force is drawn widest


class Block:
    """Arrays one after another, with a header that says where each begins."""

    def __init__(self):
        self.bytes, self.where = bytearray(), {}

    def add(self, name, values, kind):
        self.bytes += b"\0" * (len(self.bytes) % 2)
        self.where[name] = [kind, len(self.bytes), len(values)]
        self.bytes += np.ascontiguousarray(values, dtype={"u1": "u1", "u2": "<u2"}[kind]).tobytes()


def chosen_frames(run):
    """Evenly spread over the test; fewer of large assemblies."""
    of_one = 9 * run.frames[-1]["particles"] + 5 * run.frames[-1]["contacts"]
    count = int(np.clip(BUDGET / max(of_one, 1), FEWEST_FRAMES, MOST_FRAMES))
    rows = np.unique(np.linspace(0, len(run.frames) - 1, count).round().astype(int))
    return [run.frames[row]["frame"] for row in rows]


def animation(run):
    """What becomes the JSON; None if the assembly has more particles than 16 bits can name."""
    shown = chosen_frames(run)
    frames = [read_frame(run.directory.frame_file(k)) for k in shown]
    low = np.min([one.vertices.min(axis=0) for one in frames], axis=0)
    high = np.max([one.vertices.max(axis=0) for one in frames], axis=0)
    side = 1.01 * float((high - low).max())
    middle = 0.5 * (low + high)
    origin = middle - side / 2

    outline_of = {}  # id -> (outline, generation, boundary)
    for one in frames:
        for i in np.flatnonzero(~np.isin(one.id, list(outline_of))):
            outline_of[int(one.id[i])] = (one.body_vertices[one.offset[i]:one.offset[i + 1]], one.generation[i],
                                          one.boundary[i])
    ids = np.array(sorted(outline_of))
    if len(ids) > 65535:
        return None
    outlines, generation, boundary = zip(*(outline_of[int(i)] for i in ids))
    vertices = np.vstack(outlines)
    reach = float(np.abs(vertices).max())
    furthest = max(float(np.linalg.norm(one.displacement, axis=1).max()) for one in frames) or 1.0
    loaded = frames[-1].normal_force[frames[-1].normal_force > 0]
    strongest = float(np.quantile(loaded, FORCE_QUANTILE)) if len(loaded) else 1.0

    block = Block()
    block.add("corners", [len(one) for one in outlines], "u1")
    block.add("outline", np.round((vertices / reach + 1) * 32767.5).ravel(), "u2")
    block.add("generation", np.minimum(generation, 255), "u1")
    block.add("boundary", boundary, "u1")
    for k, one in enumerate(frames):
        block.add(f"who{k}", np.searchsorted(ids, one.id), "u2")
        block.add(f"at{k}", np.round((one.position - origin) / side * 65535).ravel(), "u2")
        block.add(f"turn{k}", np.round(one.angle / (2 * np.pi) * 65536) % 65536, "u2")
        block.add(f"moved{k}", np.round(np.linalg.norm(one.displacement, axis=1) / furthest * 255), "u1")
        kept = one.normal_force > 0.02 * strongest  # a line that is too thin to be seen
        block.add(f"pair{k}", np.column_stack([one.a, one.b])[kept].ravel(), "u2")
        block.add(f"force{k}", np.minimum(np.round(one.normal_force[kept] / strongest * 100), 255), "u1")
    return {
        "strain": [round(one.axial_strain, 6) for one in frames], "particles": [len(one) for one in frames],
        "contacts": [int((one.normal_force > 0).sum()) for one in frames],
        "fragments": [int((one.generation > 0).sum()) for one in frames], "side": side, "reach": reach,
        "aspect": min(1.0, float((high - low)[1] / (high - low)[0])), "furthest": furthest, "strongest": strongest,
        "where": block.where, "data": base64.b64encode(bytes(block.bytes)).decode()}
