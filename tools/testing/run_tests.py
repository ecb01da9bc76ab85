"""./run test [--sanitize=LIST] [FILTER]: builds and runs every test whose name contains FILTER, and ends with their
count. With --sanitize=address,undefined or =thread only the C++ tests, watched by these, in a build of their own.
"""

import sys
import time

import build
from setup import cache
from testing import cpp_suite, format_suite, godot_suite, python_suite

SUITES = [format_suite, cpp_suite, godot_suite, python_suite]


def main(arguments: list[str]) -> int:
    options = [argument for argument in arguments if argument.startswith("--")]
    filters = [argument for argument in arguments if argument not in options]
    if len(filters) > 1 or len(options) > 1 or any(not option.startswith("--sanitize=") for option in options):
        print("./run test [--sanitize=address,undefined|thread] [FILTER]", file=sys.stderr)
        return 2
    wanted = filters[0] if filters else ""
    sanitizers = options[0].partition("=")[2] if options else ""
    print("Building the C++ tests …", flush=True)
    build.build("template_debug", "tests", *([f"sanitize={sanitizers}"] if sanitizers else []))
    results = []
    for suite in [cpp_suite] if sanitizers else SUITES:
        started = time.monotonic()
        found = suite.run(wanted, sanitizers) if sanitizers else suite.run(wanted)
        results += found
        for result in found:
            if not result.passed:
                print(f"FAIL {result.name}\n     " + result.why.strip().replace("\n", "\n     "))
        if found:
            passed = sum(result.passed for result in found)
            name = suite.__name__.rpartition(".")[2].removesuffix("_suite")
            print(f"{name}: {passed} of {len(found)} passed, {time.monotonic() - started:.1f} s", flush=True)
    passed = sum(result.passed for result in results)
    print(f"{passed} passed, {len(results) - passed} failed")
    return 0 if results and passed == len(results) else 1


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except RuntimeError as error:
        print(error, file=sys.stderr)
        sys.exit(1)
