"""What the programs of GoogleTest are given to run in."""

import dataclasses
import stat

from setup import platforms
from testing import cpp_suite

# Says as its test's bits which temporary folder it has, and leaves a file in it.
PROGRAM = """#!/usr/bin/env bash
for option in "$@"; do
    case "$option" in --gtest_output=xml:*) report="${option#*xml:}" ;; esac
done
touch "$TEST_TMPDIR/left"
[ "$TEST_TMPDIR" = "$TMPDIR" ] || exit 1
cat >"$report" <<XML
<testsuites><testsuite><testcase name="Says" classname="Folder">
<properties><property name="bits" value="$TEST_TMPDIR"/></properties>
</testcase></testsuite></testsuites>
XML
"""


def test_programs_that_run_at_the_same_time_share_no_temporary_folder(tmp_path):
    program = tmp_path / "test_fake"
    program.write_text(PROGRAM)
    program.chmod(program.stat().st_mode | stat.S_IXUSR)

    def folder() -> str:
        (result,) = cpp_suite._run_program(program, ["cpp.fake.Folder.Says"], 10.0, platforms.host())
        assert result.passed
        return result.bits

    first, second = folder(), folder()
    assert first and first != second


def test_programs_for_windows_share_the_folder_that_wine_finds_its_server_by(tmp_path, monkeypatch):
    program = tmp_path / "test_fake"
    program.write_text(PROGRAM.replace('[ "$TEST_TMPDIR" = "$TMPDIR" ]', f'[ "$TMPDIR" = "{tmp_path}" ]'))
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr(cpp_suite, "seen_by_program", lambda path, _: str(path))
    windows = dataclasses.replace(platforms.named("windows"), emulator=())
    (result,) = cpp_suite._run_program(program, ["cpp.fake.Folder.Says"], 10.0, windows)
    assert result.passed
