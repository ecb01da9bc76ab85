"""The pages that ./run docs makes, and what the tutorials promise."""

import importlib.util
import json
import re
import subprocess
import sys
import tomllib
import types
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import docs
import experiment
import pytest

from pages.class_pages import Reference
from setup import cache
from sweeps import description

TUTORIALS = cache.clone() / "docs/tutorials"


@pytest.fixture(scope="module")
def pages(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("pages")
    docs.write(folder / "source")
    assert docs.make(folder / "source", folder / "out") == ""
    return folder / "out"


def test_every_document_and_every_class_has_its_page(pages):
    documents = {path.relative_to(cache.clone() / "docs").with_suffix("") for path in (cache.clone() / "docs").rglob("*.md")}
    classes = {Path("classes", path.stem) for path in (cache.clone() / "extension/doc_classes").glob("*.xml")}
    for page in documents | classes | {Path("index"), Path("changes")}:
        assert (pages / page).with_suffix(".html").is_file(), page


def test_pages_bring_everything_that_they_show(pages):
    for page in pages.rglob("*.html"):
        text = page.read_text()
        assert not re.findall(r'<(?:script|img|iframe)[^>]* src="(?:https?:)?//[^"]*"', text), page
        assert not re.findall(r'<link[^>]* rel="(?:stylesheet|preload|preconnect)"[^>]* href="(?:https?:)?//[^"]*"', text), page


def test_no_markup_of_the_editor_is_left(pages):
    for page in (pages / "classes").glob("*.html"):
        assert not re.search(r"\[(?:member|method|constant|enum|signal|param|code|/code|codeblock|/codeblock|b|/b)\b", page.read_text()), page


def test_a_page_that_nothing_leads_to_is_an_error(tmp_path):
    (tmp_path / "source").mkdir()
    (tmp_path / "source/index.md").write_text("# Pages\n")
    (tmp_path / "source/lonely.md").write_text("# Lonely\n\nSee [nowhere](nowhere.md).\n")
    problems = docs.make(tmp_path / "source", tmp_path / "out")
    assert "lonely.md" in problems and "nowhere" in problems


def class_page(text: str) -> str:
    xml = f'<class name="Hand" inherits="Node3D"><members><member name="own_force" type="float">{text}</member></members></class>'
    return Reference([xml.encode()]).page("Hand")


@pytest.mark.parametrize(
    ("markup", "markdown"),
    [
        ("[code]a_b[/code] is *less*", r"`a_b` is \*less\*"),
        ("[member own_force] and [member Hand.own_force]", "[own_force](#Hand.own_force) and [own_force](#Hand.own_force)"),
        ("[Node3D]", "[Node3D](https://docs.godotengine.org/en/stable/classes/class_node3d.html)"),
        ("[method Node3D.look_at]", "class_node3d.html#class-node3d-method-look-at)"),
        ("[b]Range:[/b] 0", "**Range:** 0"),
        ("[param far_away] [i]so[/i]", "`far_away` *so*"),
        ("One.\n\t\tTwo.", "One.\n\nTwo."),
        ("[code]key[/code]: what it is.", "- `key`: what it is."),
        ("Begin.\n\t\t[codeblock]\n\t\tif a:\n\t\t    b[0] = *c\n\t\t[/codeblock]\n\t\tEnd.", "Begin.\n\n```gdscript\nif a:\n    b[0] = *c\n```\n\nEnd."),
    ],
)
def test_the_markup_of_the_editor_in_markdown(markup, markdown):
    assert markdown in class_page(markup)


def blocks(document: Path, language: str) -> list[str]:
    return re.findall(rf"```{re.escape(language)}\n(.*?)```", document.read_text(), re.DOTALL)


def documents() -> list[Path]:
    clone = cache.clone()
    return [clone / "README.md", clone / "CONTRIBUTING.md", *sorted((clone / "docs").rglob("*.md"))]


def test_every_snippet_of_python_and_toml_is_parsed():
    python = [(page, block) for page in documents() for block in blocks(page, "python")]
    toml = [block for page in documents() for block in blocks(page, "toml")]
    for page, block in python:
        compile(block, str(page), "exec")
    for block in toml:
        tomllib.loads(block)
    assert len(python) >= 5 and len(toml) >= 2


def test_every_snippet_is_of_a_language_that_a_test_reads():
    """gdscript: tests/godot/docs_examples_test.gd; sh: test_docs_commands.py."""
    found = {language for page in documents() for language in re.findall(r"^[ \t]*```(.+)$", page.read_text(), re.MULTILINE)}
    assert found == {"c++", "csharp", "gdscript", "python", "sh", "toml"}


def test_the_driver_of_the_tutorial_compiles(tmp_path):
    (source,) = blocks(TUTORIALS / "own_driver.md", "c++")
    headers = ("core/ports/device.hpp", "devices/driver.hpp", "devices/force_slot.hpp", "platform/clock.hpp")
    program = "".join(f'#include "{header}"\n' for header in headers) + f"namespace tactus {{\n{source}\n}}\n"
    (tmp_path / "driver.cpp").write_text(program)
    command = ["g++", "-std=c++20", "-fsyntax-only", "-I", str(cache.clone() / "extension"), str(tmp_path / "driver.cpp")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_names_in_c_sharp_are_those_of_the_classes():
    """No Godot with C# can be had to run it."""
    known = set()
    for path in (cache.clone() / "extension/doc_classes").glob("*.xml"):
        root = ElementTree.parse(path).getroot()
        known |= {one.get("name") for kind in ("method", "member", "signal") for one in root.iter(kind)}
    used = [
        name for block in blocks(cache.clone() / "docs/csharp.md", "csharp") for name in re.findall(r'\.(?:Set|Get|Call|Connect)\("(\w+)"', block)
    ]
    assert len(used) >= 3 and not set(used) - known


def test_the_experiment_of_the_tutorial_runs_and_its_sweep_can_be_played(tmp_path, monkeypatch):
    (source,) = blocks(TUTORIALS / "own_experiment.md", "python")
    (tmp_path / "how_far.py").write_text(source)
    spec = importlib.util.spec_from_file_location("experiments.how_far", tmp_path / "how_far.py")
    module: types.ModuleType = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "experiments.how_far", module)
    spec.loader.exec_module(module)
    near, far = (module.run({"delay": delay, "way": "pose_only"}, tmp_path / "out") for delay in ("25", "200"))
    assert 0 < near["force_error_mean_N"] < far["force_error_mean_N"]
    (sweep,) = blocks(TUTORIALS / "own_experiment.md", "toml")
    (tmp_path / "sweep.toml").write_text(sweep)
    read = description.read(tmp_path / "sweep.toml", [*experiment.names(), "how_far"])
    assert len(read.runs()) == 80 and read.column("delay") == "delay_ms"
    assert json.dumps(near)


def test_the_sweep_of_the_page_can_be_played(tmp_path):
    (sweep,) = blocks(cache.clone() / "docs/experiments.md", "toml")
    (tmp_path / "sweep.toml").write_text(sweep)
    assert len(description.read(tmp_path / "sweep.toml", experiment.names()).runs()) == 3 * 4 * 2 * 5
