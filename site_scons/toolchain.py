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
    "-Wl,--exclude-libs,ALL", "-Wl,-Bsymbolic", "-Wl,-z,defs", "-Wl,--gc-sections",
    "-static-libgcc", "-static-libstdc++",
]  # fmt: skip


# Which may stand together: address with undefined.
SANITIZERS = ["address", "undefined", "thread"]


def sanitize_flags(sanitizers):
    # What is undefined ends the program, like what the others find. Of an object's type it would ask what Jolt and
    # physics/ are compiled without.
    return [f"-fsanitize={sanitizers}", "-fno-sanitize=vptr", "-fno-sanitize-recover=all"] if sanitizers else []


def compile_flags(target, sanitizers=""):
    plain = [*LANGUAGE, *OPTIMISED, *SAME_BITS, *WARNINGS, *BY_TARGET[target]]
    if not sanitizers:
        return plain
    # Less inlining than -O3 for a quicker build; warnings that only watched code gives are not errors.
    return [*plain, "-O1", "-fno-omit-frame-pointer", "-Wno-error", *sanitize_flags(sanitizers)]


# A unique symbol would keep the library loaded for ever, and the editor from reloading it. The linker drops the
# sections that nobody uses: most of the engine's functions.
SPEAKS_GODOT = ["-fno-gnu-unique", "-ffunction-sections", "-fdata-sections"]

# Jolt is compiled without run-time type information, so what derives from its classes must be, too.
# binding/ is large, generated and never in the loop: optimising it would take most of the first build.
FLAGS_OF_LAYER = {
    "physics": ["-fno-rtti"],
    "binding": [*SPEAKS_GODOT, "-O1", "-g0"],
    "nodes": SPEAKS_GODOT,
}

# Runs on any processor, to say what is missing on an older one.
FLAGS_OF_FILE = {"extension/nodes/entry.cpp": ["-march=x86-64"]}

# Stands in front of the C library and of the sanitizers: it runs before these are ready.
NOT_WATCHED = ["tests/support/realtime_audit.cpp"]


def flags_of_file(source, sanitizers):
    audit = [f"-DTACTUS_SANITIZE_{name.upper()}=1" for name in sanitizers.split(",") if name]
    return [*FLAGS_OF_FILE.get(source, []), *(["-fno-sanitize=all", *audit] if source in NOT_WATCHED and sanitizers else [])]
