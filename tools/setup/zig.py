"""Zig, whose clang builds for macOS on any system: its package has the headers of macOS's C library, what a linker must know
of that library, and libc++. It has none of Apple's frameworks, and Tactus asks for none.

Zig 0.17.1 has no FLT_MAX and no INFINITY in C++20 for macOS; 0.15.2 has. Beside it stand the compiler, archiver and readers by the names that GNU's cross tools have, so that nothing else knows Zig.
"""

import os
from pathlib import Path

from . import cache, python_tools

BIN = cache.root() / "zig/bin"
OLDEST = "11.0"  # macOS: the first for both processors
ARCHITECTURES = ("x86_64", "aarch64")
LICENSE_OF_LIBCXX = cache.root() / "zig/lib/python*/site-packages/ziglang/lib/libcxx/LICENSE.TXT"
LLVM = "/usr/lib/llvm-*/bin"  # Debian's, for what Zig has not


def is_done() -> bool:
    return python_tools.is_done("zig") and all(path.is_file() and path.read_text() == text for path, text in _scripts().items())


def install() -> None:
    if not python_tools.is_done("zig"):
        python_tools.install("zig")
    for path, text in _scripts().items():
        path.write_text(text)
        path.chmod(0o755)


def llvm(tool: str) -> Path:
    """One of LLVM's tools, of the newest release that is there."""
    found = sorted(Path("/").glob(f"{LLVM.lstrip('/')}/{tool}"), key=lambda path: int(path.parts[-3].partition("-")[2] or 0))
    if not found:
        raise RuntimeError(f"{tool} is not on this machine: Debian's package llvm has it")
    return found[-1]


def _scripts() -> dict[Path, str]:
    found = {}
    for architecture in ARCHITECTURES:
        # Zig watches what is undefined where nothing else is asked for.
        compile = f"-target {architecture}-macos.{OLDEST} -fno-sanitize=all"
        calls = {"g++": f"c++ {compile}", "gcc": f"cc {compile}", "ar": "ar", "ranlib": "ranlib"}
        for name, call in calls.items():
            found[BIN / f"{architecture}-apple-darwin-{name}"] = _script(call)
    return found


def _script(call: str) -> str:
    kept = cache.root() / "zig-cache"
    lines = [f"export ZIG_GLOBAL_CACHE_DIR='{kept}' ZIG_LOCAL_CACHE_DIR='{kept}'", f"exec '{python_tools.python('zig')}' -m ziglang {call} \"$@\""]
    return "\n".join(["#!/bin/sh", *lines, ""])


def path_with_tools() -> str:
    return f"{BIN}{os.pathsep}{os.environ['PATH']}"
