"""What goes wrong around a scene while a hand touches it: each is done to a real run, and the run must go on, or end in
order, and say what was wrong.
"""

import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import build
from experiments import namespaces
from experiments.namespaces import FAR, OPERATOR, Machines, Side
from measuring import options
from project import FOLDER
from setup import cache, godot
from testing import godot_suite


@dataclass(frozen=True)
class Settings:
    seconds: float = options.option(10.0, "s", 0.1)  # of each touch that something is done to
    cycles: int = options.option(200, "count", 1, 10**6)  # of opening and closing


@dataclass(frozen=True)
class Outcome:
    survived: bool
    seen: str


PULLED_OUT = "PlayedFalcon.APulledCableIsNoEnd"


class LeftOut(Exception):
    """This machine does not permit it."""


@dataclass(frozen=True)
class Place:
    settings: Settings
    output: Path


@dataclass(frozen=True)
class Fault:
    what: str
    do: Callable[[Place], Outcome]


def run(cases: list[str], settings: Settings, output: Path) -> dict[str, object]:
    build.build("template_debug", "tests", "extension")
    figures: dict[str, object] = {}
    for name in cases:
        print(f"{name}: {FAULTS[name].what}", flush=True)
        place = Place(settings, cache.emptied(output / name))
        try:
            outcome = FAULTS[name].do(place)
        except LeftOut as why:
            print(f"  left out: {why}", flush=True)
            figures |= {f"faults.{name}.left_out": str(why)}
            continue
        print(f"  {'survived' if outcome.survived else 'NOT SURVIVED'}: {outcome.seen}", flush=True)
        figures |= {f"faults.{name}.survived": outcome.survived, f"faults.{name}.seen": outcome.seen}
    return figures


def totals(figures: dict[str, object]) -> dict[str, object]:
    tried = [value for key, value in figures.items() if key.endswith(".survived")]
    return {"faults": len(tried), "faults_survived": sum(map(bool, tried))}


# --- one Godot, by options of its main scene


def _scene(place: Place, *words: str, output: Path | None = None) -> list[str]:
    options_ = ["--inputs=1", "--case=hand", f"--duration={place.settings.seconds:g}", f"--output={output or place.output}"]
    return [str(godot.command()), "--headless", "--path", str(FOLDER), "--", *options_, *words]


def _end(process: subprocess.Popen, place: Place) -> str:
    """What it has said until it ended by itself."""
    try:
        said, _ = process.communicate(timeout=10 * place.settings.seconds + 120)
    finally:
        process.kill()
    (place.output / "said.txt").write_text(said)
    return said


def _start(command: list[str], **more) -> subprocess.Popen:
    return subprocess.Popen(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **more)


def _ended_well(process: subprocess.Popen) -> bool:
    return process.returncode is not None and process.returncode >= 0


def _replayed(bundle: Path, place: Place) -> dict:
    """The report of a bundle's one side."""
    output = place.output / "again"
    command = [str(godot.command()), "--headless", "--path", str(FOLDER), "--", f"--replay={bundle}", f"--output={output}"]
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=600)
    report = output / "hand_replay.json"
    return (json.loads(report.read_text()) if report.is_file() else {}) | {"code": done.returncode}


@contextmanager
def _small_disk(megabytes: int):
    with tempfile.TemporaryDirectory() as folder:
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={megabytes}m", "tactus", folder], text=True, capture_output=True)
        if mounted.returncode != 0:
            raise LeftOut(f"no disk may be mounted: {mounted.stderr.strip()}")
        try:
            yield Path(folder)
        finally:
            subprocess.run(["umount", "--lazy", folder], check=True)


def disk_full(place: Place) -> Outcome:
    with _small_disk(1) as disk:
        process = _start(_scene(place, output=disk))
        said = _end(process, place)
        told = "could not be written to its end" in said
        report = _replayed(disk, place)
    kept = report.get("ticks", 0)
    survived = _ended_well(process) and told and kept > 500 and report["same"] and bool(report["problem"])
    return Outcome(survived, f"it went on and {'said so' if told else 'DID NOT SAY SO'}; {kept} recorded ticks play again to the bit")


def killed_while_recording(place: Place) -> Outcome:
    process = _start(_scene(place))
    inputs = place.output / "hand_inputs.tactus"
    _wait(lambda: inputs.is_file() and inputs.stat().st_size > 200_000, 60.0)
    process.kill()
    process.communicate()
    report = _replayed(place.output, place)
    kept = report.get("ticks", 0)
    return Outcome(kept > 200 and report["same"], f"{kept} ticks of what was recorded until then play again to the bit")


def damaged_bundle(place: Place) -> Outcome:
    process = _start(_scene(place))
    _end(process, place)
    inputs = place.output / "hand_inputs.tactus"
    whole = inputs.read_bytes()
    total = _replayed(place.output, place)["ticks"]
    played, told = [], 0
    for number in range(8):
        at = (2 * number + 1) * len(whole) // 16
        damaged = whole[:at] if number % 2 else whole[:at] + bytes([whole[at] ^ 0x10]) + whole[at + 1 :]
        inputs.write_bytes(damaged)
        report = _replayed(place.output, place)
        told += report["code"] == 2 and (not report.get("ticks") or (report["same"] and bool(report["problem"])))
        played.append(report.get("ticks", 0))
    rising = all(a <= b for a, b in zip(played, played[1:]))
    return Outcome(told == 8 and rising, f"{told} of 8 told; of {total} ticks the {', '.join(map(str, played))} before each were played")


def no_rights(place: Place) -> Outcome:
    if shutil.which("setpriv") is None:
        raise LeftOut("setpriv is missing: install util-linux")
    command = ["setpriv", "--bounding-set", "-sys_nice,-ipc_lock,-sys_resource", *_scene(place)]
    limits = ["prlimit", "--rtprio=0:0", "--memlock=0:0", "--nice=0:0"]
    process = _start([*limits, *command])
    said = _end(process, place)
    kept = place.output / "hand_statistics.json"
    if process.returncode != 0 or not kept.is_file():
        return Outcome(False, said[-300:])
    figures = json.loads(kept.read_text())
    return Outcome(not figures["fifo"] and figures["ticks"] > 500, f"it ticks all the same and says: {figures['realtime']}")


def _wait(done: Callable[[], bool], patience: float) -> None:
    end = time.monotonic() + patience
    while not done() and time.monotonic() < end:
        time.sleep(0.02)


# --- two Godots, each in a namespace of its own


Act = Callable[[Machines, tuple[Side, Side], Place], None]


def disturbed(act: Act, largest_force: float = 8.0) -> Callable[[Place], Outcome]:
    """The hand presses a box over a link; then it is done; then the hand feels the box again, and never was kicked."""

    def do(place: Place) -> Outcome:
        if why := namespaces.refusal():
            raise LeftOut(why)
        key = place.output / "key"
        key.write_text("a key that both sides know\n")
        key.chmod(0o600)
        with Machines() as machines:
            sides = namespaces.start_both(machines, key)
            try:
                figures = namespaces.disturbed(*sides, 3.0, lambda: act(machines, sides, place))
                alive = all(side.process and side.process.poll() is None for side in sides)
            finally:
                for side in sides:
                    side.kill()
        key.unlink()
        (place.output / "figures.json").write_text(json.dumps(figures))
        survived = alive and figures["connected"] == 1.0 and figures["force_largest_N"] <= largest_force
        return Outcome(
            survived,
            f"felt again after {figures['seconds_to_touch']:.2f} s, force at most {figures['force_largest_N']:.2f} N, "
            f"the far box moved by {figures['box_moved_mm']:.1f} mm",
        )

    return do


def _freeze(number: int) -> Act:
    def act(_: Machines, sides: tuple[Side, Side], place: Place) -> None:
        process = sides[number].process
        assert process
        os.killpg(process.pid, signal.SIGSTOP)
        time.sleep(place.settings.seconds / 2)
        os.killpg(process.pid, signal.SIGCONT)

    return act


def _kill(number: int) -> Act:
    return lambda _, sides, __: namespaces.restart(sides[number])


def _cut(machines: Machines, _: tuple[Side, Side], place: Place) -> None:
    namespaces.cut_for(machines, place.settings.seconds / 2)


# --- inside of one Godot: tests/proof/faults.gd


def inside(test: str, script: Path = cache.clone() / "tests/proof/faults.gd") -> Callable[[Place], Outcome]:
    def do(place: Place) -> Outcome:
        environment = godot_suite.POISONED | {
            "TACTUS_PROOF_SECONDS": f"{place.settings.seconds:g}", "TACTUS_PROOF_CYCLES": str(place.settings.cycles),
        }  # fmt: skip
        runner = cache.clone() / "tests/godot/run_tests.gd"
        # Few files, for the one that takes them all.
        limited = ["prlimit", "--nofile=512:512"]
        command = [*limited, str(godot.command()), "--headless", "--path", str(FOLDER), "--script", str(runner), "--", str(script), f"test_{test}"]
        process = _start(command, env=environment)
        said = _end(process, place)
        why = godot_suite.judge(said, [f"test_{test}"])
        seen = ", ".join(re.findall(r"^SEEN (.*)$", said, re.M))
        return Outcome(_ended_well(process) and not any(why.values()), "; ".join(filter(None, [seen, *why.values()])))

    return do


def pulled_out(place: Place) -> Outcome:
    program = cache.clone() / "build/template_debug/tests/test_played"
    if not program.is_file():
        raise LeftOut("libumockdev-dev is missing, which plays devices")
    times = max(1, place.settings.cycles // 10)
    command = [program, f"--gtest_filter={PULLED_OUT}", f"--gtest_repeat={times}"]
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=1200)
    (place.output / "said.txt").write_text(done.stdout)
    passed = len(re.findall(r"^\[       OK \]", done.stdout, re.M))
    return Outcome(done.returncode == 0 and passed >= times, f"pulled out and plugged in again {passed} times, each time found again")


FAULTS = {
    "disk_full": Fault("the disk is full while rows and inputs are recorded", disk_full),
    "killed_while_recording": Fault("the program is killed (SIGKILL) while it records", killed_while_recording),
    "damaged_bundle": Fault("a bundle is cut or has a bit turned, in eight places", damaged_bundle),
    "no_rights": Fault("no real-time priority, no locked memory", no_rights),
    "frozen_operator": Fault("the operator's process is frozen (SIGSTOP) and goes on (SIGCONT)", disturbed(_freeze(OPERATOR))),
    "frozen_far_side": Fault("the teleoperator's process is", disturbed(_freeze(FAR))),
    "killed_operator": Fault("the operator's process is killed and started again", disturbed(_kill(OPERATOR))),
    "killed_far_side": Fault("the teleoperator's process is", disturbed(_kill(FAR))),
    "network_gone": Fault("the network is gone for a while", disturbed(_cut)),
    "device_pulled_out": Fault("a Falcon is pulled out and plugged in again", pulled_out),
    "mesh_edited": Fault("a mesh is edited in every frame while it is touched", inside("mesh_edited_while_touched")),
    "bodies_thrown_about": Fault("bodies come, go and jump while they are touched", inside("bodies_come_go_and_jump_while_touched")),
    "hot_reload": Fault("the extension's library is replaced and its reload asked for while it runs", inside("hot_reload")),
    "open_and_close": Fault("a world with device, link and recorder is opened and closed", inside("open_and_close")),
    "no_files_left": Fault("the process may open no more files", inside("no_files_left")),
    "main_thread_stands_still": Fault("the main thread stands still while the hand touches", inside("main_thread_stands_still")),
}
CASES = list(FAULTS)
