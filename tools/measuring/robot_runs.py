"""Cases of scenarios 3 and 5 with a robot that a simulator made by others plays (robot_place.py), two at a time."""

import json
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from measuring.teleop_scene import Scene
from setup import cache, fetching, python_tools

# Of another run on this machine there are other ports.
_PORT = 20000 + os.getpid() % 600 * 20


@dataclass(frozen=True)
class Kind:
    title: str
    environments: tuple[str, ...]  # of setup/python_tools.py; the program runs in the first
    program: str


KINDS = {
    "mujoco": Kind("MuJoCo", ("mujoco",), "mujoco_place.py"),
    "mujoco_seen": Kind("MuJoCo", ("mujoco",), "mujoco_seen_place.py"),
    "franka": Kind("libfranka and its simulator", ("franka", "franka_simulator"), "franka_place.py"),
}


def advice(robot: str) -> str:
    """Installs what is missing. Returns why it cannot be had and what to do; empty where it is there."""
    kind = KINDS[robot]
    for name in kind.environments:
        if python_tools.is_done(name):
            continue
        print(f"Fetching {kind.title}, once …", flush=True)
        try:
            python_tools.install(name)
        except fetching.Unreachable as error:
            return f"{kind.title}: not installed, so this experiment is skipped: {error}"
    return ""


def bodies_of(scene: Scene) -> list[dict]:
    """The static boxes and spheres of a scene, as the places take them."""
    bodies: list[dict] = []
    place, friction = [0.0] * 3, 0.0
    for kind, *words in (line.split() for line in scene.lines().splitlines()):
        if kind == "body":
            numbers = [float(word) for word in words[2:]]
            if words[1] != "static" or not _is_unturned(numbers[10:14]):
                raise ValueError(f"{words[0]}: only static bodies that are not turned are understood here")
            place, friction = numbers[7:10], numbers[6]
        elif kind in ("box", "sphere"):
            count = 3 if kind == "box" else 1
            size, at = [float(word) for word in words[:count]], [float(word) for word in words[count : count + 3]]
            bodies.append({"kind": kind, "size": size, "at": [a + b for a, b in zip(place, at, strict=True)], "friction": friction})
    return bodies


def _is_unturned(rotation: list[float]) -> bool:
    return sum(abs(part) > 0.0 for part in rotation) == 1 and max(map(abs, rotation)) == 1.0


def run(robot: str, cases: list[dict]) -> dict[str, dict[str, float]]:
    """Figures by the names of the cases: {"name", "bodies", "delay_ms", "passivity", "seconds", "operator"}."""
    numbered = [case | {"port": _PORT + number, **_at_franka(number)} for number, case in enumerate(cases)]
    workers = min(os.cpu_count() or 1, len(numbered))
    with ThreadPoolExecutor(workers) as pool:
        shares = [numbered[first::workers] for first in range(workers)]
        found = [one for share in pool.map(lambda share: _play(KINDS[robot], share), shares) for one in share]
    by_name = {one.pop("name"): one for one in found}
    return {case["name"]: by_name[case["name"]] for case in cases}


def _at_franka(number: int) -> dict:
    """Addresses of this machine that the arms of one case alone listen at, and the Python that plays them."""
    run = os.getpid() % 250
    hosts = [f"127.{1 + run}.{number}.{1 + arm}" for arm in range(2)]
    return {"hosts": hosts, "simulator": str(python_tools.python("franka_simulator"))}


def _play(kind: Kind, cases: list[dict]) -> list[dict]:
    command = [python_tools.python(kind.environments[0]), cache.clone() / "tools/measuring" / kind.program]
    done = subprocess.run(command, input=json.dumps(cases), text=True, capture_output=True)
    if done.returncode != 0:
        raise RuntimeError(f"{kind.title}: the robot's side could not be played:\n{done.stderr[-3000:]}")
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
