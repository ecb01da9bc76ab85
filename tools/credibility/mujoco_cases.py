"""The cases of the bench `credibility` that MuJoCo can be asked: one JSON object on stdout, CASE to value in SI units.

At 0.1 ms with elliptic cones and contacts that settle in 5 ms. Runs in a virtual environment of its own
(tools/credibility/requirements.txt). Each case is the median over headings of the whole scene about the vertical.

MuJoCo's friction is the optimum of a convex problem. A contact that slides at v is lifted there as if it approached at mu v,
2 mu v T far for a settling time T. Where that is more than what its load presses in, the contact is lost, and the body hops.
And friction below the cone gives way in proportion to the force, less so with a large impratio. So a cube that is pushed for
long is pushed slowly, on contacts that settle in 20 ms, with an impratio of 100. At 0.1 m/s and 5 ms it hops all the way.
"""

import json
import math
import statistics
import sys

import mujoco
import numpy

STEP = 1e-4  # (unit: seconds)
SLOW_STEP = 2e-4
PLACINGS = 20
SLOW_PLACINGS = 4  # of what takes long; MuJoCo's answers differ by rounding between headings
GRAVITY = 9.81


def _model(
    bodies: str, floor_friction: float | None, gravity: float = GRAVITY, *, step: float = STEP, settling: float = 0.005, impratio: float = 1
):
    floor = ""
    if floor_friction is not None:
        floor = f'<geom name="floor" type="plane" size="20 20 1" friction="{floor_friction} 0 0"/>'
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco>
        <option timestep="{step}" cone="elliptic" impratio="{impratio}" gravity="0 0 {-gravity}" integrator="implicitfast"/>
        <default><geom condim="3" solref="{settling} 1"/></default>
        <worldbody>{floor}{bodies}</worldbody></mujoco>"""
    )


def _heading(i: int) -> float:
    """Headings that no symmetry of a box maps onto each other (unit: radians)."""
    return 0.5 * math.pi * i / PLACINGS


def _quaternion(angle: float) -> str:
    return f"{math.cos(angle / 2)} 0 0 {math.sin(angle / 2)}"


def _yaw(q) -> float:
    return math.atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] ** 2 + q[3] ** 2))


def _middle(values) -> float:
    """The median: a body that slides fast on so stiff contacts hops in some placings, and then takes longer."""
    return statistics.median(values)


def _body(geometry: str, height: float, mass: float, friction: float, heading: float) -> str:
    return (
        f'<body name="body" pos="0 0 {height}" quat="{_quaternion(heading)}"><freejoint/>'
        f'<geom name="solid" {geometry} mass="{mass}" friction="{friction} 0 0"/></body>'
    )


def _pushed(size, mass, friction, off, speed, seconds, heading, **contacts):
    """Turn (unit: radians) and mean force on the finger over the last half (unit: newtons) of a box that a
    frictionless finger of 5 mm pushes along a straight line `off` beside its middle."""
    half = [0.5 * s for s in size]
    solid = _body(f'type="box" size="{half[0]} {half[1]} {half[2]}"', half[2], mass, friction, heading)
    c, s = math.cos(heading), math.sin(heading)

    def placed(along, beside):
        return c * along - s * beside, s * along + c * beside

    start = placed(-half[0] - 0.005, off)
    finger = (
        f'<body name="finger" mocap="true" pos="{start[0]} {start[1]} {half[2]}">'
        '<geom name="tip" type="sphere" size="0.005" condim="1" priority="1"/></body>'
    )
    model = _model(solid + finger, friction, **contacts)
    data = mujoco.MjData(model)
    step = model.opt.timestep
    tip, floor = model.geom("tip").id, model.geom("floor").id
    before, turned, forces = heading, 0.0, []
    wrench = numpy.zeros(6)
    steps = round(seconds / step)
    for i in range(steps):
        way = speed * (i + 1) * step
        data.mocap_pos[0][:2] = placed(-half[0] - 0.005 + way, off)
        mujoco.mj_step(model, data)
        now = _yaw(data.qpos[3:7])
        turned += math.remainder(now - before, 2 * math.pi)
        before = now
        if i >= steps // 2:
            force = 0.0
            for k in range(data.ncon):
                contact = data.contact[k]
                if tip in (contact.geom1, contact.geom2) and floor not in (contact.geom1, contact.geom2):
                    mujoco.mj_contactForce(model, data, k, wrench)
                    # Along the way of the finger.
                    force += abs(wrench[0] * (contact.frame[0] * c + contact.frame[1] * s))
            forces.append(force)
    return abs(turned), statistics.fmean(forces)


def _thrown(geometry, height, mass, friction, speed, spin, heading):
    """Way (unit: meters) of a body that slides and spins, and when its spin has ended (unit: seconds)."""
    model = _model(_body(geometry, height, mass, friction, heading), friction)
    data = mujoco.MjData(model)
    for _ in range(2000):
        mujoco.mj_step(model, data)
    start = data.qpos[:2].copy()
    data.qvel[:] = [speed * math.cos(heading), speed * math.sin(heading), 0.0, 0.0, 0.0, spin]
    still, t = None, 0.0
    while t < 5.0:
        mujoco.mj_step(model, data)
        t += STEP
        if still is None and abs(data.qvel[5]) < 0.01 * spin:
            still = t
        if still is not None and math.hypot(data.qvel[0], data.qvel[1]) < 1e-3:
            break
    way = math.hypot(data.qpos[0] - start[0], data.qpos[1] - start[1])
    return way, still


def _free_rotation() -> float:
    """How far the momentum of a box that spins freely drifts in a minute (unit: percent)."""
    solid = '<body><freejoint/><geom type="box" size="0.02 0.04 0.06" mass="0.5"/></body>'
    model = _model(solid, None, 0.0)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    data = mujoco.MjData(model)
    data.qvel[3:] = [3.0, 4.0, 5.0]

    def momentum():
        mujoco.mj_subtreeVel(model, data)
        return data.subtree_angmom[1].copy()

    mujoco.mj_forward(model, data)
    start = momentum()
    for _ in range(round(60.0 / STEP)):
        mujoco.mj_step(model, data)
    return 100.0 * float(numpy.linalg.norm(momentum() - start) / numpy.linalg.norm(start))


def cases() -> dict[str, float]:
    cube = 'type="box" size="0.05 0.05 0.05"'
    headings = [_heading(i) for i in range(PLACINGS)]
    slow = {"step": SLOW_STEP, "settling": 0.02, "impratio": 100}
    pushes = [_pushed((0.1, 0.1, 0.1), 0.2, 1.0, 0.04, 0.01, 20.0, h, **slow) for h in headings[:SLOW_PLACINGS]]
    rods = [_pushed((0.02, 0.3, 0.02), 0.3, 0.4, 0.14, 0.1, 0.1, h) for h in headings]
    slides = [_thrown(cube, 0.05, 0.2, 0.4, 1.0, 20.0, h) for h in headings]
    discs = [_thrown('type="cylinder" size="0.05 0.01"', 0.01, 0.2, 0.4, 0.0, 20.0, h) for h in headings]
    squares = [_thrown('type="box" size="0.05 0.05 0.01"', 0.01, 0.2, 0.4, 0.0, 20.0, h) for h in headings]
    return {
        "push_off_center.turn": _middle(turn for turn, _ in pushes),
        "rod.force": _middle(force for _, force in rods),
        "slide_spin.way": _middle(way for way, _ in slides),
        "slide_spin.spin_time": _middle(time for _, time in slides),
        "disc.stop": _middle(time for _, time in discs),
        "square.stop": _middle(time for _, time in squares),
        "free_rotation.momentum_drift_60s": _free_rotation(),
    }


if __name__ == "__main__":
    json.dump(cases(), sys.stdout, indent=1)
