"""A hand that is pushed back, over a network."""

from pathlib import Path

import numpy as np

from measuring import rivals
from plots import style
from plots.teleop import WAYS, read

TITLES = {"static": "onto the ground", "dynamic": "against a box"}
FAMILIES = (tuple(rivals.TRADITIONAL), tuple(rivals.MODELS))


def draw(folder: Path, scenes: tuple[str, ...], delays: list[str], summary: dict[str, object]) -> None:
    shown = "100" if "100" in delays else delays[-1]
    drawn, axes = style.figure(4, len(scenes), 12.0, 13.0)
    along = np.array([float(delay) for delay in delays])
    for column, scene in enumerate(scenes):
        for row, family in enumerate(FAMILIES):
            _draw_depth(axes[row][column], folder, scene, shown, family)
        axes[0][column].set_title(f"An arm presses {TITLES[scene]}, {shown} ms away")
        for row, key, label in (
            (2, "energy_created_J", "energy generated in a contact (J)"),
            (3, "settled_force_error_N", "force error while\nthe hand holds (N)"),
        ):
            one = axes[row][column]
            for way in rivals.SCHEMES:
                name = "mmt" if way == rivals.DEFAULT else way
                values = [float(summary.get(f"{scene}.{name}_{delay}ms.{key}", "nan")) for delay in delays]
                colour, dash = WAYS[way]
                one.plot(along, values, dash, color=colour, marker="o", markersize=3.5, linewidth=1.3, label=rivals.LABELS[way])
            one.set(ylabel=label, xlabel="delay there and back (ms)")
        axes[2][column].set_yscale("symlog", linthresh=1e-6)
        axes[2][column].axhline(1e-6, color=style.INK, linewidth=0.8, linestyle=":")
        axes[2][column].set_ylim(-2e-7, None)
        axes[3][column].set_yscale("symlog", linthresh=1e-3)
        axes[3][column].set_ylim(0, None)
    drawn.legend(*axes[3][0].get_legend_handles_labels(), loc="outside lower center", ncols=5, fontsize=9)
    style.save(drawn, folder / "closed_loop.png")


def _draw_depth(axes, folder: Path, scene: str, delay: str, family: tuple[str, ...]) -> None:
    for number, way in enumerate(family):
        rows = read(folder / f"{scene}.{'mmt' if way == rivals.DEFAULT else way}_{delay}ms.csv")
        if number == 0:
            axes.plot(rows["time"], rows["local_depth_m"] * 1e3, color=style.QUIET, linewidth=4.0, alpha=0.4, label="local touch")
        colour, dash = WAYS[way]
        axes.plot(rows["time"], rows["depth_m"] * 1e3, dash, color=colour, linewidth=1.0, label=rivals.LABELS[way])
    axes.set(ylabel="far hand below\nthe surface (mm)", xlabel="time (s)", ylim=(0, None))
