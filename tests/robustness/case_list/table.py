"""The table of all cases in tests/robustness/README.md, made from the case files and from what was measured."""
import re
import shlex

from . import FOLDER, PARTS

README = FOLDER / "README.md"
BEGIN, END = "<!-- cases: written by tests/robustness/run --write -->", "<!-- end of the cases -->"
TITLES = {"dem": "`dem`", "xfem": "`xfem`", "coupling": "Both together"}
HEAD = "| case | what goes wrong elsewhere | expected | measured | verdict | by hand |"
RULE = "|---|---|---|---|---|---|"


def lines_of(outcomes):
    """The tables, one for each part."""
    lines = []
    for part in PARTS:
        mine = [outcome for outcome in outcomes if outcome.case.part == part]
        if mine:
            green = sum(outcome.green for outcome in mine)
            lines += ["", f"**{TITLES[part]}: {green} of {len(mine)} green**", "", HEAD, RULE, *map(row, mine)]
    return lines[1:]


def row(outcome):
    verdict = "green" if outcome.green else "**red**: " + "; ".join(outcome.reasons)
    return row_head(outcome.case) + f"{cell(outcome.text())} | {cell(verdict)} | {cell(by_hand(outcome.case))} |"


def row_head(case):
    """What a row says without any measurement."""
    return f"| {cell(case.name)} | {cell(case.why)} | {cell(case.expected)} | "


def cell(text):
    return text.replace("|", "\\|").replace("\n", " ")


def by_hand(case):
    """What to type in the repository's folder."""
    if case.tests:
        commands = [f"pytest {name}" if runner == "pytest" else f"build/release/tests/{runner} {shlex.quote(name)}"
                    for runner, name in case.tests]
    else:
        commands = [re.sub(r"^(dem|xfem) ", r"build/release/\1 ", command.replace("{out}", f"runs/{case.folder}"))
                    for command in case.commands]
    return "<br>".join(f"`{command}`" for command in commands)


def write(outcomes):
    text = README.read_text(encoding="utf-8")
    head, _, rest = text.partition(BEGIN)
    _, _, tail = rest.partition(END)
    README.write_text(f"{head}{BEGIN}\n" + "\n".join(lines_of(outcomes)) + f"\n{END}{tail}", encoding="utf-8")


def written_rows():
    """The rows that stand in the README, each by the name of its case."""
    text = README.read_text(encoding="utf-8").partition(BEGIN)[2].partition(END)[0]
    rows = [line for line in text.splitlines() if line.startswith("| ") and line != HEAD]
    return {re.split(r"(?<!\\)\|", line)[1].strip(): line for line in rows}
