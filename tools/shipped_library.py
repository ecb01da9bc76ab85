"""What is known of a library from its file alone: what it must find where it is loaded, and whether Godot finds its door."""

import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

from setup import platforms, zig
from setup.platforms import Platform

ENTRY = "tactus_library_init"
OWN = r"(?:@rpath/)?libtactus\."  # a library of macOS is listed with what it asks for
# What every machine of the system has.
OF_THE_SYSTEM = {
    "windows": {
        "kernel32.dll", "msvcrt.dll", "advapi32.dll", "ws2_32.dll", "avrt.dll", "winmm.dll", "psapi.dll",
        "api-ms-win-core-synch-l1-2-0.dll",  # of Windows 8 on
    },
    "macos": {"/usr/lib/libsystem.b.dylib"},
    "linux": {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"},
}


@dataclass(frozen=True)
class ShippedLibrary:
    libraries: frozenset[str]  # that it asks for, in lower case
    has_entry: bool
    glibc: str  # the oldest that it can be loaded with; empty: it asks for none

    def complaint(self, system: str) -> str:
        """Why it must not be given away; empty: it may."""
        if not self.has_entry:
            return f"does not show {ENTRY}"
        strange = sorted(self.libraries - OF_THE_SYSTEM[system])
        return f"needs {', '.join(strange)}, which would have to lie beside it" if strange else ""


def described(text: str) -> ShippedLibrary:
    """`text`: of objdump -p, followed by objdump -T where there are dynamic symbols; of macOS, what it asks for and exports."""
    asked_for = re.findall(rf"^\s*(?:NEEDED|DLL Name:)\s+(\S+)|^\t(?!{OWN})(\S+) \(compat", text, re.M)
    exported = re.search(rf"^\s*\[\s*\d+\]\s.*\b{ENTRY}$|^\S+ g .*\.text\s.*\b{ENTRY}$|^0x\w+  _{ENTRY}$", text, re.M)
    versions = [tuple(map(int, found.split("."))) for found in re.findall(r"\bGLIBC_(\d+(?:\.\d+)+)", text)]
    oldest = ".".join(map(str, max(versions))) if versions else ""
    return ShippedLibrary(frozenset((name or path).lower() for name, path in asked_for), bool(exported), oldest)


def read(path: Path, platform: Platform) -> ShippedLibrary:
    if platform.system == "windows":
        return described(_output([platform.tool("objdump"), "-p", path]))
    if platform.system == "linux":
        return described(_output([platform.tool("objdump"), "-p", "-T", path]))
    slices = platforms.ARCHITECTURES if platform.architecture == platforms.UNIVERSAL else [platform.architecture]
    reader = [zig.llvm("llvm-objdump"), "--macho", "--dylibs-used", "--exports-trie"]
    return together([described(_output([*reader, f"--arch={one}", path])) for one in slices])


def together(slices: list[ShippedLibrary]) -> ShippedLibrary:
    """A universal library: each processor loads its slice alone."""
    asked_for = frozenset(name for one in slices for name in one.libraries)
    return ShippedLibrary(asked_for, all(one.has_entry for one in slices), "")


def _output(command: list) -> str:
    done = subprocess.run(command, text=True, capture_output=True)
    # LLVM's ends with 0 where it has found none.
    if done.returncode != 0 or done.stdout.rstrip().endswith("is not an object file"):
        raise RuntimeError(f"{command[-1]} is no library: {done.stderr.strip() or done.stdout.strip()}")
    return done.stdout
