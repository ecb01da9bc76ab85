"""Operator samples (kind 9): each is told by what it differs by from what the ones before it in the packet let expect."""

from .stream import (
    MICRO, MOST_AGE, MOST_ANGULAR_SPEED, MOST_FORCE, MOST_POSITION, MOST_SEQUENCE, MOST_SPEED, NANO, NO_OBJECT, TENTH_MILLI,
    Fields, Reader, Writer, require, rotation_in_wholes, rotation_of, steady_largest_part, was_given, whole,
)  # fmt: skip

_CONNECTED, _FOLLOWS, _BUTTONS, _FORCE, _NEAREST, _TIME, _NEXT, _TURN = (1 << bit for bit in range(8))
_FARTHEST = 10**9  # that a sample is told from another one (unit: nanoseconds)
_MOST_TURN = 2**30 + 1
_ZERO = (0, 0, 0)
# Of each vector: quanta in one of its unit, and the most of a component.
_VECTORS = {
    "position": (NANO, MOST_POSITION), "velocity": (MICRO, MOST_SPEED), "force": (TENTH_MILLI, MOST_FORCE),
    "position_in_object": (NANO, MOST_POSITION), "spin": (MICRO, MOST_ANGULAR_SPEED),
}  # fmt: skip


def operator_samples(s: Reader | Writer, m: Fields, sent_at: int) -> None:
    m["period"] = period = s.varint(m.get("period", 0), 10**9)
    require(period >= 1, "period out of range")
    given = m.get("samples", [])
    count = s.u8(len(given), 16, 1)
    told = _Told()
    samples: list[Fields] = []
    for index in range(count):
        samples.append(_sample(s, was_given(given[index]) if s.writes else {}, samples[-1] if samples else None, told, sent_at, period))
    m["samples"] = samples


class _Told:
    """The last two samples of a packet in whole numbers, the newest first, and how many samples they are apart (0: no two)."""

    def __init__(self) -> None:
        self.last = self.before = {key: _ZERO for key in (*_VECTORS, "turn")} | {"largest": 3}
        self.apart = 0

    def expected(self, key: str, apart: int) -> tuple[int, ...]:
        """What has changed evenly goes on doing so."""
        last, before = self.last[key], self.before[key]
        evenly = self.apart == apart and (key != "turn" or self.last["largest"] == self.before["largest"])
        return tuple(2 * now - then for now, then in zip(last, before, strict=True)) if evenly else last


def _towards_zero(a: int, b: int) -> int:
    return a // b if a >= 0 else -(-a // b)


def _step(before: Fields | None, m: Fields, period: int) -> int:
    """How many samples `m` is before the one that stands before it; 0: it is told alone."""
    if before is None or before["pointer"] != m.get("pointer", 0):
        return 0
    apart = before["sequence"] - m["sequence"]
    return apart if 0 < apart <= _FARTHEST // period else 0


def _sample(s: Reader | Writer, m: Fields, before: Fields | None, told: _Told, sent_at: int, period: int) -> Fields:
    apart = _step(before, m, period) if s.writes else 0
    bits = s.u8(_bits(m, before, apart, sent_at, period) if s.writes else 0)
    apart, pointer, sequence = _identity(s, m, bits, before, apart, period)
    expected_time = before["time"] - apart * period if before and apart else sent_at
    time = expected_time + (s.folded(m.get("time", 0) - expected_time, MOST_AGE) if bits & _TIME else 0)
    now = dict.fromkeys(_VECTORS, _ZERO) | {"turn": _ZERO, "largest": 3}

    def vector(key: str, expected: tuple[int, ...] | None = None) -> None:
        quantum, most = _VECTORS[key]
        given = tuple(whole(part, quantum) for part in m.get(key, _ZERO))
        if expected is None:
            expected = told.expected(key, apart) if apart else _ZERO
        now[key] = s.wholes(given, int(most * quantum), expected)

    vector("velocity")
    vector("position", _carried_back(told.last, now["velocity"], apart * period) if apart else _ZERO)
    buttons = s.varint(m.get("buttons", 0), 0xFFFFFFFF) if bits & _BUTTONS else 0
    if bits & _FORCE:
        vector("force")
    nearest = NO_OBJECT
    if bits & _NEAREST:
        nearest = s.object(m.get("nearest_object", NO_OBJECT))
        vector("position_in_object")
    turn: Fields = {}
    if bits & _TURN:
        rotation = m.get("rotation", (0.0, 0.0, 0.0, 1.0))
        now["largest"] = s.u8(steady_largest_part(rotation), 3)
        same = now["largest"] == (told.last["largest"] if apart else 3)
        kept = rotation_in_wholes(rotation, now["largest"])
        now["turn"] = s.wholes(kept, _MOST_TURN, told.expected("turn", apart) if same and apart else _ZERO)
        vector("spin")
        turn = {"rotation": rotation_of(now["turn"], now["largest"]), "spin": _real(now, "spin")}
    told.last, told.before, told.apart = now, told.last, apart
    return turn | {
        "sequence": sequence, "time": time, "pointer": pointer, "connected": bits & _CONNECTED != 0, "buttons": buttons,
        "nearest_object": nearest, **{key: _real(now, key) for key in _VECTORS if key != "spin"},
    }  # fmt: skip


def _bits(m: Fields, before: Fields | None, apart: int, sent_at: int, period: int) -> int:
    expected_time = before["time"] - apart * period if before and apart else sent_at
    is_set = {
        _CONNECTED: m.get("connected", True), _FOLLOWS: apart > 0, _BUTTONS: m.get("buttons", 0) != 0,
        _FORCE: any(m.get("force", _ZERO)), _NEAREST: m.get("nearest_object", NO_OBJECT) != NO_OBJECT,
        _TIME: m["time"] != expected_time, _NEXT: apart == 1, _TURN: "rotation" in m,
    }  # fmt: skip
    return sum(bit for bit, set_ in is_set.items() if set_)


def _identity(s: Reader | Writer, m: Fields, bits: int, before: Fields | None, apart: int, period: int) -> tuple[int, int, int]:
    """How many samples before the one that stands before it (0: it is told alone), pointer and sequence."""
    if not bits & _FOLLOWS:
        require(bits & _NEXT == 0, "follows nothing")
        pointer, sequence = s.varint(m.get("pointer", 0), 0xFFFF), s.varint(m.get("sequence", 0), MOST_SEQUENCE)
        require(sequence >= 1, "no sample")
        return 0, pointer, sequence
    require(before is not None, "follows nothing")
    apart = 1 if bits & _NEXT else s.varint(apart, _FARTHEST // period)
    require(apart >= (1 if bits & _NEXT else 2) and apart <= _FARTHEST // period, "sequence out of range")
    require(before["sequence"] - apart >= 1, "sequence out of range")
    return apart, before["pointer"], before["sequence"] - apart


def _carried_back(last: Fields, velocity: tuple[int, ...], later: int) -> tuple[int, ...]:
    """Where the hand was `later` nanoseconds before, had its velocity changed evenly since."""
    parts = zip(last["position"], last["velocity"], velocity, strict=True)
    return tuple(at - _towards_zero((one + other) * later, 2 * 10**6) for at, one, other in parts)


def _real(wholes: Fields, key: str) -> tuple[float, ...]:
    return tuple(part / _VECTORS[key][0] for part in wholes[key])
