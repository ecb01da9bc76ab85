"""The class reference (extension/doc_classes/*.xml) as pages: what F1 shows in the editor, for a browser."""

import itertools
import re
import textwrap
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable

GODOT = "https://docs.godotengine.org/en/stable/classes/class_{}.html"
# The word before a name in a reference, and how Godot's pages call it in their anchors.
KINDS = {"member": "property", "method": "method", "constant": "constant", "enum": "", "signal": "signal"}
_MARKUP = re.compile(
    r"\[code\](?P<code>.*?)\[/code\]|\[(?P<style>[bi])\](?P<styled>.*?)\[/(?P=style)\]"
    r"|\[(?P<kind>member|method|constant|enum|signal|param) (?P<name>[^\]]+)\]|\[(?P<class_name>[A-Z]\w*)\]",
    re.DOTALL,
)
_SPECIAL = re.compile(r"([\\`*_<>\[\]|#~])")


class Reference:
    """All classes, so that they can name one another."""

    def __init__(self, helps: Iterable[bytes]):
        roots = [ElementTree.fromstring(help_) for help_ in helps]
        self._roots = {root.get("name", ""): root for root in sorted(roots, key=lambda root: root.get("name", ""))}

    def names(self) -> list[str]:
        return list(self._roots)

    def index(self) -> str:
        rows = [(self._link(name, name), self._text(root, "brief_description", name)) for name, root in self._roots.items()]
        pages = "\n".join(self._roots)
        return f"# Classes\n\nWhat F1 shows in the editor.\n\n{_table(('Class', ''), rows)}\n\n```{{toctree}}\n:hidden:\n\n{pages}\n```\n"

    def page(self, name: str) -> str:
        root = self._roots[name]
        parts = [
            f"# {name}", f"Inherits {self._link(root.get('inherits', ''), name)}.",
            self._text(root, "brief_description", name), self._text(root, "description", name), _tutorials(root),
            *self._members(root, name), *self._calls(root, name, "method", "Methods"), *self._calls(root, name, "signal", "Signals"),
            *self._constants(root, name),
        ]  # fmt: skip
        return "\n\n".join(part for part in parts if part) + "\n"

    def markdown(self, text: str, owner: str) -> str:
        """Godot's markup; each of its lines is a paragraph, lines that explain keys are a list, a code block is one of GDScript."""
        parts = re.split(r"\[codeblock\]\n(.*?)\[/codeblock\]", text, flags=re.DOTALL)
        blocks = [f"```gdscript\n{textwrap.dedent(code).rstrip()}\n```" for code in parts[1::2]]
        prose = [self._paragraphs(part, owner) for part in parts[::2]]
        return "\n\n".join(part for pair in itertools.zip_longest(prose, blocks) for part in pair if part)

    def _paragraphs(self, text: str, owner: str) -> str:
        lines = [" ".join(line.split()) for line in text.strip().splitlines() if line.strip()]
        items = [("- " if re.match(r"\[code\]\w+\[/code\](, \[code\]\w+\[/code\])*: ", line) else "") + self._line(line, owner) for line in lines]
        return "\n\n".join(items)

    def _line(self, line: str, owner: str) -> str:
        parts, end = [], 0
        for found in _MARKUP.finditer(line):
            parts += [_plain(line[end : found.start()]), self._marked(found, owner)]
            end = found.end()
        return "".join([*parts, _plain(line[end:])])

    def _marked(self, found: re.Match, owner: str) -> str:
        if found["code"] is not None:
            return f"`{found['code']}`"
        if found["style"]:
            mark = {"b": "**", "i": "*"}[found["style"]]
            return mark + self._line(found["styled"], owner) + mark
        if found["class_name"]:
            return self._link(found["class_name"], owner)
        return f"`{found['name']}`" if found["kind"] == "param" else self._link(found["name"], owner, found["kind"])

    def _link(self, name: str, owner: str, kind: str = "") -> str:
        """A class, or what a class has: `name` is Class.name, or the owner's own."""
        if not kind:
            return f"[{name}]({name}.md)" if name in self._roots else f"[{name}]({GODOT.format(name.lower())})"
        of, _, own = name.rpartition(".")
        if self._has(of or owner, own, kind):
            return f"[{own if of in ('', owner) else name}](#{_target(of or owner, own, kind)})"
        anchor = f"#class-{of}-{KINDS[kind]}-{own}".lower().replace("_", "-") if KINDS[kind] and of else ""
        return f"[{name}]({GODOT.format((of or '@globalscope').lower())}{anchor})"

    def _has(self, class_name: str, own: str, kind: str) -> bool:
        """Of enums, those of Godot's global scope are named alike; whatever else our classes are said to have, they must have."""
        root = self._roots.get(class_name)
        return root is not None and (kind != "enum" or any(one.get("enum") == own for one in root.iter("constant")))

    def _text(self, element: ElementTree.Element, tag: str, owner: str) -> str:
        return self.markdown(element.findtext(tag, ""), owner)

    def _type(self, element: ElementTree.Element, owner: str) -> str:
        if enum := element.get("enum"):
            return self._link(enum, owner, "enum")
        kind = element.get("type", "")
        return self._link(kind, owner) if kind in self._roots or kind[:1].isupper() else f"`{kind}`"

    def _members(self, root: ElementTree.Element, owner: str) -> list[str]:
        members = root.findall("members/member")
        parts = ["## Properties"] if members else []
        for one in members:
            default = f" = `{one.get('default')}`" if one.get("default") else ""
            parts += [_heading(owner, one), f"{self._type(one, owner)}{default}", self.markdown(one.text or "", owner)]
        return parts

    def _calls(self, root: ElementTree.Element, owner: str, kind: str, title: str) -> list[str]:
        calls = root.findall(f"{kind}s/{kind}")
        parts = [f"## {title}"] if calls else []
        for one in calls:
            parts += [_heading(owner, one), self._signature(one, owner), self._text(one, "description", owner)]
        return parts

    def _signature(self, call: ElementTree.Element, owner: str) -> str:
        params = sorted(call.findall("param"), key=lambda param: int(param.get("index", "0")))
        words = [
            f"`{param.get('name')}`: {self._type(param, owner)}" + (f" = `{param.get('default')}`" if param.get("default") else "")
            for param in params
        ]
        given = call.find("return")
        result = f" → {self._type(given, owner)}" if given is not None and given.get("type") != "void" else ""
        return f"({', '.join(words)}){result}" + (f", {call.get('qualifiers')}" if call.get("qualifiers") else "")

    def _constants(self, root: ElementTree.Element, owner: str) -> list[str]:
        by_enum: dict[str, list[ElementTree.Element]] = {}
        for one in root.findall("constants/constant"):
            by_enum.setdefault(one.get("enum", ""), []).append(one)
        parts = ["## Enumerations"] if by_enum else []
        for enum, constants in by_enum.items():
            parts.append(f"({_target(owner, enum, 'enum')})=\n### {enum}" if enum else "### Constants")
            for one in constants:
                name = one.get("name", "")
                parts.append(f"({_target(owner, name)})=\n- `{name}` = {one.get('value')}: {self.markdown(one.text or '', owner)}")
        return parts


def _tutorials(root: ElementTree.Element) -> str:
    """Pages of docs/, one folder above the classes' pages."""
    links = [f"- [{_plain(link.get('title', ''))}]({(link.text or '').strip().replace('docs/', '../', 1)})" for link in root.findall("tutorials/link")]
    return "\n".join(["**Read on:**\n", *links]) if links else ""


def _heading(owner: str, element: ElementTree.Element) -> str:
    name = element.get("name", "")
    return f"({_target(owner, name)})=\n### {_plain(name)}"


def _target(owner: str, name: str, kind: str = "") -> str:
    """Names of targets do not tell Form from form."""
    return f"{owner}.enum.{name}" if kind == "enum" else f"{owner}.{name}"


def _plain(text: str) -> str:
    return _SPECIAL.sub(r"\\\1", text)


def _table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = [head, ("---",) * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)
