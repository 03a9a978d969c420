"""Carries out a plan: what is finished is kept, what is interrupted goes on, what fails is reported at the end."""
from .progress import Tally, make_campaign_progress
from ..run.driver import catch_signals
from ..errors import Interrupted
from .jobs import Job, run_jobs
from ..run.ledger import Ledger, read_ledger
from ..run.run_directory import lock_directory


def carry_out(plan, program, slots):
    """Runs all that is missing and fills in summary, failure and exit code of every run. Returns the user seconds
    spent on samples, by hash. Raises Interrupted after all processes have ended; what is finished by then stays."""
    with lock_directory(plan.out, program) as lock:
        catch_signals()
        ledger_file = plan.out / "campaign.jsonl"
        with Ledger(ledger_file) as ledger:
            jobs, jobs_of = make_jobs(plan)
            samples = {job.name: sample for sample, job in jobs_of["samples"]}
            waiting = [job for _, job in jobs_of["runs"]]
            tally = Tally(jobs, waiting, len(plan.runs) - len(waiting))
            ledger.write("start", runs=len(plan.runs), kept=tally.kept, samples=len(samples), jobs=slots)
            code = 0
            try:
                with make_campaign_progress(tally) as progress:
                    def changed(job):
                        if job is not None and job.state in ("done", "failed"):
                            ledger.write("job", name=job.name, state=job.state, code=job.code, reason=job.reason,
                                         user_seconds=round(job.user_seconds, 3),
                                         **({"sample": samples[job.name].hash} if job.name in samples else {}))
                        progress.changed(job)
                    run_jobs(jobs, slots, lock, changed)
            except Interrupted as interrupt:
                code = interrupt.code
                raise
            finally:
                for run, job in jobs_of["runs"]:
                    if job.state == "failed":
                        run.failure, run.code = job.reason, job.code
                learn_summaries(plan)
                ledger.write("end", code=code or exit_code(plan))
    return sample_seconds(ledger_file)


def make_jobs(plan):
    """A job for every run that is not finished, after one for its sample if that is not there."""
    jobs, of = [], {"runs": [], "samples": []}
    sample_jobs = {}
    for run in plan.runs:
        if run.is_finished():
            continue
        after = None
        if run.sample and not run.sample.is_finished():
            after = sample_jobs.get(run.sample.hash)
            if after is None:
                run.kind.clear_sample(run.sample.out)
                after = sample_jobs[run.sample.hash] = Job(f"samples/{run.sample.out.name}", run.sample.command,
                                                           plan.out / "logs" / f"sample_{run.sample.out.name}.log",
                                                           effort=run.sample.effort)
                jobs.append(after)
                of["samples"].append((run.sample, after))
        jobs.append(Job(run.name, run.command, plan.out / "logs" / f"{run.name}.log", after, run.effort))
        of["runs"].append((run, jobs[-1]))
    return jobs, of


def learn_summaries(plan):
    for run in plan.runs:
        run.summary = run.kind.read_summary(run.out)


def exit_code(plan):
    """0, or that of the first run that failed."""
    return next((run.code for run in plan.runs if run.failure), 0)


def sample_seconds(ledger_file):
    """User seconds by sample hash, over all starts of the campaign."""
    spent = {}
    for event in read_ledger(ledger_file):
        if event["event"] == "job" and "sample" in event:
            spent[event["sample"]] = spent.get(event["sample"], 0.0) + event["user_seconds"]
    return spent
