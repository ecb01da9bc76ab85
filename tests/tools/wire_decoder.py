"""Reads packets as docs/wire_format.md describes them; knows nothing of the C++ that writes them."""

import hashlib
import math
import struct
from collections.abc import Callable
from typing import Any

MOST_PACKET_BYTES = 1184
MOST_TIME = 2**60
MOST_AGE = 60 * 10**9
MOST_SEQUENCE = 2**48
MOST_POSITION = 1e5
MOST_SPEED = 1e3
MOST_ANGULAR_SPEED = 1e4
MOST_FORCE = 1e3
MOST_TORQUE = 1e3
TURN_SCALE = 2**30 * math.sqrt(2)
MOST_GRAVITY = 100.0
MOST_COMPONENT = 1e9
MOST_POSITIVE = 1e12
NOBODY = 0xFFFFFFFF
Fields = dict[str, Any]


class Refused(Exception):
    """The packet breaks a rule of the page."""


def _require(condition: bool, rule: str) -> None:
    if not condition:
        raise Refused(rule)


class Reader:
    def __init__(self, data: bytes):
        self.data = data
        self.at = 0

    def take(self, count: int) -> bytes:
        _require(len(self.data) - self.at >= count, "truncated")
        self.at += count
        return self.data[self.at - count : self.at]

    def end(self) -> None:
        _require(self.at == len(self.data), "oversized")

    def number(self, form: str) -> int:
        return struct.unpack("<" + form, self.take(struct.calcsize("<" + form)))[0]

    def u8(self) -> int:
        return self.number("B")

    def u16(self) -> int:
        return self.number("H")

    def u32(self) -> int:
        return self.number("I")

    def u64(self) -> int:
        return self.number("Q")

    def time(self) -> int:
        value = self.number("q")
        _require(-MOST_TIME <= value <= MOST_TIME, "time out of range")
        return value

    def varint(self, most: int = 2**64 - 1) -> int:
        value = 0
        for shift in range(0, 70, 7):
            byte = self.u8()
            value |= (byte & 0x7F) << shift
            _require(byte != 0 or shift == 0, "a byte that says nothing")
            if byte < 0x80:
                _require(value <= most, "number out of range")
                return value
        raise Refused("number out of range")

    def folded(self, most: int = 2**62) -> int:
        value = self.varint()
        value = value >> 1 if value % 2 == 0 else -(value >> 1) - 1
        _require(-most <= value <= most, "number out of range")
        return value

    def whole_vec3(self, quantum: int, most: float, expected: tuple[int, ...] = (0, 0, 0)) -> tuple[int, ...]:
        """In whole parts of a meter and so on, of which `quantum` make one."""
        value = tuple(self.folded() + part for part in expected)
        _require(max(abs(part) for part in value) <= most * quantum, "number out of range")
        return value

    def single_vec3(self, most: float) -> tuple[float, ...]:
        return tuple(self.real(-most, most, "f") for _ in range(3))

    def singles(self, count: int) -> tuple[float, ...]:
        return tuple(self.real(-1e6, 1e6, "f") for _ in range(count))

    def rotation(self, largest: int) -> tuple[float, ...]:
        parts = [0.0] * 4
        for i in range(4):
            if i != largest:
                number = self.number("i")
                _require(abs(number) <= 2**30 + 1, "no rotation")
                parts[i] = number / (2**30 * math.sqrt(2))
        rest = 1.0 - sum(part * part for part in parts)
        _require(rest >= 0.25 - 1e-6, "no rotation")
        parts[largest] = math.sqrt(rest)
        return tuple(parts)

    def skip_extensions(self) -> None:
        while self.at < len(self.data):
            _require(self.u8() != 0, "oversized")
            self.take(self.u8())

    def flag(self) -> bool:
        value = self.u8()
        _require(value <= 1, "flag out of range")
        return value == 1

    def choice(self, last: int) -> int:
        value = self.u8()
        _require(value <= last, "enumeration out of range")
        return value

    def real(self, least: float = -math.inf, most: float = math.inf, form: str = "d") -> float:
        value = struct.unpack("<" + form, self.take(struct.calcsize(form)))[0]
        _require(math.isfinite(value), "not finite")
        _require(least <= value <= most, "number out of range")
        return value

    def positive(self) -> float:
        value = self.real(0.0, MOST_POSITIVE)
        _require(value > 0.0, "number out of range")
        return value

    def not_negative(self) -> float:
        return self.real(0.0, MOST_POSITIVE)

    def vec3(self, most: float = MOST_COMPONENT) -> tuple[float, ...]:
        return tuple(self.real(-most, most) for _ in range(3))

    def positive_vec3(self) -> tuple[float, ...]:
        value = self.vec3()
        _require(min(value) > 0.0, "number out of range")
        return value

    def quat(self) -> tuple[float, ...]:
        value = tuple(self.real() for _ in range(4))
        _require(abs(math.hypot(*value) - 1.0) < 1e-3, "no rotation")
        return value

    def pose(self) -> Fields:
        return {"position": self.vec3(), "rotation": self.quat()}

    def object(self) -> int:
        value = self.u32()
        _require(value != NOBODY, "no object")
        return value

    def counted(self, one: Callable[[], Any], bytes_each: int, most: int) -> list[Any]:
        count = self.u32()
        _require(count <= most, "count out of range")
        _require(count * bytes_each <= len(self.data) - self.at, "truncated")
        return [one() for _ in range(count)]


def _hello(r: Reader) -> Fields:
    side, scenario, period = r.choice(1), r.u8(), r.time()
    _require(1 <= scenario <= 5 and 1 <= period <= 10**9, "hello out of range")
    hello = {
        "side": side, "scenario": scenario, "period": period, "heard_epoch": r.u64(), "object_count": r.u32(),
        "gravity": r.vec3(MOST_GRAVITY), "oldest_version": r.u8(), "newest_version": r.u8(),
        "heard_packets": r.varint(), "heard_sequence": r.varint(),
    }  # fmt: skip
    _require(hello["oldest_version"] <= hello["newest_version"], "versions out of range")
    return hello


def _bye(_: Reader) -> Fields:
    return {}


def _clock_request(r: Reader) -> Fields:
    return {"number": r.u32(), "t0": r.time()}


def _clock_answer(r: Reader) -> Fields:
    return {"number": r.u32(), "t0": r.time(), "t1": r.time(), "t2": r.time()}


def _piece(r: Reader) -> Fields:
    piece = {"object": r.object(), "revision": r.u32(), "hash": r.take(16), "total_bytes": r.u32(), "offset": r.u32()}
    total, offset = piece["total_bytes"], piece["offset"]
    _require(1 <= total <= 1 << 24 and offset < total and offset % 1024 == 0, "piece out of range")
    return piece | {"bytes": r.take(min(1024, total - offset))}


def _removal(r: Reader) -> Fields:
    return {"object": r.object(), "revision": r.u32(), "hash": r.take(16)}


def _acknowledgement(r: Reader) -> Fields:
    return {"object": r.object(), "hash": r.take(16), "verdict": r.choice(3)}


def _near(r: Reader, sent_at: int) -> int:
    return sent_at + r.folded(MOST_AGE)


def _scaled(whole: tuple[int, ...], quantum: int) -> tuple[float, ...]:
    return tuple(part / quantum for part in whole)


def _object(r: Reader) -> int:
    return r.varint(NOBODY - 1)


def _object_states(r: Reader, sent_at: int) -> Fields:
    states = {"true_at": _near(r, sent_at), "newest_operator_sample": r.varint(MOST_SEQUENCE)}
    count = r.u8()
    _require(count <= 16, "count out of range")
    return states | {"states": [_state(r) for _ in range(count)]}


def _state(r: Reader) -> Fields:
    number, flags = _object(r), r.u8()
    _require(flags < 16, "flags out of range")
    position = _scaled(r.whole_vec3(NANO, MOST_POSITION), NANO)
    pose = {"position": position, "rotation": r.rotation(flags >> 2)}
    state = {"object": number, "asleep": flags & 1 == 1, "pose": pose}
    moving = flags & 2 == 2
    still = (0.0, 0.0, 0.0)
    return state | {
        "linear_velocity": r.single_vec3(MOST_SPEED) if moving else still,
        "angular_velocity": r.single_vec3(MOST_ANGULAR_SPEED) if moving else still,
    }


NANO, MICRO, TENTH_MILLI = 10**9, 10**6, 10**4
CONNECTED, FOLLOWS, BUTTONS, FORCE, NEAREST, TIME, NEXT, TURN = (1 << bit for bit in range(8))
NOTHING = {key: (0, 0, 0) for key in ("position", "velocity", "force", "relative", "spin", "turn")} | {"largest": 3}


def _operator_samples(r: Reader, sent_at: int) -> Fields:
    period = r.varint(10**9)
    _require(period >= 1, "period out of range")
    count = r.u8()
    _require(1 <= count <= 16, "count out of range")
    samples: list[Fields] = []
    told: list[Fields] = []
    for _ in range(count):
        samples.append(_sample(r, sent_at, period, samples[-1] if samples else None, told))
    return {"period": period, "samples": samples}


def _towards_zero(a: int, b: int) -> int:
    return a // b if a >= 0 else -(-a // b)


def _carried_on(told: list[Fields], apart: int, key: str) -> tuple[int, ...]:
    last = told[-1][key]
    if told[-1]["apart"] != apart or (key == "turn" and told[-1]["largest"] != told[-2]["largest"]):
        return last
    return tuple(2 * now - then for now, then in zip(last, told[-2][key], strict=True))


def _sample(r: Reader, sent_at: int, period: int, before: Fields | None, told: list[Fields]) -> Fields:
    """One sample. `told`: those before it in whole numbers, and how far each is apart from the one before; this one joins them."""
    flags = r.u8()
    apart = 0
    if flags & FOLLOWS:
        if before is None:
            raise Refused("follows nothing")
        apart = 1 if flags & NEXT else r.varint(10**9 // period)
        pointer, sequence = before["pointer"], before["sequence"] - apart
        _require(apart >= (1 if flags & NEXT else 2) and sequence >= 1, "sequence out of range")
        _require(apart <= 10**9 // period, "sequence out of range")
        time = before["time"] - apart * period
    else:
        _require(flags & NEXT == 0, "follows nothing")
        pointer, sequence = r.varint(0xFFFF), r.varint(MOST_SEQUENCE)
        _require(sequence >= 1, "no sample")
        time = sent_at
    expected = {key: _carried_on(told, apart, key) if apart else (0, 0, 0) for key in NOTHING if key != "largest"}
    if flags & TIME:
        time += r.folded(MOST_AGE)
    now = NOTHING | {"apart": apart, "velocity": r.whole_vec3(MICRO, MOST_SPEED, expected["velocity"])}
    place = (0, 0, 0)
    if apart:
        sums = zip(told[-1]["position"], told[-1]["velocity"], now["velocity"], strict=True)
        place = tuple(at - _towards_zero((one + other) * apart * period, 2 * 10**6) for at, one, other in sums)
    now["position"] = r.whole_vec3(NANO, MOST_POSITION, place)
    buttons = r.varint(0xFFFFFFFF) if flags & BUTTONS else 0
    if flags & FORCE:
        now["force"] = r.whole_vec3(TENTH_MILLI, MOST_FORCE, expected["force"])
    nearest = NOBODY
    if flags & NEAREST:
        nearest = _object(r)
        now["relative"] = r.whole_vec3(NANO, MOST_POSITION, expected["relative"])
    turn: Fields = {}
    if flags & TURN:
        now["largest"] = r.choice(3)
        same = now["largest"] == (told[-1]["largest"] if apart else 3)
        now["turn"] = r.whole_vec3(1, 2**30 + 1, expected["turn"] if same else (0, 0, 0))
        now["spin"] = r.whole_vec3(MICRO, MOST_ANGULAR_SPEED, expected["spin"])
        turn = {"rotation": _turned(now["turn"], now["largest"]), "spin": _scaled(now["spin"], MICRO)}
    told.append(now)
    return turn | {
        "sequence": sequence, "time": time, "pointer": pointer, "connected": flags & CONNECTED != 0, "buttons": buttons,
        "position": _scaled(now["position"], NANO), "velocity": _scaled(now["velocity"], MICRO),
        "force": _scaled(now["force"], TENTH_MILLI),
        "nearest_object": nearest, "position_in_object": _scaled(now["relative"], NANO),
    }  # fmt: skip


def _turned(whole: tuple[int, ...], largest: int) -> tuple[float, ...]:
    parts = [part / TURN_SCALE for part in whole]
    rest = 1 - sum(part * part for part in parts)
    _require(rest >= 0.25 - 1e-6, "no rotation")
    parts.insert(largest, math.sqrt(rest))
    return tuple(parts)


def _forces(r: Reader, sent_at: int) -> Fields:
    count = r.u8()
    _require(1 <= count <= 16, "count out of range")
    return {"samples": [_force(r, sent_at) for _ in range(count)]}


def _force(r: Reader, sent_at: int) -> Fields:
    return {
        "pointer": r.varint(0xFFFF), "true_at": _near(r, sent_at), "newest_operator_sample": r.varint(MOST_SEQUENCE),
        "force": _scaled(r.whole_vec3(TENTH_MILLI, MOST_FORCE), TENTH_MILLI),
        "proxy": _scaled(r.whole_vec3(NANO, MOST_POSITION), NANO),
        "object": (r.varint(NOBODY) - 1) % 2**32,
    }  # fmt: skip


def _wrenches(r: Reader, sent_at: int) -> Fields:
    count = r.u8()
    _require(1 <= count <= 8, "count out of range")
    return {"samples": [_wrench(r, sent_at) for _ in range(count)]}


def _wrench(r: Reader, sent_at: int) -> Fields:
    wrench = {
        "pointer": r.varint(0xFFFF), "true_at": _near(r, sent_at), "newest_operator_sample": r.varint(MOST_SEQUENCE),
        "force": _scaled(r.whole_vec3(TENTH_MILLI, MOST_FORCE), TENTH_MILLI),
        "torque": _scaled(r.whole_vec3(MICRO, MOST_TORQUE), MICRO),
    }  # fmt: skip
    bits = r.choice(7)
    pose = {"position": _scaled(r.whole_vec3(NANO, MOST_POSITION), NANO), "rotation": r.rotation(bits & 3)}
    return wrench | {"tool": pose, "object": (r.varint(NOBODY) - 1) % 2**32, "fixed": bits > 3}


def _ghosts(r: Reader) -> Fields:
    count = r.u8()
    _require(1 <= count <= 16, "count out of range")
    return {"ghosts": [_ghost(r) for _ in range(count)]}


def _ghost(r: Reader) -> Fields:
    ghost = {"pointer": r.varint(0xFFFF), "touches": r.flag(), "position": _scaled(r.whole_vec3(NANO, MOST_POSITION), NANO)}
    return ghost | {"radius": r.varint(10**9) / MICRO}


def _estimates(r: Reader) -> Fields:
    count = r.u8()
    _require(1 <= count <= 8, "count out of range")
    return {"estimates": [_estimate(r) for _ in range(count)]}


def _estimate(r: Reader) -> Fields:
    estimate, flags = {"object": _object(r)}, r.u8()
    _require(flags < 16, "flags out of range")
    if flags & 1:
        estimate |= {"place": r.singles(6), "turn": r.singles(6)}
    for bit, name in ((2, "stiffness"), (4, "friction"), (8, "mass")):
        if flags & bit:
            estimate[name] = r.singles(2)
    return estimate


def _sample_acknowledgements(r: Reader) -> Fields:
    count = r.u8()
    _require(1 <= count <= 24, "count out of range")
    return {"samples": [{"pointer": r.varint(0xFFFF), "sequence": r.varint(MOST_SEQUENCE)} for _ in range(count)]}


def _terms(r: Reader) -> Fields:
    scenario, passivity = r.u8(), r.u8()
    _require(1 <= scenario <= 5, "terms out of range")
    waves = {"impedance": r.varint(10**12) / MICRO} if passivity == 1 else {}
    bodies, count = r.varint(NOBODY - 1), r.u8()
    _require(count <= 20, "count out of range")
    return {"scenario": scenario, "passivity": passivity} | waves | {"bodies": bodies, "hands": [_hand_terms(r) for _ in range(count)]}


def _hand_terms(r: Reader) -> Fields:
    kind = r.choice(2)
    if kind == 1:
        return {"kind": kind, "radius": r.varint(10**12) / NANO}
    return {"kind": kind, "shape": r.u64()} if kind == 2 else {"kind": kind}


KINDS = {
    1: ("hello", _hello),
    2: ("bye", _bye),
    3: ("clock request", _clock_request),
    4: ("clock answer", _clock_answer),
    5: ("piece of a description", _piece),
    6: ("removal", _removal),
    7: ("acknowledgement", _acknowledgement),
    8: ("object states", _object_states),
    9: ("operator samples", _operator_samples),
    10: ("forces", _forces),
    11: ("ghosts", _ghosts),
    12: ("estimates", _estimates),
    13: ("wrenches", _wrenches),
    14: ("sample acknowledgements", _sample_acknowledgements),
    15: ("terms", _terms),
}
TOLD_FROM_SENDING = (8, 9, 10, 13)


def packet(data: bytes) -> tuple[Fields, str, Fields]:
    """Header, name of the kind, body."""
    r = Reader(data)
    _require(r.take(2) == b"TC", "wrong magic")
    version = r.u8()
    _require(version in (3, 4), "wrong version")
    _require(len(data) <= MOST_PACKET_BYTES, "oversized")
    kind = r.u8()
    header = {"epoch": r.u64(), "sequence": r.varint(MOST_SEQUENCE), "sent_at": r.folded(MOST_TIME)}
    _require(header["epoch"] != 0 and header["sequence"] != 0, "header out of range")
    _require(kind in KINDS, "unknown kind")
    name, read = KINDS[kind]
    body = read(r, header["sent_at"]) if kind in TOLD_FROM_SENDING else read(r)
    r.skip_extensions()
    return header, name, body


def description(data: bytes) -> Fields:
    r = Reader(data)
    read = {"object": r.object(), "name": _name(r), "touch": _touch(r), "height_image": _image(r), "friction_image": _image(r)} | _body(r)
    _require(read["object"] < FIRST_JOINT, "the number of a joint")
    r.end()
    return read


FIRST_JOINT = 0x80000000
JOINTS = ("pin", "hinge", "slider", "six axes")


def joint(data: bytes) -> Fields:
    r = Reader(data)
    read = {"joint": r.object(), "first": r.object(), "second": r.u32()}
    bodies_are_bodies = read["first"] < FIRST_JOINT and not FIRST_JOINT <= read["second"] < NOBODY
    _require(read["joint"] >= FIRST_JOINT and bodies_are_bodies and read["first"] != read["second"], "no joint")
    read |= {"kind": JOINTS[r.choice(len(JOINTS) - 1)], "frame": r.pose(), "second_frame": r.pose()}
    for name, most in (("linear", MOST_COMPONENT), ("angular", math.pi)):
        read[name] = [(r.real(-most, most), r.real(-most, most)) for _ in range(3)]
    read |= {"motor_speed": r.real(-MOST_ANGULAR_SPEED, MOST_ANGULAR_SPEED)}
    read |= {"motor_torque": r.real(0.0, MOST_COMPONENT), "bodies_collide": r.flag()}
    r.end()
    return read


def content_hash(data: bytes) -> bytes:
    return hashlib.blake2b(data, digest_size=16).digest()


def _name(r: Reader) -> str:
    size = r.u16()
    _require(size <= 1024, "name too long")
    try:
        return r.take(size).decode("utf-8")
    except UnicodeDecodeError as error:
        raise Refused("no UTF-8") from error


def _touch(r: Reader) -> Fields:
    return {
        "stiffness": r.not_negative(), "damping": r.not_negative(),
        "static_friction": r.not_negative(), "dynamic_friction": r.not_negative(),
        "by_uv": r.flag(), "texture_size": r.positive(), "texture_depth": r.not_negative(),
        "magnet_force": r.not_negative(), "magnet_range": r.positive(), "viscosity": r.not_negative(),
        "stick_slip_stiffness": r.not_negative(), "stick_slip_force": r.not_negative(),
        "vibration_force": r.not_negative(), "vibration_frequency": r.not_negative(),
        "pop_through_force": r.not_negative(), "impact_strength": r.not_negative(),
        "impact_frequency": r.not_negative(), "impact_decay": r.positive(),
        "stribeck_speed": r.not_negative(), "stiffening": r.positive(), "stiffening_depth": r.positive(),
    }  # fmt: skip


def _heights(r: Reader, least_side: int, least: float, most: float) -> Fields:
    columns, rows = r.u32(), r.u32()
    return {"columns": columns, "rows": rows} | _grid(r, columns, rows, least_side, least, most)


def _grid(r: Reader, columns: int, rows: int, least_side: int, least: float, most: float) -> Fields:
    _require(min(columns, rows) >= least_side, "grid out of range")
    _require(columns * rows * 4 <= len(r.data) - r.at, "truncated")
    return {"heights": [r.real(least, most, "f") for _ in range(columns * rows)]}


def _image(r: Reader) -> Fields | None:
    return _heights(r, 1, 0.0, 1.0) if r.flag() else None


def _body(r: Reader) -> Fields:
    body: Fields = {"motion": r.choice(2), "may_move": r.flag()}
    body |= {"pose": {"position": r.vec3(MOST_POSITION), "rotation": r.quat()}}
    body |= {"linear_velocity": r.vec3(MOST_SPEED), "angular_velocity": r.vec3(MOST_ANGULAR_SPEED)}
    body |= {"mass": r.not_negative()}
    _require(body["mass"] > 0.0 or body["motion"] == 0, "no mass")
    body |= {
        "center_of_mass": r.vec3() if r.flag() else None,
        "inertia": r.positive_vec3() if r.flag() else None,
        "friction": r.not_negative(), "restitution": r.real(0.0, 1.0), "rough": r.flag(), "absorbent": r.flag(),
        "linear_damping": r.not_negative(), "angular_damping": r.not_negative(),
        "gravity_scale": r.real(-MOST_POSITIVE, MOST_POSITIVE), "layer": r.u32(), "mask": r.u32(),
        "continuous": r.flag(), "can_sleep": r.flag(),
        "lock_linear": [r.flag() for _ in range(3)], "lock_angular": [r.flag() for _ in range(3)],
    }  # fmt: skip
    body |= {"shapes": r.counted(lambda: _shape(r), 57, 4096), "touch_shapes": r.counted(lambda: _shape(r), 57, 4096)}
    _require(len(body["shapes"]) >= 1, "no shape")
    return body


def _mesh(r: Reader) -> Fields:
    corners = r.counted(r.vec3, 24, 1 << 24)
    triangles = r.counted(lambda: (r.u32(), r.u32(), r.u32()), 12, 1 << 24)
    _require(all(index < len(corners) for triangle in triangles for index in triangle), "index out of range")
    return {"corners": corners, "triangles": triangles}


def _half_space(r: Reader) -> Fields:
    normal = r.vec3()
    _require(abs(math.hypot(*normal) - 1.0) < 1e-3, "no direction")
    return {"normal": normal, "offset": r.real(-MOST_COMPONENT, MOST_COMPONENT)}


def _height_field(r: Reader) -> Fields:
    columns, rows = r.u32(), r.u32()
    field = {"columns": columns, "rows": rows, "scale": r.vec3()}
    return field | _grid(r, columns, rows, 2, -MOST_COMPONENT, MOST_COMPONENT)


SHAPES: list[tuple[str, Callable[[Reader], Fields]]] = [
    ("sphere", lambda r: {"radius": r.positive()}),
    ("box", lambda r: {"half_extents": r.positive_vec3()}),
    ("capsule", lambda r: {"radius": r.positive(), "half_segment": r.not_negative()}),
    ("cylinder", lambda r: {"radius": r.positive(), "half_height": r.positive()}),
    ("half-space", _half_space),
    ("convex hull", _mesh),
    ("mesh", lambda r: {"smooth_below": r.real(0.0, 3.2), "one_sided": r.flag()} | _mesh(r)),
    ("height field", _height_field),
]


def _shape(r: Reader) -> Fields:
    name, read = SHAPES[r.choice(len(SHAPES) - 1)]
    return {"kind": name, "pose": r.pose()} | read(r)


# --- sealed packets: X25519 (RFC 7748), BLAKE2b, ChaCha20-Poly1305 (RFC 8439)


def greeting(data: bytes) -> Fields:
    _require(len(data) == 68, "truncated")
    _require(data[:4] == b"TS\x02\x00", "no greeting")
    sender, receiver = struct.unpack("<QQ", data[4:20])
    return {"sender": sender, "receiver": receiver, "salt": data[20:36], "public_key": data[36:]}


def _hash(data: bytes, key: bytes = b"", size: int = 32) -> bytes:
    return hashlib.blake2b(data, digest_size=size, key=key).digest()


def session_keys(secret: bytes, private_key: bytes, own: Fields, far: Fields) -> Fields:
    """Number of the session, keys to receive and to send with. `secret`: 32 bytes; `own`, `far`: greetings."""
    first, second = sorted((own, far), key=lambda side: (side["public_key"], side["sender"]))
    both = b"".join(struct.pack("<Q", side["sender"]) + side["salt"] for side in (first, second))
    shared = _x25519(private_key, far["public_key"])
    _require(any(shared), "no public key")
    pair = _hash(shared + first["public_key"] + second["public_key"], size=64)
    stretched = _hash(both, key=secret)
    to_first, to_second = (_hash(half, key=stretched) for half in (pair[:32], pair[32:]))
    receive, send = (to_first, to_second) if first is own else (to_second, to_first)
    return {"id": struct.unpack("<I", _hash(both)[:4])[0], "receive": receive, "send": send}


def unseal(key: bytes, data: bytes) -> tuple[Fields, bytes]:
    """Front and the packet inside."""
    _require(len(data) >= 32, "truncated")
    _require(data[:4] == b"TS\x02\x01", "not sealed")
    session, counter = struct.unpack("<IQ", data[4:16])
    iv, sealed, tag = bytes(4) + data[8:16], data[16:-16], data[-16:]
    one_time = _chacha20_block(key, 0, iv)[:32]
    mac_data = data[:16] + _padded(sealed) + struct.pack("<QQ", 16, len(sealed))
    _require(_poly1305(one_time, mac_data) == tag, "wrong key")
    stream = b"".join(_chacha20_block(key, 1 + i, iv) for i in range((len(sealed) + 63) // 64))
    return {"session": session, "counter": counter}, bytes(a ^ b for a, b in zip(sealed, stream, strict=False))


def _x25519(private_key: bytes, public_key: bytes) -> bytes:
    prime, a24 = 2**255 - 19, 121665
    scalar = (int.from_bytes(private_key, "little") & ~7 & (2**255 - 1)) | 2**254
    x1 = int.from_bytes(public_key, "little") & (2**255 - 1)
    x2, z2, x3, z3 = 1, 0, x1, 1
    for bit in reversed(range(255)):
        swap = scalar >> bit & 1
        if swap:
            x2, z2, x3, z3 = x3, z3, x2, z2
        a, b, c, d = x2 + z2, x2 - z2, x3 + z3, x3 - z3
        aa, bb, da, cb = a * a, b * b, d * a, c * b
        x3, z3 = (da + cb) ** 2 % prime, x1 * (da - cb) ** 2 % prime
        x2, z2 = aa * bb % prime, (aa - bb) * (aa + a24 * (aa - bb)) % prime
        if swap:
            x2, z2, x3, z3 = x3, z3, x2, z2
    return (x2 * pow(z2, prime - 2, prime) % prime).to_bytes(32, "little")


def _padded(data: bytes) -> bytes:
    return data + bytes(-len(data) % 16)


def _quarter(x: list[int], a: int, b: int, c: int, d: int) -> None:
    for first, second, third, turn in ((a, b, d, 16), (c, d, b, 12), (a, b, d, 8), (c, d, b, 7)):
        x[first] = (x[first] + x[second]) & 0xFFFFFFFF
        mixed = x[third] ^ x[first]
        x[third] = ((mixed << turn) | (mixed >> (32 - turn))) & 0xFFFFFFFF


def _twenty_rounds(state: list[int]) -> list[int]:
    x = list(state)
    for _ in range(10):
        for i in range(4):
            _quarter(x, i, 4 + i, 8 + i, 12 + i)
        for i in range(4):
            _quarter(x, i, 4 + (i + 1) % 4, 8 + (i + 2) % 4, 12 + (i + 3) % 4)
    return x


def _state_words(key: bytes, last: bytes) -> list[int]:
    return list(struct.unpack("<16I", b"expand 32-byte k" + key + last))


def _chacha20_block(key: bytes, counter: int, iv: bytes) -> bytes:
    state = _state_words(key, struct.pack("<I", counter) + iv)
    mixed = _twenty_rounds(state)
    return struct.pack("<16I", *((a + b) & 0xFFFFFFFF for a, b in zip(state, mixed, strict=True)))


def _poly1305(key: bytes, data: bytes) -> bytes:
    r = int.from_bytes(key[:16], "little") & 0x0FFFFFFC0FFFFFFC0FFFFFFC0FFFFFFF
    total = 0
    for begin in range(0, len(data), 16):
        total = (total + int.from_bytes(data[begin : begin + 16] + b"\x01", "little")) * r % (2**130 - 5)
    return ((total + int.from_bytes(key[16:], "little")) & (2**128 - 1)).to_bytes(16, "little")
