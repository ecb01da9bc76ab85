"""Scenario 5 without help from the truth, and in a place that MuJoCo simulates."""

import struct
from pathlib import Path

import numpy as np
import pytest

from experiments import scenario3, scenario5
from measuring import depth_file, eye, robot_runs
from setup import python_tools


def test_what_is_not_known_is_drawn_by_seed_and_never_exact():
    found = [scenario5.drawn(seed) for seed in range(1, 21)]
    assert found[0] == scenario5.drawn(1) and len({str(one) for one in found}) == 20
    for one in found:
        assert one["sensor.knows_support"] is False
        assert one["surface.stiffness"] != scenario5.STIFFNESS and 0.5 <= one["surface.stiffness"] / scenario5.STIFFNESS <= 2.0
        assert 0.0 < np.linalg.norm(one["sensor.synthetic_place_error"]) < 0.02
        assert 0.0 < np.linalg.norm(one["sensor.synthetic_rotation_error"]) < np.radians(3.0)
        assert abs(one["sensor.synthetic_clock_error"]) <= 0.02
        assert all(abs(one[f"robot.robot_{what}_error"]) <= 0.3 for what in ("mass", "friction"))


def test_a_run_that_discovers_nothing_is_counted_and_left_out(monkeypatch, capsys):
    def play(settings, moves, unknown, output):
        if unknown["sensor.synthetic_seed"] == 2:
            raise scenario5.NotDiscovered("nothing is there")
        return unknown["sensor.synthetic_seed"]

    monkeypatch.setattr(scenario5, "play", play)
    monkeypatch.setattr(scenario5, "figures", lambda said, seconds: {"force_error_mean_N": float(said)})
    unknown = {seed: scenario5.drawn(seed) for seed in (1, 2, 3)}
    summary = scenario5._without_help(scenario5.Settings(), 0, unknown, Path())
    assert summary == {
        "seed_1.force_error_mean_N": 1.0, "seed_3.force_error_mean_N": 3.0, "not_discovered_seeds": 1,
        "force_error_mean_N_median": 2.0, "force_error_mean_N_p95": pytest.approx(2.9),
    }  # fmt: skip
    assert "seed 2: nothing is there" in capsys.readouterr().out


def test_a_controller_that_is_mistaken_is_told_over_its_seeds():
    figures = dict.fromkeys(scenario3.FIGURES.values(), 1.0)
    found = {"traditional_robot.0ms": figures} | {
        f"traditional_robot_mistaken_{seed}.0ms": dict.fromkeys(figures, float(seed)) for seed in (1, 2, 3)
    }
    summary = scenario3.summary_of(found)
    assert summary["traditional_robot.0ms.force_error_mean_N"] == 1.0
    assert summary["traditional_robot_mistaken.0ms.force_error_mean_N_median"] == 2.0
    assert summary["traditional_robot_mistaken.0ms.force_error_mean_N_p95"] == pytest.approx(2.9)
    drawn = [scenario3.mistaken(seed) for seed in range(1, 6)]
    assert all(0.7 <= factor <= 1.3 for one in drawn for factor in one.values()) and drawn[0] != drawn[1]


def test_an_image_is_written_as_the_driver_reads_it():
    file = depth_file.DepthFile(4, 2, 1.0, noise=0.0, depth_error=0.0, seed=5)
    try:
        path = Path(file.uri.removeprefix(depth_file.SCHEME))
        file.show(np.array([[0.5, 0.6, 0.7, 0.8], [1.0, 0.0, 1.2, 1.3]]))
        data = path.read_bytes()
        magic, size, width, height, view, rate, error, noise, seed, meshes, image, sequence, shown, plug = struct.unpack_from("<QQii4dQ5I", data)
        assert (magic, size, width, height) == (0x32656E6563537354, len(data), 4, 2) and image == 1 and meshes == 0
        assert (view, rate, error, noise, seed, sequence, shown, plug) == (1.0, 0.0, 0.0, 0.0, 5, 2, 1, 0)
        assert struct.unpack_from("<8f", data, len(data) - 32) == pytest.approx((0.5, 0.6, 0.7, 0.8, 1.0, 0.0, 1.2, 1.3))
    finally:
        file.close()
    assert not path.exists()


def test_rotations_are_written_as_quaternions():
    draw = np.random.default_rng(1)
    for _ in range(50):
        q = draw.normal(size=4)
        x, y, z, w = q / np.linalg.norm(q)
        matrix = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
        assert abs(np.dot(eye.rotation_of(matrix), (x, y, z, w))) == pytest.approx(1.0)


@pytest.mark.skipif(not python_tools.is_done("mujoco"), reason="./run experiment scenario5 --robot=mujoco fetches MuJoCo")
def test_what_a_camera_in_mujoco_sees_is_touched_without_a_delay():
    """The arm presses the cube that the camera has found; the force does not depend on the delay, as that of direct teleoperation does."""
    cases = scenario5.mujoco_cases(scenario5.Settings(seconds=3.5, delay=(100,), robot="mujoco"))
    model = robot_runs.run("mujoco_seen", cases["mujoco_seen"])["mujoco_model.100ms"]
    direct = robot_runs.run("mujoco", cases["mujoco"][:1])["mujoco_direct.100ms"]
    assert model["model_place_error_median_mm"] < 3.0
    assert model["direct_contact_share"] > 0.2 and model["contact_share"] > 0.2
    assert model["force_error_mean_N"] < 0.5 * direct["force_error_mean_N"]
