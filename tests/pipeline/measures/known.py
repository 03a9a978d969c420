"""Contact states whose measures are known exactly."""
import numpy as np


def quantiles(count, a, theta_0):
    """Directions at the midpoint quantiles of Eq. 7 over the whole circle: the nodes of a quadrature that converges
    exponentially, since the integrands are periodic and analytic in the quantile."""
    share = 2 * np.pi * (np.arange(count) + 0.5) / count
    theta = share.copy()
    for _ in range(100):  # Newton: theta + a/2 (sin 2(theta - theta_0) + sin 2 theta_0) = share
        excess = theta + a / 2 * (np.sin(2 * (theta - theta_0)) + np.sin(2 * theta_0)) - share
        theta -= excess / (1 + a * np.cos(2 * (theta - theta_0)))
    return theta


def contacts(a, a_n, a_t, theta_0=np.pi / 2, theta_n=np.pi / 2, theta_t=0.0, f0=1e6, count=400):
    """(normals, normal forces, shear forces) that lie exactly on Eqs. 7 to 9, theta_t as there."""
    theta = quantiles(count, a, theta_0)
    normal = np.column_stack([np.cos(theta), np.sin(theta)])
    return normal, f0 * (1 + a_n * np.cos(2 * (theta - theta_n))), f0 * a_t * np.sin(2 * (theta - theta_t))


def forces(normal, normal_force, shear_force):
    """C x 2 forces on b."""
    tangent = np.column_stack([-normal[:, 1], normal[:, 0]])
    return normal_force[:, None] * normal + shear_force[:, None] * tangent
