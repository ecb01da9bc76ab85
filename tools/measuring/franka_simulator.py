"""Two Franka arms that speak the arm's own network protocol, as franky-sim plays them in MuJoCo: the far side of scenario 3. Runs in
the simulator's virtual environment (tools/franka/simulator.txt).

The first line of the standard input is JSON: {"hosts": two addresses, "bodies": as robot_runs.bodies_of has them, "start": of the
tip}. Each arm stands among bodies of its own and carries ours: a sphere of 10 mm radius and 50 g on its gripper, with a force sensor.
Answered by a line of JSON: where "start" and the axes of the place are in the frame of an arm's base. Both then run freely until
`hold`; from there on `step` goes on by one tick and is answered by what the sensors have (newtons), `free` lets them run again.
"""

import json
import select
import sys
import xml.etree.ElementTree as ET

import franky_sim
import mujoco
import numpy as np
from franky_sim.mujoco_simulator import MujocoSimulator

RADIUS, MASS, REACH = 0.01, 0.05, 0.05  # of the sphere; from the gripper's own center (units: meters, kilograms)
GRIPPER = 0.1034  # its center, from the flange (unit: meters)
APART = 3.0  # of the arms' bases (unit: meters)
UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])  # the place's y is the arms' z
# Of the tip and the place: these touch each other, and no link of the arm (the place is as deep as the arm is high).
_SURFACE = {"condim": "3", "solref": "0.005 1", "contype": "2", "conaffinity": "2"}


def words(values) -> str:
    return " ".join(f"{value:.17g}" for value in np.atleast_1d(values))


def add_tool(simulator: MujocoSimulator, sensors: ET.Element, number: int) -> None:
    hand = next(body for body in simulator.worldbody.iter("body") if body.get("name") == f"robot{number}_hand")
    tool = ET.SubElement(hand, "body", name=f"tool{number}", pos=words([0.0, 0.0, GRIPPER + REACH]))
    ET.SubElement(tool, "site", name=f"wrist{number}")
    ET.SubElement(tool, "geom", name=f"tip{number}", type="sphere", size=words(RADIUS), mass=words(MASS), friction="0 0 0", **_SURFACE)
    ET.SubElement(sensors, "force", name=f"wrist{number}", site=f"wrist{number}")


def add_bodies(simulator: MujocoSimulator, bodies: list[dict], origin: np.ndarray, base: np.ndarray) -> None:
    for one in bodies:
        size = np.abs(UP @ one["size"]) if one["kind"] == "box" else np.array(one["size"])
        at = base + origin + UP @ one["at"]
        friction = words([one["friction"], 0.0, 0.0])
        ET.SubElement(simulator.worldbody, "geom", type=one["kind"], size=words(size), pos=words(at), friction=friction, **_SURFACE)


def readings(simulator: MujocoSimulator, number: int) -> dict:
    """`sensor`: a push on the tool; `touching`: of MuJoCo's contacts on the tip; both in the axes of the arm's base."""
    model, data = simulator.model, simulator.data
    axes = data.site(f"wrist{number}").xmat.reshape(3, 3)
    sensor, tip = -axes @ data.sensor(f"wrist{number}").data, model.geom(f"tip{number}").id
    touching, wrench = np.zeros(3), np.zeros(6)
    for index in range(data.ncon):
        contact = data.contact[index]
        if tip in (contact.geom1, contact.geom2):
            mujoco.mj_contactForce(model, data, index, wrench)
            force = contact.frame.reshape(3, 3).T @ wrench[:3]  # from geom1 on geom2
            touching += force if contact.geom2 == tip else -force
    return {"sensor": sensor.tolist(), "touching": touching.tolist()}


def main() -> None:
    asked = json.loads(sys.stdin.readline())
    simulator = MujocoSimulator()
    with simulator:
        simulator.worldbody.remove(next(geom for geom in simulator.worldbody if geom.get("name") == "ground"))
        sensors = ET.SubElement(simulator.scene, "sensor")
        for number in range(2):
            base = np.array([0.0, APART * number, 0.0])
            robot = simulator.add_robot(position=tuple(base))
            center = robot.kinematics(np.array(robot.initial_q))
            origin = center.translation + center.rotation[:, 2] * REACH - UP @ asked["start"]
            add_tool(simulator, sensors, number)
            add_bodies(simulator, asked["bodies"], origin, base)
        with franky_sim.SimulationServer(simulator, hostname_candidates=asked["hosts"]) as server:
            print(json.dumps({"origin": origin.tolist(), "up": UP.tolist(), "reach": REACH}), flush=True)
            serve(simulator, server)


def serve(simulator: MujocoSimulator, server: franky_sim.SimulationServer) -> None:
    is_held = False
    while True:
        if not is_held:
            server.run_once(realtime=True)
            if not select.select([sys.stdin], [], [], 0.0)[0]:
                continue
        command = sys.stdin.readline().strip()
        if command == "step":
            server.run_once(realtime=False)
            print(json.dumps([readings(simulator, number) for number in range(2)]), flush=True)
        elif command in ("hold", "free"):
            is_held = command == "hold"
            print(json.dumps(command), flush=True)
        else:
            return


if __name__ == "__main__":
    main()
