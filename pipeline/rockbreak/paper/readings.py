"""What the samples say of a sentence, and whether another reading of it would say something else.

The paper's figures and its Table 3 are at the peak of strength, which at 2 MPa is 10 % strain; the peak of our runs
scatters over strain, so that twins are compared at 10 %. What the other stage, or 7 %, would say is told where it
differs. Stresses of particles are read in two ways (measures/stresses.py).
"""
from .evidence import ORDER
from .verdicts import UNDECIDABLE
from ..measures.classes import HELD

STAGES = {"at 7 %": "7 %", "at 10 %": "10 %", "at the peak": "peak"}
PEAK = ("10 %", "peak")  # what the paper calls so


def finding(parts, samples):
    """(ours in words, verdict, reason) of the parts of one sentence."""
    pieces = [piece for part in parts for piece in part.pieces(samples)]
    if not pieces:
        return "–", UNDECIDABLE, "our runs do not have it"
    worst = max((piece.verdict for piece in pieces), key=ORDER.index)
    reasons = [piece.reason for piece in pieces if piece.verdict == worst]
    notes = [piece.note for piece in pieces if piece.note]
    return "; ".join(piece.text for piece in pieces if piece.text), worst, ", ".join(dict.fromkeys(reasons + notes))


def other_readings(parts, samples):
    """(reading, verdict, reason) of every other reading of these parts that gives another verdict than they do."""
    readings = {words: tuple(at_stage(part, column, samples) for part in parts) for words, column in STAGES.items()}
    readings["stresses with two contacts held"] = tuple(
        part._replace(quantity=part.quantity + HELD) if part.quantity.endswith("_stresses") else part for part in parts)
    kind = finding(parts, samples)[1]
    found = [(words, *finding(other, samples)[1:]) for words, other in readings.items() if other != tuple(parts)]
    return [one for one in found if one[1] not in (kind, UNDECIDABLE)]


def at_stage(part, column, samples):
    """The part at another stage; itself where it does not speak of the peak or the runs lack the number."""
    other = part._replace(column=column) if getattr(part, "column", None) in PEAK else part
    return other if other.pieces(samples) else part
