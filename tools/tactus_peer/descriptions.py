"""What a teleoperator tells of its bodies once: the description of an object and of a joint, read and written by one list of fields.

body() fills in what an ordinary body has.
"""

import hashlib
import math
from typing import Any

from .stream import (
    MOST_ANGULAR_SPEED, MOST_POSITION, MOST_SPEED, NO_OBJECT, Fields, Reader, Refused, Writer, field, inner, require, was_given,
)  # fmt: skip

FIRST_JOINT = 0x80000000
STATIC, KINEMATIC, DYNAMIC = range(3)
JOINTS = ("pin", "hinge", "slider", "six axes")

_MOST_COMPONENT = 1e9
_MOST_SHAPES = 4096
_LEAST_SHAPE_BYTES = 57
_ZERO = (0.0, 0.0, 0.0)
_UNTURNED = (0.0, 0.0, 0.0, 1.0)
_HERE = {"position": _ZERO, "rotation": _UNTURNED}
# Of an ordinary surface, as HapticMaterial has it but for stiffness, damping and friction.
_SURFACE = {
    "by_uv": False, "texture_size": 0.05, "texture_depth": 0.0, "magnet_force": 0.0, "magnet_range": 0.01, "viscosity": 0.0,
    "stick_slip_stiffness": 0.0, "stick_slip_force": 0.0, "vibration_force": 0.0, "vibration_frequency": 0.0,
    "pop_through_force": 0.0, "impact_strength": 0.0, "impact_frequency": 200.0, "impact_decay": 0.02, "stribeck_speed": 0.0,
    "stiffening": 1.0, "stiffening_depth": 0.005,
}  # fmt: skip

Stream = Reader | Writer


def sphere(radius: float) -> Fields:
    return {"kind": "sphere", "pose": _HERE, "radius": radius}


def box(half_extents: tuple[float, float, float]) -> Fields:
    return {"kind": "box", "pose": _HERE, "half_extents": half_extents}


def body(number: int, name: str, shapes: list[Fields], stiffness: float, mass: float = 0.0, **other: Any) -> Fields:
    """The description of a body: static where `mass` is 0 (unit: kilograms). `stiffness`: of touch (unit: newtons per meter).
    `other`: any further property of the page; of touch in `touch`, a dictionary.
    """
    touch = {"stiffness": stiffness, "damping": 0.5, "static_friction": 0.3, "dynamic_friction": 0.2} | _SURFACE
    return {
        "object": number, "name": name, "touch": touch | other.pop("touch", {}), "height_image": None, "friction_image": None,
        "motion": DYNAMIC if mass > 0.0 else STATIC, "may_move": False, "pose": _HERE, "linear_velocity": _ZERO,
        "angular_velocity": _ZERO, "mass": mass, "center_of_mass": None, "inertia": None, "friction": 0.5, "restitution": 0.0,
        "rough": False, "absorbent": False, "linear_damping": 0.0, "angular_damping": 0.0, "gravity_scale": 1.0, "layer": 1,
        "mask": 1, "continuous": False, "can_sleep": True, "lock_linear": [False] * 3, "lock_angular": [False] * 3,
        "shapes": shapes, "touch_shapes": [],
    } | other  # fmt: skip


def encode_description(description: Fields) -> bytes:
    return _encode(_description, description)


def decode_description(data: bytes) -> Fields:
    return _decode(_description, data)


def encode_joint(joint: Fields) -> bytes:
    return _encode(_joint, joint)


def decode_joint(data: bytes) -> Fields:
    return _decode(_joint, data)


def content_hash(data: bytes) -> bytes:
    return hashlib.blake2b(data, digest_size=16).digest()


def _encode(fields, message: Fields) -> bytes:
    s = Writer()
    fields(s, was_given(message))
    return bytes(s.data)


def _decode(fields, data: bytes) -> Fields:
    s = Reader(data)
    message: Fields = {}
    fields(s, message)
    require(s.left == 0, "oversized")
    return message


def _description(s: Stream, m: Fields) -> None:
    field(m, "object", s.u32, FIRST_JOINT - 1)
    field(m, "name", _name_of(s), blank="")
    _touch(s, inner(s, m, "touch"))
    for image in ("height_image", "friction_image"):
        _optional(s, m, image, lambda value: _grid_of(s, value or {}, 1, 0.0, 1.0))
    _body(s, m)


def _name_of(s: Stream):
    def name(text: str) -> str:
        data = text.encode()
        size = s.integer(len(data), "H", 0, 1024)
        try:
            return s.octets(data, size).decode()
        except UnicodeDecodeError as error:
            raise Refused("no UTF-8") from error

    return name


def _touch(s: Stream, m: Fields) -> None:
    positive = ("texture_size", "magnet_range", "impact_decay", "stiffening", "stiffening_depth")
    for key in ("stiffness", "damping", "static_friction", "dynamic_friction", *_SURFACE):
        field(m, key, s.flag if key == "by_uv" else s.positive if key in positive else s.not_negative)


def _optional(s: Stream, m: Fields, key: str, one) -> None:
    """A flag, and what it announces; None: it is absent."""
    given = m[key] if s.writes else None
    m[key] = one(given) if s.flag(given is not None) else None


def _grid_of(s: Stream, m: Fields, least_side: int, least: float, most: float, scaled: bool = False) -> Fields:
    """Numbers row by row; those of a height field have a scale."""
    read = {"columns": s.u32(m.get("columns", 0)), "rows": s.u32(m.get("rows", 0))}
    if scaled:
        read["scale"] = s.reals(m.get("scale", _ZERO), _MOST_COMPONENT)
    count = read["columns"] * read["rows"]
    require(min(read["columns"], read["rows"]) >= least_side, "grid out of range")
    heights = _room(s, m.get("heights", []), count, 4)
    return read | {"heights": [s.real(value, least, most, "f") for value in heights]}


def _room(s: Stream, values: list, count: int, bytes_each: int) -> list:
    """As many values as are written or read; a reader looks whether there can be so many first."""
    if s.writes:
        require(len(values) == count, f"{len(values)} values for {count}")
        return values
    require(count * bytes_each <= s.left, "truncated")
    return [0] * count


def _counted(s: Stream, values: list, one, bytes_each: int, most: int = 1 << 24) -> list:
    count = s.u32(len(values), most)
    return [one(value) for value in _room(s, values, count, bytes_each)]


def _pose(s: Stream, m: Fields, key: str, most: float = _MOST_COMPONENT) -> None:
    pose = inner(s, m, key)
    field(pose, "position", s.reals, most, blank=_ZERO)
    field(pose, "rotation", s.quat, blank=_UNTURNED)


def _positive_vector(s: Stream, value: tuple[float, ...]) -> tuple[float, ...]:
    value = s.reals(value, _MOST_COMPONENT)
    require(min(value) > 0.0, "number out of range")
    return value


def _flags(m: Fields, s: Stream, *keys: str) -> None:
    for key in keys:
        field(m, key, s.flag)


def _body(s: Stream, m: Fields) -> None:
    field(m, "motion", s.u8, 2)
    _flags(m, s, "may_move")
    _pose(s, m, "pose", MOST_POSITION)
    field(m, "linear_velocity", s.reals, MOST_SPEED, blank=_ZERO)
    field(m, "angular_velocity", s.reals, MOST_ANGULAR_SPEED, blank=_ZERO)
    field(m, "mass", s.not_negative)
    require(m["mass"] > 0.0 or m["motion"] == STATIC, "no mass")
    _optional(s, m, "center_of_mass", lambda value: s.reals(value or _ZERO, _MOST_COMPONENT))
    _optional(s, m, "inertia", lambda value: _positive_vector(s, value or _ZERO))
    field(m, "friction", s.not_negative)
    field(m, "restitution", s.real, 0.0, 1.0)
    _flags(m, s, "rough", "absorbent")
    field(m, "linear_damping", s.not_negative)
    field(m, "angular_damping", s.not_negative)
    field(m, "gravity_scale", s.real, -1e12, 1e12)
    field(m, "layer", s.u32)
    field(m, "mask", s.u32)
    _flags(m, s, "continuous", "can_sleep")
    for key in ("lock_linear", "lock_angular"):
        m[key] = [s.flag(value) for value in (m[key] if s.writes else [0] * 3)]
    for key in ("shapes", "touch_shapes"):
        given = m[key] if s.writes else []
        m[key] = _counted(s, given, lambda shape: _shape(s, shape), _LEAST_SHAPE_BYTES, _MOST_SHAPES)
    require(len(m["shapes"]) >= 1, "no shape")


def _shape(s: Stream, given: Fields) -> Fields:
    m: Fields = was_given(given) if s.writes else {}
    names = list(_SHAPES)
    kind = s.u8(names.index(m["kind"]) if s.writes else 0, len(names) - 1)
    m["kind"] = names[kind]
    _pose(s, m, "pose")
    _SHAPES[names[kind]](s, m)
    return m


def _sphere(s: Stream, m: Fields) -> None:
    field(m, "radius", s.positive)


def _box(s: Stream, m: Fields) -> None:
    field(m, "half_extents", lambda value: _positive_vector(s, value), blank=_ZERO)


def _capsule(s: Stream, m: Fields) -> None:
    field(m, "radius", s.positive)
    field(m, "half_segment", s.not_negative)


def _cylinder(s: Stream, m: Fields) -> None:
    field(m, "radius", s.positive)
    field(m, "half_height", s.positive)


def _half_space(s: Stream, m: Fields) -> None:
    field(m, "normal", s.reals, _MOST_COMPONENT, blank=_ZERO)
    require(abs(math.hypot(*m["normal"]) - 1.0) < 1e-3, "no direction")
    field(m, "offset", s.real, -_MOST_COMPONENT, _MOST_COMPONENT)


def _hull(s: Stream, m: Fields) -> None:
    corners, triangles = (m["corners"], m["triangles"]) if s.writes else ([], [])
    m["corners"] = _counted(s, corners, lambda corner: s.reals(corner or _ZERO, _MOST_COMPONENT), 24)
    most = len(m["corners"]) - 1
    m["triangles"] = _counted(s, triangles, lambda three: tuple(s.u32(index) for index in three or (0, 0, 0)), 12)
    require(all(index <= most for three in m["triangles"] for index in three), "index out of range")


def _mesh(s: Stream, m: Fields) -> None:
    field(m, "smooth_below", s.real, 0.0, 3.2)
    field(m, "one_sided", s.flag)
    _hull(s, m)


def _height_field(s: Stream, m: Fields) -> None:
    m |= _grid_of(s, m, 2, -_MOST_COMPONENT, _MOST_COMPONENT, scaled=True)


_SHAPES = {
    "sphere": _sphere, "box": _box, "capsule": _capsule, "cylinder": _cylinder, "half-space": _half_space,
    "convex hull": _hull, "mesh": _mesh, "height field": _height_field,
}  # fmt: skip


def _joint(s: Stream, m: Fields) -> None:
    field(m, "joint", s.u32, NO_OBJECT - 1)
    field(m, "first", s.u32, FIRST_JOINT - 1)
    field(m, "second", s.u32)
    is_body = m["second"] < FIRST_JOINT or m["second"] == NO_OBJECT
    require(m["joint"] >= FIRST_JOINT and is_body and m["first"] != m["second"], "no joint")
    m["kind"] = JOINTS[s.u8(JOINTS.index(m["kind"]) if s.writes else 0, len(JOINTS) - 1)]
    _pose(s, m, "frame")
    _pose(s, m, "second_frame")
    for key, most in (("linear", _MOST_COMPONENT), ("angular", math.pi)):
        m[key] = [s.reals(ends, most) for ends in (m[key] if s.writes else [(0.0, 0.0)] * 3)]
    field(m, "motor_speed", s.real, -MOST_ANGULAR_SPEED, MOST_ANGULAR_SPEED)
    field(m, "motor_torque", s.real, 0.0, _MOST_COMPONENT)
    _flags(m, s, "bodies_collide")
