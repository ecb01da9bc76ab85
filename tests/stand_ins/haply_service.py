"""Answers as Haply's service does, for tests: states of one Inverse3 and its grip, a thousand times a second, one more
only after the last has been answered with a force.

    haply_service.py [silent|nonsense|uncalibrated|hasty|quoted]

A hasty one that has an answer in advance tells two states at once, a quoted one gives its device a name with a quotation mark. Prints its port, then each force that is another one, as
"x y z" and the number of the state that it answers, "waited" where no answer came and it told its state again, and "acknowledged" for a frame of the protocol's own.
A line on stdin: "drop" closes the connection, "mad" makes nonsense of all it says from now on over this one, "lie FIELD
MANNER" lets one field of its states lie; "lied NANOSECONDS", on the steady clock, says when the first of them was sent.
"""

import base64
import hashlib
import json
import os
import select
import socket
import struct
import sys
import time

GUID = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"


# A number that is none is written as null, as by the library that the real one uses.
WRONG = {"no_number": None, "infinite": 1e300}


def lying(told: dict, field: str, manner: str) -> dict:
    """The state, of which a field is wrong, leaps, or is frozen and no longer fits another one."""
    hand, grip = told["inverse3"][0]["state"], told["wireless_verse_grip"][0]["state"]
    if field == "position":
        moved = {"no_number": None, "infinite": 1e300, "leaps": hand["cursor_position"]["x"] + 0.03}
        hand["cursor_position"]["x"] = moved.get(manner, hand["cursor_position"]["x"])
    moves = manner == "frozen" and field in ("position", "velocity")
    hand["cursor_velocity"] = {"x": 1.5 if moves else 0.0, "y": 0.0, "z": 0.0}
    if field == "velocity":
        hand["cursor_velocity"]["x"] = (WRONG | {"leaps": 1e3}).get(manner, hand["cursor_velocity"]["x"])
    if field == "rotation":
        grip["orientation"]["z"] = (WRONG | {"leaps": -grip["orientation"]["z"]}).get(manner, grip["orientation"]["z"])
    if field == "buttons" and manner == "leaps":
        grip["buttons"] = {name: not held for name, held in grip["buttons"].items()}
    if field == "buttons" and manner in ("connected", "awake"):  # is not, and repeats what it said before
        told["wireless_verse_grip"][0]["status"][manner] = False
    return told


def state(calibrated: bool) -> dict:
    return {
        "session_id": 1,
        "inverse3": [
            {
                "device_id": "048D",
                "config": {"type": "inverse3", "handedness": "right", "coordinate_origin": "device_base"},
                "state": {
                    "cursor_position": {"x": 0.05, "y": -0.15, "z": 0.19},
                    "cursor_velocity": {"x": 0.1, "y": 0.2, "z": 0.3},
                    "mode": "idle",
                },
                "status": {"calibrated": calibrated, "in_use": False, "power_supply": True, "ready": True, "started": True},
            }
        ],
        "verse_grip": [],
        "wireless_verse_grip": [
            {
                "device_id": "0",
                "state": {
                    "buttons": {"a": True, "b": False, "c": True},
                    "orientation": {"x": 0.0, "y": 0.0, "z": 0.7071067811865476, "w": 0.7071067811865476},
                },
                "status": {"connected": True, "awake": True, "ready": True},
            }
        ],
        "custom_verse_grip": [],
    }


def shake_hands(client: socket.socket) -> None:
    request = b""
    while b"\r\n\r\n" not in request:
        request += client.recv(4096)
    headers = dict(line.split(": ", 1) for line in request.decode().split("\r\n")[1:] if ": " in line)
    digest = hashlib.sha1((headers["Sec-WebSocket-Key"] + GUID).encode()).digest()
    client.sendall(
        b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        b"Sec-WebSocket-Accept: " + base64.b64encode(digest) + b"\r\n\r\n"
    )


def frame(text: str) -> bytes:
    payload = text.encode()
    head = struct.pack("!BB", 0x81, len(payload)) if len(payload) < 126 else struct.pack("!BBH", 0x81, 126, len(payload))
    return head + payload


def exactly(client: socket.socket, count: int) -> bytes:
    got = b""
    while len(got) < count:
        part = client.recv(count - len(got))
        if not part:
            raise ConnectionError
        got += part
    return got


def message(client: socket.socket) -> str | None:
    """None: a frame of the protocol's own. A client's frames have to be masked."""
    first, second = exactly(client, 2)
    assert second & 0x80, "not masked"
    size = second & 0x7F
    if size == 126:
        (size,) = struct.unpack("!H", exactly(client, 2))
    mask = exactly(client, 4)
    payload = bytes(byte ^ mask[i % 4] for i, byte in enumerate(exactly(client, size)))
    return payload.decode() if first & 0x0F == 1 else None


def force_of(text: str) -> tuple[float, float, float]:
    said = json.loads(text)
    (device,) = said["inverse3"]
    command = device["commands"]["set_cursor_force"]
    assert device["device_id"] == "048D" and command["execute"] is True and said["session"] == {}
    # Without a sign of nothing.
    return tuple(round(command["vector"][axis], 3) + 0.0 for axis in "xyz")


def heard(force: tuple, last: tuple | None, states: int) -> tuple:
    if force != last:
        print(*force, states, flush=True)
    return force


def serve(client: socket.socket, manner: str, lie: list[str]) -> None:
    shake_hands(client)
    last = None
    states = 0  # those that are told again are no more
    is_told_again = False
    has_lied = True
    while True:
        states += not is_told_again
        is_told_again = False
        if manner != "silent" and lie[1:] != ["silent"]:
            told = state(manner != "uncalibrated")
            if manner == "quoted":
                told["inverse3"][0]["device_id"] = '04"8D'
            if manner == "hasty" and select.select([client], [], [], 0)[0] and (text := message(client)) is not None:
                last = heard(force_of(text), last, states)
                client.sendall(2 * frame(json.dumps(told)))
            else:
                client.sendall(frame("{]" if manner == "nonsense" else json.dumps(lying(told, *lie) if lie else told)))
        if not has_lied:
            print("lied", time.monotonic_ns(), flush=True)
            has_lied = True
        while True:
            readable, _, _ = select.select([client, sys.stdin], [], [], 0.05)
            if sys.stdin in readable:
                said = os.read(sys.stdin.fileno(), 100)
                if not said:
                    sys.exit(0)
                if said.startswith(b"lie "):
                    lie[:] = said.split(b"\n")[-2].decode().split()[1:]
                    has_lied = lie[1] == "none"
                elif said == b"mad\n":
                    manner = "nonsense"
                else:
                    return
            elif client not in readable:
                print("waited", flush=True)
                is_told_again = True
                break  # no answer yet: it is told again, as the real one does at its own pace
            if client not in readable:
                continue
            text = message(client)
            if text is not None:
                last = heard(force_of(text), last, states)
                break
            print("acknowledged", flush=True)
        time.sleep(0.0008)


def main(manner: str) -> None:
    listener = socket.create_server(("127.0.0.1", 0))
    print(listener.getsockname()[1], flush=True)
    lie: list[str] = []
    while True:
        readable, _, _ = select.select([listener, sys.stdin], [], [])
        if sys.stdin in readable:
            said = os.read(sys.stdin.fileno(), 100)
            if not said:
                return
            if said.startswith(b"lie "):
                lie[:] = said.split(b"\n")[-2].decode().split()[1:]
        if listener in readable:
            client, _ = listener.accept()
            try:
                serve(client, manner, lie)
            except (ConnectionError, OSError):
                pass
            client.close()


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "")
