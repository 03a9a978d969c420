"""Distributions of forces at the quantiles of known laws, and states whose shares are known by hand."""
from statistics import NormalDist

import numpy as np
import pytest

from rockbreak import measures

SHARES = (np.arange(20000) + 0.5) / 20000
EXPONENTIAL = -2e6 * np.log(1 - SHARES)  # mean 2e6 but for what lies beyond the last quantile


@pytest.mark.parametrize("options", [{"bins": 60, "upper": 6.0}, {"bins": 40, "spacing": "log", "upper": 6.0},
                                     {"bins": np.array([0.0, 0.5, 1.0, 3.0])}])
def test_the_density_is_that_of_the_law_in_any_bins(options):
    found = measures.force_distribution(EXPONENTIAL, **options)
    inside = np.exp(-found.edges[:-1]) - np.exp(-found.edges[1:])
    # Of 20000 quantiles a bin may gain or lose one at each end, and the mean is 3e-5 off.
    assert found.density * np.diff(found.edges) == pytest.approx(inside, abs=2.0 / 20000)
    assert found.count / found.contacts == pytest.approx(inside, abs=2.0 / 20000)
    assert found.scale == pytest.approx(2e6, rel=1e-3)
    assert found.error == pytest.approx(np.sqrt(found.count) / 20000 / np.diff(found.edges))


def test_the_density_integrates_to_one_and_idle_contacts_do_not_count():
    forces = np.append(EXPONENTIAL, np.zeros(5000))
    found = measures.force_distribution(forces, bins=200, upper=20.0)
    assert np.sum(found.density * np.diff(found.edges)) == pytest.approx(1, abs=1e-12)
    assert found.contacts == 20000


def test_forces_may_be_divided_by_a_given_force():
    found = measures.force_distribution(np.array([1e6, 2e6, 3.5e6]), bins=4, upper=4.0, scale=1e6)
    assert found.count.tolist() == [0, 1, 1, 1] and found.scale == 1e6
    assert found.density == pytest.approx(np.array([0, 1, 1, 1]) / 3)
    with pytest.raises(ValueError, match="spacing"):
        measures.force_distribution(np.ones(3), spacing="square")


def test_the_tail_of_an_exponential_law_has_its_exponent():
    beta, error = measures.exponential_tail(EXPONENTIAL)
    assert beta == pytest.approx(1, abs=2e-3)  # what lies beyond the last quantile is missing
    assert error == pytest.approx(1 / np.sqrt(np.exp(-1) * 20000), rel=0.01)
    assert np.isnan(measures.exponential_tail(np.ones(5))).all()


def test_the_scatter_of_a_tail_tells_an_exponential_from_half_a_normal_distribution():
    assert measures.tail_variation(EXPONENTIAL) == pytest.approx(1, abs=0.003)
    assert measures.tail_variation(EXPONENTIAL, start=0.5) == pytest.approx(1, abs=0.003)
    normal = np.array([NormalDist().inv_cdf(one) for one in 0.5 + SHARES / 2])
    tail = np.concatenate([1 + 0.1 * normal, np.full(len(normal), 1 - 0.1 * np.sqrt(2 / np.pi))])  # mean 1
    assert measures.tail_variation(tail) == pytest.approx(np.sqrt(np.pi / 2 - 1), abs=0.002)
    assert np.isnan(measures.tail_variation(np.ones(5)))


def test_the_power_of_weak_forces_is_that_of_a_power_law():
    """P(x) = 3/4 x^(-1/2) / sqrt(3) up to 3 has mean 1."""
    power, error = measures.power_of_weak(3 * SHARES ** 2)
    assert power == pytest.approx(-0.5, abs=1e-3)
    assert error == pytest.approx(0.5 / np.sqrt(20000 / np.sqrt(3)), rel=0.01)
    assert np.isnan(measures.power_of_weak(np.zeros(0))).all()


def test_uniformity_of_laws_in_closed_form():
    """Exponential: Gini 1/2, <f>^2 / <f^2> 1/2, variation 1, e^-1 above the mean, top tenth (1 + ln 10) / 10."""
    found = measures.uniformity(EXPONENTIAL)
    assert (found.gini, found.participation, found.variation, found.above_mean, found.top_tenth) == pytest.approx(
        (0.5, 0.5, 1, np.exp(-1), (1 + np.log(10)) / 10), abs=2e-3)
    even = measures.uniformity(np.full(40, 3.0))
    assert (even.gini, even.participation, even.variation, even.top_tenth) == pytest.approx((0, 1, 0, 0.1), abs=1e-12)
    lone = measures.uniformity(np.array([1e-12] * 99 + [1.0]))
    assert (lone.gini, lone.participation) == pytest.approx((0.99, 0.01), abs=1e-9)
    assert measures.uniformity(np.zeros(3)) is None


def test_two_strong_contacts_along_the_load_carry_what_they_carry():
    """Two vertical contacts of 4, two horizontal ones of 1: deviator 8 - 2, of which the strong ones give 8 / 6 and the
    weak ones -2 / 6; pressure 8 / 10."""
    branch = np.array([[0, 1], [0, 1], [1, 0], [1, 0]], dtype=float)
    normal_force = np.array([4.0, 4.0, 1.0, 1.0])
    found = measures.strong_share(branch, normal_force[:, None] * branch, normal_force)
    assert (found.limit, found.contacts, found.pressure, found.deviator) == pytest.approx((2.5, 0.5, 0.8, 8 / 6))
    limits, contacts, pressure, deviator = measures.deviator_by_force(
        branch, normal_force[:, None] * branch, normal_force, np.array([0.5, 1.0, 4.0]))
    assert (contacts.tolist(), pressure.tolist()) == ([0, 0.5, 1], [0, pytest.approx(0.2), 1])
    assert deviator == pytest.approx([0, -2 / 6, 1])


def test_shares_do_not_depend_on_the_axes():
    rng = np.random.default_rng(2)
    branch, force, normal_force = rng.normal(size=(50, 2)), rng.normal(size=(50, 2)), rng.exponential(1, 50)
    turn = np.array([[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]])
    one = measures.strong_share(branch, force, normal_force)
    other = measures.strong_share(branch @ turn.T, force @ turn.T, normal_force)
    assert (one.pressure, one.deviator) == pytest.approx((other.pressure, other.deviator), rel=1e-9)


def test_without_a_deviator_nobody_has_a_share_of_it():
    branch = np.array([[0, 1], [1, 0]], dtype=float)
    assert np.isnan(measures.strong_share(branch, 3 * branch, np.array([3.0, 3.0])).deviator)
