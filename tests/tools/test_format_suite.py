"""Which files the formatters are shown."""

import pytest
from setup import cache
from testing import format_suite

TOOL = """#!/usr/bin/env bash
# Finds wrong what says so, and notes what it was shown.
shift
printf '%s\\n' "${@##*/}" >>"$0.shown"
! grep -l wrong "$@"
"""


@pytest.fixture
def clone(tmp_path, monkeypatch):
    tool = tmp_path / "tool"
    tool.write_text(TOOL)
    tool.chmod(0o755)
    monkeypatch.setattr(cache, "clone", lambda: tmp_path)
    monkeypatch.setattr(cache, "venv_bin", lambda _: tool)
    for path in format_suite.SETTINGS:
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text("as they are")
    for name in ("a.cpp", "b.cpp"):
        (tmp_path / name).write_text("right")
    return tmp_path


def check(clone) -> tuple[bool, list[str]]:
    """Whether all are right, and what the tool was shown."""
    shown = clone / "tool.shown"
    shown.unlink(missing_ok=True)
    result = format_suite._check("format.tool", ["tool", "--check"], [clone / "a.cpp", clone / "b.cpp"])
    return result.passed, shown.read_text().split() if shown.is_file() else []


def test_what_was_found_right_is_not_shown_again_until_it_changes(clone):
    assert check(clone) == (True, ["a.cpp", "b.cpp"])
    assert check(clone) == (True, [])
    (clone / "b.cpp").write_text("right as well")
    assert check(clone) == (True, ["b.cpp"])


def test_what_is_wrong_is_shown_until_it_is_right(clone):
    (clone / "a.cpp").write_text("wrong")
    assert check(clone) == (False, ["a.cpp", "b.cpp"])
    assert check(clone) == (False, ["a.cpp", "b.cpp"])
    (clone / "a.cpp").write_text("right")
    assert check(clone)[0]


def test_other_settings_ask_for_all_anew(clone):
    assert check(clone)[0]
    (clone / ".clang-format").write_text("others")
    assert check(clone) == (True, ["a.cpp", "b.cpp"])
