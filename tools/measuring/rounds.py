"""Repeating a measurement on a machine that others disturb.

A virtual machine's host takes processors away without asking. A round in which it took much says more about the host
than about the loop, so the measurement is repeated, and the round that lost least is reported: the rule looks at the
disturbance alone, never at the result.
"""

from collections.abc import Callable, Sequence

from measuring.scene_run import Run


def measure(most: int, calm_steal_share: float, once: Callable[[int], Run]) -> list[Run]:
    """Rounds 1, 2, …, until the host has been calm in one, at most `most`."""
    rounds: list[Run] = []
    while len(rounds) < most:
        rounds.append(once(len(rounds) + 1))
        if rounds[-1].steal_share <= calm_steal_share:
            break
    return rounds


def reported(rounds: Sequence[Run]) -> int:
    """Counted from 1."""
    return 1 + min(range(len(rounds)), key=lambda index: rounds[index].steal_share)
