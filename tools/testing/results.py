"""What a suite returns: one result per test, its name starting with the suite's."""

from dataclasses import dataclass


@dataclass
class Result:
    name: str
    why: str = ""  # empty: passed
    skipped: str = ""  # why it could not be run here; empty: it was
    seconds: float = 0.0
    bits: str = ""  # of what it computed, where it says: tests/session/same_bits_test.cpp

    @property
    def passed(self) -> bool:
        return not self.why


def matching(names: list[str], wanted: str) -> list[str]:
    return [name for name in names if wanted.lower() in name.lower()]
