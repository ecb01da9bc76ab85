"""A sweep as one file describes it: an experiment, the factors whose levels are all combined, and seeds (docs/experiments.md)."""

import dataclasses
import difflib
import hashlib
import importlib
import itertools
import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from measuring import options
from measuring.options import Refused

ENDINGS = (".toml", ".json")
MOST_RUNS = 100_000
KEYS = ("title", "experiment", "options", "factors", "repeats", "seeds", "measures", "x", "lines", "panels")


@dataclass(frozen=True)
class Run:
    experiment: str
    options: Mapping[str, str]

    @property
    def identity(self) -> str:
        """The same for the same run, whatever sweep asks for it."""
        text = json.dumps([self.experiment, sorted(self.options.items())])
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    def __str__(self) -> str:
        return " ".join([self.experiment, *(f"--{name}={value}" for name, value in self.options.items())])


@dataclass(frozen=True)
class Sweep:
    name: str
    title: str
    experiment: str
    options: Mapping[str, str]  # of every run
    factors: Mapping[str, tuple[str, ...]]  # their levels
    seeds: tuple[str, ...]  # none where the experiment has none
    measures: tuple[str, ...]  # keys of the summary that the report is about
    drawn: tuple[str, ...]  # factors along x, as lines, in panels; those that are left are averaged over

    @property
    def varied(self) -> tuple[str, ...]:
        return (*self.factors, "seed") if self.seeds else tuple(self.factors)

    def runs(self) -> list[Run]:
        """All combinations; the seeds change fastest, then the factor that is named last."""
        levels = [*self.factors.values(), *([self.seeds] if self.seeds else [])]
        chosen = [dict(zip(self.varied, one)) for one in itertools.product(*levels)]
        return [Run(self.experiment, {**self.options, **one}) for one in chosen]

    def values(self, run: Run) -> dict[str, object]:
        """What the experiment understands of the run's options: numbers are numbers, lists and pairs as they were written."""
        parsed = options.parse(settings(self.experiment), run.options)
        values = {name: getattr(parsed, name) for name in self.varied}
        return {name: run.options[name] if isinstance(value, (tuple, dict)) else value for name, value in values.items()}

    def column(self, name: str) -> str:
        """The name of a factor with its unit."""
        unit = _unit(self.experiment, name)
        return f"{name}_{unit}" if unit not in ("", "count") else name

    def label(self, name: str) -> str:
        unit = _unit(self.experiment, name)
        return f"{name.replace('_', ' ')} ({unit})" if unit not in ("", "factor", "share", "count") else name.replace("_", " ")

    def is_number(self, name: str) -> bool:
        return _fields(self.experiment)[name].type in (int, float)


def read(path: Path, experiments: list[str]) -> Sweep:
    try:
        text = path.read_text()
        given = tomllib.loads(text) if path.suffix == ".toml" else json.loads(text)
    except OSError as error:
        raise Refused(f"{path} cannot be read: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, json.JSONDecodeError, UnicodeDecodeError) as error:
        raise Refused(f"{path} is not in the form its ending promises: {error}") from None
    try:
        return _checked(path.stem, given, experiments)
    except ValueError as error:
        raise Refused(f"{path}: {error}") from None


def settings(experiment: str) -> type:
    return importlib.import_module(f"experiments.{experiment}").Settings


def like(name: str, known: list[str]) -> str:
    """What there is instead: the names that are nearest, or all."""
    near = difflib.get_close_matches(name, known, n=5, cutoff=0.5)
    return ", ".join(near or known[:20])


def _checked(name: str, given: object, experiments: list[str]) -> Sweep:
    if not isinstance(given, dict):
        raise Refused(f"a table is needed, with {', '.join(KEYS)}")
    for key in given:
        if key not in KEYS:
            raise Refused(f"unknown key {key!r}; there are: {', '.join(KEYS)}")
    experiment = given.get("experiment")
    if experiment not in experiments:
        raise Refused(f"experiment = {experiment!r} is none of {', '.join(experiments)}")
    common = {key: _text(key, value) for key, value in _table(given, "options").items()}
    factors = {key: _levels(f"factors.{key}", values) for key, values in _table(given, "factors").items()}
    for key in factors.keys() & common.keys():
        raise Refused(f"{key} is an option of all runs and a factor as well")
    for key in {"seed"} & (factors.keys() | common.keys()):
        raise Refused(f"{key}: say repeats = N, or seeds = [1, 2, …]")
    _check_truth_values(given, experiment)
    seeds = _seeds(given, experiment)
    measures = given.get("measures")
    if not isinstance(measures, list) or not measures or not all(isinstance(one, str) for one in measures):
        raise Refused("measures = [\"KEY\", …] must name what is reported: keys of the experiment's summary.json")
    sweep = Sweep(
        name, str(given.get("title", name)), experiment, common, factors, seeds, tuple(measures), _drawn(given, experiment, factors)
    )  # fmt: skip
    count = max(len(seeds), 1)
    for levels in factors.values():
        count *= len(levels)
    if count > MOST_RUNS:
        raise Refused(f"{count} runs are more than {MOST_RUNS}")
    # Each level on its own: what one option may be does not depend on the others.
    for key, levels in [(key, (value,)) for key, value in common.items()] + list(factors.items()) + [("seed", seeds)]:
        values = [getattr(options.parse(settings(experiment), {key: level}), key) for level in levels]
        if any(value in values[:place] for place, value in enumerate(values)):
            where = "seeds" if key == "seed" else f"factors.{key}"
            raise Refused(f"{where} has a level twice: {', '.join(levels)}")
    return sweep


def _table(given: dict, key: str) -> dict:
    found = given.get(key, {})
    if not isinstance(found, dict):
        raise Refused(f"{key} must be a table")
    return found


def _levels(key: str, values: object) -> tuple[str, ...]:
    if not isinstance(values, list) or not values:
        raise Refused(f"{key} must be a list of its levels")
    return tuple(_text(key, value) for value in values)


def _check_truth_values(given: dict, experiment: str) -> None:
    """`true` is 1 of a switch alone, and no number."""
    levels = {**{key: [value] for key, value in _table(given, "options").items()}, **_table(given, "factors")}
    for key, values in levels.items():
        field = _fields(experiment).get(key)
        if field is not None and field.type is not bool and any(isinstance(value, bool) for value in values):
            raise Refused(f"{key} = {str(next(value for value in values if isinstance(value, bool))).lower()} is refused: it must be {options.allowed(field)}")


def _text(key: str, value: object) -> str:
    """As it would stand behind --key= on the command line."""
    if isinstance(value, bool):
        return str(int(value))
    if not isinstance(value, (int, float, str)):
        raise Refused(f"{key} = {value!r} is neither a number nor a text")
    return str(value)


def _seeds(given: dict, experiment: str) -> tuple[str, ...]:
    if "repeats" in given and "seeds" in given:
        raise Refused("repeats and seeds: one of them says it")
    repeats = given.get("repeats", 1)
    if type(repeats) is not int or not 1 <= repeats <= MOST_RUNS:
        raise Refused(f"repeats = {repeats!r} is not a number from 1 to {MOST_RUNS}")
    seeds = given.get("seeds", list(range(1, repeats + 1)))
    if not isinstance(seeds, list) or not seeds or any(type(seed) is not int for seed in seeds):
        raise Refused("seeds must be a list of whole numbers")
    if "seed" not in _fields(experiment):
        if len(seeds) > 1:
            raise Refused(f"{experiment} has no --seed: it would be the same run {len(seeds)} times")
        return ()
    return _levels("seeds", seeds)


def _drawn(given: dict, experiment: str, factors: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
    """What is not said: along x the first factor that is a number, the others in their order."""
    said = [given[place] for place in ("x", "lines", "panels") if place in given]
    for name in said:
        if not isinstance(name, str) or name not in factors:
            raise Refused(f"{name!r} is drawn, but is none of the factors {', '.join(factors) or '(there are none)'}")
    if len(set(said)) < len(said):
        raise Refused("x, lines and panels must be three different factors")
    left = [name for name in factors if name not in said and len(factors[name]) > 1]
    left.sort(key=lambda name: name not in _fields(experiment) or _fields(experiment)[name].type not in (int, float))
    found = [given[place] if place in given else left.pop(0) if left else "" for place in ("x", "lines", "panels")]
    return tuple(name for name in found if name)


def _fields(experiment: str) -> dict[str, dataclasses.Field]:
    return {field.name: field for field in dataclasses.fields(settings(experiment))}


def _unit(experiment: str, name: str) -> str:
    return options.unit_of(_fields(experiment)[name])
