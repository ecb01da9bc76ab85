"""Bundles: what has left its inputs is played again to the same bits, by the project and by the program that stands alone."""

import json
import os
import re
import shlex
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import experiment
import pytest
import replay

import project
from measuring import records
from setup import cache, godot
from testing import exports


def play(program: list, *options: str) -> subprocess.CompletedProcess:
    command = [*program, "--headless", "--", *options]
    return subprocess.run(list(map(str, command)), timeout=180, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


@pytest.fixture(scope="module")
def exported() -> list:
    return [exports.of_project()]


@pytest.fixture(scope="module")
def bundle(tmp_path_factory) -> Path:
    """In real time, as documented: without --duration, which is shorter here."""
    folder = tmp_path_factory.mktemp("bundle")
    line = next(line for line in (cache.clone() / "docs/bundles.md").read_text().splitlines() if "--inputs=1" in line)
    documented = shlex.split(line.split("#")[0])[3:]
    options = [option for option in documented if not re.match("--(output|duration)=", option)]
    done = play([godot.command(), "--path", project.FOLDER], *options, f"--output={folder}", "--duration=2", "--case=hand")
    assert done.returncode == 0, done.stdout
    return folder


def test_a_bundle_has_what_its_page_says(bundle):
    described = re.findall(r"`CASE(_?[\w.]+)`", (cache.clone() / "docs/bundles.md").read_text())
    assert len(described) > 4
    of_others = {"hand_force.svg", "hand_hand.svg", "hand_images.oni"}  # by the launcher, of a camera
    assert {f"hand{ending}" for ending in described} - of_others == {path.name for path in bundle.iterdir()}
    assert json.loads((bundle / "hand_settings.json").read_text())["options"]["duration"] == 2.0


def test_it_gives_the_same_bits_again(bundle, capsys):
    assert replay.main([str(bundle)]) == 0
    said = capsys.readouterr().out
    assert re.search(r"hand: 2\d{3} ticks, bit-exact, [0-9a-f]{8,16}$", said, re.M), said
    assert replay.main([str(bundle)]) == 0
    assert capsys.readouterr().out == said


def test_the_exported_program_gives_them_too(bundle, exported, tmp_path):
    done = play(exported, f"--replay={bundle}", f"--output={tmp_path}")
    assert done.returncode == 0, done.stdout
    report = json.loads((tmp_path / "hand_replay.json").read_text())
    assert report["same"] and report["rows"] == "same" and report["problem"] == ""
    assert (tmp_path / "hand.csv").read_bytes() == (bundle / "hand.csv").read_bytes()


def test_so_does_a_place_that_has_nothing_of_this_one(bundle, exported, tmp_path):
    """Another home, another folder, no settings of anybody's; and the C library computes as on a processor without fused steps."""
    place, taken = tmp_path / "elsewhere", tmp_path / "taken home"
    shutil.copytree(exported[0].parent, place)
    shutil.copytree(bundle, taken)
    command = [place / exported[0].name, "--headless", "--", f"--replay={taken}"]
    own = {"HOME": str(tmp_path), "PATH": "/usr/bin:/bin", "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4"}
    done = subprocess.run(command, cwd="/", env=own, timeout=180, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert done.returncode == 0 and "bit-exact" in done.stdout, done.stdout


def launched(program: list, folder: Path, *options: str) -> None:
    ports = [20000 + os.getpid() % 6000 * 2 + number for number in (0, 1)]
    done = play(program, "--launch=now", f"--output={folder}", f"--local_port={ports[0]}", f"--remote_port={ports[1]}", *options)
    assert done.returncode == 0, done.stdout


def test_the_exported_launcher_plays_scenario_4_with_itself_and_the_bundle_gives_it_again(exported, tmp_path, capsys):
    launched(exported, tmp_path, "--scenario=4", "--seconds=4", "--delay=40", "--jitter=5", "--loss=0.05")
    for side in ("operator", "environment"):
        assert (tmp_path / f"{side}_force.svg").read_text().startswith("<svg")
        ElementTree.parse(tmp_path / f"{side}_hand.svg")
    assert records.figures(records.read(tmp_path / "operator.csv"))["contact_time_share"] > 0.05
    statistics = json.loads((tmp_path / "operator_statistics.json").read_text())
    assert statistics["link"]["objects"] > 0
    assert replay.main([str(tmp_path)]) == 0
    assert len(re.findall("bit-exact", capsys.readouterr().out)) == 2
    again = play(exported, f"--replay={tmp_path}")
    assert again.returncode == 0, again.stdout


def test_the_launcher_plays_every_world_of_a_scene_with_a_robot(exported, tmp_path):
    launched(exported, tmp_path, "--scenario=3", "--seconds=2")
    again = play(exported, f"--replay={tmp_path}")
    assert again.returncode == 0, again.stdout
    assert len(re.findall("bit-exact", again.stdout)) == len(list(tmp_path.glob(f"*{replay.INPUTS}"))) == 2


def test_the_launcher_refuses_what_there_is_not(exported, tmp_path):
    for option, said in {
        "--scenario=7": "a whole number from 1 to 5",
        "--driver=DRIVER_X": "DRIVER_FALCON",
        "--seconds=0": "a number from 0.1",
        "--delay=nan": "a number from 0.0 to 20000.0 (ms",
        "--colour=red": "there is no --colour",
    }.items():
        done = play(exported, "--launch=now", f"--output={tmp_path}", option)
        assert done.returncode == 2 and said in done.stdout, done.stdout
    assert not list(tmp_path.iterdir())


def test_as_an_experiment_it_has_its_figures_and_plots(bundle):
    assert experiment.main([str(bundle)]) == 0
    output = cache.clone() / "build/experiments" / f"{bundle.name}_again"
    summary = json.loads((output / "summary.json").read_text())
    assert summary["hand.same"] and summary["hand.force_max_n"] > 0.0
    assert (output / "hand_force.png").is_file() and (output / "hand_object.png").is_file()


def test_a_damaged_one_is_said_and_what_is_whole_is_played(bundle, tmp_path, capsys):
    inputs = (bundle / f"hand{replay.INPUTS}").read_bytes()
    middle = len(inputs) // 2
    flipped = bytearray(inputs)
    flipped[middle] ^= 1
    for name, bytes_ in {"short": inputs[:middle], "flipped": flipped}.items():
        (tmp_path / f"{name}{replay.INPUTS}").write_bytes(bytes_)
    assert replay.main([str(tmp_path)]) == 2
    said = capsys.readouterr().out
    for line in ("short", "flipped"):
        found = re.search(rf"{line}: (\d+) ticks, bit-exact, .*not all of it could be played: ", said)
        assert found and 500 < int(found[1]) < 1800, said


def test_rows_that_are_others_are_told(bundle, tmp_path, capsys):
    for path in bundle.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    with (tmp_path / "hand.csv").open("a") as rows:
        rows.write("1,2,3\n")
    assert replay.main([str(tmp_path)]) == 1
    assert "its rows are not those of the bundle" in capsys.readouterr().out


@pytest.mark.parametrize("part", ["hand_statistics.json", "hand_periods.json", "hand_trace.json"])
def test_a_part_that_was_changed_is_told(part, bundle, tmp_path, capsys):
    for path in bundle.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / part).write_text((bundle / part).read_text().replace("0", "1", 1))
    assert replay.main([str(tmp_path)]) == 1
    assert f"its part {part} is not the one that was recorded" in capsys.readouterr().out


def test_what_is_no_bundle_is_refused(tmp_path, capsys):
    assert replay.main([str(tmp_path)]) == 2 and replay.main([]) == 2
    assert experiment.main([str(tmp_path)]) == 2
    assert "is no bundle" in capsys.readouterr().err
