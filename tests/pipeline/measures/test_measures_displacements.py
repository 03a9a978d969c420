"""Motions that are known: rigid rotation, simple shear, compression, and what is not affine."""
import numpy as np
import pytest

from rockbreak import measures
from test_measures_frame import plain_frame

RNG = np.random.default_rng(9)
PLACES = RNG.uniform(-3, 3, (200, 2))
SIMPLE_SHEAR = np.array([[0.0, 0.02], [0.0, 0.0]])
COMPRESSION = np.array([[0.012, 0.003], [-0.001, -0.03]])


@pytest.mark.parametrize("gradient, strain, rotation", [
    (SIMPLE_SHEAR, (0, 0, -0.01), -0.01), (COMPRESSION, (-0.012, 0.03, -0.001), -0.002),
    (np.array([[0.0, -0.05], [0.05, 0.0]]), (0, 0, 0), 0.05)])
def test_an_affine_motion_is_found_with_no_rest(gradient, strain, rotation):
    motion = measures.affine_motion(PLACES, np.array([0.3, -0.2]) + PLACES @ gradient.T)
    assert motion.gradient == pytest.approx(gradient, abs=1e-13)
    assert motion.translation == pytest.approx([0.3, -0.2]) and motion.share == pytest.approx(0, abs=1e-20)
    assert motion.strain == pytest.approx(strain, abs=1e-13)
    assert motion.rotation == pytest.approx(rotation, abs=1e-13)


def test_a_rigid_rotation_by_a_finite_angle():
    """R - 1 is its gradient: rotation sin(t), and a strain 1 - cos(t) that small-strain theory sees."""
    c, s = np.cos(0.3), np.sin(0.3)
    motion = measures.affine_motion(PLACES, PLACES @ np.array([[c, s], [-s, c]]) - PLACES)
    assert motion.rotation == pytest.approx(s) and motion.strain == pytest.approx([1 - c, 1 - c, 0], abs=1e-13)


def test_the_rest_is_what_is_not_affine():
    """u = x + 0.1 (-1)^k in pairs at one place: the pairs cancel in the fit."""
    places = np.repeat(PLACES, 2, axis=0)
    wiggle = 0.1 * np.tile([[1.0, 0.0], [-1.0, 0.0]], (len(PLACES), 1))
    motion = measures.affine_motion(places, 0.01 * places + wiggle)
    assert motion.rest == pytest.approx(wiggle, abs=1e-13)
    assert motion.share == pytest.approx(0.01 / np.mean(np.sum((0.01 * places + wiggle) ** 2, axis=1)))


def test_weights_decide_where_motions_differ():
    places = np.array([[0, 0], [1, 0], [0, 1], [1, 1]], dtype=float)
    motion = measures.affine_motion(places, np.array([[0, 0], [0, 0], [0, 0], [1, 0]], dtype=float),
                                    np.array([1, 1, 1, 1e-12]))
    assert motion.gradient == pytest.approx(np.zeros((2, 2)), abs=1e-9)


def test_a_frame_s_motion_is_that_since_the_start_of_shear():
    displacement = PLACES @ COMPRESSION.T
    frame = plain_frame(PLACES + displacement, displacement=displacement)
    assert measures.frame_motion(frame).gradient == pytest.approx(COMPRESSION, abs=1e-13)


@pytest.mark.parametrize("gradient", [SIMPLE_SHEAR, COMPRESSION])
def test_local_gradients_are_exact_for_affine_motion(gradient):
    found = measures.local_gradients(PLACES, PLACES @ gradient.T, radius=1.2)
    assert found == pytest.approx(np.tile(gradient, (200, 1, 1)), abs=1e-12)
    assert measures.rotation_of(found) == pytest.approx(np.full(200, measures.rotation_of(gradient)), abs=1e-12)
    assert measures.strain_of(found)[0] == pytest.approx(measures.strain_of(gradient), abs=1e-12)


def test_local_gradients_tell_two_blocks_apart():
    """The right half turns, the left one does not; away from the border each knows only its own."""
    turning = PLACES[:, 0] > 0
    displacement = np.where(turning[:, None], PLACES @ np.array([[0, -0.1], [0.1, 0]]).T, 0.0)
    rotation = measures.rotation_of(measures.local_gradients(PLACES, displacement, radius=1.0))
    assert rotation[PLACES[:, 0] > 1.0] == pytest.approx(0.1) and rotation[PLACES[:, 0] < -1.0] == pytest.approx(0)


def test_too_few_neighbours_give_no_gradient():
    places = np.array([[0, 0], [1, 0], [2, 0], [0, 50], [1, 50], [0, 51]], dtype=float)
    found = measures.local_gradients(places, 0.1 * places, radius=2.5)
    assert np.isnan(found[:3]).all()  # all on one line
    assert found[3:] == pytest.approx(np.tile(0.1 * np.eye(2), (3, 1, 1)))


def test_neighbours_are_those_of_all_distances():
    from rockbreak.measures.displacements import pairs_within
    i, j = pairs_within(PLACES, 0.9)
    distance = np.linalg.norm(PLACES[:, None] - PLACES[None], axis=2)
    expected = np.argwhere((distance < 0.9) & (distance > 0))
    assert sorted(zip(i.tolist(), j.tolist())) == sorted(map(tuple, expected.tolist()))


def test_rotations_and_displacements_since_a_frame_follow_the_family():
    """Particle 1 broke into 5 and 6, 6 into 8 and 9: 8 knows its parent only where that one was already there."""
    start = plain_frame(np.zeros((3, 2)), id=np.array([0, 1, 2]), angle=np.array([0.1, 0.2, 0.3]))
    after = plain_frame(np.ones((4, 2)), id=np.array([0, 5, 8, 9]), parent=np.array([-1, 1, 6, 6]),
                        root=np.array([0, 1, 1, 1]), angle=np.array([7.0, 0.5, 0.7, 0.2]),
                        displacement=np.array([[1, 0], [2, 0], [3, 0], [4, 0]], dtype=float))
    assert measures.ancestors(after, start).tolist() == [0, 1, 1, 1]
    assert measures.rotations_since(after, start) == pytest.approx([6.9, 0.3, 0.5, 0.0])
    assert measures.displacements_since(after, start) == pytest.approx(after.displacement)
    between = plain_frame(np.zeros((3, 2)), id=np.array([0, 5, 6]), angle=np.array([1.0, 0.4, 0.5]))
    assert measures.rotations_since(after, between) == pytest.approx([6.0, 0.1, 0.2, -0.3])
    lost = plain_frame(np.zeros((1, 2)), id=np.array([0]))
    assert np.isnan(measures.rotations_since(after, lost)[1:]).all()


def test_classes_by_length():
    u = np.array([[0.3, 0.4], [1.0, 0.0], [0.0, -1.2]])
    assert measures.displacement_class(u, [0.5, 1.18]).tolist() == [0, 1, 2]
