import json

import pytest

from rockbreak.errors import RockbreakError
from rockbreak.run.ledger import Ledger, coupling_overhead, read_ledger, seconds_per_phase


def test_events_come_back_in_order(tmp_path):
    with Ledger(tmp_path / "run.jsonl") as ledger:
        ledger.write("frame", frame=0, seconds={"dem": 1.5})
        ledger.write("split", frame=0, broken=3)
    with Ledger(tmp_path / "run.jsonl") as ledger:
        ledger.write("end", code=0)
    events = read_ledger(tmp_path / "run.jsonl")
    assert [event["event"] for event in events] == ["frame", "split", "end"]
    assert events[1]["broken"] == 3 and all(event["time"] > 1e9 for event in events)


def test_every_event_is_on_disk_at_once(tmp_path):
    ledger = Ledger(tmp_path / "run.jsonl")
    ledger.write("frame", frame=0)
    assert json.loads((tmp_path / "run.jsonl").read_text())["frame"] == 0
    ledger.close()


@pytest.mark.parametrize("kept", [1, 5, 20])
def test_a_half_written_last_line_is_left_out_and_cut_off_before_the_next_event(tmp_path, kept):
    path = tmp_path / "run.jsonl"
    with Ledger(path) as ledger:
        ledger.write("frame", frame=0)
        ledger.write("frame", frame=1)
    lines = path.read_text().splitlines(keepends=True)
    path.write_text(lines[0] + lines[1][:kept])
    assert [event["frame"] for event in read_ledger(path)] == [0]
    with Ledger(path) as ledger:
        ledger.write("frame", frame=2)
    assert [event["frame"] for event in read_ledger(path)] == [0, 2]


def test_a_damaged_line_in_the_middle_is_named(tmp_path):
    path = tmp_path / "run.jsonl"
    path.write_text('{"event": "frame"}\n{"eve\n{"event": "end"}\n')
    with pytest.raises(RockbreakError, match="run.jsonl:2"):
        read_ledger(path)


def test_a_missing_ledger_has_no_events(tmp_path):
    assert read_ledger(tmp_path / "run.jsonl") == []


def test_seconds_are_summed_per_phase_over_all_resumptions():
    events = [{"event": "frame", "seconds": {"dem": 1.0}},
              {"event": "split", "seconds": {"xfem": 0.5, "handover": 0.1}}, {"event": "end"},
              {"event": "frame", "seconds": {"dem": 2.0}}, {"event": "report", "seconds": {"report": 4}}]
    assert seconds_per_phase(events) == {"dem": 3.0, "xfem": 0.5, "handover": 0.1, "report": 4.0, "total": 7.6}


def test_the_coupling_overhead_is_what_is_neither_stepping_nor_solving():
    """By hand: of 20 + 5 s, 14 + 2 s are stepping and preparation, 4 s are solving; a killed start tells nothing."""
    dem = {"preparation": 6.0, "shear": 8.0, "write": 1.0, "apply": 0.5, "exchange": 5.0}
    xfem = {"loads": 1.0, "analysis": 3.0, "read": 0.5, "write": 0.25, "total": 4.75}
    events = [{"event": "end", "code": 143}, {"event": "frame", "seconds": {"dem": 100.0}},
              {"event": "end", "code": 0, "phases": {"wall": 20.0, "dem": dem, "xfem": xfem}},
              {"event": "end", "code": 0, "phases": {"wall": 5.0, "dem": {"shear": 2.0, "write": 1.0}}}]
    assert coupling_overhead(events) == pytest.approx((20 + 5 - 16 - 4) / 25)
    assert coupling_overhead(events[:2]) is None
    assert coupling_overhead([{"event": "end", "code": 0, "phases": {"wall": 0.0}}]) is None
