"""Scenario 5 in a place that MuJoCo simulates: a camera there makes the operator's local model, and an arm follows the hand
(mujoco_arm.py). Runs in MuJoCo's own virtual environment (tools/credibility/requirements.txt).

MuJoCo draws the depth images; the camera adds a Kinect's noise and 1 % of error, and Tactus recognizes what is in them (eye.py). The
model's masses and friction are the library's and the defaults, its stiffness is that of the arm's own control. A state is sent when
the next image is drawn, a thirtieth of a second after its own. The camera does not see the arm.
"""

import json
import os
import sys
from pathlib import Path

os.environ.setdefault("MUJOCO_GL", "egl")

import mujoco
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from measuring import arm_control, eye, robot_place
from measuring.mujoco_arm import Arm
from project import FOLDER
from tactus_peer import Teleoperator
from tactus_peer.descriptions import body, box

IMAGE_EVERY = 33  # ticks
FAR = 8.0  # nothing is seen beyond (unit: meters)
_DOWN = 0.9701  # that the camera looks down by (unit: radians)
_AT = np.array([0.0, 0.7, 0.48])  # the camera (unit: meters)
_SUPPORT = 0
_PATIENCE = 1.0  # for what an image shows (unit: seconds)


def camera_pose() -> np.ndarray:
    """It looks along its -z."""
    pose = np.eye(4)
    c, s = np.cos(_DOWN), np.sin(_DOWN)
    pose[:3, :3] = [[1, 0, 0], [0, c, s], [0, -s, c]]
    pose[:3, 3] = _AT
    return pose


class Picture:
    """What the camera sees of an arm's place."""

    def __init__(self, arm: Arm):
        self._model, self._data = arm.place
        self._renderer = mujoco.Renderer(self._model, eye.HEIGHT, eye.WIDTH)
        self._renderer.enable_depth_rendering()
        self._camera = mujoco.MjvCamera()
        self._camera.type, self._camera.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, self._model.camera("eye").id

    def depth(self) -> np.ndarray:
        self._renderer.update_scene(self._data, self._camera)
        depth = self._renderer.render()
        return np.where(depth < FAR, depth, 0.0)

    def close(self) -> None:
        self._renderer.close()


class Pair(robot_place.Pair):
    def __init__(self, case: dict, at: np.ndarray):
        how = {"pose": camera_pose(), "across_height": eye.across_height()}
        self.robot, self.direct = Arm(case["bodies"], at, how), Arm(case["bodies"], at, how)
        self._moving = [one for one in case["bodies"] if "mass" in one]
        self._picture = Picture(self.robot)
        self._eye = eye.Eye(how["pose"], {"meshes": json.dumps([one["name"] for one in self._moving]), "knows_support": "true"})
        self._ticks, self._shown_at, self._states = 0, None, []
        self._off: list[float] = []

    def describe(self, side: Teleoperator) -> None:
        seen = self._eye.find(self._picture.depth, {one["name"] for one in self._moving})
        library = json.loads((FOLDER / "addons/tactus/meshes/library.json").read_text())
        normal, offset = seen["plane"]
        table = self._moving[0]["on"]
        height = offset / normal[1]
        pose = {"position": (0.0, height - table[1], 0.0), "rotation": (0.0, 0.0, 0.0, 1.0)}
        side.add_body(body(_SUPPORT, "support", [box(tuple(table))], stiffness=arm_control.STIFFNESS, pose=pose))
        for number, one in enumerate(self._moving, _SUPPORT + 1):
            name = one["name"]
            place, rotation = eye.pose_of(seen["objects"][name]["pose"])
            pose = {"position": place, "rotation": rotation}
            mass = library[name]["mass_kg"]
            side.add_body(body(number, name, [box(tuple(one["size"]))], stiffness=arm_control.STIFFNESS, mass=mass, pose=pose))

    def go(self, robot: np.ndarray | None, direct: np.ndarray) -> None:
        self.direct.go(direct)
        if robot is not None:
            self.robot.go(robot)

    def answer(self, side: Teleoperator, sample: dict, taken: float) -> None:
        self._ticks += 1
        if self._ticks % IMAGE_EVERY != 0:
            return
        if self._shown_at is not None and (seen := self._eye.seen(_PATIENCE)):
            side.send_states(self._states_of(seen["objects"]), self._shown_at)
        self._shown_at = sample["sequence"]
        self._eye.show(self._picture.depth())

    def _states_of(self, objects: dict) -> list[dict]:
        states = []
        for number, one in enumerate(self._moving, _SUPPORT + 1):
            if (found := objects.get(one["name"])) and found["state"] in ("found", "tracked"):
                place, rotation = eye.pose_of(found["pose"])
                pose = {"position": place, "rotation": rotation}
                speeds = {key: tuple(found[key]) for key in ("linear_velocity", "angular_velocity")}
                states.append({"object": number, "asleep": found["rests"], "pose": pose, **speeds})
        return states

    def note(self, row: dict) -> None:
        for one in self._moving:
            if (modelled := row["bodies"].get(one["name"])) is not None:
                self._off.append(float(np.linalg.norm(self.robot.pose(one["name"])[:3, 3] - modelled)))

    def figures(self) -> dict[str, float]:
        off = 1e3 * np.array(self._off)
        return {"model_place_error_median_mm": float(np.median(off)), "model_place_error_p95_mm": float(np.percentile(off, 95))}

    def close(self) -> None:
        self._eye.close()
        self._picture.close()


if __name__ == "__main__":
    robot_place.main(Pair)
