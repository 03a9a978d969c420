"""Campaigns: how a table becomes runs (no process), what is run, kept, resumed and reported (children that only
pretend), and that a shared sample changes no result (the real executables, a tiny scene)."""
import csv
import fcntl
import json
import os
import signal
import subprocess
import time
from types import SimpleNamespace

import pytest
import yaml

import fake_children
from conftest import REPOSITORY
from patience import patience
from rockbreak.campaign import biaxial_test as kind
from rockbreak.campaign.table import read_campaign
from rockbreak.campaign.report import paper_findings, versions_text
from rockbreak.campaign.tables import conditions_of, numbers_of, scatter
from rockbreak.errors import RockbreakError
from rockbreak.campaign.plan import make_plan
from rockbreak.run.run_directory import RunDirectory, attributes, is_valid
from synthetic import CASE, edited, write_run

TWINS = {"breakable": {"effects": CASE["effects"]}, "solid": {"effects": CASE["effects"][:-1]}}


class Workplace:
    """A folder with fake executables, a base scene and a campaign."""

    def __init__(self, path, monkeypatch):
        self.path = path
        self.out = path / "out"
        self.log_file = path / "calls.log"
        fake_children.install(path / "bin")
        monkeypatch.setenv("ROCKBREAK_BIN", str(path / "bin"))
        monkeypatch.setenv("FAKE_LOG", str(self.log_file))
        self.scene(fake={})

    def scene(self, fake):
        case = {**CASE, "shear": {**CASE["shear"], "frames": 3}, "material": {"density": 2500, "m_i": 25},
                "fake": {"slow": 0, "dem_dies_at": -1, "peak": 0.5, **fake}}
        (self.path / "scene.yaml").write_text(yaml.safe_dump(case))

    def table(self, **content):
        file = self.path / "table.yaml"
        file.write_text(yaml.safe_dump({"base": "scene.yaml", "report": False, **content}, sort_keys=False))
        return file

    def plan(self, **content):
        return make_plan(read_campaign(self.table(**content)), self.out)

    def start(self, *arguments, **content):
        return subprocess.Popen([REPOSITORY / "pipeline" / "campaign", self.table(**content), "--out", self.out,
                                 *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def run(self, *arguments, **content):
        process = self.start(*arguments, **content)
        process.out, process.err = process.communicate(timeout=patience(120))
        return process

    def calls(self):
        if not self.log_file.exists():
            return []
        lines = [line for line in self.log_file.read_text().splitlines() if line.startswith("dem -")]
        self.log_file.unlink()
        return lines

    def rows(self):
        with open(self.out / "campaign.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))


@pytest.fixture
def work(tmp_path, monkeypatch):
    return Workplace(tmp_path, monkeypatch)


# -- the table

def test_axes_span_the_table_and_explicit_runs_are_added(work):
    table = read_campaign(work.table(axes={"preparation.confining_pressure": ["0.5e6", "2e6"], "variant": TWINS,
                                           "seed": [1, 2, 3]},
                                     runs=[{"name": "far", "shear": {"axial_strain": 0.2}, "seed": 4}]))
    names = [variation.name for variation in table.variations]
    assert len(names) == len(set(names)) == 13
    assert names[0] == "confining_pressure-0.5e6_breakable_seed-1" and names[-1] == "far"
    assert dict(table.variations[4].keys) == {"preparation.confining_pressure": "0.5e6", "seed": "2",
                                              "effects": "[friction, local_damping, energy_ledger]"}
    assert dict(table.variations[-1].keys) == {"shear.axial_strain": "0.2", "seed": "4"}


def test_a_table_without_axes_is_its_base(work):
    (variation,) = read_campaign(work.table()).variations
    assert variation.name == "base" and variation.keys == ()


@pytest.mark.parametrize("content, said", [
    ({"axis": {}}, 'axis: unknown key; did you mean "axes"?'),
    ({"base": "scen.yaml"}, "base: found scen.yaml, expected a scene (YAML)"),
    ({"axes": {"seed": 3}}, 'axes.seed: found "3", expected a list of values'),
    ({"axes": {"seed": []}}, "axes.seed: found a list, expected a list of values, or"),
    ({"axes": {"seed": [1, 1]}}, "axes.seed: found 1, 1, expected each value once"),
    ({"axes": {"variant": {"a": "x"}}}, 'axes.variant.a: found "x", expected the keys of this variant'),
    ({"axes": {"seed": [1], "v": {"a": {"seed": 2}}}}, "axes.seed: found in two axes"),
    ({"runs": [3]}, 'runs[1]: found "3", expected the keys of a run'),
    ({"compare": "papr"}, 'compare: found "papr", expected none or paper'),
    ({"report": "yes"}, 'report: found "yes", expected true or false'),
    ({"set": {"shear.frames": 1, "shear": {"frames": 2}}}, "set.shear.frames: found twice"),
    ({"shared_sample": ["time_step.safty"]}, 'shared_sample: found "time_step.safty", expected a key of the scene'),
    ({"axes": {"seed": [1], "shear.fraems": [1]}}, 'run seed-1_fraems-1: --set shear.fraems=1: unknown key "fraems"'),
])
def test_bad_input_names_file_key_found_and_expected(work, content, said):
    with pytest.raises(RockbreakError) as caught:
        work.plan(**content)
    assert caught.value.code == 2 and str(caught.value).startswith(str(work.path / "table.yaml"))
    assert said in str(caught.value)


def test_a_duplicate_key_of_the_file_is_refused(work):
    file = work.path / "twice.yaml"
    file.write_text("base: scene.yaml\naxes:\n  seed: [1]\n  seed: [2]\n")
    with pytest.raises(RockbreakError, match=r'twice.yaml:4:3: duplicate key "seed", first given in line 3'):
        read_campaign(file)


def test_set_reaches_all_runs_but_not_a_key_that_varies(work):
    table = read_campaign(work.table(set={"seed": 7}), ["shear.axial_strain=0.2"])
    assert table.common == {"seed": "7", "shear.axial_strain": "0.2"}
    with pytest.raises(RockbreakError, match="found a key that the table varies"):
        read_campaign(work.table(axes={"seed": [1]}), ["seed=2"])


# -- identity and samples

def hashes(plan):
    return [run.hash for run in plan.runs]


def test_the_hash_covers_the_meaning_of_the_keys_alone(work):
    one = work.plan(axes={"seed": [1, 2]})
    assert len(set(hashes(one))) == 2
    assert hashes(work.plan(axes={"any": {"x": {"seed": 1}, "y": {"seed": 2}}})) == hashes(one), "names do not count"
    assert hashes(work.plan(set={"preparation.void_ratio": "0.30"}, axes={"seed": [1, 2]})) == hashes(one), "as before"
    assert hashes(work.plan(set={"output.keep_frames": 3}, axes={"seed": [1, 2]})) == hashes(one), "only where it goes"
    assert set(hashes(work.plan(set={"shear.axial_strain": 0.2}, axes={"seed": [1, 2]}))).isdisjoint(hashes(one))


def test_what_only_breakage_sees_makes_no_other_run_of_one_without(work):
    axes = {"variant": TWINS}
    breakable, solid = hashes(work.plan(axes=axes))
    for key in ({"material.m_i": 20}, {"breakage.interval": 0.01}):
        other = hashes(work.plan(axes=axes, set=key))
        assert other[1] == solid and other[0] != breakable
    assert hashes(work.plan(axes=axes, set={"material.density": 2000}))[1] != solid


def test_rows_that_mean_the_same_are_one_run(work):
    plan = work.plan(axes={"seed": [1, 2]}, runs=[{"name": "again", "seed": 2}])
    assert len(plan.runs) == 2
    assert [variation.name for variation in plan.runs[1].variations] == ["seed-2", "again"]


def test_runs_share_the_sample_that_their_preparation_sees(work):
    plan = work.plan(axes={"seed": [1, 2], "variant": TWINS, "shear.strain_rate": [0.02, 0.01],
                           "material.m_i": [25, 20]})
    assert len(plan.runs) == 12 and len(plan.samples()) == 2, "the rock is nothing to runs without breakage"
    assert {run.sample.out.name.rpartition("_")[0] for run in plan.runs} == {"seed-1", "seed-2"}
    denser = work.plan(axes={"seed": [1], "preparation.void_ratio": [0.3, 0.25], "material.density": [2500, 2000]})
    assert len(denser.samples()) == 4


def test_a_declared_key_is_sheared_from_the_sample_of_the_base(work):
    axes = {"preparation.void_ratio": [0.3, 0.25]}
    own, shared = work.plan(axes=axes), work.plan(axes=axes, shared_sample=["preparation.void_ratio"])
    assert (len(own.samples()), len(shared.samples())) == (2, 1)
    assert shared.runs[0].hash == own.runs[0].hash, "the base is what it was"
    assert shared.runs[1].hash != own.runs[1].hash, "the other started from another sample"
    assert not any("void_ratio" in word for word in shared.samples()[0].command)


# -- what is run

def test_a_campaign_runs_once_and_then_only_what_is_new(work):
    axes = {"seed": [1, 2], "variant": TWINS}
    first = work.run("-j", "2", axes=axes)
    assert first.returncode == 0, first.err
    assert first.out == f"{work.out / 'campaign.html'}\n"
    calls = work.calls()
    assert calls.count("dem --resume --until-frame --threads 0") == 2, "the processors are shared"
    assert calls.count("dem --resume --threads --serve") == 4
    rows = work.rows()
    assert [(row["seed"], row["variant"], row["state"]) for row in rows] == [
        ("1", "breakable", "done"), ("1", "solid", "done"), ("2", "breakable", "done"), ("2", "solid", "done")]
    summary = json.loads((work.out / rows[0]["directory"] / "summary.json").read_text())
    assert float(rows[0]["peak_sin_phi"]) == summary["peak_sin_phi"]
    assert {name for name in numbers_of(summary)} <= set(rows[0])
    assert float(rows[0]["cpu_seconds"]) > 0 and float(rows[0]["sample_cpu_seconds"]) > 0
    assert {row["name"] for row in rows} == {folder.name for folder in (work.out / "runs").iterdir()}

    assert work.run(axes=axes).returncode == 0 and work.calls() == []
    assert work.rows() == rows
    assert work.run(axes={"seed": [1, 2, 3], "variant": TWINS}).returncode == 0
    assert work.calls() == ["dem --resume --until-frame 0", "dem --resume --serve", "dem --resume --serve"]
    assert len(work.rows()) == 6


def test_a_directory_of_something_else_is_refused(work):
    work.out.mkdir()
    (work.out / "notes.txt").write_text("mine")
    process = work.run(axes={"seed": [1]})
    assert process.returncode == 2
    assert "directory of something else (no campaign.jsonl or plan.json in it)" in process.err
    assert [entry.name for entry in work.out.iterdir()] == ["notes.txt"]
    process = work.run("--snakemake", axes={"seed": [1]})
    assert process.returncode == 2 and [entry.name for entry in work.out.iterdir()] == ["notes.txt"]


def test_one_that_fails_stops_no_other_and_is_tried_again(work):
    runs = [{"seed": 1}, {"seed": 2, "fake.dem_dies_at": 1}, {"seed": 3}]
    process = work.run(runs=runs)
    assert process.returncode == 3
    assert "1 of 3 runs failed" in process.err and "dem: error: particle 7, frame 3: flew off" in process.err
    assert [row["state"] for row in work.rows()] == ["done", "failed", "done"]
    assert "flew off" in (work.out / "campaign.md").read_text()
    work.calls()
    assert work.run(runs=runs).returncode == 3
    assert work.calls() == ["dem --resume --serve"]


def test_when_a_sample_fails_its_runs_fail_and_no_other(work):
    work.scene(fake={"dem_dies_at": 0})
    process = work.run(runs=[{"seed": 1, "shear.strain_rate": 0.01}, {"seed": 1}, {"seed": 2, "fake.dem_dies_at": -1}])
    assert process.returncode == 3 and process.err.count("its sample could not be prepared") >= 2
    assert [row["state"] for row in work.rows()] == ["failed", "failed", "done"]


def test_a_damaged_sample_is_prepared_anew(work):
    assert work.run(runs=[{"seed": 1}]).returncode == 0
    (sample,) = (work.out / "samples").glob("*/prepared/sample.h5")
    whole = sample.read_bytes()
    sample.write_bytes(b"")
    assert work.run(runs=[{"seed": 1}, {"seed": 1, "shear.strain_rate": 0.01}]).returncode == 0
    assert sample.read_bytes() == whole


def test_an_interrupted_campaign_ends_its_processes_and_goes_on(work):
    axes = {"seed": [1, 2]}
    work.scene(fake={"slow": 0.3})
    process = work.start("-j", "2", axes=axes)
    wait_for(lambda: list((work.out / "runs").glob("*/frames/000001.h5")))
    process.send_signal(signal.SIGTERM)
    _, err = process.communicate(timeout=patience(60))
    assert process.returncode == 143 and "interrupted; go on with the same command" in err
    assert processes_of(work.out) == []
    # The fake writes in place, so the signal may have cut its last frame.
    frames = {file: attributes(file)["payload_hash"] for file in (work.out / "runs").glob("*/frames/*.h5")
              if is_valid(file)}
    work.calls()
    assert work.run("-j", "2", axes=axes).returncode == 0
    assert not any("--until-frame" in call for call in work.calls()), "samples are kept"
    assert frames and all(attributes(file)["payload_hash"] == value for file, value in frames.items())
    assert [row["state"] for row in work.rows()] == ["done", "done"]


def wait_for(is_time, seconds=60):
    end = time.monotonic() + patience(seconds)
    while not is_time():
        assert time.monotonic() < end, "it never came"
        time.sleep(0.01)


def processes_of(folder):
    found = []
    for entry in os.listdir("/proc"):
        try:
            with open(f"/proc/{entry}/cmdline", "rb") as file:
                if entry.isdigit() and str(folder).encode() in file.read():
                    found.append(entry)
        except OSError:
            pass
    return found


def test_conditions_are_called_as_the_figures_call_them(work):
    plan = work.plan(axes={"variant": TWINS, "preparation.confining_pressure": ["0.5e+6", "2.0e+6"], "seed": [1, 2],
                           "shear.strain_rate": [0.02, 0.01]})
    assert [condition.label for condition in conditions_of(plan)][:3] == [
        "breakable, 0.5 MPa, strain rate 0.02", "breakable, 0.5 MPa, strain rate 0.01",
        "breakable, 2 MPa, strain rate 0.02"]


def test_runs_of_different_versions_are_no_secret(tmp_path):
    runs = [SimpleNamespace(out=write_run(tmp_path / name, frames=2, breakable=False),
                            summary={"complete": True}) for name in "abc"]
    assert versions_text(SimpleNamespace(runs=runs)) == ""
    for run, version in zip(runs, ("2e2c6fe459ca", "2e2c6fe459ca", "103182a53e01")):
        with edited(run.out / "frames" / "000000.h5") as frame:
            frame.require_group("provenance").attrs["git"] = version
    assert versions_text(SimpleNamespace(runs=runs)) == (
        "Not all runs were made by the same version of dem: 2e2c6fe459ca (2 runs), 103182a53e01 (1 runs)")
    runs[2].summary = None
    assert versions_text(SimpleNamespace(runs=runs)) == "", "what is not finished is not shown"


def test_what_became_of_the_paper_is_told_first(tmp_path):
    assert paper_findings(tmp_path) == []
    (tmp_path / "paper_table.csv").write_text(
        "confining_pressure,row,verdict\n500000,a,reproduced\n500000,b,not reproduced\n1e+06,a,reproduced\n"
        '"",c,not decidable\n')
    assert paper_findings(tmp_path) == ["3 numbers of the paper: 2 reproduced, 1 not reproduced",
                                        "1 sentences of the paper: 1 not decidable"]


def test_progress_is_json_lines_and_a_dry_run_writes_nothing(work):
    axes = {"seed": [1, 2]}
    process = work.run("--dry-run", axes=axes)
    lines = [line.split("\t")[:2] for line in process.out.splitlines()]
    assert lines == [["new", "sample"]] * 2 + [["new", "run"]] * 2 and not work.out.exists()
    process = work.run(axes=axes)
    events = [json.loads(line) for line in process.err.splitlines()]
    assert {event["event"] for event in events} == {"job", "campaign", "progress"}
    last = [event for event in events if event["event"] == "campaign"][-1]
    assert (last["runs"], last["done"], last["failed"]) == (2, 2, 0)


def test_the_papers_runs_are_set_beside_the_paper_if_the_campaign_asks(work):
    runs = {"set": {"effects": TWINS["solid"]["effects"]}, "compare": "paper"}
    assert work.run(**runs).returncode == 0 and not (work.out / "paper_table.html").exists(), "not the paper's assembly"
    process = work.run("--set", "assembly.particles=1194", **runs)
    assert process.returncode == 0, process.err
    assert "2 MPa, non-breakable" in (work.out / "paper_table.md").read_text()
    assert 'href="paper_table.html"' in (work.out / "campaign.html").read_text()


def test_two_campaigns_do_not_share_a_directory(work):
    work.out.mkdir()
    with open(work.out / ".lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        process = work.run()
    assert process.returncode == 2 and "another pipeline/campaign" in process.err


def test_scatter_is_the_standard_deviation_of_a_sample():
    assert scatter([1.0, 2.0, 3.0, 4.0]) == pytest.approx((5 / 3) ** 0.5)
    assert scatter([1.0]) is None


# -- the real executables

def test_the_campaigns_in_configs_are_valid(tmp_path):
    files = sorted((REPOSITORY / "configs").glob("campaign_*.yaml"))
    assert files
    for file in files:
        assert len(make_plan(read_campaign(file), tmp_path / "out").runs) > 1

def test_a_run_from_a_shared_sample_is_the_run_that_prepared_its_own(tmp_path):
    keys = {"assembly.particles": 60, "shear.axial_strain": 0.002, "breakage.interval": 0.001}
    table = tmp_path / "table.yaml"
    table.write_text(yaml.safe_dump({"base": str(REPOSITORY / "configs" / "demo.yaml"), "report": False, "set": keys,
                                     "axes": {"variant": {"breakable": {}, "solid": {"effects": TWINS["solid"][
                                         "effects"]}}}}))
    process = subprocess.run([REPOSITORY / "pipeline" / "campaign", table, "--out", tmp_path / "out"],
                             capture_output=True, text=True, check=False)
    assert process.returncode == 0, process.stderr[-3000:]
    assert len(list((tmp_path / "out" / "samples").iterdir())) == 1
    (solid,) = (tmp_path / "out" / "runs").glob("solid_*")
    overrides = [word for key, value in keys.items() for word in ("--set", f"{key}={value}")]
    subprocess.run([REPOSITORY / "pipeline" / "run", REPOSITORY / "configs" / "demo.yaml", "--out", tmp_path / "alone",
                    "--no-report", *overrides, "--set", "effects=[friction, local_damping, energy_ledger]"], check=True,
                   capture_output=True)
    frames = [[attributes(RunDirectory(path).frame_file(k))["payload_hash"] for k in RunDirectory(path).frame_numbers()]
              for path in (solid, tmp_path / "alone")]
    assert frames[0] == frames[1] and kind.read_summary(solid)["complete"]


def test_preparation_sees_none_of_the_effects_of_breakage():
    names = CASE["effects"]
    case = {**CASE, "effects": [*names, "toughness", "face_friction"]}
    assert kind.sample_case(case, case, []) == kind.sample_case(CASE, CASE, [])
