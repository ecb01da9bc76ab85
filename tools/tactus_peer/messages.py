"""The messages of docs/wire_format.md: one list of fields for each kind, read and written by the same function.

A message is a dictionary with the names of the page. Lengths are in meters, forces in newtons, times in nanoseconds;
vectors are tuples, rotations x, y, z, w. NO_OBJECT stands for no object.
"""

import math
from collections.abc import Callable
from typing import Any

from .samples import operator_samples
from .stream import (
    MICRO, MOST_AGE, MOST_ANGULAR_SPEED, MOST_FORCE, MOST_POSITION, MOST_SEQUENCE, MOST_SPEED, MOST_TIME, MOST_TORQUE,
    NANO, NO_OBJECT, TENTH_MILLI, Fields, Reader, Refused, Writer, field, inner, items, largest_part, require, was_given,
)  # fmt: skip

MOST_PACKET_BYTES = 1184
MOST_PIECE_BYTES = 1024
MOST_DESCRIPTION_BYTES = 1 << 24
MOST_GRAVITY = 100.0  # of each component (unit: meters per second squared)
OLDEST_VERSION, NEWEST_VERSION = 3, 4
OPERATOR, TELEOPERATOR = 0, 1
# Verdicts of an acknowledgement.
KNOWN, REFUSED, NO_ROOM, REMOVED = range(4)
# Kinds of hands in the terms.
NO_HAND, PROXY, TOOL = range(3)
NO_PASSIVITY, WAVE_VARIABLES, TIME_DOMAIN, TWO_LAYERS = range(4)
ZERO = (0.0, 0.0, 0.0)
UNTURNED = (0.0, 0.0, 0.0, 1.0)

_MOST_ESTIMATE = 1e6
_TAKEN_TAG = 1  # the extension of forces
_TAKEN_QUANTA = 10**7  # that make one joule

Stream = Reader | Writer


def _hello(s: Stream, m: Fields, _: int) -> None:
    field(m, "side", s.u8, 1)
    field(m, "scenario", s.u8, 5, 1)
    field(m, "period", s.integer, "q", 1, 10**9)
    field(m, "heard_epoch", s.u64)
    field(m, "object_count", s.u32)
    field(m, "gravity", s.reals, MOST_GRAVITY, blank=ZERO)
    field(m, "oldest_version", s.u8)
    field(m, "newest_version", s.u8)
    require(m["oldest_version"] <= m["newest_version"], "versions out of range")
    field(m, "heard_packets", s.varint)
    field(m, "heard_sequence", s.varint)


def _bye(_: Stream, __: Fields, ___: int) -> None:
    pass


def _clock_request(s: Stream, m: Fields, _: int) -> None:
    field(m, "number", s.u32)
    field(m, "t0", s.time)


def _clock_answer(s: Stream, m: Fields, sent_at: int) -> None:
    _clock_request(s, m, sent_at)
    field(m, "t1", s.time)
    field(m, "t2", s.time)


def _described(s: Stream, m: Fields) -> None:
    field(m, "object", s.u32, NO_OBJECT - 1)
    field(m, "revision", s.u32)
    field(m, "hash", s.octets, 16, blank=b"")


def _piece(s: Stream, m: Fields, _: int) -> None:
    _described(s, m)
    field(m, "total_bytes", s.u32, MOST_DESCRIPTION_BYTES)
    field(m, "offset", s.u32)
    total, offset = m["total_bytes"], m["offset"]
    require(offset < total and offset % MOST_PIECE_BYTES == 0, "piece out of range")
    field(m, "bytes", s.octets, min(MOST_PIECE_BYTES, total - offset), blank=b"")


def _removal(s: Stream, m: Fields, _: int) -> None:
    _described(s, m)


def _acknowledgement(s: Stream, m: Fields, _: int) -> None:
    field(m, "object", s.u32, NO_OBJECT - 1)
    field(m, "hash", s.octets, 16, blank=b"")
    field(m, "verdict", s.u8, 3)


def _age(s: Stream, m: Fields, key: str, sent_at: int) -> None:
    field(m, key, lambda value: s.folded(value - sent_at, MOST_AGE) + sent_at)


def _object_states(s: Stream, m: Fields, sent_at: int) -> None:
    _age(s, m, "true_at", sent_at)
    field(m, "newest_operator_sample", s.varint, MOST_SEQUENCE)
    items(s, m, "states", 0, 16, _state)


def _state(s: Stream, m: Fields) -> None:
    field(m, "object", s.object)
    pose = inner(s, m, "pose")
    velocities = ("linear_velocity", "angular_velocity")
    moves = any(any(m.get(key, ZERO)) for key in velocities)
    largest = largest_part(pose.get("rotation", UNTURNED))
    bits = s.u8(int(m.get("asleep", False)) | int(moves) << 1 | largest << 2, 15)
    field(pose, "position", s.quanta, NANO, MOST_POSITION, blank=ZERO)
    field(pose, "rotation", s.rotation, bits >> 2, blank=UNTURNED)
    m["asleep"] = bits & 1 == 1
    for key, most in zip(velocities, (MOST_SPEED, MOST_ANGULAR_SPEED), strict=True):
        m[key] = s.reals(m.get(key, ZERO), most, "f") if bits & 2 else ZERO


def _felt(s: Stream, m: Fields, sent_at: int) -> None:
    field(m, "pointer", s.varint, 0xFFFF)
    _age(s, m, "true_at", sent_at)
    field(m, "newest_operator_sample", s.varint, MOST_SEQUENCE)
    field(m, "force", s.quanta, TENTH_MILLI, MOST_FORCE, blank=ZERO)


def _forces(s: Stream, m: Fields, sent_at: int) -> None:
    items(s, m, "samples", 1, 16, lambda s, one: _force(s, one, sent_at))


def _force(s: Stream, m: Fields, sent_at: int) -> None:
    _felt(s, m, sent_at)
    field(m, "proxy", s.quanta, NANO, MOST_POSITION, blank=ZERO)
    field(m, "object", s.touched, blank=NO_OBJECT)


def _wrenches(s: Stream, m: Fields, sent_at: int) -> None:
    items(s, m, "samples", 1, 8, lambda s, one: _wrench(s, one, sent_at))


def _wrench(s: Stream, m: Fields, sent_at: int) -> None:
    _felt(s, m, sent_at)
    field(m, "torque", s.quanta, MICRO, MOST_TORQUE, blank=ZERO)
    tool = inner(s, m, "tool")
    bits = s.u8(largest_part(tool.get("rotation", UNTURNED)) | int(m.get("fixed", False)) << 2, 7)
    field(tool, "position", s.quanta, NANO, MOST_POSITION, blank=ZERO)
    field(tool, "rotation", s.rotation, bits & 3, blank=UNTURNED)
    field(m, "object", s.touched, blank=NO_OBJECT)
    m["fixed"] = bits & 4 == 4


def _ghosts(s: Stream, m: Fields, _: int) -> None:
    items(s, m, "ghosts", 1, 16, _ghost)


def _ghost(s: Stream, m: Fields) -> None:
    field(m, "pointer", s.varint, 0xFFFF)
    field(m, "touches", s.flag)
    field(m, "position", s.quanta, NANO, MOST_POSITION, blank=ZERO)
    field(m, "radius", s.size, MICRO, 10**9)


def _estimates(s: Stream, m: Fields, _: int) -> None:
    items(s, m, "estimates", 1, 8, _estimate)


def _estimate(s: Stream, m: Fields) -> None:
    field(m, "object", s.object)
    names = ("place", "stiffness", "friction", "mass")
    bits = s.u8(sum(1 << bit for bit, name in enumerate(names) if name in m), 15)
    if bits & 1:
        for name in ("place", "turn"):
            field(m, name, lambda values: _covariance(s, values), blank=(0.0,) * 6)
    for bit, name in list(enumerate(names))[1:]:
        if bits & 1 << bit:
            field(m, name, lambda values: tuple(s.real(value, 0.0, _MOST_ESTIMATE, "f") for value in values), blank=(0.0, 0.0))


def _covariance(s: Stream, values: tuple[float, ...]) -> tuple[float, ...]:
    """xx, yy, zz, xy, xz, yz: no variance below 0, no correlation above 1 but for rounding."""
    values = s.reals(values, _MOST_ESTIMATE, "f")
    for i, j, mixed in ((0, 1, 3), (0, 2, 4), (1, 2, 5)):
        require(min(values[i], values[j]) >= 0.0, "a negative variance")
        require(abs(values[mixed]) <= math.sqrt(values[i] * values[j]) * (1 + 1e-6), "a correlation above 1")
    return values


def _sample_acknowledgements(s: Stream, m: Fields, _: int) -> None:
    items(s, m, "samples", 1, 24, _sample_acknowledgement)


def _sample_acknowledgement(s: Stream, m: Fields) -> None:
    field(m, "pointer", s.varint, 0xFFFF)
    field(m, "sequence", s.varint, MOST_SEQUENCE)


def _terms(s: Stream, m: Fields, _: int) -> None:
    field(m, "scenario", s.u8, 5, 1)
    field(m, "passivity", s.u8)
    if m["passivity"] == WAVE_VARIABLES:
        field(m, "impedance", s.size, MICRO, 10**12)
    field(m, "bodies", s.varint, NO_OBJECT - 1)
    items(s, m, "hands", 0, 20, _hand_terms)


def _hand_terms(s: Stream, m: Fields) -> None:
    field(m, "kind", s.u8, 2)
    if m["kind"] == PROXY:
        field(m, "radius", s.size, NANO, 10**12)
    elif m["kind"] == TOOL:
        field(m, "shape", s.u64)


def _operator_samples(s: Stream, m: Fields, sent_at: int) -> None:
    operator_samples(s, m, sent_at)


KINDS: list[tuple[str, Callable[[Any, Fields, int], None]]] = [
    ("hello", _hello), ("bye", _bye), ("clock request", _clock_request), ("clock answer", _clock_answer),
    ("piece of a description", _piece), ("removal", _removal), ("acknowledgement", _acknowledgement),
    ("object states", _object_states), ("operator samples", _operator_samples), ("forces", _forces), ("ghosts", _ghosts),
    ("estimates", _estimates), ("wrenches", _wrenches), ("sample acknowledgements", _sample_acknowledgements), ("terms", _terms),
]  # fmt: skip
_NUMBERS = {name: number for number, (name, _) in enumerate(KINDS, 1)}
_FIRST_OF_NEWEST_VERSION = _NUMBERS["sample acknowledgements"]


def decode(data: bytes) -> tuple[Fields, str, Fields]:
    """Header, name of the kind and body of a packet. Raises Refused where it breaks a rule of the page."""
    s = Reader(data)
    require(s.octets(b"", 2) == b"TC", "wrong magic")
    require(OLDEST_VERSION <= s.u8() <= NEWEST_VERSION, "wrong version")
    require(len(data) <= MOST_PACKET_BYTES, "oversized")
    number = s.u8()
    header: Fields = {}
    _header(s, header)
    require(1 <= number <= len(KINDS), "unknown kind")
    name, fields = KINDS[number - 1]
    body: Fields = {}
    fields(s, body, header["sent_at"])
    _read_extensions(s, name, body)
    return header, name, body


def encode(epoch: int, sequence: int, sent_at: int, kind: str, body: Fields) -> bytes:
    """The packet of a message. Raises Refused where a value is missing or outside its range."""
    if kind not in _NUMBERS:
        raise Refused(f"'{kind}' is no kind of message: there are {', '.join(_NUMBERS)}")
    s = Writer()
    number = _NUMBERS[kind]
    s.octets(b"TC", 2)
    s.u8(NEWEST_VERSION if number >= _FIRST_OF_NEWEST_VERSION else OLDEST_VERSION)
    s.u8(number)
    _header(s, was_given({"epoch": epoch, "sequence": sequence, "sent_at": sent_at}))
    KINDS[number - 1][1](s, was_given(body), sent_at)
    _write_extensions(s, kind, body)
    require(len(s.data) <= MOST_PACKET_BYTES, "oversized")
    return bytes(s.data)


def _header(s: Stream, m: Fields) -> None:
    field(m, "epoch", s.u64)
    field(m, "sequence", s.varint, MOST_SEQUENCE)
    field(m, "sent_at", s.folded, MOST_TIME)
    require(m["epoch"] != 0 and m["sequence"] != 0, "header out of range")


def _read_extensions(s: Reader, kind: str, body: Fields) -> None:
    while s.left > 0:
        tag = s.u8()
        require(tag != 0, "oversized")
        content = s.octets(b"", s.u8())
        if kind == "forces" and tag == _TAKEN_TAG and len(content) == 4 * len(body["samples"]):
            taken = Reader(content)
            for sample in body["samples"]:
                sample["taken"] = taken.u32() / _TAKEN_QUANTA


def _write_extensions(s: Writer, kind: str, body: Fields) -> None:
    """The energy that the environment's end has taken in, as `taken` of a force (unit: joules); rounded down."""
    if kind == "forces" and any(sample.get("taken") for sample in body["samples"]):
        s.u8(_TAKEN_TAG)
        s.u8(4 * len(body["samples"]))
        for sample in body["samples"]:
            s.u32(int(sample.get("taken", 0.0) * _TAKEN_QUANTA + 1e-6) % 2**32)
