"""Pointers carried along with a turned object, beside corrections that mask what they change."""

from collections.abc import Sequence
from pathlib import Path

from plots import style

LOOKS = {
    "stealthy_translate": ("carried, translated", "#7a4fa3", "-"), "stealthy_turn": ("carried, turned", style.WARNING, "-"),
    "stealthy_magnitude": ("masked, size kept", style.REFERENCE, "--"), "stealthy_direction": ("masked, direction kept", style.MEASURED, "--"),
    "pose_velocity": ("neither", style.QUIET, ":"),
}  # fmt: skip


def draw(summary: dict[str, object], turns: Sequence[int], path: Path) -> None:
    drawn, ((felt, error),) = style.figure(1, 2, 10.0, 4.2)
    for scheme, (label, color, line) in LOOKS.items():
        for axes, key in ((felt, "felt_excess_100ms_jnd_p99"), (error, "force_error_over_never_corrected")):
            points = [(turn, summary[f"{scheme}.{turn}deg.{key}"]) for turn in turns if f"{scheme}.{turn}deg.{key}" in summary]
            if points:
                axes.plot(*zip(*points), color=color, linestyle=line, marker="o", markersize=4, label=label)
    felt.set(xlabel="orientation error (°)", ylabel="excess force in 100 ms, 99 % (JND)", ylim=(0, None))
    error.set(xlabel="orientation error (°)", ylabel="force error over never correcting", ylim=(0, None))
    error.axhline(1.0, color=style.INK, linewidth=0.8, linestyle=":")
    felt.set_title("What is felt of the correction", pad=10)
    error.set_title("What is left of the error", pad=10)
    felt.legend(fontsize=9)
    style.save(drawn, path)
