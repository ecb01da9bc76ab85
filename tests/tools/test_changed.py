"""What ./run test --changed runs after which change."""

import pytest
from testing import changed, godot_suite
from testing.results import Result

PROGRAM = "build/template_debug/tests/test_core"


@pytest.mark.parametrize(
    ("files", "cpp", "godot", "tools"),
    [
        (set(), False, False, False),
        # A source that the program of core's tests is linked with.
        ({PROGRAM, "extension/core/haptics/force_law.cpp"}, True, False, False),
        # A comment, perhaps: the program's bytes are as they were.
        ({"extension/core/haptics/force_law.cpp"}, False, False, False),
        ({PROGRAM, "tests/core/haptics/force_law_test.cpp"}, True, False, False),
        ({PROGRAM, "tests/core/haptics/stribeck_test.cpp"}, False, False, False),
        ({"demo_project/gallery/menu.gd"}, False, True, True),
        ({"demo_project/addons/tactus/bin/libtactus.so"}, False, True, True),
        ({"tests/godot/touch_test.gd"}, False, True, False),
        ({"tests/godot/tool_test.gd"}, False, False, False),
        ({"tests/tools/test_addon.py"}, False, False, True),
        ({"tests/tools/test_host.py"}, False, False, False),
        ({"tools/addon.py"}, False, False, True),
        ({"docs/tool.md"}, False, False, True),
    ],
)
def test_runs_what_the_change_reaches(files, cpp, godot, tools):
    reached = changed.reached_by(files)
    assert reached.cpp("cpp.core.ForceLaw.DampingActsOnTheApproachOnly") == cpp
    assert reached.godot("godot.touch_test.test_a_wall") == godot
    assert reached.tools("tools.test_addon.test_one") == tools


def test_a_released_file_is_that_of_its_source():
    assert changed.reached_by({"tests/godot/touch_test.gd"}).godot("godot.released.touch_test.test_a_wall")


def test_a_test_with_parameters_is_that_of_its_source():
    assert changed._without_parameters("cpp.session.Family/Kicks.NoneIsFelt/teleports") == "cpp.session.Kicks.NoneIsFelt"


def test_a_run_of_all_that_is_green_is_the_last_one(tmp_path, monkeypatch):
    monkeypatch.setattr(changed, "_FILE", tmp_path / "last_green.json")
    assert changed.since_last_green().cpp("cpp.core.Any.Test")
    changed.note_green()
    assert not changed.since_last_green().cpp("cpp.core.Any.Test")


def test_reads_how_long_a_test_in_godot_took():
    output = "RUN test_one\nhello\nTOOK 1500 ms\nPASS test_one\nRUN test_two\nFAIL test_two: no\nRUN test_three\nTOOK 2 ms\n"
    assert godot_suite.times(output) == {"test_one": 1.5, "test_three": 0.002}
    assert Result("a").seconds == 0.0
