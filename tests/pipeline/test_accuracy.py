"""Accuracy studies: how ladders become runs, their errors and scatter against numbers worked out by hand, and the page
of a study whose children only pretend."""
import csv
import subprocess
from types import SimpleNamespace

import pytest
import yaml

from conftest import REPOSITORY
from rockbreak.campaign import biaxial_test
from rockbreak.accuracy.measures import number_measure
from rockbreak.accuracy.numbers import beyond, cheapest_good, floors_of, ladder_of
from rockbreak.accuracy.study import Knob, read_study
from rockbreak.errors import RockbreakError
from rockbreak.campaign.plan import make_plan
from synthetic import CASE
from test_campaign import Workplace

STUDY = {"base": "scene.yaml", "seeds": [1, 2], "shared_sample": ["fake.peak"], "knobs": {
    "peak": {"key": "fake.peak", "rungs": [0.45, 0.5, 0.6]},
    "solid": {"rungs": {"breakable": {"effects": CASE["effects"]}, "solid": {"effects": CASE["effects"][:-1]}}}}}


@pytest.fixture
def work(tmp_path, monkeypatch):
    return Workplace(tmp_path, monkeypatch)


def study_file(work, **content):
    path = work.path / "table.yaml"
    path.write_text(yaml.safe_dump({**STUDY, **content}, sort_keys=False))
    return path


# -- the file

def test_ladders_share_the_runs_and_samples_of_the_base(work):
    study = read_study(study_file(work)).subjects[0]
    plan = make_plan(study.campaign, work.out)
    assert len(plan.runs) == 2 * (1 + 2 + 1), "0.5 and breakable are what the base has"
    assert len(plan.samples()) == 2
    knob = study.knobs[0]
    assert knob.rungs == ["0.45", "0.5", "0.6"]
    for seed in ("1", "2"):
        assert plan.row_runs[knob.variations["0.5", seed]] is plan.row_runs[study.base[seed]]


@pytest.mark.parametrize("content, said", [
    ({"seeds": []}, "seeds: found a list, expected a list of values"),
    ({"seed": 1}, 'seed: unknown key; did you mean "seeds"?'),
    ({"knobs": {}}, "knobs: found none, expected at least one knob"),
    ({"knobs": {"a": {"rungs": [1, 2]}}}, "knobs.a.key: found nothing, expected a text"),
    ({"knobs": {"a": {"key": "x.y", "rungs": [1]}}}, "knobs.a.rungs: found 1, expected at least the reference"),
    ({"knobs": {"a": {"key": "x.y", "rungs": 3}}}, 'knobs.a.rungs: found "3", expected a list of values'),
    ({"knobs": {"a": {"key": "seed", "rungs": [1, 2]}}}, "knobs.a.rungs: found seed, expected it under seeds"),
    ({"knobs": {"a": {"rung": [1, 2]}}}, 'knobs.a.rung: unknown key; did you mean "rungs"?'),
    ({"set": {"seed": 3}}, "set: found seed, expected it under seeds"),
    ({"measures": {"a": "x y"}}, 'measures.a: found "x y", expected a number of summary.json'),
    ({"tolerances": {"a": 1}}, "tolerances.a: found no such measure, expected one of peak sin φ"),
    ({"specimens": {"a": {}}}, "specimens: found beside seeds, expected one of them"),
    ({"subjects": {}}, 'base: unknown key'),
])
def test_bad_input_names_file_key_found_and_expected(work, content, said):
    with pytest.raises(RockbreakError) as caught:
        read_study(study_file(work, **content))
    assert caught.value.code == 2 and said in str(caught.value)
    assert str(caught.value).startswith(str(work.path / "table.yaml"))


def test_the_study_of_dem_is_valid_and_the_base_is_a_rung_of_every_knob(tmp_path):
    study = read_study(REPOSITORY / "configs" / "accuracy_dem.yaml").subjects[0]
    plan = make_plan(study.campaign, tmp_path / "out")
    base = plan.row_runs[study.base["1"]]
    for knob in study.knobs:
        assert base in [plan.row_runs[knob.variations[label, "1"]] for label in knob.rungs], knob.name
    assert len(plan.samples()) == 3 * (1 + 4 + 3 + 3), "stiffness, law and size prepare their own"


# -- the numbers

def ladder(values, cpu=(4.0, 2.0, 1.0), rounding_only=False, base=1, tolerances=None):
    """A ladder of one measure: `values` per rung, a number per seed (None: that run failed)."""
    seeds = [str(number) for number in range(len(values[0]))]
    labels = [f"r{number}" for number in range(len(values))]
    runs = {(label, seed): SimpleNamespace(
        summary=None if value is None else {"m": value, "n": 2.0, "cpu_seconds": seconds, "contact_steps": 7},
        failure="flew off" if value is None else None, sample=None)
        for label, row, seconds in zip(labels, values, cpu) for seed, value in zip(seeds, row)}
    subject = SimpleNamespace(name="", specimens=seeds, tolerances=tolerances or {},
                              measures=[number_measure("m", "m"), number_measure("m / n", "m", "n")],
                              base={seed: (labels[base], seed) for seed in seeds})
    knob = Knob("knob", labels, {key: key for key in runs}, {(label, seed): (labels[0], seed) for label, seed in runs},
                rounding_only)
    return ladder_of(knob, subject, biaxial_test, SimpleNamespace(row_runs=runs), {})


def test_errors_are_paired_and_the_scatter_is_that_of_the_seeds():
    found = ladder([[1.0, 3.0], [1.1, 3.1], [1.3, 2.6]])
    assert [rung.cells["m"].error for rung in found.rungs] == pytest.approx([0.0, 0.1, (0.5 * (0.09 + 0.16)) ** 0.5])
    assert [rung.cells["m"].difference for rung in found.rungs] == pytest.approx([0.0, 0.1, -0.05])
    assert found.scatter["m"] == pytest.approx(((2.0 + 2.0 + 0.845) / 3) ** 0.5)
    assert found.rungs[1].cells["m / n"].error == pytest.approx(0.05)
    assert [(rung.is_reference, rung.is_base) for rung in found.rungs] == [(True, False), (False, True), (False, False)]
    assert [rung.cost for rung in found.rungs] == [4.0, 2.0, 1.0]


def test_the_cheapest_good_rung_stays_within_the_scatter():
    scattered = ladder([[1.0, 1.2], [1.05, 1.25], [1.5, 1.7]])
    assert cheapest_good(scattered, {}).label == "r1"
    assert beyond(scattered.rungs[2], scattered, {}) == ["m", "m / n"]
    assert cheapest_good(scattered, {"m": 0.6, "m / n": 0.3}).label == "r2", "rounding alone does as much"


def test_a_rung_that_costs_as_much_as_the_base_is_not_preferred():
    values = [[1.0, 1.2], [1.0, 1.2], [1.0, 1.2]]
    assert cheapest_good(ladder(values, cpu=(4.0, 2.0, 1.5)), {}).label == "r1"
    assert cheapest_good(ladder(values, cpu=(4.0, 2.0, 1.3)), {}).label == "r2"


def test_a_tolerance_decides_in_place_of_the_scatter():
    found = ladder([[1.0, 1.2], [1.05, 1.25], [1.08, 1.28]], tolerances={"m": 0.06, "m / n": 0.06})
    assert beyond(found.rungs[2], found, {}) == ["m"], "the scatter is 0.14"
    assert cheapest_good(found, {"m": 1.0}).label == "r1"


def test_a_rung_that_failed_is_no_candidate_and_pairs_only_what_there_is():
    found = ladder([[1.0, 1.2], [1.0, 1.2], [1.1, None]])
    assert cheapest_good(found, {}).label == "r1"
    assert found.rungs[2].cells["m"].pairs == 1 and found.rungs[2].cells["m"].error == pytest.approx(0.1)
    assert found.rungs[2].failures == ["flew off"]


def test_the_growth_of_rounding_comes_from_the_ladders_that_change_nothing_else():
    ladders = [ladder([[1.0, 2.0], [1.0, 2.2], [1.3, 2.0]], rounding_only=True), ladder([[1.0], [9.0]])]
    assert floors_of(ladders)["m"] == pytest.approx((0.5 * 0.09) ** 0.5)


# -- the whole

def test_a_study_ends_in_a_table_a_page_and_a_figure_per_knob(work):
    command = [REPOSITORY / "pipeline" / "accuracy", study_file(work), "--out", work.out, "-j", "2"]
    process = subprocess.run(command, capture_output=True, text=True, check=False)
    assert process.returncode == 0, process.stderr
    assert process.stdout == f"{work.out / 'accuracy.md'}\n"
    with open(work.out / "accuracy.csv", encoding="utf-8") as file:
        rows = {(row["knob"], row["rung"], row["measure"]): row for row in csv.DictReader(file)}
    row = rows["peak", "0.6", "peak sin φ"]
    assert float(row["error_rms"]) == pytest.approx(0.15, abs=1e-9) and row["pairs"] == "2"
    assert float(row["mean"]) == pytest.approx(0.6, abs=1e-9) and float(row["cpu_seconds"]) > 0
    assert [rows["peak", label, "peak sin φ"][mark] for label in ("0.45", "0.5") for mark in ("reference", "base")] == [
        "1", "0", "0", "1"]
    page = (work.out / "accuracy.md").read_text()
    assert "| **0.5** (base)" in page and "| 0.45 (reference)" in page
    assert "the base, 0.5 (" in page and "is not within the scatter in peak sin φ" in page
    for name in ("peak", "solid"):
        assert f"figures/accuracy_{name}.svg" in page
        assert (work.out / "figures" / f"accuracy_{name}.svg").read_text().lstrip().startswith("<?xml")
        assert f'aria-label="{name}: error against time"' in (work.out / "accuracy.html").read_text()
        assert (work.out / "figures" / f"accuracy_{name}.png").read_bytes().startswith(b"\x89PNG")
    assert (work.out / "campaign.csv").exists()

    work.calls()
    assert subprocess.run(command, capture_output=True, check=False).returncode == 0 and work.calls() == []
