"""Whether the sources are as the formatters and the linter want them: format.TOOL.

A file that a tool has found right is not shown to it again as long as the file, the tool and its settings are the same.
"""

import subprocess
from pathlib import Path

from setup import cache
from testing.jobs import Job
from testing.results import Result, matching

# The tools' versions, and their own settings.
SETTINGS = ["tools/requirements.txt", ".clang-format", ".gdlintrc"]


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
    kept = cache.clone() / "build/format" / f"{name}.txt"
    found_right = set(kept.read_text().split()) if kept.is_file() else set()
    settings = cache.digest(*command, *((cache.clone() / path).read_text() for path in SETTINGS))
    digests = {path: cache.digest(settings, str(path.relative_to(cache.clone())), path.read_text()) for path in files}
    asked = [path for path, digest in digests.items() if digest not in found_right]
    if asked:
        done = subprocess.run([cache.venv_bin(tool), *options, *asked], cwd=cache.clone(), text=True, capture_output=True)
        if done.returncode != 0:
            return Result(name, (done.stdout + done.stderr)[-3000:])
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text("\n".join(digests.values()))
    return Result(name)
