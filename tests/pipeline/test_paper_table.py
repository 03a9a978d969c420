"""Many runs beside the paper: scatter over seeds, verdicts, sentences, limits of the classes, and the files written."""
import csv

import numpy as np
import pytest
import yaml

import synthetic
from rockbreak.paper import causes, numbers as paper
from rockbreak.paper.class_limits import best_limits, misfit
from rockbreak.measures.classes import three_classes
from rockbreak.paper.table import TableRow, counts_once, write
from rockbreak.paper.verdicts import NOT_REPRODUCED, REPRODUCED, UNDECIDABLE, WITHIN_SCATTER, verdict

STARTS = {"paper": 0.30, "void_ratio_e1": 0.21, "void_ratio_e4": 0.302}


@pytest.mark.parametrize("quantity, published, mean, deviation, expected", [
    ("contacts", 2000, 2100, None, REPRODUCED),         # 5 %
    ("contacts", 2000, 2101, None, NOT_REPRODUCED),
    ("contacts", 2000, 2101, 50.6, WITHIN_SCATTER),     # 2 s.d.
    ("contacts", 2000, 2101, 50.4, NOT_REPRODUCED),
    ("weak_forces", 1000, 900, None, REPRODUCED),       # 10 %
    ("weak_forces", 1000, 899, 10.0, NOT_REPRODUCED),
    ("strong_forces", 56, 66, 1.0, REPRODUCED),         # 0.5 % of 2015
    ("strong_forces", 56, 67, 0.0, NOT_REPRODUCED),
    ("high_vertical_stresses_held", 19, 25, None, NOT_REPRODUCED),  # 0.5 % of 1194 is 5.97
    ("strong_forces", 9, 15, None, REPRODUCED),         # 2 sqrt(9), so that none at all are too few
    ("strong_forces", 9, 0, 1.0, NOT_REPRODUCED),
    ("strong_forces", 0, 2, 0.0, REPRODUCED),
    ("strong_forces", 0, 3, 0.0, NOT_REPRODUCED),
    ("particles", 1234, 1194, 0.0, NOT_REPRODUCED),     # 3 % of all particles, but none of the 40 new ones
    ("particles", 1234, 1228.1, None, REPRODUCED),      # 0.5 % of 1194 is more than 10 % of 40
    ("particles", 1411, 1389.4, None, REPRODUCED),      # 10 % of 217
    ("particles", 1411, 1389.2, 2.0, NOT_REPRODUCED),
    ("peak_strain", 0.10, 0.109, 0.0, REPRODUCED),
    ("void_ratio_rise_e1", 0.036, 0.0411, None, NOT_REPRODUCED),
    ("sin_phi_misfit", 0.0, -0.019, None, REPRODUCED),
    ("sin_phi_misfit", 0.0, 0.021, None, NOT_REPRODUCED),
    ("sin_phi", None, 0.5, 0.01, UNDECIDABLE),
    ("contacts", 2000, None, None, UNDECIDABLE),
])
def test_a_row_is_reproduced_within_the_stated_tolerance_and_within_the_scatter_up_to_two_deviations(
        quantity, published, mean, deviation, expected):
    assert verdict(quantity, "peak", published, mean, deviation, STARTS)[0] == expected


def test_a_number_that_is_not_reproduced_says_its_cause(written):
    found = row(written[2], "non-breakable", "contacts", "0 %")
    assert found["reason"].endswith(causes.CAUSES["contacts", "0 %"])
    assert causes.cause_of("void_ratio_e1", "end") == ""


def test_a_void_ratio_is_judged_only_in_a_definition_in_which_our_sample_starts_at_the_papers():
    assert verdict("void_ratio_e4", "start", 0.30, 0.302, None, STARTS)[0] == UNDECIDABLE
    assert verdict("void_ratio_e4", "end", 0.336, 0.340, None, STARTS)[0] == REPRODUCED
    found, reason = verdict("void_ratio_e1", "end", 0.336, 0.336, None, STARTS)
    assert found == UNDECIDABLE and "0.210" in reason
    assert verdict("void_ratio_e2", "end", 0.336, 0.336, None, STARTS)[0] == UNDECIDABLE


def test_what_cannot_fail_is_not_called_reproduced():
    assert verdict("large_displacements", "0 %", 0, 0, 0.0, STARTS)[0] == UNDECIDABLE
    assert verdict("large_displacements", "7 %", 0, 0, 0.0, STARTS)[0] == REPRODUCED
    assert verdict("particles", "0 %", 1194, 1194, 0.0, STARTS)[0] == UNDECIDABLE


def test_the_tally_counts_each_number_of_the_paper_once():
    def row(table, quantity, column):
        return TableRow(table, quantity, column, 1.0, [])
    assert counts_once(row("Table 2", "weak_forces", "10 %"), 2e6)
    assert not counts_once(row("Table 3", "weak_forces", "peak"), 2e6)  # Table 2 has it
    assert counts_once(row("Table 3", "weak_forces", "peak"), 1e6)
    assert not counts_once(row("Table 3", "weak_forces", "10 %"), 1e6)
    assert not counts_once(row("Table 3", "low_vertical_stresses_held", "peak"), 1e6)
    kinds = [kind for kind in ("e1", "e2", "e4") if counts_once(row("Table 4", f"void_ratio_{kind}", "end"), 1e6)]
    assert kinds == ["e4"]


def test_limits_that_made_the_counts_are_found_again():
    rng = np.random.default_rng(2)
    samples = [(np.sort(rng.exponential(scale, 1000)), None) for scale in (1.0, 2.0, 3.0)]
    samples = [(values, three_classes(values, 1.3, 5.2)) for values, _ in samples]
    candidates = np.arange(5, 80) / 10
    assert best_limits(samples, candidates, candidates) == pytest.approx((0.0, 1.3, 5.2))
    assert misfit(samples, 1.3, 5.2) == 0.0
    assert best_limits(samples, np.array([1.5]), np.array([4.0]))[0] == pytest.approx(misfit(samples, 1.5, 4.0))


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Four seeds of which the contacts are 96, 96, 96 and 100; a breakable twin; and an assembly of another size."""
    folder = tmp_path_factory.mktemp("table")
    plan = {"s1": (1, 96), "s2": (2, 96), "s3 <b>": (3, 96), "s4": (4, 100), "broken": (1, 96), "small": (1, 96)}
    for name, (seed, contacts) in plan.items():
        run = synthetic.write_run(folder / name, frames=5, strain=0.173, breakable=name == "broken",
                                  contacts=contacts)
        case = yaml.safe_load((run / "case.yaml").read_text()) | {"seed": seed}
        case["assembly"]["particles"] = 300 if name == "small" else paper.PARTICLES
        (run / "case.yaml").write_text(yaml.safe_dump(case))
    page = write([folder / name for name in plan], folder / "out")
    return folder, page, list(csv.DictReader((folder / "out" / "paper_table.csv").open()))


def row(rows, assembly, name, column):
    found = [one for one in rows if (one["assembly"], one["row"], one["column"]) == (assembly, name, column)]
    assert len(found) == 1
    return found[0]


def test_mean_and_standard_deviation_are_over_the_seeds(written):
    found = row(written[2], "non-breakable", "contacts", "10 %")
    assert (float(found["mean"]), float(found["standard_deviation"]), found["n"]) == (97.0, 2.0, "4")
    assert float(found["difference"]) == 97 - 1947 and found["verdict"] == "not reproduced"
    assert row(written[2], "breakable", "contacts", "10 %")["standard_deviation"] == ""


def test_the_page_names_what_it_left_out_and_escapes_names(written):
    folder, page, _ = written
    assert page == folder / "out" / "paper_table.html"
    text = page.read_text()
    assert "another assembly or pressure: small" in text and "2 MPa, non-breakable" in text and "1, 2, 3, 4" in text
    markdown = (folder / "out" / "paper_table.md").read_text()
    assert "| contacts, all three classes | 10 % | Table 2 | 1947 | 97 ± 2.0 (4) | -1850 | not repr" in markdown
    assert "<span" not in markdown and "http" not in text
    said = next(one for one in written[2] if one["row"] == "breakage makes new contacts")
    assert said["verdict"] == NOT_REPRODUCED and "no difference" in said["reason"] and said["paper"].startswith("1947")
    assert "| 4.2, Fig. 9 | breakage makes new contacts |" in markdown and said["ours"] in text


def test_runs_that_differ_by_more_than_their_seed_are_not_averaged(written, tmp_path):
    folder, _, _ = written
    run = synthetic.write_run(tmp_path / "stiff", frames=5, strain=0.173, breakable=False)
    case = yaml.safe_load((folder / "s1" / "case.yaml").read_text()) | {"contact": {"law": "potential"}}
    (run / "case.yaml").write_text(yaml.safe_dump(case))
    text = write([folder / "s1", folder / "s2", run], tmp_path / "out").read_text()
    assert "2 MPa, non-breakable; contact.law = potential" in text


def test_a_run_that_did_not_hold_its_lateral_stress_is_named_and_left_out(written, tmp_path):
    folder, _, _ = written
    run = synthetic.write_run(tmp_path / "loose", frames=5, strain=0.173, breakable=False)
    (run / "case.yaml").write_text((folder / "s1" / "case.yaml").read_text())
    for file in (run / "frames").glob("*.h5"):
        with synthetic.edited(file) as frame:
            frame["history/stress_xx"][:] = 2.2e6
    text = write([folder / "s1", run], tmp_path / "out").read_text()
    assert "loose is left out: its lateral stress was off by 10 %" in text
    assert {one["n"] for one in csv.DictReader((tmp_path / "out" / "paper_table.csv").open())} == {"1", ""}


def test_without_a_run_of_the_papers_assembly_nothing_is_written(written, tmp_path):
    assert write([written[0] / "small"], tmp_path / "out") is None
    assert not (tmp_path / "out").exists()
