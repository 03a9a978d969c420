"""Nothing is lost, and what is damaged is refused: short parts of what tests/robustness/lost does by the hundred."""
import subprocess
import sys

import h5py
import pytest

import synthetic
from conftest import REPOSITORY
from rockbreak.command_line import is_concluded
from rockbreak.errors import IO_FAILURE, RockbreakError
from rockbreak.run.child import binaries, executable
from rockbreak.run.ledger import Ledger, read_ledger
from rockbreak.run.run_directory import RunDirectory, is_valid, write_text
from rockbreak.sealed import open_sealed

sys.path.insert(0, str(REPOSITORY / "tests" / "robustness" / "lost"))
from lost_damage import KINDS, PROGRAMS, Bench  # noqa: E402
from lost_faults import Sweep  # noqa: E402
from lost_kills import Campaign  # noqa: E402
from lost_power import LEFT, PowerCuts  # noqa: E402

FULL_DEVICE = "/dev/full"  # every write to it finds no space


def test_killed_at_random_and_resumed_a_run_is_the_uninterrupted_one(tmp_path):
    campaign = Campaign(tmp_path, 1, ["resident", "oneshot"], report=False, overrides=["shear.axial_strain=0.02"])
    campaign.uninterrupted()
    while campaign.kills < 12 and not campaign.faults:
        campaign.one_run(12)
    assert campaign.faults == []
    assert campaign.kills == 12 and campaign.runs >= 1 and len(campaign.counts["phase"]) >= 2


def test_ended_by_signals_at_random_and_resumed_a_run_is_the_uninterrupted_one(tmp_path):
    campaign = Campaign(tmp_path, 2, ["resident", "oneshot"], report=False, overrides=["shear.axial_strain=0.02"],
                        signals=["term", "int"])
    campaign.uninterrupted()
    while campaign.kills < 6 and not campaign.faults:
        campaign.one_run(6)
    assert campaign.faults == []
    assert campaign.kills == 6 and set(campaign.counts["signal"]) == {"term", "int"}


def test_after_a_power_cut_the_resumed_run_is_the_uninterrupted_one(tmp_path):
    cuts = PowerCuts(tmp_path, 1)
    for _ in range(8):
        cuts.one()
    assert cuts.faults == [] and all(cuts.counts[kind] > 0 for kind in LEFT)


def test_damaged_files_are_refused_made_anew_or_read_as_written_by_each_program(tmp_path):
    bench = Bench(tmp_path, 1)
    for n, kind in enumerate(KINDS):
        bench.one(PROGRAMS[n % 3], kind)
    bench.one("report", "bit flipped")
    assert bench.faults == [] and sum(bench.counts.values()) == len(KINDS) + 1
    assert bench.counts["report: refused"] == 1


def test_a_call_that_fails_ends_the_run_with_the_name_of_its_file_and_nothing_half(tmp_path):
    sweep = Sweep(tmp_path, durability="every")
    for name, kind, n in (("dem", "nospace", 2), ("dem", "again", 3), ("driver", "nospace", 4), ("xfem", "device", 4),
                          ("driver", "nospace", 9), ("dem", "short", 12), ("xfem", "again", 2), ("xfem", "kill", 10)):
        assert sweep.one(name, kind, n, "resident")
    assert sweep.faults == [] and sum(sweep.counts.values()) == 8


def test_random_damage_is_refused_by_name_or_read_as_what_was_written(tmp_path):
    run = tmp_path / "run"
    subprocess.run([executable("dem"), "run",
                    REPOSITORY / "tests" / "robustness" / "golden" / "scene.yaml", "--out", run, "--until-frame", "0"],
                   check=True, capture_output=True)
    found = subprocess.run([binaries() / "tests" / "damage", run / "frames" / "000000.h5",
                            "--count", "400"], capture_output=True, text=True, check=False)
    assert found.returncode == 0 and "400 copies, 0 wrong" in found.stdout, found.stdout


@pytest.fixture
def frame(tmp_path):
    return synthetic.write_run(tmp_path / "run", frames=2) / "frames" / "000001.h5"


@pytest.mark.parametrize("damage, says", [
    (lambda content: content[:100] + bytes([content[100] ^ 4]) + content[101:], "do not match the checksum"),
    (lambda content: content[:-1], "cut short"),
    (lambda content: content[:-24], "cut short"),
    (lambda content: b"", "cut short"),
    (lambda content: content[:-3] + bytes(3), "do not match the checksum"),
], ids=["flipped", "one_byte_short", "without_seal", "empty", "seal_zeroed"])
def test_a_damaged_file_never_reaches_the_hdf5_library(frame, damage, says, monkeypatch):
    frame.write_bytes(damage(frame.read_bytes()))
    monkeypatch.setattr(h5py, "File", lambda *_: pytest.fail("HDF5 was let at it"))
    with pytest.raises(RockbreakError, match=says) as error:
        open_sealed(frame)
    assert str(frame) in str(error.value) and error.value.code == IO_FAILURE
    assert not is_valid(frame)


def test_a_ledger_that_cannot_grow_says_so_and_keeps_its_lines_whole(tmp_path, monkeypatch):
    path = tmp_path / "run.jsonl"
    with Ledger(path) as ledger:
        ledger.write("frame", frame=0)

        class Filling:
            """Takes five bytes, then is full."""
            fileno = ledger._file.fileno

            def write(self, data, _room=[5]):
                taken, _room[0] = _room[0], 0
                if taken == 0:
                    raise OSError(28, "No space left on device")
                return real.write(data[:taken])

            def close(self):
                real.close()
        real, ledger._file = ledger._file, Filling()
        with pytest.raises(RockbreakError, match="run.jsonl: cannot write: No space left on device") as error:
            ledger.write("frame", frame=1)
        ledger._file = real
        ledger.write("end", code=error.value.code)
    assert [event["event"] for event in read_ledger(path)] == ["frame", "end"]
    assert read_ledger(path)[-1]["code"] == IO_FAILURE


def test_a_text_that_finds_no_space_leaves_the_old_one(tmp_path):
    path = tmp_path / "summary.json"
    write_text(path, "old")
    (tmp_path / "summary.json.tmp").symlink_to(FULL_DEVICE)
    with pytest.raises(RockbreakError, match="summary.json: cannot write: No space left on device"):
        write_text(path, "new")
    assert path.read_text() == "old" and not (tmp_path / "summary.json.tmp").is_symlink()


def test_what_was_concluded_is_told_by_the_ledger_not_by_clocks(tmp_path):
    directory = RunDirectory(synthetic.write_run(tmp_path / "run", frames=2))
    assert not is_concluded(directory, with_report=True) and not is_concluded(directory, with_report=False)
    directory.summary_file.write_text("{}")
    directory.report_file.write_text("")
    with Ledger(directory.ledger_file) as ledger:
        ledger.write("report", path="report.html")
        assert is_concluded(directory, with_report=True) and is_concluded(directory, with_report=False)
        ledger.write("frame", frame=1)  # made again; its file may well be older than the report
        assert not is_concluded(directory, with_report=True)
