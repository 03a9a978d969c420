"""Normal contact forces: their distribution (Fig. 7), how uniform it is, and what the strong ones carry.

Contacts that carry nothing do not count. f is the normal force, <f> its mean, x = f / <f>.
"""
from dataclasses import dataclass

import numpy as np

from .stresses import assembly_stress


@dataclass(frozen=True)
class ForceDistribution:
    """Probability density of x = f / scale in K bins."""
    edges: np.ndarray    # K + 1
    density: np.ndarray  # K [1 per unit of x]; its integral is 1 if the bins hold all forces
    count: np.ndarray    # K contacts
    scale: float         # [N]
    contacts: int        # that carry force, in bins or not

    @property
    def centres(self):
        return 0.5 * (self.edges[1:] + self.edges[:-1])

    @property
    def error(self):
        """K standard errors of the density (counts as Poisson's)."""
        return np.sqrt(self.count) / (self.contacts * np.diff(self.edges))


def force_distribution(normal_force, bins=30, upper=6.0, lower=1e-3, spacing="linear", scale=None):
    """ForceDistribution of C forces [N] in `bins` bins from 0 (linear) or `lower` (spacing="log") to `upper`.

    `scale` [N] divides the forces; None: their mean. `bins` may also be an array of edges. Forces outside the bins
    count in the norm, so that distributions with different bins can be compared.
    """
    f = normal_force[normal_force > 0]
    scale = float(scale if scale is not None else f.mean() if len(f) else 1.0)
    if np.ndim(bins):
        edges = np.asarray(bins, dtype=float)
    elif spacing == "log":
        edges = np.geomspace(lower, upper, bins + 1)
    elif spacing == "linear":
        edges = np.linspace(0.0, upper, bins + 1)
    else:
        raise ValueError(f"spacing {spacing!r}; expected 'linear' or 'log'")
    count, _ = np.histogram(f / scale, bins=edges)
    return ForceDistribution(edges, count / (max(len(f), 1) * np.diff(edges)), count, scale, len(f))


def exponential_tail(normal_force, start=1.0):
    """(beta, standard error) of P(x) ~ exp(-beta x) above x = `start`; (nan, nan) without forces there.

    Maximum likelihood: beta = 1 / <x - start>. Mueth, Jaeger and Nagel (1998): beta about 1.5 in static packings; the
    smaller beta, the more strong forces.
    """
    f = normal_force[normal_force > 0]
    x = f / f.mean() if len(f) else f
    tail = x[x > start]
    if not len(tail):
        return np.nan, np.nan
    beta = 1 / np.mean(tail - start)
    return float(beta), float(beta / np.sqrt(len(tail)))


def tail_variation(normal_force, start=1.0):
    """Standard deviation over mean of x - `start`, of the forces above x = `start`; nan without forces there.

    1 for an exponential tail, whatever its exponent; 0.76 for half a normal distribution, above 1 for a power law. Its
    standard error is about 1 / sqrt(forces there).
    """
    f = normal_force[normal_force > 0]
    excess = f / f.mean() - start if len(f) else f
    excess = excess[excess > 0]
    return float(excess.std() / excess.mean()) if len(excess) else np.nan


def power_of_weak(normal_force, end=1.0):
    """(alpha, standard error) of P(x) ~ x^alpha below x = `end`; (nan, nan) without forces there.

    Maximum likelihood; Radjai, Jean, Moreau and Roux (1996). alpha = 0: all weak forces equally likely; below 0: the
    weakest prevail.
    """
    f = normal_force[normal_force > 0]
    x = f / f.mean() if len(f) else f
    weak = x[x < end]
    if not len(weak):
        return np.nan, np.nan
    power = 1 / np.mean(np.log(end / weak))
    return float(power - 1), float(power / np.sqrt(len(weak)))


@dataclass(frozen=True)
class Uniformity:
    """How evenly forces are shared out. All but `variation` lie between 0 and 1."""
    gini: float           # 0: all equal; 1: one carries all
    participation: float  # <f>^2 / <f^2>; 1: all equal; 1 / C: one carries all
    variation: float      # standard deviation / mean
    top_tenth: float      # share of the sum that the largest tenth carries
    above_mean: float     # share of the contacts above <f>


def uniformity(values):
    """Uniformity of C values >= 0 (forces, or stresses); None without any above 0. Zeros do not count."""
    f = np.sort(values[values > 0])
    n = len(f)
    if not n:
        return None
    total, mean = f.sum(), f.mean()
    rest = f[:-max(1, round(0.1 * n))].sum()
    return Uniformity(gini=float(np.dot(2 * np.arange(1, n + 1) - n - 1, f) / (n * total)),
                      participation=float(mean ** 2 / np.mean(f ** 2)), variation=float(f.std() / mean),
                      top_tenth=float(1 - rest / total), above_mean=float(np.mean(f > mean)))


@dataclass(frozen=True)
class StrongShare:
    """What contacts above a force carry, as shares of all contacts'."""
    limit: float     # [N]
    contacts: float  # of their number
    pressure: float  # of the mean stress
    deviator: float  # of the deviator, along the assembly's own


def strong_share(branch, force, normal_force, limit=None):
    """StrongShare of the contacts with a normal force above `limit` [N]; None: above the mean.

    Radjai, Wolf, Jean and Moreau (1998): contacts above the mean carry almost the whole deviator, those below only
    pressure. C branch vectors and forces on their ends (C x 2), normal forces (C). nan where the whole is 0.
    """
    loaded = normal_force > 0
    limit = limit if limit is not None else float(normal_force[loaded].mean()) if loaded.any() else 0.0
    table = deviator_by_force(branch, force, normal_force, np.array([limit]))
    return StrongShare(limit, *(float(1 - values[0]) for values in table[1:]))


def deviator_by_force(branch, force, normal_force, limits):
    """(limits, and shares of contacts, pressure and deviator carried by contacts up to each limit), K each.

    The curve of Radjai et al. (1998): the deviator of weak contacts alone may even be negative.
    """
    loaded = normal_force > 0
    terms = np.column_stack([force[:, 0] * branch[:, 0], force[:, 1] * branch[:, 1],
                             0.5 * (force[:, 0] * branch[:, 1] + force[:, 1] * branch[:, 0])])[loaded]
    xx, yy, xy = assembly_stress(branch[loaded], force[loaded], 1.0)
    length = np.hypot(0.5 * (yy - xx), xy)
    along = (0.5 * (yy - xx) * 0.5 * (terms[:, 1] - terms[:, 0]) + xy * terms[:, 2]) / (length if length else np.nan)
    order = np.argsort(normal_force[loaded], kind="stable")
    up_to = np.searchsorted(normal_force[loaded][order], limits, side="right")

    def share(values):
        total = np.concatenate([[0.0], np.cumsum(values[order])])
        with np.errstate(invalid="ignore", divide="ignore"):
            return total[up_to] / total[-1]

    return limits, share(np.ones(len(order))), share(0.5 * (terms[:, 0] + terms[:, 1])), share(along)
