"""Campaign and study files (YAML) with every scalar kept as it was written, and checks that name file, key, found and
expected.

A value of a scene goes on to `dem` word by word (`--set key=value`), so that one specification alone decides what it
means: PyYAML would read 0.5e6 as text and 1e-3 as text, but 0.001 as a number.
"""
import difflib

import yaml

from .errors import BAD_INPUT, RockbreakError


class _TextLoader(yaml.BaseLoader):
    """Every scalar a string; a key given twice is refused."""

    def construct_mapping(self, node, deep=False):
        seen = {}
        for key, _ in node.value:
            if key.value in seen:
                raise yaml.constructor.ConstructorError(
                    None, None, f'duplicate key "{key.value}", first given in line {seen[key.value]}; expected each '
                    "key once", key.start_mark)
            seen[key.value] = key.start_mark.line + 1
        return super().construct_mapping(node, deep)


def read_mapping(path):
    """The mapping in a file."""
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise RockbreakError(BAD_INPUT, f"{path}: no such file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise RockbreakError(BAD_INPUT, f"{path}: unreadable: {error}") from error
    try:
        content = yaml.load(text, Loader=_TextLoader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        where = f":{mark.line + 1}:{mark.column + 1}" if mark else ""
        raise RockbreakError(BAD_INPUT, f"{path}{where}: {error.problem}") from error
    except yaml.YAMLError as error:
        raise RockbreakError(BAD_INPUT, f"{path}: {error}") from error
    if not isinstance(content, dict):
        raise RockbreakError(BAD_INPUT, f"{path}: found {described(content)}, expected a mapping of keys")
    return content


def described(value):
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, list):
        return "a list"
    return f'"{value}"' if value else "nothing"


class Section:
    """One mapping of a file. Each question about a key raises what is wrong with it."""

    def __init__(self, path, content, where=""):
        self.path = path
        self.content = content
        self.where = where

    def fail(self, key, text):
        name = f"{self.where}.{key}" if self.where and key else self.where or key
        raise RockbreakError(BAD_INPUT, f"{self.path}: {name}: {text}")

    def expected(self, key, value, expected):
        self.fail(key, f"found {described(value)}, expected {expected}")

    def only(self, *known):
        for key in self.content:
            if key not in known:
                close = difflib.get_close_matches(key, known, 1)
                self.fail(key, "unknown key; " + (f'did you mean "{close[0]}"?' if close
                                                  else f"expected one of {', '.join(known)}"))

    def text(self, key, default=None):
        value = self.content.get(key, default)
        if not isinstance(value, str) or not value:
            self.expected(key, value, "a text")
        return value

    def choice(self, key, allowed, default):
        value = self.content.get(key, default)
        if value not in allowed:
            self.expected(key, value, " or ".join(allowed))
        return value

    def flag(self, key, default):
        return self.choice(key, ("true", "false"), "true" if default else "false") == "true"

    def list(self, key, default=()):
        value = self.content.get(key, list(default))
        if not isinstance(value, list):
            self.expected(key, value, "a list")
        return value

    def mapping(self, key):
        value = self.content.get(key, {})
        if not isinstance(value, dict):
            self.expected(key, value, "a mapping")
        return Section(self.path, value, f"{self.where}.{key}" if self.where else key)

    def scene_keys(self):
        """This mapping as keys of a scene: dotted path -> text as `--set` takes it. Sections may be nested."""
        keys = {}

        def walk(content, prefix):
            for name, value in content.items():
                if isinstance(value, dict):
                    walk(value, f"{prefix}{name}.")
                elif prefix + name in keys:
                    self.fail(prefix + name, "found twice, as a dotted key and in its section; expected it once")
                elif value == "":
                    self.expected(prefix + name, value, "a value")
                else:
                    keys[prefix + name] = flow_text(value)

        walk(self.content, "")
        return keys


def flat(case, prefix=""):
    """Nested keys of a scene as dotted.key: value."""
    found = {}
    for key, value in case.items():
        found |= flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {prefix + key: value}
    return found


def flow_text(value):
    """A value as YAML on one line."""
    return f"[{', '.join(flow_text(item) for item in value)}]" if isinstance(value, list) else value
