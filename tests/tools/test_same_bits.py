"""What would make a processor's results its own: products fused with sums by the compiler."""

import platform
import subprocess

import pytest
from setup import cache

FUSED_ALTERNATELY = ("vfmaddsub", "vfmsubadd")  # nobody asks for these (core/math/lanes.hpp)


@pytest.mark.skipif(platform.machine() != "x86_64", reason="x86-64 alone has the instructions")
@pytest.mark.parametrize("folder", ["extension/core", "extension/session", "extension/physics", "tests/session"])
def test_no_pair_of_products_is_fused_with_sums_unasked(folder):
    objects = sorted((cache.clone() / "build/template_debug/obj" / folder).rglob("*.o"))
    assert objects, "./run test builds them first"
    for one in objects:
        code = subprocess.run(["objdump", "-d", "--no-show-raw-insn", str(one)], text=True, capture_output=True, check=True).stdout
        assert not any(name in code for name in FUSED_ALTERNATELY), one
