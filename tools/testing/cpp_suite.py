"""The GoogleTest programs: cpp.LAYER.SUITE.TEST.

Under sanitizers what they find is the failure of the program that showed it; a program ends at its first one.
Programs for another platform run in an emulator of it.
"""

import functools
import os
import re
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from pathlib import Path

import addon
from setup import cache, platforms
from setup.platforms import Platform
from testing.jobs import PROCESSORS, Job, carry_out
from testing.results import Result, matching

TIME_LIMIT = 600  # (unit: seconds) a program
SLOW_TIME_LIMIT = 3600  # what sanitizers watch, or an emulator runs, takes up to fifty times as long
IN_VIRTUAL_TIME = {"core", "physics", "sensing", "session"}  # nothing there waits for a clock, a socket or a device
LEFT_OUT_WITHOUT = {"sensing_openni": "it needs OpenNI2: ./run setup --with-sensing"}
_TEST = re.compile(r"^TEST(?:_[FP])?\((\w+),\s*(\w+)\)", re.M)
SANITIZER_OPTIONS = {
    "ASAN_OPTIONS": "detect_stack_use_after_return=1:strict_init_order=1",
    "UBSAN_OPTIONS": "print_stacktrace=1",
    "TSAN_OPTIONS": "second_deadlock_stack=1",
}


def programs_with(wanted: str) -> list[str]:
    """What scons has to build for the tests whose name contains the words: the programs with such tests. A test with
    parameters has words in its name that its source has not: where none is found, all."""
    if not wanted:
        return ["tests"]
    named = [name for name in _named_in_sources() if wanted.lower() in name.lower()]
    layers = sorted({name.split(".")[1] for name in named})
    if not layers and (wanted.lower().startswith("cpp") or "/" in wanted):
        return ["tests"]
    return [f"build/template_debug/tests/test_{layer}" for layer in layers]


def _named_in_sources() -> list[str]:
    tests = cache.clone() / "tests"
    found = []
    for path in sorted(tests.rglob("*_test.cpp")):
        found += named_in(path)
    return found


def named_in(source: Path) -> list[str]:
    """The tests of a file of tests/, without their parameters."""
    layer = source.relative_to(cache.clone() / "tests").parts[0]
    return [f"cpp.{layer}.{suite}.{test}" for suite, test in _TEST.findall(source.read_text())]


def run(wanted: str, sanitizers: str = "", platform: Platform | None = None) -> list[Result]:
    return carry_out(jobs(wanted, sanitizers, platform), {}).results


def jobs(
    wanted: str, sanitizers: str = "", platform: Platform | None = None, is_reached: Callable[[str], bool] = lambda _: True
) -> list[Job]:
    platform = platform or platforms.host()
    variant = cache.variant("template_debug", sanitizers, platform.name if platform.is_foreign else "")
    folder = cache.clone() / "build" / variant / "tests"
    programs = [program for program in sorted(folder.glob("test_*")) if (cache.clone() / "tests" / _layer(program)).is_dir()]
    time_limit = SLOW_TIME_LIMIT if sanitizers or platform.is_foreign else TIME_LIMIT
    found = [Job("cpp", "cpp.left_out", lambda: _left_out(folder, wanted))]
    for program in programs:
        for number, part in enumerate(_parts(program, list(filter(is_reached, _chosen(program, wanted, platform))))):
            run = functools.partial(_run_program, program, part, time_limit, platform)
            found.append(Job("cpp", f"cpp.{_layer(program)}.{number}", run))
    return found


def _parts(program: Path, chosen: list[str]) -> list[list[str]]:
    """The tests that are asked for: as many lists as there are processors where none waits for a clock."""
    count = PROCESSORS if _layer(program) in IN_VIRTUAL_TIME else 1
    return [part for part in (chosen[start::count] for start in range(count)) if part]


def _left_out(folder: Path, wanted: str) -> list[Result]:
    """The tests of programs that are only made where the machine has what they need."""
    results = []
    for name, why in LEFT_OUT_WITHOUT.items():
        if not (folder / f"test_{name}").is_file():
            tests = [test for test in _named_in_sources() if test.split(".")[1] == name]
            results += [Result(test, skipped=why) for test in matching(tests, wanted)]
    return results


def _layer(program: Path) -> str:
    return program.stem.removeprefix("test_")


def environment(platform: Platform) -> dict[str, str]:
    """Wine keeps its Windows in the cache; a test that starts its program anew does so in the emulator, and one loads
    the extension where it is built."""
    emulated = {
        "WINEPREFIX": str(cache.root() / "wine"),
        "WINEDEBUG": "-all",
        "TACTUS_EMULATOR": " ".join(platform.emulator),
    }
    extension = {"TACTUS_EXTENSION": seen_by_program(library, platform) for library in addon.built(platform)[:1]}
    return SANITIZER_OPTIONS | os.environ | extension | (emulated if platform.is_foreign else {})


def seen_by_program(path: Path, platform: Platform) -> str:
    return f"Z:{path}" if platform.system == "windows" else str(path)


def _own_temporary_folder(folder: str, platform: Platform) -> dict[str, str]:
    """For GoogleTest and the standard library: what a test writes there, no other run on this machine writes or removes.
    Wine looks for its server by TMPDIR, and all programs of one Windows need the same."""
    by_library = {} if platform.system == "windows" else {"TMPDIR": folder}
    return {"TEST_TMPDIR": seen_by_program(Path(folder), platform)} | by_library


def _chosen(program: Path, wanted: str, platform: Platform) -> list[str]:
    prefix = f"cpp.{_layer(program)}."
    return matching([prefix + name for name in _names(program, platform)], wanted)


def _run_program(program: Path, chosen: list[str], time_limit: float, platform: Platform) -> list[Result]:
    prefix = f"cpp.{_layer(program)}."
    if not chosen:
        return []
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        names = ":".join(name.removeprefix(prefix) for name in chosen)
        output = f"--gtest_output=xml:{seen_by_program(report, platform)}"
        options = [f"--gtest_filter={names}", output, "--gtest_brief=1"]
        command = [*platform.emulator, program, *options]
        try:
            done = subprocess.run(
                command, cwd=cache.clone(), env=environment(platform) | _own_temporary_folder(folder, platform), timeout=time_limit,
                text=True, errors="replace", capture_output=True,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return [Result(prefix + "program", f"not done after {time_limit} s")]
        if not report.is_file():
            return [Result(prefix + "program", f"ended with {done.returncode}:\n{done.stdout[-1000:]}{done.stderr[:6000]}")]
        results = [_result(prefix, case) for case in ElementTree.parse(report).iter("testcase")]
        if done.returncode != 0 and all(result.passed for result in results):
            results.append(Result(prefix + "program", f"ended with {done.returncode}:\n{done.stderr[:6000]}"))
        return results


def _names(program: Path, platform: Platform) -> list[str]:
    command = [*platform.emulator, program, "--gtest_list_tests"]
    text = subprocess.run(command, check=True, env=environment(platform), text=True, capture_output=True).stdout
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
    skipped = case.find("skipped")
    # The reason comes after the place in the source and the word "Skipped".
    reason = "" if skipped is None else skipped.get("message", "").strip().split("\n")[-1] or "no reason given"
    bits = [found.get("value", "") for found in case.iter("property") if found.get("name") == "bits"]
    name, seconds = f"{prefix}{case.get('classname')}.{case.get('name')}", float(case.get("time", 0.0))
    return Result(name, why, reason, seconds, "".join(bits))
