"""Compiler flags: one set for everything, so that the same numbers come out of every build."""

import os
import re
import shutil
import subprocess
from pathlib import Path

from setup import cache

# A fused multiply-add rounds once where the source rounds twice; whether one is made depends on inlining.
SAME_BITS = ["-ffp-contract=off"]
# All the same gcc 12 makes one instruction of two products whose sums alternate (vfmaddsub), where it puts plain
# arithmetic into vectors by itself. What is to lie in vectors says so (core/math/lanes.hpp), and loses nothing.
NO_ALTERNATING_SUMS = {"x86_64": ["-fno-tree-slp-vectorize"]}
# gcc for x86-64 clears a few hundred bytes by `rep stos`, which is slow to begin: a fifth of a free tick of the proxy
# went there. Moves of 32 bytes begin at once.
CLEAR_BY_MOVES = ["-mmemset-strategy=vector_loop:512:noalign,libcall:-1:noalign"]
# gcc 12 warns of overlap inside its own std::string (-Wrestrict, its bug 105651).
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Werror"]
FALSE_WARNINGS_OF_GCC = ["-Wno-restrict"]

BY_TARGET = {
    "template_debug": ["-g1"],  # assertions on: thread roles, preconditions
    "template_release": ["-DNDEBUG"],
}

# Godot carries a Jolt of its own: neither may see the other's symbols.
LINK_EXTENSION = {
    "linux": [
        "-Wl,--exclude-libs,ALL", "-Wl,-Bsymbolic", "-Wl,-z,defs", "-Wl,--gc-sections",
        "-static-libgcc", "-static-libstdc++",
    ],
    # A DLL shows what is marked so, and no more.
    "windows": ["-static", "-Wl,--gc-sections"],
    "macos": ["-Wl,-dead_strip", "-Wl,-undefined,error"],
}  # fmt: skip

# What players get names no function: a fifth of the library.
LINK_FOR = {"template_debug": [], "template_release": ["-s"]}

# Nothing of the compiler has to lie beside a program for another machine.
LINK_PROGRAM = {"linux": [], "windows": ["-static"], "macos": []}


# What stands in front of the C library where its functions cannot simply be defined once more:
# tests/support/realtime_audit_windows.cpp.
WRAPPED = [
    "malloc", "calloc", "realloc", "free", "pthread_mutex_lock", "pthread_mutex_trylock", "pthread_cond_wait",
    "pthread_cond_timedwait", "pthread_join", "__imp__aligned_malloc", "__imp__aligned_free",
    "__imp_AcquireSRWLockExclusive", "__imp_AcquireSRWLockShared", "__imp_TryAcquireSRWLockExclusive",
    "__imp_TryAcquireSRWLockShared",
]  # fmt: skip
# The file that stands there is taken from its archive also where only the compiler's own libraries ask for it.
LINK_AUDIT = {
    "linux": [],
    "windows": [*(f"-Wl,--wrap={name}" for name in WRAPPED), "-Wl,-u,__wrap_malloc"],
    "macos": [],
}


# Which may stand together: address with undefined, and both with the fuzzer.
SANITIZERS = ["address", "undefined", "thread", "fuzzer"]


def sanitize_flags(sanitizers, is_fuzzed=False):
    """Of every program, or of one whose main() is libFuzzer's own."""
    # What is undefined ends the program, like what the others find. Of an object's type it would ask what Jolt and
    # physics/ are compiled without.
    named = sanitizers if is_fuzzed else sanitizers.replace("fuzzer", "fuzzer-no-link")
    return [f"-fsanitize={named}", "-fno-sanitize=vptr", "-fno-sanitize-recover=all"] if sanitizers else []


def fuzzing_compiler():
    """The newest clang that has libFuzzer beside it; "" where there is none."""

    def has_fuzzer(compiler):
        folder = subprocess.run([compiler, "-print-runtime-dir"], text=True, capture_output=True, check=True).stdout.strip()
        beside = [Path(folder), Path(folder).parent / "linux"]
        return any(one.glob("libclang_rt.fuzzer*.a") for one in beside)

    found = {path.name: path for folder in os.environ["PATH"].split(os.pathsep) for path in Path(folder).glob("clang++*")}
    versions = {int(name.partition("-")[2] or 0): path for name, path in found.items() if re.fullmatch(r"clang\+\+(-\d+)?", name)}
    return next((str(path) for _, path in sorted(versions.items(), reverse=True) if has_fuzzer(path)), "")


def without_places():
    """Files are named as they lie in the clone, whoever has built them: objects are shared between clones, and libraries are
    given away. What stands between $( and $) is no part of what an object depends on."""
    places = {Path(__file__).resolve().parents[1]: ".", cache.root(): "cache"}
    return ["$(", *(f"-ffile-prefix-map={place}={name}".replace("$", "$$") for place, name in places.items()), "$)"]


def compile_flags(platform, target, sanitizers=""):
    """What belongs to the platform comes with it: tools/setup/platforms.py."""
    language = ["-std=c++20", "-fno-exceptions", *platform.position, "-fvisibility=hidden", "-fvisibility-inlines-hidden"]
    optimised = ["-O3", *platform.machine, "-fno-math-errno"]
    same_bits = [*SAME_BITS, *NO_ALTERNATING_SUMS.get(platform.architecture, [])]
    is_gcc = platform.system != "macos" and "fuzzer" not in sanitizers
    moves = CLEAR_BY_MOVES if is_gcc and platform.architecture == "x86_64" else []
    warnings = [*WARNINGS, *(FALSE_WARNINGS_OF_GCC if is_gcc else [])]
    plain = [*language, *optimised, *moves, *same_bits, *warnings, *BY_TARGET[target], *without_places()]
    if not sanitizers:
        return plain
    # Less inlining than -O3 for a quicker build; warnings that only watched code gives are not errors, and another
    # compiler's are not looked at.
    other = ["-w"] if "fuzzer" in sanitizers else ["-Wno-error"]
    return [*plain, "-O1", "-fno-omit-frame-pointer", *other, *sanitize_flags(sanitizers)]


# The linker drops the sections without a user: most of the engine's functions.
SPEAKS_GODOT = ["-ffunction-sections", "-fdata-sections"]
# A unique symbol, which ELF alone has, would keep the library loaded for ever, and the editor from reloading it.
NO_UNIQUE_SYMBOLS = {"linux": ["-fno-gnu-unique"], "windows": ["-fno-gnu-unique"], "macos": []}

# Jolt is compiled without run-time type information, so what derives from its classes must be, too.
# binding/ is large, generated and never in the loop: optimising it would take most of the first build.
FLAGS_OF_LAYER = {
    "physics": ["-fno-rtti"],
    "binding": [*SPEAKS_GODOT, "-O1", "-g0"],
    "nodes": SPEAKS_GODOT,
    # What stands beneath it throws; it lets nothing out: core/ports/depth_sensing.hpp.
    "sensing": ["-fexceptions"],
}


def flags_of_layer(platform, layer):
    unique = NO_UNIQUE_SYMBOLS[platform.system] if layer in ("binding", "nodes") else []
    return [*unique, *FLAGS_OF_LAYER.get(layer, [])]


# Run on any processor, to say what is missing on an older one.
ANY_PROCESSOR = {"-march=x86-64-v3": ["-march=x86-64"], "-march=x86_64_v3": ["-march=x86_64"]}
RUN_ANYWHERE = ["extension/nodes/entry.cpp", "extension/platform/processor_x86_64.cpp"]

# Stands in front of the C library and of the sanitizers: it runs before these are ready.
NOT_WATCHED = ["tests/support/realtime_audit.cpp", "tests/support/realtime_audit_linux.cpp"]

# Of tests alone: gcc 12 takes the variants in copied lists of shapes for uninitialized.
FALSE_ALARMS = ["-Wno-maybe-uninitialized"]


def flags_of_file(platform, source, sanitizers):
    anywhere = [flag for one in platform.machine for flag in ANY_PROCESSOR.get(one, [])] if source in RUN_ANYWHERE else []
    audit = [f"-DTACTUS_SANITIZE_{name.upper()}=1" for name in sanitizers.split(",") if name]
    return [*anywhere, *(["-fno-sanitize=all", *audit] if source in NOT_WATCHED and sanitizers else [])]


# Debian's PCL does not stand -march=native, and throws.
AS_PCL = ["-std=c++20", "-O2", "-fPIC", "-w"]


def openni():
    """Folders of OpenNI2's headers, where OPENNI2_INCLUDE names them or the system has them; none where it is not installed."""
    named = os.environ.get("OPENNI2_INCLUDE", "")
    found = [Path(folder) for folder in (named, "/usr/include/openni2", "/usr/local/include/openni2") if folder]
    return [folder for folder in found if (folder / "OniCAPI.h").is_file() and (folder / "Driver/OniDriverAPI.h").is_file()][:1]


# A library that is loaded later finds the played poll() and ioctl() first.
LINK_PLAYED = ["-Wl,--export-dynamic-symbol=poll", "-Wl,--export-dynamic-symbol=ioctl"]


def umockdev():
    """Flags to compile and link with umockdev, which plays devices of the system; none where it is not installed."""
    command = ["pkg-config", "--cflags", "--libs", "umockdev-1.0"]
    if not shutil.which("umockdev-run"):  # what has to be loaded before the C library comes with it
        return [], []
    try:
        words = subprocess.run(command, text=True, capture_output=True, check=True).stdout.split()
    except (OSError, subprocess.CalledProcessError):
        return [], []
    folders = [word.removeprefix("-I") for word in words if word.startswith("-I")]
    compile = [word for folder in folders for word in ("-isystem", folder)]
    return compile, [word.removeprefix("-l") for word in words if word.startswith("-l")]
