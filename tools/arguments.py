"""The words behind ./run, held against a table of commands before anything is set up: tools/commands.py is that table."""

import difflib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from measuring.options import Refused

HELP = ("-h", "--help")
# What stands behind it is for the program that the command starts.
REST = "--"


@dataclass(frozen=True)
class Option:
    name: str  # with its dashes
    value: str = ""  # what stands behind "=", as the help writes it; empty: the option is a word of its own
    check: Callable[[str], object] = str  # raises ValueError where the value cannot be
    optional: bool = False  # the value may be left out


@dataclass(frozen=True)
class Given:
    words: tuple[str, ...] = ()
    options: Mapping[str, str] = field(default_factory=dict)  # by name; an option without a value has ""
    rest: tuple[str, ...] = ()  # for the program that is started
    raw: tuple[str, ...] = ()  # all of it, as it was written

    def has(self, option: str) -> bool:
        return option in self.options


@dataclass(frozen=True)
class Command:
    name: str
    help: Sequence[tuple[str, str]]  # what may follow the name, and what the command does then
    options: Callable[[tuple[str, ...]], Sequence[Option]] = lambda _: ()  # for these words, which have been checked
    words: Callable[[tuple[str, ...]], None] | None = None  # raises Refused where these words cannot be; None: it takes none
    together: Callable[[Given], None] = lambda _: None  # raises ValueError where words and options do not go together
    details: Callable[[tuple[str, ...]], str] = lambda _: ""  # more help, where the words name something that has some
    starts_program: bool = False  # takes what stands behind "--"


def usage(commands: Iterable[Command]) -> str:
    """All of them, one line a form."""
    lines = [(f"./run {command.name} {form}".rstrip(), what) for command in commands for form, what in command.help]
    width = max(len(form) for form, _ in lines) + 2
    return "".join(f"{form:{width}}{what}\n" for form, what in lines)


def asks_for_help(arguments: Sequence[str]) -> bool:
    return any(word in HELP for word in arguments[: _end(arguments)])


def read(command: Command, arguments: Sequence[str]) -> Given:
    """What was given, by kind; Refused with a line of advice where that cannot be."""
    end = _end(arguments)
    own, rest = arguments[:end], tuple(arguments[end + 1 :])
    words = tuple(word for word in own if not _is_option(word))
    try:
        if end < len(arguments) and not command.starts_program:
            raise Refused(f"nothing may stand behind {REST}: no program is started")
        if words and command.words is None:
            raise Refused(f"{words[0]!r} is too much: no words follow")
        if command.words is not None:
            command.words(words)
        options = _options(command.options(words), [word for word in own if _is_option(word)])
        given = Given(words, options, rest, tuple(arguments))
        command.together(given)
    except ValueError as error:
        raise Refused(f"./run {command.name}: {_sentence(error)} See ./run {command.name} --help") from None
    return given


def choose(given: str, known: Iterable[str], what: str) -> str:
    """One of the known names; Refused with the nearest ones, or with all."""
    names = list(known)
    if given in names:
        return given
    raise Refused(f"there is no {what} {given!r}{advice(given, names)}")


def advice(given: str, known: Sequence[str]) -> str:
    near = difflib.get_close_matches(given, known, n=1, cutoff=0.6)
    if near:
        return f": did you mean {near[0]}?"
    return f": choose from {', '.join(known)}" if known else ""


def _sentence(error: ValueError) -> str:
    text = str(error)
    return text if text.endswith(("?", ".")) else f"{text}."


def _end(arguments: Sequence[str]) -> int:
    return list(arguments).index(REST) if REST in arguments else len(arguments)


def _is_option(word: str) -> bool:
    return word.startswith("-") and word != "-"


def _options(known: Sequence[Option], given: Sequence[str]) -> dict[str, str]:
    by_name = {option.name: option for option in known}
    found: dict[str, str] = {}
    for word in given:
        name, equals, value = word.partition("=")
        if name not in by_name:
            raise Refused(f"there is no option {name}{advice(name, list(by_name)) or ': it takes none'}")
        if name in found:
            raise Refused(f"{name} is given twice: say it once")
        option = by_name[name]
        if equals and not option.value:
            raise Refused(f"{name} takes no value")
        if option.value and not equals and not option.optional:
            raise Refused(f"{name} needs a value: {name}={option.value}")
        if equals:
            option.check(value)
        found[name] = value
    return found
