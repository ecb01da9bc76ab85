"""docs/thesis.md: each of its figures names a key of a command that exists, and cites a section that the thesis has."""

import importlib
import re
from pathlib import Path

import pytest

import experiment
from experiments import dynamic_mmt, static_mmt
from measuring import perturbed, rivals, teleop_runs
from setup import cache

PAGE = (cache.clone() / "docs/thesis.md").read_text()
SCENARIOS = ("scenario2", "scenario4")


def rows(heading: str) -> list[list[str]]:
    part = PAGE.split(f"\n## {heading}", 1)[1].split("\n## ", 1)[0]
    lines = [line for line in part.splitlines() if line.startswith("|")][2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def cases(name: str) -> set[str]:
    """What stands before the last word of its keys."""
    if name == "static_mmt":
        settings = static_mmt.Settings()
        places = static_mmt.places(teleop_runs.description(name), settings)
        return {f"{place.name}.{case['name']}" for place in places for case in static_mmt.cases(place, settings, Path())}
    if name == "dynamic_mmt":
        description = teleop_runs.description(name)
        table = {str(case["name"]) for case in dynamic_mmt.cases(description, dynamic_mmt.Settings(), Path())}
        return table | {f"{variant}.{way}.100ms" for variant in description["variants"] for way in rivals.SCHEMES}
    if name == "timing_networked":
        return {f"{scenario}.{side}" for scenario in SCENARIOS for side in ("operator", "teleoperator")}
    return {"static", "dynamic"} if name == "scenario1" else set(perturbed.CASES)


def sources() -> str:
    clone = cache.clone()
    paths = [*(clone / "tools").rglob("*.py"), *(clone / "tests/shared").glob("teleop_*.cpp"), clone / "extension/doc_classes/HapticWorld.xml"]
    return "\n".join(path.read_text() for path in paths)


KEYS = [(re.search(r"experiment (\w+)", row[1])[1], row[2].strip("`")) for row in rows("Figures")]


@pytest.mark.parametrize(("name", "key"), KEYS)
def test_each_figure_names_a_key(name: str, key: str):
    case, _, figure = key.rpartition(".")
    assert name in experiment.names() and hasattr(importlib.import_module(f"experiments.{name}"), "run")
    assert case in cases(name), key
    module = importlib.import_module(f"experiments.{name}")
    if hasattr(module, "FIGURES"):
        assert figure in module.FIGURES, key
    else:
        assert re.sub(r"_(p90_us|share)$", "", figure) in sources(), key


def test_all_inferences_scenarios_and_requirements_are_there_with_their_command():
    assert [int(row[0].split(",")[0]) for row in rows("Inferences")] == list(range(1, 13))
    assert [int(row[0].split(",")[0]) for row in rows("Scenarios")] == list(range(1, 6))
    assert [int(row[0].split(" ")[0]) for row in rows("Requirements")] == list(range(1, 7))
    for heading in ("Figures", "Inferences", "Scenarios"):
        for row in rows(heading):
            assert any(word in experiment.names() for cell in row for word in re.findall(r"\./run experiment (\w+)", cell)), row


# Of the thesis: chapter, sections, and subsections.
SECTIONS = {"2": (3, {}), "3": (2, {1: 4, 2: 4}), "4": (5, {4: 7}), "5": (4, {})}


def test_every_section_that_is_cited_exists():
    """In the sources and the documents: "thesis 5.6" has no such section to lead to."""
    found = []
    clone = cache.clone()
    for folder, endings in (("extension", ("hpp", "cpp", "xml")), ("tools", ("py",)), ("docs", ("md",)), ("demo_project", ("gd", "json"))):
        for ending in endings:
            for path in (clone / folder).rglob(f"*.{ending}"):
                for cited in re.findall(r"thesis(?:,? sections?)? (\d)\.(\d)(?:\.(\d))?\b", path.read_text()):
                    found.append((str(path.relative_to(clone)), *cited))
    assert len(found) > 20
    for path, chapter, section, part in found:
        sections, parts = SECTIONS[chapter]
        assert 1 <= int(section) <= sections, (path, chapter, section)
        assert not part or int(part) <= parts.get(int(section), 0), (path, chapter, section, part)
