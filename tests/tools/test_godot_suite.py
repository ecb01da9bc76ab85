"""When a headless run counts as passed."""

from testing.godot_suite import judge


def test_end_marker_and_pass_are_enough():
    assert judge("Godot Engine\nRUN test_a\nPASS test_a\nEND\n", ["test_a"]) == {"test_a": ""}


def test_failure_is_told():
    assert judge("RUN test_a\nFAIL test_a: one is 2\nEND\n", ["test_a"]) == {"test_a": "one is 2"}


def test_without_an_end_marker_the_run_fails():
    assert "exit" in judge("RUN test_a\nPASS test_a\n", ["test_a"])


def test_an_error_line_fails_the_test_it_stands_in():
    verdict = judge("RUN test_a\nERROR: broken\nPASS test_a\nRUN test_b\nPASS test_b\nEND\n", ["test_a", "test_b"])
    assert verdict == {"test_a": "ERROR: broken", "test_b": ""}


def test_an_announced_error_is_fine():
    output = "RUN test_a\nEXPECT broken\nERROR: broken\nPASS test_a\nEND\n"
    assert judge(output, ["test_a"]) == {"test_a": ""}


def test_an_announced_error_that_does_not_come_is_a_failure():
    assert judge("RUN test_a\nEXPECT broken\nPASS test_a\nEND\n", ["test_a"])["test_a"] != ""


def test_each_announcement_needs_a_line_of_its_own():
    once = "RUN test_a\nEXPECT broken\nEXPECT broken\nERROR: broken\nPASS test_a\nEND\n"
    assert judge(once, ["test_a"])["test_a"] == "announced but not printed: broken"
    twice = once.replace("ERROR: broken\n", "ERROR: broken\nERROR: broken\n")
    assert judge(twice, ["test_a"]) == {"test_a": ""}


def test_a_leak_at_exit_fails_the_file():
    output = "RUN test_a\nPASS test_a\nEND\nWARNING: ObjectDB instances leaked at exit\n"
    assert "leaked" in judge(output, ["test_a"])["exit"]


def test_a_script_that_does_not_load_fails():
    verdict = judge("SCRIPT ERROR: Parse Error\nFAIL load: the script has errors\n", ["test_a"])
    assert verdict["test_a"] == "did not run" and verdict["start"] != ""
