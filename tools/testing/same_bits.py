"""Whether another platform's programs compute what this machine's own do, to the bit: bits.LAYER.SUITE.TEST.

A test that records a property "bits" is played once more by the program of this machine.
"""

import build
from testing import cpp_suite
from testing.results import Result


def compare(found: list[Result]) -> list[Result]:
    """One result for each test of another platform that recorded its bits."""
    recorded = [result for result in found if result.bits]
    layers = sorted({result.name.split(".")[1] for result in recorded})
    if layers:
        build.build("template_debug", *(f"build/template_debug/tests/test_{layer}" for layer in layers))
    return [_compared(result) for result in recorded]


def _compared(theirs: Result) -> Result:
    own = cpp_suite.run(theirs.name)
    bits = own[0].bits if own else "nothing"
    why = "" if theirs.bits == bits else f"{theirs.bits} there, {bits} here"
    return Result(theirs.name.replace("cpp.", "bits.", 1), why)
