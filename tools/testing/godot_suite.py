"""The headless tests of tests/godot: godot.FILE.TEST. One Godot per file, so that what it prints has an owner.

A file passes only with its END marker, and a test only without lines of error or leak that it has not announced.
"""

import re
import subprocess
from pathlib import Path

from setup import cache, godot
from testing.results import Result, matching

FOLDER = cache.clone() / "tests/godot"
PROJECT = cache.clone() / "demo_project"
TIME_LIMIT = 300  # (unit: seconds) a file
TROUBLE = re.compile(r"^\s*(ERROR|SCRIPT ERROR|USER ERROR|USER SCRIPT ERROR):|leaked at exit|still in use at exit|^Leaked ")


def run(wanted: str) -> list[Result]:
    results = []
    for path in sorted(FOLDER.rglob("*_test.gd")):
        names = re.findall(r"^func (test_\w+)", path.read_text(), re.M)
        chosen = matching([f"{_prefix(path)}{name}" for name in names], wanted)
        if chosen:
            results += _run_file(path, chosen)
    return results


def _prefix(path: Path) -> str:
    return f"godot.{path.stem}."


def _run_file(path: Path, chosen: list[str]) -> list[Result]:
    names = [name.removeprefix(_prefix(path)) for name in chosen]
    command = [str(godot.command()), "--headless", "--path", PROJECT, "--script", FOLDER / "run_tests.gd", "--", path]
    try:
        done = subprocess.run(
            [*command, *names], timeout=TIME_LIMIT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
    except subprocess.TimeoutExpired:
        return [Result(_prefix(path) + "file", f"not done after {TIME_LIMIT} s")]
    return [Result(_prefix(path) + name, why) for name, why in judge(done.stdout, names).items()]


def judge(output: str, expected_tests: list[str]) -> dict[str, str]:
    """Why each test failed, empty for those that passed. "start" and "exit" appear when there was trouble there."""
    sections, order = {"start": []}, ["start"]
    for line in output.splitlines():
        if line.startswith("RUN ") or line == "END":
            order.append("exit" if line == "END" else line.removeprefix("RUN "))
            sections[order[-1]] = []
        else:
            sections[order[-1]].append(line)
    verdicts = {name: _verdict(name, sections[name]) for name in order}
    for name in expected_tests:
        verdicts.setdefault(name, "did not run")
    if "exit" not in verdicts:
        verdicts["exit"] = f"ended before its end:\n{output[-2000:]}"
    return {name: why for name, why in verdicts.items() if why or name not in ("start", "exit")}


def _verdict(name: str, lines: list[str]) -> str:
    failures = [line for line in lines if line.startswith("FAIL ")]
    if failures:
        return failures[0].partition(": ")[2] or failures[0]
    announced = [line.removeprefix("EXPECT ") for line in lines if line.startswith("EXPECT ")]
    trouble = [line for line in lines if TROUBLE.search(line) and not any(text in line for text in announced)]
    if trouble:
        return "\n".join(trouble)
    said = [line for line in lines if not line.startswith("EXPECT ")]
    missing = [words for words in announced if sum(words in line for line in said) < announced.count(words)]
    if missing:
        return f"announced but not printed: {missing[0]}"
    return "" if name in ("start", "exit") or f"PASS {name}" in lines else "neither passed nor failed"
