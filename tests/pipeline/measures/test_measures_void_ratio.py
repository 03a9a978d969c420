"""Areas and void ratios of lattices whose answer is known."""
import numpy as np
import pytest

import synthetic
from rockbreak import measures
from test_measures_frame import plain_frame


def lattice(n=12, gap=0.1, side=0.4):
    """n x n squares, `gap` apart, with the ring through the centres of the outer ones."""
    i, j = np.meshgrid(np.arange(n), np.arange(n))
    position = (side + gap) * np.column_stack([i.ravel(), j.ravel()])
    at = {tuple(p): row for row, p in enumerate(np.column_stack([i.ravel(), j.ravel()]).tolist())}
    way = ([(k, 0) for k in range(n - 1)] + [(n - 1, k) for k in range(n - 1)]
           + [(k, n - 1) for k in range(n - 1, 0, -1)] + [(0, k) for k in range(n - 1, 0, -1)])
    ring = np.array([at[place] for place in way])
    boundary = np.isin(np.arange(n * n), ring)
    return plain_frame(position, half=side / 2, ring=ring, boundary=boundary)


def test_void_ratios_of_a_lattice_by_hand():
    """A = (11 * 0.5)^2; solids inside: 100 whole, 40 halves, 4 quarters of 0.16 m^2."""
    found = measures.void_ratios(lattice())
    area = 5.5 ** 2
    assert found.assembly_area == pytest.approx(area)
    assert found.e1 == pytest.approx(area / (121 * 0.16) - 1)
    assert found.e4 == pytest.approx(area / (100 * 0.16) - 1)
    assert found.e2 == found.e1 and found.escaped == 0


def test_overlaps_and_runaways():
    frame = lattice()
    away = len(frame)
    position = np.vstack([frame.position, [[20.0, 3.0], [-3.0, 1.0]]])
    frame = plain_frame(position, half=0.2, ring=frame.ring, a=[5, 7], b=[6, away + 1],
                        overlap_area=np.array([0.01, 0.02]))
    found = measures.void_ratios(frame)
    assert found.escaped == 1  # the other one outside touches something, and counts
    assert found.e2 == pytest.approx(5.5 ** 2 / (122 * 0.16 - 0.03) - 1)
    assert found.e4 == pytest.approx(5.5 ** 2 / (101 * 0.16) - 1)


def clipped_area(polygon, low, high):
    """Sutherland and Hodgman (1974): the second method."""
    for axis, bound, sign in ((0, low[0], 1), (0, high[0], -1), (1, low[1], 1), (1, high[1], -1)):
        kept = []
        for p, q in zip(polygon, np.roll(polygon, -1, axis=0)):
            u, v = sign * (p[axis] - bound), sign * (q[axis] - bound)
            if u >= 0:
                kept.append(p)
            if u * v < 0:
                kept.append(p + (q - p) * u / (u - v))
        if len(kept) < 3:
            return 0.0
        polygon = np.array(kept)
    return synthetic.polygon_area(polygon)


def test_areas_in_tiles_are_those_of_clipped_polygons():
    rng = np.random.default_rng(6)
    outlines = []
    for _ in range(60):
        turn = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(3, 9)))
        outlines.append(rng.uniform(0, 3, 2) + rng.uniform(0.05, 1.5) * np.column_stack([np.cos(turn), np.sin(turn)]))
    x, y = np.array([0.0, 0.4, 0.5, 1.7, 2.2]), np.array([0.1, 0.9, 1.0, 2.5])
    tiles = measures.tile_areas(np.vstack(outlines), np.cumsum([0] + [len(o) for o in outlines]), x, y)
    found = np.zeros((60, 3, 4))
    found[tiles.polygon, tiles.row, tiles.column] = tiles.area
    expected = [[[clipped_area(o, (x[i], y[j]), (x[i + 1], y[j + 1])) for i in range(4)] for j in range(3)]
                for o in outlines]
    assert found == pytest.approx(np.array(expected), abs=1e-14)


def test_a_square_on_the_grid_lines_lies_in_its_tiles_alone():
    square = np.array([[1.0, 1.0], [3.0, 1.0], [3.0, 2.0], [1.0, 2.0]])
    edges = np.arange(5.0)
    tiles = measures.tile_areas(square, np.array([0, 4]), edges, edges)
    filled = {(int(r), int(c)) for r, c, area in zip(tiles.row, tiles.column, tiles.area) if area > 0}
    assert filled == {(1, 1), (1, 2)} and tiles.area[tiles.area > 0].tolist() == [1.0, 1.0]


def test_a_polygon_that_is_not_convex_keeps_its_area_in_tiles():
    star = np.array([[np.cos(t), np.sin(t)] for t in np.arange(10) * np.pi / 5]) * np.tile([2.0, 0.7], 5)[:, None]
    edges = np.linspace(-2.1, 2.2, 14)
    tiles = measures.tile_areas(star, np.array([0, 10]), edges, edges)
    assert tiles.area.sum() == pytest.approx(synthetic.polygon_area(star), rel=1e-13)


def test_the_local_void_ratio_of_a_lattice_is_the_cell_s():
    """Windows of two by two cells hold four squares wherever they stand: e = 4 * 0.25 / (4 * 0.16) - 1."""
    fields = measures.windows(lattice(), size=1.0, across=4)
    assert np.isfinite(fields.void_ratio).all()
    assert fields.void_ratio == pytest.approx(np.full(fields.void_ratio.shape, 0.5 ** 2 / 0.16 - 1), rel=1e-12)
    assert fields.x[0] - 0.5 == pytest.approx(0) and fields.x[-1] + 0.5 == pytest.approx(5.5)


def test_a_hole_raises_the_void_ratio_around_it():
    whole = lattice()
    hole = np.flatnonzero((whole.position == whole.position[5 * 12 + 5]).all(axis=1))[0]
    kept = np.arange(len(whole)) != hole
    renumbered = np.cumsum(kept) - 1
    frame = plain_frame(whole.position[kept], half=0.2, ring=renumbered[whole.ring])
    e = measures.windows(frame, size=1.0, across=4).void_ratio
    assert e.max() == pytest.approx(1 / 0.48 - 1, rel=1e-12) and e.min() == pytest.approx(0.25 / 0.16 - 1, rel=1e-12)


def test_windows_that_leave_the_ring_have_no_value():
    turn = np.arange(40) * 2 * np.pi / 40
    ring = 3 * np.column_stack([np.cos(turn), np.sin(turn)])
    square = np.array([[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]])
    fields = measures.windows_of(square, np.array([0, 4]), ring, size=1.0, across=2)
    x, y = np.meshgrid(fields.x, fields.y)
    corner = np.hypot(np.abs(x) + 0.5, np.abs(y) + 0.5)
    assert np.isfinite(fields.void_ratio[corner < 2.99]).all() and np.isnan(fields.void_ratio[corner > 3.0]).all()
    assert fields.void_ratio[np.isfinite(fields.void_ratio)] == pytest.approx(0, abs=1e-12)


def test_means_and_stresses_of_windows():
    """Windows stand around squares: values linear in place have window means linear in place. A stress in the solids is
    thinned by the voids."""
    frame = lattice()
    fields = measures.windows(frame, size=1.0, across=2)
    x, _ = np.meshgrid(fields.x, fields.y)
    assert fields.mean(3 * frame.position[:, 0]) == pytest.approx(3 * x, rel=1e-12)
    stress = fields.stress(np.tile([1e6, 2e6, -3e5], (len(frame), 1)))
    assert stress == pytest.approx(np.tile(np.array([1e6, 2e6, -3e5]) * 0.16 / 0.25, x.shape + (1,)), rel=1e-12)


def test_unknown_values_do_not_count_in_means():
    frame = lattice()
    values = np.where(np.arange(len(frame)) % 2, np.nan, 7.0)
    assert measures.windows(frame, size=1.0).mean(values) == pytest.approx(7.0, rel=1e-12)
