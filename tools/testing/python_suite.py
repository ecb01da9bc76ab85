"""The tests of what stands behind ./run: tools.FILE.TEST."""

import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from setup import cache
from testing.results import Result, matching

# What these files look at or start, as scons names it.
BUILT_FOR = {
    "test_proof.py": "fuzzers",
    "test_same_bits.py": "build/template_debug/tests/test_session",
}
AT_A_TIME = 3  # they build in folders of their own, or wait for processes and their turn


def has(wanted: str) -> bool:
    """Whether there is a test whose name contains the words, as far as its source tells."""
    return any(matching(_named_in(path), wanted) for path in (cache.clone() / "tests/tools").glob("test_*.py"))


def programs_with(wanted: str) -> list[str]:
    """What scons has to build beside the extension for the tests whose name contains the words."""
    files = {path.name: path for path in (cache.clone() / "tests/tools").glob("test_*.py")}
    return [program for file, program in BUILT_FOR.items() if file in files and matching(_named_in(files[file]), wanted)]


def _named_in(path: Path) -> list[str]:
    return [f"tools.{path.stem}.{name}" for name in re.findall(r"^def (test_\w+)", path.read_text(), re.M)]


def run(wanted: str, is_reached: Callable[[str], bool] = lambda _: True) -> list[Result]:
    collected = _pytest("--collect-only", "-q").stdout.splitlines()
    identities = [line for line in collected if "::" in line]
    if not identities and collected and "no tests" not in collected[-1]:
        return [Result("tools.collection", "\n".join(collected[-20:]))]
    names = {_name(identity): identity for identity in identities}
    chosen = list(filter(is_reached, matching(list(names), wanted)))
    if not chosen:
        return []
    # Files stay whole: their fixtures are made once.
    files: dict[str, list[str]] = {}
    for name in chosen:
        files.setdefault(name.split(".")[1], []).append(names[name])
    with ThreadPoolExecutor(AT_A_TIME) as pool:
        return sum(pool.map(_run, sorted(files.values(), key=len, reverse=True)), [])


def _run(identities: list[str]) -> list[Result]:
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        done = _pytest("-q", f"--junitxml={report}", *identities)
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
