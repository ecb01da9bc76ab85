"""What stands behind --key=value on the command line: the one parser of it, by type, unit and range.

An experiment declares its options once, as the fields of a dataclass `Settings`: option() for one value, numbers() and
names() for a list, switch() for 0 or 1, a Literal for a choice. What does not fit is refused before anything is touched,
with the key, the value and what is allowed.
"""

import re
import sys
from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING, Field, field, fields
from typing import Any, TypeVar, get_args, get_origin

Options = TypeVar("Options")
Known = Iterable[str] | Callable[[], Iterable[str]]

# The longest that anything is delayed (ms), as in MMTNetworkConditions, and the longest that anything is played (s).
LONGEST_DELAY_MS, LONGEST_S = 10_000.0, 100_000.0
# Every whole number up to here is a double of its own, as the words of tests/shared/teleop_words.cpp need.
LARGEST_SEED = 2**53
_WHOLE = re.compile(r"[+-]?[0-9]+")
_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?")
_WITHOUT_DIMENSION = ("", "factor", "share", "count")


class Refused(ValueError):
    """The command asks for what there is not; nothing has been changed. The exit code is 2."""


def option(default: Any, unit: str = "", least: float = 0.0, most: float = LONGEST_S) -> Any:
    """A field that counts in `unit`: "ms", "m"; "factor", "share" and "count" have no dimension. Both ends are allowed."""
    return field(default=default, metadata={"unit": unit, "least": least, "most": most})


def seconds(default: float, least: float = 0.001, most: float = LONGEST_S) -> Any:
    """How long something is played."""
    return option(default, "s", least, most)


def seed(default: int = 1) -> Any:
    return option(default, "count", 0, LARGEST_SEED)


def numbers(default: Iterable[float], unit: str, least: float = 0.0, most: float = LONGEST_S, was: str = "") -> Any:
    """A tuple of numbers, written 0,25,50. `was`: the name that the option had."""
    return field(default=tuple(default), metadata={"unit": unit, "least": least, "most": most, "was": was})


def names(default: Iterable[str] | None, among: Known) -> Any:
    """A tuple of names, written one,two; `all`, and the default None, stands for all of them."""
    return field(default=tuple(default) if default is not None else ALL, metadata={"unit": "", "among": among})


def name(default: str, among: Known) -> Any:
    """One name of those."""
    return field(default=default, metadata={"unit": "", "among": among})


def text(default: str = "") -> Any:
    """A text that only who takes it can judge."""
    return field(default=default, metadata={"unit": "", "free": True})


def pairs() -> Any:
    """Words of another program, written KEY=VALUE,KEY=VALUE; nothing written: none."""
    return field(default_factory=dict, metadata={"unit": ""})


def switch(default: bool) -> Any:
    return field(default=default, metadata={"unit": ""})


ALL = ("all",)


def unit_of(one: Field) -> str:
    return one.metadata.get("unit", "")


def of_words(words: Iterable[str]) -> dict[str, str]:
    """--key=value …, each key once."""
    found: dict[str, str] = {}
    for word in words:
        key, equals, value = word.removeprefix("--").partition("=")
        if not word.startswith("--") or not equals or not key:
            raise Refused(f"{word!r} is not --key=value")
        if key in found:
            raise Refused(f"--{key} is given twice, as {found[key]!r} and as {value!r}: say it once")
        found[key] = value
    return found


def parse(kind: type[Options], given: Mapping[str, str]) -> Options:
    """`kind` is a dataclass whose fields have their defaults."""
    known = {field.name: field for field in fields(kind)}  # type: ignore[arg-type]
    given = _renamed(known.values(), given)
    unknown = sorted(set(given) - set(known))
    if unknown:
        raise Refused(f"unknown option --{unknown[0]}; there are: {', '.join(f'--{name}' for name in known)}")
    values = {name: _value(one, given[name]) if name in given else _default(one) for name, one in known.items()}
    return kind(**values)


def _renamed(known: Iterable[Field], given: Mapping[str, str]) -> Mapping[str, str]:
    """Options under their former names, each with a warning, as CHANGELOG.md promises."""
    now = {one.metadata["was"]: one.name for one in known if one.metadata.get("was")}
    found: dict[str, str] = {}
    for key, value in given.items():
        name = now.get(key, key)
        if name in found or (name != key and name in given):
            raise Refused(f"--{key} is the former name of --{name}, and both are given: say it once")
        if name != key:
            print(f"--{key} is --{name} now. The old name still works: write the new one before it is dropped, see CHANGELOG.md.", file=sys.stderr)
        found[name] = value
    return found


def words(settings: Any) -> str:
    """All options with the values that they have, as they are given."""
    return " ".join(f"--{one.name}={_written(getattr(settings, one.name))}" for one in fields(settings))


def _written(value: object) -> str:
    if isinstance(value, bool):
        return str(int(value))
    if isinstance(value, Mapping):
        return ",".join(f"{key}={one}" for key, one in value.items())
    return ",".join(map(str, value)) if isinstance(value, tuple) else str(value)


def allowed(one: Field) -> str:
    """What may stand behind the key, in words."""
    kind, among = one.type, one.metadata.get("among")
    if get_origin(kind) is dict:
        return "KEY=VALUE separated by commas, each KEY once"
    if among is not None:
        several = "names separated by commas, or all; there are " if get_origin(kind) is tuple else "one of "
        return several + ", ".join(_known(one))
    if get_args(kind) and get_origin(kind) is not tuple:
        return "one of " + ", ".join(map(str, get_args(kind)))
    if kind is bool:
        return "0 or 1"
    if kind is str:
        return "a text"
    number = "a whole number" if int in (kind, *get_args(kind)) else "a number"
    number = f"{number}s separated by commas, each".replace("a ", "", 1) if get_origin(kind) is tuple else number
    unit = unit_of(one)
    least, most = _range(one)
    said = f"{number} from {least:.16g} to {most:.16g}"
    return said if unit in _WITHOUT_DIMENSION else f"{said} ({unit}, which is not written)"


def _default(one: Field) -> object:
    if one.default_factory is not MISSING:
        return one.default_factory()
    if one.default is MISSING:
        raise TypeError(f"the option {one.name} has no default")
    return tuple(_known(one)) if one.default is ALL else one.default


def _value(one: Field, given: str) -> object:
    try:
        return _read(one, given)
    except ValueError as error:
        why = f" ({error})" if str(error) else ""
        raise Refused(f"--{one.name}={given} is refused{why}: it must be {allowed(one)}") from None


def _read(one: Field, given: str) -> object:
    kind = one.type
    if get_origin(kind) is dict:
        return _pairs(given)
    if get_origin(kind) is tuple:
        return _list(one, given)
    if "among" in one.metadata:
        return _one_of(given, _known(one))
    if get_args(kind):
        return _one_of(given, get_args(kind))
    if kind is bool:
        return _one_of(given, ("0", "1")) == "1"
    if kind is str:
        if not one.metadata.get("free") and not given:
            raise ValueError("nothing is written")
        return given
    return _number(one, kind, given)


def _list(one: Field, given: str) -> tuple:
    if "among" in one.metadata and given == "all":
        return tuple(_known(one))
    kind = get_args(one.type)[0]
    found: list[object] = []
    for part in given.split(","):
        value = _one_of(part, _known(one)) if "among" in one.metadata else _number(one, kind, part)
        if value in found:
            raise ValueError(f"{part} is there twice")
        found.append(value)
    return tuple(found)


def _pairs(given: str) -> dict[str, str]:
    found: dict[str, str] = {}
    for pair in given.split(",") if given else ():
        key, equals, value = pair.partition("=")
        if not equals or not key or not value or key in found:
            raise ValueError(f"{pair!r} is none")
        found[key] = value
    return found


def _one_of(given: str, choices: Iterable[str]) -> str:
    if given not in choices:
        raise ValueError(f"there is no {given!r}")
    return given


def _number(one: Field, kind: object, given: str) -> float | int:
    if not (_WHOLE if kind is int else _NUMBER).fullmatch(given):
        raise ValueError
    value = int(given) if kind is int else float(given)
    least, most = _range(one)
    if not least <= value <= most:
        raise ValueError
    return value


def _range(one: Field) -> tuple[float, float]:
    """Of a field that says none: every whole number that a double tells from its neighbors."""
    return one.metadata.get("least", -LARGEST_SEED), one.metadata.get("most", LARGEST_SEED)


def _known(one: Field) -> tuple[str, ...]:
    among = one.metadata["among"]
    return tuple(among() if callable(among) else among)
