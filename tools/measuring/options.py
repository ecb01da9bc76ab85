"""What stands behind --key=value on the command line, checked against what an experiment understands."""

from collections.abc import Mapping
from dataclasses import Field, field, fields
from typing import Any, TypeVar, get_args

Options = TypeVar("Options")


class Refused(ValueError):
    """The command asks for what there is not; nothing has been changed. The exit code is 2."""


def option(default: float, unit: str) -> Any:
    """A field of such a dataclass that counts in `unit`: "ms", "m"; "factor" and "share" (0 … 1) have no dimension."""
    return field(default=default, metadata={"unit": unit})


def unit_of(one: Field) -> str:
    return one.metadata.get("unit", "")


def parse(kind: type[Options], given: Mapping[str, str]) -> Options:
    """`kind` is a dataclass whose fields are bool, int, float, str or a Literal, each with its default."""
    known = {field.name: field for field in fields(kind)}  # type: ignore[arg-type]
    unknown = sorted(set(given) - set(known))
    if unknown:
        raise Refused(f"unknown option --{unknown[0]}; there are: {', '.join(f'--{name}' for name in known)}")
    return kind(**{name: _value(name, known[name].type, text) for name, text in given.items()})


def _value(name: str, kind: object, text: str) -> object:
    choices = get_args(kind)
    if choices:
        if text not in choices:
            raise Refused(f"--{name}={text} is not one of {', '.join(choices)}")
        return text
    try:
        return kind(text)  # type: ignore[operator]
    except ValueError:
        raise Refused(f"--{name}={text} is not a number") from None
