"""Fabric and force anisotropies of one contact state: second-order Fourier fits, Eqs. 7-12 of the paper.

E(theta)   = 1/(2 pi) [1 + a cos 2(theta - theta_0)]      (7)  contact orientations
f_n(theta) = f_0 [1 + a_n cos 2(theta - theta_n)]         (8)  mean normal force
f_s(theta) = f_0 a_t sin 2(theta - theta_t)               (9)  mean shear force
sin(phi)   = (a + a_n + a_t) / 2 / (1 + a a_n / 2)        (10)
sin(phi)   = (a + a_n + a_t) / 2                          (11)
sin(phi)   = (s_1 - s_2) / (s_1 + s_2)                    (12)  s_1, s_2: principal stresses of Eq. 13

The paper calls f_0 the average of all contact forces; where contacts are unequally many by direction that is larger, by
1 + a a_n / 2 cos 2(theta_0 - theta_n) (7 % at 10 % strain and 2 MPa), and with it (10) would have no denominator. All
contacts count, those of boundary particles too; `dem` has none between two of these.

theta is the direction of the contact normal, from the x axis; a normal and its opposite are the same direction.
(7) is fitted by its moments, <cos 2 theta> = a/2 cos 2 theta_0 and <sin 2 theta> = a/2 sin 2 theta_0; (8) and (9) by
least squares over the contacts, f_0 being the constant term of (8), that is, the mean over all directions.

Sign of the shear force. Frames count it positive along (-n_y, n_x), counter-clockwise, and theta_t is that of (9) read
so. Then theta_t lies *across* the load: under vertical compression theta_0 and theta_n are near 90 degrees, theta_t
near 0. `theta_shear` = theta_t + 90 degrees is the direction that the shear forces help to carry, (9) with the shear
force counted clockwise; in the paper's Eq. 10 all three directions are one. With E, f_n, f_s of any three directions
and one length of all branches, Eq. 13 gives exactly

sin(phi) = | a e(theta_0) + a_n e(theta_n) + a_t e(theta_shear) | / 2 / (1 + a a_n / 2 cos 2(theta_0 - theta_n)),

e(theta) = (cos 2 theta, sin 2 theta): `sin_phi_general`, which is Eq. 10 where the three directions are one.

How few contacts are too few: n contacts drawn without any preferred direction give a = sqrt(pi / n) in the mean
(`a_of_chance`), 0.04 with 2000 and 0.18 with 100, and an error of sqrt(2 / n) in each fit of a.

Contacts of a packing are not drawn independently, as the standard errors suppose: those around one particle keep apart,
forces balance. Over 75 isotropic samples of about 1200 particles the components of a, a_n, a_t scattered by 0.018,
0.026, 0.008, where the fits claimed 0.030, 0.023, 0.005: right for a_n, too large for a, too small for a_t.
"""
from dataclasses import dataclass

import numpy as np

from .stresses import line_angle, principal_stresses

SMALLEST_FIT = 3  # contacts


@dataclass(frozen=True)
class Anisotropies:
    a: float
    a_n: float
    a_t: float
    theta_0: float  # [rad] in [0, pi), as theta_n and theta_t
    theta_n: float
    theta_t: float
    mean_normal_force: float  # f_0 [N]
    contacts: int = 0         # that carry force
    errors: dict = None       # standard errors of a, a_n, a_t, theta_*, sum, sin_phi, sin_phi_simplified

    @property
    def sum(self):
        """a + a_n + a_t, the paper's total anisotropy (Figs. 12, 20)."""
        return self.a + self.a_n + self.a_t

    @property
    def theta_shear(self):
        """Direction that the shear forces help to carry [rad]; see the file's head."""
        return float(line_angle(self.theta_t + np.pi / 2))

    @property
    def sin_phi(self):
        """Eq. 10."""
        return 0.5 * self.sum / (1 + 0.5 * self.a * self.a_n)

    @property
    def sin_phi_simplified(self):
        """Eq. 11."""
        return 0.5 * self.sum

    @property
    def sin_phi_general(self):
        """Eq. 10 without the assumption that the three directions are one; see the file's head."""
        deviator = abs(self.a * np.exp(2j * self.theta_0) + self.a_n * np.exp(2j * self.theta_n)
                       + self.a_t * np.exp(2j * self.theta_shear))
        return float(0.5 * deviator / (1 + 0.5 * self.a * self.a_n * np.cos(2 * (self.theta_0 - self.theta_n))))

    @property
    def a_of_chance(self):
        """sqrt(pi / n): mean `a` of as many contacts without any preferred direction."""
        return float(np.sqrt(np.pi / self.contacts))

    def orientation(self, theta):
        """E of Eq. 7 [1/rad]."""
        return (1 + self.a * np.cos(2 * (theta - self.theta_0))) / (2 * np.pi)

    def normal(self, theta):
        """Mean normal force of Eq. 8 [N]."""
        return self.mean_normal_force * (1 + self.a_n * np.cos(2 * (theta - self.theta_n)))

    def shear(self, theta):
        """Mean shear force of Eq. 9 [N], counter-clockwise positive."""
        return self.mean_normal_force * self.a_t * np.sin(2 * (theta - self.theta_t))


def fit_anisotropies(normal, normal_force, shear_force):
    """Anisotropies of C contacts: unit normals (C x 2), normal and shear forces (C) [N]. None below 3 contacts.

    Contacts that carry nothing are not counted. Standard errors are to first order, take the contacts for independent
    (see the file's head) and let the scatter of the forces depend on direction (sandwich estimate).
    """
    loaded = normal_force > 0
    normal, normal_force, shear_force = normal[loaded], normal_force[loaded], shear_force[loaded]
    n = len(normal)
    if n < SMALLEST_FIT:
        return None
    cos2 = normal[:, 0] ** 2 - normal[:, 1] ** 2
    sin2 = 2 * normal[:, 0] * normal[:, 1]
    c, s = cos2.mean(), sin2.mean()
    basis = np.column_stack([np.ones_like(cos2), cos2, sin2])
    inverse = np.linalg.pinv(basis)  # 3 x C
    (f0, nc, ns), (_, tc, ts) = inverse @ normal_force, inverse @ shear_force
    fit = dict(
        a=2 * float(np.hypot(s, c)), theta_0=float(line_angle(0.5 * np.arctan2(s, c))),
        a_n=float(np.hypot(ns, nc) / f0), theta_n=float(line_angle(0.5 * np.arctan2(ns, nc))),
        # a_t sin 2(theta - theta_t) = a_t (cos 2 theta_t sin 2 theta - sin 2 theta_t cos 2 theta)
        a_t=float(np.hypot(tc, ts) / f0), theta_t=float(line_angle(0.5 * np.arctan2(-tc, ts))))
    # What one contact more would change, times n, in each fitted number: their mean squares over n are the variances.
    moments = np.array([cos2 - c, sin2 - s])
    normal_terms = n * inverse * (normal_force - basis @ (f0, nc, ns))
    shear_terms = n * inverse * (shear_force - basis @ (inverse @ shear_force))
    of = {}
    of["a"], of["theta_0"] = _polar_terms(2 * c, 2 * s, *(2 * moments))
    of["a_n"], of["theta_n"] = _polar_terms(nc / f0, ns / f0, *((normal_terms[1:] - np.outer(
        (nc / f0, ns / f0), normal_terms[0])) / f0))
    of["a_t"], of["theta_t"] = _polar_terms(ts / f0, -tc / f0, *((shear_terms[:0:-1] * [[1], [-1]] - np.outer(
        (ts / f0, -tc / f0), normal_terms[0])) / f0))
    of["sum"] = of["a"] + of["a_n"] + of["a_t"]
    below = 1 + 0.5 * fit["a"] * fit["a_n"]
    total = fit["a"] + fit["a_n"] + fit["a_t"]
    of["sin_phi"] = 0.5 * of["sum"] / below - 0.25 * total / below ** 2 * (
        fit["a"] * of["a_n"] + fit["a_n"] * of["a"])
    of["sin_phi_simplified"] = 0.5 * of["sum"]
    errors = {name: float(np.sqrt(np.mean(terms ** 2) / n)) for name, terms in of.items()}
    return Anisotropies(**fit, mean_normal_force=float(f0), contacts=n, errors=errors)


def _polar_terms(x, y, dx, dy):
    """Changes of the length of (x, y) and of half its angle where it changes by (dx, dy)."""
    length = np.hypot(x, y)
    if length == 0:
        return np.hypot(dx, dy), np.full_like(dx, np.inf)
    return (x * dx + y * dy) / length, 0.5 * (x * dy - y * dx) / length ** 2


def frame_anisotropies(frame):
    """Anisotropies of an open frame file."""
    contacts = frame["contacts"]
    return fit_anisotropies(contacts["normal"][:], contacts["normal_force"][:], contacts["shear_force"][:])


@dataclass(frozen=True)
class PolarHistogram:
    """Contacts by direction, for Figs. 9-11, 17-19: K bins around the circle, each contact in both its directions."""
    edges: np.ndarray               # K + 1, from 0 to 2 pi [rad]
    contacts: np.ndarray            # K
    mean_normal_force: np.ndarray   # K [N]; nan without a contact, as the rest
    mean_shear_force: np.ndarray    # K [N], counter-clockwise positive
    mean_shear_size: np.ndarray     # K [N]; mean of |shear force|
    normal_force_error: np.ndarray  # K [N]; standard errors of the means
    shear_force_error: np.ndarray   # K [N]

    @property
    def centres(self):
        return 0.5 * (self.edges[1:] + self.edges[:-1])

    @property
    def density(self):
        """E of Eq. 7 [1/rad]; its integral around the circle is 1."""
        return self.contacts / (self.contacts.sum() * np.diff(self.edges))


def polar_histogram(normal, normal_force, shear_force, bins=36):
    """PolarHistogram of C contacts (as in fit_anisotropies) in an even number of equal `bins`.

    Contacts that carry nothing are not counted.
    """
    if bins % 2:
        raise ValueError(f"{bins} bins; expected an even number, so that opposite directions have equal bins")
    loaded = normal_force > 0
    x, y = normal[loaded].T
    half = bins // 2
    k = np.floor(np.arctan2(y, x) % np.pi * (half / np.pi)).astype(int) % half
    count = np.bincount(k, minlength=half)
    with np.errstate(invalid="ignore", divide="ignore"):
        def mean(values):
            return np.bincount(k, values, half) / count

        def error(values, means):
            return np.sqrt(np.bincount(k, (values - means[k]) ** 2, half) / (count - 1) / count)

        n, s = normal_force[loaded], shear_force[loaded]
        halves = [count, mean(n), mean(s), mean(np.abs(s)), error(n, mean(n)), error(s, mean(s))]
    return PolarHistogram(np.linspace(0, 2 * np.pi, bins + 1), *(np.tile(values, 2) for values in halves))


def sin_phi_of_stress(stress):
    """Eq. 12 from stress (..., 3) as (xx, yy, xy) [any unit]: (s_1 - s_2) / (s_1 + s_2) of the principal stresses."""
    major, minor, _ = principal_stresses(stress)
    return (major - minor) / (major + minor)
