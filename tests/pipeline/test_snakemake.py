"""Campaigns through Snakemake: the plan as rules, on this machine and through a `sbatch` that only pretends, and the
same results as without."""
import json
import os
import shutil
import signal
import subprocess

import pytest
import yaml

from conftest import REPOSITORY
from patience import patience
from rockbreak.campaign.snakemake import planned_jobs
from rockbreak.run.run_directory import attributes, is_valid
from test_campaign import TWINS, Workplace, processes_of, wait_for

pytestmark = pytest.mark.skipif(not shutil.which("snakemake"), reason="needs snakemake: apt-get install snakemake "
                                "(pipeline/setup --with-tests)")
PROFILE = REPOSITORY / "pipeline" / "rockbreak" / "campaign" / "slurm"
AXES = {"seed": [1, 2], "variant": TWINS}


@pytest.fixture
def work(tmp_path, monkeypatch):
    (tmp_path / "a folder").mkdir()
    return Workplace(tmp_path / "a folder", monkeypatch)


def snakemake(out, *arguments):
    return subprocess.run(["snakemake", *arguments], cwd=out, capture_output=True, text=True, timeout=patience(300),
                          check=False)


def write_rules(work, *arguments, **content):
    process = work.run("--snakemake", *arguments, **content)
    assert process.returncode == 0 and process.out == f"{work.out / 'Snakefile'}\n", process.err
    return process


def payloads(out):
    """Name of every frame and split of all runs -> payload hash."""
    return {str(file.relative_to(out)): attributes(file)["payload_hash"]
            for kind in ("frames", "splits") for file in (out / "runs").glob(f"*/{kind}/*.h5") if is_valid(file)}


def test_every_sample_and_run_is_a_rule_with_the_command_that_the_campaign_would_start(work):
    plan = work.plan(axes=AXES)
    jobs = {job["name"]: job for job in planned_jobs(plan)}
    assert len(jobs) == 6 and all(str(run.out) in jobs[run.name]["command"] for run in plan.runs)
    for run in plan.runs:
        sample = jobs[f"sample_{run.sample.out.name}"]
        assert jobs[run.name]["needs"] == sample["makes"] and sample["needs"] == []
        assert jobs[run.name]["makes"] == [f"runs/{run.name}/summary.json"]
        assert sample["priority"] > jobs[run.name]["priority"]
    breakable, solid = (jobs[run.name]["priority"] for run in plan.runs[:2])
    assert breakable > solid


def test_a_process_takes_no_more_processors_than_its_rule_says(work):
    """Left to itself, xfem would take all."""
    for arguments, threads in (((), 1), (("--threads", "3"), 3)):
        write_rules(work, *arguments, axes=AXES)
        jobs = json.loads((work.out / "plan.json").read_text())["jobs"]
        assert len(jobs) == 6
        assert all(job["threads"] == threads and f"--threads {threads}" in job["command"] for job in jobs)


def test_the_dry_run_names_what_is_missing_and_runs_nothing(work):
    write_rules(work, axes=AXES)
    process = snakemake(work.out, "-n", "-j", "2")
    assert process.returncode == 0, process.stderr
    for run in work.plan(axes=AXES).runs:
        assert f"rule {run.name}:" in process.stdout
    assert work.calls() == [] and not (work.out / "runs").exists()


def test_a_killed_snakemake_goes_on_where_its_runs_stand(work):
    work.scene(fake={"slow": 0.3})
    write_rules(work, axes={"seed": [1, 2]})
    process = subprocess.Popen(["snakemake", "-j", "2"], cwd=work.out, start_new_session=True,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_for(lambda: list((work.out / "runs").glob("*/frames/000001.h5")))
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    wait_for(lambda: processes_of(work.out) == [])
    before = payloads(work.out)
    assert before and not list((work.out / "runs").glob("*/summary.json"))
    work.calls()
    assert snakemake(work.out, "--unlock").returncode == 0
    done = snakemake(work.out, "-j", "2", "--rerun-incomplete")
    assert done.returncode == 0, done.stderr
    assert not any("--until-frame" in call for call in work.calls()), "samples are kept"
    assert before.items() <= payloads(work.out).items()
    assert [row["state"] for row in work.rows()] == ["done", "done"]
    assert "Nothing to be done" in snakemake(work.out, "-j", "2").stderr
    process = work.run(axes={"seed": [1, 2]})
    assert process.returncode == 0 and work.calls() == [], "pipeline/campaign takes the runs for finished, too"


def test_one_that_fails_stops_no_other(work):
    runs = [{"seed": 1}, {"seed": 2, "fake.dem_dies_at": 1}, {"seed": 3}]
    write_rules(work, runs=runs)
    process = snakemake(work.out, "-j", "2", "--keep-going")
    assert process.returncode != 0
    plan = work.plan(runs=runs)
    assert [run.is_finished() for run in plan.runs] == [True, False, True]
    assert "flew off" in (work.out / "logs" / f"{plan.runs[1].name}.log").read_text()


def test_the_profile_for_slurm_submits_every_rule_with_what_it_needs(work, monkeypatch):
    """`sbatch` starts the script that it is given and answers with a number, as the real one does."""
    log = work.path / "sbatch.log"
    sbatch = work.path / "bin" / "sbatch"
    sbatch.write_text(f'#!/bin/sh\nprintf "%s\\n" "$*" >> "{log}"\nfor script; do :; done\n'
                      'sh "$script" >/dev/null 2>&1 &\necho $!\n')
    sbatch.chmod(0o755)
    monkeypatch.setenv("PATH", f"{work.path / 'bin'}:{os.environ['PATH']}")
    monkeypatch.setenv("CI", "true")  # Snakemake then looks at its jobs every second, not every ten
    write_rules(work, "--threads", "3")
    process = snakemake(work.out, "--profile", PROFILE)
    assert process.returncode == 0, process.stderr
    (run,) = work.plan().runs
    words = [line.split()[:-1] for line in log.read_text().splitlines()]
    assert [line[1] for line in words] == [f"--job-name=rockbreak.{name}" for name in (
        f"sample_{run.sample.out.name}", run.name)], "the tables are made where Snakemake runs"
    assert all({"--parsable", "--cpus-per-task=3", "--mem=1000", "--time=120"} <= set(line) for line in words)
    assert (work.out / "campaign.html").exists() and [row["state"] for row in work.rows()] == ["done"]


def test_runs_through_snakemake_are_byte_for_byte_those_of_the_campaign(tmp_path):
    """The real executables, breakable and solid twins from one sample."""
    table = tmp_path / "table.yaml"
    table.write_text(yaml.safe_dump({
        "base": str(REPOSITORY / "configs" / "demo.yaml"), "report": False,
        "set": {"assembly.particles": 60, "shear.axial_strain": 0.004, "breakage.interval": 0.001},
        "axes": {"variant": {"breakable": {}, "solid": {"effects": TWINS["solid"]["effects"]}}}}))

    def campaign(out, *arguments):
        process = subprocess.run([REPOSITORY / "pipeline" / "campaign", table, "--out", out, *arguments],
                                 capture_output=True, text=True, check=False, timeout=patience(300))
        assert process.returncode == 0, process.stderr[-3000:]

    campaign(tmp_path / "local", "-j", "2")
    campaign(tmp_path / "rules", "--snakemake", "--threads", "1")
    process = snakemake(tmp_path / "rules", "-j", "2")
    assert process.returncode == 0, process.stderr[-3000:]
    local = payloads(tmp_path / "local")
    assert payloads(tmp_path / "rules") == local and len(local) >= 10
    plan = json.loads((tmp_path / "rules" / "plan.json").read_text())
    assert len(plan["jobs"]) == 3
