"""Cases of scenario 3 with a robot in a place that MuJoCo simulates (mujoco_place.py), two at a time."""

import json
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor

from measuring.teleop_scene import Scene
from setup import cache, fetching, python_tools

# Of another run on this machine there are other ports.
_PORT = 20000 + os.getpid() % 600 * 20


def advice() -> str:
    """Installs MuJoCo where it is missing. Returns why it cannot be had and what to do; empty where it is there."""
    if python_tools.is_done("mujoco"):
        return ""
    print("Fetching MuJoCo, once …", flush=True)
    try:
        python_tools.install("mujoco")
    except fetching.Unreachable as error:
        return f"MuJoCo is not installed, so this experiment is skipped: {error}"
    return ""


def bodies_of(scene: Scene) -> list[dict]:
    """The static boxes and spheres of a scene, as mujoco_place.model_of takes them."""
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


def run(cases: list[dict]) -> dict[str, dict[str, float]]:
    """Figures by the names of the cases: {"name", "bodies", "delay_ms", "passivity", "seconds", "operator"}."""
    numbered = [case | {"port": _PORT + number} for number, case in enumerate(cases)]
    workers = min(os.cpu_count() or 1, len(numbered))
    with ThreadPoolExecutor(workers) as pool:
        found = [one for share in pool.map(_play, [numbered[first::workers] for first in range(workers)]) for one in share]
    by_name = {one.pop("name"): one for one in found}
    return {case["name"]: by_name[case["name"]] for case in cases}


def _play(cases: list[dict]) -> list[dict]:
    script = cache.clone() / "tools/measuring/mujoco_place.py"
    done = subprocess.run([python_tools.python("mujoco"), script], input=json.dumps(cases), text=True, capture_output=True)
    if done.returncode != 0:
        raise RuntimeError(f"MuJoCo's side could not be played:\n{done.stderr[-3000:]}")
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
