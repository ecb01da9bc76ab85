"""docs/wire_format.md is enough to read what the C++ writes: the same vectors, a reader of its own."""

import pytest
import wire_decoder as wire
from setup import cache

HASH = bytes(range(0xA0, 0xB0))
HEADER = {"epoch": 0x0102030405060708, "sequence": 77, "sent_at": -123456789}


def _vectors() -> dict[str, bytes]:
    lines = (cache.clone() / "tests/shared/wire_vectors.txt").read_text().splitlines()
    return {name: bytes.fromhex(text) for name, text in (line.split() for line in lines)}


VECTORS = _vectors()
PACKETS = [name for name in VECTORS if name not in ("sealed", "description", "description_hash")]


def _hand(sequence):
    return {
        "sequence": sequence, "time": 1_000_000 * sequence, "pointer": 1, "connected": True, "buttons": 0x80000001,
        "position": (0.01, 0.02, 0.03), "velocity": (-0.1, 0.2, -0.3), "force": (1.5, -2.5, 3.5),
        "nearest_object": 7, "position_in_object": (0.001, 0.002, -0.003),
    }  # fmt: skip


def _state(number):
    return {
        "object": number, "asleep": number % 2 == 1,
        "pose": {"position": (0.5 + number, -1.25, 2.0), "rotation": (-0.5, 0.5, -0.5, 0.5)},
        "linear_velocity": (0.125, -0.25, 0.375 + number), "angular_velocity": (-4.0, 5.5, 6.25),
    }  # fmt: skip


EXPECTED = {
    "hello": ("hello", {
        "side": 1, "scenario": 2, "period": 1_000_000, "heard_epoch": 0x1122334455667788, "object_count": 9,
        "gravity": (0.0, -9.5, 0.25),
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
        "true_at": 5_000_000, "newest_operator_sample": 42, "states": [_state(3), _state(4)],
    }),
    "operator_samples": ("operator samples", {"samples": [_hand(43), _hand(42)]}),
    "force": ("force", {
        "pointer": 2, "true_at": 5_000_000, "newest_operator_sample": 41, "force": (0.1, 0.2, -0.3),
        "proxy": (1.0, 2.0, 3.0), "object": 4,
    }),
}  # fmt: skip


def test_there_is_a_vector_of_every_kind():
    assert sorted(EXPECTED) == sorted(PACKETS)
    assert len(PACKETS) == len(wire.KINDS)


@pytest.mark.parametrize("name", PACKETS)
def test_packet_is_read(name):
    header, kind, body = wire.packet(VECTORS[name])
    assert header == HEADER
    assert (kind, body) == EXPECTED[name]


@pytest.mark.parametrize("name", PACKETS)
def test_packet_cut_anywhere_is_refused(name):
    for size in range(len(VECTORS[name])):
        with pytest.raises(wire.Refused):
            wire.packet(VECTORS[name][:size])


def test_description_is_read():
    read = wire.description(VECTORS["description"])
    assert (read["object"], read["name"], read["mass"]) == (5, "Table/Box", 0.125)
    assert (read["touch"]["stiffness"], read["touch"]["pop_through_force"]) == (750.0, 3.0)
    assert read["texture"] == {"columns": 2, "rows": 3, "heights": [0.0, 0.25, 0.5, 0.75, 1.0, 0.125]}
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


def test_sealed_packet_is_opened():
    front, inside = wire.unseal(bytes(range(1, 33)), VECTORS["sealed"])
    assert front == {"sender": 0x1111111111111111, "receiver": 0x2222222222222222, "counter": 4}
    assert inside == b"touch"


def test_sealed_packet_needs_its_key():
    with pytest.raises(wire.Refused, match="wrong key"):
        wire.unseal(bytes(range(2, 34)), VECTORS["sealed"])


@pytest.mark.parametrize("at", [0, 3, 5, 13, 21, 28, 33, 40])
def test_altered_sealed_packet_is_refused(at):
    altered = bytearray(VECTORS["sealed"])
    altered[at] ^= 1
    with pytest.raises(wire.Refused):
        wire.unseal(bytes(range(1, 33)), bytes(altered))
