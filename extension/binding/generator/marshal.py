"""The body of a wrapper: C++ values into the memory the engine expects, the call, and the way back.

    C++                          engine
    bool                         uint8_t
    any integer, enum            int64_t
    float, double                double
    Node*, Ref<Resource>         the engine's object pointer
    everything else              the value itself, in place

Written out instead of left to templates: the compiler is three times as fast.
"""

WIRE_TYPE = {"bool": "uint8_t", "enum": "int64_t", "bitfield": "int64_t", "object": "GodotObject*", "ref": "GodotObject*"}


def wire_type(cpp):
    if cpp.kind == "number":
        return "double" if cpp.plain in ("float", "double") else "int64_t"
    return WIRE_TYPE.get(cpp.kind, cpp.plain)


def encoded(name, cpp):
    """An expression of the wire type; None when the value can be handed over in place."""
    if cpp.kind in ("bool", "number", "enum"):
        return name if wire_type(cpp) == cpp.plain else f"static_cast<{wire_type(cpp)}>({name})"
    if cpp.kind == "object":
        return f"internal::owner_of({name})"
    if cpp.kind == "ref":
        return f"internal::owner_of({name}.ptr())"
    return None


def decoded(cpp):
    if cpp.kind == "bool":
        return "result != 0"
    if cpp.kind == "object":
        return f"internal::object_as<{cpp.objects[0]}>(result)"
    if cpp.kind == "ref":
        return f"internal::ref_as<{cpp.objects[0]}>(result)"
    if cpp.kind in ("builtin", "array", "bitfield") or wire_type(cpp) == cpp.plain:
        return "result"
    return f"static_cast<{cpp.plain}>(result)"


def argument_lines(signature):
    """Declares `arguments`, the array of pointers that every ptrcall takes; says what to pass for it."""
    lines, pointers = [], []
    for name, cpp, _ in signature.arguments:
        expression = encoded(name, cpp)
        if expression is None or expression == name:
            pointers.append(f"&{name}")
            continue
        wire = f"{name.removeprefix('p_')}_wire"
        lines.append(f"    const auto {wire} = {expression};")
        pointers.append(f"&{wire}")
    if not pointers:
        return [], "nullptr"
    lines.append(f"    const void* const arguments[] = {{{', '.join(pointers)}}};")
    return lines, "arguments"


def call_lines(signature, call):
    """`call(arguments, result)` gives the C++ call; the lines around it hand over and take back."""
    lines, arguments = argument_lines(signature)
    if signature.result is None:
        return [*lines, f"    {call(arguments, 'nullptr')};"]
    wire = wire_type(signature.result)
    start = f"    {wire} result;" if signature.result.kind in ("builtin", "array") else f"    {wire} result{{}};"
    return [*lines, start, f"    {call(arguments, '&result')};", f"    return {decoded(signature.result)};"]
