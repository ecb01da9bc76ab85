"""The tests of what stands behind ./run: tools.FILE.TEST."""

import functools
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from pathlib import Path

from setup import cache
from testing.jobs import Job
from testing.results import Result, matching

# What these files look at or start, as scons names it.
BUILT_FOR = {
    "test_proof.py": "fuzzers",
    "test_same_bits.py": "build/template_debug/tests/test_session",
}

SHORT = 0.5  # (unit: seconds)


def has(wanted: str) -> bool:
    """Whether there is a test whose name contains the words, as far as its source tells."""
    return any(matching(_named_in(path), wanted) for path in (cache.clone() / "tests/tools").glob("test_*.py"))


def programs_with(wanted: str) -> list[str]:
    """What scons has to build beside the extension for the tests whose name contains the words."""
    files = {path.name: path for path in (cache.clone() / "tests/tools").glob("test_*.py")}
    return [program for file, program in BUILT_FOR.items() if file in files and matching(_named_in(files[file]), wanted)]


def _named_in(path: Path) -> list[str]:
    return [f"tools.{path.stem}.{name}" for name in re.findall(r"^def (test_\w+)", path.read_text(), re.M)]


def jobs(wanted: str, is_reached: Callable[[str], bool] | None, known: dict[str, float]) -> list[Job]:
    """Files stay whole, for their fixtures are made once. `is_reached`: None where all tests are. `known`: what
    times_of_files() gave the last time."""
    if not wanted and is_reached is None:
        return _jobs_of({path.stem: [path.name] for path in sorted((cache.clone() / "tests/tools").glob("test_*.py"))}, known)
    collected = _pytest("--collect-only", "-q").stdout.splitlines()
    identities = [line for line in collected if "::" in line]
    if not identities and collected and "no tests" not in collected[-1]:
        why = "\n".join(collected[-20:])
        return [Job("python", "tools.collection", lambda: [Result("tools.collection", why)])]
    names = {_name(identity): identity for identity in identities}
    files: dict[str, list[str]] = {}
    for name in filter(is_reached, matching(list(names), wanted)):
        files.setdefault(name.split(".")[1], []).append(names[name])
    return _jobs_of(files, known)


def _jobs_of(files: dict[str, list[str]], known: dict[str, float]) -> list[Job]:
    """Of each file what is asked of it, as pytest names it. What takes less time than pytest's start shares one."""
    short = [file for file in files if known.get(f"tools.{file}", SHORT) < SHORT]
    own = [Job("python", f"tools.{file}", functools.partial(_run, asked)) for file, asked in files.items() if file not in short]
    shared = [name for file in short for name in files[file]]
    return [*own, Job("python", "tools.short", lambda: _run(shared))] if short else own


def times_of_files(results: list[Result]) -> dict[str, float]:
    """By tools.FILE (unit: seconds)."""
    times: dict[str, float] = {}
    for result in results:
        if result.name.startswith("tools."):
            file = ".".join(result.name.split(".")[:2])
            times[file] = times.get(file, 0.0) + result.seconds
    return times


def _run(asked: list[str]) -> list[Result]:
    """`asked`: files, or some of their tests as pytest names them."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        done = _pytest("-q", f"--junitxml={report}", *asked)
        if not report.is_file():
            return [Result("tools.pytest", f"ended with {done.returncode}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")]
        return [_result(case) for case in ElementTree.parse(report).iter("testcase")]


def _pytest(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "--rootdir", ".", *arguments]
    return subprocess.run(command, cwd=cache.clone() / "tests/tools", text=True, capture_output=True)


def _name(identity: str) -> str:
    path, test = identity.split("::", 1)
    return f"tools.{Path(path).stem}.{test}"


def _result(case: ElementTree.Element) -> Result:
    troubles = [*case.findall("failure"), *case.findall("error")]
    why = "\n".join((trouble.text or trouble.get("message", ""))[-3000:] for trouble in troubles)
    skipped = case.find("skipped")
    why_not = "" if skipped is None else skipped.get("message", "")
    name = f"tools.{case.get('classname', '').rpartition('.')[2]}.{case.get('name')}"
    return Result(name, why, why_not, float(case.get("time", 0.0)))
