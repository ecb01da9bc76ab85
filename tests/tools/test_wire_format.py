"""docs/wire_format.md is enough to read what the C++ writes: the same vectors, a reader of its own."""

import hashlib

import pytest
import wire_decoder as wire
from setup import cache

HASH = bytes(range(0xA0, 0xB0))
HEADER = {"epoch": 0x0102030405060708, "sequence": 77, "sent_at": -123456789}


def _vectors() -> dict[str, bytes]:
    lines = (cache.clone() / "tests/shared/wire_vectors.txt").read_text().splitlines()
    return {name: bytes.fromhex(text) for name, text in (line.split() for line in lines)}


VECTORS = _vectors()
PACKETS = [name for name in VECTORS if name not in ("greeting", "sealed", "description", "description_hash", "joint")]
STILL = (0.0, 0.0, 0.0)


def _hand(sequence, **other):
    hand = {
        "sequence": sequence, "time": 1_000_000 * sequence, "pointer": 1, "connected": True, "buttons": 0x80000001,
        "position": (0.01, 0.02, 0.03), "velocity": (-0.1, 0.2, -0.3), "force": (1.5, -2.5, 3.5),
        "nearest_object": 7, "position_in_object": (0.001, 0.002, -0.003),
    }  # fmt: skip
    return hand | other


def _state(number, linear_velocity, angular_velocity):
    return {
        "object": number, "asleep": number % 2 == 1,
        "pose": {"position": (0.5 + number, -1.25, 2.0), "rotation": (-0.4, 0.4, -0.2, 0.8)},
        "linear_velocity": linear_velocity, "angular_velocity": angular_velocity,
    }  # fmt: skip


def _unit(*parts):
    length = sum(part * part for part in parts) ** 0.5
    return tuple(part / length for part in parts)


def _tool(sequence, **other):
    tool = ALONE | {"pointer": 17, "spin": (0.5, -1.25, 2.0), "rotation": _unit(-0.4, 0.4, -0.2, 0.8)}
    return _hand(sequence, **(tool | other))


ALONE = {"pointer": 0, "force": STILL, "buttons": 0, "nearest_object": wire.NOBODY, "position_in_object": STILL}

EXPECTED = {
    "hello": ("hello", {
        "side": 1, "scenario": 2, "period": 1_000_000, "heard_epoch": 0x1122334455667788, "object_count": 9,
        "gravity": (0.0, -9.5, 0.25), "oldest_version": 2, "newest_version": 3, "heard_packets": 300,
        "heard_sequence": 321,
    }),
    "bye": ("bye", {}),
    "clock_request": ("clock request", {"number": 12, "t0": 1_000_000_007}),
    "clock_answer": ("clock answer", {"number": 12, "t0": 1_000_000_007, "t1": -5, "t2": 6}),
    "discovery_fragment": ("piece of a description", {
        "object": 7, "revision": 3, "hash": HASH, "total_bytes": 1029, "offset": 1024, "bytes": bytes([1, 2, 3, 4, 5]),
    }),
    "removal": ("removal", {"object": 8, "revision": 4, "hash": HASH}),
    "acknowledge": ("acknowledgement", {"object": 9, "hash": HASH, "verdict": 2}),
    "object_states": ("object states", {
        "true_at": 5_000_000, "newest_operator_sample": 42,
        "states": [_state(3, (0.125, -0.25, 3.375), (-4.0, 5.5, 6.25)), _state(4, STILL, STILL)],
    }),
    "operator_samples": ("operator samples", {
        "period": 1_000_000, "samples": [
            _hand(43), _hand(42, position=(0.0101, 0.02, 0.03), velocity=(-0.1, 0.25, -0.3)),
            _hand(41, velocity=(-0.1, 0.31, -0.3)), _hand(38), _hand(43, **ALONE),
        ],
    }),
    "forces": ("forces", {"samples": [
        {"pointer": 2, "true_at": 5_000_000, "newest_operator_sample": 41, "force": (0.1, 0.2, -0.3),
         "proxy": (1.0, 2.0, 3.0), "object": 4},
        {"pointer": 3, "true_at": -123456789, "newest_operator_sample": 0, "force": (0.0, -5.25, 0.0),
         "proxy": (-1.0, 0.0, 0.25), "object": wire.NOBODY},
    ]}),
    "ghosts": ("ghosts", {"ghosts": [
        {"pointer": 1, "touches": True, "position": (0.5, -1.25, 2.0), "radius": 0.01},
        {"pointer": 3, "touches": False, "position": (0.0, 0.125, -3.0), "radius": 0.0055},
    ]}),
    "estimates": ("estimates", {"estimates": [
        {"object": 5, "place": (0.25, 0.5, 0.125, 0.125, 0.0, -0.0625), "turn": (0.5, 0.5, 0.5, 0.0, 0.0, 0.0), "mass": (0.75, 0.0625)},
        {"object": 300, "stiffness": (512.0, 8.0), "friction": (0.25, 0.03125)},
    ]}),
    "wrenches": ("wrenches", {"samples": [
        {"pointer": 17, "true_at": 5_000_000, "newest_operator_sample": 41, "force": (0.1, 0.2, -0.3),
         "torque": (0.25, -0.5, 1e-6), "tool": {"position": (1.0, 2.0, 3.0), "rotation": (-0.4, 0.4, -0.2, 0.8)}, "object": 4,
         "fixed": False},
        {"pointer": 16, "true_at": -123456789, "newest_operator_sample": 0, "force": (0.0, -5.25, 0.0), "torque": STILL,
         "tool": {"position": (-1.0, 0.0, 0.25), "rotation": (0.6, 0.0, 0.8, 0.0)}, "object": wire.NOBODY, "fixed": True},
    ]}),
    "sample_acknowledgements": ("sample acknowledgements", {
        "samples": [{"pointer": 1, "sequence": 300}, {"pointer": 17, "sequence": 5}],
    }),
    "terms": ("terms", {
        "scenario": 3, "passivity": 1, "impedance": 4.5, "bodies": 300,
        "hands": [{"kind": 1, "radius": 0.0105}, {"kind": 0}, {"kind": 1, "radius": 0.005}, *[{"kind": 0}] * 13,
                  {"kind": 2, "shape": 0x0102030405060708}],
    }),
    "tool_samples": ("operator samples", {
        "period": 1_000_000, "samples": [
            _tool(43), _tool(42, rotation=_unit(-0.41, 0.38, -0.2, 0.81), spin=(0.5, -1.0, 2.0)),
            _tool(41, rotation=_unit(-0.41, 0.88, -0.2, 0.3)), _tool(39),
        ],
    }),
}  # fmt: skip


def _near(read, expected):
    """Equal, but for rounding."""
    if isinstance(expected, dict):
        return read.keys() == expected.keys() and all(_near(read[key], expected[key]) for key in expected)
    if isinstance(expected, (list, tuple)):
        return len(read) == len(expected) and all(_near(a, b) for a, b in zip(read, expected, strict=True))
    return abs(read - expected) < 1e-9 if isinstance(expected, float) else read == expected


def test_there_is_a_vector_of_every_kind():
    assert sorted(EXPECTED) == sorted(PACKETS)
    assert {EXPECTED[name][0] for name in PACKETS} == {name for name, _ in wire.KINDS.values()}


@pytest.mark.parametrize("name", PACKETS)
def test_packet_is_read(name):
    header, kind, body = wire.packet(VECTORS[name])
    assert header == HEADER
    assert kind == EXPECTED[name][0]
    assert _near(body, EXPECTED[name][1]), body


@pytest.mark.parametrize("name", PACKETS)
def test_packet_cut_anywhere_is_refused(name):
    for size in range(len(VECTORS[name])):
        with pytest.raises(wire.Refused):
            wire.packet(VECTORS[name][:size])


def test_description_is_read():
    read = wire.description(VECTORS["description"])
    assert (read["object"], read["name"], read["mass"]) == (5, "Table/Box", 0.125)
    assert (read["touch"]["stiffness"], read["touch"]["pop_through_force"]) == (750.0, 3.0)
    assert (read["touch"]["impact_strength"], read["touch"]["impact_decay"]) == (4.0, 0.125)
    assert (read["touch"]["stribeck_speed"], read["touch"]["stiffening"]) == (0.0625, 2.5)
    assert read["touch"]["stiffening_depth"] == 0.03125
    assert read["touch"]["by_uv"]
    assert read["friction_image"] == {"columns": 1, "rows": 2, "heights": [0.5, 1.0]}
    assert read["height_image"] == {"columns": 2, "rows": 3, "heights": [0.0, 0.25, 0.5, 0.75, 1.0, 0.125]}
    assert read["pose"] == {"position": (0.5, -1.0, 2.0), "rotation": (0.5, -0.5, 0.5, 0.5)}
    assert (read["inertia"], read["center_of_mass"]) == ((0.001, 0.002, 0.003), (0.01, 0.02, 0.03))
    assert (read["layer"], read["mask"]) == (5, 0x80000003)
    assert (read["lock_linear"], read["lock_angular"]) == ([True, False, False], [False, False, True])
    assert [shape["kind"] for shape in read["shapes"]] == [name for name, _ in wire.SHAPES]
    assert [shape["smooth_below"] for shape in read["touch_shapes"]] == [0.25]
    assert read["shapes"][2]["half_segment"] == 0.2
    assert read["shapes"][6]["triangles"] == [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    assert read["shapes"][7]["heights"] == [0.0, 1.0, -2.0, 3.0, 4.0, 5.0]


def test_description_has_its_hash():
    assert wire.content_hash(VECTORS["description"]) == VECTORS["description_hash"]


def test_description_cut_anywhere_is_refused():
    for size in range(len(VECTORS["description"])):
        with pytest.raises(wire.Refused):
            wire.description(VECTORS["description"][:size])


def test_joint_is_read():
    read = wire.joint(VECTORS["joint"])
    assert (read["joint"] - wire.FIRST_JOINT, read["first"], read["second"], read["kind"]) == (3, 5, 9, "hinge")
    assert read["frame"] == {"position": (0.25, -1.0, 2.0), "rotation": (0.5, -0.5, 0.5, 0.5)}
    assert read["second_frame"] == {"position": (1.5, 0.0, -0.125), "rotation": (-0.5, 0.5, 0.5, 0.5)}
    assert read["linear"] == [(-0.5, 0.75), (0.0, 0.0), (1.0, -1.0)]
    assert read["angular"] == [(-1.0, 1.5), (1.0, -1.0), (-0.25, 0.0)]
    assert (read["motor_speed"], read["motor_torque"], read["bodies_collide"]) == (-2.5, 12.5, True)


def test_joint_cut_anywhere_is_refused():
    for size in range(len(VECTORS["joint"])):
        with pytest.raises(wire.Refused):
            wire.joint(VECTORS["joint"][:size])


@pytest.mark.parametrize("name", PACKETS)
def test_extensions_are_passed_over(name):
    assert wire.packet(VECTORS[name] + bytes([7, 2, 99, 99, 8, 0])) == wire.packet(VECTORS[name])
    for wrong in ([0], [7], [7, 2, 99]):
        with pytest.raises(wire.Refused):
            wire.packet(VECTORS[name] + bytes(wrong))


# --- the two sides of the sealed vector


SECRET = bytes(range(1, 33))


def _private_key(seed):
    return hashlib.blake2b(bytes([seed]) * 32, digest_size=32).digest()


def _greeting(seed):
    public = wire._x25519(_private_key(seed), bytes([9]) + bytes(31))
    return {"sender": 0x1111111111111111 * seed, "salt": bytes([0x50 + seed]) * 16, "public_key": public}


def _receiving_key():
    return wire.session_keys(SECRET, _private_key(2), _greeting(2), _greeting(1))["receive"]


def test_greeting_is_read():
    read = wire.greeting(VECTORS["greeting"])
    assert {key: read[key] for key in ("sender", "salt", "public_key")} == _greeting(1)
    assert read["receiver"] in (0, 0x2222222222222222)


def test_both_sides_make_the_same_keys():
    near = wire.session_keys(SECRET, _private_key(1), _greeting(1), _greeting(2))
    far = wire.session_keys(SECRET, _private_key(2), _greeting(2), _greeting(1))
    assert (near["id"], near["send"], near["receive"]) == (far["id"], far["receive"], far["send"])


def test_sealed_packet_is_opened():
    front, inside = wire.unseal(_receiving_key(), VECTORS["sealed"])
    assert front["session"] == wire.session_keys(SECRET, _private_key(1), _greeting(1), _greeting(2))["id"]
    assert inside == b"hhh"


def test_sealed_packet_needs_its_key():
    with pytest.raises(wire.Refused, match="wrong key"):
        wire.unseal(bytes(range(2, 34)), VECTORS["sealed"])


@pytest.mark.parametrize("at", [0, 3, 5, 9, 15, 16, 18, 20, 34])
def test_altered_sealed_packet_is_refused(at):
    altered = bytearray(VECTORS["sealed"])
    altered[at] ^= 1
    with pytest.raises(wire.Refused):
        wire.unseal(_receiving_key(), bytes(altered))
