"""A hand that is pushed back, over a network."""

from pathlib import Path

import numpy as np

from plots import style
from plots.teleop import read

TITLES = {"static": "onto the ground", "dynamic": "against a box"}


WAYS = {
    "traditional": ("traditional", style.WARNING, "-"),
    "traditional_wave_variables": ("wave variables", style.REFERENCE, "-"),
    "traditional_time_domain": ("time domain", style.QUIET, "-"),
    "traditional_two_layers": ("two layers", style.INK, "-"),
    "mmt": ("local model", style.MEASURED, "-"),
}


def draw(folder: Path, scenes: tuple[str, ...], delays: list[str], summary: dict[str, object]) -> None:
    shown = "100" if "100" in delays else delays[-1]
    drawn, axes = style.figure(3, len(scenes), 12.0, 9.6)
    for column, scene in enumerate(scenes):
        depth, energy, share = (axes[row][column] for row in range(3))
        rows = read(folder / f"{scene}.mmt_{shown}ms.csv")
        depth.plot(rows["time"], rows["local_depth_m"] * 1e3, color=style.QUIET, linewidth=4.0, alpha=0.4, label="local touch")
        along = np.array([float(delay) for delay in delays])
        for way, (label, colour, dash) in WAYS.items():
            rows = read(folder / f"{scene}.{way}_{shown}ms.csv")
            depth.plot(rows["time"], rows["depth_m"] * 1e3, dash, color=colour, linewidth=1.0, label=label)
            for key, one in (("energy_created_J", energy), ("settled_force_share", share)):
                values = [float(summary[f"{scene}.{way}_{delay}ms.{key}"]) for delay in delays]
                one.plot(along, values, dash, color=colour, marker="o", markersize=4)
        depth.set(ylabel="far hand below the surface (mm)", xlabel="time (s)", ylim=(0, None))
        depth.set_title(f"An arm presses {TITLES[scene]}, {shown} ms away")
        depth.legend(fontsize=8, ncols=2)
        energy.set(ylabel="energy made in a contact (J)", xlabel="delay there and back (ms)")
        energy.set_yscale("symlog", linthresh=1e-6)
        energy.axhline(1e-6, color=style.INK, linewidth=0.8, linestyle=":")
        share.axhline(1.0, color=style.INK, linewidth=0.8, linestyle=":")
        share.set(ylabel="felt of the true force\nwhile the hand holds", xlabel="delay there and back (ms)", ylim=(0, 1.6))
    style.save(drawn, folder / "closed_loop.png")
