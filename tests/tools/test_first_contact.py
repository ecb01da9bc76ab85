"""What a newcomer reads: the README's length, links that lead somewhere, sentences that can be read, figures and names that are so."""

import re
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import addon
import docs
import docs_pictures
import pytest
import yaml
from setup import cache, python_tools

CLONE = cache.clone()
DOCUMENTS = sorted([*CLONE.glob("*.md"), *(CLONE / "docs").rglob("*.md")])
GUIDE = [CLONE / f"docs/{page}.md" for page in docs.CONTENTS["Guide"]]
README = (CLONE / "README.md").read_text()


def test_the_readme_is_short_and_answers_what_newcomers_ask():
    assert len(README.split()) <= 600
    headings = re.findall(r"^## (.*)$", README, re.MULTILINE)
    wanted = ["What you can do", "Install", "First scene", "Devices", "Platforms", "What is not supported", "How it compares", "Research"]
    assert [heading for heading in headings if heading in wanted] == wanted
    files = ("CITATION.cff", "LICENSE", "CONTRIBUTING.md", "SECURITY.md", "docs/faq.md")
    for answer in ("./run demo", "./run test", *files, f"tactus-{addon.version()}.zip"):
        assert answer in README, answer


def without_code(text: str) -> str:
    return re.sub(r"^ *```.*?^ *```", "", text, flags=re.DOTALL | re.MULTILINE)


def slug(heading: str) -> str:
    return re.sub(r"[^\w\- ]", "", re.sub(r"\]\([^)]*\)", "]", heading).lower()).replace(" ", "-")


def anchors(page: Path) -> set[str]:
    return {slug(heading) for heading in re.findall(r"^#+ (.*)$", without_code(page.read_text()), re.MULTILINE)}


def dead_links(page: Path) -> list[str]:
    """Of those within this project: files that are missing, headings that are others."""
    dead = []
    for link in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", without_code(page.read_text()))):
        place, _, anchor = link.partition("#")
        if "://" in link or link.startswith("mailto:"):
            continue
        target = (page.parent / place).resolve() if place else page
        if not target.exists() or (anchor and anchor not in anchors(target)):
            dead.append(link)
    return dead


@pytest.mark.parametrize("page", DOCUMENTS, ids=lambda page: page.name)
def test_no_link_is_dead(page):
    assert dead_links(page) == []


def test_a_dead_link_is_found(tmp_path):
    (tmp_path / "there.md").write_text("# There\n\n## A heading, of two\n")
    (tmp_path / "page.md").write_text("[a](there.md#a-heading-of-two) [b](there.md#nowhere) [c](missing.md) `[d](code.md)`\n")
    assert dead_links(tmp_path / "page.md") == ["there.md#nowhere", "missing.md"]


def sentences(page: Path) -> list[str]:
    """Of its paragraphs and lists; tables and code are read otherwise."""
    lines = [line for line in without_code(page.read_text()).splitlines() if not re.match(r"\s*(\||#|!\[|<!--)", line)]
    blocks = re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", "\n".join(lines))
    plain = [re.sub(r"\]\([^)]*\)|[*`\[\]]", "", re.sub(r"^\s*(?:[-*]|\d+\.) ", "", block)) for block in blocks]
    found = [sentence for block in plain for sentence in re.split(r"(?<=[.!?])\s+", " ".join(block.split()))]
    return [sentence for sentence in found if len(re.findall(r"[A-Za-z]", sentence)) > 1]


def test_sentences_are_told_apart(tmp_path):
    text = "# A\n\nOne is here. Two\nis [there](x.md).\n\n- Three `a.b` is.\n- Four\n\n| no | row |\n\n```\nno code.\n```\n"
    (tmp_path / "page.md").write_text(text)
    assert sentences(tmp_path / "page.md") == ["One is here.", "Two is there.", "Three a.b is.", "Four"]


@pytest.mark.parametrize("page", GUIDE, ids=lambda page: page.name)
def test_sentences_of_the_guide_are_short(page):
    lengths = [len(sentence.split()) for sentence in sentences(page)]
    assert sum(lengths) / len(lengths) <= 18


def test_who_cites_names_this_version_and_its_license():
    citation = yaml.safe_load((CLONE / "CITATION.cff").read_text())
    assert citation["cff-version"] == "1.2.0" and citation["title"] and citation["message"] and citation["authors"]
    assert citation["version"] == addon.version()
    assert (CLONE / "LICENSE").read_text().startswith(f"{citation['license']} License")
    assert citation["references"][0]["title"] in (CLONE / "docs/bibliography.md").read_text()


def test_each_claim_of_the_comparison_has_its_source_beside_it():
    features = re.search(r"^## Features\n\n(.*?)\n\n", (CLONE / "docs/comparison.md").read_text(), re.DOTALL | re.MULTILINE)
    assert features
    head, _, *rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in features[1].splitlines()]
    others = head[2:-1]
    assert others and all(re.fullmatch(r"\[.+\]\(https://.+\)", name) for name in others)
    for row in rows:
        assert len(row) == len(head), row[0]
        assert "none yet" in row[1] or re.search(r"\]\(.+\)|`\./run .+`", row[-1]), row[0]


def checked(checker: str, *words: str | Path) -> subprocess.CompletedProcess:
    """By one of tools/papers/requirements.txt."""
    return subprocess.run([python_tools.python("papers").with_name(checker), *words], text=True, capture_output=True)


def test_the_citation_is_valid(tmp_path):
    valid = checked("cffconvert", "--validate", "-i", CLONE / "CITATION.cff")
    assert valid.returncode == 0, valid.stdout + valid.stderr
    wrong = tmp_path / "CITATION.cff"
    wrong.write_text((CLONE / "CITATION.cff").read_text().replace("type: thesis", "type: this is"))
    assert checked("cffconvert", "--validate", "-i", wrong).returncode != 0


def test_the_workflow_is_valid(tmp_path):
    workflow = CLONE / ".github/workflows/build.yml"
    lint = ("zizmor", "--offline", "--no-progress", "--strict-collection")
    valid = checked(*lint, workflow)
    assert valid.returncode == 0, valid.stdout + valid.stderr
    wrong = tmp_path / ".github/workflows/build.yml"
    wrong.parent.mkdir(parents=True)
    wrong.write_text(workflow.read_text().replace("runs-on:", "runs_on:"))
    assert checked(*lint, wrong).returncode != 0


def test_states_of_a_link_are_those_that_the_code_reports():
    page = (CLONE / "docs/tutorials/two_computers.md").read_text()
    sources = [CLONE / "extension" / name for name in ("world/world_link.cpp", "network/udp_sockets.cpp", "network/terms.cpp")]
    code = re.sub(r'"\s+"', "", "".join(source.read_text() for source in sources))
    quoted = [text for text in re.findall(r'"([^"]+)"', without_code(page)) if "…" in text or " " in text]
    assert len(quoted) > 10
    for text in quoted:
        for part in filter(None, (part.strip() for part in text.split("…"))):
            assert part in code, part
    states = ElementTree.parse(CLONE / "extension/doc_classes/MMTLink.xml").iter("constant")
    for state in (one.get("name", "") for one in states):
        assert not state.startswith("STATE_") or f"`{state}`" in page, state


def test_every_driver_stands_in_the_table_of_devices():
    page = (CLONE / "docs/hardware.md").read_text()
    drivers = [one.get("name", "") for one in ElementTree.parse(CLONE / "extension/doc_classes/HapticDevice.xml").iter("constant")]
    for driver in drivers:
        assert not driver.startswith("DRIVER_") or driver in ("DRIVER_AUTOMATIC", "DRIVER_ROBOT_TIP") or f"`{driver}`" in page, driver


def test_the_workflow_gives_commands_that_there_are():
    import commands

    workflow = yaml.safe_load((CLONE / ".github/workflows/build.yml").read_text())
    steps = [step.get("run", "") for job in workflow["jobs"].values() for step in job["steps"]]
    given = re.findall(r"\./run (\w+)", "\n".join(steps))
    assert {"test", "addon"} <= set(given) <= set(commands.BY_NAME)


def test_every_picture_is_made_by_the_command_and_shown():
    shown = {name for page in DOCUMENTS for name in re.findall(r"\]\((?:docs/)?pictures/(\w+)\.webp\)", page.read_text())}
    there = {path.stem for path in (CLONE / "docs/pictures").glob("*")}
    scenes, editor = ((CLONE / f"tools/{file}.gd").read_text() for file in ("scene_pictures", "editor_pictures"))
    of_gallery = re.search(r"const GALLERY := \{(.*?)\}", scenes, re.DOTALL)
    assert of_gallery
    others = scenes.replace(of_gallery[0], "")
    made = {f"scene_{name}" for name in re.findall(r'"(\w+)"', of_gallery[1])} | set(re.findall(r'"(\w+)":', others))
    made.add(docs_pictures.FILM)
    made |= {one or other for one, other in re.findall(r'_save(?:_inspector|_screen)?\("(\w+)"\)|_node_alone\(\w+, "(\w+)"', editor)}
    made |= set(re.findall(r'_keep\(.*, "(\w+)"\)', editor))
    assert shown == there == made and len(there) >= 25
