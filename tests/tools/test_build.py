"""When SCons is called at all."""

import build
import pytest
from setup import cache, processes


@pytest.fixture
def asked(monkeypatch) -> list[list]:
    """What SCons was asked for."""
    found: list[list] = []

    def started(command, **_):
        found.append(command[1:])
        raise RuntimeError("SCons")

    monkeypatch.setattr(processes, "started", started)
    monkeypatch.setenv(build.BUILT, "")
    return found


def asks(target: str, *what: str) -> bool:
    try:
        build.build(target, *what)
    except RuntimeError:
        return True
    return False


def test_what_who_started_it_has_built_is_not_asked_for_again(asked):
    assert asks("template_release", "extension")
    build.declare({"template_debug": ["tests"], "template_release": ["extension", "sensing"]})
    assert not asks("template_release", "extension") and not asks("template_release", "sensing", "extension")
    assert len(asked) == 1


def test_anything_else_is(asked):
    build.declare({"template_debug": ["tests"], "template_release": ["extension"]})
    assert asks("template_debug", "extension") and asks("template_release", "extension", "benches")
    assert asks("template_debug", "tests", "sanitize=thread")


def test_nor_does_it_hold_for_another_clone(asked, monkeypatch, tmp_path):
    build.declare({"template_debug": ["tests"]})
    monkeypatch.setattr(cache, "clone", lambda: tmp_path)
    assert asks("template_debug", "tests")
