#!/usr/bin/python3
"""Sums the JUnit files of a folder, shows what failed, and ends with `N passed, N failed`.

usage: tests/count_results.py DIR [--only PREFIX...]
Each run left NAME.code (its exit code), NAME.log, and NAME.xml if it came to its tests.
"""
import sys
import xml.etree.ElementTree as xml
from pathlib import Path


def count(path):
    """(passed, [(name, output)], skipped) of one JUnit file; None if it cannot be read."""
    try:
        cases = list(xml.parse(path).getroot().iter("testcase"))
    except (OSError, xml.ParseError):
        return None
    passed, failed, skipped = 0, [], 0
    for case in cases:
        problem = next((case.find(tag) for tag in ("failure", "error") if case.find(tag) is not None), None)
        name = f"{case.get('classname', '')} {case.get('name', '')}".strip()
        if problem is not None or case.get("status") in ("fail", "notrun"):
            output = (problem.text if problem is not None else "") or case.findtext("system-out") or ""
            failed.append((name, output))
        elif case.find("skipped") is not None or case.get("status") == "disabled":
            skipped += 1
        else:
            passed += 1
    return passed, failed, skipped


def main(directory, only):
    passed = failed = 0
    for path in sorted(directory.glob("*.code")):
        name, code = path.stem, int(path.read_text())
        if only and not name.startswith(only):
            continue
        counted = count(directory / f"{name}.xml")
        log = directory / f"{name}.log"
        if counted is None or (code != 0 and not counted[1]) or counted[0] + len(counted[1]) == 0:
            # The runner itself went wrong (or found no test): that is one failure, with all that it said.
            print(f"-- {name} did not run its tests (exit code {code}):")
            print(log.read_text(errors="replace")[-8000:] if log.exists() else "no output")
            passed += counted[0] if counted else 0
            failed += 1
            continue
        for test, output in counted[1]:
            print(f"-- FAILED {name}: {test}\n{output[-4000:]}")
        print(f"   {name}: {counted[0]} passed, {len(counted[1])} failed, {counted[2]} skipped")
        passed += counted[0]
        failed += len(counted[1])
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), tuple(sys.argv[3:])))
