"""Void ratios: of the assembly in three definitions, and the exact areas of outlines in the tiles of a grid.

e1 = A / S - 1       A: polygon of the ring centroids; S: solids inside it, boundary particles by interior angle / 2 pi
e2 = A / (S - O) - 1  O: area of all overlaps, which S counts twice
e4 = A / I - 1       I: area of the particles that are not in the ring
"""
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class VoidRatios:
    e1: float
    e2: float
    e4: float
    assembly_area: float  # A [m^2]
    escaped: int          # particles outside the ring that touch nothing; they count nowhere


def interior_angles(polygon):
    """B interior angles [rad], 0 to 2 pi, of a counter-clockwise polygon (B x 2)."""
    out, back = np.roll(polygon, -1, axis=0) - polygon, np.roll(polygon, 1, axis=0) - polygon
    cross = out[:, 0] * back[:, 1] - out[:, 1] * back[:, 0]
    return np.arctan2(cross, np.einsum("ij,ij->i", out, back)) % (2 * np.pi)


def inside_polygon(polygon, points):
    """N bool: points (N x 2) inside a counter-clockwise polygon (B x 2), by the crossings of the ray to the right."""
    p, q = polygon, np.roll(polygon, -1, axis=0)
    x, y = points[:, 0, None], points[:, 1, None]
    spans = (p[:, 1] > y) != (q[:, 1] > y)
    side = (q[:, 0] - p[:, 0]) * (y - p[:, 1]) - (q[:, 1] - p[:, 1]) * (x - p[:, 0])
    return np.sum(spans & ((q[:, 1] > p[:, 1]) == (side > 0)), axis=1) % 2 == 1


def void_ratios(frame):
    """VoidRatios of a Frame: what `dem` writes to history/void_ratio_*, from the particles and contacts alone."""
    polygon = frame.position[frame.ring]
    in_ring, touched = np.zeros(len(frame), dtype=bool), np.zeros(len(frame), dtype=bool)
    in_ring[frame.ring] = True
    touched[frame.a] = touched[frame.b] = True
    held = touched | inside_polygon(polygon, frame.position)
    interior = frame.area[held & ~in_ring].sum()
    solids = interior + np.dot(frame.area[frame.ring], interior_angles(polygon)) / (2 * np.pi)
    area = frame.assembly_area
    return VoidRatios(float(area / solids - 1), float(area / (solids - frame.overlap_area.sum()) - 1),
                      float(area / interior - 1), area, int(np.sum(~held & ~in_ring)))


@dataclass(frozen=True)
class TileAreas:
    """P pairs of a polygon and a tile that it (or its box) touches."""
    polygon: np.ndarray  # P
    row: np.ndarray      # P; of the tile, along y
    column: np.ndarray   # P; along x
    area: np.ndarray     # P [m^2] of the polygon inside the tile


def tile_areas(vertices, offset, x, y):
    """TileAreas of polygons (V x 2, counter-clockwise, convex or not, first rows N + 1) on a grid with edges `x`, `y`.

    The part of a polygon in a tile is - integral of (clamp(y, y_low, y_high) - y_low) dx over the pieces of its
    boundary between x_low and x_high: a sum over edges, without clipping a single polygon. Exact to rounding.
    """
    nx, ny = len(x) - 1, len(y) - 1
    low, high = np.minimum.reduceat(vertices, offset[:-1]), np.maximum.reduceat(vertices, offset[:-1])
    first = [np.maximum(np.searchsorted(edges, low[:, k], side="right") - 1, 0) for k, edges in enumerate((x, y))]
    last = [np.minimum(np.searchsorted(edges, high[:, k], side="left"), n) for k, (edges, n) in
            enumerate(((x, nx), (y, ny)))]
    width, height = (np.maximum(last[k] - first[k], 0) for k in (0, 1))
    polygon, within = _expand(width * height)
    column = first[0][polygon] + within % width[polygon]
    row = first[1][polygon] + within // width[polygon]

    following = np.arange(1, len(vertices) + 1)
    following[offset[1:] - 1] = offset[:-1]
    pair, k = _expand(np.diff(offset)[polygon])
    p = offset[polygon[pair]] + k
    along, left, right = vertices[:, 0], x[column[pair]], x[column[pair] + 1]
    beside = (np.minimum(along, along[following])[p] < right) & (np.maximum(along, along[following])[p] > left)
    pair, p, left, right = pair[beside], p[beside], left[beside], right[beside]
    (px, py), (qx, qy) = vertices[p].T, vertices[following[p]].T
    bottom, top = y[row[pair]], y[row[pair] + 1]
    cut_p, cut_q = np.clip(px, left, right), np.clip(qx, left, right)
    span = qx - px
    slope = (qy - py) / np.where(span == 0, 1.0, span)
    height_p, height_q = py + slope * (cut_p - px), py + slope * (cut_q - px)
    mean = _mean_clamped(np.minimum(height_p, height_q), np.maximum(height_p, height_q), bottom, top)
    area = -np.bincount(pair, mean * (cut_q - cut_p), len(polygon))
    return TileAreas(polygon, row, column, np.maximum(area, 0.0))


def _expand(number):
    """(0 0 1 1 1 ..., 0 1 0 1 2 ...): the group and the place within it, for groups of `number` members."""
    group = np.repeat(np.arange(len(number)), number)
    return group, np.arange(len(group)) - np.repeat(np.cumsum(number) - number, number)


def _mean_clamped(low, high, bottom, top):
    """Mean of clamp(y, bottom, top) - bottom over y from `low` to `high`."""
    length = high - low
    scale = np.where(length > 0, length, 1.0)
    enter, leave = np.clip(low, bottom, top), np.clip(high, bottom, top)
    between = (leave - enter) / scale * (0.5 * (enter + leave) - bottom)
    above = (high - np.clip(high, low, np.maximum(top, low))) / scale * (top - bottom)
    return np.where(length > 0, between + above, np.clip(low, bottom, top) - bottom)
