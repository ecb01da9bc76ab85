"""A small clone in which everything that the front door sets up is there already, as stand-ins that do nothing or wait.

Only programs beside the front door are stand-ins: SCons, Godot, the virtual screen, the tools' Python, the installer of
packages. Each leaves its name in `started` when it begins to wait, with a process of its own session beside it.
"""

import os
import shutil
import signal
import subprocess
import sys
import time
import uuid
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAPERS = ["CHANGELOG.md", "README.md", "LICENSE", "CITATION.cff", "CONTRIBUTING.md", "SECURITY.md", "CODE_OF_CONDUCT.md"]
COPIED = ["run", "SConstruct", *PAPERS, "docs", "tools", "site_scons", "tests/bench", "extension", "demo_project"]
LEFT_OUT = shutil.ignore_patterns(".godot", "bin", "__pycache__", "*.cpp~")

# Waits where its name is among WAITS, else does what `otherwise` says.
SCRIPT = """#!/bin/bash
name={name}
case "$*" in
*--version* | *--dump* | *--import* | *--quit-after*) WAITS="" ;;  # Godot, on the way there
esac
case " $WAITS " in
*" $name "*)
    setsid sleep 1000 &
    echo "$name" >>"$STAND_INS/started"
    sleep 1000
    ;;
esac
{otherwise}
"""
GODOT = 'case "$*" in --version) echo 4.6.3.stable.stand_in ;; *--dump*) echo "{}" >extension_api.json; touch gdextension_interface.h ;; *--export*) [ ${EXPORT_ENDS:-0} = 0 ] && echo new >"${@: -1}"; exit ${EXPORT_ENDS:-0} ;; esac'
SCREEN = """while [ $# -gt 0 ]; do [ "$1" = -displayfd ] && fd=$2; shift; done
echo 99 >&$fd
setsid sleep 1000 &
sleep 1000"""


def _hear_all() -> None:
    """What was started in the background, or by nohup, begins deaf to these, and so does all that it starts."""
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)


class Clone:
    def __init__(self, folder: Path):
        self.folder, self.programs = folder / "clone", folder / "programs"
        self.cache = folder / "cache"
        self.mark = uuid.uuid4().hex
        for name in COPIED:
            target = self.folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, target, ignore=LEFT_OUT)
            else:
                shutil.copy(ROOT / name, target)
        self.programs.mkdir()
        venv = self.cache / "tactus/venv"
        (venv / "bin").mkdir(parents=True)
        self._write(self.programs / "godot", GODOT)
        self._write(self.programs / "Xvfb", SCREEN)
        self._write(venv / "bin/scons", "exit ${SCONS_ENDS:-0}")
        self._write(venv / "bin/python", f'exec {sys.executable} "$@"')
        self._write(self.folder / "tools/debian_packages.sh", 'echo "$*" >>"$STAND_INS/packages"')
        jolt = folder / "jolt"
        for path in (jolt / "include/Jolt/Jolt.h", jolt / "lib/libJolt.a"):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
        self.environment = {
            "PATH": f"{self.programs}:/usr/bin:/bin", "HOME": str(folder), "XDG_CACHE_HOME": str(self.cache), "XDG_DATA_HOME": str(folder),
            "GODOT": str(self.programs / "godot"), "JOLT_PREFIX": str(jolt), "STAND_INS": str(folder), "STAND_IN_MARK": self.mark,
            "LC_ALL": "C.UTF-8",
        }  # fmt: skip
        # As done: the tools' packages, the older interfaces, and the export template of that Godot.
        for name in ("papers", "godot-interfaces"):
            (self.cache / "tactus" / name).mkdir()
        mark = "[cache.mark_done(p._folder(name), p._key(name)) for name in ('venv', 'papers')]"
        mark += "; cache.mark_done(i._crate_folder(), i.KEY)"
        code = f"import sys; sys.path[:0] = ['tools']; from setup import cache, interfaces as i, python_tools as p; {mark}"
        subprocess.run(["/usr/bin/python3", "-B", "-c", code], cwd=self.folder, env=self.environment, check=True)
        template = folder / "godot/export_templates/4.6.3.stable/linux_release.x86_64"
        template.parent.mkdir(parents=True)
        template.touch()
        self.stand_ins = folder

    def _write(self, path: Path, otherwise: str) -> None:
        path.write_text(SCRIPT.replace("{name}", path.name).replace("{otherwise}", otherwise))
        path.chmod(0o755)

    def ask(self, *words: str, run: Path | None = None, within: list | None = None, **more) -> subprocess.CompletedProcess:
        """`within`: a command that the front door is called by, such as ulimit or unshare."""
        environment = self.environment | more.pop("env", {})
        command = [*(within or []), run or self.folder / "run", *words]
        return subprocess.run(command, env=environment, text=True, capture_output=True, timeout=120, **({"cwd": self.folder} | more))

    def begin(self, *words: str, waits: str, within: list | None = None) -> subprocess.Popen:
        """Returns when one of the stand-ins named waits."""
        started = self.stand_ins / "started"
        started.unlink(missing_ok=True)
        process = subprocess.Popen(
            [*(within or []), self.folder / "run", *words], cwd=self.folder, env=self.environment | {"WAITS": waits}, stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True, preexec_fn=_hear_all,
        )  # fmt: skip
        until = time.monotonic() + 60.0
        while not started.is_file() and process.poll() is None and time.monotonic() < until:
            time.sleep(0.01)
        if not started.is_file():
            process.kill()
            raise AssertionError(f"nothing waits: {process.communicate()[1]}")
        return process

    def left_running(self) -> list[str]:
        """Programs that belong to this clone."""
        found = []
        for path in Path("/proc").glob("[0-9]*/environ"):
            try:
                if f"STAND_IN_MARK={self.mark}".encode() in path.read_bytes():
                    state = (path.parent / "stat").read_text().rpartition(")")[2].split()[0]
                    found += [(path.parent / "cmdline").read_text().replace("\0", " ")] if state not in "ZX" else []
            except OSError:
                continue
        return found

    def packages_asked_for(self) -> bool:
        return (self.stand_ins / "packages").is_file()

    def end_all(self) -> None:
        for path in Path("/proc").glob("[0-9]*/environ"):
            try:
                if f"STAND_IN_MARK={self.mark}".encode() in path.read_bytes():
                    os.kill(int(path.parent.name), signal.SIGKILL)
            except OSError:
                continue
