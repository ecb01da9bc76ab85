"""The wrappers of the engine's classes."""

from generator.api import Signature, Unsupported, header_of, safe_name, snake_case
from generator.builtins import FRAGMENTS
from generator.global_scope import enum_lines

SOURCES = 8  # the wrappers are compiled in this many pieces

RENAMED = {("Node", "get_node"): "get_node_internal"}  # Node has get_node<T>() instead, as in godot-cpp


class ClassWriter:
    def __init__(self, api, name):
        self.api = api
        self.name = name
        self.entry = api.classes[name]
        self.engine_name = self.entry["name"]
        self.base = api.cpp_class(self.entry["inherits"]) if "inherits" in self.entry else "Wrapped"
        self.includes = {header_of(self.base), "godot_cpp/classes/global_constants.hpp"}
        self.source_includes = {header_of(name)}
        self.forward = set()
        self.declarations = []
        self.definitions = []
        self.virtuals = []
        self.left_out = []
        self.methods = 0
        if self.base == "Wrapped":
            self.includes |= {"godot_cpp/private/ptrcall.hpp", "godot_cpp/variant/variant.hpp"}
        elif name != "RefCounted":
            self.includes.add("godot_cpp/classes/ref.hpp")

    def declare(self, line=""):
        self.declarations.append(f"    {line}" if line else "")

    def define(self, *lines):
        self.definitions += [*lines, ""]

    def note(self, signature):
        for cpp in signature.types():
            if cpp.kind == "array":
                self.includes.add("godot_cpp/variant/typed_array.hpp")
            for needed in cpp.complete:
                if needed not in (self.name, "Array"):
                    self.includes.add(header_of(needed))
            for used in cpp.objects:
                self.source_includes.add(header_of(used))
                if used != self.name:
                    self.forward.add(used)

    def constants(self):
        for enum in self.entry.get("enums", []):
            self.declarations += enum_lines(enum, "    ")
        for constant in self.entry.get("constants", []):
            self.declare(f"static constexpr int {constant['name']} = {constant['value']};")
        if self.entry.get("constants"):
            self.declare()

    def singleton(self):
        if self.name not in self.api.singletons:
            return
        self.declare(f"static {self.name}* get_singleton();")
        self.declare()
        self.define(
            f"{self.name}* {self.name}::get_singleton() {{",
            f"    static GodotObject* const object = internal::find_singleton(\"{self.api.singletons[self.name]}\");",
            f"    return static_cast<{self.name}*>(internal::get_object_instance_binding(object));",
            "}",
        )

    def all_methods(self):
        for method in self.entry.get("methods", []):
            try:
                signature = Signature(self.api, method)
            except Unsupported as missing:
                self.left_out.append((method["name"], str(missing)))
                continue
            self.note(signature)
            self.methods += 1
            if method["is_virtual"]:
                self.virtual_method(method, signature)
            elif method["is_vararg"]:
                self.vararg_method(method, signature)
            else:
                self.plain_method(method, signature)

    def lookup(self, method):
        return (
            "    static const GDExtensionMethodBindPtr method =\n"
            f'        internal::find_engine_method("{self.engine_name}", "{method["name"]}", {method["hash"]});'
        )

    def method_name(self, method):
        return RENAMED.get((self.name, method["name"]), safe_name(method["name"]))

    def plain_method(self, method, signature):
        name = self.method_name(method)
        result = signature.result_type()
        suffix = " const" if method["is_const"] else ""
        prefix = "static " if method["is_static"] else ""
        own = "nullptr" if method["is_static"] else "_owner"
        arguments = "".join(f", {argument}" for argument in signature.names())
        self.declare(f"{prefix}{result} {name}({signature.parameters(True)}){suffix};")
        self.define(
            f"{result} {self.name}::{name}({signature.parameters(False)}){suffix} {{",
            self.lookup(method),
            f"    return internal::call_engine_method<{result}>(method, {own}{arguments});",
            "}",
        )

    def vararg_method(self, method, signature):
        name = self.method_name(method)
        result = signature.result_type()
        suffix = " const" if method["is_const"] else ""
        fixed = signature.parameters(False)
        fixed = fixed + ", " if fixed else ""
        values = "".join(f"Variant({argument}), " for argument in signature.names())
        count = len(signature.arguments)
        self.declare("template <class... A>")
        self.declare(f"{result} {name}({fixed}const A&... p_arguments){suffix} {{")
        self.declare(
            f"    const Variant values[sizeof...(A) + {count + 1}] = {{{values}Variant(p_arguments)..., Variant()}};"
        )
        self.declare(f"    return {name}_values(values, sizeof...(A) + {count});")
        self.declare("}")
        self.declare(f"{result} {name}_values(const Variant* values, size_t count){suffix};")
        call = "internal::call_vararg_engine_method(method, _owner, values, count)"
        if result == "void":
            answer = f"    {call};"
        elif result == "Variant":
            answer = f"    return {call};"
        else:
            answer = f"    return static_cast<{result}>({call}.operator int64_t());"
        self.define(
            f"{result} {self.name}::{name}_values(const Variant* values, size_t count){suffix} {{",
            self.lookup(method),
            answer,
            "}",
        )

    def virtual_method(self, method, signature):
        name = method["name"]
        result = signature.result_type()
        suffix = " const" if method["is_const"] else ""
        self.virtuals.append(name)
        self.declare(f"virtual {result} {name}({signature.parameters(False)}){suffix};")
        unnamed = signature.parameters(False, named=False)
        body = "{}" if result == "void" else "{\n    return {};\n}"
        if signature.result and signature.result.kind == "enum":
            body = f"{{\n    return static_cast<{result}>(0);\n}}"
        self.define(f"{result} {self.name}::{name}({unnamed}){suffix} {body}")

    def virtual_registration(self):
        self.declarations += ["", "protected:"]
        self.declare("template <class T, class B>")
        self.declare("static void register_virtuals() {")
        self.declare(f"    {self.base}::template register_virtuals<T, B>();")
        for name in self.virtuals:
            self.declare(f"    if constexpr (!std::is_same_v<decltype(&B::{name}), decltype(&T::{name})>) {{")
            self.declare(f'        internal::bind_virtual<&T::{name}>(T::get_class_static(), "{name}");')
            self.declare("    }")
        self.declare("}")
        if self.virtuals:
            self.includes.add("godot_cpp/private/bind_virtual.hpp")

    def header(self):
        forward = "".join(f"class {name};\n" for name in sorted(self.forward - {self.base}))
        fragment_path = FRAGMENTS / f"{snake_case(self.name)}.inc"
        fragment = ""
        if fragment_path.exists():
            lines = fragment_path.read_text(encoding="utf-8").splitlines()
            fragment = "\n".join(f"    {line}" if line else "" for line in lines) + "\n\n"
        note = ""
        if self.left_out:
            names = ", ".join(f"{name} ({reason})" for name, reason in self.left_out)
            note = f"// Left out, their types are not in classes.txt: {names}.\n"
        casts = [
            f"VARIANT_{'BITFIELD' if enum['is_bitfield'] else 'ENUM'}_CAST({self.name}::{enum['name']})\n"
            for enum in self.entry.get("enums", [])
        ]
        tail = ""
        if casts:
            tail = "\n#include <godot_cpp/core/type_info.hpp>\n\n" + "".join(casts)
        body = "\n".join(self.declarations)
        return f"""namespace godot {{

{forward}
{note}class {self.name} : public {self.base} {{
    GDEXTENSION_CLASS({self.name}, {self.base})

public:
{fragment}{body}
}};

}}  // namespace godot
{tail}"""

    def write(self, output):
        self.constants()
        self.singleton()
        self.all_methods()
        self.virtual_registration()
        if self.base == "Wrapped":
            self.includes = (self.includes - {header_of("Wrapped")}) | {"godot_cpp/classes/wrapped.hpp"}
        body = self.header()
        output.write_header(header_of(self.name), sorted(self.includes), body)


def write_classes(api, output):
    writers = [ClassWriter(api, name) for name in api.classes]
    for writer in writers:
        writer.write(output)
    write_sources(writers, output)
    write_class_table(api, output)
    return writers


def write_sources(writers, output):
    """Classes in alphabetical order, cut into pieces of about the same number of methods."""
    share = sum(writer.methods for writer in writers) / SOURCES
    pieces = [[] for _ in range(SOURCES)]
    done = 0
    for writer in writers:
        pieces[min(SOURCES - 1, int(done / share))].append(writer)
        done += writer.methods
    for index, piece in enumerate(pieces):
        includes = {"godot_cpp/private/vararg.hpp", "godot_cpp/core/object.hpp"}
        definitions = []
        for writer in piece:
            includes |= writer.source_includes
            definitions += writer.definitions
        output.write_source(
            f"classes_{index}",
            sorted(includes),
            "namespace godot {\n\n" + "\n".join(definitions) + "\n}  // namespace godot\n",
        )


def write_class_table(api, output):
    rows = "\n".join(
        f'    {{"{api.classes[name]["name"]}", &ClassAccess::binding_callbacks<{name}>}},' for name in api.classes
    )
    output.write_source(
        "class_table",
        ["godot_cpp/private/class_table.hpp"]
        + ["godot_cpp/private/class_access.hpp"]
        + [header_of(name) for name in api.classes],
        f"""namespace godot::internal {{

const EngineClass engine_classes[] = {{
{rows}
}};
const size_t engine_class_count = sizeof(engine_classes) / sizeof(engine_classes[0]);

}}  // namespace godot::internal
""",
    )


