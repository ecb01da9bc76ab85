"""Reads packets as docs/wire_format.md describes them; knows nothing of the C++ that writes them."""

import hashlib
import math
import struct
from collections.abc import Callable
from typing import Any

MOST_PACKET_BYTES = 1184
MOST_TIME = 2**60
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

    def vec3(self) -> tuple[float, ...]:
        return tuple(self.real(-MOST_COMPONENT, MOST_COMPONENT) for _ in range(3))

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
    return {
        "side": side, "scenario": scenario, "period": period, "heard_epoch": r.u64(), "object_count": r.u32(),
        "gravity": r.vec3(),
    }  # fmt: skip


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


def _object_states(r: Reader) -> Fields:
    states = {"true_at": r.time(), "newest_operator_sample": r.u64()}
    count = r.u16()
    _require(count <= 10, "count out of range")
    return states | {"states": [_state(r) for _ in range(count)]}


def _state(r: Reader) -> Fields:
    return {
        "object": r.object(), "asleep": r.flag(), "pose": r.pose(),
        "linear_velocity": r.vec3(), "angular_velocity": r.vec3(),
    }  # fmt: skip


def _operator_samples(r: Reader) -> Fields:
    count = r.u16()
    _require(1 <= count <= 9, "count out of range")
    return {"samples": [_sample(r) for _ in range(count)]}


def _sample(r: Reader) -> Fields:
    sequence = r.u64()
    _require(sequence != 0, "no sample")
    return {
        "sequence": sequence, "time": r.time(), "pointer": r.u16(), "connected": r.flag(), "buttons": r.u32(),
        "position": r.vec3(), "velocity": r.vec3(), "force": r.vec3(),
        "nearest_object": r.u32(), "position_in_object": r.vec3(),
    }  # fmt: skip


def _force(r: Reader) -> Fields:
    return {
        "pointer": r.u16(), "true_at": r.time(), "newest_operator_sample": r.u64(),
        "force": r.vec3(), "proxy": r.vec3(), "object": r.u32(),
    }  # fmt: skip


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
    10: ("force", _force),
}


def packet(data: bytes) -> tuple[Fields, str, Fields]:
    """Header, name of the kind, body."""
    r = Reader(data)
    _require(r.take(2) == b"TC", "wrong magic")
    _require(r.u8() == 1, "wrong version")
    _require(len(data) <= MOST_PACKET_BYTES, "oversized")
    kind, body_bytes, reserved = r.u8(), r.u16(), r.u16()
    header = {"epoch": r.u64(), "sequence": r.u64(), "sent_at": r.time()}
    _require(header["epoch"] != 0 and header["sequence"] != 0, "header out of range")
    _require(len(data) - 32 >= body_bytes, "truncated")
    _require(len(data) - 32 == body_bytes, "oversized")
    _require(reserved == 0, "reserved bytes")
    _require(kind in KINDS, "unknown kind")
    name, read = KINDS[kind]
    body = read(r)
    r.end()
    return header, name, body


def description(data: bytes) -> Fields:
    r = Reader(data)
    read = {"object": r.object(), "name": _name(r), "touch": _touch(r), "texture": _texture(r)} | _body(r)
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
        "texture_size": r.positive(), "texture_depth": r.not_negative(),
        "magnet_force": r.not_negative(), "magnet_range": r.positive(), "viscosity": r.not_negative(),
        "stick_slip_stiffness": r.not_negative(), "stick_slip_force": r.not_negative(),
        "vibration_force": r.not_negative(), "vibration_frequency": r.not_negative(),
        "pop_through_force": r.not_negative(),
    }  # fmt: skip


def _heights(r: Reader, least_side: int, least: float, most: float) -> Fields:
    columns, rows = r.u32(), r.u32()
    return {"columns": columns, "rows": rows} | _grid(r, columns, rows, least_side, least, most)


def _grid(r: Reader, columns: int, rows: int, least_side: int, least: float, most: float) -> Fields:
    _require(min(columns, rows) >= least_side, "grid out of range")
    _require(columns * rows * 4 <= len(r.data) - r.at, "truncated")
    return {"heights": [r.real(least, most, "f") for _ in range(columns * rows)]}


def _texture(r: Reader) -> Fields | None:
    return _heights(r, 1, 0.0, 1.0) if r.flag() else None


def _body(r: Reader) -> Fields:
    body: Fields = {"motion": r.choice(2), "may_move": r.flag(), "pose": r.pose()}
    body |= {"linear_velocity": r.vec3(), "angular_velocity": r.vec3(), "mass": r.not_negative()}
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
    ("mesh", lambda r: {"smooth_below": r.real(0.0, 3.2)} | _mesh(r)),
    ("height field", _height_field),
]


def _shape(r: Reader) -> Fields:
    name, read = SHAPES[r.choice(len(SHAPES) - 1)]
    return {"kind": name, "pose": r.pose()} | read(r)


# --- sealed packets: XChaCha20-Poly1305 in the words of RFC 8439 and of the draft on XChaCha


def unseal(key: bytes, data: bytes) -> tuple[Fields, bytes]:
    """Front and the packet inside."""
    _require(len(data) >= 44, "truncated")
    _require(data[:2] == b"TS" and data[2] == 1 and data[3] == 0, "not sealed")
    nonce, sealed, tag = data[4:28], data[28:-16], data[-16:]
    subkey = _hchacha20(key, nonce[:16])
    iv = bytes(4) + nonce[16:]
    one_time = _chacha20_block(subkey, 0, iv)[:32]
    mac_data = _padded(data[:4]) + _padded(sealed) + struct.pack("<QQ", 4, len(sealed))
    _require(_poly1305(one_time, mac_data) == tag, "wrong key")
    stream = b"".join(_chacha20_block(subkey, 1 + i, iv) for i in range((len(sealed) + 63) // 64))
    sender, receiver, counter = struct.unpack("<QQQ", nonce)
    front = {"sender": sender, "receiver": receiver, "counter": counter}
    return front, bytes(a ^ b for a, b in zip(sealed, stream, strict=False))


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


def _hchacha20(key: bytes, nonce: bytes) -> bytes:
    x = _twenty_rounds(_state_words(key, nonce))
    return struct.pack("<8I", *x[:4], *x[12:])


def _poly1305(key: bytes, data: bytes) -> bytes:
    r = int.from_bytes(key[:16], "little") & 0x0FFFFFFC0FFFFFFC0FFFFFFC0FFFFFFF
    total = 0
    for begin in range(0, len(data), 16):
        total = (total + int.from_bytes(data[begin : begin + 16] + b"\x01", "little")) * r % (2**130 - 5)
    return ((total + int.from_bytes(key[16:], "little")) & (2**128 - 1)).to_bytes(16, "little")
