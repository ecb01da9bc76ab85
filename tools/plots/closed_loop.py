"""A hand that is pushed back, over a network."""

from pathlib import Path

import numpy as np

from plots import style
from plots.teleop import read

TITLES = {"static": "onto the ground", "dynamic": "against a box"}


def draw(folder: Path, scenes: tuple[str, ...], delays: list[str], summary: dict[str, object]) -> None:
    slowest = delays[-1]
    drawn, axes = style.figure(2, len(scenes), 11.0, 6.4)
    for column, scene in enumerate(scenes):
        depth, energy = axes[0][column], axes[1][column]
        traditional, model = (read(folder / f"{scene}.{way}_{slowest}ms.csv") for way in ("traditional", "mmt"))
        depth.plot(
            model["time"], model["direct_depth_m"] * 1e3, color=style.QUIET, linewidth=3.0, alpha=0.5, label="local touch"
        )
        for rows, colour, label in ((traditional, style.WARNING, "traditional"), (model, style.MEASURED, "local model")):
            depth.plot(
                rows["time"], rows["depth_m"] * 1e3, color=colour, linewidth=1.1, label=f"{label}, {slowest} ms"
            )
        depth.set(ylabel="hand below the surface (mm)", xlabel="time (s)", ylim=(0, None))
        depth.set_title(f"An arm presses {TITLES[scene]}")
        depth.legend(fontsize=8)
        along = np.array([float(delay) for delay in delays])
        for way, colour in (("traditional", style.WARNING), ("mmt", style.MEASURED)):
            values = [summary[f"{scene}.{way}_{delay}ms.energy_J"] for delay in delays]
            energy.plot(along, values, color=colour, marker="o", markersize=4)
        energy.axhline(float(summary[f"{scene}.local.energy_J"]), color=style.QUIET, linewidth=1.0)
        energy.set(ylabel="energy given to the hand (J)", xlabel="delay there and back (ms)")
    style.save(drawn, folder / "closed_loop.png")
