"""The built-in types whose memory only the engine understands: String, Array, Callable, the packed arrays …"""

from pathlib import Path

from generator.api import (
    MATH_TYPES,
    OPAQUE_TYPES,
    Signature,
    Unsupported,
    constant_case,
    header_of,
    safe_name,
    snake_case,
)
from generator.global_scope import enum_lines

FRAGMENTS = Path(__file__).parent / "fragments"

OPERATORS = {
    "==": "EQUAL",
    "!=": "NOT_EQUAL",
    "<": "LESS",
    "<=": "LESS_EQUAL",
    ">": "GREATER",
    ">=": "GREATER_EQUAL",
    "+": "ADD",
    "%": "MODULE",
}

ELEMENTS = {
    "PackedByteArray": "uint8_t",
    "PackedInt32Array": "int32_t",
    "PackedInt64Array": "int64_t",
    "PackedFloat32Array": "float",
    "PackedFloat64Array": "double",
    "PackedStringArray": "String",
    "PackedVector2Array": "Vector2",
    "PackedVector3Array": "Vector3",
    "PackedColorArray": "Color",
    "PackedVector4Array": "Vector4",
}


def type_constant(name):
    return f"GDEXTENSION_VARIANT_TYPE_{constant_case(name)}"


def fragment_of(name):
    """Members written by hand that stand in the class beside the generated ones."""
    path = FRAGMENTS / f"{snake_case(name)}.inc"
    if name in ELEMENTS:
        path = FRAGMENTS / "packed_array.inc"
    if not path.exists():
        return ""
    text = path.read_text(encoding="utf-8").replace("@CLASS@", name).replace("@ELEMENT@", ELEMENTS.get(name, ""))
    return "".join(f"    {line}\n" if line else "\n" for line in text.splitlines())


def wants_operator(name, operator):
    right = operator.get("right_type")
    if operator["name"] not in OPERATORS or right is None:
        return False
    if operator["name"] == "%":
        return right in ("Array", "Variant")
    return right in OPAQUE_TYPES


class BuiltinWriter:
    def __init__(self, api, name):
        self.api = api
        self.name = name
        self.entry = api.builtins[name]
        self.size = next(size["size"] for size in api.sizes if size["name"] == name)
        self.declarations = []
        self.definitions = []
        self.includes = {"gdextension_interface.h", "godot_cpp/core/defs.hpp", "initializer_list", "utility"}
        self.forward = set()

    def declare(self, line):
        self.declarations.append(f"    {line}" if line else "")

    def define(self, *lines):
        self.definitions += [*lines, ""]

    def note(self, signature):
        """Defaults need complete types, everything else only a name."""
        for _, cpp, default in signature.arguments:
            if default is not None and cpp.name in OPAQUE_TYPES and cpp.name != self.name:
                self.includes.add(header_of(cpp.name))
        for cpp in signature.types():
            if cpp.name in MATH_TYPES:
                self.includes.add(header_of(cpp.name))
            elif cpp.name in OPAQUE_TYPES + ["Variant"] and cpp.name != self.name:
                self.forward.add(cpp.name)
            self.forward.update(cpp.objects)

    def constructors(self):
        name = self.name
        for constructor in self.entry["constructors"]:
            signature = Signature(self.api, constructor)
            self.note(signature)
            arguments = "".join(f", {argument}" for argument in signature.names())
            self.declare(f"{name}({signature.parameters(False)});")
            self.define(
                f"{name}::{name}({signature.parameters(False)}) {{",
                "    static const GDExtensionPtrConstructor constructor =",
                f"        internal::find_constructor({type_constant(name)}, {constructor['index']});",
                f"    internal::call_constructor(constructor, opaque_{arguments});",
                "}",
            )
        self.declare(f"{name}({name}&& other) noexcept : {name}() {{ swap_memory(other); }}")
        self.declare(f"{name}& operator=(const {name}& other) {{")
        self.declare(f"    {name} copy(other);")
        self.declare("    swap_memory(copy);")
        self.declare("    return *this;")
        self.declare("}")
        self.declare(f"{name}& operator=({name}&& other) noexcept {{")
        self.declare("    swap_memory(other);")
        self.declare("    return *this;")
        self.declare("}")
        if self.entry["has_destructor"]:
            self.declare(f"~{name}();")
            self.define(
                f"{name}::~{name}() {{",
                "    static const GDExtensionPtrDestructor destructor =",
                f"        internal::find_destructor({type_constant(name)});",
                "    destructor(opaque_);",
                "}",
            )
        self.declare("")

    def methods(self):
        for method in self.entry.get("methods", []):
            try:
                signature = Signature(self.api, method)
            except Unsupported:
                continue
            self.note(signature)
            if method["is_vararg"]:
                self.vararg_method(method, signature)
            else:
                self.plain_method(method, signature)
        self.declare("")

    def lookup(self, method):
        return (
            "    static const GDExtensionPtrBuiltInMethod method =\n"
            f'        internal::find_builtin_method({type_constant(self.name)}, "{method["name"]}", {method["hash"]});'
        )

    def plain_method(self, method, signature):
        name = safe_name(method["name"])
        result = signature.result_type()
        suffix = " const" if method["is_const"] else ""
        prefix = "static " if method["is_static"] else ""
        own = "nullptr" if method["is_static"] else "opaque_"
        arguments = "".join(f", {argument}" for argument in signature.names())
        self.define(
            f"{result} {self.name}::{name}({signature.parameters(False)}){suffix} {{",
            self.lookup(method),
            f"    return internal::call_builtin_method<{result}>(method, {own}{arguments});",
            "}",
        )
        shorter = signature.without_variant_default()
        if shorter is None:
            self.declare(f"{prefix}{result} {name}({signature.parameters(True)}){suffix};")
            return
        # Variant is not complete yet, so its default becomes a second function.
        self.declare(f"{prefix}{result} {name}({signature.parameters(False)}){suffix};")
        self.declare(f"{prefix}{result} {name}({shorter.parameters(True)}){suffix};")
        self.define(
            f"{result} {self.name}::{name}({shorter.parameters(False)}){suffix} {{",
            f"    return {name}({', '.join(shorter.names() + ['Variant()'])});",
            "}",
        )

    def vararg_method(self, method, signature):
        name = safe_name(method["name"])
        result = signature.result_type()
        suffix = " const" if method["is_const"] else ""
        fixed = signature.parameters(False)
        fixed = fixed + ", " if fixed else ""
        values = "".join(f"Variant({argument}), " for argument in signature.names())
        count = len(signature.arguments)
        self.forward.add("Variant")
        self.declare("template <class... A>")
        # Variant is complete wherever this is called; here it must stay a dependent name.
        later = "internal::Later<Variant, A...>::type" if result == "Variant" else result
        self.declare(f"{later} {name}({fixed}const A&... p_arguments){suffix} {{")
        self.declare("    using Value = typename internal::Later<Variant, A...>::type;")
        self.declare(f"    const Value values[sizeof...(A) + {count + 1}] = "
                     f"{{{values.replace('Variant(', 'Value(')}Value(p_arguments)..., Value()}};")
        self.declare(f"    return {name}_values(values, sizeof...(A) + {count});")
        self.declare("}")
        self.declare(f"{result} {name}_values(const Variant* values, size_t count){suffix};")
        self.define(
            f"{result} {self.name}::{name}_values(const Variant* values, size_t count){suffix} {{",
            self.lookup(method),
            f"    return internal::call_vararg_builtin<{result}>(method, opaque_, values, count);",
            "}",
        )

    def operators(self):
        for operator in self.entry["operators"]:
            if not wants_operator(self.name, operator):
                continue
            right = operator["right_type"]
            result = "bool" if operator["return_type"] == "bool" else operator["return_type"]
            symbol = operator["name"]
            if right != self.name:
                self.forward.add(right)
            self.declare(f"{result} operator{symbol}(const {right}& p_other) const;")
            right_constant = "GDEXTENSION_VARIANT_TYPE_NIL" if right == "Variant" else type_constant(right)
            self.define(
                f"{result} {self.name}::operator{symbol}(const {right}& p_other) const {{",
                "    static const GDExtensionPtrOperatorEvaluator evaluate = internal::find_operator(",
                f"        GDEXTENSION_VARIANT_OP_{OPERATORS[symbol]}, {type_constant(self.name)}, {right_constant});",
                f"    return internal::call_operator<{result}>(evaluate, opaque_, p_other);",
                "}",
            )
        self.declare("")

    def enums_and_constants(self):
        for enum in self.entry.get("enums", []):
            self.declarations += enum_lines(enum, "    ")

    def header(self):
        if self.name in ELEMENTS:
            self.includes.add("godot_cpp/core/math.hpp")
            if ELEMENTS[self.name] in MATH_TYPES + OPAQUE_TYPES:
                self.includes.add(header_of(ELEMENTS[self.name]))
        if self.name in ("Callable", "Signal"):
            self.includes.add("godot_cpp/private/later.hpp")
        if self.name == "String":
            self.includes.add("godot_cpp/variant/char_string.hpp")
        if self.name in ("Array", "Dictionary"):
            self.forward.add("Variant")
        fragment = fragment_of(self.name)
        forward = "".join(
            f"{'struct' if name in MATH_TYPES else 'class'} {name};\n"
            for name in sorted(self.forward - {self.name})
        )
        body = "\n".join(self.declarations)
        tail = FRAGMENTS / f"{snake_case(self.name)}_after.inc"
        after = tail.read_text(encoding="utf-8") if tail.exists() else ""
        return f"""namespace godot {{

{forward}
class {self.name} {{
public:
{body}
{fragment}
    void* _native_ptr() const {{ return const_cast<uint8_t*>(opaque_); }}

private:
    void swap_memory({self.name}& other) noexcept {{ std::swap(opaque_, other.opaque_); }}

    alignas(8) uint8_t opaque_[{self.size}];
}};
{after}
}}  // namespace godot
"""

    def write(self, output):
        self.enums_and_constants()
        self.constructors()
        self.methods()
        self.operators()
        body = self.header()
        output.write_header(header_of(self.name), sorted(self.includes), body)


def write_builtins(api, output):
    definitions = []
    for name in OPAQUE_TYPES:
        writer = BuiltinWriter(api, name)
        writer.write(output)
        definitions += writer.definitions
    middle = len(definitions) // 2
    while definitions[middle]:
        middle += 1
    for index, part in enumerate((definitions[:middle], definitions[middle:])):
        output.write_source(
            f"builtins_{index}",
            ["godot_cpp/core/object.hpp", "godot_cpp/private/vararg.hpp", "godot_cpp/variant/variant.hpp"],
            "namespace godot {\n\n" + "\n".join(part) + "\n}  // namespace godot\n",
        )
