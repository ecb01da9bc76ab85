"""Without a network, a step says that in one line; what the network has not to do with is told as it is."""

import shutil
import subprocess
from pathlib import Path

import pytest
from setup import fetching, godot
from stand_in_clone import Clone


@pytest.fixture
def clone(tmp_path):
    clone = Clone(tmp_path)
    clone.environment["PIP_RETRIES"] = "1"
    yield clone
    clone.end_all()


def offline(clone: Clone) -> subprocess.CompletedProcess:
    """Its proxy is a port of this machine that refuses every connection."""
    nowhere = {name: "http://127.0.0.1:9" for name in ("https_proxy", "http_proxy")}
    return clone.ask("setup", env=nowhere)


def check_says_so(answer: subprocess.CompletedProcess, program: str) -> None:
    assert answer.returncode == 1
    assert answer.stderr.splitlines()[-1].startswith(f"{program} cannot reach its server."), answer.stderr
    assert "Traceback" not in answer.stderr and len(answer.stderr.splitlines()) == 2


def test_pythons_tools(clone):
    shutil.rmtree(clone.cache / "tactus/venv")
    check_says_so(offline(clone), "pip")
    assert not (clone.cache / "tactus/venv/.done").exists()


@pytest.mark.skipif(shutil.which("cargo") is None, reason="there is no cargo: ./run setup brings it")
def test_jolts_source(clone):
    del clone.environment["JOLT_PREFIX"]
    clone.environment["PATH"] += f":{Path(str(shutil.which('cargo'))).parent}"
    own = {"CARGO_HOME": str(clone.stand_ins), "CARGO_NET_RETRY": "0", "RUSTUP_HOME": str(Path.home() / ".rustup")}
    clone.environment |= own
    check_says_so(offline(clone), "cargo vendor")


def test_debians_archive(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(godot, "mirrors", lambda: ["http://127.0.0.1:9/debian"])
    monkeypatch.setattr(godot, "SUITES", ["forky"])
    with pytest.raises(fetching.Unreachable, match="apt-get update cannot reach its server"):
        godot._first_suite_with_godot()


def test_other_troubles_are_told_as_they_are():
    wrong = fetching.trouble("pip", "THESE PACKAGES DO NOT MATCH THE HASHES FROM THE REQUIREMENTS FILE")
    assert not isinstance(wrong, fetching.Unreachable) and "DO NOT MATCH" in str(wrong)
