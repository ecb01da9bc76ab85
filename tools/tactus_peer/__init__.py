"""A side of a Tactus link in Python alone: what docs/wire_format.md says, read and written.

    stream        numbers to bytes and back
    messages      the kinds of packets: decode(bytes) and encode(epoch, sequence, time, kind, body)
    samples       operator samples, which are told from each other
    descriptions  bodies and joints
    epochs        which packets of the far side count
    teleoperator  Teleoperator: hello, terms, clocks, hands, forces, bodies, over UDP

docs/own_teleoperator.md shows how to use it. It needs Python 3.11 and no other package.
"""

from .descriptions import body, box, sphere
from .messages import decode, encode
from .stream import NO_OBJECT, Refused
from .teleoperator import Teleoperator

__all__ = ["NO_OBJECT", "Refused", "Teleoperator", "body", "box", "decode", "encode", "sphere"]
