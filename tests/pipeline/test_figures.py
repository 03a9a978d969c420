"""The numbers in the figures, against runs whose numbers are known; and figures of runs that have hardly anything."""
import csv
import io
import warnings

import h5py
import numpy as np
import pytest

import synthetic
from rockbreak.figures.catalogue import CATALOGUE, PRESSURES
from rockbreak.figures.selection import select
from rockbreak.report.page import write_report
from rockbreak.run.results import Results
from rockbreak.run.run_directory import RunDirectory

A, A_N, A_T = 0.3, 0.5, 0.2  # from 4 % strain on; before, they grow in proportion to the strain
BROKEN = {1e6: 2, 4e6: 6}    # particles that break in the first split, by pressure
CONTACTS = 96


def selection_of(*directories):
    return select([Results(RunDirectory(directory)) for directory in directories])


@pytest.fixture(scope="module")
def grid(tmp_path_factory):
    folder = tmp_path_factory.mktemp("figures")
    return selection_of(*(synthetic.write_run(
        folder / f"{pressure:g} {breakable}", frames=11, breakable=breakable, pressure=pressure, contacts=CONTACTS,
        breaks=lambda k, pressure=pressure: BROKEN[pressure] if k == 0 else 0)
        for pressure in BROKEN for breakable in (True, False)))


@pytest.fixture(scope="module")
def one(grid):
    return selection_of(grid.at(4e6, True).first.directory.path)


def rows_of(selection, name, **wanted):
    """Rows of a figure's data as dicts, numbers as numbers; those with the `wanted` cells."""
    entry = next(entry for entry in CATALOGUE if entry.name == name)
    found = []
    for row in csv.DictReader(io.StringIO(entry.drawn(selection).data.text())):
        if all(row[key] == value for key, value in wanted.items()):
            found.append({key: number(value) for key, value in row.items()})
    assert found
    return found


def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def test_anisotropies_are_those_that_were_written(grid, one):
    for name, value in (("a", A), ("a_n", A_N), ("a_t", A_T), ("total", A + A_N + A_T)):
        assert rows_of(one, "anisotropies", anisotropy=name)[-1]["value"] == pytest.approx(value, rel=0.02)
        for condition in ("1 MPa, solid", "4 MPa, breakable"):
            curve = rows_of(grid, "anisotropies_by_pressure", anisotropy=name, condition=condition)
            assert curve[-1]["value"] == pytest.approx(value, rel=0.02)
            assert np.interp(0.02, [row["axial_strain"] for row in curve],
                             [row["value"] for row in curve]) == pytest.approx(value / 2, rel=0.05)


def test_friction_is_that_of_the_stresses_and_of_equations_10_and_11(grid, one):
    ends = {source: rows_of(one, "stress_and_fabric", source=source)[-1]["sin_phi"]
            for source in ("stresses", "eq_10", "eq_11")}
    assert ends["eq_10"] == pytest.approx(0.5 / 1.075, rel=0.02) and ends["eq_11"] == pytest.approx(0.5, rel=0.02)
    assert ends["stresses"] == pytest.approx(0.4 + 0.1 * np.exp(-3), rel=0.01)
    beside = rows_of(grid, "stress_and_fabric_by_pressure", condition="4 MPa, breakable")
    assert {row["source"]: row["sin_phi"] for row in beside} == pytest.approx(
        {"stresses": ends["stresses"], "eq_10": ends["eq_10"]}, rel=0.01)
    for row in rows_of(grid, "peak_friction"):
        peak = 0.5 if row["source"] == "stresses" else 0.5 / 1.075
        assert row["peak_friction_angle_degrees"] == pytest.approx(np.degrees(np.arcsin(peak)), abs=0.5)
        assert row["pressure_Pa"] in BROKEN


def test_directions_hold_every_contact_twice_and_their_fits(one, grid):
    bars = rows_of(one, "contact_orientation", column="end")
    assert sum(row["contacts"] for row in bars) == 2 * CONTACTS
    assert sum(row["contacts_fit"] for row in bars) == pytest.approx(2 * CONTACTS, rel=1e-3)
    assert bars[9]["direction_degrees"] == 95
    normal, shear = 1e6 * (1 + A_N * np.cos(np.radians(10))), 1e6 * A_T * np.sin(np.radians(10))  # at 95 degrees
    for selection, stage, name, force, at_95 in (
            (one, "end", "normal_force_directions", "mean_normal_force_N", normal),
            (grid, "1 MPa", "normal_force_directions_by_pressure", "mean_normal_force_N", normal),
            (one, "end", "shear_force_directions", "mean_shear_force_N", shear),
            (grid, "4 MPa", "shear_force_directions_by_pressure", "mean_shear_force_N", shear)):
        found = rows_of(selection, name, column=stage)[9]
        assert found[f"{force}_fit"] == pytest.approx(at_95, rel=0.03)
        assert found[force] == pytest.approx(at_95, rel=0.05, abs=2e4)
    assert rows_of(one, "shear_force_directions", column="end")[8]["mean_shear_force_N"] < 0  # at 85 degrees


def test_the_density_of_forces_has_their_number_and_mean(one):
    for strain in ("0", "0.1"):
        bars = rows_of(one, "force_pdf", axial_strain=strain)
        width = bars[1]["normal_force_MN"] - bars[0]["normal_force_MN"]
        assert sum(row["density_per_MN"] for row in bars) * width == pytest.approx(1, abs=1.5 / CONTACTS)
        mean = sum(row["density_per_MN"] * row["normal_force_MN"] for row in bars) * width
        assert mean == pytest.approx(1 + (A * A_N / 2 if strain == "0.1" else 0), abs=width)


def test_pictures_hold_displacements_classes_and_stresses_of_every_particle(one):
    path = one.runs[0].directory.frame_file(10)
    with h5py.File(path) as file:
        moved = np.hypot(*file["particles/displacement"][:].T)
        ids, place, area = (file[f"particles/{name}"][:] for name in ("id", "position", "area"))
        ends, point, force = (file[f"contacts/{name}"][:] for name in ("a", "point", "force"))
        others, pressed = file["contacts/b"][:], file["contacts/normal_force"][:]
    shown = rows_of(one, "displacements", frame="10")
    assert [row["displacement_m"] for row in shown] == pytest.approx(moved, rel=1e-5)
    assert sum(row["generation"] == 1 for row in shown) == 2 * BROKEN[4e6]
    chains = rows_of(one, "force_chains", frame="10")
    assert [row["force_class"] for row in chains] == [int(f >= 1e6) for f in pressed]
    for name, axis in (("vertical_stresses", 1), ("horizontal_stresses", 0)):
        expected = np.zeros(len(ids))  # - 1/A sum f l over the contacts, one by one
        for a, b, at, f in zip(ends, others, point, force):
            for particle, sign in ((a, -1), (b, 1)):
                k = list(ids).index(particle)
                expected[k] -= sign * f[axis] * (at - place[k])[axis] / area[k]
        shown = rows_of(one, name, frame="10")
        assert [row["stress_Pa"] for row in shown] == pytest.approx(expected, rel=1e-5, abs=1)
        assert [row["stress_class"] for row in shown] == [(s >= 4e6) + (s > 12e6) for s in expected]


def test_breakage_is_counted_by_particles_and_by_mass(grid, one):
    area = 6 * 0.5 * 0.22 ** 2 * np.sin(np.pi / 3)  # every hexagon breaks into halves
    for row in rows_of(grid, "breakage_by_pressure", measure="broken"):
        assert row["value"] == pytest.approx(BROKEN[row["pressure_Pa"]] / 48, rel=1e-5)
    for row in rows_of(grid, "breakage_by_pressure", measure="fragments"):
        assert row["value"] == pytest.approx(BROKEN[row["pressure_Pa"]] / 48, rel=1e-5)
    # Halves, of 0.71 times the size, pass two sieves more; Hardin's limit is a third of the size before: none is told.
    for name, value in (("marsal", 6 / 48), ("hardin", 6 / 48 * np.log(2) / 2 / np.log(3)), ("fragments", 6 / 48)):
        assert rows_of(one, "breakage_against_strain", measure=name)[-1]["value"] == pytest.approx(value, rel=1e-5)
    generations = rows_of(one, "fragments_by_generation")
    assert [(row["particles"], row["share_of_mass"]) for row in generations] == pytest.approx(
        [(42, 42 / 48), (12, 6 / 48)], rel=1e-5)
    last = rows_of(grid, "gradations", curve="4 MPa, breakable")
    assert [row["size_m"] for row in last] == pytest.approx(
        [np.sqrt(2 * area / np.pi)] * 12 + [np.sqrt(4 * area / np.pi)] * 42, rel=1e-5)
    assert last[11]["finer_by_mass"] == pytest.approx(6 / 48, rel=1e-5) and last[-1]["finer_by_mass"] == 1
    assert sum(row["share_of_breakages"] for row in rows_of(one, "crack_rose")) == pytest.approx(1)


def test_the_rose_of_breakage_lines_tells_modes_apart_and_sums_to_one(tmp_path):
    run = synthetic.write_run(tmp_path / "run", frames=3, breaks=lambda k: 6 if k == 0 else 0)
    with synthetic.edited(run / "splits" / "000000.h5") as split:
        parents = split["broken/parent"][:]
        split["particles/failure_mode"][:] = [1 + (k in parents[:2]) for k in split["particles/id"]]  # 2: shear
        path = split["broken/path"][:]
    rows = rows_of(selection_of(run), "crack_rose")
    for mode, share in (("tension", 4 / 6), ("shear", 2 / 6)):
        assert sum(row["share_of_breakages"] for row in rows if row["mode"] == mode) == pytest.approx(share, rel=1e-5)
    angle = np.degrees(np.arctan2(*(path[:, 1] - path[:, 0]).T[::-1])) % 180
    for row in rows:
        of_mode = angle[:2] if row["mode"] == "shear" else angle[2:]
        expected = np.sum(np.abs(of_mode - row["direction_degrees"]) < 5) / 6
        assert row["share_of_breakages"] == pytest.approx(expected, rel=1e-5)


def test_curves_of_several_seeds_are_their_mean(tmp_path):
    runs = [synthetic.write_run(tmp_path / f"{pressure:g} {seed}", frames=3, pressure=pressure, contacts=contacts)
            for pressure, seed, contacts in ((1e6, 1, 90), (1e6, 2, 96), (4e6, 1, 90))]
    case = (runs[1] / "case.yaml").read_text()
    (runs[1] / "case.yaml").write_text(case.replace("seed: 1", "seed: 2"))
    means = rows_of(selection_of(*runs), "contacts", condition="1 MPa")
    assert len(means) > 1 and all(row["contacts"] == 93 for row in means)
    assert all(row["contacts_deviation"] == pytest.approx(np.std([90, 96], ddof=1), rel=1e-4) for row in means)


def test_shares_of_the_energy_are_those_that_were_written(grid):
    shares = {row["kind"]: row["share"] for row in rows_of(grid, "energy_shares", condition="1 MPa, solid")}
    assert shares == pytest.approx({"friction": 0.6, "elastic, change": 0.2, "damping": 0.1, "contact law": 0.05,
                                    "released by breakage": 0.04})


def keep_frames(run, count):
    for kind, kept in (("frames", count), ("splits", count - 1)):
        for file in (run / kind).glob("*.h5"):
            if int(file.stem) >= kept:
                file.unlink()


def without_contacts(run):
    for path in (run / "frames").glob("*.h5"):
        with synthetic.edited(path) as file:
            for name, values in {name: data[:0] for name, data in file["contacts"].items()}.items():
                del file["contacts"][name]
                file["contacts"][name] = values


@pytest.mark.parametrize("options, spoil, missing", [
    ({}, lambda run: keep_frames(run, 1), {"deviator", "energy", "void_ratio"}),        # interrupted at once
    ({"breakable": False}, lambda run: keep_frames(run, 1), {"gradations"}),
    ({"strain": 0.173}, lambda run: keep_frames(run, 4), set()),                        # later
    ({"breaks": lambda k: 0}, lambda run: None, {"crack_rose"}),
    ({}, without_contacts, {"contact_orientation", "anisotropies", "force_pdf"}),
    ({"contacts": 2}, lambda run: None, {"contact_orientation"}),
    ({"size": (2, 1), "breakable": False, "contacts": 1}, lambda run: None, {"contact_orientation"}),
], ids=["one frame", "one frame, unbreakable", "interrupted", "nothing breaks", "no contacts", "two contacts",
        "two particles"])
def test_a_run_that_lacks_something_gets_the_other_figures_without_a_complaint(tmp_path, options, spoil, missing):
    run = synthetic.write_run(tmp_path / "run", frames=5, **options)
    spoil(run)
    selection = selection_of(run)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        drawn = {entry.name for entry in CATALOGUE if entry.needs != PRESSURES and entry.drawn(selection) is not None}
    assert drawn and not drawn & missing and drawn >= {"displacements", "phases"}


def test_a_run_with_one_frame_has_a_page(tmp_path):
    run = synthetic.write_run(tmp_path / "run", frames=5)
    keep_frames(run, 1)
    write_report([Results(RunDirectory(run))], tmp_path / "page.html")
    assert 'id="displacements"' in (tmp_path / "page.html").read_text()
