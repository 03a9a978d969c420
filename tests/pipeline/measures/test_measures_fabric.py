"""Eqs. 7 to 13 on contacts at quadrature points, where every sum is the integral to rounding."""
import numpy as np
import pytest

import known
from rockbreak import measures

STATES = [(0.3, 0.5, 0.2), (0.05, 0.9, 0.01), (0.6, 0.1, 0.4)]


@pytest.mark.parametrize("a, a_n, a_t", STATES)
def test_the_fit_is_exact_at_quadrature_points(a, a_n, a_t):
    angles = {"theta_0": 1.4, "theta_n": 1.7, "theta_t": 0.2}
    fit = measures.fit_anisotropies(*known.contacts(a, a_n, a_t, **angles, f0=3e6))
    assert (fit.a, fit.a_n, fit.a_t) == pytest.approx((a, a_n, a_t), abs=1e-12)
    assert [getattr(fit, name) for name in angles] == pytest.approx(list(angles.values()), abs=1e-11)
    assert fit.mean_normal_force == pytest.approx(3e6, rel=1e-13)
    assert fit.contacts == 400


def test_directions_lie_between_0_and_pi():
    fit = measures.fit_anisotropies(*known.contacts(0.3, 0.5, 0.2, theta_0=-0.3, theta_n=3.4, theta_t=2.0))
    assert (fit.theta_0, fit.theta_n, fit.theta_t) == pytest.approx((np.pi - 0.3, 3.4 - np.pi, 2.0), abs=1e-11)


def test_isotropic_contacts_have_no_anisotropy_and_no_friction():
    normal, normal_force, shear_force = known.contacts(0, 0, 0)
    fit = measures.fit_anisotropies(normal, normal_force, shear_force)
    assert (fit.a, fit.a_n, fit.a_t, fit.sin_phi, fit.sin_phi_simplified, fit.sin_phi_general) == pytest.approx(
        (0,) * 6, abs=1e-13)
    stress = measures.assembly_stress(0.4 * normal, known.forces(normal, normal_force, shear_force), 100.0)
    assert stress == pytest.approx([400 * 0.4 * 1e6 / 2 / 100] * 2 + [0], rel=1e-12, abs=1e-6)
    assert measures.sin_phi_of_stress(stress) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("a, a_n, a_t", STATES)
def test_eq_10_is_eq_12_of_eq_13_and_eq_11_is_above_by_its_factor(a, a_n, a_t):
    """With branches of one length and one principal direction Eq. 10 is exact: the integral of Eq. 13 over Eqs. 7 to 9.
    Shear forces that support the load lie on Eq. 9 with theta_t across it."""
    normal, normal_force, shear_force = known.contacts(a, a_n, a_t, 1.2, 1.2, 1.2 - np.pi / 2)
    fit = measures.fit_anisotropies(normal, normal_force, shear_force)
    stress = measures.assembly_stress(0.45 * normal, known.forces(normal, normal_force, shear_force), 180.0)
    macroscopic = measures.sin_phi_of_stress(stress)
    assert fit.sin_phi == pytest.approx(macroscopic, abs=1e-12)
    assert fit.sin_phi_general == pytest.approx(macroscopic, abs=1e-12)
    assert fit.sin_phi_simplified == pytest.approx(macroscopic * (1 + a * a_n / 2), abs=1e-12)
    assert fit.sum == pytest.approx(a + a_n + a_t, abs=1e-12)
    assert measures.principal_stresses(stress)[2] == pytest.approx(1.2, abs=1e-11)
    assert fit.theta_shear == pytest.approx(1.2, abs=1e-11)


def test_three_different_directions_need_the_general_form():
    normal, normal_force, shear_force = known.contacts(0.3, 0.5, 0.2, 1.2, 1.5, 1.9 - np.pi / 2)
    fit = measures.fit_anisotropies(normal, normal_force, shear_force)
    stress = measures.assembly_stress(0.45 * normal, known.forces(normal, normal_force, shear_force), 180.0)
    assert fit.sin_phi_general == pytest.approx(measures.sin_phi_of_stress(stress), abs=1e-12)
    assert fit.sin_phi > measures.sin_phi_of_stress(stress) + 0.03


def test_shear_forces_against_the_load_count_against_it():
    """theta_t along the load: shear forces that a = a_n alone would not have; the general form subtracts them."""
    normal, normal_force, shear_force = known.contacts(0.3, 0.5, 0.2, theta_t=np.pi / 2)
    fit = measures.fit_anisotropies(normal, normal_force, shear_force)
    stress = measures.assembly_stress(normal, known.forces(normal, normal_force, shear_force), 1.0)
    assert measures.sin_phi_of_stress(stress) == pytest.approx(0.5 * (0.3 + 0.5 - 0.2) / 1.075, abs=1e-12)
    assert fit.sin_phi_general == pytest.approx(measures.sin_phi_of_stress(stress), abs=1e-12)
    assert fit.theta_shear == pytest.approx(0, abs=1e-11) or fit.theta_shear == pytest.approx(np.pi, abs=1e-11)


def test_a_branch_length_that_varies_with_direction_changes_eq_13_in_the_same_order():
    """Eq. 10 knows nothing of branches: with l (1 + 0.1 cos 2(theta - theta_0)) it misses about half of 0.1."""
    normal, normal_force, shear_force = known.contacts(0.3, 0.5, 0.2)
    length = 1 + 0.1 * (normal[:, 1] ** 2 - normal[:, 0] ** 2)
    fit = measures.fit_anisotropies(normal, normal_force, shear_force)
    stress = measures.assembly_stress(length[:, None] * normal, known.forces(normal, normal_force, shear_force), 1.0)
    assert 0.02 < measures.sin_phi_of_stress(stress) - fit.sin_phi < 0.05


def test_standard_errors_are_the_scatter_of_repeated_samples():
    """600 samples of 800 contacts: their own scatter, against the mean of the errors that the fits claim. The scatter
    of 600 numbers is known to 3 %; the forces are noisier where they are larger."""
    rng = np.random.default_rng(5)
    fits = []
    for _ in range(600):
        theta = rng.uniform(0, 2 * np.pi, 2000)
        theta = theta[rng.uniform(0, 1.3, 2000) < 1 + 0.3 * np.cos(2 * (theta - np.pi / 2))][:800]
        mean = 1 + 0.5 * np.cos(2 * (theta - np.pi / 2))
        fits.append(measures.fit_anisotropies(np.column_stack([np.cos(theta), np.sin(theta)]),
                                              mean * rng.exponential(1.0, len(theta)),
                                              0.2 * np.sin(2 * theta) + 0.3 * mean * rng.normal(0, 1, len(theta))))
    for name in ("a", "a_n", "a_t", "theta_0", "theta_n", "sum", "sin_phi", "sin_phi_simplified"):
        claimed = np.mean([fit.errors[name] for fit in fits])
        assert claimed == pytest.approx(np.std([getattr(fit, name) for fit in fits]), rel=0.12), name
    turned = [np.sin(2 * fit.theta_t) / 2 for fit in fits]  # about 0, where [0, pi) has its seam
    assert np.mean([fit.errors["theta_t"] for fit in fits]) == pytest.approx(np.std(turned), rel=0.12)


def test_standard_errors_are_those_of_the_jackknife():
    """The second method: leave one of 600 contacts out, fit anew; the two agree up to terms of order 1 / 600."""
    rng = np.random.default_rng(11)
    normal, normal_force, shear_force = known.contacts(0.6, 0.5, 0.3, 1.2, 1.4, 0.5, count=600)
    state = normal, normal_force * rng.exponential(1, 600), shear_force + 2e5 * rng.normal(size=600)
    keep = ~np.eye(600, dtype=bool)
    left = [measures.fit_anisotropies(*(values[mask] for values in state)) for mask in keep]
    for name, error in measures.fit_anisotropies(*state).errors.items():
        assert error == pytest.approx(np.sqrt(599) * np.std([getattr(fit, name) for fit in left]), rel=0.02), name


def test_contacts_without_preference_have_an_a_of_chance():
    rng = np.random.default_rng(8)
    found = []
    for _ in range(400):
        theta = rng.uniform(0, np.pi, 500)
        fit = measures.fit_anisotropies(np.column_stack([np.cos(theta), np.sin(theta)]), np.ones(500), np.zeros(500))
        found.append(fit.a)
    assert np.mean(found) == pytest.approx(fit.a_of_chance, rel=0.08)


def test_the_polar_histogram_holds_every_contact_twice_and_its_means():
    normal, normal_force, shear_force = known.contacts(0.3, 0.5, 0.2, 1.4, 1.7, 0.2, count=40000)
    polar = measures.polar_histogram(normal, normal_force, shear_force, bins=24)
    theta = polar.centres
    assert polar.contacts.sum() == 2 * 40000
    assert np.sum(polar.density * np.diff(polar.edges)) == pytest.approx(1, rel=1e-12)
    smear = np.sinc(2 * np.pi / 24 / np.pi)  # mean of cos 2 theta over a bin / its value in the middle
    fit = measures.fit_anisotropies(normal, normal_force, shear_force)
    assert polar.density == pytest.approx((1 + 0.3 * smear * np.cos(2 * (theta - 1.4))) / (2 * np.pi), abs=3e-4)
    assert polar.mean_normal_force == pytest.approx(fit.normal(theta), rel=0.02)
    assert polar.mean_shear_force == pytest.approx(fit.shear(theta), abs=0.02e6)
    assert (polar.mean_shear_size >= np.abs(polar.mean_shear_force) - 1e-6).all()
    assert polar.mean_normal_force[:12] == pytest.approx(polar.mean_normal_force[12:])


def test_a_bin_without_contacts_has_no_mean():
    normal = np.array([[1.0, 0.0], [1.0, 0.01], [0.99, 0.02], [0.0, 1.0]])
    polar = measures.polar_histogram(normal, np.array([1.0, 2.0, 3.0, 0.0]), np.array([0.5, -0.5, 0.3, 9.0]), bins=8)
    assert polar.contacts.tolist() == [3, 0, 0, 0, 3, 0, 0, 0]
    assert polar.mean_normal_force[0] == pytest.approx(2) and np.isnan(polar.mean_normal_force[2])
    assert polar.mean_shear_force[4] == pytest.approx(0.1) and polar.mean_shear_size[4] == pytest.approx(1.3 / 3)
    assert polar.normal_force_error[0] == pytest.approx(1 / np.sqrt(3))
    with pytest.raises(ValueError, match="even"):
        measures.polar_histogram(normal, np.ones(4), np.zeros(4), bins=7)
