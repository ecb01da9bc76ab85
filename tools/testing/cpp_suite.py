"""The GoogleTest programs: cpp.LAYER.SUITE.TEST.

Under sanitizers what they find is the failure of the program that showed it; a program ends at its first one.
"""

import os
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from setup import cache
from testing.results import Result, matching

TIME_LIMIT = 600  # (unit: seconds) a program
SANITIZER_TIME_LIMIT = 3600  # they take up to twenty times as long
SANITIZER_OPTIONS = {
    "ASAN_OPTIONS": "detect_stack_use_after_return=1:strict_init_order=1",
    "UBSAN_OPTIONS": "print_stacktrace=1",
    "TSAN_OPTIONS": "second_deadlock_stack=1",
}


def run(wanted: str, sanitizers: str = "") -> list[Result]:
    results = []
    folder = cache.clone() / "build" / cache.variant("template_debug", sanitizers) / "tests"
    for program in sorted(folder.glob("test_*")):
        if (cache.clone() / "tests" / _layer(program)).is_dir():
            results += _run_program(program, wanted, SANITIZER_TIME_LIMIT if sanitizers else TIME_LIMIT)
    return results


def _layer(program: Path) -> str:
    return program.name.removeprefix("test_")


def _run_program(program: Path, wanted: str, time_limit: float) -> list[Result]:
    prefix = f"cpp.{_layer(program)}."
    chosen = matching([prefix + name for name in _names(program)], wanted)
    if not chosen:
        return []
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        names = ":".join(name.removeprefix(prefix) for name in chosen)
        command = [program, f"--gtest_filter={names}", f"--gtest_output=xml:{report}", "--gtest_brief=1"]
        try:
            done = subprocess.run(
                command, cwd=cache.clone(), env=SANITIZER_OPTIONS | os.environ, timeout=time_limit, text=True,
                capture_output=True,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return [Result(prefix + "program", f"not done after {time_limit} s")]
        if not report.is_file():
            return [Result(prefix + "program", f"ended with {done.returncode}:\n{done.stdout[-1000:]}{done.stderr[:6000]}")]
        results = [_result(prefix, case) for case in ElementTree.parse(report).iter("testcase")]
        if done.returncode != 0 and all(result.passed for result in results):
            results.append(Result(prefix + "program", f"ended with {done.returncode}:\n{done.stderr[:6000]}"))
        return results


def _names(program: Path) -> list[str]:
    text = subprocess.run([program, "--gtest_list_tests"], check=True, text=True, capture_output=True).stdout
    names, suite = [], ""
    for line in text.splitlines():
        word = line.split("#")[0].strip()
        if line.startswith("  "):
            names.append(suite + word)
        elif word.endswith("."):
            suite = word
    return names


def _result(prefix: str, case: ElementTree.Element) -> Result:
    why = "\n".join(failure.get("message", "") for failure in case.findall("failure"))
    return Result(f"{prefix}{case.get('classname')}.{case.get('name')}", why)
