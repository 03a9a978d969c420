"""Classes of forces, stresses and displacements against states whose answer is known by hand."""
import numpy as np
import pytest

import synthetic
from rockbreak.measures.classes import (STRESS_LIMITS, force_classes, held_stresses, large_displacements,
                                        particle_stresses, read_contact_state, stress_classes, two_contacts)


def test_forces_at_a_threshold_are_moderate_and_unloaded_contacts_do_not_count():
    assert force_classes(np.array([0.0, 1.0, 0.999e6, 1e6, 5e6, 5.001e6, 9e6])) == (2, 2, 2)
    assert force_classes(np.zeros(0)) == (0, 0, 0)


def test_tension_is_a_low_stress():
    assert stress_classes(np.array([-20e6, 3e6, 5e6, 8e6, 30e6]), low=4e6, high=10e6) == (2, 2, 1)


def test_a_displacement_counts_by_its_length():
    assert large_displacements(np.array([[1.1, 0.0], [0.9, 0.9], [0.0, -1.19], [0.0, 0.0]])) == 2


def pressed_square(stress, side=0.5, turn=0.3, centre=(3.0, -2.0)):
    """A turned square between four neighbours that put the tractions of a uniform stress on its sides' middles."""
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, -s], [s, c]])
    outward = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]]) @ rotation.T
    point = np.asarray(centre) + 0.5 * side * outward
    force = -side * outward @ stress.T  # traction of a compression-positive stress
    position = np.vstack([[centre], np.asarray(centre) + side * outward])
    return position, point, force


@pytest.mark.parametrize("square_is_a", [True, False])
def test_a_square_under_the_tractions_of_a_uniform_stress_has_that_stress(square_is_a):
    stress = np.array([[2e6, -0.7e6], [-0.7e6, 5e6]])
    position, point, force = pressed_square(stress)
    square, others = np.zeros(4, dtype=int), np.arange(1, 5)
    a, b = (square, others) if square_is_a else (others, square)
    found = particle_stresses(position, np.full(5, 0.25), a, b, point, -force if square_is_a else force)
    assert found[0] == pytest.approx([2e6, 5e6, -0.7e6])


def test_two_particles_pressed_on_each_other_have_equal_and_opposite_forces_but_equal_signs_of_stress():
    position = np.array([[0.0, 0.0], [0.0, 1.0]])
    found = particle_stresses(position, np.array([0.5, 0.25]), np.array([0]), np.array([1]), np.array([[0.0, 0.6]]),
                              np.array([[0.0, 1e6]]))
    assert found == pytest.approx(np.array([[0, 1.2e6, 0], [0, 1.6e6, 0]]))


def test_the_volume_average_of_particle_stresses_is_the_stress_of_the_assembly():
    """Eq. 13 with branch vectors between centroids, over any closed set of contacts."""
    rng = np.random.default_rng(3)
    position, area = rng.uniform(0, 5, (30, 2)), rng.uniform(0.1, 0.2, 30)
    pairs = np.array([(i, j) for i in range(30) for j in range(i + 1, 30)])[rng.permutation(435)[:80]]
    point, force = rng.uniform(0, 5, (80, 2)), rng.normal(0, 1e6, (80, 2))
    a, b = pairs.T
    found = particle_stresses(position, area, a, b, point, force)
    total = np.einsum("ci,cj->ij", force, position[b] - position[a])
    expected = [total[0, 0], total[1, 1], 0.5 * (total[0, 1] + total[1, 0])]
    assert area @ found == pytest.approx(expected, rel=1e-9)


def test_supports_are_two_contacts_of_the_particle_as_a_or_as_b():
    a, b = np.array([0, 0, 1, 0]), np.array([1, 2, 2, 3])
    found = two_contacts(5, a, b)
    for particle, contacts in enumerate([{0, 1, 3}, {0, 2}, {1, 2}]):
        assert found[particle, 0] != found[particle, 1] and set(found[particle]) <= contacts
    assert found[3:].tolist() == [[3, -1], [-1, -1]]


def test_which_contacts_support_a_particle_does_not_follow_the_numbers_of_its_neighbours():
    """Six neighbours around each particle, numbered in turn: two of six at random are side by side in 6 of 15."""
    particles = np.arange(0, 70000, 7)
    a, b = np.repeat(particles, 6), np.arange(70000)[np.arange(70000) % 7 > 0]
    found = two_contacts(70000, a, b)[particles]
    apart = np.abs(found[:, 0] - found[:, 1])
    assert np.mean((apart == 1) | (apart == 5)) == pytest.approx(0.4, abs=0.02)


def test_a_column_held_at_both_ends_carries_no_stress_and_one_held_across_gains_what_poisson_would_have_spread():
    """Uniaxial stress in plane strain: sideways it expands by nu/(1-nu) of what it shortens."""
    stress = np.array([[0.0, 4e6, 0.0]] * 3)
    point = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]])
    found = held_stresses(stress, np.array([[0, 1], [0, 2], [0, -1]]), point, poisson_ratio=0.2)
    assert found == pytest.approx(np.array([[0, 0, 0], [1e6, 4e6, 0], [0, 4e6, 0]]))


def test_held_supports_neither_come_closer_nor_move_apart():
    rng = np.random.default_rng(5)
    stress, point = rng.normal(0, 1e6, (50, 3)), rng.uniform(-1, 1, (100, 2))
    supports = np.arange(100).reshape(50, 2)
    found = held_stresses(stress, supports, point, poisson_ratio=0.3)
    for (xx, yy, xy), (i, j), before in zip(found, supports, stress):
        d = point[i] - point[j]
        sigma = np.array([[xx, xy], [xy, yy]])
        strain = sigma - 0.3 * np.trace(sigma) * np.eye(2)
        assert d @ strain @ d == pytest.approx(0, abs=1e-6 * 1e6)
        across = np.array([-d[1], d[0]])
        assert across @ sigma @ across == pytest.approx(
            across @ np.array([[before[0], before[2]], [before[2], before[1]]]) @ across)


def test_a_frame_is_counted_as_its_arrays_are(tmp_path):
    run = synthetic.write_run(tmp_path / "r", frames=5, breaks=lambda k: 2)
    path = run / "frames" / "000004.h5"
    with synthetic.edited(path) as file:
        forces = np.concatenate([np.full(10, 0.5e6), np.full(20, 2e6), np.full(5, 7e6)])
        forces = np.concatenate([forces, np.zeros(len(file["contacts/a"]) - 35)])
        file["contacts/normal_force"][:] = forces
        file["particles/displacement"][:] = 0.0
        file["particles/displacement"][3] = [2.0, 0.0]
        ids, force = file["particles/id"][:].tolist(), file["contacts/force"][:]
        position, area = file["particles/position"][:], file["particles/area"][:]
        by_hand = np.zeros((len(ids), 2))
        for c, (a, b) in enumerate(zip(file["contacts/a"][:], file["contacts/b"][:])):
            for particle, sign in ((ids.index(a), 1), (ids.index(b), -1)):
                arm = file["contacts/point"][c] - position[particle]
                by_hand[particle] += sign * force[c] * arm / area[particle]
    state = read_contact_state(path)
    assert state.stress["virial"][:, :2] == pytest.approx(by_hand, rel=1e-9, abs=1e-3)
    counts, (low, high) = state.counts(), STRESS_LIMITS["virial"]
    assert [counts[name] for name in ("weak_forces", "moderate_forces", "strong_forces", "contacts")] == [10, 20, 5, 35]
    assert counts["large_displacements"] == 1 and counts["particles"] == len(ids) == 48 + 8
    assert counts["low_vertical_stresses"] == np.sum(by_hand[:, 1] < low)
    assert counts["high_horizontal_stresses"] == np.sum(by_hand[:, 0] > high)
