"""Force chains made by hand in a grid of weak particles."""
import numpy as np
import pytest

from rockbreak import measures
from test_measures_frame import plain_frame

STRONG, WEAK = 10e6, 1e6


def uniaxial(size, direction):
    c, s = np.cos(direction), np.sin(direction)
    return size * np.array([c * c, s * s, c * s])


def column_in_a_grid(columns=5, rows=8, at=2):
    """A square grid of touching particles with stress WEAK, and STRONG vertical stress in one column."""
    position = np.array([[i, j] for i in range(columns) for j in range(rows)], dtype=float)
    stress = np.array([uniaxial(STRONG if p[0] == at else WEAK, np.pi / 2) for p in position])
    a, b = np.nonzero(np.triu(np.linalg.norm(position[:, None] - position[None], axis=2) < 1.1, 1))
    return position, stress, a, b


def polyline(angles):
    """Particles one apart in the directions of `angles`, stressed halfway between the directions of their two links."""
    steps = np.array([[np.cos(t), np.sin(t)] for t in angles])
    position = np.concatenate([[[0.0, 0.0]], np.cumsum(steps, axis=0)])
    toward = np.concatenate([angles[:1], 0.5 * (angles[1:] + angles[:-1]), angles[-1:]])
    return position, np.array([uniaxial(STRONG, t) for t in toward]), np.arange(len(angles)), np.arange(len(angles)) + 1


def test_a_straight_chain_in_a_weak_background_is_found():
    position, stress, a, b = column_in_a_grid()
    chains = measures.find_chains(position, stress, a, b)
    assert len(chains) == 1 and chains.sizes.tolist() == [8]
    assert position[chains.members].tolist() == [[2, j] for j in range(8)]
    assert chains.length == pytest.approx(7) and chains.span[0] == pytest.approx([0, 7])
    assert chains.straightness == pytest.approx(1)
    assert {tuple(sorted(pair)) for pair in np.column_stack([a, b])[chains.contacts].tolist()} == {
        tuple(sorted(pair)) for pair in zip(chains.members[:-1], chains.members[1:])}
    assert chains.threshold == pytest.approx((8 * STRONG + 32 * WEAK) / 40)
    assert chains.of_particle.tolist() == [0 if p[0] == 2 else -1 for p in position]


def test_stress_across_the_column_makes_no_chain_of_it():
    position, stress, a, b = column_in_a_grid()
    assert len(measures.find_chains(position, stress[:, [1, 0, 2]], a, b)) == 0


@pytest.mark.parametrize("bend, sizes", [(80, [9]), (100, [5, 4])])
def test_a_chain_is_cut_where_it_bends_by_more_than_twice_the_angle(bend, sizes):
    """Stress at the bend points halfway: each link is half of the bend off. At 100 degrees neither link of the corner
    is good; the corner's own end belongs to none."""
    angles = np.radians([90.0] * 4 + [90.0 - bend] * 4)
    position, stress, a, b = polyline(angles)
    if sizes == [5, 4]:  # give the corner to the first part: its stress along that
        stress[4] = uniaxial(STRONG, np.pi / 2)
    chains = measures.find_chains(position, stress, a, b, threshold=2e6)
    assert sorted(chains.sizes.tolist(), reverse=True) == sizes


def test_the_angle_decides():
    position, stress, a, b = polyline(np.radians([90, 90, 90, 40, 40, 40.0]))  # each link of the corner 25 degrees off
    assert measures.find_chains(position, stress, a, b, threshold=2e6, angle=np.radians(26)).sizes.tolist() == [7]
    assert measures.find_chains(position, stress, a, b, threshold=2e6, angle=np.radians(24)).sizes.tolist() == [3, 3]


def test_two_particles_are_no_chain_unless_asked_for():
    position, stress, a, b = polyline(np.radians([90.0]))
    assert len(measures.find_chains(position, stress, a, b, threshold=2e6)) == 0
    assert len(measures.find_chains(position, stress, a, b, threshold=2e6, shortest=2)) == 1


def test_a_fork_goes_on_along_the_straighter_link():
    position = np.array([[0, 0], [0, 1], [0, 2], [0.1, 3], [0.6, 2.8]], dtype=float)
    stress = np.array([uniaxial(STRONG, np.pi / 2)] * 5)
    chains = measures.find_chains(position, stress, np.array([0, 1, 2, 2]), np.array([1, 2, 4, 3]), threshold=2e6)
    assert chains.members.tolist() == [0, 1, 2, 3] and chains.contacts.tolist() == [0, 1, 3]


def test_every_chain_is_a_path_of_its_contacts_in_a_random_packing():
    """Whatever the state: members are unique, highly stressed, and neighbours in a chain share its contact."""
    rng = np.random.default_rng(4)
    position = rng.uniform(0, 17, (600, 2))
    stress = rng.exponential(1e6, (600, 3)) * [1, 1, 0.4]
    a, b = np.nonzero(np.triu(np.linalg.norm(position[:, None] - position[None], axis=2) < 1.0, 1))
    chains = measures.find_chains(position, stress, a, b)
    assert len(chains) > 5 and len(np.unique(chains.members)) == len(chains.members)
    assert chains.stressed[chains.members].all() and (chains.sizes >= 3).all()
    assert len(chains.contacts) == len(chains.members) - len(chains)
    k = 0
    for begin, end in zip(chains.offset[:-1], chains.offset[1:]):
        for i, j in zip(chains.members[begin:end - 1], chains.members[begin + 1:end]):
            assert {a[chains.contacts[k]], b[chains.contacts[k]]} == {i, j}
            k += 1


def test_a_closed_chain_ends_somewhere():
    """Twelve particles on a circle, stressed along it."""
    turn = np.arange(12) * np.pi / 6
    position = np.column_stack([np.cos(turn), np.sin(turn)])
    stress = np.array([uniaxial(STRONG, t + np.pi / 2) for t in turn])
    chains = measures.find_chains(position, stress, np.arange(12), (np.arange(12) + 1) % 12, threshold=2e6)
    assert chains.sizes.tolist() == [12] and len(chains.contacts) == 11


def test_boundary_particles_and_idle_contacts_of_a_frame_are_in_no_chain():
    position, stress, a, b = column_in_a_grid()
    boundary = position[:, 1] == 0
    idle = (position[a] == [2, 5]).all(axis=1) & (position[b] == [2, 6]).all(axis=1)
    frame = plain_frame(position, a=a, b=b, boundary=boundary, normal_force=np.where(idle, 0.0, 1.0))
    chains = measures.force_chains(frame, stress)
    assert [position[i].tolist() for i in chains.members] == [[2, j] for j in range(1, 6)]  # (2, 6), (2, 7) are two
    assert {(a[k], b[k]) for k in chains.contacts} == set(zip(chains.members[:-1], chains.members[1:]))
