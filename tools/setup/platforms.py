"""What Tactus is built for, and with which tools."""

import platform
import sys
from dataclasses import dataclass

X86_64 = ("-march=x86-64-v3",)
# gcc for Windows does not align the stack for 32-byte vectors (its bug 54412): the assembler writes moves that do not
# mind. Before Windows 10, timers were too coarse for a tick.
WINDOWS = ("-Wa,-muse-unaligned-vector-move", "-D_WIN32_WINNT=0x0A00", "-DWIN32_LEAN_AND_MEAN", "-DNOMINMAX")


@dataclass(frozen=True)
class Platform:
    name: str  # of ./run and scons
    system: str  # linux, windows, macos: the endings of sources, and Godot's feature tags
    architecture: str  # x86_64, arm64
    prefix: str  # of the compiler's and its tools' names; empty: this machine's own
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
    def compiler(self) -> str:
        # Debian's two for Windows differ in their threads; only this one's know C++'s.
        return self.prefix + ("g++-posix" if self.system == "windows" else "g++")

    def tool(self, name: str) -> str:
        return self.prefix + name


def host() -> Platform:
    system = "macos" if sys.platform == "darwin" else "linux"
    arm = platform.machine() in ("arm64", "aarch64")
    name = system if arm == (system == "macos") else f"{system}_{'arm64' if arm else 'x86_64'}"
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
]  # fmt: skip


def tested_by(word: str) -> Platform | None:
    """What `./run test WORD` means, if it means a platform: windows, arm64."""
    return next((one for one in FOREIGN if word in (one.system, one.architecture)), None)


def named_in(arguments: list[str]) -> list[Platform]:
    """Those that --platform=NAME[,NAME…] or --all asks for, besides this machine's own."""
    if "--all" in arguments:
        return list(FOREIGN)
    names = [name for word in arguments if word.startswith("--platform=") for name in word.partition("=")[2].split(",")]
    return [one for one in map(named, dict.fromkeys(names)) if one.is_foreign]


def named(name: str) -> Platform:
    """One of these; a RuntimeError names them all."""
    known = {one.name: one for one in [host(), *FOREIGN]}
    if name not in known:
        raise RuntimeError(f"platform={name}: choose from {', '.join(known)}")
    return known[name]
