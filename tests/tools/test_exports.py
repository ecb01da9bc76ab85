"""Programs that tests share."""

import pytest
from setup import cache
from testing import exports


def test_a_program_is_exported_again_where_something_has_changed(tmp_path, monkeypatch):
    monkeypatch.setattr(cache, "clone", lambda: tmp_path)
    folder, made = tmp_path / "build/exported", []

    def export(program) -> None:
        made.append(program)
        program.write_text(f"number {len(made)}")

    for content, text in [("one", "number 1"), ("one", "number 1"), ("another", "number 2"), ("one", "number 3")]:
        assert exports.kept(folder, content, export).read_text() == text


def test_what_was_exported_by_half_is_none(tmp_path, monkeypatch):
    monkeypatch.setattr(cache, "clone", lambda: tmp_path)
    folder = tmp_path / "build/exported"

    def fails(program) -> None:
        program.write_text("half")
        raise RuntimeError("the disk is full")

    with pytest.raises(RuntimeError, match="full"):
        exports.kept(folder, "one", fails)
    assert exports.kept(folder, "one", lambda program: program.write_text("whole") and None).read_text() == "whole"
