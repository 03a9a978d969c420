"""`dem explain` that only pretends: apart from the other fakes, because it is called often and must start fast."""
import sys
from pathlib import Path

import yaml


def resolved(arguments):
    """The scene with its `--set`; a key that the scene does not have is refused, as by `dem`."""
    case = yaml.safe_load(Path(arguments[1]).read_text())
    for word, override in zip(arguments, arguments[1:]):
        if word != "--set":
            continue
        key, _, value = override.partition("=")
        section, _, name = key.rpartition(".")
        place = case.get(section) if section else case
        if place is None or (name not in place and key != "preparation.from"):
            print(f'dem: error: --set {override}: unknown key "{name}"', file=sys.stderr)
            sys.exit(2)
        place[name] = yaml.safe_load(value)
    return case


if __name__ == "__main__":
    print(yaml.safe_dump(resolved(sys.argv[1:])))
