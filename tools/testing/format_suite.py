"""Whether the sources are as the formatters and the linter want them: format.TOOL."""

import subprocess
from pathlib import Path

from setup import cache
from testing.jobs import Job
from testing.results import Result, matching


def jobs(wanted: str) -> list[Job]:
    cpp = _files("extension", "tests", "tools", endings=(".cpp", ".hpp"))
    gd = _files("demo_project", "tests", "tools", endings=(".gd",))
    checks = {
        "format.clang_format": (["clang-format", "--dry-run", "--Werror"], cpp),
        "format.gdformat": (["gdformat", "--check", "--line-length=110"], gd),
        "format.gdlint": (["gdlint"], gd),
    }
    chosen = [name for name in matching(list(checks), wanted) if checks[name][1]]
    return [Job("format", name, lambda name=name: [_check(name, *checks[name])]) for name in chosen]


def _files(*folders: str, endings: tuple[str, ...]) -> list[Path]:
    paths = [path for folder in folders for path in (cache.clone() / folder).rglob("*") if path.suffix in endings]
    return sorted(path for path in paths if ".godot" not in path.parts)


def _check(name: str, command: list[str], files: list[Path]) -> Result:
    tool, *options = command
    done = subprocess.run(
        [cache.venv_bin(tool), *options, *files], cwd=cache.clone(), text=True, capture_output=True
    )
    return Result(name, (done.stdout + done.stderr)[-3000:] if done.returncode != 0 else "")
