"""The class reference as the table behind code and help."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from bind_classes import OWN_ATTRIBUTES, ClassTable, literal

FOLDER = Path(__file__).resolve().parents[2] / "extension" / "doc_classes"
TABLES = [ClassTable(path) for path in sorted(FOLDER.glob("*.xml"))]
BOUND = [table for table in TABLES if table.is_bound()]


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.name)
def test_the_help_is_in_godots_format(table):
    root = ElementTree.fromstring(table.help())
    assert [child.tag for child in root][:3] == ["brief_description", "description", "tutorials"]
    for kind, attributes in OWN_ATTRIBUTES.items():
        for element in root.iter(kind):
            assert not set(attributes) & set(element.keys()), f"{kind} {element.get('name')}"
    assert root.find(".//statistics") is None
    for element in (*root.iter("member"), *root.iter("constant"), *root.iter("description")):
        assert element.text.strip(), f"{element.tag} {element.get('name')} says nothing"


@pytest.mark.parametrize("table", BOUND, ids=lambda table: table.name)
def test_every_member_is_bound_and_every_number_has_its_range(table):
    source = table.source()
    for member in table.all("member"):
        assert f'"{member.get("name")}"' in source
        if member.get("type") in ("int", "float") and member.get("field"):
            assert member.get("enum") or member.get("max"), f"{member.get('name')} has no range"
    for signal in table.all("signal"):
        assert f'MethodInfo("{signal.get("name")}"' in source
    for constant in table.all("constant"):
        assert f'== {constant.get("value")});' in source


def test_statistics_are_keys_in_code_and_lines_in_the_help():
    table = next(table for table in TABLES if table.name == "MMTLink")
    keys = [one.get("key") for one in table.all("statistic")]
    assert len(keys) == len(set(keys)) > 50
    text = table.help().decode()
    for key in keys:
        assert f'd["{key}"]' in table.source()
        assert f"[code]{key}[/code]: " in text


def test_statistics_of_a_group_are_properties_of_its_class():
    owner = next(table for table in TABLES if table.name == "HapticWorld")
    group = next(table for table in TABLES if table.name == "HapticTimingStatistics")
    names = [one.get("key") for one in owner.root.iterfind(".//group[@class='HapticTimingStatistics']/statistic")]
    assert [member.get("name") for member in group.all("member")] == names and len(names) > 20
    member = ElementTree.fromstring(group.help()).find(".//member[@name='baseline_mean_period_us']")
    assert "[member HapticWorld.measure_baseline]" in member.text and "[b]Unit:[/b] μs." in member.text
    assert f'return HapticStatistics::of<{group.name}>(figures("{group.name}"));' in owner.source()


def test_each_group_is_returned_by_a_method():
    for table in TABLES:
        if owner := table.root.get("statistics_of"):
            returned = [one for one in next(one for one in TABLES if one.name == owner).all("method") if one.find("return").get("type") == table.name]
            assert len(returned) == 1, table.name


def test_a_range_is_said_with_its_unit():
    table = next(table for table in TABLES if table.name == "MMTNetworkConditions")
    assert "[b]Range:[/b] 0 to 10 s." in table.help().decode()


def test_a_unit_that_the_inspector_would_cut_is_left_to_the_description():
    sources = {table.name: table.source() for table in TABLES if table.is_bound()}
    assert 'PropertyInfo(Variant::VECTOR3, "gravity", PROPERTY_HINT_NONE, ""' in sources["HapticWorld"]
    assert 'PropertyInfo(Variant::VECTOR3, "applied_torque", PROPERTY_HINT_NONE, ""' in sources["HapticDevice"]
    assert 'PropertyInfo(Variant::VECTOR3, "applied_force", PROPERTY_HINT_NONE, "suffix:N"' in sources["HapticDevice"]


def test_what_is_not_shown_is_still_stored():
    table = next(table for table in TABLES if table.name == "HapticPath")
    for name, form in (("circle_radius", "FORM_CIRCLE_WAVE"), ("points_loop", "FORM_POINTS")):
        assert f'(name == "{name}" && !(form_ == {form}))' in table.source()
    assert "property.usage = PROPERTY_USAGE_STORAGE;" in table.source()
    assert '(name == "form"' not in table.source()


def test_former_names_are_those_of_the_changelog():
    """tests/godot/renames_test.gd loads each of them."""
    text = (FOLDER.parents[1] / "CHANGELOG.md").read_text()
    listed = re.findall(r"^\| `([\w.]+)` \| `([\w.]+)` \|$", text, re.MULTILINE)
    renamed = [(table.old_name(), table.name) for table in TABLES if table.old_name()]
    for table in TABLES:
        for one in (*table.all("member"), *table.all("method"), *table.all("constant")):
            for old in one.get("was", "").split():
                renamed.append((old if "." in old else f"{table.name}.{old}", f"{table.name}.{one.get('name')}"))
            if one.get("now") and not one.get("hidden"):
                renamed.append((f"{table.name}.{one.get('name')}", f"{table.name}.{one.get('now')}"))
    assert len(listed) == len({old for old, _ in listed}) and sorted(listed) == sorted(renamed)


def test_a_former_name_is_deprecated_in_the_help():
    table = next(table for table in TABLES if table.name == "MMTTuning")
    old = ElementTree.fromstring(table.old_help())
    assert (old.get("name"), old.get("inherits"), old.get("deprecated")) == ("TeleopTuning", "MMTTuning", "Use [MMTTuning] instead.")
    member = ElementTree.fromstring(table.help()).find(".//member[@name='stealth_let_go']")
    assert member.get("deprecated") == "Use [member stealth_release_time] instead."
    assert (member.get("setter"), member.get("getter"), member.get("type")) == ("set_stealth_let_go", "get_stealth_let_go", "float")


def test_a_former_method_is_deprecated_in_the_help():
    help_ = {name: ElementTree.fromstring(next(table for table in TABLES if table.name == name).help()) for name in ("ProxyPointer", "HapticPath")}
    former = help_["ProxyPointer"].find(".//method[@name='is_squeezed']")
    assert former.get("deprecated") == "Use [method is_pinched] instead." and former.find("return").get("type") == "bool"
    assert help_["HapticPath"].find(".//method[@name='get_problem']").get("deprecated") == "Use [method get_problems] instead."
    assert help_["ProxyPointer"].find(".//constant[@name='STATUS_SQUEEZED']").get("deprecated") == "Use [constant STATUS_PINCHED] instead."


def test_a_path_has_a_node_beside_it():
    table = next(table for table in TABLES if table.name == "ProxyPointer")
    node = ElementTree.fromstring(table.help()).find(".//member[@name='device_node']")
    assert (node.get("type"), node.get("setter"), node.get("getter")) == ("HapticDevice", "set_device_node", "get_device_node")


def test_a_default_has_one_type_on_every_system():
    """long is int64_t on Linux alone."""
    assert literal("4294967295") == "int64_t(4294967295)"
    assert [literal(text) for text in ("-1", "2147483647", "0.5", "Vector3()")] == ["-1", "2147483647", "0.5", "Vector3()"]
