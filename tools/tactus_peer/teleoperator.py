"""The teleoperator's side of a link with an operator's MMTLink, over UDP.

Call tick() once a period, act on what hand() returns, and say what became of it by send_force() or send_states(). Time
comes in as an argument, so that real and virtual time are alike. Without a key a link stays within one machine; sealed
packets are not written here.
"""

import random
import select
import socket
from dataclasses import dataclass, field
from typing import Any

from . import descriptions, messages
from .epochs import Epochs
from .stream import NO_OBJECT, Fields, Refused

_HELLO_EVERY = 100_000_000  # (unit: nanoseconds, as all below)
_OFTEN = 20_000_000
_MEETING = 2 * 10**9
_TERMS_EVERY = 5  # hellos
_REPEAT_AFTER = 200_000_000
_ROOM_AFTER = 5 * 10**9
_READY_AFTER = 200_000_000  # a described body is ready for its states
_STANDING_EVERY = 10**9
_STANDS = 1e-3  # below this speed (unit: meters per second)
_STANDS_TURNING = 0.05  # (unit: radians per second)
_FIRST_TOOL = 16
_ROBOT = 3
_WITHOUT_MODEL = (2, _ROBOT)


Packet = tuple[Fields, str, Fields]  # header, kind, body


@dataclass
class _Told:
    """One body that the operator is told of."""

    description: bytes
    state: Fields  # of one that stands
    stands: bool
    revision: int
    due: int = 0
    known_at: int | None = None
    state_due: int = 0
    is_leaving: bool = False


@dataclass
class Counts:
    sent: int = 0
    received: int = 0
    refused: dict[str, int] = field(default_factory=dict)  # by the rule that a packet broke
    dropped: int = 0  # of no present epoch, or a copy


class Teleoperator:
    def __init__(
        self, local_port: int, remote_port: int, scenario: int, radius: float = 0.01, pointers: int = 1, period: int = 1_000_000,
        gravity: tuple[float, float, float] = (0.0, -9.81, 0.0), passivity: int = messages.NO_PASSIVITY, impedance: float = 0.0,
        delay: int = 0, address: str = "127.0.0.1",
    ):  # fmt: skip
        """`radius`: of the proxies, as at the operator (unit: meters). `delay`: of an emulated network, each way (unit: nanoseconds).
        `local_port` 0: any that is free; see `port`.
        """
        self.scenario, self.period, self.gravity, self.delay = scenario, period, gravity, delay
        self.counts = Counts()
        self.newest_sample = 0  # the newest of the operator's that hand() has returned
        self.newest_arrived = 0  # sample that has reached this machine, before the emulated delay
        self.round_trip = 0  # of the exchange with the least delay (unit: nanoseconds)
        self.clock_ahead = 0  # of the operator's before this one (unit: nanoseconds)
        self._terms: Fields = {
            "scenario": scenario, "passivity": passivity, "impedance": impedance, "bodies": 0,
            "hands": [{"kind": messages.PROXY, "radius": radius}] * pointers,
        }  # fmt: skip
        self._epochs = Epochs(random.SystemRandom().randrange(1, 2**64))
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((address, local_port))
        self._socket.setblocking(False)
        self._remote = (address, remote_port)
        self._now = self._sequence = self._request = self._revision = 0
        self._arriving: list[tuple[int, Packet]] = []
        self._leaving: list[tuple[int, bytes]] = []
        self._next_hello = self._next_request = self._met_at = self._hellos = 0
        self._told: dict[int, _Told] = {}
        self._forget()

    @property
    def port(self) -> int:
        return self._socket.getsockname()[1]

    # --- each period

    def tick(self, now: int) -> None:
        """Takes what has come and sends what is due. `now`: of a clock that only goes forward (unit: nanoseconds)."""
        self.fetch(now)
        while self._arriving and self._arriving[0][0] <= now:
            arrived, packet = self._arriving.pop(0)
            self._take(*packet, arrived)
        if now >= self._next_hello:
            self._say_hello()
        if self.is_connected and now >= self._next_request:
            self._next_request = now + (_OFTEN if now - self._met_at < _MEETING else _HELLO_EVERY)
            self._request += 1
            self._send("clock request", {"number": self._request, "t0": now})
        if self._epochs.hears(now):
            self._describe()
        self._acknowledge()
        self.flush()

    def wait(self, seconds: float) -> bool:
        """Until a datagram has come, or for so long; False: none has."""
        return bool(select.select([self._socket], [], [], max(seconds, 0.0))[0])

    def flush(self) -> None:
        """Gives the system what is due to leave: called by tick(), and after the last send of a period."""
        while self._leaving and self._leaving[0][0] <= self._now:
            try:
                self._socket.sendto(self._leaving.pop(0)[1], self._remote)
            except (BlockingIOError, ConnectionRefusedError):
                pass  # lost, as by any network

    def close(self) -> None:
        for _ in range(3):
            self._send("bye", {})
        while self._leaving:
            self._now = self._leaving[0][0]
            self.flush()
        self._socket.close()

    def __enter__(self) -> "Teleoperator":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # --- what the operator does

    @property
    def is_connected(self) -> bool:
        """Both sides hear each other."""
        return self._epochs.hears(self._now) and self._epochs.is_heard_there

    @property
    def problem(self) -> str:
        """Why nothing may be pressed; empty where all agrees."""
        if not self.is_connected:
            return "the operator is not heard"
        terms, own = self._peer_terms, self._terms
        if not terms:
            older = self._hello["newest_version"] < messages.NEWEST_VERSION
            return "" if older and self._hello["scenario"] == self.scenario else "the operator's terms have not come"
        if terms["scenario"] != self.scenario:
            return f"the operator plays scenario {terms['scenario']}, this side {self.scenario}: set both alike"
        if self.scenario in _WITHOUT_MODEL:
            if terms["passivity"] != own["passivity"]:
                return f"the operator's passivity is {terms['passivity']}, this side's {own['passivity']}: set both alike"
            if own["passivity"] == messages.WAVE_VARIABLES and abs(terms["impedance"] - own["impedance"]) > 1e-5:
                return f"the operator's wave impedance is {terms['impedance']} N·s/m, this side's {own['impedance']}: set both alike"
        if terms["bodies"] < own["bodies"]:
            return f"the operator has room for {terms['bodies']} bodies of {own['bodies']}: raise its room"
        return ""

    def hand(self, pointer: int = 0) -> Fields | None:
        """The newest sample of a proxy; None where it is not there, or may press nothing."""
        sample = self._samples.get(pointer)
        if sample is None or not sample["connected"] or self.problem or not self._works(pointer):
            return None
        self.newest_sample = max(self.newest_sample, sample["sequence"])
        return sample

    def _works(self, pointer: int) -> bool:
        if not self._peer_terms:
            return True
        theirs = self._peer_terms["hands"]
        own = self._terms["hands"]
        if pointer >= min(len(own), len(theirs)) or own[pointer]["kind"] != theirs[pointer]["kind"]:
            return False
        if own[pointer]["kind"] != messages.PROXY:
            return own[pointer] == theirs[pointer]
        return self.scenario == _ROBOT or abs(own[pointer]["radius"] - theirs[pointer]["radius"]) <= 1e-6

    # --- what becomes of it

    def send_force(
        self, sample: Fields, force: Any, proxy: Any, touched: int = NO_OBJECT, taken: float = 0.0,
    ) -> None:  # fmt: skip
        """Scenarios 2 and 3: what the hand of `sample` is to be given (unit: newtons), and where the proxy is. `taken`: the energy
        that this end has taken in from the environment so far (unit: joules).
        """
        answer = {
            "pointer": sample["pointer"], "true_at": self._now, "newest_operator_sample": sample["sequence"], "force": tuple(force),
            "proxy": tuple(proxy), "object": touched, "taken": taken,
        }  # fmt: skip
        self._send("forces", {"samples": [answer]})

    def add_body(self, description: Fields) -> None:
        """Tells of a body: descriptions.body(). Called again with the same number, it replaces the one of before."""
        number = description["object"]
        self._revision += 1
        state = {"object": number, "asleep": True, "pose": description["pose"]}
        stands = description["motion"] == descriptions.STATIC
        self._told[number] = _Told(descriptions.encode_description(description), state, stands, self._revision)
        self._note_bodies()

    def remove_body(self, number: int) -> None:
        self._revision += 1
        told = self._told[number]
        told.is_leaving, told.known_at, told.due, told.revision = True, None, 0, self._revision

    def is_known(self, number: int) -> bool:
        """The operator has the body in its model."""
        told = self._told.get(number)
        return told is not None and told.known_at is not None

    @property
    def all_known(self) -> bool:
        """The operator has every body that it has been told of, and they are ready for their states."""
        return all(self._is_ready(number) for number, told in self._told.items() if not told.is_leaving)

    def send_states(self, states: list[Fields], sample: int | None = None) -> None:
        """Scenarios 2, 4 and 5: where moving bodies are, each {"object", "pose", "linear_velocity", "angular_velocity"}; of those that
        the operator does not have yet nothing is sent. What stands is sent without being asked for. `sample`: the newest that had been
        applied when they were there; None: now.
        """
        ready = [state for state in states if self._is_ready(state["object"])]
        for first in range(0, len(ready), 16):
            self._send_states(ready[first : first + 16], sample)

    def _send_states(self, states: list[Fields], sample: int | None = None) -> None:
        body = {"true_at": self._now, "newest_operator_sample": self.newest_sample if sample is None else sample, "states": states}
        self._send("object states", body)

    def _is_ready(self, number: int) -> bool:
        told = self._told.get(number)
        return told is not None and told.known_at is not None and self._now - told.known_at >= _READY_AFTER

    # --- the link

    def fetch(self, now: int) -> None:
        """Takes what the system has. tick() does so as well."""
        self._now = now
        while True:
            try:
                data, sender = self._socket.recvfrom(2048)
            except (BlockingIOError, ConnectionRefusedError):
                return
            if sender != self._remote:
                continue
            try:
                packet = messages.decode(data)
            except Refused as refused:
                self.counts.refused[str(refused)] = self.counts.refused.get(str(refused), 0) + 1
                continue
            self._arriving.append((self._now + self.delay, packet))
            if packet[1] == "operator samples":
                self.newest_arrived = max(self.newest_arrived, packet[2]["samples"][0]["sequence"])

    def _send(self, kind: str, body: Fields) -> None:
        data = messages.encode(self._epochs.own, self._sequence + 1, self._now, kind, body)
        self._sequence += 1
        self.counts.sent += 1
        self._leaving.append((self._now + self.delay, data))

    def _take(self, header: Fields, kind: str, body: Fields, arrived: int) -> None:
        starts = self._epochs.starts
        if not self._epochs.admits(header, kind, body, messages.TELEOPERATOR, arrived):
            self.counts.dropped += 1
            return
        self.counts.received += 1
        if self._epochs.starts != starts:
            self._forget()
        match kind:
            case "hello":
                self._hello = body
            case "clock request":
                self._send("clock answer", {**body, "t1": arrived, "t2": max(self._now, arrived)})
            case "clock answer":
                self._note_clock(body, arrived)
            case "terms" if header["sequence"] > self._terms_packet:
                self._terms_packet, self._peer_terms = header["sequence"], body
            case "operator samples":
                for sample in body["samples"]:
                    before = self._samples.get(sample["pointer"])
                    if before is None or sample["sequence"] > before["sequence"]:
                        self._samples[sample["pointer"]] = sample
            case "acknowledgement":
                self._note_verdict(body)

    def _forget(self) -> None:
        """Another start of the operator: it has heard nothing yet."""
        self._hello: Fields = {}
        self._peer_terms: Fields = {}
        self._terms_packet = 0
        self._samples: dict[int, Fields] = {}
        self._seen: dict[int, int] = {}
        self._acknowledged: dict[int, int] = {}
        self._clock_at = None
        self.newest_sample = 0
        self._met_at = self._next_hello = self._now
        self._hellos = 0
        for number, told in list(self._told.items()):
            if told.is_leaving:
                del self._told[number]
            told.due, told.known_at = 0, None
        self._note_bodies()

    def _say_hello(self) -> None:
        packets, sequence = self._epochs.sequences.settled()
        self._send("hello", {
            "side": messages.TELEOPERATOR, "scenario": self.scenario, "period": self.period,
            "heard_epoch": self._epochs.peer if self._epochs.hears(self._now) else 0, "object_count": len(self._told),
            "gravity": self.gravity, "oldest_version": messages.OLDEST_VERSION, "newest_version": messages.NEWEST_VERSION,
            "heard_packets": packets, "heard_sequence": sequence,
        })  # fmt: skip
        meets = self._now - self._met_at < _MEETING
        self._next_hello = self._now + _HELLO_EVERY
        if meets or self._hellos % _TERMS_EVERY == 0:
            self._send("terms", self._terms)
        self._hellos += 1

    def _note_clock(self, answer: Fields, arrived: int) -> None:
        """Of the exchanges of the last ten seconds, the one with the least delay."""
        there, back = answer["t1"] - answer["t0"], answer["t2"] - arrived
        delay = (arrived - answer["t0"]) - (answer["t2"] - answer["t1"])
        if delay < 0 or answer["t2"] < answer["t1"] or arrived < answer["t0"]:
            return
        if self._clock_at is None or delay <= self.round_trip or arrived - self._clock_at > 10**10:
            self._clock_at, self.round_trip, self.clock_ahead = arrived, delay, (there + back) // 2

    def _acknowledge(self) -> None:
        """Of a hand that is gone or stands, and from which nothing newer has come for a tick."""
        known = []
        for pointer, sample in self._samples.items():
            slow = sum(part * part for part in sample["velocity"]) < _STANDS**2
            still = slow and sum(part * part for part in sample.get("spin", messages.ZERO)) < _STANDS_TURNING**2
            is_old = self._seen.get(pointer) == sample["sequence"]
            self._seen[pointer] = sample["sequence"]
            is_due = (is_old and still) or not sample["connected"]
            if is_due and self._acknowledged.get(pointer) != sample["sequence"]:
                self._acknowledged[pointer] = sample["sequence"]
                known.append({"pointer": pointer, "sequence": sample["sequence"]})
        if known:
            self._send("sample acknowledgements", {"samples": known[:24]})

    # --- bodies

    def _note_bodies(self) -> None:
        self._terms["bodies"] = max(self._told, default=-1) + 1

    def _describe(self) -> None:
        standing = []
        for number, told in self._told.items():
            if told.known_at is None and self._now >= told.due:
                told.due = self._now + max(_REPEAT_AFTER, 3 * self.round_trip // 2)
                self._send_pieces(number, told)
            elif told.stands and self._is_ready(number) and self._now >= told.state_due:
                told.state_due = self._now + _STANDING_EVERY
                standing.append(told.state)
        for first in range(0, len(standing), 16):
            self._send_states(standing[first : first + 16])

    def _send_pieces(self, number: int, told: _Told) -> None:
        content = {"object": number, "revision": told.revision, "hash": descriptions.content_hash(told.description)}
        if told.is_leaving:
            self._send("removal", content)
            return
        total = len(told.description)
        for offset in range(0, total, messages.MOST_PIECE_BYTES):
            piece = told.description[offset : offset + messages.MOST_PIECE_BYTES]
            self._send("piece of a description", {**content, "total_bytes": total, "offset": offset, "bytes": piece})

    def _note_verdict(self, body: Fields) -> None:
        told = self._told.get(body["object"])
        if told is None or body["hash"] != descriptions.content_hash(told.description):
            return
        if told.is_leaving:
            if body["verdict"] == messages.REMOVED:
                del self._told[body["object"]]
                self._note_bodies()
        elif body["verdict"] == messages.KNOWN:
            told.known_at = self._now if told.known_at is None else told.known_at
        elif body["verdict"] == messages.REFUSED:
            told.due = 2**62
        elif body["verdict"] == messages.NO_ROOM:
            told.due = self._now + _ROOM_AFTER
