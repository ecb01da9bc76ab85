"""The demo project in Godot: import, editor, scene, export."""

import hashlib
import subprocess
import sys
from pathlib import Path

from setup import cache, display, godot, processes
from setup.steps import Step

FOLDER = cache.clone() / "demo_project"


def import_step() -> Step:
    return Step("Import the project", _is_imported, import_resources, place=cache.clone() / "build")


def import_resources() -> None:
    import_into(FOLDER)
    _stamp().write_text(content())


def name_extension(folder: Path) -> None:
    """So that a Godot that has not scanned the project yet loads it: scenes use its classes."""
    extension_list = folder / ".godot/extension_list.cfg"
    extension_list.parent.mkdir(exist_ok=True)
    extension_list.write_text("res://addons/tactus/tactus.gdextension\n")


def import_into(folder: Path) -> None:
    """Any project with the addon in it."""
    name_extension(folder)
    done = subprocess.run(
        [str(godot.command()), "--headless", "--path", folder, "--import"],
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    if done.returncode != 0:
        print(done.stdout, file=sys.stderr)
        raise RuntimeError("Godot could not import the project")


def _is_imported() -> bool:
    return _stamp().is_file() and _stamp().read_text() == content()


def _stamp() -> Path:
    return FOLDER / ".godot/imported_content"


def content() -> str:
    """Names, sizes and times of what Godot imports."""
    digest = hashlib.sha256(str(godot.command()).encode())
    for path in sorted(FOLDER.rglob("*")):
        if path.is_file() and ".godot" not in path.parts:
            status = path.stat()
            digest.update(f"{path}\0{status.st_size}\0{status.st_mtime_ns}\n".encode())
    return digest.hexdigest()


def help_step() -> Step:
    return Step("The editor's help", _has_help, _prepare_help)


def _prepare_help() -> None:
    # A Godot that has never been an editor before collects its own class reference and forgets that of extensions; from
    # the second start on, both are there.
    command = [str(godot.command()), "--headless", "--editor", "--path", str(FOLDER), "--quit-after", "20"]
    subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120)


def _has_help() -> bool:
    base = cache.xdg_folder("XDG_CACHE_HOME", ".cache")
    major, minor, *_ = godot.version(str(godot.command())) or (0, 0)
    return (base / "godot" / f"editor_doc_cache-{major}.{minor}.res").is_file()


def run(*arguments: str) -> int:
    """Godot on the project, in a window; without a screen, in a virtual one."""
    with display.environment() as environment:
        command = [str(godot.command()), "--path", str(FOLDER), *arguments]
        return processes.run(command, env=environment)


def export() -> int:
    folder = cache.clone() / "build/export"
    with cache.replacing(folder) as fresh:
        export_to(fresh / "tactus.x86_64")
    print(f"{cache.shown(folder / 'tactus.x86_64')} {_runs_on()}")
    return 0


def _runs_on() -> str:
    """Where the program runs: its template may lie upon libraries of the cache."""
    if godot.installed():
        return "runs on its own"
    return f"runs on this machine, for this user: its libraries are in {cache.root()}. For others, export with a Godot of your own (docs/development.md)"


def export_to(target: Path, folder: Path = FOLDER) -> None:
    """The program, with the extension's library beside it."""
    command = [str(godot.command()), "--headless", "--path", folder, "--export-release", "Linux", target]
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0 or not target.is_file():
        raise RuntimeError(f"Godot could not export the project:\n{done.stdout[-3000:]}")
