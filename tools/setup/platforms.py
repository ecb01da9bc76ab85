"""What Tactus is built for, and with which tools."""

import platform
import sys
from dataclasses import dataclass, replace

from . import zig

X86_64 = ("-march=x86-64-v3",)
# gcc for Windows does not align the stack for 32-byte vectors (its bug 54412): the assembler writes moves that do not
# mind. Before Windows 10, timers were too coarse for a tick.
WINDOWS = ("-Wa,-muse-unaligned-vector-move", "-D_WIN32_WINNT=0x0A00", "-DWIN32_LEAN_AND_MEAN", "-DNOMINMAX")


# The universal library of macOS has a slice for each processor. Cross compilers have GNU's names: tools/setup/zig.py.
UNIVERSAL = "universal"
ARCHITECTURES = ("x86_64", "arm64")


@dataclass(frozen=True)
class Platform:
    name: str  # of ./run and scons
    system: str  # linux, windows, macos: the endings of sources, and Godot's feature tags
    architecture: str  # x86_64, arm64; of what is given away also UNIVERSAL
    prefix: str  # of the compiler's and its tools' names, with their folder where it is not in PATH; empty: this machine's own
    machine: tuple[str, ...]  # flags of every compiler call, also for what others wrote
    position: tuple[str, ...] = ("-fPIC",)  # and how code finds its own data
    libraries: tuple[str, ...] = ()  # of the system, that the extension needs
    emulator: tuple[str, ...] = ()  # what runs its programs here

    @property
    def is_foreign(self) -> bool:
        return bool(self.prefix)

    @property
    def flags(self) -> tuple[str, ...]:
        return (*self.position, *self.machine)

    @property
    def triple(self) -> str:
        """The cross compiler's name of the platform, as configure scripts take it."""
        return self.prefix.rpartition("/")[2].rstrip("-")

    @property
    def compiler(self) -> str:
        # Debian's two for Windows differ in their threads; only this one's know C++'s.
        return self.prefix + ("g++-posix" if self.system == "windows" else "g++")

    def tool(self, name: str) -> str:
        return self.prefix + name


def host() -> Platform:
    system = "macos" if sys.platform == "darwin" else "linux"
    arm = platform.machine() in ("arm64", "aarch64")
    name = f"{system}_{'arm64' if arm else 'x86_64'}" if arm or system == "macos" else system
    return Platform(name, system, "arm64" if arm else "x86_64", "", () if arm else X86_64)


FOREIGN = [
    Platform(
        "windows", "windows", "x86_64", "x86_64-w64-mingw32-", (*X86_64, *WINDOWS), (),
        libraries=("ws2_32", "avrt", "winmm", "psapi", "synchronization"), emulator=("/usr/lib/wine/wine64",),
    ),
    Platform(
        "linux_arm64", "linux", "arm64", "aarch64-linux-gnu-", ("-march=armv8-a",),
        emulator=("/usr/bin/qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"),
    ),
    Platform("macos_x86_64", "macos", "x86_64", f"{zig.BIN}/x86_64-apple-darwin-", ("-march=x86_64_v3",)),  # as Zig spells it
    Platform("macos_arm64", "macos", "arm64", f"{zig.BIN}/aarch64-apple-darwin-", ()),
]  # fmt: skip


def tested_by(word: str) -> Platform | None:
    """What `./run test WORD` means, if it means a platform: windows, arm64."""
    return next((one for one in FOREIGN if one.emulator and word in (one.system, one.architecture)), None)


def names() -> list[str]:
    """What --platform takes: the platforms, and a system whose slices are joined."""
    return [*(one.name for one in [host(), *FOREIGN]), "macos"]


def given_away(platforms: list[Platform]) -> list[Platform]:
    """Of the same libraries as an archive has them: one universal platform in place of macOS's slices, where all are there."""
    slices = [one for one in platforms if one.system == "macos"]
    if len(slices) < 2:
        return platforms
    joined = replace(slices[0], name="macos", architecture=UNIVERSAL)
    return [*(one for one in platforms if one.system != "macos"), joined]


def named_in(arguments: list[str]) -> list[Platform]:
    """Those that --platform=NAME[,NAME…] or --all asks for, besides this machine's own."""
    if "--all" in arguments:
        return list(FOREIGN)
    names = [name for word in arguments if word.startswith("--platform=") for name in word.partition("=")[2].split(",")]
    slices = [one.name for one in FOREIGN if one.system == "macos"]
    asked_for = [part for name in names for part in (slices if name == "macos" else [name])]
    return [one for one in map(named, dict.fromkeys(asked_for)) if one.is_foreign]


def named(name: str) -> Platform:
    """One of these; a RuntimeError names them all."""
    known = {one.name: one for one in [host(), *FOREIGN]}
    if name not in known:
        raise RuntimeError(f"platform={name}: choose from {', '.join(known)}")
    return known[name]
