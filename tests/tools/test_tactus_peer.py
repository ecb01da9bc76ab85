"""A side of a link in Python alone (tools/tactus_peer): every message there and back, judged by bytes that the C++ side wrote and by
a reader of its own; and teleoperators that a Godot operator touches.
"""

import os
import random
import subprocess
import sys
import time

import pytest
import wire_decoder as wire
from tactus_peer import NO_OBJECT, Refused, Teleoperator, body, box, decode, descriptions, encode, own_teleoperator
from tactus_peer.epochs import Epochs, Sequences
from test_wire_format import EXPECTED, PACKETS, VECTORS

from measuring import peer_operator
from setup import cache

# Another run of the tests on this machine has other ports.
PORTS = iter(range(26000 + os.getpid() % 600 * 10, 32000))
HEADER = {"epoch": 7, "sequence": 9, "sent_at": 5_000_000_000}


def again(data: bytes) -> bytes:
    header, kind, message = decode(data)
    return encode(header["epoch"], header["sequence"], header["sent_at"], kind, message)


@pytest.mark.parametrize("name", PACKETS)
def test_packet_of_the_other_implementation_is_read_and_written_alike(name):
    assert decode(VECTORS[name]) == wire.packet(VECTORS[name])
    assert again(VECTORS[name]) == VECTORS[name]


@pytest.mark.parametrize("name", PACKETS)
def test_written_message_is_read_by_the_judge(name):
    kind, message = EXPECTED[name]
    data = encode(*HEADER.values(), kind, _with_time(kind, message))
    header, read_kind, read = wire.packet(data)
    assert (header, read_kind) == (HEADER, kind)
    assert read == decode(data)[2]
    assert encode(*HEADER.values(), kind, read) == data


def _with_time(kind: str, message: dict) -> dict:
    """The judge leaves out what is nothing, and so may a writer; a time lies near that of sending."""
    if kind in ("operator samples", "forces", "wrenches"):
        key = "time" if kind == "operator samples" else "true_at"
        return message | {"samples": [sample | {key: HEADER["sent_at"]} for sample in message["samples"]]}
    return message | ({"true_at": HEADER["sent_at"]} if kind == "object states" else {})


@pytest.mark.parametrize("name", PACKETS)
def test_packet_cut_anywhere_is_refused(name):
    for size in range(len(VECTORS[name])):
        with pytest.raises(Refused):
            decode(VECTORS[name][:size])


def test_whatever_bytes_come_both_readers_agree():
    luck = random.Random(1)
    agreed_refusals = 0
    for _ in range(20_000):
        data = bytearray(VECTORS[luck.choice(PACKETS)])
        for _ in range(luck.randrange(1, 4)):
            data[luck.randrange(len(data))] = luck.randrange(256)
        found = [_outcome(read, bytes(data)) for read in (decode, wire.packet)]
        if found[0] is None and found[1] is not None and found[1][1] == "estimates":
            continue  # the judge looks at no covariance
        assert found[0] == found[1], data.hex()
        agreed_refusals += found[0] is None
    assert agreed_refusals > 1000


def _outcome(read, data: bytes):
    try:
        return read(data)
    except (Refused, wire.Refused):
        return None


@pytest.mark.parametrize(
    ("kind", "message", "words"),
    [
        ("hullo", {}, "no kind"),
        ("forces", {"samples": [{"pointer": 0, "true_at": 0, "newest_operator_sample": 1, "proxy": (0, 0, 0), "object": 1}]}, "'force'"),
        ("clock request", {"number": -1, "t0": 0}, "out of range"),
        ("clock request", {"number": 1, "t0": 2**61}, "out of range"),
        ("forces", {"samples": []}, "out of range"),
        ("object states", {"true_at": 0, "newest_operator_sample": 0, "states": [
            {"object": 1, "pose": {"position": (float("nan"), 0, 0), "rotation": (0, 0, 0, 1)}}]}, "not finite"),
        ("object states", {"true_at": 0, "newest_operator_sample": 0, "states": [
            {"object": 1, "pose": {"position": (0, 0, 0), "rotation": (0, 0, 1, 1)}}]}, "no rotation"),
        ("object states", {"true_at": 0, "newest_operator_sample": 0, "states": [{"object": 1}]}, "'pose'"),
    ],
)  # fmt: skip
def test_message_that_breaks_a_rule_is_not_written(kind, message, words):
    with pytest.raises(Refused, match=words):
        encode(1, 1, 0, kind, message)


def test_energy_taken_in_travels_as_an_extension():
    sample = {
        "pointer": 0, "true_at": 0, "newest_operator_sample": 1, "force": (0.0, 1.0, 0.0), "proxy": (0.0, 0.0, 0.0),
        "object": NO_OBJECT, "taken": 0.0123,
    }  # fmt: skip
    data = encode(1, 1, 0, "forces", {"samples": [sample]})
    assert decode(data)[2]["samples"][0]["taken"] == pytest.approx(0.0123, abs=1e-7)
    assert wire.packet(data)[2]["samples"][0]["force"] == (0.0, 1.0, 0.0)


def test_descriptions_are_read_and_written_alike():
    for name, read, write, judge in (
        ("description", descriptions.decode_description, descriptions.encode_description, wire.description),
        ("joint", descriptions.decode_joint, descriptions.encode_joint, wire.joint),
    ):
        assert read(VECTORS[name]) == judge(VECTORS[name])
        assert write(read(VECTORS[name])) == VECTORS[name]
        for size in range(len(VECTORS[name])):
            with pytest.raises(Refused):
                read(VECTORS[name][:size])
    assert descriptions.content_hash(VECTORS["description"]) == VECTORS["description_hash"]
    made = wire.description(descriptions.encode_description(body(3, "Ground", [box((0.5, 0.05, 0.5))], 500.0)))
    assert (made["object"], made["name"], made["motion"], made["touch"]["stiffness"]) == (3, "Ground", 0, 500.0)


def test_copies_and_what_cannot_be_are_dropped():
    window = Sequences()
    assert [window.is_new(number, 0) for number in (5, 7, 6, 7, 5, 8)] == [True, True, True, False, False, True]
    assert not window.is_new(8 + 513, 0)
    assert window.is_new(8 + 513, 1_000_000)
    for number in range(522, 700):
        window.is_new(number, 1_000_000)
    packets, sequence = window.settled()
    assert sequence == 699 - 128
    assert packets == 5 + (571 - 521)


def hello(side: int = 0, heard: int = 0) -> dict:
    return {
        "side": side, "scenario": 2, "period": 1_000_000, "heard_epoch": heard, "object_count": 0, "gravity": (0.0, -9.81, 0.0),
        "oldest_version": 3, "newest_version": 4, "heard_packets": 0, "heard_sequence": 0,
    }  # fmt: skip


def test_only_a_hello_of_the_other_side_begins_an_epoch():
    epochs = Epochs(own=99)

    def admits(epoch: int, sequence: int, kind: str, message: dict, now: int) -> bool:
        return epochs.admits({"epoch": epoch, "sequence": sequence, "sent_at": 0}, kind, message, 1, now)

    assert not admits(1, 1, "forces", {}, 0)
    assert not admits(1, 1, "hello", hello(side=1), 0)
    assert admits(1, 2, "hello", hello(heard=99), 0) and epochs.is_heard_there
    assert admits(1, 3, "forces", {}, 0)
    assert not admits(2, 1, "hello", hello(), 1000), "who cannot hear this side ends no conversation"
    assert admits(2, 2, "hello", hello(heard=99), 1000)
    assert not admits(1, 4, "hello", hello(heard=99), 2000), "that start is over"
    assert not admits(2, 3, "bye", {}, 3000) and not epochs.hears(3000)
    assert not admits(2, 4, "forces", {}, 4000)
    assert admits(2, 5, "hello", hello(heard=99), 5000) and epochs.hears(5000)


# --- a Godot operator


def operator(side: Teleoperator, remote: int, scenario: int, **other: object) -> peer_operator.Operator:
    return peer_operator.Operator({"scenario": scenario, "local_port": remote, "remote_port": side.port, **other})


def test_operator_feels_what_python_answers():
    """Scenario 3: each force is displayed one tick after the sample that it answers."""
    port = next(PORTS)
    with Teleoperator(0, port, scenario=3) as side, operator(side, port, 3, way="res://paths/robot_path.tres") as one:
        peer_operator.meet(one, side)
        one.set_out()
        sent, displayed = [], []
        for _ in range(1500):
            row = peer_operator.step_both(one, side)
            sample = side.hand()
            assert sample is not None and sample["sequence"] == len(one.rows)
            assert sample["position"] == pytest.approx(row["hand"], abs=1e-8)
            force = 500.0 * max(0.01 - sample["position"][1], 0.0)
            side.send_force(sample, (0.0, force, 0.0), sample["position"])
            peer_operator.deliver(side)
            sent.append(force)
            displayed.append(row["force"][1])
        assert max(sent) > 1.0
        off = [abs(one - other) for one, other in zip(sent, displayed[1:], strict=False)]
        assert sorted(off)[len(off) * 9 // 10] < 2e-3
        assert not side.counts.refused


def test_another_scenario_or_radius_presses_nothing():
    port = next(PORTS)
    with Teleoperator(0, port, scenario=2, radius=0.02) as side, operator(side, port, 2) as one:
        peer_operator.meet(one, side)
        assert side.hand() is None
    port = next(PORTS)
    with Teleoperator(0, port, scenario=3) as side, operator(side, port, 2) as one:
        for _ in range(2000):
            peer_operator.step_both(one, side)
            if "scenario 2" in side.problem:
                break
        assert "scenario 2, this side 3: set both alike" in side.problem
        assert side.hand() is None


def test_delay_is_kept_in_virtual_time():
    port, delay = next(PORTS), 20
    with Teleoperator(0, port, scenario=3, delay=delay * peer_operator.TICK) as side, operator(side, port, 3) as one:
        peer_operator.meet(one, side)
        for _ in range(100):
            peer_operator.step_both(one, side)
            assert side.hand()["sequence"] == len(one.rows) - delay


def test_bodies_are_discovered_move_and_go():
    """Scenario 4: the operator's local model is what Python describes."""
    port = next(PORTS)
    with Teleoperator(0, port, scenario=4) as side, operator(side, port, 4) as one:
        side.add_body(body(0, "Ground", [box((0.5, 0.05, 0.5))], 500.0))
        side.add_body(body(1, "Box", [box((0.05, 0.05, 0.05))], 500.0, mass=0.2, gravity_scale=0.0, linear_damping=0.0))
        peer_operator.meet(one, side)
        for tick in range(3000):
            row = peer_operator.step_both(one, side)
            pose = {"position": (0.2, 0.3, 0.0), "rotation": (0.0, 0.0, 0.0, 1.0)}
            side.hand()
            if tick % 5 == 0:
                side.send_states([{"object": 1, "pose": pose}])
            peer_operator.deliver(side)
            if set(row["bodies"]) == {"Ground", "Box"} and row["bodies"]["Box"] == pytest.approx([0.2, 0.3, 0.0], abs=1e-4):
                break
        assert row["bodies"].get("Box") == pytest.approx([0.2, 0.3, 0.0], abs=1e-4), row
        assert row["bodies"]["Ground"] == pytest.approx([0.0, 0.0, 0.0])
        side.remove_body(1)
        for _ in range(3000):
            row = peer_operator.step_both(one, side)
            peer_operator.deliver(side)
            if "Box" not in row["bodies"]:
                break
        assert set(row["bodies"]) == {"Ground"}


def test_own_teleoperator_is_felt():
    """The program of docs/own_teleoperator.md, as its own process: the displayed force is that of its spring at a place where the
    hand has been.
    """
    port, far_port = next(PORTS), next(PORTS)
    program = cache.clone() / "tools/tactus_peer/own_teleoperator.py"
    assert len(program.read_text().splitlines()) <= 50
    options = {"scenario": 2, "local_port": port, "remote_port": far_port, "way": "res://paths/robot_path.tres"}
    with subprocess.Popen([sys.executable, program, str(far_port), str(port)]) as far:
        try:
            with peer_operator.Operator(options) as one:
                assert any(_is_of_its_spring(one, tick) for tick in range(30_000)), one.rows[-1]
        finally:
            far.terminate()


def _is_of_its_spring(one: peer_operator.Operator, tick: int) -> bool:
    if tick == 1:
        one.set_out()
    force = one.step()["force"]
    time.sleep(0.001)  # its own time must not stand still
    places = (row["hand"] for row in one.rows[-500:])
    return max(force) > 1.0 and any(force == pytest.approx(own_teleoperator.answer({"position": at})[0], abs=2e-3) for at in places)
