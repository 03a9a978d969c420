"""A history of splits made by hand: families, generations, directions, sizes."""
import numpy as np
import pytest

import synthetic
from rockbreak import measures
from test_measures_frame import plain_frame

# 0 and 1 are whole; 2 broke into 3 and 4, 4 into 5 and 6.
FAMILY = dict(id=np.array([0, 1, 3, 5, 6]), parent=np.array([-1, -1, 2, 4, 4]), root=np.array([0, 1, 2, 2, 2]),
              generation=np.array([0, 0, 1, 2, 2]), area=np.array([1.0, 2.0, 0.5, 0.3, 0.2]))


def split_of(frame, **given):
    n, none = len(frame), np.zeros(0, int)
    values = dict(number=frame.number, id=frame.id, status=np.zeros(n, int), stress=np.full((n, 3), np.nan),
                  min_safety_factor=np.ones(n), failure_mode=np.zeros(n, int), broken=none, path=np.zeros((0, 2, 2)),
                  fragment=none, fragment_parent=none, fragment_offset=np.zeros(1, int),
                  fragment_vertices=np.zeros((0, 2)), cracked=none, crack_offset=np.zeros(1, int),
                  crack_points=np.zeros((0, 2)))
    return measures.Split(**(values | given))


def test_families_and_generations_by_hand():
    frame = plain_frame(np.zeros((5, 2)), **FAMILY)
    families = measures.families(frame)
    assert families.root.tolist() == [0, 1, 2] and families.members.tolist() == [1, 1, 3]
    assert families.broken.tolist() == [False, False, True] and families.generation.tolist() == [0, 0, 2]
    assert families.area == pytest.approx([1, 2, 1]) and families.largest_share == pytest.approx([1, 1, 0.5])
    assert families.of.tolist() == [0, 1, 2, 2, 2]
    found = measures.generations(frame)
    assert [(g.generation, g.particles) for g in found] == [(0, 2), (1, 1), (2, 2)]
    assert [g.area_share for g in found] == pytest.approx([3 / 4, 0.5 / 4, 0.5 / 4])
    assert found[1].mean_size == pytest.approx(np.sqrt(4 * 0.5 / np.pi))


def test_a_breakage_in_world_axes():
    """A square turned by 30 degrees, cut along its body's y axis a quarter of its width from the left: the line stands
    at 120 degrees; the mean stress is vertical."""
    frame = plain_frame([[0, 0], [5, 6]], number=7, axial_strain=0.03, angle=np.radians([0, 30]), id=np.array([4, 8]),
                        root=np.array([4, 2]), generation=np.array([0, 1]))
    left, right = np.array([[-0.5, -0.5], [-0.25, -0.5], [-0.25, 0.5], [-0.5, 0.5]]), np.array(
        [[-0.25, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.25, 0.5]])
    split = split_of(frame, stress=np.array([[1.0, 1.0, 0.0], [1e6, 4e6, 0.0]]), failure_mode=np.array([0, 2]),
                     broken=np.array([8]), path=np.array([[[-0.25, -0.5], [-0.25, 0.5]]]), fragment=np.array([9, 10]),
                     fragment_parent=np.array([8, 8]), fragment_offset=np.array([0, 4, 8]),
                     fragment_vertices=np.vstack([right, left]))
    found = measures.breakages_of(frame, split)
    assert (found.frame[0], found.axial_strain[0], found.particle[0], found.root[0], found.generation[0],
            found.mode[0]) == (7, 0.03, 8, 2, 1, 2)
    assert found.pieces[0] == pytest.approx([0.25, 0.75]) and found.size_ratio == pytest.approx([0.25])
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    assert found.ends[0, 1] == pytest.approx([5 - 0.25 * c - 0.5 * s, 6 - 0.25 * s + 0.5 * c])
    assert np.degrees(found.direction) == pytest.approx([120])
    assert np.degrees(found.stress_direction) == pytest.approx([90])
    assert np.degrees(found.angle_to_stress) == pytest.approx([30]) == np.degrees(found.angle_to_axis)
    assert found.applied.all() and not measures.breakages_of(frame, split, final=True).applied.any()
    with pytest.raises(ValueError, match="particle 8"):
        measures.breakages_of(plain_frame([[0, 0]]), split)


def test_arrested_cracks_in_world_axes():
    """A bent crack in particle 8, and one in a fragment that the frame does not have yet."""
    frame = plain_frame([[0, 0], [5, 6]], angle=np.radians([0, 90]), id=np.array([4, 8]))
    split = split_of(frame, stress=np.tile([1e6, 4e6, 0.0], (2, 1)), failure_mode=np.array([0, 1]),
                     cracked=np.array([8, 9]), crack_offset=np.array([0, 3, 5]),
                     crack_points=np.array([[0, 0], [0.3, 0], [0.3, 0.4], [9, 9], [8, 8]], dtype=float))
    cracks = measures.arrested_cracks(frame, split)
    assert cracks.particle.tolist() == [1] and cracks.mode.tolist() == [1]
    assert cracks.length == pytest.approx([0.7])
    assert cracks.ends[0] == pytest.approx(np.array([[5, 6], [4.6, 6.3]]))
    assert np.degrees(cracks.direction) == pytest.approx([180 - np.degrees(np.arctan2(3, 4))])
    assert np.degrees(cracks.angle_to_stress) == pytest.approx([np.degrees(np.arctan2(4, 3))])


def test_angles_between_lines_know_no_head_and_tail():
    assert measures.angle_between(np.radians([179.0, 10.0, 90.0]), np.radians([1.0, 190.0, 0.0])) == pytest.approx(
        np.radians([2.0, 0.0, 90.0]), abs=1e-12)


def test_all_breakages_of_a_run(tmp_path):
    """Every second frame breaks one hexagon along its diagonal, the final frame another one that is never applied."""
    run = synthetic.write_run(tmp_path / "r", frames=6, breaks=lambda k: 1 if k % 2 else 0)
    found = measures.read_breakages(run)
    assert found.frame.tolist() == [1, 3, 5] and found.applied.tolist() == [True, True, False]
    assert found.axial_strain == pytest.approx([0.02, 0.06, 0.10])
    assert found.size_ratio == pytest.approx([0.5] * 3) and found.pieces.sum(axis=1) == pytest.approx(found.area)
    assert np.linalg.norm(found.ends[:, 1] - found.ends[:, 0], axis=1) == pytest.approx([0.44] * 3)
    assert measures.breakages_by_strain(found, [0, 0.05, 0.1]).tolist() == [1, 2]
    last = measures.read_frame(run / "frames" / "000005.h5")
    assert measures.generations(last)[1].particles == 2 * found.applied.sum()
    assert found.chosen(found.applied).frame.tolist() == [1, 3]
    edges, share = measures.direction_rose(found.direction, bins=6)
    assert share.sum() == pytest.approx(1) and edges[[0, -1]] == pytest.approx([0, np.pi])


def test_a_run_without_breakage_has_none(tmp_path):
    run = synthetic.write_run(tmp_path / "r", frames=3, breakable=False)
    found = measures.read_breakages(run)
    assert len(found) == 0 and found.direction.shape == (0,) and found.angle_to_stress.shape == (0,)
    assert measures.breakages_by_strain(found, [0, 0.1]).tolist() == [0]
    assert measures.direction_rose(found.direction)[1].sum() == 0
