"""Words of a case (tests/shared/teleop_words.cpp): by type and range, by names that there are, or refused."""

import functools
import resource
import subprocess

import pytest

from experiments import linked_touch
from measuring import teleop_runs
from measuring.options import Refused

SHORT = {"seconds": "0.5", "loss": "0.3"}


@pytest.mark.parametrize(
    ("word", "allowed"),
    [
        *((f"jitter_ms={value}", "a number from 0 to 10000") for value in ("abc", "nan", "inf", "-5", "1e9", "5O", "5ms")),
        *((f"states_every={value}", "a whole number from 1 to") for value in ("abc", "0", "1.5", "-1")),
        *((f"seed={value}", "a whole number from 0 to") for value in ("-1", "1e300", "abc")),
        ("arm=2", "a whole number from 0 to 1"), ("burst=2", "a number from 0 to"), ("nonsense=1", "no such key"),
        ("correction=posee", "one of none, pose"), ("derivation=abc", "one of none, velocity"), ("passivity=waves", "one of none, wave_variables"),
        ("wrong.Box.mas=1", "no such key"), ("wrong.Box.mass=abc", "another kind"), ("wrong.box.mass=1.2", "there is no body box"),
        ("event.0=soon", "SECONDS,KIND"), ("object=box", "there is no body box"),
    ],
)  # fmt: skip
def test_nonsense_is_refused_with_its_word_and_what_is_allowed(word, allowed, tmp_path):
    with pytest.raises(Refused, match=allowed):
        linked_touch.run(SHORT | {"set": word}, tmp_path)


def test_a_large_seed_is_a_seed_of_its_own(tmp_path):
    one, other = (linked_touch.run(SHORT | {"seconds": "4", "seed": str(seed)}, tmp_path) for seed in (1, 2**32 + 1))
    assert one != other


def test_a_disk_that_is_full_ends_the_run(tmp_path, monkeypatch):
    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))

    teleop_runs.program()
    limited = functools.partial(subprocess.Popen, preexec_fn=limit, restore_signals=False)
    monkeypatch.setattr(subprocess, "Popen", limited)
    with pytest.raises(RuntimeError, match="could not be written: is the disk full"):
        linked_touch.run({"seconds": "4", "rows": "1"}, tmp_path)
