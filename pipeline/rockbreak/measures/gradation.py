"""Sizes of particles: gradation curves, breakage indices (Marsal, Hardin, Einav) and fractal dimension.

A gradation is by mass, which in the plane is area: all of a run's rock has one density. Curves are those of the
particles themselves, not of sieve classes; where an index depends on sieves, they are an argument.
"""
from dataclasses import dataclass

import numpy as np


def equivalent_diameter(area):
    """N diameters of the circles of areas [m^2]: sqrt(4 A / pi) [m]."""
    return np.sqrt(4 * np.asarray(area) / np.pi)


def _pairs(offset):
    """(polygon of each vertex, next vertex; every (vertex, vertex) pair of one polygon as two arrays)."""
    count = np.diff(offset)
    owner = np.repeat(np.arange(len(count)), count)
    following = np.arange(1, offset[-1] + 1)
    following[offset[1:] - 1] = offset[:-1]
    repeats = count[owner]
    first = np.repeat(np.arange(offset[-1]), repeats)
    within = np.arange(repeats.sum()) - np.repeat(np.cumsum(repeats) - repeats, repeats)
    return owner, following, first, offset[owner[first]] + within


def sieve_size(vertices, offset):
    """N smallest caliper widths [m] of convex outlines (V x 2, first rows N + 1): the slot that each falls through.

    The smallest width of a convex polygon is across one of its edges (rotating calipers).
    """
    owner, following, first, other = _pairs(offset)
    edge = vertices[following] - vertices
    normal = np.column_stack([-edge[:, 1], edge[:, 0]]) / np.linalg.norm(edge, axis=1)[:, None]
    distance = np.einsum("ij,ij->i", normal[first], vertices[other] - vertices[first])
    begin = np.flatnonzero(np.concatenate([[True], np.diff(first) != 0]))
    return np.minimum.reduceat(np.maximum.reduceat(distance, begin), offset[:-1])


def longest_diameter(vertices, offset):
    """N longest distances between two vertices [m]: what a scene calls the diameter."""
    owner, _, first, other = _pairs(offset)
    return np.maximum.reduceat(np.linalg.norm(vertices[other] - vertices[first], axis=1),
                               np.searchsorted(owner[first], np.arange(len(offset) - 1)))


SIZES = {"equivalent": lambda frame: equivalent_diameter(frame.area),
         "sieve": lambda frame: sieve_size(frame.body_vertices, frame.offset),
         "diameter": lambda frame: longest_diameter(frame.body_vertices, frame.offset)}


@dataclass(frozen=True)
class Gradation:
    """N sizes, ascending [m], with the share by mass of the particles up to each: a step curve."""
    size: np.ndarray
    passing: np.ndarray  # the last is 1

    def finer(self, size):
        """Share by mass of particles smaller than `size` [m] (array or number)."""
        return np.concatenate([[0.0], self.passing])[np.searchsorted(self.size, size, side="left")]

    def percentile(self, percent):
        """d_percent [m]: the smallest size up to which that share of the mass lies."""
        row = np.searchsorted(self.passing, np.asarray(percent) / 100 * (1 - 1e-12))
        return self.size[np.minimum(row, len(self.size) - 1)]

    @property
    def uniformity(self):
        """C_u = d60 / d10."""
        return float(self.percentile(60) / self.percentile(10))

    @property
    def curvature(self):
        """C_c = d30^2 / (d60 d10)."""
        return float(self.percentile(30) ** 2 / (self.percentile(60) * self.percentile(10)))

    def mean_log(self, limit):
        """Mean by mass of log10(d / limit), no particle counting as smaller than `limit` [m]."""
        share = np.diff(np.concatenate([[0.0], self.passing]))
        return float(np.dot(share, np.log10(np.maximum(self.size, limit) / limit)))


def gradation(size, mass):
    """Gradation of N particles: sizes [m], masses (or areas) in any unit."""
    order = np.argsort(size, kind="stable")
    passing = np.cumsum(np.asarray(mass)[order])
    return Gradation(np.asarray(size)[order], passing / passing[-1])


def frame_gradation(frame, size="equivalent", boundary=True):
    """Gradation of a Frame by "equivalent" diameter, "sieve" or longest "diameter"; `boundary`: those as well."""
    chosen = slice(None) if boundary else ~frame.boundary
    return gradation(SIZES[size](frame)[chosen], frame.area[chosen])


def smallest_piece(case):
    """Equivalent diameter [m] of the smallest fragment that a scene allows (breakage.minimum_area)."""
    return float(equivalent_diameter(case["breakage"]["minimum_area"]))


def standard_sieves(lower, upper, ratio=2 ** 0.25):
    """Sieves from `upper` [m] downward by `ratio` until one is at or below `lower`, ascending."""
    return upper * ratio ** -np.arange(np.ceil(np.log(upper / lower) / np.log(ratio) - 1e-9), -1.0, -1.0)


def marsal(before, after, sieves):
    """Marsal's (1967) breakage index B_g [-]: sum of the positive differences before - after of the shares retained.

    `sieves` [m], ascending: a share is retained between two of them, below the first or above the last. It grows with
    finer sieves; a finer set than the sizes' spread turns every change into breakage.
    """
    retained = [np.diff(np.concatenate([[0.0], curve.finer(np.asarray(sieves)), [1.0]])) for curve in (before, after)]
    return float(np.maximum(retained[0] - retained[1], 0).sum())


def hardin(before, after, limit):
    """Hardin's (1985) relative breakage B_r = B_t / B_p [-] in closed form for step curves.

    The potential B_p is the area between the curve before and the vertical at the size `limit` [m], over log10 d: the
    mean by mass of log10(d / limit). B_t is the area between the two curves, coarser than `limit`. Hardin takes 0.074
    mm, silt, which rockfill whose pieces have a smallest size cannot reach; take that size instead (`smallest_piece`),
    and B_r = 1 where everything is broken down to it. nan without a potential.
    """
    potential = before.mean_log(limit)
    return (potential - after.mean_log(limit)) / potential if potential > 0 else np.nan


def einav(before, after, limit, exponent=0.4):
    """Einav's (2007) relative breakage [-]: as Hardin's, but towards an ultimate fractal gradation, not one size.

    Ultimate: F(d) = (d^exponent - limit^exponent) / (largest^exponent - limit^exponent), from `limit` to the largest
    size before; exponent = 3 - fractal dimension (2 - the dimension counted in the plane); 0.4 for 2.6 in space.
    """
    largest, initial = before.size[-1], before.mean_log(limit)
    ratio = np.log(largest / limit)
    ultimate = (ratio / -np.expm1(-exponent * ratio) - 1 / exponent) / np.log(10)
    return (initial - after.mean_log(limit)) / (initial - ultimate) if initial > ultimate else np.nan


@dataclass(frozen=True)
class FractalFit:
    dimension: float
    error: float   # standard error of the line's slope; the points are not independent: a lower bound
    points: int    # sizes fitted
    lower: float   # [m] range of sizes fitted
    upper: float


def _log_slope(x, y):
    x, y = np.log(x), np.log(y)
    slope, intercept = np.polyfit(x - x.mean(), y, 1)
    rest = y - intercept - slope * (x - x.mean())
    return slope, np.sqrt(rest @ rest / max(len(x) - 2, 1) / np.sum((x - x.mean()) ** 2))


def fractal_dimension(size, lower=0.0, upper=np.inf):
    """FractalFit of N(>= d) ~ d^-D: least squares of log N over log d at the sizes in [lower, upper] [m].

    None below 3 different sizes. Sizes near the largest, of which only a few remain, and near the smallest piece that a
    scene allows do not scale; leave them out.
    """
    d = np.unique(size)
    number = len(size) - np.searchsorted(np.sort(size), d, side="left")
    return _fractal(d, number, lower, upper, lambda slope: -slope)


def fractal_dimension_by_mass(curve, lower=0.0, upper=np.inf, dimensions=2):
    """FractalFit of M(<= d) / M ~ d^(dimensions - D) on a Gradation, at its sizes in [lower, upper] [m].

    In the plane `dimensions` is 2, and a section through space of dimension D has D - 1: Turcotte (1986) uses 3. It
    takes the law to hold down to d = 0; where pieces have a smallest size the number's fit is the better one.
    """
    last = np.concatenate([curve.size[1:] != curve.size[:-1], [True]])
    return _fractal(curve.size[last], curve.passing[last], lower, upper, lambda slope: dimensions - slope)


def _fractal(d, amount, lower, upper, dimension):
    chosen = (d >= lower) & (d <= upper)
    if chosen.sum() < 3:
        return None
    slope, error = _log_slope(d[chosen], amount[chosen])
    return FractalFit(float(dimension(slope)), float(error), int(chosen.sum()), float(d[chosen][0]),
                      float(d[chosen][-1]))
