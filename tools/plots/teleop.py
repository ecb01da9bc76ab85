"""Forces and places over a network: what the hand felt against what it should have felt."""

import csv
from pathlib import Path

import numpy as np

from measuring import rivals
from plots import style

# Colour and dash of each way: traditional touch is dashed.
WAYS = {
    "default": (style.MEASURED, "-"), "never_corrected": (style.QUIET, "-"), "pose_only": (style.WARNING, "-"),
    "velocities": (style.REFERENCE, "-"), "passive_updates": ("#3f8148", "-"), "carried_translate": ("#b9770e", "-."),
    "carried_turn": ("#b23a8e", "-."), "traditional": (style.INK, "--"),
    "traditional_compensation_spring": ("#4a6b8a", ":"), "traditional_wave_variables": ("#7a4fa3", "--"), "traditional_time_domain": ("#2a8c8c", "--"),
    "traditional_two_layers": ("#a87b1e", "--"),
}  # fmt: skip

Rows = dict[str, np.ndarray]


def read(path: Path) -> Rows:
    """The columns of what tests/bench/teleop.cpp wrote; time in seconds."""
    with path.open(newline="") as file:
        header = next(csv.reader(file))
        rows = np.loadtxt(file, delimiter=",", ndmin=2)
    columns = {name: rows[:, index] for index, name in enumerate(header)}
    columns["time"] = columns.pop("time_us") * 1e-6
    return columns


def force_error(rows: Rows) -> np.ndarray:
    return np.sqrt(sum((rows[f"force_{axis}"] - rows[f"direct_{axis}"]) ** 2 for axis in "xyz"))


def legend(axes) -> None:
    axes.legend(ncols=4, loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2)


def draw_gain(folder: Path, scene: str, delay: float) -> None:
    """The force on the hand, over a network with and without a local model, against direct touch."""
    rows = {scenario: read(folder / f"{scene}.{scenario}.csv") for scenario in ("traditional", "mmt")}
    drawn, ((force,), (error,)) = style.figure(2, 1, 9.0, 5.4, sharex=True)
    direct = rows["mmt"]
    size = np.sqrt(sum(direct[f"direct_{axis}"] ** 2 for axis in "xyz"))
    force.plot(direct["time"], size, color=style.QUIET, linewidth=3.0, alpha=0.5, label="direct touch")
    for scenario, colour, label in (
        ("traditional", style.WARNING, "direct"),
        ("mmt", style.MEASURED, "model-mediated"),
    ):
        size = np.sqrt(sum(rows[scenario][f"force_{axis}"] ** 2 for axis in "xyz"))
        force.plot(rows[scenario]["time"], size, color=colour, linewidth=1.2, label=label)
        error.plot(rows[scenario]["time"], force_error(rows[scenario]), color=colour, linewidth=1.2)
    force.set(ylabel="force on the hand (N)", ylim=(0, None))
    force.set_title(f"{round(delay * 1e3)} ms away, {scene} scene", pad=24)
    legend(force)
    error.set(ylabel="force error (N)", xlabel="time (s)", ylim=(0, None))
    style.save(drawn, folder / f"{scene}_forces.png")


LABELS = {"none": "never corrected", "pose": "pose alone (thesis)", "stealthy_direction": "stealthy, re-simulated"}
COLOURS = {"none": style.QUIET, "pose": style.WARNING, "stealthy_direction": style.MEASURED}


def draw_dynamic(folder: Path, names: tuple[str, ...]) -> None:
    """The thesis's figure 5.5 and the force plots that it lacks."""
    drawn, ((place,), (force,), (error,)) = style.figure(3, 1, 9.0, 8.0, sharex=True)
    direct_drawn = False
    for name in names:
        path = folder / f"{name}.csv"
        if not path.is_file():
            continue
        rows, scheme = read(path), name.split(".")[0]
        if not direct_drawn:
            size = np.sqrt(sum(rows[f"direct_{axis}"] ** 2 for axis in "xyz"))
            force.plot(rows["time"], size, color=style.INK, linewidth=3.0, alpha=0.25, label="direct touch")
            direct_drawn = True
        size = np.sqrt(sum(rows[f"force_{axis}"] ** 2 for axis in "xyz"))
        colour, label = COLOURS[scheme], LABELS[scheme]
        known = rows["box_error_m"] > 0.0
        place.semilogy(rows["time"][known], rows["box_error_m"][known] * 1e3, color=colour, linewidth=1.2, label=label)
        force.plot(rows["time"], size, color=colour, linewidth=1.0, label=label)
        error.plot(rows["time"], force_error(rows), color=colour, linewidth=1.0, label=label)
    place.set(ylabel="box off by (mm)", ylim=(1e-4, 3e3))
    place.set_title("A box that is pushed 100 ms away, its model 20 % too heavy and 30 % too slippery", pad=24)
    legend(place)
    force.set(ylabel="force (N)", ylim=(0, None))
    error.set(ylabel="force error (N)", xlabel="time (s)", ylim=(0, None), xlim=(1.0, 5.0))
    style.save(drawn, folder / "dynamic.png")


def draw_unsynchronised(folder: Path, variant: str, delay: float) -> None:
    """The thesis's figure 5.5: a right model whose sides are not synchronised, and what its mistakes make of the force."""
    drawn, ((error,), (place,)) = style.figure(2, 1, 9.0, 6.0, sharex=True)
    for scheme in rivals.MODELS:
        rows = read(folder / f"{variant}.{scheme}.{delay:.0f}ms.csv")
        colour, dash = WAYS[scheme]
        error.plot(rows["time"], force_error(rows), dash, color=colour, linewidth=1.0)
        off = np.where(rows["box_error_m"] > 0.0, rows["box_error_m"] * 1e3, np.nan)
        place.semilogy(rows["time"], off, dash, color=colour, linewidth=1.0, label=rivals.LABELS[scheme])
    error.set(ylabel="force error (N)")
    error.set_yscale("symlog", linthresh=1e-2)
    error.set_ylim(0, None)
    error.set_title(f"A right model whose teleoperator ticks at other times, {delay:.0f} ms away")
    place.set(ylabel="box off by (mm)", xlabel="time (s)", ylim=(1e-4, None))
    drawn.legend(*place.get_legend_handles_labels(), loc="outside lower center", ncols=5, fontsize=8.5)
    style.save(drawn, folder / "unsynchronised.png")


def draw_variants(found: dict, variants: tuple[str, ...], delay: str, path: Path) -> None:
    """Every scheme with every mistake of the model or the link."""
    figures = (
        ("force_error_mean_N", "force error, mean (N)"),
        ("box_position_error_rms_mm", "box off by, RMS (mm)"),
        ("felt_excess_100ms_jnd_p99", "excess force in 100 ms, p99 (JND)"),
    )
    drawn, axes = style.figure(1, 3, 15.0, 4.6, sharey=True)
    schemes = tuple(rivals.SCHEMES)
    for (key, title), one in zip(figures, axes[0]):
        values = np.array([[found[f"{variant}.{scheme}.{delay}"][key] for variant in variants] for scheme in schemes])
        _draw_table(one, values)
        one.set(title=title, xticks=range(len(variants)), yticks=range(len(schemes)))
        one.set_xticklabels([variant.replace("_", "\n") for variant in variants], fontsize=7)
        one.set_yticklabels([rivals.LABELS[scheme] for scheme in schemes], fontsize=8.5)
    style.save(drawn, path)


def _draw_table(axes, values: np.ndarray) -> None:
    shown = np.log10(np.maximum(values, 1e-4))
    image = axes.imshow(shown, cmap="YlOrRd", aspect="auto")
    for (row, column), value in np.ndenumerate(values):
        dark = image.norm(shown[row, column]) > 0.6
        text = f"{value:.2g}" if 1e-4 <= value < 99.5 else "0" if value < 99.5 else f"{value:.0f}"
        axes.text(column, row, text, ha="center", va="center", color="white" if dark else style.INK, fontsize=8)
    axes.grid(False)


def draw_schemes(found: dict, corrections: tuple, derivations: tuple, path: Path) -> None:
    """Every scheme at 100 ms without loss."""
    figures = (
        ("force_error_mean_N", "force error, mean (N)"),
        ("box_position_error_rms_mm", "box off by, RMS (mm)"),
        ("correction_force_step_max_N", "largest step (N)"),
    )
    drawn, axes = style.figure(1, 3, 12.0, 4.2, sharey=True)
    for (key, title), one in zip(figures, axes[0]):
        values = np.array(
            [[found.get(f"{c}.{d}.100ms.0pct", {}).get(key, np.nan) for c in corrections] for d in derivations]
        )
        _draw_table(one, values)
        one.set(title=title, xticks=range(len(corrections)), yticks=range(len(derivations)))
        one.set_xticklabels([c.replace("_", "\n") for c in corrections], fontsize=8)
        one.set_yticklabels(derivations)
    drawn.suptitle("100 ms, no loss: how a correction is brought in, and how the present is derived", fontsize=11)
    style.save(drawn, path)


def draw_delays(found: dict, path: Path) -> None:
    schemes = {
        "none.none": "never_corrected", "pose.none": "pose_only", "pose_velocity.velocity": "velocities",
        "passive.resimulate": "passive_updates", "stealthy_direction.resimulate": "default",
        **{scheme: scheme for scheme in rivals.TRADITIONAL},
    }  # fmt: skip
    drawn, axes = style.figure(1, 2, 12.0, 5.4)
    for (key, title), one in zip(
        (("force_error_mean_N", "force error, mean (N)"), ("box_position_error_rms_mm", "box off by, RMS (mm)")), axes[0]
    ):
        for scheme, way in schemes.items():
            colour, whole = WAYS[way]
            for loss, dash in (("0", whole), ("50", ":")):
                points = sorted(
                    (float(name.split(".")[-2].removesuffix("ms")), figures[key])
                    for name, figures in found.items()
                    if name.rsplit(".", 2)[0] == scheme and name.endswith(f".{loss}pct") and key in figures
                )
                if points:
                    label = rivals.LABELS[way] if loss == "0" else None
                    one.plot(*zip(*points), dash, color=colour, marker="o", markersize=3, linewidth=1.3, label=label)
        one.set(title=title, xlabel="delay there and back (ms)", yscale="log")
    drawn.legend(*axes[0][0].get_legend_handles_labels(), loc="outside lower center", ncols=5, fontsize=8.5)
    axes[0][1].text(0.98, 0.02, "dotted: half of all packets lost", transform=axes[0][1].transAxes, ha="right", fontsize=8)
    style.save(drawn, path)
