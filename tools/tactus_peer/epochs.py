"""Which packets of a far side count: those of its present start, each once (docs/wire_format.md, Epochs and Sequence)."""

from .stream import Fields

VANISHED_AFTER = 10**9  # (unit: nanoseconds)
_REMEMBERED = 5 * 10**9  # an epoch that is over (unit: nanoseconds)
_WINDOW = 1024
_FARTHEST_AHEAD = 512
_MOST_A_SECOND = 20_000
_SETTLED = 128  # so far back, what was overtaken has come as well


class Sequences:
    """Tells copies, and packets that cannot be: a window of the last 1,024 sequences."""

    def __init__(self) -> None:
        self._newest = self._newest_at = self._came = 0
        self._mask = 0  # bit i: newest - i has come

    def is_new(self, sequence: int, now: int) -> bool:
        if now - self._newest_at > VANISHED_AFTER:
            self._newest = self._came = self._mask = 0
        ahead = sequence - self._newest
        most = _FARTHEST_AHEAD + (now - self._newest_at) * _MOST_A_SECOND // 10**9
        if self._newest == 0 or 0 < ahead <= most:
            self._mask = (self._mask << min(ahead, _WINDOW) | 1) & (1 << _WINDOW) - 1
            self._newest, self._newest_at = sequence, now
        elif ahead > 0 or -ahead >= _WINDOW or self._mask >> -ahead & 1:
            return False
        else:
            self._mask |= 1 << -ahead
        self._came += 1
        return True

    def settled(self) -> tuple[int, int]:
        """heard_packets and heard_sequence of a hello."""
        if self._newest <= _SETTLED:
            return 0, 0
        since = (self._mask & (1 << _SETTLED) - 1).bit_count()
        return self._came - since, self._newest - _SETTLED


class Epochs:
    """Of the far side: which start of it is heard, and whether it hears this one."""

    def __init__(self, own: int):
        self.own, self.peer = own, 0
        self.is_heard_there = False  # its last hello names this side's epoch
        self.has_left = False
        self.starts = 0
        self._heard_at = -(2**62)
        self._bye = 0
        self._before = 0
        self._over: dict[int, int] = {}  # epoch: when it ended
        self.sequences = Sequences()

    def hears(self, now: int) -> bool:
        return self.peer != 0 and not self.has_left and now - self._heard_at <= VANISHED_AFTER

    def admits(self, header: Fields, kind: str, body: Fields, own_side: int, now: int) -> bool:
        """Whether the packet counts. A hello may begin another epoch."""
        epoch, is_hello = header["epoch"], kind == "hello"
        if epoch == self.own or now - self._over.get(epoch, -(2**62)) < _REMEMBERED or (is_hello and body["side"] == own_side):
            return False
        if epoch != self.peer:
            names_own = is_hello and body["heard_epoch"] == self.own
            if not is_hello or (self.hears(now) and not names_own):
                return False
            self._before, self.peer, self.has_left, self.is_heard_there = self.peer, epoch, False, False
            self.starts += 1
            self.sequences = Sequences()
        if not self.sequences.is_new(header["sequence"], now):
            return False
        if kind == "bye":
            self.has_left, self._bye = True, header["sequence"]
            return False
        if self.has_left:
            if not is_hello or header["sequence"] <= self._bye:
                return False
            self.has_left = False
        self._heard_at = now
        if is_hello:
            self.is_heard_there = body["heard_epoch"] == self.own
            if self.is_heard_there and self._before:
                self._over[self._before] = now
                self._before = 0
        return True
