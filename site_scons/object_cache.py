"""SCons's cache of objects, which clones share: what was cut short there is built anew, and a cache that cannot be written
costs time and no build.
"""

import struct
from pathlib import Path

import SCons.CacheDir
import SCons.Errors


class ObjectCache(SCons.CacheDir.CacheDir):
    """Its layout is SCons's own. That is not asked for in the cache, under a lock: one that was left behind there would stop
    every later build."""

    def __init__(self, path):
        super().__init__(None)
        self.path, self.config = path, {"prefix_len": 2}

    def retrieve(self, node):
        kept = self.cachepath(node)[1]  # none with --cache-disable
        if kept and Path(kept).is_file() and not is_whole(Path(kept)):
            try:
                Path(kept).unlink()
            except OSError:
                return False
        return super().retrieve(node)

    def push(self, node):
        try:
            return super().push(node)
        except (OSError, SCons.Errors.SConsEnvironmentError):
            return None


# Of an ELF file of 64 bits: how long its head is, and what stands there: where the table of sections begins; how long a line
# of it is, and how many there are.
_HEAD = 64
_SECTIONS_BEGIN, _SECTIONS = (40, "<Q"), (58, "<HH")
_ARCHIVE, _MEMBER = b"!<arch>\n", 60  # its mark; and how long the head of a member is


def is_whole(path):
    """False where the end of an object, a library or a program is missing: a full disk, a loss of power."""
    content = path.read_bytes()
    if _ARCHIVE.startswith(content[: len(_ARCHIVE)]):
        return _is_whole_archive(content)
    if not content.startswith(b"\x7fELF"):
        return any(content)
    if len(content) < _HEAD:
        return False
    begin = struct.unpack_from(_SECTIONS_BEGIN[1], content, _SECTIONS_BEGIN[0])[0]
    length, count = struct.unpack_from(_SECTIONS[1], content, _SECTIONS[0])
    return begin + length * count <= len(content) and any(content[begin:])


def _is_whole_archive(content):
    place = len(_ARCHIVE)
    while place < len(content):
        size = content[place + 48 : place + 58].strip()  # in decimals
        if not size.isdigit():
            return False
        place += _MEMBER + int(size)
        place += place % 2
    return place == len(content)
