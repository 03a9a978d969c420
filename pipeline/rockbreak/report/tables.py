"""The report's numbers as text: headline, summary table with the paper's values, checks, warnings."""
from collections import Counter
from statistics import mean, stdev

from ..paper import numbers as paper
from ..run.ledger import kind_of

SERVO_TOLERANCE = 0.02      # rms of the lateral stress error
AREA_TOLERANCE = 1e-12      # relative change of the total solid area
REST_TOLERANCE = 1e-3       # unbalanced force before shear
INERTIA_TOLERANCE = 1e-3    # inertial number
ENERGY_TOLERANCE = 0.001    # residual over boundary work

PASSED, NOT_MET, UNKNOWN = "✓ passed", "✗ not met", "not known"
VERDICTS = {PASSED: "good", NOT_MET: "bad", UNKNOWN: "unknown"}  # with their style on the page


def number(value, form="{:.3f}"):
    return "–" if value is None else form.format(value)


def headline(run):
    s = run.summary
    tiles = [(f"{s['particles_initial']} → {s['particles_final']}", "particles")]
    if run.breakable:
        tiles.append((str(s["broken_total"]), "broken"))
    return tiles + [
        (f"{run.frames[-1]['axial_strain']:.1%}", "axial strain"),
        (number(s["peak_sin_phi"]), f"peak sin φ at {number(s['peak_strain'], '{:.1%}')}"),
        (number(s["residual_sin_phi"]), "residual sin φ"),
        (f"{number(s['initial_void_ratio'])} → {number(s['final_void_ratio'])}", "void ratio"),
        (number(s["wall_seconds"]["total"], "{:.0f} s"), "wall time"),
    ]


def published(run):
    """The paper's values for this very run, by the label of a row; empty for other scenes."""
    if not paper.applies_to(run.case):
        return {}
    contacts = paper.CONTACTS_2MPA[run.breakable]
    values = {"contacts, start": contacts[0.0], "contacts, end": contacts[0.173],
              "void ratio, start": paper.INITIAL_VOID_RATIO,
              "void ratio, end": paper.FINAL_VOID_RATIO[run.breakable][2e6]}
    if run.breakable:
        values |= {f"particles at {strain:.1%}": count for strain, count in paper.PARTICLES_2MPA_BREAKABLE.items()}
        values["broken"] = paper.PARTICLES_2MPA_BREAKABLE[0.173] - paper.PARTICLES
    return values


def summary_rows(run):
    """Label -> text."""
    s, energy = run.summary, run.summary["energy"]
    megajoule = {key: None if value is None else 1e-6 * value for key, value in energy.items()}
    rows = {"confining pressure [MPa]": number(None if s["confining_pressure"] is None
                                               else 1e-6 * s["confining_pressure"], "{:g}")}
    rows |= {f"particles at {float(strain):.1%}": str(count) for strain, count in s["particles_at_strain"].items()}
    rows["broken"] = number(s["broken_total"], "{}")
    rows |= {f"contacts, {name}": number(s[f"contacts_{key}"], "{}")
             for name, key in (("start", "initial"), ("peak", "peak"), ("end", "final"))}
    for name, key in (("start", "initial"), ("end", "final")):
        rows[f"void ratio, {name}"] = number(s[f"{key}_void_ratio"])
        rows[f"e1 / e2 / e4, {name}"] = " / ".join(number(s["void_ratios"][key][kind]) for kind in ("e1", "e2", "e4"))
    rows["peak sin φ"] = number(s["peak_sin_phi"])
    rows["strain at the peak"] = number(s["peak_strain"], "{:.2%}")
    rows["residual sin φ"] = number(s["residual_sin_phi"])
    fabric = s["anisotropy_peak"] or {}
    rows["a / a_n / a_t at the peak"] = " / ".join(number(fabric.get(key)) for key in ("a", "a_n", "a_t"))
    rows["sin φ of Eq. 10 at the peak"] = number(s["sin_phi_micro_peak"])
    rows |= {f"{label} [MJ]": number(megajoule[key], "{:.4g}") for label, key in (
        ("boundary work", "boundary_work"), ("friction", "friction"), ("damping", "damping"),
        ("elastic energy, end", "elastic"), ("kinetic energy, end", "kinetic"),
        ("released by breakage", "released_by_breakage"), ("contact law work", "contact_law_work"),
        ("energy residual", "residual"))}
    rows["steps"] = number(s["steps"], "{:,}")
    rows["contact steps"] = number(s["contact_steps"], "{:,}")
    return rows


def summary_table(runs):
    """Head and rows of text: a row for each number that some run has, the paper's value (if it has one) at the end."""
    tables = [summary_rows(run) for run in runs]
    beside = [published(run) for run in runs]
    labels = list(dict.fromkeys(label for table in tables for label in table))
    with_paper = any(beside)
    rows = []
    for label in labels:
        reference = " / ".join(str(values.get(label, "")) if values else "" for values in beside).strip(" /")
        rows.append([label, *(table.get(label, "–") for table in tables), *([reference] if with_paper else [])])
    return ["number", *(run.name for run in runs), *(["Raisianzadeh et al. (2019)"] if with_paper else [])], rows


CONDITION_COLUMNS = (  # heading, number of the summary, format
    ("particles, end", "particles_final", "{:.0f}"), ("broken", "broken_total", "{:.0f}"),
    ("e, start", "initial_void_ratio", "{:.3f}"),
    ("e, end", "final_void_ratio", "{:.3f}"), ("peak sin φ", "peak_sin_phi", "{:.3f}"),
    ("at strain", "peak_strain", "{:.1%}"), ("sin φ of Eq. 10", "sin_phi_micro_peak", "{:.3f}"),
    ("residual sin φ", "residual_sin_phi", "{:.3f}"),
)


def condition_table(selection):
    """Head and rows of text: mean ± standard deviation over the seeds of each condition."""
    rows = []
    for condition in selection.conditions:
        found = [[run.summary[key] for run in condition.runs if run.summary[key] is not None]
                 for _, key, _ in CONDITION_COLUMNS]
        rows.append([condition.label, str(len(condition.runs)), *(
            mean_text(values, form) for values, (_, _, form) in zip(found, CONDITION_COLUMNS))])
    return ["condition", "runs", *(heading for heading, _, _ in CONDITION_COLUMNS)], rows


def mean_text(values, form):
    if not values:
        return "–"
    return form.format(mean(values)) + (f" ± {form.format(stdev(values))}" if len(values) > 1 else "")


def checks(runs):
    """(check, run, found, wanted, one of VERDICTS)."""
    return [row for row, _ in checked(runs)]


def checked(runs):
    """Rows of `checks` with the number that was held against its limit."""
    found = []
    for run in runs:
        s, energy = run.summary, run.summary["energy"]
        work, residual = energy["boundary_work"], energy["residual"]
        values = (
            ("unbalanced force at rest", s["unbalanced_force_at_rest"], REST_TOLERANCE, "{:.1e}"),
            ("lateral stress error, rms", s["lateral_stress_error_rms"], SERVO_TOLERANCE, "{:.2%}"),
            ("largest inertial number", s["max_inertial_number"], INERTIA_TOLERANCE, "{:.1e}"),
            ("solid area, relative change", s["solid_area_error"], AREA_TOLERANCE, "{:.1e}"),
            ("energy residual / boundary work", abs(residual / work) if work and residual is not None else None,
             ENERGY_TOLERANCE, "{:.2%}"),
        )
        for label, value, limit, form in values:
            verdict = UNKNOWN if value is None else PASSED if value <= limit else NOT_MET
            found.append(((label, run.name, number(value, form), "≤ " + form.format(limit), verdict), value))
    return found


def worst_checks(runs):
    """The same of several runs: of each check the run that is furthest from passing."""
    found = {}
    for row, value in checked(runs):
        if row[0] not in found or (value or 0.0) > (found[row[0]][1] or 0.0):
            found[row[0]] = (row, value)
    return [row for row, _ in found.values()]


def warnings(runs):
    """(run, text) of the warnings in the ledgers; of those that differ by their numbers alone, the first."""
    found = []
    for run in runs:
        first, counts = {}, Counter()
        for event in run.ledger():
            if event["event"] == "warning":
                text = f"{event.get('source', '')}: {event.get('text', '')}".strip(": ")
                first.setdefault(kind_of(text), text)
                counts[kind_of(text)] += 1
        found += [(run.name, text + (f" (and {counts[kind] - 1} more like it)" if counts[kind] > 1 else ""))
                  for kind, text in first.items()]
    return found
