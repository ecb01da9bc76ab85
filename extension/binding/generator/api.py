"""The engine's API description, and how its types are written in C++."""

import json
import re
from copy import copy

# Hand-written under include/godot_cpp/variant: plain structs with the engine's memory layout.
MATH_TYPES = (
    "Vector2 Vector2i Rect2 Rect2i Vector3 Vector3i Transform2D Vector4 Vector4i Plane Quaternion AABB Basis "
    "Transform3D Projection Color"
).split()

# Generated: memory that only the engine understands.
OPAQUE_TYPES = (
    "String StringName NodePath RID Callable Signal Dictionary Array PackedByteArray PackedInt32Array "
    "PackedInt64Array PackedFloat32Array PackedFloat64Array PackedStringArray PackedVector2Array "
    "PackedVector3Array PackedColorArray PackedVector4Array"
).split()

BUILTIN_TYPES = MATH_TYPES + OPAQUE_TYPES + ["Variant"]

# 64-bit pointers, single-precision real_t: what Godot's own builds are.
BUILD_CONFIGURATION = "float_64"

INTEGERS = {
    "int8": "int8_t",
    "int16": "int16_t",
    "int32": "int32_t",
    "int64": "int64_t",
    "uint8": "uint8_t",
    "uint16": "uint16_t",
    "uint32": "uint32_t",
    "uint64": "uint64_t",
    "char16": "char16_t",
    "char32": "char32_t",
}

KEYWORDS = {"new", "delete", "default", "operator", "class", "template", "typeof", "union", "xor", "or", "and", "not"}


class Unsupported(Exception):
    """A type that the chosen classes do not reach: the method that uses it is left out."""


def snake_case(name):
    """Node3D -> node3d, PhysicsServer3D -> physics_server3d: the names of the headers."""
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Za-z0-9])(?=[A-Z][a-z])", "_", name)
    return words.replace("2_D", "2D").replace("3_D", "3D").lower()


def constant_case(name):
    """PackedByteArray -> PACKED_BYTE_ARRAY: the names of Variant::Type."""
    return snake_case(name).upper()


def safe_name(name):
    return {"typeof": "type_of"}.get(name, name + "_" if name in KEYWORDS else name)


def header_of(type_name):
    folder = "variant" if type_name in BUILTIN_TYPES else "classes"
    return f"godot_cpp/{folder}/{snake_case(type_name)}.hpp"


class Api:
    def __init__(self, path, chosen_classes):
        with open(path, encoding="utf-8") as file:
            description = json.load(file)
        self.header = description["header"]
        self.builtins = {entry["name"]: entry for entry in description["builtin_classes"]}
        self.global_enums = description["global_enums"]
        self.utility_functions = description["utility_functions"]
        self.singletons = {self.cpp_class(entry["type"]): entry["name"] for entry in description["singletons"]}
        self.sizes = self._for_this_build(description["builtin_class_sizes"], "sizes")
        self.member_offsets = self._for_this_build(description["builtin_class_member_offsets"], "classes")
        self.all_classes = {self.cpp_class(entry["name"]): entry for entry in description["classes"]}
        self.classes = self._with_bases(chosen_classes)

    @staticmethod
    def _for_this_build(entries, key):
        return next(entry[key] for entry in entries if entry["build_configuration"] == BUILD_CONFIGURATION)

    @staticmethod
    def cpp_class(name):
        # The engine's class list is itself a class of that list; its C++ name is taken.
        return "ClassDBSingleton" if name == "ClassDB" else name

    def _with_bases(self, chosen_classes):
        reached = set()
        for name in chosen_classes:
            if name not in self.all_classes:
                raise SystemExit(f"classes.txt: this Godot has no class {name}")
            while name and name not in reached:
                reached.add(name)
                name = self.cpp_class(self.all_classes[name].get("inherits", ""))
        return {name: self.all_classes[name] for name in sorted(reached)}

    def is_refcounted(self, class_name):
        return self.all_classes[class_name]["is_refcounted"]


class CppType:
    """One type of the API: how it is written, what it needs to be declared and defined."""

    def __init__(self, api, name, meta=None):
        self.name = name
        self.objects = []  # classes that a declaration only has to name
        self.complete = []  # types that must be complete already in the declaration
        self.kind = "value"
        self.plain = self._resolve(api, name, meta)

    def _resolve(self, api, name, meta):
        if name == "bool":
            self.kind = "bool"
            return "bool"
        if name == "int":
            self.kind = "number"
            return INTEGERS[meta or "int64"]
        if name == "float":
            self.kind = "number"
            return "float" if meta == "float" else "double"
        if name.startswith(("enum::", "bitfield::")):
            return self._resolve_enum(api, name)
        if name.startswith("typedarray::"):
            self.kind = "array"
            element = CppType(api, name.split("::", 1)[1].split(":")[-1])
            self.objects = element.objects
            self.complete = ["Array"]
            return f"TypedArray<{element.element_name()}>"
        if name in BUILTIN_TYPES:
            self.kind = "builtin"
            return name
        if name in api.classes:
            self.objects = [name]
            self.kind = "ref" if api.is_refcounted(name) else "object"
            return f"Ref<{name}>" if self.kind == "ref" else f"{name}*"
        raise Unsupported(name)

    def _resolve_enum(self, api, name):
        category, path = name.split("::")
        owner, _, enum = path.rpartition(".")
        if owner and owner != "Variant" and owner not in BUILTIN_TYPES:
            owner = api.cpp_class(owner)
            if owner not in api.classes:
                raise Unsupported(name)
            self.complete = [owner]
        self.enum = f"{owner}::{enum}" if owner else enum
        self.kind = category
        return f"BitField<{self.enum}>" if category == "bitfield" else self.enum

    def element_name(self):
        return self.objects[0] if self.objects else self.plain

    def argument(self):
        if self.kind in ("bool", "number", "enum", "object"):
            return self.plain
        if self.kind == "bitfield":
            return self.plain
        return f"const {self.plain}&"

    def default(self, value):
        """A default value of the description as a C++ expression."""
        if value == "null":
            return "Variant()" if self.name == "Variant" else "nullptr"
        if self.kind == "enum":
            return f"static_cast<{self.enum}>({value})"
        if self.kind == "array":
            return f"{self.plain}()"
        if value == "[]":
            return "Array()"
        if value == "{}":
            return "Dictionary()"
        if value.startswith('&"'):
            return value[1:]
        if value == "inf":
            return "INFINITY"
        if value == "-9223372036854775808":
            return "INT64_MIN"
        return value


class Signature:
    """Arguments and result of a function of the API, in C++."""

    def __init__(self, api, entry):
        self.arguments = []
        for argument in entry.get("arguments", []):
            meta = argument.get("meta")
            cpp = CppType(api, argument["type"], None if meta == "required" else meta)
            self.arguments.append((f"p_{argument['name']}", cpp, argument.get("default_value")))
        result = entry.get("return_value") or ({"type": entry["return_type"]} if "return_type" in entry else None)
        self.result = None
        if result is not None:
            meta = result.get("meta")
            self.result = CppType(api, result["type"], None if meta == "required" else meta)

    def types(self):
        return [cpp for _, cpp, _ in self.arguments] + ([self.result] if self.result else [])

    def result_type(self):
        return self.result.plain if self.result else "void"

    def parameters(self, with_defaults, named=True):
        parts = []
        for name, cpp, default in self.arguments:
            part = f"{cpp.argument()} {name}" if named else cpp.argument()
            if with_defaults and default is not None:
                part += f" = {cpp.default(default)}"
            parts.append(part)
        return ", ".join(parts)

    def without_variant_default(self):
        """The same without its last argument, when that is a Variant with a default; otherwise None."""
        if not self.arguments or self.arguments[-1][1].name != "Variant" or self.arguments[-1][2] is None:
            return None
        shorter = copy(self)
        shorter.arguments = self.arguments[:-1]
        return shorter

    def names(self):
        return [name for name, _, _ in self.arguments]
