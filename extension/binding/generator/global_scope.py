"""Global enums, utility functions, sizes: what belongs to no class."""

from generator.api import MATH_TYPES, OPAQUE_TYPES, Signature, Unsupported, header_of, safe_name
from generator.marshal import call_lines


def enum_lines(enum, indent=""):
    underlying = " : uint64_t" if enum.get("is_bitfield") else ""
    lines = [f"{indent}enum {enum['name']}{underlying} {{"]
    lines += [f"{indent}    {value['name']} = {value['value']}," for value in enum["values"]]
    return lines + [f"{indent}}};", ""]


def write_global_constants(api, output):
    lines = ["namespace godot {", ""]
    for enum in api.global_enums:
        if not enum["name"].startswith("Variant."):
            lines += enum_lines(enum)
    lines += ["}  // namespace godot", ""]
    output.write_header("godot_cpp/classes/global_constants.hpp", ["cstdint"], "\n".join(lines))

    casts = [
        f"VARIANT_{'BITFIELD' if enum.get('is_bitfield') else 'ENUM'}_CAST({enum['name']})"
        for enum in api.global_enums
        if not enum["name"].startswith("Variant.")
    ]
    casts += ["VARIANT_ENUM_CAST(Variant::Type)", "VARIANT_ENUM_CAST(Variant::Operator)"]
    output.write_header(
        "godot_cpp/classes/global_constants_binds.hpp",
        ["godot_cpp/core/type_info.hpp"],
        "\n".join(casts) + "\n",
    )


def write_sizes(api, output):
    sizes = {entry["name"]: entry["size"] for entry in api.sizes}
    output.write_header(
        "godot_cpp/private/sizes.hpp",
        ["cstddef"],
        "namespace godot::internal {\n\n"
        f"inline constexpr size_t size_of_variant = {sizes['Variant']};\n\n"
        "}  // namespace godot::internal\n",
    )
    checks = [f"static_assert(sizeof({name}) == {sizes[name]});" for name in MATH_TYPES + OPAQUE_TYPES + ["Variant"]]
    for entry in api.member_offsets:
        if entry["name"] in MATH_TYPES and entry["name"] not in ("Basis", "Transform2D", "Projection"):
            for member in entry["members"]:
                checks.append(f"static_assert(offsetof({entry['name']}, {member['member']}) == {member['offset']});")
    output.write_source(
        "layout",
        ["cstddef", "godot_cpp/variant/variant.hpp"],
        "// The memory of these types is shared with the engine.\n\nnamespace godot {\n\n"
        + "\n".join(checks)
        + "\n\n}  // namespace godot\n",
    )


LEFT_OUT = {"is_instance_valid"}  # godot-cpp has none either


def write_utility_functions(api, output):
    declarations = []
    definitions = []
    for entry in api.utility_functions:
        if entry["name"] in LEFT_OUT:
            continue
        try:
            signature = Signature(api, entry)
        except Unsupported:
            continue
        name = safe_name(entry["name"])
        result = signature.result_type()
        lookup = f'    static constinit internal::UtilityFunction function("{entry["name"]}", {entry["hash"]});'
        if entry["is_vararg"]:
            # The first argument stands in the description only to say that there is one.
            declarations += [
                "    template <class... A>",
                f"    static {result} {name}(const Variant& p_first, const A&... p_rest) {{",
                "        const Variant values[] = {p_first, Variant(p_rest)...};",
                f"        return {name}_values(values, sizeof...(A) + 1);",
                "    }",
                f"    static {result} {name}_values(const Variant* values, size_t count);",
                "",
            ]
            definitions += [
                f"{result} UtilityFunctions::{name}_values(const Variant* values, size_t count) {{",
                lookup,
                f"    return internal::call_vararg_utility<{result}>(function, values, count);",
                "}",
                "",
            ]
            continue
        count = len(signature.arguments)
        declarations.append(f"    static {result} {name}({signature.parameters(True)});")
        definitions += [
            f"{result} UtilityFunctions::{name}({signature.parameters(False)}) {{",
            lookup,
            *call_lines(signature, lambda given, back, count=count: f"function.call({given}, {back}, {count})"),
            "}",
            "",
        ]
    output.write_header(
        "godot_cpp/variant/utility_functions.hpp",
        ["godot_cpp/variant/variant.hpp"],
        "namespace godot {\n\nclass UtilityFunctions {\npublic:\n"
        + "\n".join(declarations)
        + "\n};\n\n}  // namespace godot\n",
    )
    output.write_source(
        "utility_functions",
        [
            header_of("Object"),
            "godot_cpp/private/vararg.hpp",
            "godot_cpp/variant/utility_functions.hpp",
        ],
        "namespace godot {\n\n" + "\n".join(definitions) + "\n}  // namespace godot\n",
    )
