"""What a figure is drawn from: runs grouped into conditions, which are runs that differ by their seed alone."""
from dataclasses import dataclass
from functools import cached_property

from ..style import BLUE, CYCLE, LINES, MARKERS, VERMILION, sequence
from ..text_yaml import flat

REFERENCE_PRESSURE = 2e6  # [Pa] at which the paper shows what depends on strain
# What may differ between the runs of one condition: the seed, and what follows from where a run was made.
FREE_KEYS = ("seed", "output.", "preparation.from", "shear.frame_interval")
KINDS = {False: "solid", True: "breakable"}
KIND_COLORS = {False: BLUE, True: VERMILION}
KIND_LINES = {False: "-", True: "--"}
KIND_MARKERS = {False: "o", True: "D"}


@dataclass(eq=False)
class Condition:
    label: str       # in legends and tables
    pressure: float  # [Pa], None if the scene names none
    breakable: bool
    runs: list
    style: dict = None  # colour, line and marker that tell it apart

    @property
    def first(self):
        """The run that is pictured: that of the lowest seed."""
        return self.runs[0]

    @property
    def line(self):
        return {key: self.style[key] for key in ("color", "linestyle")}


class Selection:
    """Conditions, at rising pressure, solid before breakable."""

    def __init__(self, conditions):
        self.conditions = sorted(conditions, key=lambda one: (one.pressure or 0.0, one.breakable))
        self._assign_styles()

    @property
    def runs(self):
        return [run for condition in self.conditions for run in condition.runs]

    @property
    def breakable(self):
        return [condition for condition in self.conditions if condition.breakable]

    @property
    def is_single(self):
        return len(self.runs) == 1

    @property
    def has_seeds(self):
        return any(len(condition.runs) > 1 for condition in self.conditions)

    @cached_property
    def pressures(self):
        return sorted({one.pressure for one in self.conditions if one.pressure is not None})

    @cached_property
    def kinds(self):
        return sorted({one.breakable for one in self.conditions})

    @cached_property
    def reference(self):
        """The part at one pressure: the paper's 2 MPa, or the nearest to it; all if there is but one."""
        if len(self.pressures) < 2:
            return self
        nearest = min(self.pressures, key=lambda pressure: abs(pressure - REFERENCE_PRESSURE))
        return self.only(lambda one: one.pressure == nearest)

    def only(self, wanted):
        """The part whose conditions are wanted, with the styles of a selection of its own."""
        return Selection([Condition(one.label, one.pressure, one.breakable, one.runs)
                          for one in self.conditions if wanted(one)])

    def at(self, pressure, breakable):
        """The condition of one cell of the table of pressures and kinds, or None."""
        return next((one for one in self.conditions if (one.pressure, one.breakable) == (pressure, breakable)), None)

    @cached_property
    def is_grid(self):
        """Whether pressure and kind alone tell the conditions apart."""
        return len({(one.pressure, one.breakable) for one in self.conditions}) == len(self.conditions)

    def _assign_styles(self):
        shades = dict(zip(self.pressures, sequence(len(self.pressures))))
        for index, one in enumerate(self.conditions):
            if not self.is_grid:
                one.style = {"color": CYCLE[index % len(CYCLE)], "linestyle": LINES[index % len(LINES)],
                             "marker": MARKERS[index % len(MARKERS)]}
            else:
                color = shades[one.pressure] if len(self.pressures) > 1 else KIND_COLORS[one.breakable]
                line = KIND_LINES[one.breakable] if len(self.conditions) > 1 else "-"
                one.style = {"color": color, "linestyle": line,
                             "marker": KIND_MARKERS[one.breakable]}
            if self.is_grid:
                words = [f"{1e-6 * one.pressure:g} MPa"] if len(self.pressures) > 1 else []
                words += [KINDS[one.breakable]] if len(self.kinds) > 1 or not words else []
                one.label = ", ".join(words)


def select(runs):
    """The conditions of some runs (Results): runs at one pressure, breakable or not, whose scenes are otherwise equal
    but for their seeds. Where nothing but the seed differs between all of them, each stands for itself."""
    cells = {}
    for run in runs:
        cells.setdefault((pressure_of(run), run.breakable, variant_of(run, runs)), []).append(run)
    if len(cells) == 1 and len(runs) > 1:
        return Selection([Condition(run.name, pressure_of(run), run.breakable, [run]) for run in runs])
    conditions = []
    for (pressure, breakable, variant), members in cells.items():
        members.sort(key=lambda run: run.case.get("seed") or 0)
        label = members[0].name if len(members) == 1 else variant or KINDS[breakable]
        conditions.append(Condition(label, pressure, breakable, members))
    return Selection(conditions)


def pressure_of(run):
    value = (run.case.get("preparation") or {}).get("confining_pressure")
    return None if value is None else float(value)


def variant_of(run, runs):
    """The keys by which this run differs from others at its pressure and of its kind."""
    peers = [flat(one.case) for one in runs if (pressure_of(one), one.breakable) == (pressure_of(run), run.breakable)]
    mine = flat(run.case)
    varied = [key for key in sorted(mine) if not key.startswith(FREE_KEYS)
              and any(str(peer.get(key)) != str(mine[key]) for peer in peers)]
    return ", ".join(f"{key.rpartition('.')[2].replace('_', ' ')} {mine[key]}" for key in varied)
