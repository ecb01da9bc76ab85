"""Compiler flags: one set for everything, so that the same numbers come out of every build."""

OPTIMISED = ["-O3", "-march=x86-64-v3", "-fno-math-errno"]
# A fused multiply-add rounds once where the source rounds twice; whether one is made depends on inlining.
SAME_BITS = ["-ffp-contract=off"]
# gcc 12 warns of overlap inside its own std::string (-Wrestrict, its bug 105651).
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Werror", "-Wno-restrict"]
LANGUAGE = ["-std=c++20", "-fno-exceptions", "-fPIC", "-fvisibility=hidden", "-fvisibility-inlines-hidden"]

BY_TARGET = {
    "template_debug": ["-g1"],  # assertions on: thread roles, preconditions
    "template_release": ["-DNDEBUG"],
}

# Godot carries a Jolt of its own: neither may see the other's symbols.
LINK_EXTENSION = [
    "-Wl,--exclude-libs,ALL", "-Wl,-Bsymbolic", "-Wl,-z,defs", "-Wl,--gc-sections", "-static-libgcc", "-static-libstdc++",
]  # fmt: skip


def compile_flags(target):
    return [*LANGUAGE, *OPTIMISED, *SAME_BITS, *WARNINGS, *BY_TARGET[target]]


# A unique symbol would keep the library loaded for ever, and the editor from reloading it. The linker drops the
# sections that nobody uses: most of the engine's functions.
SPEAKS_GODOT = ["-fno-gnu-unique", "-ffunction-sections", "-fdata-sections"]

# Jolt is compiled without run-time type information, so what derives from its classes must be, too.
FLAGS_OF_LAYER = {"physics": ["-fno-rtti"], "binding": SPEAKS_GODOT, "nodes": SPEAKS_GODOT}

# Runs on any processor, to say what is missing on an older one.
FLAGS_OF_FILE = {"extension/nodes/entry.cpp": ["-march=x86-64"]}
