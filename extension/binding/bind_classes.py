"""From the class reference (doc_classes/*.xml) to code and to the editor's help: one table for both.

A class with a `header` attribute has its _bind_methods() written from its XML: methods, properties, signals and
constants, each with its documentation beside it. What Godot's own format does not know are further attributes, which
the editor never sees:

    class      header       the C++ header, below extension/; includes: others that statistics need
               was          the name that the class had: a class of its own, which scenes and scripts of before still find
               statistics_of  the class whose statistics of this group are this one's properties
    method     cpp          the C++ member function, where it is not called alike
               hidden       bound, and no part of the public reference
               was          the names that it had, separated by spaces: each calls it, with a warning
               now          the name of the method that is called in place of this former one, which still works, with a warning
    member     range        the inspector's slider: "min,max,step" and Godot's or_greater, or_less, exp
               unit         of the value, shown behind it
               hint         any other Godot hint, "NAME:STRING"
               usage        "EDITOR": shown and not stored; "STORAGE": stored and not shown; "NONE": neither
               now          the name of the property that is used in place of this former one, whose getter warns
               group        name and prefix of the group that begins here, "NAME:PREFIX"; subgroup: the same within it
               param        name of the setter's argument
    member that is stored as it is set (its class says TACTUS_PROPERTIES, nodes/properties.hpp)
               field        where the value is in the class
               min, max     what is accepted of a number, and of a vector's length
               scale        "seconds": the field is in nanoseconds
               changed      what the class does when the value is another one (the class's own `changed` where this is
                            not given)
               follows      "yes": the same is done when the resource that is the value says that it has changed
               was          the names that it had, separated by spaces; "Class.name" where it was another class's
               was_scale    what a number under its former name is multiplied by
               A path to a node (NODE_PATH_VALID_TYPES) has a second property for scripts, NAME_node: the node itself.
    member     shown        a C++ condition, seen from the class: else the inspector does not show it (the class declares
                            _validate_property)
    constant   is           the C++ value that has to be the same number
               label        what the inspector shows
               was          the name that it had, which scripts can still use
    statistics method, let, statistic: a Dictionary, each key with type, C++ value, and meaning; `if` is a condition,
               `needs` one without which it is empty
    group      class: the statistics in it are properties of this class, which has a page of its own and a method here that
               returns it; `name` is that of a property where it is not the key's

Works with this binding and with godot-cpp alike.
"""

import copy
import os.path
import re
import xml.etree.ElementTree as ElementTree

VARIANT_TYPES = {
    "bool": "BOOL", "int": "INT", "float": "FLOAT", "String": "STRING", "StringName": "STRING_NAME",
    "NodePath": "NODE_PATH", "Vector3": "VECTOR3", "Vector3i": "VECTOR3I", "Transform3D": "TRANSFORM3D", "Dictionary": "DICTIONARY",
    "Array": "ARRAY", "PackedStringArray": "PACKED_STRING_ARRAY", "PackedVector3Array": "PACKED_VECTOR3_ARRAY",
    "PackedInt32Array": "PACKED_INT32_ARRAY", "AABB": "AABB",
    "PackedFloat32Array": "PACKED_FLOAT32_ARRAY", "PackedFloat64Array": "PACKED_FLOAT64_ARRAY",
}  # fmt: skip
RESOURCES = {"Curve", "Curve3D", "HapticVolume", "HapticForce", "HapticGuide", "HapticMaterial", "HapticPath", "MMTNetworkConditions", "MMTTuning", "Material", "Mesh", "Texture2D"}

OWN_ATTRIBUTES = {
    "class": ["header", "includes", "changed", "was", "statistics_of"],
    "method": ["cpp", "hidden", "was", "now"],
    "member": ["range", "unit", "hint", "usage", "group", "subgroup", "param", "field", "figure", "now", "min", "max", "scale", "was", "was_scale", "changed", "follows", "shown"],
    "constant": ["is", "label", "was"],
}
# The unit that ends a key. Others say theirs in words.
KEY_UNITS = {"_us": "μs", "_ms": "ms", "_s": "s", "_per_s": "1/s", "_mm": "mm", "_m": "m", "_n": "N", "_j": "J"}


def quoted(text):
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"' if text.isascii() else f'String::utf8("{escaped}")'


def quoted_utf8(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def in_words(number):
    """A number without an exponent."""
    return f"{float(number):,.9f}".rstrip("0").rstrip(".")


def literal(text):
    """A default as C++ has it: one that an int cannot hold is of the same type as on every system, for which Variant is made."""
    return f"int64_t({text})" if re.fullmatch(r"-?\d+", text) and abs(int(text)) > 0x7FFFFFFF else text


class ClassTable:
    def __init__(self, path):
        self.path = path
        self.root = ElementTree.parse(path).getroot()
        self.name = self.root.get("name")
        if owner := self.root.get("statistics_of"):
            self.take_statistics(ElementTree.parse(path.with_name(owner + ".xml")).getroot())

    def take_statistics(self, owner):
        """Those of this group become properties."""
        members = self.root.find("members")
        for one in [one for group in owner.iter("group") if group.get("class") == self.name for one in group]:
            key = one.get("key")
            name = one.get("name", key)
            unit = next((unit for end, unit in sorted(KEY_UNITS.items(), key=lambda pair: -len(pair[0])) if key.endswith(end)), "")
            member = ElementTree.SubElement(
                members, "member", name=name, type=one.get("type"), setter="", getter=f"get_{name}", figure=key, unit=unit, usage="READ_ONLY"
            )
            member.text = re.sub(r"\[(member|method|enum|constant) (\w+)\]", rf"[\1 {owner.get('name')}.\2]", one.text)

    def is_bound(self):
        return self.root.get("header") is not None

    def all(self, kind):
        return list(self.root.iter(kind))

    def enumerators(self, enum):
        """Those of one enum; it may be another class's, then none are known here."""
        return [c for c in self.all("constant") if c.get("enum") == enum.removeprefix(f"{self.name}.")]

    # --- code

    def source(self):
        includes = [f'#include "{self.root.get("header")}"', "", "#include <godot_cpp/core/class_db.hpp>"]
        includes += [f'#include "{header}"' for header in self.root.get("includes", "").split()]
        parts = [self.checks(), self.properties(), self.validation(), self.bindings(), *(self.statistics(one) for one in self.all("statistics"))]
        return "\n".join([
            f"// Generated by extension/binding/bind_classes.py from extension/doc_classes/{self.path.name}.",
            *includes, "", "namespace tactus {", "", "using namespace godot;", "",
            *(part + "\n" for part in parts if part), "}  // namespace tactus", "",
        ])  # fmt: skip

    def checks(self):
        values = [(c.get("is") or f"{self.name}::{c.get('name')}", c.get("value")) for c in self.all("constant")]
        return "\n".join(f"static_assert(static_cast<int64_t>({is_}) == {value});" for is_, value in values)

    def bindings(self):
        lines = [line for method in self.all("method") for line in self.method(method)]
        bound = {method.get("name") for method in self.all("method")}
        for index, member in enumerate(self.all("member")):
            lines += self.member(member, index, bound)
        lines += [self.signal(signal) for signal in self.all("signal")]
        for c in self.all("constant"):
            lines += [
                f'ClassDB::bind_integer_constant(get_class_static(), "{c.get("enum", "")}", "{name}", '
                f'{c.get("value")}, {"true" if c.get("is_bitfield") else "false"});'
                for name in (c.get("name"), *c.get("was", "").split())
            ]
        return f"void {self.name}::_bind_methods() {{\n" + "\n".join("    " + line for line in lines) + "\n}"

    def method(self, method):
        if any(one.get("method") == method.get("name") for one in self.all("statistics")):
            method.set("cpp", method.get("name"))
        params = sorted(method.findall("param"), key=lambda param: int(param.get("index")))
        names = ", ".join(f'"{name}"' for name in [method.get("name"), *(param.get("name") for param in params)])
        defaults = "".join(f", DEFVAL({literal(param.get('default'))})" for param in params if param.get("default") is not None)
        function = method.get("cpp") or method.get("name")
        bind = "bind_method("
        if "static" in method.get("qualifiers", ""):
            bind = f'bind_static_method("{self.name}", '
        if now := method.get("now"):
            # One that is hidden is the getter of a former property.
            of = "get_" if method.get("hidden") else ""
            former = self.former(function, method.get("name").removeprefix(of), now.removeprefix(of))
            return [f"ClassDB::bind_method(D_METHOD({names}), {former}{defaults});"]
        lines = [f"ClassDB::{bind}D_METHOD({names}), &{self.name}::{function}{defaults});"]
        for old in method.get("was", "").split():
            former = self.former(function, old, method.get("name"))
            lines.append(f"ClassDB::bind_method(D_METHOD({names.replace(quoted(method.get('name')), quoted(old), 1)}), {former}{defaults});")
        return lines

    def former(self, function, old, now):
        """The C++ function that warns and calls this one."""
        return f'former<&{self.name}::{function}, "{old}", "{now}">(&{self.name}::{function})'

    def member(self, member, index, bound):
        lines, name = [], member.get("name")
        if group := member.get("group"):
            title, _, prefix = group.partition(":")
            lines.append(f"ADD_GROUP({quoted(title)}, {quoted(prefix)});")
        if subgroup := member.get("subgroup"):
            title, _, prefix = subgroup.partition(":")
            lines.append(f"ADD_SUBGROUP({quoted(title)}, {quoted(prefix)});")
        setter, getter = member.get("setter"), member.get("getter")
        set_by = get_by = None
        if member.get("field"):
            # A getter with a type, of which a typed script learns what the property is.
            setter, getter = setter or f"set_{name}", getter or f"get_{name}"
            set_by = f"&{self.name}::set_row<{index}>"
            get_by = f"&{self.name}::get_row<{index}, {self.value_type(member)}>"
        if key := member.get("figure"):
            get_by = f'&{self.name}::figure<"{key}", {self.value_type(member)}>'
        if member.get("follows"):
            lines.append(f'ClassDB::bind_method(D_METHOD("_{name}_changed"), &{self.name}::row_changed<{index}>);')
        param = member.get("param") or name
        for function, arguments, by in ((setter, f', "{param}"', set_by), (getter, "", get_by)):
            if function and function not in bound:
                bound.add(function)
                by = by or f"&{self.name}::{function}"
                lines.append(f'ClassDB::bind_method(D_METHOD("{function}"{arguments}), {by});')
        lines.append(f'ADD_PROPERTY({self.property_info(member)}, "{setter}", "{getter}");')
        if kind := self.node_type(member):
            node = self.node_member(member)
            lines += [
                f'ClassDB::bind_method(D_METHOD("set_{name}_node", "node"), &{self.name}::set_node_row<{index}>);',
                f'ClassDB::bind_method(D_METHOD("get_{name}_node"), &{self.name}::get_node_row<{index}, {kind}>);',
                f'ADD_PROPERTY({self.property_info(node)}, "set_{name}_node", "get_{name}_node");',
            ]
        for old in self.former_names(member):
            lines += [
                f'ClassDB::bind_method(D_METHOD("set_{old}", "{old}"), &{self.name}::set_renamed<{index}>);',
                f'ClassDB::bind_method(D_METHOD("get_{old}"), &{self.name}::get_renamed<{index}, {self.value_type(member)}>);',
                f'ADD_PROPERTY({self.property_info(self.as_it_was(member, old))}, "set_{old}", "get_{old}");',
            ]
        return lines

    @staticmethod
    def node_type(member):
        """Of the node that the path leads to; empty: it is no such path. Where it may be one of several classes: any."""
        types = member.get("hint", "").partition("NODE_PATH_VALID_TYPES:")[2]
        return "Node3D" if "," in types else types

    def node_member(self, member):
        """The node that the path leads to, for scripts: neither shown nor stored."""
        return ElementTree.Element("member", name=f"{member.get('name')}_node", type=self.node_type(member), usage="NONE")

    @staticmethod
    def former_names(member):
        """Those that it had in this class."""
        return [name for name in member.get("was", "").split() if "." not in name]

    @staticmethod
    def as_it_was(member, old):
        """Neither shown nor stored."""
        return ElementTree.Element("member", {**member.attrib, "name": old, "usage": "NONE"})

    @staticmethod
    def value_type(member):
        kind = member.get("type")
        if kind not in VARIANT_TYPES:
            return f"Ref<{kind}>"
        return {"int": "int64_t", "float": "double"}.get(kind, kind)

    def property_info(self, element):
        kind, name = element.get("type"), quoted(element.get("name"))
        variant, hint, text = VARIANT_TYPES.get(kind, "OBJECT"), "NONE", ""
        usage, class_name = "PROPERTY_USAGE_DEFAULT", ""
        if variant == "OBJECT":
            hint, text = ("RESOURCE_TYPE" if kind in RESOURCES else "NODE_TYPE"), kind
            class_name = kind
        if enum := element.get("enum"):
            hint = "ENUM"
            text = ",".join(f"{self.label(c)}:{c.get('value')}" for c in self.enumerators(enum))
            usage += " | PROPERTY_USAGE_CLASS_IS_" + ("BITFIELD" if element.get("is_bitfield") else "ENUM")
            class_name = enum
        suffix = f"suffix:{element.get('unit')}" if self.has_room_for_unit(element) else ""
        if range_ := element.get("range"):
            hint, text = "RANGE", ",".join(filter(None, (range_, suffix)))
        else:
            text = text or suffix
        if explicit := element.get("hint"):
            hint, _, text = explicit.partition(":")
        if stored := element.get("usage"):
            usage = usage.replace("PROPERTY_USAGE_DEFAULT", f"PROPERTY_USAGE_{stored}")
        usage = f"static_cast<uint32_t>({usage})" if "|" in usage else usage
        last = f", {quoted(text)}, {usage}, {quoted(class_name)}"
        return f"PropertyInfo(Variant::{variant}, {name}, PROPERTY_HINT_{hint}{last})"

    @staticmethod
    def has_room_for_unit(element):
        """The inspector cuts a long one off beside each of three numbers; the description has it as well."""
        unit = element.get("unit", "")
        return unit and (element.get("type") != "Vector3" or len(unit) <= 2)

    def label(self, constant):
        """What the inspector shows. Godot takes the list apart at its commas, and each entry at its colon."""
        label = constant.get("label", constant.get("name"))
        if set(label) & set(",:"):
            raise ValueError(f"{self.path.name}: {constant.get('name')} needs a label without comma and colon, not '{label}'")
        return label

    def signal(self, signal):
        params = sorted(signal.findall("param"), key=lambda param: int(param.get("index")))
        arguments = "".join(", " + self.property_info(param) for param in params)
        return f'ADD_SIGNAL(MethodInfo("{signal.get("name")}"{arguments}));'

    def properties(self):
        members = self.all("member")
        if not any(member.get("field") for member in members):
            return ""
        return (
            f"std::span<const Property<{self.name}>> {self.name}::properties() {{\n"
            f"    using Owner = {self.name};\n"
            f"    static const Property<Owner> all[] = {{\n" + "\n".join(map(self.row, members)) + "\n    };\n"
            "    return all;\n}"
        )

    def validation(self):
        hidden = [(m.get("name"), m.get("shown")) for m in self.all("member") if m.get("shown")]
        if not hidden:
            return ""
        conditions = " ||\n".join(f'        (name == "{name}" && !({shown}))' for name, shown in hidden)
        return (
            f"void {self.name}::_validate_property(PropertyInfo& property) const {{\n"
            f"    const String name = property.name;\n    if (\n{conditions}) {{\n"
            "        property.usage = PROPERTY_USAGE_STORAGE;\n    }\n}"
        )

    def row(self, member):
        name, field, was = member.get("name"), member.get("field"), member.get("was", "")
        if not field:
            return f'        {{"{name}", "{was}"}},'
        kind = member.get("type")
        low, high, one_of = member.get("min", "0"), member.get("max", "0"), 0
        if enum := member.get("enum"):
            values = [int(c.get("value")) for c in self.enumerators(enum)]
            low, high, one_of = min(values), max(values), sum(1 << value for value in values)
        elif kind == "bool":
            high = 1
        variant = VARIANT_TYPES.get(kind, "OBJECT")
        limits = f'{{Variant::{variant}, {low}, {high}, {one_of}u, "{kind}", {quoted_utf8(self.wanted(member))}}}'
        seconds = "_seconds" if member.get("scale") == "seconds" else ""
        changed = member.get("changed") or self.root.get("changed")
        changed = f"[](Owner& o) {{ o.{changed}(); }}" if changed else "nullptr"
        follows = f'"_{name}_changed"' if member.get("follows") else '""'
        return (
            f'        {{"{name}", "{was}", {limits},'
            f" [](const Owner& o) {{ return stored{seconds}(o.{field}); }},"
            f" [](Owner& o, const Variant& x) {{ store{seconds}(o.{field}, x); }}, {changed}, {follows}, {member.get('was_scale', '1.0')},"
            f' "{self.node_type(member)}"}},'
        )

    def wanted(self, member):
        """What a value has to be, in words."""
        kind = member.get("type")
        if enum := member.get("enum"):
            names = [c.get("name") for c in self.enumerators(enum)]
            return f"one of the constants {os.path.commonprefix(names).rpartition('_')[0]}_…"
        if kind in ("int", "float"):
            return ("" if kind == "float" else "a whole number ") + f"between {self.limits(member, ' and ')}"
        if kind == "Vector3":
            return f"finite, and no longer than {in_words(member.get('max'))}{self.unit(member)}"
        if kind.startswith("Packed"):
            element = re.sub(r"(Int|Float)\d+$", lambda found: found[1].lower(), kind.removeprefix("Packed").removesuffix("Array"))
            return f"a {kind}, or an Array of {element}"
        return {"bool": "true or false"}.get(kind, f"a {kind}" + ("" if kind in VARIANT_TYPES else ", or none"))

    def statistics(self, statistics):
        """The Dictionary of all, or of one group, and each group as an object."""
        name, method = self.name, statistics.get("method")
        groups = {group.get("class") for group in statistics.iter("group")}
        lines = [f"if (!({statistics.get('needs')})) {{", "    return Dictionary();", "}"] if statistics.get("needs") else []
        lines += [f"const auto& {let.get('name')} = {let.get('value')};" for let in statistics.findall("let")]
        lines.append("Dictionary d;")
        loose = self.figures(statistics)
        lines += ["if (of.empty()) {", *("    " + line for line in loose), "}"] if groups and loose else loose
        for one in statistics.findall("group"):
            lines += [f'if (of.empty() || of == "{one.get("class")}") {{', *("    " + line for line in self.figures(one)), "}"]
        lines.append("return d;")
        body = "\n".join("    " + line for line in lines)
        if not groups:
            return f"Dictionary {name}::{method}() const {{\n{body}\n}}"
        returned = {one.find("return").get("type"): one.get("name") for one in self.all("method")}
        return "\n\n".join([
            f"Dictionary {name}::figures(std::string_view of) const {{\n{body}\n}}",
            f'Dictionary {name}::{method}() const {{\n    return figures("");\n}}',
            *(
                f'Ref<{group}> {name}::{returned[group]}() const {{\n    return HapticStatistics::of<{group}>(figures("{group}"));\n}}'
                for group in sorted(groups)
            ),
        ])  # fmt: skip

    @staticmethod
    def figures(parent):
        """The lines that put the statistics right below it into the Dictionary."""
        lines, condition = [], None
        for one in parent.findall("statistic"):
            if one.get("if") != condition:
                lines += ["}"] if condition else []
                condition = one.get("if")
                lines += [f"if ({condition}) {{"] if condition else []
            cast = {"int": "static_cast<int64_t>", "float": "static_cast<double>"}.get(one.get("type"), "Variant")
            lines.append(f'd["{one.get("key")}"] = {cast}({one.get("value")});')
        return lines + (["}"] if condition else [])

    @staticmethod
    def registration(tables):
        """The source that makes all these classes known to the engine."""
        includes = ["nodes/register_types.hpp", *sorted({table.root.get("header") for table in tables})]
        own = {table.name for table in tables}
        tables = sorted(tables, key=lambda table: table.root.get("inherits") in own)  # a class after the one that it extends
        renamed = [table for table in tables if table.old_name()]
        return "\n".join([
            "// Generated by extension/binding/bind_classes.py from extension/doc_classes/.",
            "#include <godot_cpp/core/class_db.hpp>", "", *(f'#include "{header}"' for header in includes), "",
            "namespace tactus {", "", *(table.old_class() for table in renamed), "void register_public_classes() {",
            *(f"    GDREGISTER_CLASS({table.name});" for table in tables),
            # Virtual: scenes and scripts make objects of it, and the editor offers it no more.
            *(f"    GDREGISTER_VIRTUAL_CLASS({table.old_name()});" for table in renamed), "}", "", "}  // namespace tactus", "",
        ])  # fmt: skip

    def old_name(self):
        return self.root.get("was", "")

    def old_class(self):
        """The class under the name that it had: nothing but a message."""
        return "\n".join([
            f"class {self.old_name()} : public {self.name} {{", f"    GDCLASS({self.old_name()}, {self.name})", "", "public:",
            f'    {self.old_name()}() {{ warn_of_rename("{self.old_name()}", "{self.name}"); }}', "};", "",
        ])  # fmt: skip

    # --- the editor's help

    def help(self):
        """The XML as Godot knows it."""
        root = copy.deepcopy(self.root)
        for statistics in list(root.iter("statistics")):
            description = root.find(f"methods/method[@name='{statistics.get('method')}']/description")
            lines = [f"[code]{one.get('key')}[/code]: {one.text.strip()}" for one in statistics.iter("statistic")]
            description.text = description.text.rstrip() + "\n\t\t\t\t" + "\n\t\t\t\t".join(lines) + "\n\t\t\t"
            root.remove(statistics)
        for methods in root.iter("methods"):
            for method in methods.findall("method[@hidden]"):
                methods.remove(method)
            for method in methods.findall("method[@now]"):
                method.set("deprecated", f"Use [method {method.get('now')}] instead.")
            for method in methods.findall("method[@was]"):
                for old in method.get("was").split():
                    former = copy.deepcopy(method)
                    former.attrib.update(name=old, deprecated=f"Use [method {method.get('name')}] instead.")
                    former.find("description").text = f"The former name of [method {method.get('name')}]."
                    methods.append(former)
        for constants in root.iter("constants"):
            for constant in constants.findall("constant[@was]"):
                for old in constant.get("was").split():
                    deprecated = f"Use [constant {constant.get('name')}] instead."
                    former = ElementTree.SubElement(constants, "constant", {**constant.attrib, "name": old, "deprecated": deprecated})
                    former.text = f"The former name of [constant {constant.get('name')}]."
        for member in root.iter("member"):
            if now := member.get("now"):
                member.set("deprecated", f"Use [member {now}] instead.")
            if member.get("figure"):
                member.text = member.text.rstrip() + (f"\n\t\t\t[b]Unit:[/b] {member.get('unit')}.\n\t\t" if member.get("unit") else "")
            elif limits := self.limits(member, " to "):
                member.text = member.text.rstrip() + f"\n\t\t\t[b]Range:[/b] {limits}.\n\t\t"
            if member.get("field"):
                member.set("setter", member.get("setter") or f"set_{member.get('name')}")
                member.set("getter", member.get("getter") or f"get_{member.get('name')}")
        for members in root.iter("members"):
            for member in list(members):
                name = member.get("name")
                if kind := self.node_type(member):
                    accessors = {"setter": f"set_{name}_node", "getter": f"get_{name}_node"}
                    node = ElementTree.SubElement(members, "member", {"name": f"{name}_node", "type": kind, **accessors})
                    node.text = (
                        f"The node that [member {name}] leads to, or [code]null[/code]. Setting it makes [member {name}] the path to it. "
                        "Both nodes need one scene tree, or one node above them; a node that moves in the tree later is not followed. "
                        f"Scenes store the path alone."
                    )
                for old in self.former_names(member):
                    accessors = {"setter": f"set_{old}", "getter": f"get_{old}", "deprecated": f"Use [member {member.get('name')}] instead."}
                    former = ElementTree.SubElement(members, "member", {**member.attrib, "name": old, **accessors})
                    former.text = f"The former name of [member {member.get('name')}]."
        for kind, attributes in OWN_ATTRIBUTES.items():
            for element in root.iter(kind):
                for attribute in attributes:
                    element.attrib.pop(attribute, None)
        return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)

    def old_help(self):
        """Of the class under the name that it had."""
        root = ElementTree.Element("class", name=self.old_name(), inherits=self.name, deprecated=f"Use [{self.name}] instead.")
        ElementTree.SubElement(root, "brief_description").text = f"The former name of [{self.name}]."
        text = f"Scenes and scripts from before the class was called [{self.name}] still load and work the same, with one warning."
        ElementTree.SubElement(root, "description").text = text
        return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)

    @staticmethod
    def unit(member):
        return f" {member.get('unit')}" if member.get("unit") else ""

    def limits(self, member, between):
        if member.get("max") is None:
            return f"any, in {member.get('unit')}" if member.get("unit") and not member.get("range") else ""
        low = in_words(member.get("min", "0"))
        return f"{low}{between}{in_words(member.get('max'))}{self.unit(member)}"
