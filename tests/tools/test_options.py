"""--key=value: one parser, by type, unit and range."""

from dataclasses import dataclass
from typing import Literal

import pytest

from measuring import options
from measuring.options import Refused


@dataclass(frozen=True)
class Settings:
    seconds: float = options.seconds(10.0)
    rounds: int = options.option(3, "count", 1, 1000)
    clock: Literal["real", "stepped"] = "real"
    delays: tuple[int, ...] = options.numbers((0, 50), "ms", 0, 10_000, was="waits")
    ways: tuple[str, ...] = options.names(None, lambda: {"one": 1, "two": 2})
    pictures: bool = options.switch(True)
    set: dict[str, str] = options.pairs()


DEFAULT = Settings(10.0, 3, "real", (0, 50), ("one", "two"), True, {})


def test_what_is_not_given_keeps_its_default():
    assert options.parse(Settings, {}) == DEFAULT
    assert options.parse(Settings, {"rounds": "1"}).rounds == 1


def test_values_are_turned_into_the_kind_of_their_field():
    given = {"seconds": "2.5", "clock": "stepped", "delays": "100,5", "ways": "two", "pictures": "0", "set": "a=1,b=x"}
    expected = Settings(2.5, 3, "stepped", (100, 5), ("two",), False, {"a": "1", "b": "x"})
    assert options.parse(Settings, given) == expected


def test_a_former_name_works_and_names_the_new_one(capsys):
    assert options.parse(Settings, {"waits": "5"}).delays == (5,)
    assert capsys.readouterr().err.startswith("--waits is --delays now.")
    with pytest.raises(options.Refused, match="--waits is the former name of --delays, and both are given"):
        options.parse(Settings, {"waits": "5", "delays": "5"})


def test_all_names_are_all_there_are():
    assert options.parse(Settings, {"ways": "all"}).ways == ("one", "two")


@pytest.mark.parametrize(("given", "value"), [("1e1", 10.0), ("0.001", 0.001), ("100000", 1e5), ("+5.", 5.0), (".5", 0.5)])
def test_both_ends_and_every_way_to_write_a_number(given, value):
    assert options.parse(Settings, {"seconds": given}).seconds == value


@pytest.mark.parametrize(
    ("key", "value", "allowed"),
    [
        ("seconds", "many", r"a number from 0.001 to 100000 \(s, which is not written\)"),
        ("seconds", "nan", "a number from"), ("seconds", "inf", "a number from"), ("seconds", "-1", "a number from"),
        ("seconds", "0", "a number from"), ("seconds", "1e300", "a number from"), ("seconds", "", "a number from"),
        ("seconds", "10s", "a number from"), ("seconds", "1_0", "a number from"), ("seconds", "٣", "a number from"),
        ("seconds", " 5", "a number from"), ("seconds", "5O", "a number from"),
        ("rounds", "1.5", "a whole number from 1 to 1000"), ("rounds", "0", "a whole number"), ("rounds", "4294967297", "a whole number"),
        ("clock", "fast", "one of real, stepped"), ("clock", "Stepped", "one of real, stepped"),
        ("delays", "0,abc", "whole numbers separated by commas, each from 0 to 10000"), ("delays", "0,,5", "whole numbers"),
        ("delays", "", "whole numbers"), ("delays", "50,50", "whole numbers"), ("delays", "5,-1", "whole numbers"),
        ("ways", "three", "names separated by commas, or all; there are one, two"), ("ways", "", "names"), ("ways", "one,one", "names"),
        ("pictures", "true", "0 or 1"), ("pictures", "2", "0 or 1"), ("pictures", "", "0 or 1"),
        ("set", "a", "KEY=VALUE"), ("set", "a=1,a=2", "KEY=VALUE"), ("set", "=1", "KEY=VALUE"), ("set", "a=", "KEY=VALUE"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused_with_its_key_and_what_is_allowed(key, value, allowed):
    with pytest.raises(Refused, match=f"^--{key}={value} is refused.*it must be {allowed}"):
        options.parse(Settings, {key: value})


def test_an_unknown_key_is_refused_with_those_there_are():
    with pytest.raises(Refused, match="--second.*--seconds"):
        options.parse(Settings, {"second": "1"})


def test_words_are_keys_and_values_each_once():
    assert options.of_words(["--a=1", "--b=c=d"]) == {"a": "1", "b": "c=d"}
    for words, why in [(["--a=1", "--a=2"], "given twice"), (["a=1"], "is not --key"), (["--a"], "is not --key"), (["--=1"], "is not --key")]:
        with pytest.raises(Refused, match=why):
            options.of_words(words)


def test_a_number_that_says_no_range_has_that_of_whole_doubles():
    @dataclass(frozen=True)
    class Plain:
        seed: int = 1

    assert options.parse(Plain, {"seed": "-5"}).seed == -5
    with pytest.raises(Refused, match="from -9007199254740992 to 9007199254740992"):
        options.parse(Plain, {"seed": "9007199254740993"})
