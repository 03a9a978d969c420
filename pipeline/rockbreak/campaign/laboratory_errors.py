"""Errors of a laboratory test: against theory where the test has one, else against the reference run.

Each takes a run and its reference run, with `summary` (summary.json), `case` (resolved) and `out` (the directory, with
result.h5), and returns a signed error or None. Lengths are in De = sqrt(4 A / pi), loads relative, angles in degrees.
"""
import math
from functools import lru_cache

import numpy as np
from matplotlib.tri import Triangulation

from ..sealed import open_sealed

# Fields are compared outside discs of this radius [De] about the loads: there a point force has no finite stress.
NEAR_A_LOAD = 0.15


def no_value(_):
    return None


def diameter(summary):
    return math.sqrt(4 * summary["specimen"]["area"] / math.pi)


def has_theory(summary):
    return bool(summary.get("analytical"))


# -- loads

def strength(run, load):
    """The load in units of pi De sigma_t / 2, which splits a disc: comparable over sizes and rocks."""
    rock = run.case["material"]
    if run.summary[load] is None:
        return None
    return run.summary[load] / (0.5 * math.pi * diameter(run.summary) * rock["sigma_ci"] / rock["m_i"])


def initiation_load_value(run):
    return strength(run, "first_failure_load")


def breakage_load_value(run):
    return strength(run, "breakage_load")


def initiation_load(run, reference):
    return load_error(run.summary, reference.summary, "first_failure_load", "ratio_first_failure")


def breakage_load(run, reference):
    return load_error(run.summary, reference.summary, "breakage_load", "ratio")


def load_error(one, other, load, ratio):
    if has_theory(one):
        return one[ratio] - 1 if one[ratio] is not None else None
    return one[load] / other[load] - 1 if one[load] and other[load] else None


# -- what is left

def verdict(run, reference):
    """1 where one breaks and the other does not; by theory all specimens break."""
    expected = "broken" if has_theory(run.summary) else reference.summary["status"]
    return float((run.summary["status"] == "broken") != (expected == "broken"))


def line_of(summary):
    line = np.array(summary["breakage_line"], dtype=float)
    return line if line.shape == (2, 2) else None


def direction_degrees(line):
    """Of the line against the load axis, in (-90, 90]."""
    angle = math.degrees(math.atan2(line[1, 0] - line[0, 0], line[1, 1] - line[0, 1]))
    return angle - 180 * round(angle / 180)


def angle(run, reference):
    """Of the breakage line; theory gives its size alone."""
    one = line_of(run.summary)
    if one is None:
        return None
    if has_theory(run.summary):
        return abs(direction_degrees(one)) - run.summary["analytical"]["fracture_angle_deg"]
    other = line_of(reference.summary)
    if other is None:
        return None
    turn = direction_degrees(one) - direction_degrees(other)
    return turn - 180 * round(turn / 180)


def path(run, reference):
    """Largest distance of the crack from where it should be: from the load axis of a disc; elsewhere between the two
    breakage lines, whose order of ends means nothing."""
    one = line_of(run.summary)
    if one is None:
        return None
    if run.summary["test"] == "brazilian":
        points = np.vstack([one, np.array(run.summary["crack_path"]).reshape(-1, 2)])
        return float(np.abs(points[:, 0]).max()) / diameter(run.summary)
    other = line_of(reference.summary)
    if other is None or has_theory(run.summary):
        return None
    return min(np.linalg.norm(one - ends, axis=1).max() for ends in (other, other[::-1])) / diameter(run.summary)


def fragment_value(run):
    """Share of the smaller piece in the area."""
    areas = [piece["area"] for piece in run.summary["fragments"]]
    return min(areas) / sum(areas) if areas else None


def fragment(run, reference):
    one = fragment_value(run)
    if run.summary["test"] == "brazilian":
        other = 0.5
    else:
        other = None if has_theory(run.summary) else fragment_value(reference)
    return None if one is None or other is None else one - other


# -- stress fields per unit load

@lru_cache(maxsize=64)
def field_of(out, name):
    """Centroids, areas, stress (xx, yy, xy) per unit load, load points and a finder of elements; None where part of the
    load is held, as stress is then not proportional to it."""
    with open_sealed(out / "result.h5") as file:
        nodes, triangles = file["mesh/nodes"][:], file["mesh/triangles"][:]
        stress, load = file[f"stress/{name}"][:], float(file.attrs["first_failure_load"])
        loads = file["loads/point"][:] if "loads/point" in file else np.zeros((0, 2))
    corners = nodes[triangles]
    sides = corners[:, 1:] - corners[:, :1]
    area = 0.5 * np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    return {"centroid": corners.mean(axis=1), "area": area, "stress": stress / load, "loads": loads,
            "finder": Triangulation(nodes[:, 0], nodes[:, 1], triangles).get_trifinder()}


def far_from(points, loads, radius):
    far = np.ones(len(points), dtype=bool)
    for load in loads:
        far &= np.linalg.norm(points - load, axis=1) > radius
    return far


def disc_stress(points, radius, arc=0.0):
    """Plane stress field of a disc under two opposite forces of 1 N/m at its top and bottom, compression positive:
    points, or even vertical tractions over arcs of this length (Hondros 1959 has the normal ones).

    Two collinear forces on the rim: two half-plane fields of point forces, and the uniform tension that clears the rim
    of the normal components of the forces (Timoshenko & Goodier, Theory of Elasticity, section 41); an arc is the sum
    of such pairs, by Gauss's rule."""
    angles, weights = [0.0], [1.0]
    if arc > 0:
        angles, weights = np.polynomial.legendre.leggauss(24)
        angles, weights = 0.5 * arc / radius * angles, 0.5 * weights
    total = np.zeros((len(points), 3))
    for angle, weight in zip(angles, weights):
        x, top = points[:, 0] - radius * math.sin(angle), radius * math.cos(angle)
        for side in (1.0, -1.0):
            depth = top - side * points[:, 1]  # from the load, inwards
            r2 = x * x + depth * depth
            radial = weight * 2 / math.pi * depth / r2  # compression along the ray from the load
            total += np.column_stack([radial * x * x / r2, radial * depth * depth / r2,
                                      -side * radial * x * depth / r2])
        total[:, :2] -= weight * math.cos(angle) / (math.pi * radius)
    return total


def field_error(run, reference, name):
    """Relative L2 norm of the difference, over the elements away from the loads. None for a specimen with cracks of its
    own: result.h5 holds the stress without them, which says nothing about that specimen."""
    if run.case.get("specimen", {}).get("cracks"):
        return None
    if run.summary.get("held_load") or run.summary["first_failure_load"] is None:
        return None
    one, size = field_of(run.out, name), diameter(run.summary)
    if run.summary["test"] == "brazilian":
        radius = 0.5 * run.summary["specimen"]["diameter"]
        far = far_from(one["centroid"], [[0, radius], [0, -radius]], NEAR_A_LOAD * size)
        literal = run.case.get("breakage", {}).get("literal", False)
        patch = 0.0 if literal else run.case.get("loading", {}).get("patch", 0.0)
        exact = disc_stress(one["centroid"], radius, patch * size)
    elif has_theory(run.summary):
        return None
    else:
        if reference.summary["first_failure_load"] is None:
            return None
        other = field_of(reference.out, name)
        found = other["finder"](*one["centroid"].T)
        far = far_from(one["centroid"], one["loads"], NEAR_A_LOAD * size) & (found >= 0)
        exact = other["stress"][found]
    weight = (one["area"] * far)[:, None] * np.array([1, 1, 2])  # the shear stress stands twice in the tensor
    return math.sqrt(float((weight * (one["stress"] - exact) ** 2).sum() / (weight * exact ** 2).sum()))


def stress_field(run, reference):
    return field_error(run, reference, "element")


def averaged_stress(run, reference):
    return field_error(run, reference, "averaged")
