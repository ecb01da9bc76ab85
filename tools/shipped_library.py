"""What is known of a library from its file alone: what it must find where it is loaded, and whether Godot finds its door."""

import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

from setup.platforms import Platform

ENTRY = "tactus_library_init"
# What every machine of the system has.
OF_THE_SYSTEM = {
    "windows": {
        "kernel32.dll", "msvcrt.dll", "advapi32.dll", "ws2_32.dll", "avrt.dll", "winmm.dll", "psapi.dll",
        "api-ms-win-core-synch-l1-2-0.dll",  # of Windows 8 on
    },
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
    """`text`: of objdump -p, followed by objdump -T where there are dynamic symbols."""
    asked_for = re.findall(r"^\s*(?:NEEDED|DLL Name:)\s+(\S+)", text, re.M)
    exported = re.search(rf"^\s*\[\s*\d+\]\s.*\b{ENTRY}$|^\S+ g .*\.text\s.*\b{ENTRY}$", text, re.M)
    versions = [tuple(map(int, found.split("."))) for found in re.findall(r"\bGLIBC_(\d+(?:\.\d+)+)", text)]
    oldest = ".".join(map(str, max(versions))) if versions else ""
    return ShippedLibrary(frozenset(name.lower() for name in asked_for), bool(exported), oldest)


def read(path: Path, platform: Platform) -> ShippedLibrary:
    options = ["-p"] if platform.system == "windows" else ["-p", "-T"]
    done = subprocess.run([platform.tool("objdump"), *options, path], text=True, capture_output=True)
    if done.returncode != 0:
        raise RuntimeError(f"{path} is no library: {done.stderr.strip()}")
    return described(done.stdout)
