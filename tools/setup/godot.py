"""A Godot to work with: the one on this machine when it is new enough, otherwise Debian's, in a private root."""

import os
import re
import shutil
import subprocess
from pathlib import Path

from . import cache, progress
from .debian_root import LIBRARY_FOLDER, DebianRoot, mirrors
from .fetching import Unreachable

OLDEST = (4, 4)
TESTED = "4.6.3"
# Where a Godot is looked for, one after the other: a suite gets a newer one, and is put away one day.
SUITES = ["forky", "testing", "unstable"]
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
    found = re.search(r"^\d+\.\d+(\.\d+)?\.", text, re.M)
    return _numbers(found[0]) if found else None


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


def private_folders() -> list[Path]:
    """Those that are ready; the tested version first, then the newest. An older one is a kept copy."""
    found = [folder for folder in cache.root().glob("godot-*") if cache.is_done(folder, _key(folder))]
    return sorted(found, key=lambda folder: (folder.name == f"godot-{TESTED}", _numbers(folder.name)), reverse=True)


def command() -> str | None:
    """What to start, if it is ready."""
    own = installed()
    if own:
        return own
    return next((str(folder / "godot") for folder in private_folders()), None)


def is_private_ready() -> bool:
    return bool(private_folders())


def _key(folder: Path) -> str:
    # The patched paths are absolute: a cache that was moved is not ready.
    return cache.digest(LAYOUT, folder.name.removeprefix("godot-"), str(folder), *PACKAGES, *SOFTWARE_GRAPHICS)


def _numbers(text: str) -> tuple[int, ...]:
    """Of a version, the first three."""
    found = re.search(r"(\d+)\.(\d+)(?:\.(\d+))?", text)
    return tuple(int(part or 0) for part in found.groups()) if found else (0,)


def fetch() -> str:
    packages, found = _first_suite_with_godot()
    name = ".".join(map(str, _numbers(found)))
    if name != TESTED:
        print(f"{name} from {packages.suite} (tested with {TESTED}) … ", end="", flush=True)
    folder = cache.root() / f"godot-{name}"
    with progress.watching(packages.fetched):
        archives = packages.fetch(PACKAGES + SOFTWARE_GRAPHICS)
    packages.unpack(archives, cache.emptied(folder) / "root")
    _make_self_contained(folder / "root")
    _write_wrapper(folder)
    if version(str(folder / "godot")) is None:
        raise RuntimeError(f"{folder}/godot does not start")
    packages.forget_downloads()
    cache.mark_done(folder, _key(folder))
    return str(folder / "godot")


def _first_suite_with_godot() -> tuple[DebianRoot, str]:
    """A suite that has one that is new enough, and its version. Every archive of the machine's apt sources is asked."""
    troubles, reached = [], False
    for suite in SUITES:
        for address in mirrors():
            packages = DebianRoot(cache.root() / "downloads" / f"debian-{suite}", suite, address)
            try:
                packages.update()
                reached = True
                found = packages.candidate("godot")
            except RuntimeError as error:
                troubles.append(error if isinstance(error, Unreachable) else f"{suite}: {error}")
                continue
            if _numbers(found) >= OLDEST:
                return packages, found
            troubles.append(f"{suite} has Godot {found}: too old")
    if not reached and isinstance(troubles[0], Unreachable):
        raise troubles[0]
    raise RuntimeError(
        "no Debian archive of this machine's apt sources has a Godot of at least version 4.4. Install one and name it in"
        " GODOT.\n" + "\n".join(map(str, troubles))
    )


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
    return cache.xdg_folder("XDG_DATA_HOME", ".local/share") / "godot/export_templates" / name[0] / "linux_release.x86_64"


def is_template_ready(godot: str) -> bool:
    return template_path(godot).is_file()


def install_template(godot: str) -> None:
    if installed() is not None:
        raise RuntimeError(f"install the export templates of {godot} from its editor: {template_path(godot)} is missing")
    source = Path(godot).parent / "root/usr/bin/godot-template-release"
    target = template_path(godot)
    target.parent.mkdir(parents=True, exist_ok=True)
    partial = target.with_suffix(".partial")
    shutil.copyfile(source, partial)
    partial.chmod(0o755)
    partial.rename(target)
