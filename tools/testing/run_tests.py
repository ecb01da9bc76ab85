"""./run test [--sanitize=LIST] [windows|arm64] [FILTER]: builds and runs every test whose name contains FILTER, and ends
with their count.

With --sanitize=address,undefined or =thread only the C++ tests, watched by these, in a build of their own. `windows` and
`arm64`: the C++ tests and the benches compiled for Windows, run by Wine, and for Linux on ARM, run by QEMU.
"""

import sys
import time

import build
from setup import cache, platforms
from testing import bench_suite, cpp_suite, format_suite, godot_suite, python_suite, same_bits

SUITES = [format_suite, cpp_suite, godot_suite, python_suite]
ELSEWHERE = [cpp_suite, bench_suite]


def main(arguments: list[str]) -> int:
    options = [argument for argument in arguments if argument.startswith("--")]
    filters = [argument for argument in arguments if argument not in options]
    platform = platforms.tested_by(filters.pop(0)) if filters and platforms.tested_by(filters[0]) else platforms.host()
    if len(filters) > 1 or len(options) > 1 or any(not option.startswith("--sanitize=") for option in options):
        print("./run test [--sanitize=address,undefined|thread] [windows|arm64] [FILTER]", file=sys.stderr)
        return 2
    wanted = filters[0] if filters else ""
    sanitizers = options[0].partition("=")[2] if options else ""
    what = ["tests", "benches"] if platform.is_foreign else ["tests"]
    print(f"Building the C++ {' and '.join(what)} …", flush=True)
    watched = [f"sanitize={sanitizers}"] if sanitizers else []
    build.build("template_debug", *what, f"platform={platform.name}", *watched)
    only_cpp = bool(sanitizers) or platform.is_foreign
    results = []
    for suite in ELSEWHERE if platform.is_foreign else [cpp_suite] if only_cpp else SUITES:
        started = time.monotonic()
        found = suite.run(wanted, sanitizers, platform) if only_cpp else suite.run(wanted)
        if platform.is_foreign and suite is cpp_suite:
            found += same_bits.compare(found)
        skipped = [result for result in found if result.skipped]
        found = [result for result in found if not result.skipped]
        results += found
        for result in found:
            if not result.passed:
                print(f"FAIL {result.name}\n     " + result.why.strip().replace("\n", "\n     "))
        for result in skipped:
            print(f"SKIP {result.name}: {result.skipped}")
        if found:
            passed = sum(result.passed for result in found)
            name = suite.__name__.rpartition(".")[2].removesuffix("_suite")
            not_run = f", {len(skipped)} skipped" if skipped else ""
            print(f"{name}: {passed} of {len(found)} passed{not_run}, {time.monotonic() - started:.1f} s", flush=True)
    passed = sum(result.passed for result in results)
    print(f"{passed} passed, {len(results) - passed} failed")
    return 0 if results and passed == len(results) else 1


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except RuntimeError as error:
        print(error, file=sys.stderr)
        sys.exit(1)
