"""Nothing that a scene or a script can name is without its meaning, its unit and its range."""

import re
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path

from bind_classes import ClassTable

from setup import cache

TABLES = [ClassTable(path) for path in sorted((cache.clone() / "extension/doc_classes").glob("*.xml"))]
ADDON = cache.clone() / "demo_project/addons/tactus"

WITH_A_UNIT = ("float", "Vector3", "PackedVector3Array", "PackedFloat64Array")
# In words or in signs; of what has no dimension, what it is instead.
_UNIT = re.compile(
    r"meter|newton|second|radian|degree|kilogram|joule|watt|pixel|\bHz\b|N·m·s|N·m|N·s|N/m|rad/s|m/s|J\b"
    r"|share|factor|coefficient|0 to 1|direction|normal|how many|for each|over what|unit of",
    re.IGNORECASE,
)
# At the end of a key, or before what it is measured by.
_UNIT_IN_KEY = re.compile(r"_(s|ms|us|n|j|m|mm|rad|deg|jnd|hz|share|mb|per_s|ppm|n_per_m|m_per_s|kg)(_|$)")


def missing() -> tuple[Counter, list[str]]:
    """How many of each kind there are, and what each lacks."""
    counted, lacks = Counter(), []

    def see(kind: str, name: str, *problems: str) -> None:
        counted[kind] += 1
        lacks.extend(f"{name} {problem}" for problem in problems if problem)

    for table in TABLES:
        see("class", table.name, *(f"has no {tag}" for tag in ("brief_description", "description") if not _text(table.root.find(tag))))
        for kind in ("method", "signal"):
            for one in table.all(kind):
                if not one.get("hidden"):
                    see(kind, f"{table.name}.{one.get('name')}", *_of_call(one))
        for one in table.all("member"):
            if one.get("figure"):
                continue  # seen below, as a statistic of the class that returns it
            see("member", f"{table.name}.{one.get('name')}", *_of_member(table, one))
        for one in table.all("constant"):
            see("constant", f"{table.name}.{one.get('name')}", "" if _text(one) else "says nothing")
            counted["enum"] += one is table.enumerators(one.get("enum", ""))[0]
        for one in table.all("statistic"):
            told = one.get("type") != "float" or _UNIT_IN_KEY.search(one.get("key")) or _UNIT.search(_text(one))
            see("statistic", f"{table.name}: {one.get('key')}", "" if _text(one) else "says nothing", "" if told else "has no unit")
    return counted, lacks


def _of_call(one: ElementTree.Element) -> list[str]:
    text = _text(one.find("description"))
    kinds = [part.get("type") for part in one.findall("param") + one.findall("return")]
    needs_unit = any(kind in WITH_A_UNIT for kind in kinds)
    return ["says nothing"] if not text else ["has no unit"] if needs_unit and not _UNIT.search(text) else []


def _of_member(table: ClassTable, one: ElementTree.Element) -> list[str]:
    text, kind = _text(one), one.get("type")
    is_angle = "radians_as_degrees" in one.get("range", "") + one.get("hint", "")
    is_written = "READ_ONLY" not in one.get("usage", "")
    is_number = kind in ("int", "float", "Vector3") and not one.get("enum")
    no_unit = kind in WITH_A_UNIT and not is_angle and (one.get("unit") is None or not (one.get("unit") or _UNIT.search(text)))
    no_range = is_number and is_written and not table.limits(one, " to ")
    return ["says nothing"] * (not text) + ["has no unit"] * no_unit + ["has no range"] * no_range


def _text(one: ElementTree.Element | None) -> str:
    return (one.text or "").strip() if one is not None else ""


def test_nothing_is_without_its_meaning_its_unit_and_its_range():
    counted, lacks = missing()
    assert not lacks
    least = {"class": 15, "method": 80, "member": 180, "signal": 20, "enum": 20, "constant": 100, "statistic": 100}
    assert all(counted[kind] >= count for kind, count in least.items()), counted


def test_what_lacks_something_is_found():
    table = ClassTable(Path(cache.clone() / "extension/doc_classes/HapticDevice.xml"))
    member = next(one for one in table.all("member") if one.get("name") == "arm_mass")
    for attribute, problem in (("unit", "has no unit"), ("max", "has no range")):
        kept = member.attrib.pop(attribute)
        assert _of_member(table, member) == [problem]
        member.set(attribute, kept)
    member.text = " "
    assert _of_member(table, member) == ["says nothing"]
    method = next(one for one in table.all("method") if one.get("name") == "get_force")
    method.find("description").text = "How firmly it is pushed."
    assert _of_call(method) == ["has no unit"]


def test_getters_and_booleans_are_in_godots_form():
    wrong, counted = [], Counter()
    for table in TABLES:
        for one in (method for method in table.all("method") if not method.get("hidden")):
            text, name = _text(one.find("description")), f"{table.name}.{one.get('name')}"
            if one.find("return").get("type") == "void":
                continue
            counted["returns"] += 1
            is_getter = re.match("get_|is_|has_|find_|sample", one.get("name"))
            if not (text.startswith("Returns ") if is_getter else "Returns " in text):
                wrong.append(f"{name} does not say what it returns")
        for one in (member for member in table.all("member") if member.get("type") == "bool"):
            counted["bool"] += 1
            if not _text(one).startswith("If [code]true[/code], "):
                wrong.append(f"{table.name}.{one.get('name')} does not begin with 'If [code]true[/code], '")
        for one in table.all("signal"):
            if not _text(one.find("description")).startswith("Emitted "):
                wrong.append(f"{table.name}.{one.get('name')} does not say when it is emitted")
    assert not wrong
    assert counted["returns"] >= 80 and counted["bool"] >= 25, counted


def test_every_text_is_of_whole_sentences():
    for table in TABLES:
        for one in (*table.all("member"), *table.all("constant"), *table.all("statistic"), *table.all("description"), *table.all("brief_description")):
            text = _text(one)
            assert not text or text.endswith((".", ":", "[/codeblock]", "[/code]")), f"{table.name} {one.attrib}: {text[-40:]}"


def test_every_class_leads_to_a_page():
    """Godot opens links of http alone, and these pages are at no address: a link is a path in the clone, and a link of ./run docs."""
    for table in TABLES:
        links = table.root.findall("tutorials/link")
        assert links, f"{table.name} has no tutorial"
        for link in links:
            assert link.get("title") and (cache.clone() / (link.text or "")).is_file(), f"{table.name}: {link.text}"


def test_every_class_has_an_icon_and_every_icon_a_class():
    icons = {path.stem: ElementTree.parse(path).getroot() for path in (ADDON / "icons").glob("*.svg")}
    # Statistics of all kinds have one icon.
    assert set(icons) == {table.name for table in TABLES if not table.root.get("statistics_of")}
    for name, icon in icons.items():
        assert (icon.get("width"), icon.get("height"), icon.get("viewBox")) == ("16", "16", "0 0 16 16"), name
