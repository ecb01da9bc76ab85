"""What a suite returns: one result per test, its name starting with the suite's."""

from dataclasses import dataclass


@dataclass
class Result:
    name: str
    why: str = ""  # empty: passed
    skipped: bool = False  # and said why

    @property
    def passed(self) -> bool:
        return not self.why


def matching(names: list[str], wanted: str) -> list[str]:
    return [name for name in names if wanted.lower() in name.lower()]
