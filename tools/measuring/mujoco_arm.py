"""A robot arm with a fingertip in a place that MuJoCo simulates: the far side of scenarios 3 and 5.

The arm is a Franka Research 3 as the package franky-sim describes it: masses, inertia of the gears, damping and friction of its
seven joints, and limits of their torques. Ours are what it carries, a rod with a sphere of 10 mm radius and 0.2 kg, and how it is
controlled (arm_control.py).

The controller computes the weight that it bears from masses that are wrong: each link's by up to 5 %, the tool's by 30 %. It feels
contacts by a force sensor between arm and tool, tared before it sets out. The tip alone touches, the links do not.
"""

import importlib.util
from pathlib import Path

import mujoco
import numpy as np

from measuring import arm_control
from measuring.arm_control import RADIUS, TICK

SUBSTEPS = 4
JOINTS = 7
UNSEEN = 3  # group of what no camera sees
TOOL_MASS, TOOL_LENGTH = 0.2, 0.1  # (units: kilograms, meters)
POSTURE = np.array([0, 0, 0, -np.pi / 2, 0, np.pi / 2, -np.pi / 4])  # q0 (unit: radians)
WRONG_LINKS, WRONG_TOOL, SEED = 0.05, -0.3, 1  # of the masses that the controller knows
_FLANGE = 0.107  # of the arm, from its last joint (unit: meters)
_SURFACE = {"condim": 3, "solref": [0.005, 1.0]}


def model_of(bodies: list[dict], camera: dict | None = None) -> mujoco.MjModel:
    """`bodies`: boxes and spheres, {"kind", "size" (half extents, or a radius), "at", "friction"}; y is up. One with a "name" and a
    "mass" moves, and may be turned about y by "turn" (radians). `camera`: "eye", its pose, and its field of view from top to bottom.
    """
    spec = mujoco.MjSpec.from_file(str(_description()))
    _keep_joints_and_masses(spec)
    spec.option.timestep = TICK / SUBSTEPS
    spec.option.gravity = [0.0, -9.81, 0.0]
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    for one in bodies:
        kind = {"box": mujoco.mjtGeom.mjGEOM_BOX, "sphere": mujoco.mjtGeom.mjGEOM_SPHERE}[one["kind"]]
        size = [*one["size"], 0.0, 0.0][:3]
        geom = {"type": kind, "size": size, "friction": [one["friction"], 0, 0], **_SURFACE}
        if "mass" not in one:
            spec.worldbody.add_geom(pos=one["at"], **geom)
            continue
        half = 0.5 * one.get("turn", 0.0)
        body = spec.worldbody.add_body(name=one["name"], pos=one["at"], quat=[np.cos(half), 0.0, np.sin(half), 0.0])
        body.add_freejoint()
        body.add_geom(mass=one["mass"], **geom)
    if camera is not None:
        quat = np.zeros(4)
        mujoco.mju_mat2Quat(quat, camera["pose"][:3, :3].flatten())
        spec.worldbody.add_camera(name="eye", pos=camera["pose"][:3, 3], quat=quat, fovy=np.degrees(camera["across_height"]))
    spec.body("base").quat = [1.0, -1.0, 0.0, 0.0]  # its z is up
    tool = spec.body("fr3_link7").add_body(name="tool", pos=[0.0, 0.0, _FLANGE])
    tool.add_site(name="wrist")
    tool.add_site(name="tip", pos=[0.0, 0.0, TOOL_LENGTH])
    shape = {"type": mujoco.mjtGeom.mjGEOM_SPHERE, "size": [RADIUS, 0, 0], "pos": [0.0, 0.0, TOOL_LENGTH]}
    tool.add_geom(name="tip", group=UNSEEN, mass=TOOL_MASS, friction=[0, 0, 0], **shape, **_SURFACE)
    spec.add_sensor(name="wrist", type=mujoco.mjtSensor.mjSENS_FORCE, objtype=mujoco.mjtObj.mjOBJ_SITE, objname="wrist")
    return spec.compile()


def _description() -> Path:
    """The package's own modules need others that are not installed, so it is found without being imported."""
    package = importlib.util.find_spec("franky_sim")
    assert package is not None and package.submodule_search_locations
    return Path(package.submodule_search_locations[0]) / "assets/fr3.xml"


def _keep_joints_and_masses(spec: mujoco.MjSpec) -> None:
    """Of the description: without meshes, its own drives, and the gripper."""
    for kind in (spec.keys, spec.equalities, spec.tendons, spec.actuators, spec.excludes, spec.geoms):
        for one in list(kind):
            spec.delete(one)
    spec.delete(spec.body("hand"))
    for kind in (spec.meshes, spec.materials):
        for one in list(kind):
            spec.delete(one)


class Arm:
    def __init__(self, bodies: list[dict], at: np.ndarray, camera: dict | None = None):
        """Stands with its tip at `at` (unit: meters)."""
        self._model, self._known = model_of(bodies, camera), model_of(bodies)
        self._data, self._thought = mujoco.MjData(self._model), mujoco.MjData(self._known)
        wrong = np.random.default_rng(SEED).uniform(1.0 - WRONG_LINKS, 1.0 + WRONG_LINKS, self._known.nbody)
        wrong[self._known.body("tool").id] = 1.0 + WRONG_TOOL
        self._known.body_mass[:] *= wrong
        self._site, self._geom = self._model.site("tip").id, self._model.geom("tip").id
        self._data.qpos[:JOINTS] = POSTURE
        mujoco.mj_forward(self._model, self._data)
        self._model.body_pos[self._model.body("base").id] += at - self.tip
        self._target = np.array(at)
        self._sensor = arm_control.ForceSensor()
        self.touches = False
        self.contact = np.zeros(3)  # of the surroundings on the tip, as the sensor has it (unit: newtons)
        self.touching = np.zeros(3)  # the same as MuJoCo's contacts have it
        self._settle()

    @property
    def tip(self) -> np.ndarray:
        return self._data.site_xpos[self._site].copy()

    @property
    def torques(self) -> np.ndarray:
        """Of the drives in the last tick (unit: newton meters)."""
        return self._data.qfrc_applied[:JOINTS].copy()

    def _settle(self) -> None:
        for _ in range(1000):
            self.go(self._target)
        self._sensor.tare()
        self.contact = np.zeros(3)

    def go(self, wanted: np.ndarray) -> None:
        """One tick, led to where the tip is wanted (unit: meters)."""
        step = arm_control.step_towards(self._target, wanted)
        self._target = self._target + step
        self._data.qfrc_applied[:JOINTS] = self._torques(step / TICK)
        sensed, self.touching = np.zeros(3), np.zeros(3)
        for _ in range(SUBSTEPS):
            mujoco.mj_step(self._model, self._data)
            sensed += self._sensed() / SUBSTEPS
            self.touching += self._contact_force() / SUBSTEPS
        mujoco.mj_kinematics(self._model, self._data)
        self.touches = bool(np.any(self.touching))
        self.contact = self._sensor.contact(sensed)

    def _torques(self, speed: np.ndarray) -> np.ndarray:
        q, rate = self._data.qpos[:JOINTS], self._data.qvel[:JOINTS]
        jacobian = np.zeros((3, self._model.nv))
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_jacSite(self._model, self._data, jacobian, None, self._site)
        led = arm_control.torques(jacobian[:, :JOINTS], self._target - self.tip, speed, q, rate, POSTURE)
        limits = self._model.jnt_actfrcrange[:JOINTS]
        return np.clip(led + self._weight(), limits[:, 0], limits[:, 1])

    def _weight(self) -> np.ndarray:
        """Torques that would bear the arm if its masses were those that the controller knows."""
        weight = np.zeros(self._model.nv)
        self._thought.qpos[:] = self._data.qpos
        mujoco.mj_kinematics(self._known, self._thought)
        mujoco.mj_comPos(self._known, self._thought)
        mujoco.mj_rne(self._known, self._thought, 0, weight)
        return weight[:JOINTS]

    def pose(self, name: str) -> np.ndarray:
        """Of a body that moves: where it is, 4 x 4."""
        body, pose = self._data.body(name), np.eye(4)
        pose[:3, :3], pose[:3, 3] = body.xmat.reshape(3, 3), body.xpos
        return pose

    @property
    def place(self) -> tuple[mujoco.MjModel, mujoco.MjData]:
        """For who looks at it."""
        return self._model, self._data

    def _sensed(self) -> np.ndarray:
        """The sensor's reading in the place's own axes, as a push on the tool."""
        axes = self._data.site("wrist").xmat.reshape(3, 3)
        return -axes @ self._data.sensordata

    def _contact_force(self) -> np.ndarray:
        total, wrench = np.zeros(3), np.zeros(6)
        for number in range(self._data.ncon):
            contact = self._data.contact[number]
            if self._geom not in (contact.geom1, contact.geom2):
                continue
            mujoco.mj_contactForce(self._model, self._data, number, wrench)
            force = contact.frame.reshape(3, 3).T @ wrench[:3]  # from geom1 on geom2
            total += force if contact.geom2 == self._geom else -force
        return total
