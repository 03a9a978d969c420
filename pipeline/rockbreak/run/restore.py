"""Frames that are lost or damaged although later ones stand: a machine that goes down keeps some of the files of its
last seconds and loses others, in any order; a disk spoils older ones."""
import os
import shutil
from pathlib import Path

from ..errors import BAD_INPUT, NUMERICAL_FAILURE, RockbreakError, cannot
from ..sealed import is_sealed
from .run_directory import RunDirectory, attributes, make_folder


def restore_frame(run, k, expected):
    """Makes frame k anew, by a `dem` that goes on from the frame and split before it, or from the prepared sample, in a
    folder of its own. `expected`: its payload hash, None if nobody knows it. Returns its payload hash."""
    directory, scratch = run.directory, RunDirectory(run.directory.restoring)
    run.child_event("driver", {"event": "warning", "text": f"frames/{k:06d}.h5 is lost or damaged; it is made anew"})
    try:
        begin_from(directory, scratch, k)
        run.start("dem", [*run.dem_arguments(scratch.path), "--until-frame", str(k)]).finish()
        found = require_same(scratch.frame_file(k), expected)
        take_over(scratch.frame_file(k), directory.frame_file(k))
        sample = Path("prepared", "sample.h5")
        if (scratch.path / sample).exists() and not is_sealed(directory.path / sample):
            take_over(scratch.path / sample, directory.path / sample)
    except RockbreakError as error:
        if error.code == NUMERICAL_FAILURE:  # its message names a file in there
            raise
        shutil.rmtree(scratch.path, ignore_errors=True)
        raise
    shutil.rmtree(scratch.path, ignore_errors=True)
    return found


def require_same(path, expected):
    """The payload hash of a frame or split that was made anew; refused and removed if later ones stand on another."""
    found = attributes(path).get("payload_hash")
    if expected not in (None, found):
        path.unlink()
        raise RockbreakError(BAD_INPUT, f"{path.parent.name}/{path.name} is lost or damaged; made anew it has the payload "
                             f"{found}, expected {expected}, on which later ones stand. Another version of dem or xfem "
                             "has made those: resume with that one, or remove this frame, its split and all later ones")
    return found


def begin_from(directory, scratch, k):
    """Copies what frame k is made from."""
    shutil.rmtree(scratch.path, ignore_errors=True)
    before = [directory.frame_file(k - 1), directory.split_file(k - 1)] if k else sorted(
        (directory.path / "prepared").glob("*.h5"))
    for file in [directory.case_file, *filter(os.path.exists, before)]:
        target = scratch.path / file.relative_to(directory.path)
        make_folder(target.parent)
        try:
            shutil.copyfile(file, target)
        except OSError as error:
            raise cannot("write", target, error) from error


def take_over(source, target):
    """Moves a file, whose folder may be on another disk, to its place at once."""
    temporary = target.with_name(target.name + ".tmp")
    try:
        shutil.move(source, temporary)
        os.replace(temporary, target)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise cannot("write", target, error) from error
