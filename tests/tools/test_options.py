"""--key=value of an experiment."""

from dataclasses import dataclass
from typing import Literal

import pytest

from measuring import options


@dataclass(frozen=True)
class Settings:
    seconds: float = 10.0
    rounds: int = 3
    clock: Literal["real", "stepped"] = "real"


def test_what_is_not_given_keeps_its_default():
    assert options.parse(Settings, {"rounds": "1"}) == Settings(10.0, 1, "real")


def test_values_are_turned_into_the_kind_of_their_field():
    assert options.parse(Settings, {"seconds": "2.5", "clock": "stepped"}) == Settings(2.5, 3, "stepped")


def test_an_unknown_key_is_refused_with_those_there_are():
    with pytest.raises(ValueError, match="--second.*--seconds"):
        options.parse(Settings, {"second": "1"})


def test_a_word_where_a_number_belongs_is_refused():
    with pytest.raises(ValueError, match="--rounds=many is not a number"):
        options.parse(Settings, {"rounds": "many"})


def test_only_the_choices_of_a_field_are_taken():
    with pytest.raises(ValueError, match="--clock=fast is not one of real, stepped"):
        options.parse(Settings, {"clock": "fast"})
