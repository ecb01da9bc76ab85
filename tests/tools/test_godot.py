"""Which Godot is taken, as the suites go on."""

import pytest
from setup import cache, godot
from setup.debian_root import AptError


class Suites:
    """Archives of one address whose suites have these versions of Godot; None: the suite is gone."""

    def __init__(self, versions):
        self.versions = versions

    def __call__(self, folder, suite, address):
        self.suite = suite
        return _Suite(suite, self.versions.get(suite))


class _Suite:
    def __init__(self, suite, version):
        self.suite, self.version = suite, version

    def update(self):
        if self.version is None:
            raise AptError("no Release file")

    def candidate(self, package):
        return self.version


def _found(monkeypatch, versions):
    monkeypatch.setattr(godot, "DebianRoot", Suites(versions))
    monkeypatch.setattr(godot, "mirrors", lambda: ["http://archive/debian"])
    return godot._first_suite_with_godot()


def test_a_newer_godot_than_the_tested_one_is_taken(monkeypatch):
    packages, version = _found(monkeypatch, {"forky": "4.9.1+ds-1"})
    assert (packages.suite, version) == ("forky", "4.9.1+ds-1")


def test_where_a_suite_is_gone_the_next_one_is_asked(monkeypatch):
    packages, version = _found(monkeypatch, {"forky": None, "testing": "4.8-stable-1"})
    assert (packages.suite, version) == ("testing", "4.8-stable-1")


def test_one_that_is_too_old_is_not_taken_and_the_message_says_what_to_do(monkeypatch):
    with pytest.raises(RuntimeError, match="4.4.*GODOT") as refused:
        _found(monkeypatch, {"forky": "3.6.2+ds-1", "testing": None})
    assert "forky has Godot 3.6.2" in str(refused.value) and "testing: no Release file" in str(refused.value)


def test_a_kept_copy_of_another_version_is_used(tmp_path, monkeypatch):
    monkeypatch.setattr(cache, "root", lambda: tmp_path)
    monkeypatch.setattr(godot, "installed", lambda: None)
    assert godot.command() is None
    for name in ("godot-4.7", "godot-4.10.2"):
        (tmp_path / name).mkdir()
        cache.mark_done(tmp_path / name, godot._key(tmp_path / name))
    assert godot.command() == str(tmp_path / "godot-4.10.2/godot")
    tested = tmp_path / f"godot-{godot.TESTED}"
    tested.mkdir()
    assert godot.command() == str(tmp_path / "godot-4.10.2/godot"), "half a copy does not count"
    cache.mark_done(tested, godot._key(tested))
    assert godot.command() == str(tested / "godot")
