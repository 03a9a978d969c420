"""The order in which a campaign starts its processes: a simulated clock for the length of the whole, real processes for
the promise that no slot is empty while there is work."""
import itertools

import pytest

from rockbreak.campaign import biaxial_test as kind
from rockbreak.campaign.jobs import Job, next_jobs, run_jobs


def paper_like(durations, sample=10.0):
    """Per pressure a sample, then a breakable run and a solid one: (jobs, seconds that each takes). Ordered as a
    table."""
    jobs, seconds = [], {}
    for pressure, (breakable, solid) in durations.items():
        first = Job(f"sample {pressure}", [], None, effort=sample)
        for name, length in (("breakable", breakable), ("solid", solid)):
            jobs.append(Job(f"{name} {pressure}", [], None, first, length))
            seconds[jobs[-1].name] = length
        jobs.append(first)
        seconds[first.name] = sample
    return jobs, seconds


def simulated(jobs, seconds, slots):
    """The time at which the last one ends; a slot may not be empty while a job is ready."""
    now, ends = 0.0, {}
    while any(job.state != "done" for job in jobs):
        for job in next_jobs(jobs, slots):
            job.state, ends[job.name] = "running", now + seconds[job.name]
        running = [job for job in jobs if job.state == "running"]
        assert len(running) == slots or not next_jobs(jobs, len(jobs)), "an idle slot beside a job that is ready"
        first = min(running, key=lambda job: ends[job.name])
        now, first.state = ends[first.name], "done"
    return now


DURATIONS = {0.5: (45, 28), 1: (60, 28), 2: (90, 28), 4: (150, 28)}


def test_the_papers_campaign_takes_little_longer_than_its_work_shared_by_two():
    jobs, seconds = paper_like(DURATIONS)
    assert simulated(jobs, seconds, 2) <= 1.03 * sum(seconds.values()) / 2
    jobs, seconds = paper_like(DURATIONS)
    assert simulated(jobs, seconds, 8) == 10 + 150, "the longest chain, with slots enough"


@pytest.mark.parametrize("slots", [1, 2, 3, 4])
def test_wrong_estimates_cost_no_more_than_the_bound_of_list_schedules(slots):
    """Graham: any schedule that leaves no slot idle ends within work / m + (1 - 1/m) * longest chain."""
    for order in itertools.permutations(DURATIONS.values()):
        jobs, seconds = paper_like(DURATIONS)
        for job, wrong in zip([job for job in jobs if job.after], itertools.chain(*order)):
            job.effort = wrong
        assert simulated(jobs, seconds, slots) <= sum(seconds.values()) / slots + (1 - 1 / slots) * 160 + 1e-9


def test_what_others_wait_for_counts_with_them():
    short_sample = Job("sample", [], None, effort=1.0)
    jobs = [Job("alone", [], None, effort=5.0), Job("waits", [], None, short_sample, 7.0), short_sample]
    assert [job.name for job in next_jobs(jobs, 1)] == ["sample"]
    assert [job.name for job in next_jobs(jobs, 3)] == ["sample", "alone"]
    short_sample.state = "done"
    assert [job.name for job in next_jobs(jobs, 1)] == ["waits"]


def test_equal_jobs_keep_the_order_of_the_table():
    jobs = [Job(name, [], None) for name in "cab"]
    assert [job.name for job in next_jobs(jobs, 2)] == ["c", "a"]


def case(pressure, effects=(), particles=1194):
    return {"assembly": {"particles": particles}, "preparation": {"confining_pressure": pressure},
            "effects": ["friction", *effects], "shear": {"axial_strain": 0.173, "strain_rate": 0.02}}


def test_breakable_runs_count_as_longer_and_more_so_at_higher_pressure():
    efforts = [kind.effort(one) for one in (case(4e6), case(0.5e6, ["breakage"]), case(2e6, ["breakage"]),
                                            case(4e6, ["breakage"]))]
    assert efforts == sorted(efforts) and len(set(efforts)) == 4
    assert efforts[2] == pytest.approx(3.2 * efforts[0])
    assert kind.effort(case(4e6, particles=2388)) == 2 * efforts[0]
    assert kind.sample_effort(case(4e6, ["breakage"])) == kind.sample_effort(case(0.5e6)) < efforts[0]


def test_real_processes_fill_the_slots_and_follow_what_they_need(tmp_path):
    """Each writes its name when it starts and when it ends; one that fails takes those with it that need it."""
    log = tmp_path / "order"

    def job(name, after=None, effort=1.0, code=0):
        script = f"echo +{name} >> {log}; sleep 0.05; echo -{name} >> {log}; echo 'error: {name}' >&2; exit {code}"
        return Job(name, ["/bin/sh", "-c", script], tmp_path / "log", after, effort)

    good, bad = job("good", effort=2.0), job("bad", code=3, effort=4.0)
    jobs = [job("last", effort=0.5), good, bad, job("a", good), job("b", good), job("c", bad)]
    most = 0

    def look(_):
        nonlocal most
        running = sum(one.state == "running" for one in jobs)
        most = max(most, running)
        ready = [one for one in jobs if one.state == "waiting" and (one.after is None or one.after.state == "done")]
        assert running == 2 or not ready

    with open(tmp_path / "lock", "w", encoding="utf-8") as lock:
        run_jobs(jobs, 2, lock, lambda one: look(one) if one is None else None)
    lines = log.read_text().split()
    assert most == 2 and {one.name: one.state for one in jobs} == {
        "last": "done", "good": "done", "bad": "failed", "a": "done", "b": "done", "c": "failed"}
    assert set(lines[:2]) == {"+bad", "+good"} and "+c" not in lines and lines.index("-good") < lines.index("+a")
    assert jobs[5].reason.startswith("its sample could not be prepared") and jobs[5].code == 3
