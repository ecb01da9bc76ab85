"""./run proof, each part of it in short, and whether it tells of what there is to tell."""

import json
import re
from pathlib import Path

import numpy as np
import prove
import pytest

from proof import faults, fuzz, loop, page, soak
from setup import cache
from testing import words

PLAIN = fuzz.Settings(driver="plain", workers=1)


def test_a_planted_defect_is_found_told_and_its_input_kept(tmp_path):
    search = fuzz.play("planted", fuzz.Target(20_000, 64), PLAIN, tmp_path, led=False)
    assert search.count("crash") == fuzz.MOST_FOUND and search.count("hang") == 0
    for one in search.found:
        assert one.input.read_bytes().startswith(b"touch")
        assert "does not hold: the planted defect" in one.words
    assert len({one.input for one in search.found}) == fuzz.MOST_FOUND


def test_an_input_that_takes_for_ever_is_a_hang(tmp_path):
    (tmp_path / "corpus/planted").mkdir(parents=True)
    (tmp_path / "corpus/planted/input").write_bytes(b"wait for ever")
    settings = fuzz.Settings(driver="plain", workers=1, longest=1.0)
    search = fuzz.play("planted", fuzz.Target(3, 64), settings, tmp_path, led=False)
    assert [one.kind for one in search.found] == ["hang"]
    assert search.found[0].input.read_bytes() == b"wait for ever"


@pytest.mark.parametrize("target", fuzz.CASES)
def test_a_target_in_short(target, tmp_path):
    search = fuzz.play(target, fuzz.Target(2_000 if target == "packets" else 300, fuzz.TARGETS[target].max_len), PLAIN, tmp_path, led=False)
    assert search.found == []
    assert search.runs >= 300


def test_what_was_found_once_is_kept_in_its_targets_folder():
    kept = cache.clone() / "tests/fuzz/found"
    assert {path.name for path in kept.iterdir()} <= set(fuzz.CASES) if kept.is_dir() else True


def test_the_page_is_as_it_would_be_written():
    """But for its figures: sentences that are edited on the page alone would be lost with the next run."""
    # A number, and a figure that was not measured, are of the run.
    plain = re.compile(r"\d|not run")
    written = [one for one in words.of_markdown("", page.text({})).sentences() if not plain.search(one)]
    there = set(words.of_markdown("", page.PAGE.read_text()).sentences())
    assert len(written) > 15 and not [one for one in written if one not in there]


def test_by_the_front_door_it_leaves_its_figures(tmp_path, capsys):
    arguments = ["--only=fuzz.meshes", "--runs=50", "--driver=plain", "--workers=2", f"--output={tmp_path}"]
    assert prove.main(arguments) == 0
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["fuzz.meshes_runs"] >= 50 and summary["fuzz.meshes_crashes"] == summary["fuzz.meshes_hangs"] == 0
    assert summary["fuzz.meshes_driver"] == "plain" and "played, 0 crashes" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--only=luck"], "choose from fuzz, faults, soak, loop"),
        (["--only=fuzz.luck"], "choose from packets, meshes, recordings, images, scene_properties"),
        (["--only=soak", "--days=1"], "unknown option --days"),
        (["--runs=7"], "whose options"),
    ],
)
def test_what_there_is_not_is_refused(arguments, said, tmp_path):
    with pytest.raises(ValueError, match=said):
        prove.main([*arguments, f"--output={tmp_path}"])


SHORT = faults.Settings(seconds=3.0, cycles=6)


@pytest.mark.parametrize("name", faults.CASES)
def test_a_fault_in_short(name, tmp_path):
    try:
        outcome = faults.FAULTS[name].do(faults.Place(SHORT, tmp_path))
    except faults.LeftOut as why:
        pytest.skip(str(why))
    assert outcome.survived, outcome.seen


def test_a_fault_that_is_not_survived_is_told(tmp_path):
    script = tmp_path / "planted.gd"
    script.write_text(f'extends "{cache.clone()}/tests/godot/test_case.gd"\n\n\nfunc test_it() -> void:\n\tOS.crash("planted")\n')
    outcome = faults.inside("it", script)(faults.Place(SHORT, tmp_path))
    assert not outcome.survived and "ended before its end" in outcome.seen
    figures = {"faults.it.survived": outcome.survived, "faults.disk_full.survived": True}
    assert faults.totals(figures) == {"faults": 2, "faults_survived": 1}


def test_the_churn_in_short(tmp_path):
    figures = soak.run(soak.CASES, soak.Settings(hours=0.02), tmp_path)
    assert figures["soak.ticks"] == pytest.approx(2 * 72_000, abs=100) and figures["soak.changes"] > 100
    assert figures["soak.pointer_pressed_frames"] > 100 and figures["soak.tool_pressed_frames"] > 0
    assert figures["soak.files_growth"] < 10  # what is open at a moment comes and goes by five
    assert (tmp_path / "memory.png").is_file()


def test_memory_that_grows_is_told():
    steady = {"files": 9, "threads": 3, "objects": 700, "ticks": 1, "changes": {"body": 2}, "pressed": {"pointer": 3}}
    samples = [{"time": 60.0 * i, "resident_mb": 200.0 + max(0.0, 30.0 - i) + 0.01 * i} | steady for i in range(480)]
    assert soak.judge(samples)["soak.growth_mb"] == pytest.approx(2.4, abs=0.1)


CYCLICTEST = """# /dev/cpu_dma_latency set to 0us
# Histogram
000000 000000
000003 000900
000012 000099
# Total: 000001000
# Min Latencies: 00003
# Max Latencies: 31234
# Histogram Overflows: 00001
"""


def test_the_histogram_of_cyclictest_is_read():
    counts = loop.read_cyclictest(CYCLICTEST)
    assert counts.sum() == 1000 and counts[3] == 900 and counts[-1] == 1
    assert [loop.quantile(counts, share) for share in (0.5, 0.9, 0.91, 0.999, 1.0)] == [3, 3, 12, 12, loop.MOST_LATE]
    with pytest.raises(RuntimeError, match="counted nothing"):
        loop.read_cyclictest("")


def test_the_worse_of_idle_and_loaded_counts():
    assert loop.totals({"loop.idle.p999_over_cyclictest": 0.5, "loop.loaded.p999_over_cyclictest": 1.5}) == {"loop.p999_over_cyclictest": 1.5}


def test_deadlines_are_drawn(tmp_path):
    for case in loop.CASES:
        counts = {name: np.bincount([1, 1, 2, 40]).tolist() for name in loop.LOOPS}
        (tmp_path / f"{case}.json").write_text(json.dumps(counts))
    assert loop.draw(tmp_path).stat().st_size > 10_000


def test_the_page_says_what_was_found_and_what_was_not_run():
    figures = {"fuzz.packets_runs": 12, "fuzz.packets_crashes": 3, "faults.disk_full.survived": False, "faults.disk_full.seen": "a hole"}
    written = page.text(figures | faults.totals(figures))
    assert "| 12 | not run | 3 |" in written and "| **no** | a hole |" in written
    assert written.count(page.NOT_RUN) > 20 and "0 of 1" in written


def test_the_page_that_is_kept_names_every_target_and_every_fault():
    kept = Path(page.PAGE).read_text()
    assert all(f"`{name}`" in kept for name in fuzz.TARGETS)
    assert all(fault.what in kept for fault in faults.FAULTS.values())
