"""In stepped time the same scene gives the same bytes: of one program, and of the exported one that stands alone."""

import os
import subprocess
from pathlib import Path

import pytest

from measuring.scene_run import Case, play
from testing import exports

SECONDS = 3.0  # the first touch of the sphere, and the box pushed
STATIC = Case("static", "res://gallery/static_testbed/static_testbed.tscn")
DYNAMIC = Case("dynamic", "res://gallery/dynamic_testbed/dynamic_testbed.tscn")
MESHES = Case("meshes", "res://gallery/mesh_library/mesh_library.tscn")  # which it finds by their names in the library


@pytest.fixture(scope="module")
def exported() -> Path:
    return exports.of_project()


def rows(case: Case, folder: Path) -> bytes:
    return play(case, folder, SECONDS, "stepped").rows.read_bytes()


def test_two_runs_write_the_same_rows(tmp_path):
    first, second = (rows(DYNAMIC, tmp_path / name) for name in ("first", "second"))
    assert first.count(b"\n") > 1000 * SECONDS
    assert first == second


def test_one_core_writes_the_same_rows(tmp_path):
    cores = os.sched_getaffinity(0)
    with_all = rows(DYNAMIC, tmp_path / "all")
    os.sched_setaffinity(0, {min(cores)})
    try:
        with_one = rows(DYNAMIC, tmp_path / "one")
    finally:
        os.sched_setaffinity(0, cores)
    assert with_one == with_all


@pytest.mark.parametrize("case", [STATIC, DYNAMIC, MESHES], ids=lambda case: case.name)
def test_the_exported_program_feels_what_the_project_does(exported, tmp_path, case):
    options = {"scene": case.scene, "case": case.name, "output": tmp_path, "clock": "stepped", "duration": SECONDS}
    command = [exported, "--headless", "--", *(f"--{key}={value}" for key, value in options.items())]
    done = subprocess.run(
        command, cwd=exported.parent, timeout=120, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    assert done.returncode == 0, done.stdout
    assert (tmp_path / f"{case.name}.csv").read_bytes() == rows(case, tmp_path / "project")
