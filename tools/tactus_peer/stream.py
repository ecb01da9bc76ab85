"""Numbers to bytes and back, as docs/wire_format.md has them: little-endian, packed without gaps, every step checked.

Reader and Writer have the same methods, so that one list of fields serves both directions: each method takes the value
that is to be written, and returns the one that was written or read. A reader ignores what it is given.
"""

import math
import struct
from collections.abc import Callable
from typing import Any

Fields = dict[str, Any]

NO_OBJECT = 0xFFFFFFFF
MOST_TIME = 2**60  # (unit: nanoseconds)
MOST_AGE = 60 * 10**9  # (unit: nanoseconds)
MOST_SEQUENCE = 2**48
MOST_POSITION = 1e5  # of each component (unit: meters)
MOST_SPEED = 1e3  # (unit: meters per second)
MOST_ANGULAR_SPEED = 1e4  # (unit: radians per second)
MOST_FORCE = 1e3  # (unit: newtons)
MOST_TORQUE = 1e3  # (unit: newton meters)
# How many quanta make one of the unit.
NANO, MICRO, TENTH_MILLI = 10**9, 10**6, 10**4

_MOST_POSITIVE = 1e12
_TURN_SCALE = 2**30 * math.sqrt(2)
_MOST_TURN = 2**30 + 1
_LEAST_SQUARE = 0.25 - 1e-6  # of the largest of the four parts of a unit quaternion
_ALIKE = 1e-8  # parts of a quaternion that differ by less are as large


class Refused(ValueError):
    """A packet breaks a rule of docs/wire_format.md, or a value to be sent does; the text says which."""


def require(condition: bool, rule: str) -> None:
    if not condition:
        raise Refused(rule)


def whole(value: float, quantum: int) -> int:
    """In whole quanta, of which `quantum` make one; halves away from zero."""
    require(math.isfinite(value), "not finite")
    return int(math.copysign(math.floor(abs(value) * quantum + 0.5), value))


class _Stream:
    """What follows from the four primitives of a reader or a writer: octets, number, varint and real."""

    writes = False

    def octets(self, value: bytes, size: int) -> bytes:
        """Bytes as they are."""
        raise NotImplementedError

    def number(self, form: str, value: int) -> int:
        """`form`: a letter of struct, of an integer."""
        raise NotImplementedError

    def real(self, value: float, least: float = -math.inf, most: float = math.inf, form: str = "d") -> float:
        raise NotImplementedError

    def varint(self, value: int, most: int = 2**64 - 1) -> int:
        raise NotImplementedError

    def integer(self, value: int, form: str, least: int, most: int) -> int:
        value = self.number(form, value)
        require(least <= value <= most, f"number out of range: {value}")
        return value

    def u8(self, value: int = 0, most: int = 255, least: int = 0) -> int:
        return self.integer(value, "B", least, most)

    def u32(self, value: int = 0, most: int = 2**32 - 1) -> int:
        return self.integer(value, "I", 0, most)

    def u64(self, value: int) -> int:
        return self.number("Q", value)

    def flag(self, value: bool) -> bool:
        return self.u8(int(bool(value)), 1) == 1

    def time(self, value: int) -> int:
        return self.integer(value, "q", -MOST_TIME, MOST_TIME)

    def folded(self, value: int, most: int = 2**62) -> int:
        read = self.varint(2 * value if value >= 0 else -2 * value - 1)
        value = read >> 1 if read % 2 == 0 else -(read >> 1) - 1
        require(-most <= value <= most, "number out of range")
        return value

    def wholes(self, values: tuple[int, ...], most: int, expected: tuple[int, ...] = (0, 0, 0)) -> tuple[int, ...]:
        """Whole numbers, each as what it differs by from the one that is expected."""
        values = tuple(self.folded(value - part) + part for value, part in zip(values, expected, strict=True))
        require(max(map(abs, values)) <= most, "number out of range")
        return values

    def quanta(self, values: tuple[float, ...], quantum: int, most: float) -> tuple[float, ...]:
        """Three numbers in whole quanta, of which `quantum` make one."""
        given = tuple(whole(value, quantum) for value in values)
        return tuple(part / quantum for part in self.wholes(given, math.ceil(most * quantum)))

    def size(self, value: float, quantum: int, most: int) -> float:
        """What is not negative, in whole quanta."""
        require(value >= 0.0, "number out of range")
        return self.varint(whole(value, quantum), most) / quantum

    def reals(self, values: tuple[float, ...], most: float, form: str = "d") -> tuple[float, ...]:
        return tuple(self.real(value, -most, most, form) for value in values)

    def positive(self, value: float) -> float:
        value = self.not_negative(value)
        require(value > 0.0, "number out of range")
        return value

    def not_negative(self, value: float) -> float:
        return self.real(value, 0.0, _MOST_POSITIVE)

    def quat(self, value: tuple[float, ...]) -> tuple[float, ...]:
        value = tuple(self.real(part) for part in value)
        require(abs(math.hypot(*value) - 1.0) < 1e-3, "no rotation")
        return value

    def object(self, value: int) -> int:
        return self.varint(value, NO_OBJECT - 1)

    def touched(self, value: int) -> int:
        """An object, and 1 on top; NO_OBJECT: none."""
        return (self.varint((value + 1) % 2**32, NO_OBJECT) - 1) % 2**32

    def rotation(self, value: tuple[float, ...], largest: int) -> tuple[float, ...]:
        """A `turn`: all parts x, y, z, w but the largest, as i32."""
        kept = rotation_in_wholes(value, largest)
        return rotation_of(tuple(self.integer(part, "i", -_MOST_TURN, _MOST_TURN) for part in kept), largest)


class Reader(_Stream):
    def __init__(self, data: bytes):
        self._data, self._at = data, 0

    @property
    def left(self) -> int:
        return len(self._data) - self._at

    def octets(self, value: bytes, size: int) -> bytes:
        require(self.left >= size, "truncated")
        self._at += size
        return self._data[self._at - size : self._at]

    def number(self, form: str, value: int = 0) -> int:
        return struct.unpack("<" + form, self.octets(b"", struct.calcsize("<" + form)))[0]

    def real(self, value: float = 0.0, least: float = -math.inf, most: float = math.inf, form: str = "d") -> float:
        value = struct.unpack("<" + form, self.octets(b"", struct.calcsize("<" + form)))[0]
        require(math.isfinite(value), "not finite")
        require(least <= value <= most, "number out of range")
        return value

    def varint(self, value: int = 0, most: int = 2**64 - 1) -> int:
        value = 0
        for shift in range(0, 70, 7):
            byte = self.number("B")
            value |= (byte & 0x7F) << shift
            require(byte != 0 or shift == 0, "a byte that adds nothing")
            if byte < 0x80:
                require(value <= min(most, 2**64 - 1), "number out of range")
                return value
        raise Refused("number out of range")


class Writer(_Stream):
    writes = True

    def __init__(self) -> None:
        self.data = bytearray()

    def octets(self, value: bytes, size: int) -> bytes:
        require(len(value) == size, f"{len(value)} bytes for {size}")
        self.data += value
        return value

    def number(self, form: str, value: int) -> int:
        try:
            self.data += struct.pack("<" + form, value)
        except struct.error as error:
            raise Refused(f"number out of range: {value!r}") from error
        return value

    def real(self, value: float, least: float = -math.inf, most: float = math.inf, form: str = "d") -> float:
        require(math.isfinite(value), "not finite")
        require(least <= value <= most, f"number out of range: {value}")
        self.data += struct.pack("<" + form, value)
        return value

    def varint(self, value: int, most: int = 2**64 - 1) -> int:
        require(0 <= value <= most, f"number out of range: {value}")
        left = value
        while left >= 0x80:
            self.data.append(left & 0x7F | 0x80)
            left >>= 7
        self.data.append(left)
        return value


def largest_part(rotation: tuple[float, ...], alike: float = 0.0) -> int:
    """Of x, y, z, w the index of the largest; of those that are as large but for `alike` the first."""
    most = max(map(abs, rotation)) - alike
    return next(index for index, part in enumerate(rotation) if abs(part) >= most)


def steady_largest_part(rotation: tuple[float, ...]) -> int:
    """As samples have it: rounding does not change which."""
    return largest_part(rotation, _ALIKE)


def rotation_in_wholes(rotation: tuple[float, ...], largest: int) -> tuple[int, ...]:
    """The other three parts, in the whole numbers of a `turn`, with signs that make the largest positive."""
    length = math.hypot(*rotation)
    require(abs(length - 1.0) < 1e-3, "no rotation")
    scale = (-1.0 if rotation[largest] < 0.0 else 1.0) / length
    return tuple(whole(part * scale * _TURN_SCALE, 1) for index, part in enumerate(rotation) if index != largest)


def rotation_of(wholes: tuple[int, ...], largest: int) -> tuple[float, ...]:
    require(max(map(abs, wholes)) <= _MOST_TURN, "no rotation")
    parts = [part / _TURN_SCALE for part in wholes]
    rest = 1.0 - sum(part * part for part in parts)
    require(rest >= _LEAST_SQUARE, "no rotation")
    parts.insert(largest, math.sqrt(rest))
    return tuple(parts)


class _Given(dict):
    """A message that is to be written: what it lacks is named. It is not changed by being written."""

    def __missing__(self, key: str) -> Any:
        raise Refused(f"'{key}' is missing")


def was_given(message: Fields) -> Fields:
    return _Given({key: was_given(value) if isinstance(value, dict) else value for key, value in message.items()})


def field(m: Fields, key: str, stream_method: Callable[..., Any], *limits: Any, blank: Any = 0) -> None:
    """Writes m[key], or reads it. `blank`: what a reader's method is given in place of a value."""
    value = m[key] if isinstance(m, _Given) else blank
    m[key] = stream_method(value, *limits)


def inner(s: Reader | Writer, m: Fields, key: str) -> Fields:
    """A message within another one."""
    return m[key] if s.writes else m.setdefault(key, {})


def items(s: Reader | Writer, m: Fields, key: str, least: int, most: int, one: Callable[[Any, Fields], None]) -> None:
    """A list of messages: a u8 count, and so many times what one(stream, message) writes or reads."""
    given = [was_given(value) for value in m[key]] if s.writes else []
    count = s.u8(len(given), most, least)
    m[key] = given if s.writes else [{} for _ in range(count)]
    for value in m[key]:
        one(s, value)
