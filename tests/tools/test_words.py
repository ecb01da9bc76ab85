"""Docs, class reference, messages and commits are written in the words of docs/glossary.md and in sentences of readable length."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from setup import cache
from testing import words

CLONE = cache.clone()
PAGES = sorted([CLONE / "README.md", CLONE / "CONTRIBUTING.md", *(CLONE / "docs").rglob("*.md")])
NOTEBOOK = CLONE / "docs/notebook"  # notes on experiments, as they were made: its words count, its sentences do not
CLASSES = sorted((CLONE / "extension/doc_classes").glob("*.xml"))
REPLACED = words.replaced_words((CLONE / "docs/glossary.md").read_text())
# The first commit whose successors keep to the form of a subject.
COMMITS_SINCE = "adc6141"

# Public names that hold a replaced word: a published key, which experiments and their tables have.
KEPT_NAMES = {"MMTLink.refused_strangers"}


def text_of(path: Path) -> words.Text:
    name = str(path.relative_to(CLONE))
    if path.suffix == ".md":
        return words.of_markdown(name, path.read_text())
    return words.of_class(name, ElementTree.parse(path).getroot())


@pytest.mark.parametrize("path", [path for path in PAGES + CLASSES if NOTEBOOK not in path.parents], ids=lambda path: path.stem)
def test_sentences_can_be_read_at_once(path: Path):
    text = text_of(path)
    long = words.long_sentences(text)
    assert not long, "\n".join(long)
    assert words.mean_length(text) <= words.LONGEST_MEAN, f"{words.mean_length(text):.1f} words a sentence"


@pytest.mark.parametrize("path", PAGES + CLASSES, ids=lambda path: path.stem)
def test_texts_use_the_words_of_the_glossary(path: Path):
    if path.stem == "glossary":
        return  # it names them
    found = words.found_words(text_of(path), REPLACED)
    assert not found, "\n".join(f"'{word}' is '{REPLACED[word]}' ({sentence})" for word, sentence in found)


def public_names() -> list[tuple[str, str]]:
    """Each with its class."""
    found = []
    for path in CLASSES:
        root = ElementTree.parse(path).getroot()
        elements = [element for kind in ("method", "member", "signal", "constant", "statistic") for element in root.iter(kind)]
        shown = [element for element in elements if not (element.get("hidden") or element.get("now"))]
        found += [(path.stem, name) for element in shown for name in (element.get("name"), element.get("key")) if name]
    return found


def test_public_names_use_the_words_of_the_glossary():
    wrong = {}
    for of, name in public_names():
        spoken = f" {name.lower().replace('_', ' ')} "
        wrong |= {f"{of}.{name}": REPLACED[word] for word in REPLACED if f" {word} " in spoken}
    assert set(wrong) == KEPT_NAMES, {name: term for name, term in wrong.items() if name not in KEPT_NAMES}


def messages() -> dict[str, list[str]]:
    """Texts in quotes that have a space, by file: what nodes, the editor, the gallery and the tools say. Comments are none."""
    found = {}
    for path in [*(CLONE / "extension").rglob("*.cpp"), *(CLONE / "demo_project").rglob("*.gd"), *(CLONE / "demo_project").rglob("*.tscn")]:
        if ".godot" in path.parts:
            continue
        lines = [line for line in path.read_text().splitlines() if not line.strip().startswith(("//", "#"))]
        texts = re.findall(r'"((?:[^"\\\n]|\\.)*)"', "\n".join(lines))
        found[str(path.relative_to(CLONE))] = [text for text in texts if " " in text.strip()]
    return found


def test_messages_use_the_words_of_the_glossary():
    said = messages()
    assert sum(map(len, said.values())) > 500
    wrong = [(name, *one) for name, texts in said.items() for one in words.found_words(words.Text(name, texts), REPLACED)]
    assert not wrong, "\n".join(f"{name}: '{word}' is '{REPLACED[word]}' ({text})" for name, word, text in wrong)


def test_commits_are_said_as_area_and_imperative():
    subjects = words.subjects(CLONE, COMMITS_SINCE, 50)
    if subjects is None:
        pytest.skip("the clone does not reach back to where the rule began")
    assert not [subject for subject in subjects if words.subject_is_wrong(subject)]


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("One is here. Two are `a. B`.\nThree!", ["One is here.", "Two are X.", "Three!"]),
        ("# Head\n\nText.\n\n| a | Cell. Cell. |\n\n```sh\nNo text. None.\n```\n- An item\n- Another", ["Text.", "An item", "Another"]),
        ("The value is 1.5 mm. [A link](to/it.md) of *2 N* ends.", ["The value is 1.5 mm.", "A link of 2 N ends."]),
    ],
)
def test_sentences_of_markdown(source: str, expected: list[str]):
    assert words.of_markdown("", source).sentences() == expected


def test_what_is_wrong_is_found():
    glossary = "| Term | In place of | Meaning |\n|---|---|---|\n| proxy | fingertip, fingertips | a sphere |\n| tick | | a pass |\n"
    replaced = words.replaced_words(glossary)
    assert replaced == {"fingertip": "proxy", "fingertips": "proxy"}
    text = words.Text("", ["The Fingertip stays. " + "Word " * 31 + "end."])
    assert [word for word, _ in words.found_words(text, replaced)] == ["fingertip"]
    assert len(words.long_sentences(text)) == 1 and words.mean_length(text) == (3 + 32) / 2


@pytest.mark.parametrize(
    ("subject", "is_wrong"),
    [
        ("docs: Split long sentences", False), ("core, tests: Read README.md first", False), ("Split long sentences", True),
        ("docs: Split.", True), ("docs: split", True), ("docs: " + "A" * 67, True),
    ],
)  # fmt: skip
def test_the_form_of_a_subject(subject: str, is_wrong: bool):
    assert words.subject_is_wrong(subject) == is_wrong
