"""Sizes, gradations and breakage indices of shapes and curves worked out by hand."""
import numpy as np
import pytest

from rockbreak import measures
from test_measures_frame import plain_frame


def rectangle(width, height, turn):
    corners = 0.5 * np.array([[-width, -height], [width, -height], [width, height], [-width, height]])
    c, s = np.cos(turn), np.sin(turn)
    return corners @ np.array([[c, s], [-s, c]])


def test_sizes_of_turned_shapes():
    """A rectangle falls through the slot of its shorter side, a triangle through that of its shortest height."""
    triangle = np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]])
    hexagon = np.array([[np.cos(t), np.sin(t)] for t in np.arange(6) * np.pi / 3 + 0.2])
    shapes = [rectangle(0.3, 0.8, 0.7), triangle, hexagon]
    vertices, offset = np.vstack(shapes), np.cumsum([0] + [len(shape) for shape in shapes])
    assert measures.sieve_size(vertices, offset) == pytest.approx([0.3, 3 * 4 / 5, np.sqrt(3)])
    assert measures.longest_diameter(vertices, offset) == pytest.approx([np.hypot(0.3, 0.8), 5, 2])
    assert measures.equivalent_diameter([np.pi, 0.25 * np.pi]) == pytest.approx([2, 1])


def test_the_sieve_size_is_the_smallest_width_over_all_directions():
    rng = np.random.default_rng(1)
    turn = np.sort(rng.uniform(0, 2 * np.pi, 7))
    polygon = np.column_stack([np.cos(turn), 0.6 * np.sin(turn)])  # on an ellipse: convex
    direction = np.linspace(0, np.pi, 20001)
    reach = polygon @ np.array([np.cos(direction), np.sin(direction)])
    width = (reach.max(axis=0) - reach.min(axis=0)).min()
    assert measures.sieve_size(polygon, np.array([0, 7]))[0] == pytest.approx(width, abs=1e-4)
    assert measures.sieve_size(polygon, np.array([0, 7]))[0] <= width


def test_a_curve_of_four_known_sizes():
    curve = measures.gradation(np.array([0.4, 0.1, 0.2, 0.3]), np.array([4.0, 1.0, 2.0, 3.0]))
    assert curve.size.tolist() == [0.1, 0.2, 0.3, 0.4] and curve.passing == pytest.approx([0.1, 0.3, 0.6, 1])
    assert curve.finer([0.05, 0.1, 0.15, 0.3, 0.5]) == pytest.approx([0, 0, 0.1, 0.3, 1])
    assert curve.percentile([10, 30, 31, 60, 100]).tolist() == [0.1, 0.2, 0.3, 0.3, 0.4]
    assert curve.uniformity == pytest.approx(3) and curve.curvature == pytest.approx(0.04 / 0.03)
    assert curve.mean_log(0.1) == pytest.approx(0.2 * np.log10(2) + 0.3 * np.log10(3) + 0.4 * np.log10(4))


def test_a_frame_has_a_curve_for_each_size():
    frame = plain_frame(np.zeros((3, 2)), half=0.2, boundary=np.array([True, False, False]))
    for size, value in (("sieve", 0.4), ("diameter", 0.4 * np.sqrt(2)), ("equivalent", 0.8 / np.sqrt(np.pi))):
        curve = measures.frame_gradation(frame, size)
        assert curve.size == pytest.approx([value] * 3) and curve.passing == pytest.approx([1 / 3, 2 / 3, 1])
    assert len(measures.frame_gradation(frame, boundary=False).size) == 2


BEFORE = measures.gradation(np.array([0.4, 0.8]), np.array([1.0, 3.0]))
AFTER = measures.gradation(np.array([0.2, 0.4, 0.8]), np.array([1.0, 1.0, 2.0]))  # a quarter of 0.8 broke down to 0.2
SIEVES = [0.1, 0.3, 0.6, 1.0]


def test_marsal_by_hand():
    """Retained on 0.1, 0.3, 0.6: before 0, 1/4, 3/4; after 1/4, 1/4, 1/2."""
    assert measures.marsal(BEFORE, AFTER, SIEVES) == pytest.approx(0.25)
    assert measures.marsal(BEFORE, BEFORE, SIEVES) == 0
    assert measures.marsal(BEFORE, AFTER, [0.1, 1.0]) == 0  # too coarse to see it
    assert measures.marsal(BEFORE, AFTER, [0.5]) == pytest.approx(0.25)  # below the last sieve is a share as well


def test_hardin_by_hand():
    """Over log10(d / 0.1): potential (log 4 + 3 log 8) / 4; a quarter of the mass goes from log 8 to log 2."""
    potential = (np.log10(4) + 3 * np.log10(8)) / 4
    assert measures.hardin(BEFORE, AFTER, 0.1) == pytest.approx(0.25 * np.log10(4) / potential)
    assert measures.hardin(BEFORE, BEFORE, 0.1) == 0
    assert measures.hardin(BEFORE, measures.gradation(np.array([0.1]), np.ones(1)), 0.1) == pytest.approx(1)
    assert np.isnan(measures.hardin(BEFORE, AFTER, 0.8))


def test_hardin_counts_nothing_below_the_limit():
    """What is crushed below 0.2 has used up its potential, however fine it is."""
    dust = measures.gradation(np.array([1e-6, 0.4, 0.8]), np.array([1.0, 1.0, 2.0]))
    assert measures.hardin(BEFORE, dust, 0.2) == pytest.approx(measures.hardin(BEFORE, AFTER, 0.2))


def test_hardin_is_the_area_between_the_curves():
    """Against quadrature of the two curves over log10 d."""
    rng = np.random.default_rng(7)
    curves = [measures.gradation(rng.uniform(low, 0.6, 200), rng.uniform(1, 2, 200)) for low in (0.3, 0.05)]
    middle = np.log10(0.1) + (np.arange(400_000) + 0.5) / 400_000 * np.log10(6)
    width = np.log10(6) / 400_000
    potential = np.sum(1 - curves[0].finer(10 ** middle)) * width
    total = np.sum(curves[1].finer(10 ** middle) - curves[0].finer(10 ** middle)) * width
    assert measures.hardin(*curves, 0.1) == pytest.approx(total / potential, abs=1e-5)


def test_einav_is_one_at_the_ultimate_gradation_and_zero_before():
    share = (np.arange(200_000) + 0.5) / 200_000
    ultimate = (0.1 ** 0.4 + share * (0.8 ** 0.4 - 0.1 ** 0.4)) ** (1 / 0.4)
    assert measures.einav(BEFORE, measures.gradation(ultimate, np.ones(len(share))), 0.1) == pytest.approx(1, abs=1e-5)
    assert measures.einav(BEFORE, BEFORE, 0.1) == 0
    assert measures.einav(BEFORE, AFTER, 0.1) > measures.hardin(BEFORE, AFTER, 0.1)


@pytest.mark.parametrize("dimension", [0.8, 1.37, 2.5])
def test_the_fractal_dimension_of_a_power_law(dimension):
    """N(>= d) = (d / 0.6)^-D at its sizes."""
    size = 0.6 * np.arange(1, 501) ** (-1 / dimension)
    fit = measures.fractal_dimension(size)
    assert (fit.dimension, fit.error) == (pytest.approx(dimension, abs=1e-10), pytest.approx(0, abs=1e-9))
    part = measures.fractal_dimension(np.append(size, np.full(300, 0.7)), upper=size[10])
    assert part.points == 490 and part.lower == size.min() and part.upper == size[10]
    assert measures.fractal_dimension(size[:2]) is None


@pytest.mark.parametrize("dimensions, dimension", [(2, 1.3), (3, 2.6)])
def test_the_fractal_dimension_by_mass_of_a_power_law(dimensions, dimension):
    passing = np.linspace(0.001, 1, 1000)
    curve = measures.Gradation(0.5 * passing ** (1 / (dimensions - dimension)), passing)
    fit = measures.fractal_dimension_by_mass(curve, dimensions=dimensions)
    assert fit.dimension == pytest.approx(dimension, abs=1e-10)


def test_the_fractal_dimension_has_an_error_that_tells_of_a_bend():
    size = np.concatenate([np.geomspace(0.1, 0.3, 200), np.geomspace(0.3, 0.31, 200)])
    assert measures.fractal_dimension(size).error > 0.02


def test_sieves_go_down_to_the_smallest_and_the_smallest_piece_is_a_circle():
    sieves = measures.standard_sieves(0.1, 0.8, ratio=2)
    assert sieves == pytest.approx([0.1, 0.2, 0.4, 0.8])
    assert measures.standard_sieves(0.09, 0.8, ratio=2)[0] == pytest.approx(0.05)
    assert measures.smallest_piece({"breakage": {"minimum_area": np.pi / 4}}) == pytest.approx(1)
