"""./run test [--times] [--changed] [--sanitize=LIST] [windows|arm64] [FILTER]: builds what the tests whose name contains
FILTER need, runs them and ends with their count.

The suites run side by side, from one queue (jobs.py). --times lists the slowest twenty. --changed leaves out what no change since the last green run can reach
(changed.py). With --sanitize=address,undefined or =thread only the C++ tests, watched by these, in a build of their own.
`windows` and `arm64`: the C++ tests and the benches compiled for Windows, run by Wine, and for Linux on ARM, run by QEMU.
"""

import argparse
import time
from collections.abc import Callable

import build
import entry
import project
from setup import platforms, steps
from setup.platforms import Platform
from testing import bench_suite, changed, cpp_suite, format_suite, godot_suite, jobs, python_suite, same_bits
from testing.results import Result

SLOWEST = 20
PLAYS_CASES = "build/template_release/bench/teleop"  # what most tests of experiments start


def main(arguments: list[str]) -> int:
    given = _given(arguments)
    words = list(given.words)
    platform = platforms.tested_by(words.pop(0)) if words and platforms.tested_by(words[0]) else platforms.host()
    wanted = words[0] if words else ""
    if platform.is_foreign or given.sanitize:
        results = _elsewhere(platform, given.sanitize, wanted)
    else:
        results = _here(wanted, given.changed)
    if given.times:
        _print_slowest(results)
    passed = sum(result.passed for result in results)
    print(f"{passed} passed, {len(results) - passed} failed")
    return 0 if results and passed == len(results) else 1


def _given(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="./run test", allow_abbrev=False)
    parser.add_argument("--times", action="store_true")
    parser.add_argument("--changed", action="store_true")
    parser.add_argument("--sanitize", default="")
    parser.add_argument("words", nargs="*")
    return parser.parse_args(arguments)


def _elsewhere(platform: Platform, sanitizers: str, wanted: str) -> list[Result]:
    what = ["tests", "benches"] if platform.is_foreign else ["tests"]
    watched = [f"sanitize={sanitizers}"] if sanitizers else []
    _build(what, f"platform={platform.name}", *watched)
    found = _shown("cpp", lambda: cpp_suite.run(wanted, sanitizers, platform))
    if platform.is_foreign:
        found += _shown("bits", lambda: same_bits.compare(found))
        found += _shown("bench", lambda: bench_suite.run(wanted, sanitizers, platform))
    return found


def _here(wanted: str, only_changed: bool) -> list[Result]:
    in_project = godot_suite.has(wanted) or python_suite.has(wanted)
    programs = [*cpp_suite.programs_with(wanted), *python_suite.programs_with(wanted)]
    targets = [*(["extension", "sensing", "probe"] if in_project else []), *programs]
    released = ["extension", "sensing", *([] if wanted else [PLAYS_CASES])]
    if targets:
        _build(targets)
    if in_project:
        build.build("template_release", *released)
        build.declare({"template_debug": targets, "template_release": released})
        steps.run([project.import_step()])
    reached = changed.since_last_green() if only_changed else changed.everything()
    known, started = jobs.known_times(), time.monotonic()
    asked = [
        *format_suite.jobs(wanted),
        *cpp_suite.jobs(wanted, is_reached=reached.cpp),
        *godot_suite.jobs(wanted, reached.godot),
        *python_suite.jobs(wanted, reached.tools if only_changed else None, known),
    ]
    done = jobs.carry_out(asked, known, lambda suite, found: _show(suite, found, time.monotonic() - started))
    results = [result for result in done.results if not result.skipped]
    if not wanted and not only_changed:
        jobs.keep_times(done.times | python_suite.times_of_files(results))
    if not wanted and results and all(result.passed for result in results):
        changed.note_green()
    return results


def _build(targets: list[str], *options: str) -> None:
    print("Building what the tests need …", flush=True)
    build.build("template_debug", *targets, *options)


def _shown(name: str, run: Callable[[], list[Result]]) -> list[Result]:
    """What the suite found, without what was skipped; prints both."""
    started = time.monotonic()
    found = run()
    _show(name, found, time.monotonic() - started)
    return [result for result in found if not result.skipped]


def _show(name: str, all_found: list[Result], seconds: float) -> None:
    skipped = [result for result in all_found if result.skipped]
    found = [result for result in all_found if not result.skipped]
    for result in found:
        if not result.passed:
            print(f"FAIL {result.name}\n     " + result.why.strip().replace("\n", "\n     "))
    for result in skipped:
        print(f"SKIP {result.name}: {result.skipped}")
    if found:
        passed = sum(result.passed for result in found)
        not_run = f", {len(skipped)} skipped" if skipped else ""
        print(f"{name}: {passed} of {len(found)} passed{not_run}, {seconds:.1f} s", flush=True)


def _print_slowest(results: list[Result]) -> None:
    total = sum(result.seconds for result in results) or 1.0
    print(f"The slowest {SLOWEST} of {len(results)} tests, with their share of {total:.0f} s:")
    for result in sorted(results, key=lambda one: -one.seconds)[:SLOWEST]:
        print(f"{result.seconds:8.1f} s {100.0 * result.seconds / total:5.1f} %  {result.name}")


if __name__ == "__main__":
    entry.leave(main)
