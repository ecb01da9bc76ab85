"""Tables of the documents that a command makes: each says which command, and a sample that changes each day still holds."""

import importlib
import math
import random
from collections.abc import Callable
from datetime import date
from pathlib import Path

import pytest

from doc_tables import make, pages, words
from doc_tables.tables import DYNAMIC, TABLES
from measuring import teleop_runs
from setup import cache

# Cases that a row needs together, by the table; no text: none needs it.
_TOGETHER: dict[str, Callable[[str], str]] = {
    "static_errors": lambda case: case,
    "dynamic_schemes": lambda case: case if case.removesuffix(".100ms.0pct") in DYNAMIC.values() else "",
    "dynamic_variants_force": lambda case: case.split(".")[1],
    "dynamic_variants_place": lambda case: case.split(".")[1],
    "dynamic_losses": lambda case: case.split(".")[-2],
    "closed_loop_static": lambda case: case.rsplit("_", 1)[0],
    "closed_loop_dynamic": lambda case: case.rsplit("_", 1)[0],
    "data_reduction": lambda case: case.split(".")[0],
}


class Unplayed(dict):
    """The figures of a case that is not in the sample."""

    def __missing__(self, key: str) -> float:
        return math.nan


def test_every_table_that_is_made_stands_in_its_page_with_its_command():
    found = {}
    for path in sorted((cache.clone() / "docs").rglob("*.md")):
        found |= {block.name: (path.name, block.command) for block in pages.blocks(path.read_text())}
    assert found == {name: (table.document, table.command) for name, table in TABLES.items()}


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"), (0.01, "0.01"), (0.0123, "0.012"), (1.0, "1"), (1.26, "1.3"), (9.96, "10"), (86.4, "86"), (865.0, "865"), (2.8e-5, "2.8·10⁻⁵"),
        (1.7e-8, "1.7·10⁻⁸"), (3e-5, "3·10⁻⁵"), (math.nan, ""), (1e-14, "0"), (1e-4, "0.0001"),
    ],
)  # fmt: skip
def test_figures_in_words(value, text):
    assert words.figure(value) == text


def test_who_made_a_table_is_told_anew_only_where_it_is_another_one():
    name = "gate"
    rows = [["spring", "95.5 %", "100.0 %"]]
    text = f"Before.\n\n<!-- table {name}: `./run experiment gate` -->\n| old |\n\nAfter.\n"
    first = pages.put(text, name, rows, "Tactus 1")
    assert first.startswith("Before.") and first.endswith("After.\n") and "*Made by Tactus 1*" in first and "old" not in first
    assert pages.put(first, name, rows, "Tactus 2") == first
    other = pages.put(first, name, [["spring", "95.0 %", "100.0 %"]], "Tactus 2")
    assert "*Made by Tactus 2*" in other and "Tactus 1" not in other


def test_a_sample_that_changes_each_day_still_holds(monkeypatch, tmp_path):
    """Fails where a figure of the documents is not what its command gives: ./run docs --figures makes them anew."""
    day = date.today().toordinal()
    name = sorted(_TOGETHER)[day % len(_TOGETHER)]
    table, play = TABLES[name], teleop_runs.run
    stands = {row[0]: row for row in make.rows_of(name)}
    assert stands, f"{name} is empty: ./run docs --figures"

    def sampled(scene: str, cases: list, folder: Path, *more, **others) -> dict:
        groups = sorted({_TOGETHER[name](str(case["name"])) for case in cases} - {""})
        chosen = set(random.Random(day).sample(groups, min(3, len(groups))))
        asked = [case for case in cases if _TOGETHER[name](str(case["name"])) in chosen]
        found = play(scene, asked, folder, *more, **others)
        return {str(case["name"]): found.get(str(case["name"]), Unplayed()) for case in cases}

    monkeypatch.setattr(teleop_runs, "run", sampled)
    experiment = importlib.import_module(f"experiments.{table.experiment}")
    for part in ("trade", "change"):  # these read the rows of every case
        if hasattr(experiment, part):
            whole = getattr(experiment, part)
            monkeypatch.setattr(experiment, part, lambda *given, whole=whole: _or_nothing(whole, given))
    given = dict(table.options) | ({"variants": "0"} if name == "dynamic_losses" else {"table": "0"} if "variants" in name else {})
    rows = table.rows(experiment.run(given, tmp_path))
    whole = [row for row in rows if all(cell and "nan" not in cell for cell in row)]
    assert whole
    for row in whole:
        assert row == stands[row[0]], name


def _or_nothing(whole: Callable, given: tuple) -> dict:
    try:
        return whole(*given)
    except FileNotFoundError:
        return {}
