"""The C functions that the engine offers, as one table."""

import re



def functions_of(header_text):
    """(name, typedef) of every function documented in gdextension_interface.h, in its order."""
    found = re.findall(r"@name (\w+)\n.*?\*/\s*typedef [^;]*?\(\*(\w+)\)\(", header_text, flags=re.S)
    return [(name, typedef) for name, typedef in found if name != "get_proc_address"]


def write_interface(output, header_text):
    functions = functions_of(header_text)
    output.write("include/gdextension_interface.h", header_text)
    members = "\n".join(f"    {typedef} {name} = nullptr;" for name, typedef in functions)
    output.write_header(
        "godot_cpp/private/interface.hpp",
        ["gdextension_interface.h"],
        f"""namespace godot::internal {{

// What the engine of this process offers; a function that it does not know stays null.
struct Interface {{
{members}
}};

extern Interface interface;
extern GDExtensionClassLibraryPtr library;
extern void* token;

void load_interface(GDExtensionInterfaceGetProcAddress get_proc_address);

}}  // namespace godot::internal
""",
    )
    loads = "\n".join(f'    load(interface.{name}, "{name}");' for name, _ in functions)
    output.write_source(
        "interface",
        ["godot_cpp/private/interface.hpp"],
        f"""namespace godot::internal {{

Interface interface;

void load_interface(GDExtensionInterfaceGetProcAddress get_proc_address) {{
    const auto load = [get_proc_address]<class Function>(Function& function, const char* name) {{
        function = reinterpret_cast<Function>(get_proc_address(name));
    }};
{loads}
}}

}}  // namespace godot::internal
""",
    )


