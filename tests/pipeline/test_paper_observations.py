"""What the paper's sentences ask of a run, against states and histories whose answer is counted one by one."""
import h5py
import numpy as np
import pytest

import synthetic
from rockbreak.measures.fabric import frame_anisotropies
from rockbreak.measures.frame import read_frame
from rockbreak.paper.observations import equations_10_11, frame_numbers, observe, outside_over_inside
from rockbreak.run.results import Results
from rockbreak.run.run_directory import RunDirectory

FRAMES, STRAIN, FABRIC = 21, 0.173, (0.3, 0.5, 0.2)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    run = synthetic.write_run(tmp_path_factory.mktemp("observed") / "run", frames=FRAMES, strain=STRAIN,
                              anisotropy=FABRIC, breaks=lambda k: 7 if k == 2 else 0)
    return Results(RunDirectory(run))


@pytest.fixture(scope="module")
def state(results, tmp_path_factory):
    """(path, numbers) of the last frame with normal forces about 70 and shear forces about 100 degrees, of 250 contacts
    of which 20 are unloaded."""
    path = tmp_path_factory.mktemp("state") / "000020.h5"
    path.write_bytes(results.directory.frame_file(20).read_bytes())
    normal, force, shear = synthetic.contacts_of_known_anisotropy(250, 0.2, 0.6, 0.25, np.radians(90), np.radians(70),
                                                                  np.radians(100))
    force[::13] = shear[::13] = 0
    with synthetic.edited(path) as file:
        ids = file["particles/id"][:]
        pairs = np.random.default_rng(1).permuted(np.tile(ids, (250, 1)), axis=1)[:, :2]
        for name, values in {"a": pairs.min(axis=1), "b": pairs.max(axis=1), "normal": normal, "normal_force": force,
                             "shear_force": shear, "point": np.zeros((250, 2)), "force": np.zeros((250, 2))}.items():
            del file[f"contacts/{name}"]
            file[f"contacts/{name}"] = values
        fit = frame_anisotropies(file)
    return path, frame_numbers(read_frame(path), fit)


def test_forces_are_counted_one_by_one(state):
    path, found = state
    with h5py.File(path) as file:
        contacts = [(f, abs(s), angle) for f, s, angle in zip(
            file["contacts/normal_force"][:], file["contacts/shear_force"][:],
            np.degrees(np.arctan2(*file["contacts/normal"][:].T[::-1]))) if f > 0]
        fragment = dict(zip(file["particles/id"][:], file["particles/generation"][:] > 0))
        broken = [fragment[a] or fragment[b] for a, b, f in zip(
            file["contacts/a"][:], file["contacts/b"][:], file["contacts/normal_force"][:]) if f > 0]
    f = [one[0] for one in contacts]
    mean = sum(f) / len(f)
    assert len(f) == 230 and 10 < sum(broken) < 220
    expected = {
        "mean_force": 1e-3 * mean, "force_scatter": 1e-3 * (sum((x - mean) ** 2 for x in f) / len(f)) ** 0.5,
        "shear_over_normal": sum(one[1] for one in contacts) / sum(f),
        "share_below_mean": sum(x < mean for x in f) / len(f), "top_tenth": sum(sorted(f)[-23:]) / sum(f),
        "gini": sum(abs(x - y) for x in f for y in f) / (2 * len(f) ** 2 * mean),
        "vertical_contacts": sum(45 < abs(one[2]) < 135 for one in contacts),
        "horizontal_contacts": sum(not 45 < abs(one[2]) < 135 for one in contacts),
        "force_at_fragments": (sum(x for x, at in zip(f, broken) if at) / sum(broken)
                               / (sum(x for x, at in zip(f, broken) if not at) / (len(f) - sum(broken)))),
    }
    assert {name: found[name] for name in expected} == pytest.approx(expected)
    assert found["tilt_of_normal_forces"] == pytest.approx(20, abs=1)
    assert found["tilt_of_shear_forces"] == pytest.approx(80, abs=1)  # 100 + 90 degrees
    assert found["diagonal_shear_force"] == pytest.approx(250, rel=0.03)


def test_motion_is_that_of_the_particles_one_by_one(state):
    path, found = state
    with h5py.File(path) as file:
        moved, place = file["particles/displacement"][:], file["particles/position"][:]
    start = place - moved
    radius = [np.hypot(*(one - start.mean(axis=0))) for one in start]
    length = [np.hypot(*one) for one in moved]
    outer, inner = ([x for x, r in zip(length, radius) if (r >= max(radius) / 2) == far] for far in (True, False))
    assert found["largest_displacement"] == pytest.approx(max(length))
    assert found["outer_over_inner"] == pytest.approx(np.mean(outer) / np.mean(inner))


def test_stages_are_the_frames_nearest_to_their_strains(results):
    """Displacements grow in proportion to the strain, and frames are 0.865 % apart."""
    found = observe(results)
    for column, frame in (("start", 0), ("2 %", 2), ("7 %", 8), ("10 %", 12), ("17.3 %", 20), ("end", 20), ("peak", 5)):
        moved = found["largest_displacement", column] / found["largest_displacement", "end"]
        assert moved == pytest.approx(frame / 20, abs=0.01)


def test_strengths_are_those_of_the_peak_of_the_last_2_percent_and_of_2_percent_around_7_and_10(results):
    found = observe(results)
    for column, middle in (("end", STRAIN - 0.01), ("7 %", 0.07), ("10 %", 0.10)):
        strain = np.linspace(middle - 0.01, middle + 0.01, 200)
        assert found["sin_phi", column] == pytest.approx(np.mean(0.4 + 0.1 * np.exp(-(strain - 0.04) / 0.02)), abs=1e-4)
    assert found["sin_phi", "peak"] == pytest.approx(0.5, abs=0.003)


def test_equations_10_and_11_are_compared_with_equation_12_every_half_percent(results):
    frames, ten, eleven = np.linspace(0, STRAIN, FRAMES), [], []
    for strain in 0.005 * np.arange(1, 35):
        at = frames[np.argmin(np.abs(frames - strain))]
        a, a_n, a_t = min(1, at / 0.04) * np.array(FABRIC)
        macro = 0.5 * np.sin(np.pi / 2 * at / 0.04) if at < 0.04 else 0.4 + 0.1 * np.exp(-(at - 0.04) / 0.02)
        ten.append(abs((a + a_n + a_t) / 2 / (1 + a * a_n / 2) - macro))
        eleven.append((a + a_n + a_t) / 2 - macro)
    assert equations_10_11(results) == pytest.approx({10: np.mean(ten), 11: np.mean(eleven)}, abs=0.003)


def test_the_share_that_breaks_outside_is_counted_one_by_one(results):
    with h5py.File(results.directory.frame_file(0)) as first, h5py.File(results.directory.split_file(2)) as split:
        place, broken = first["particles/position"][:], set(split["broken/parent"][:])
        free = [k for k in range(48) if not first["particles/boundary"][k]]
    radius = {k: np.hypot(*(place[k] - place.mean(axis=0))) for k in free}
    outer = sorted(free, key=radius.get)[len(free) // 2:]
    inner = [k for k in free if k not in outer]
    shares = [sum(k in broken for k in part) / len(part) for part in (outer, inner)]
    assert 0 < shares[1] != shares[0] > 0
    assert outside_over_inside(results) == pytest.approx(shares[0] / shares[1])
