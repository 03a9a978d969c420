"""accuracy.csv, one figure per ladder, accuracy.md and accuracy.html: what accuracy costs in time."""
import html
import re

from .figures import pareto, title_of
from .numbers import beyond, cheapest_good, floors_of, is_whole, ladder_of
from ..campaign.table import file_name
from ..campaign.tables import markdown_table, write_csv
from ..report.page import render
from ..run.run_directory import write_text
from ..style import png_bytes, svg_text

DPI = 160


def write_accuracy(study, plan, sample_seconds):
    """Returns the path of the page."""
    ladders, floors = [], {}
    for subject in study.subjects:
        of_subject = [ladder_of(knob, subject, study.kind, plan, sample_seconds) for knob in subject.knobs]
        floors[subject.name] = floors_of(of_subject)
        ladders += of_subject
    ladders.sort(key=lambda ladder: study.knobs.index(ladder.knob.name))  # stable: subjects keep their order
    write_csv(plan.out / "accuracy.csv", csv_rows(study, ladders))
    pictures = {}
    (plan.out / "figures").mkdir(exist_ok=True)
    for ladder in ladders:
        figure = pareto(ladder, study.kind, floors[ladder.subject.name])
        if figure:
            name = file_name(f"accuracy_{title_of(ladder)}")
            pictures[id(ladder)] = (name, svg_text(figure, name))
            (plan.out / "figures" / f"{name}.png").write_bytes(png_bytes(figure, DPI))
            figure.savefig(plan.out / "figures" / f"{name}.svg", metadata={"Date": None})
    blocks = page_blocks(study, plan, ladders, floors, pictures, sample_seconds)
    page = plan.out / "accuracy.md"
    write_text(page, "\n\n".join(markdown(*block) for block in blocks) + "\n")
    write_text(plan.out / "accuracy.html", render("accuracy.html.j2", {
        "title": blocks[0][1], "blocks": [(block[0], *html_parts(*block)) for block in blocks[1:]]}))
    return page


def csv_rows(study, ladders):
    return [({"subject": ladder.subject.name} if ladder.subject.name else {})
            | {"knob": ladder.knob.name, "rung": rung.label, "reference": int(rung.is_reference),
               "base": int(rung.is_base), "measure": measure, "mean": cell.mean, "mean_difference": cell.difference,
               "error_rms": cell.error, f"{study.kind.SPECIMENS[:-1]}_scatter": ladder.scatter[measure],
               "tolerance": ladder.subject.tolerances.get(measure), "pairs": cell.pairs}
            | {column: rung.costs[key] for _, column, key, _ in study.kind.COSTS}
            | ({"preparation_cpu_seconds": rung.preparation_seconds} if rung.preparation_seconds is not None else {})
            for ladder in ladders for rung in ladder.rungs for measure, cell in rung.cells.items()]


# -- the page: blocks of (kind, contents...)

def page_blocks(study, plan, ladders, floors, pictures, sample_seconds):
    kind = study.kind
    total = sum(run.summary.get(kind.TOTAL) or 0 for run in plan.runs if run.summary)
    samples = sum(sample_seconds.values())
    blocks = [
        ("title", f"What accuracy costs in time: {study.file.stem}"),
        ("text", "One knob at a time, around a base. "
         + " ".join(f"{subject.name or 'Base'}: {described(subject)}." for subject in study.subjects)),
        ("text", f"**Error**: root mean square, over the {kind.SPECIMENS}, of the difference from the reference's run "
         f"of the same {kind.SPECIMENS[:-1]}{kind.THEORY_NOTE}; in brackets the mean difference. **Scatter**: "
         f"standard deviation between the {kind.SPECIMENS}, all rungs of the ladder together. A **bold** error is "
         f"{good_enough(study, floors)}. {kind.COST_NOTE} {len(plan.runs)} runs, "
         f"{total:.0f} s" + (f", and {samples:.0f} s for the samples" if samples else "")
         + ". All numbers: `accuracy.csv`; every run: `campaign.csv`."),
        ("heading", "What follows"),
        ("list", [sentence(ladder, floors[ladder.subject.name], kind) for ladder in ladders])]
    for subject in study.subjects:
        if floors[subject.name]:
            of = f", {subject.name}" if subject.name else ""
            blocks.append(("text", f"Growth of rounding{of}, the largest error of the rungs that differ by rounding "
                           "alone: "
                           + ", ".join(f"{name} {value:.2g}" for name, value in floors[subject.name].items())
                           + ". No smaller error means anything."))
    for ladder in ladders:
        blocks += [("heading", title_of(ladder)), ("table", *table(ladder, kind, floors[ladder.subject.name]))]
        if ladder.knob.against_itself:
            blocks.append(("text", f"Each rung is compared with itself under `{ladder.knob.against_itself}`."))
        blocks += [("text", f"Rung {rung.label} failed: {failure}")
                   for rung in ladder.rungs for failure in rung.failures]
        if id(ladder) in pictures:
            blocks.append(("figure", f"{title_of(ladder)}: error against time", *pictures[id(ladder)]))
    return blocks


def described(subject):
    campaign = subject.campaign
    keys = ", ".join(f"`{key}: {value}`" for key, value in campaign.common.items()) or "nothing else"
    return f"`{campaign.base.name}` with {keys}; {campaign.kind.SPECIMENS} {', '.join(subject.specimens)}"


def good_enough(study, floors):
    limits = "larger than that" + (" and than the growth of rounding" if any(floors.values()) else "")
    return f"larger than the study's tolerance (*good enough*); where it states none, {limits}" \
        if any(subject.tolerances for subject in study.subjects) else limits


def table(ladder, kind, floors):
    names = [measure.name for measure in ladder.subject.measures
             if any(rung.cells[measure.name].error is not None for rung in ladder.rungs)]
    prepared = any(rung.preparation_seconds is not None for rung in ladder.rungs)
    base_cost = ladder.base.cost if ladder.base else None
    head = ["rung", kind.COSTS[0][0], "of the base", *(heading for heading, _, _, _ in kind.COSTS[1:]),
            *(["sample [s]"] if prepared else []), *names]
    blank = [""] * (len(head) - len(names) - 1)
    rows = []
    for rung in ladder.rungs:
        notes = [note for note, holds in (("reference", rung.is_reference), ("base", rung.is_base)) if holds]
        label = f"**{rung.label}**" if rung.is_base else rung.label
        costs = [compact(scaled(rung.costs[key], factor)) for _, _, key, factor in kind.COSTS]
        rows.append([f"{label} ({', '.join(notes)})" if notes else label, costs[0],
                     form(rung.cost / base_cost if base_cost and rung.cost else None, "{:.0%}"), *costs[1:],
                     *([form(rung.preparation_seconds, "{:.3g}")] if prepared else []),
                     *(error_text(rung, ladder, name, floors) for name in names)])
    rows.append([f"*scatter between {kind.SPECIMENS}*", *blank, *(form(ladder.scatter[name]) for name in names)])
    if ladder.subject.tolerances:
        rows.append(["*good enough*", *blank, *(form(ladder.subject.tolerances.get(name), "{:g}") for name in names)])
    if ladder.reference:
        rows.append(["*mean of the reference*", *blank, *(form(ladder.reference.cells[name].mean) for name in names)])
    return head, rows


def scaled(value, factor):
    return None if value is None else factor * value


def compact(value):
    return form(value, "{:.0f}" if value is not None and 1e3 <= value < 1e6 else "{:.3g}")


def form(value, text="{:.4f}"):
    return "–" if value is None else text.format(value)


def error_text(rung, ladder, name, floors):
    cell = rung.cells[name]
    if cell.error is None:
        return "–"
    if cell.error == 0:
        return "0"
    text = f"{cell.error:.4f}"
    bold = f"**{text}**" if name in beyond(rung, ladder, floors) else text
    return bold if f"{cell.difference:.4f}" == text else f"{bold} ({cell.difference:+.4f})"


def sentence(ladder, floors, kind):
    """What the numbers say of one knob."""
    base, cheapest = ladder.base, cheapest_good(ladder, floors)
    factor, unit = kind.COSTS[0][3], kind.COST_UNIT
    words = f"**{title_of(ladder)}**: "
    limit = "good enough" if ladder.subject.tolerances else "within the scatter"
    if base is None:
        words += "the base is none of its rungs. "
    elif not is_whole(base):
        words += f"the base, {base.label}, is not finished. "
    else:
        outside = beyond(base, ladder, floors)
        words += f"the base, {base.label} ({compact(factor * base.cost)} {unit}), " + (
            "is the reference itself. " if base.is_reference and not outside else
            f"is {limit} in every measure. " if not outside else
            f"is not {limit} in " + ", ".join(
                f"{name} ({form(base.cells[name].error)} against {form(ladder.allowed(name, floors))})"
                for name in outside) + ". ")
    if cheapest is None:
        return words + f"No rung is whole and {limit}."
    words += f"Cheapest rung {limit}: {cheapest.label}, {compact(factor * cheapest.cost)} {unit}"
    if base is not None and base is not cheapest and base.cost:
        words += f", {cheapest.cost / base.cost:.0%} of the base"
    return words + "."


# -- as Markdown and as HTML

def markdown(block, *contents):
    if block == "title":
        return f"# {contents[0]}"
    if block == "heading":
        return f"## {contents[0]}"
    if block == "list":
        return "\n".join(f"- {item}" for item in contents[0])
    if block == "table":
        return markdown_table(*contents)
    if block == "figure":
        return f"![{contents[0]}](figures/{contents[1]}.svg)"
    return contents[0]


def html_parts(block, *contents):
    if block == "list":
        return ([marked_up(item) for item in contents[0]],)
    if block == "table":
        return [marked_up(cell) for cell in contents[0]], [[marked_up(cell) for cell in row] for row in contents[1]]
    if block == "figure":
        return contents[0], contents[2]
    return (marked_up(contents[0]),)


def marked_up(text):
    """The Markdown that the page uses: **bold**, *emphasis*, `code`."""
    text = html.escape(text, quote=False)
    for pattern, tag in ((r"\*\*(.+?)\*\*", "b"), (r"\*(.+?)\*", "em"), (r"`(.+?)`", "code")):
        text = re.sub(pattern, rf"<{tag}>\1</{tag}>", text)
    return text
