"""Fabric and force anisotropies of one contact state: second-order Fourier fits, Eqs. 7-10 of the paper.

E(theta)   = 1/(2 pi) [1 + a cos 2(theta - theta_0)]      (7)  contact orientations
f_n(theta) = f_0 [1 + a_n cos 2(theta - theta_n)]         (8)  mean normal force
f_s(theta) = f_0 a_t sin 2(theta - theta_t)               (9)  mean shear force
sin(phi)   = (a + a_n + a_t) / 2 / (1 + a a_n / 2)        (10)

theta is the direction of the contact normal, from the x axis; a normal and its opposite are the same direction.
(7) is fitted by its moments, <cos 2 theta> = a/2 cos 2 theta_0 and <sin 2 theta> = a/2 sin 2 theta_0; (8) and (9) by
least squares over the contacts, f_0 being the constant term of (8), that is, the mean over all directions.
"""
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Anisotropies:
    a: float
    a_n: float
    a_t: float
    theta_0: float  # [rad], as theta_n and theta_t
    theta_n: float
    theta_t: float
    mean_normal_force: float  # f_0 [N]

    @property
    def sin_phi(self):
        """Eq. 10."""
        return 0.5 * (self.a + self.a_n + self.a_t) / (1 + 0.5 * self.a * self.a_n)


def fit_anisotropies(normal, normal_force, shear_force):
    """Anisotropies of C contacts: unit normals (C x 2), normal and shear forces (C) [N]. None below 3 contacts.

    Contacts that carry nothing are not counted.
    """
    loaded = normal_force > 0
    normal, normal_force, shear_force = normal[loaded], normal_force[loaded], shear_force[loaded]
    if len(normal) < 3:
        return None
    cos2 = normal[:, 0] ** 2 - normal[:, 1] ** 2
    sin2 = 2 * normal[:, 0] * normal[:, 1]
    c, s = cos2.mean(), sin2.mean()
    basis = np.column_stack([np.ones_like(cos2), cos2, sin2])
    (f0, nc, ns), *_ = np.linalg.lstsq(basis, normal_force, rcond=None)
    (_, tc, ts), *_ = np.linalg.lstsq(basis, shear_force, rcond=None)
    return Anisotropies(
        a=2 * float(np.sqrt(c * c + s * s)), theta_0=0.5 * float(np.arctan2(s, c)),
        a_n=float(np.sqrt(nc * nc + ns * ns) / f0), theta_n=0.5 * float(np.arctan2(ns, nc)),
        # a_t sin 2(theta - theta_t) = a_t (cos 2 theta_t sin 2 theta - sin 2 theta_t cos 2 theta)
        a_t=float(np.sqrt(tc * tc + ts * ts) / f0), theta_t=0.5 * float(np.arctan2(-tc, ts)),
        mean_normal_force=float(f0))


def frame_anisotropies(frame):
    """Anisotropies of an open frame file."""
    contacts = frame["contacts"]
    return fit_anisotropies(contacts["normal"][:], contacts["normal_force"][:], contacts["shear_force"][:])
