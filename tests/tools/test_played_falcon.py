"""Scenario 1, touched from end to end: Godot, its haptic thread, the Falcon's driver and libusb, and below them a Falcon
that is played by tests/played."""

import json
import subprocess

import pytest
from measuring import records
from project import FOLDER
from setup import cache, godot

PLAYER = cache.clone() / "build/template_debug/tests/play_falcon"


@pytest.mark.skipif(not PLAYER.is_file(), reason="umockdev is not installed")
def test_the_hand_that_holds_a_falcon_feels_the_ground(tmp_path):
    firmware, figures = tmp_path / "firmware.bin", tmp_path / "figures.json"
    device = {"driver": 16, "firmware": str(firmware), "force_limit": 6.0}
    command = [
        PLAYER, f"--firmware={firmware}", f"--figures={figures}", "--",
        godot.command(), "--headless", "--path", FOLDER, "--",
        "--scene=res://gallery/static_testbed/static_testbed.tscn", "--case=falcon", f"--output={tmp_path}", "--duration=6", "--warmup=2",
        *(f"--device.{name}={json.dumps(value)}" for name, value in device.items()),
    ]  # fmt: skip
    done = subprocess.run(command, text=True, capture_output=True, timeout=60)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    record = records.read(tmp_path / "falcon.csv")
    # The hand was moved by the device, and was pushed back by what the scene's ground is worth.
    assert record.force_size.max() > 1.0
    seen = json.loads(figures.read_text())
    assert seen["exchanges"] > 500
    assert seen["largest_force_N"] > 1.0
