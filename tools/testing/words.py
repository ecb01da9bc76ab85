"""How the texts for people are written: sentences of Markdown and of the class reference, and the words that the glossary replaces.

The reasons are in docs/glossary.md: one word, one meaning, and the field's word.
"""

import re
import subprocess
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

LONGEST_SENTENCE = 30  # words
LONGEST_MEAN = 20  # words a sentence, over a page
LONGEST_SUBJECT = 72  # characters

_END = re.compile(r"(?<=[.!?:;])[\"”)*_]*\s+(?=[\"“(*_`\[]*[A-Z0-9`])")
_WORD = re.compile(r"[A-Za-zÀ-ÿ][\w'’–-]*")


@dataclass(frozen=True)
class Text:
    """A page, or all texts of a class: its prose by paragraphs."""

    name: str
    paragraphs: list[str]

    def sentences(self) -> list[str]:
        return [sentence for paragraph in self.paragraphs for sentence in sentences(paragraph)]


def sentences(paragraph: str) -> list[str]:
    """A colon or a semicolon that begins a new clause in a capital ends one as well."""
    return [one for one in _END.split(" ".join(paragraph.split())) if words(one)]


def words(sentence: str) -> list[str]:
    return _WORD.findall(sentence)


def of_markdown(name: str, source: str) -> Text:
    """Without code, tables, headings, formulas, comments and the addresses of links; each item of a list is a paragraph."""
    source = re.sub(r"^ *```.*?^ *```$", "\n", source, flags=re.DOTALL | re.MULTILINE)
    source = re.sub(r"<!--.*?-->|\$\$.*?\$\$", "\n", source, flags=re.DOTALL)
    lines = ["" if re.match(r"\s*(\||#|!\[)", line) else re.sub(r"^\s*([-*]|\d+\.)\s+", "\n", line) for line in source.splitlines()]
    paragraphs = re.split(r"\n\s*\n", "\n".join(lines))
    return Text(name, [_plain(one) for one in paragraphs if one.strip()])


def _plain(text: str) -> str:
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    # What is quoted as code or as a formula counts as one word.
    text = re.sub(r"`[^`]*`|\$[^$]*\$", "X", text)
    return re.sub(r"\*\*|__|(?<!\w)[*_]|[*_](?!\w)", "", text)


def of_class(name: str, root: ElementTree.Element) -> Text:
    parts = [*root.iter("member"), *root.iter("constant"), *root.iter("statistic"), *root.iter("description"), *root.iter("brief_description")]
    paragraphs = []
    for part in parts:
        text = re.sub(r"\[codeblock\].*?\[/codeblock\]", "", part.text or "", flags=re.DOTALL)
        text = re.sub(r"\[code\].*?\[/code\]", "X", text, flags=re.DOTALL)
        text = re.sub(r"\[(?:member|method|constant|enum|signal|param) ([^\]]+)\]|\[(\w+)\]", "X", text)
        paragraphs += [line for line in text.splitlines() if line.strip()]
    return Text(name, paragraphs)


def replaced_words(glossary: str) -> dict[str, str]:
    """In place of what to write what, from the tables of docs/glossary.md whose second column names words to avoid."""
    found = {}
    for line in glossary.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else []
        if len(cells) == 3 and cells[1] and not set(cells[1]) <= set("-") and cells[1] != "In place of":
            found |= {word.strip(): cells[0] for word in cells[1].split(",")}
    return found


def long_sentences(text: Text) -> list[str]:
    return [one for one in text.sentences() if len(words(one)) > LONGEST_SENTENCE]


def mean_length(text: Text) -> float:
    lengths = [len(words(one)) for one in text.sentences()]
    return sum(lengths) / len(lengths) if lengths else 0.0


def found_words(text: Text, replaced: dict[str, str]) -> list[tuple[str, str]]:
    """Each with the sentence that has it."""
    patterns = {word: re.compile(rf"\b{re.escape(word)}\b", re.IGNORECASE) for word in replaced}
    return [(word, one) for one in text.sentences() for word, pattern in patterns.items() if pattern.search(one)]


def subject_is_wrong(subject: str) -> bool:
    """Not `area: Imperative`, or too long."""
    return len(subject) > LONGEST_SUBJECT or not re.fullmatch(r"[a-z][\w /,-]*: [A-Z`][^.]*(\.[^.\s][^.]*)*", subject)


def subjects(folder: Path, since: str, count: int) -> list[str] | None:
    """Of the newest commits after `since`, without merges and reverts; None where the clone does not reach back to it."""
    log = subprocess.run(
        ["git", "log", "--no-merges", f"-{count}", "--format=%s", f"{since}..HEAD"], cwd=folder, text=True, capture_output=True
    )
    if log.returncode != 0:
        return None
    return [line for line in log.stdout.splitlines() if not line.startswith(("Revert ", "fixup! ", "squash! "))]
