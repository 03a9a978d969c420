"""Frames that are lost or damaged although later ones stand: a machine that goes down keeps some of the files of its
last seconds and loses others, in any order; a disk spoils older ones."""
import os
import shutil

from ..errors import BAD_INPUT, RockbreakError, cannot
from .run_directory import RunDirectory, attributes, make_folder


def restore_frame(run, k, expected):
    """Makes frame k anew, by a `dem` that goes on from the frame and split before it, or from the prepared sample, in a
    folder of its own. `expected`: payload hash that the ledger has of it, None if it does not know."""
    directory, scratch = run.directory, RunDirectory(run.directory.restoring)
    begin_from(directory, scratch, k)
    run.child_event("driver", {"event": "warning", "text": f"frames/{k:06d}.h5 is lost or damaged; it is made anew"})
    run.start("dem", ["run", str(scratch.case_file), "--out", str(scratch.path), "--resume", "--until-frame", str(k),
                      *run.threads()]).finish()
    found = attributes(scratch.frame_file(k)).get("payload_hash")
    if expected not in (None, found):
        raise RockbreakError(BAD_INPUT, f"{directory.frame_file(k)}: is lost or damaged, and what is made anew has the "
                             f"payload {found}, expected {expected} as in {directory.ledger_file.name}: this is "
                             f"another version of dem; remove frames {k} and later to go on with it from there")
    try:
        os.replace(scratch.frame_file(k), directory.frame_file(k))
    except OSError as error:
        raise cannot("write", directory.frame_file(k), error) from error
    shutil.rmtree(scratch.path, ignore_errors=True)


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
