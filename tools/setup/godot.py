"""A Godot to work with: the one on this machine when it is new enough, otherwise Debian's, in a private root."""

import os
import re
import shutil
import subprocess
from pathlib import Path

from . import cache
from .debian_root import LIBRARY_FOLDER, DebianRoot

OLDEST = (4, 4)
SUITE = "forky"
PINNED = "4.6.3"
LAYOUT = "1"  # raised when what is done to the unpacked packages changes
PACKAGES = ["godot", "godot-template-release"]
SOFTWARE_GRAPHICS = [
    "libgl1", "libegl1", "libgl1-mesa-dri", "libglx-mesa0", "libegl-mesa0", "mesa-vulkan-drivers", "libvulkan1",
]  # fmt: skip


def version(command: str) -> tuple[int, ...] | None:
    try:
        text = subprocess.run([command, "--version"], text=True, capture_output=True, timeout=60).stdout
    except (OSError, subprocess.TimeoutExpired):
        return None
    found = re.search(r"^(\d+)\.(\d+)(?:\.(\d+))?\.", text, re.M)
    return tuple(int(part or 0) for part in found.groups()) if found else None


def installed() -> str | None:
    """The command in GODOT, or the first suitable one on the PATH."""
    named = os.environ.get("GODOT")
    if named:
        path = shutil.which(named)
        if not path or (version(path) or (0,)) < OLDEST:
            raise RuntimeError(f"GODOT={named} is not a Godot of at least version 4.4")
        return path
    for name in ("godot", "godot4"):
        path = shutil.which(name)
        if path and (version(path) or (0,)) >= OLDEST:
            return path
    return None


def private_folder() -> Path:
    return cache.root() / f"godot-{PINNED}"


def command() -> str | None:
    """What to start, if it is ready."""
    return installed() or (str(private_folder() / "godot") if is_private_ready() else None)


def is_private_ready() -> bool:
    # The patched paths are absolute: a cache that was moved is not ready.
    return cache.is_done(private_folder(), _key())


def _key() -> str:
    return cache.digest(LAYOUT, PINNED, str(private_folder()), *PACKAGES, *SOFTWARE_GRAPHICS)


def fetch() -> str:
    folder = private_folder()
    packages = DebianRoot(cache.root() / "downloads" / f"debian-{SUITE}", SUITE)
    packages.update()
    found = packages.candidate("godot")
    if not found.startswith(PINNED):
        raise RuntimeError(
            f"Debian's {SUITE} has Godot {found}; Tactus is tested with {PINNED}."
            " Install a Godot of at least version 4.4 and name it in GODOT."
        )
    archives = packages.fetch(PACKAGES + SOFTWARE_GRAPHICS)
    packages.unpack(archives, cache.emptied(folder) / "root")
    _make_self_contained(folder / "root")
    _write_wrapper(folder)
    if version(str(folder / "godot")) is None:
        raise RuntimeError(f"{folder}/godot does not start")
    packages.forget_downloads()
    cache.mark_done(folder, _key())
    return str(folder / "godot")


def _make_self_contained(root: Path) -> None:
    """Gives the programs the root's loader and libraries, whatever the machine's own are."""
    libraries = root / LIBRARY_FOLDER
    below = [libraries / name for name in ("pulseaudio", "lapack", "blas")]
    run_path = ":".join(str(path) for path in [libraries, *below] if path.is_dir())
    loader = str(libraries / "ld-linux-x86-64.so.2")
    for program in ("godot", "godot-template-release"):
        # The old DT_RPATH also serves the libraries' own dependencies, DT_RUNPATH does not.
        _patchelf("--set-interpreter", loader, "--force-rpath", "--set-rpath", run_path, root / "usr/bin" / program)
    for library in _with_own_run_path(libraries):
        _patchelf("--set-rpath", run_path, library)


def _with_own_run_path(folder: Path) -> list[Path]:
    """A library with a run path of its own is deaf to the program's."""
    files = [path for path in folder.glob("*.so*") if path.is_file() and not path.is_symlink()]
    return [path for path in files if path.read_bytes()[:4] == b"\x7fELF" and _patchelf("--print-rpath", path)]


def _patchelf(*arguments: object) -> str:
    command = [str(cache.venv_bin("patchelf")), *map(str, arguments)]
    return subprocess.run(command, check=True, text=True, capture_output=True).stdout.strip()


def _write_wrapper(folder: Path) -> None:
    share = f"{folder}/root/usr/share"
    wrapper = folder / "godot"
    wrapper.write_text(f"""#!/bin/sh
# Godot from its private root, with that root's graphics drivers beside the machine's own.
export LIBGL_DRIVERS_PATH="${{LIBGL_DRIVERS_PATH:-{folder}/root/{LIBRARY_FOLDER}/dri}}"
export __EGL_VENDOR_LIBRARY_DIRS="${{__EGL_VENDOR_LIBRARY_DIRS:-{share}/glvnd/egl_vendor.d}}"
export VK_DRIVER_FILES="${{VK_DRIVER_FILES:-{share}/vulkan/icd.d/lvp_icd.json}}"
export XKB_CONFIG_ROOT="${{XKB_CONFIG_ROOT:-{share}/X11/xkb}}"
exec {folder}/root/usr/bin/godot "$@"
""")
    wrapper.chmod(0o755)


def dump_api(godot: str) -> Path:
    """Writes extension_api.json and gdextension_interface.h, which the binding is generated from."""
    folder = api_folder(godot)
    folder.mkdir(parents=True, exist_ok=True)
    options = ["--headless", "--dump-extension-api-with-docs", "--dump-gdextension-interface"]
    subprocess.run([godot, *options], cwd=folder, check=True, capture_output=True)
    for name in ("extension_api.json", "gdextension_interface.h"):
        if not (folder / name).is_file():
            raise RuntimeError(f"{godot} wrote no {name}")
    cache.mark_done(folder, _version_key(godot))
    return folder


def api_folder(godot: str) -> Path:
    name = ".".join(map(str, version(godot) or (0,)))
    return cache.root() / f"godot-{name}" / "api"


def is_api_ready(godot: str) -> bool:
    return cache.is_done(api_folder(godot), _version_key(godot))


def _version_key(godot: str) -> str:
    return subprocess.run([godot, "--version"], check=True, text=True, capture_output=True).stdout.strip()


def template_path(godot: str) -> Path:
    """Where Godot looks for the export template: its version without Debian's build name."""
    name = re.match(r"\d+\.\d+(\.\d+)?\.[a-z]+\d*", _version_key(godot))
    if not name:
        raise RuntimeError(f"{godot} gives no version")
    data = os.environ.get("XDG_DATA_HOME") or str(Path.home() / ".local/share")
    return Path(data) / "godot/export_templates" / name[0] / "linux_release.x86_64"


def is_template_ready(godot: str) -> bool:
    return template_path(godot).is_file()


def install_template(godot: str) -> None:
    if installed() is not None:
        raise RuntimeError(f"install the export templates of {godot} from its editor: {template_path(godot)} is missing")
    source = private_folder() / "root/usr/bin/godot-template-release"
    target = template_path(godot)
    target.parent.mkdir(parents=True, exist_ok=True)
    partial = target.with_suffix(".partial")
    shutil.copyfile(source, partial)
    partial.chmod(0o755)
    partial.rename(target)
