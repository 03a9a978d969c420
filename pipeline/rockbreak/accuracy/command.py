"""`pipeline/accuracy`: arguments, messages, exit codes."""
from pathlib import Path

from .study import read_study
from ..campaign.command import add_campaign_arguments, finish, threads_each
from ..campaign.tables import run_rows, write_csv
from ..command_line import Parser, guarded
from ..campaign.plan import joined, make_plan


def accuracy(arguments=None):
    parser = Parser(prog="pipeline/accuracy", description="What accuracy costs in time: ladders of one knob at a time "
                    "against their finest rung or theory, over several seeds or specimens. Resumable like a campaign. "
                    "The path of accuracy.md is all that it writes to stdout.")
    parser.add_argument("study", type=Path, help="for example configs/accuracy_dem.yaml")
    add_campaign_arguments(parser)
    options = parser.parse_args(arguments)

    def work():
        study = read_study(options.study, options.overrides)
        plan = joined(options.out, [make_plan(subject.campaign, options.out, threads_each(options))
                                    for subject in study.subjects])
        finish(plan, options, parser.prog, lambda seconds: pages(study, plan, seconds))

    return guarded(parser.prog, work, go_on="the same command")


def pages(study, plan, seconds):
    """Tables and pages; the path of accuracy.md."""
    from .report import write_accuracy  # matplotlib is slow to load
    write_csv(plan.out / "campaign.csv", run_rows(study.subjects[0].campaign, plan, seconds))
    return write_accuracy(study, plan, seconds)
