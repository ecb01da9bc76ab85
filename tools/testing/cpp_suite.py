"""The GoogleTest programs: cpp.LAYER.SUITE.TEST."""

import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from setup import cache
from testing.results import Result, matching

TIME_LIMIT = 600  # (unit: seconds) a program


def run(wanted: str) -> list[Result]:
    results = []
    for program in sorted((cache.clone() / "build/template_debug/tests").glob("test_*")):
        if (cache.clone() / "tests" / _layer(program)).is_dir():
            results += _run_program(program, wanted)
    return results


def _layer(program: Path) -> str:
    return program.name.removeprefix("test_")


def _run_program(program: Path, wanted: str) -> list[Result]:
    prefix = f"cpp.{_layer(program)}."
    chosen = matching([prefix + name for name in _names(program)], wanted)
    if not chosen:
        return []
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        names = ":".join(name.removeprefix(prefix) for name in chosen)
        command = [program, f"--gtest_filter={names}", f"--gtest_output=xml:{report}", "--gtest_brief=1"]
        try:
            done = subprocess.run(command, cwd=cache.clone(), timeout=TIME_LIMIT, text=True, capture_output=True)
        except subprocess.TimeoutExpired:
            return [Result(prefix + "program", f"not done after {TIME_LIMIT} s")]
        if not report.is_file():
            return [Result(prefix + "program", f"ended with {done.returncode}:\n{(done.stdout + done.stderr)[-3000:]}")]
        return [_result(prefix, case) for case in ElementTree.parse(report).iter("testcase")]


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
