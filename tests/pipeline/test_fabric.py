"""Fourier fits against contacts made from Eqs. 7 to 9 with known coefficients."""
import numpy as np
import pytest

from rockbreak.measures.fabric import fit_anisotropies
from synthetic import contacts_of_known_anisotropy


@pytest.mark.parametrize("a, a_n, a_t", [(0.3, 0.5, 0.2), (0.05, 0.9, 0.01), (0.6, 0.1, 0.4)])
def test_fit_returns_the_anisotropies_of_the_distribution(a, a_n, a_t):
    directions = {"theta_0": 1.4, "theta_n": 1.6, "theta_t": 0.7}
    fit = fit_anisotropies(*contacts_of_known_anisotropy(4000, a, a_n, a_t, **directions, f0=3e6))
    assert (fit.a, fit.a_n, fit.a_t) == pytest.approx((a, a_n, a_t), abs=1e-6)
    assert fit.mean_normal_force == pytest.approx(3e6)
    for name, angle in directions.items():
        assert np.sin(2 * (getattr(fit, name) - angle)) == pytest.approx(0, abs=1e-5)
        assert np.cos(2 * (getattr(fit, name) - angle)) == pytest.approx(1, abs=1e-5)


def test_fit_from_random_contacts_is_unbiased():
    """Contacts drawn by rejection from Eq. 7, forces on Eqs. 8 and 9 with noise: sampling error only."""
    rng = np.random.default_rng(3)
    theta = rng.uniform(0, 2 * np.pi, 400_000)
    theta = theta[rng.uniform(0, 1.3, len(theta)) < 1 + 0.3 * np.cos(2 * (theta - np.pi / 2))]
    normal = np.column_stack([np.cos(theta), np.sin(theta)])
    force = (1 + 0.5 * np.cos(2 * (theta - np.pi / 2))) * rng.exponential(1.0, len(theta))
    shear = 0.2 * np.sin(2 * (theta - np.pi / 2)) + rng.normal(0, 0.3, len(theta))
    fit = fit_anisotropies(normal, force, shear)
    assert (fit.a, fit.a_n, fit.a_t) == pytest.approx((0.3, 0.5, 0.2), abs=0.01)


def test_isotropic_contacts_have_none():
    fit = fit_anisotropies(*contacts_of_known_anisotropy(360, 0, 0, 0))
    assert (fit.a, fit.a_n, fit.a_t, fit.sin_phi) == pytest.approx((0, 0, 0, 0), abs=1e-9)


def test_a_normal_and_its_opposite_count_alike():
    normal, force, shear = contacts_of_known_anisotropy(500, 0.3, 0.5, 0.2)
    flip = np.where(np.arange(500) % 3 == 0, -1.0, 1.0)[:, None]
    one, other = fit_anisotropies(normal, force, shear), fit_anisotropies(flip * normal, force, shear)
    assert (one.a, one.a_n, one.a_t) == pytest.approx((other.a, other.a_n, other.a_t), rel=1e-12)


def test_contacts_without_force_do_not_count():
    normal, force, shear = contacts_of_known_anisotropy(500, 0.3, 0.5, 0.2)
    idle = np.tile([1.0, 0.0], (200, 1))
    fit = fit_anisotropies(np.vstack([normal, idle]), np.append(force, np.zeros(200)), np.append(shear, np.zeros(200)))
    assert fit.a == pytest.approx(0.3, abs=1e-4)


def test_eq_10():
    fit = fit_anisotropies(*contacts_of_known_anisotropy(4000, 0.3, 0.5, 0.2))
    assert fit.sin_phi == pytest.approx(0.5 * 1.0 / (1 + 0.075), abs=1e-5)


def test_too_few_contacts_give_no_fit():
    assert fit_anisotropies(np.eye(2), np.ones(2), np.zeros(2)) is None
