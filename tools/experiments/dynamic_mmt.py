"""Touch of what moves, over a network, with a model that is realistically wrong: how to bring the truth in (thesis 5.4).

    ./run experiment dynamic_mmt [--seconds=10] [--delay=0,25,50,100,200,500] [--loss=0,0.1,0.5] [--pictures=1]
        [--table=1] [--variants=1] [--long=1] [--unmodelled=1] [--grid=1] [--grid_scenes=one,three,stack,hinge] [--grid_wrong=all] [--grid_delay=50,100,200]
        [--grid_schemes=default,never_corrected,…] [--grid_loss=0,0.5] [--grid_seeds=6] [--grid_set=KEY=VALUE,KEY=VALUE]
        [--mass=0.8 --friction=1.3 --tilt=1 --moved=0.01 --pose_noise=0.001 --phase=500 --late=50 --jitter=3]

Cases are CORRECTION.DERIVATION.DELAYms.LOSSpct: how a correction is brought in, how the present is derived from a state
that is one delay old, the delay there and back, and the share of packets lost. traditional.DELAYms.LOSSpct is beside them, and traditional_SCHEME with each passive scheme.

VARIANT.SCHEME.100ms are other mistakes (demo_project/experiments/dynamic_mmt.json, "variants"), each with every scheme of
measuring/rivals.py: among them "unsynchronised", a right model whose side ticks half a tick later and starts late behind a
jittering link (thesis figure 5.5), and places that are seen with 1 mm of noise.

long_delay.WAY.2000ms.* are a turn and a half with 2 s there and back: the default with a history that is longer than the delay,
short_history with the usual one of 1.024 s, beyond which moving bodies are corrected by velocity, and never_corrected.

thesis_system.DELAYms.LOSSpct.* is the thesis's own link (rivals.THESIS_SYSTEM), thesis_system.VARIANT.* the same with other
mistakes, so that what its jitter, its losses and its poses without rates do is beside ours.

The grid (measuring/teleop_grid.py; grid.csv has a line for each of its cases) asks the default against never correcting,
pose alone, velocities and traditional touch, over models that are wrong in many ways; grid.unseen.* are the same of models
that chance has made wrong, by so many seeds (grid_unseen.csv). --table=0, --variants=0 and the options
of the grid leave out what is not wanted.

unmodelled.* are the figures of another grid (unmodelled.csv; left out by --unmodelled=0 or --grid=0), in which something else
acts on the box and no side is told of it: one or two other hands, a spring to the world, hidden walls, a draft, a hidden joint.

--grid_set changes the default, with keys of tests/shared/teleop_words.cpp.
"""

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from measuring import options, rivals, teleop_grid, teleop_runs

CORRECTIONS = ("none", "pose", "pose_velocity", "passive", "stealthy_magnitude", "stealthy_direction")
DERIVATIONS = ("none", "velocity", "acceleration", "averaged", "history", "resimulate")
FIGURES = (
    *teleop_runs.PLACES, *teleop_runs.FIGURES, "force_jitter_rms_N", "correction_force_step_max_N", "correction_cost_jnd_p99",
    "packets_per_s", "force_error_shifted_mean_N",
)  # fmt: skip
# Of the variants: at this delay (milliseconds), without loss.
VARIED_AT = "100"
FIGURE_5_5 = "unsynchronised"
# There and back (milliseconds); the history is a tenth of a second longer.
LONG_MS = 2000
LONG: dict[str, teleop_runs.Case] = {
    "default": {"history_ms": LONG_MS + 100}, "short_history": {}, "never_corrected": {"correction": "none"},
}  # fmt: skip
LONG_FIGURES = (
    "box_position_error_mean_mm", "box_position_error_max_mm", "box_position_error_final_mm", "force_error_mean_N",
    "felt_excess_100ms_jnd_p99", "corrections", "replays", "states_beyond_history",
)  # fmt: skip
# Shown as curves: the model left alone, the thesis's correction, and ours.
SHOWN = ("none.none.100ms.0pct", "pose.none.100ms.0pct", "stealthy_direction.resimulate.100ms.0pct")


@dataclass(frozen=True)
class Settings(teleop_runs.Imperfections):
    seconds: float = options.seconds(10.0)
    delay: tuple[int, ...] = options.numbers((0, 25, 50, 100, 200, 500), "ms", 0, options.LONGEST_DELAY_MS, was="delays")
    loss: tuple[float, ...] = options.numbers((0.0, 0.1, 0.5), "share", 0, 1, was="losses")
    clock: Literal["virtual", "real"] = "virtual"
    pictures: bool = options.switch(True)
    table: bool = options.switch(True)
    variants: bool = options.switch(True)
    long: bool = options.switch(True)
    unmodelled: bool = options.switch(True)
    grid: bool = options.switch(True)
    grid_scenes: tuple[str, ...] = options.names(None, lambda: teleop_runs.description("dynamic_mmt")["grid"]["scenes"])
    grid_wrong: tuple[str, ...] = options.names(None, lambda: teleop_runs.description("dynamic_mmt")["grid"]["wrong"])
    grid_delay: tuple[int, ...] = options.numbers((50, 100, 200), "ms", 0, options.LONGEST_DELAY_MS, was="grid_delays")
    grid_loss: tuple[float, ...] = options.numbers((0.0, 0.5), "share", 0, 1, was="grid_losses")
    grid_seeds: int = options.option(6, "count", 0, 1000)
    grid_schemes: tuple[str, ...] = options.names(None, teleop_grid.SCHEMES)
    grid_set: dict[str, str] = options.pairs()


def _percent(share: float) -> str:
    """As it stands in the names of cases."""
    return f"{100 * share:g}"


def cases(description: dict, settings: Settings, output: Path) -> list[teleop_runs.Case]:
    wrong = teleop_runs.wrong(description["wrong"]) | settings.keys(description["scene"], description["object"])
    found: list[teleop_runs.Case] = []
    for delay in map(str, settings.delay):
        for share in settings.loss:
            loss = _percent(share)
            common = {"delay_ms": delay, "loss": share, "seconds": settings.seconds}
            common["object"] = description["object"]
            for way, keys in rivals.TRADITIONAL.items():
                found.append({"name": f"{way}.{delay}ms.{loss}pct", **keys, **common})
            found.append({"name": f"thesis_system.{delay}ms.{loss}pct", **rivals.THESIS_SYSTEM, **common, **wrong})
            for correction in CORRECTIONS:
                for derivation in DERIVATIONS if correction != "none" else ("none",):
                    name = f"{correction}.{derivation}.{delay}ms.{loss}pct"
                    one = {"name": name, "correction": correction, "derivation": derivation, **common, **wrong}
                    found.append(one | ({"rows": output / f"{name}.csv"} if name in SHOWN else {}))
    return found


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description("dynamic_mmt")
    if settings.clock == "real":
        from measuring import teleop_processes

        return teleop_processes.dynamic_mmt(description, settings.seconds, output)
    summary: dict[str, object] = _table(description, settings, output) if settings.table else {}
    if settings.variants:
        summary |= _variants(description, settings, output)
    if settings.long:
        summary |= _long_delay(description, output)
    if settings.grid and settings.unmodelled:
        summary |= _unmodelled(description, settings, output)
    if settings.grid:
        summary |= _grid(description, settings, output)
    return summary


def _table(description: dict, settings: Settings, output: Path) -> dict[str, object]:
    found = teleop_runs.run(description["scene"], cases(description, settings, output), output)
    # A model that is never corrected derives nothing: one run stands for all derivations.
    for name in [name for name in found if name.startswith("none.none.")]:
        found |= {name.replace("none.none.", f"none.{derivation}."): found[name] for derivation in DERIVATIONS}
    _write_table(output / "cases.csv", found)
    summary: dict[str, object] = {f"{name}.{key}": found[name][key] for name in sorted(found) for key in FIGURES}
    summary["best"] = best(found)
    if settings.pictures:
        from plots import teleop

        teleop.draw_dynamic(output, SHOWN)
        teleop.draw_schemes(found, CORRECTIONS[1:], DERIVATIONS, output / "schemes.png")
        teleop.draw_delays(found, output / "delays.png")
    return summary


def _variants(description: dict, settings: Settings, output: Path) -> dict[str, object]:
    common: teleop_runs.Case = {"delay_ms": VARIED_AT, "seconds": settings.seconds, "object": description["object"]}
    cases: list[teleop_runs.Case] = []
    for variant, how in description["variants"].items():
        wrong = teleop_runs.wrong(how.get("wrong", {}))
        for scheme in rivals.SCHEMES:
            name = f"{variant}.{scheme}.{VARIED_AT}ms"
            case = {"name": name, **common, **how.get("link", {}), **rivals.with_model(scheme, wrong)}
            cases.append(case | ({"rows": output / f"{name}.csv"} if variant == FIGURE_5_5 else {}))
        cases.append({"name": f"thesis_system.{variant}.{VARIED_AT}ms", **common, **how.get("link", {}), **rivals.THESIS_SYSTEM, **wrong})
    found = teleop_runs.run(description["scene"], cases, output)
    summary: dict[str, object] = {f"{name}.{key}": one[key] for name, one in found.items() for key in FIGURES}
    for scheme in rivals.SCHEMES:
        quiet, noisy = (found[f"{variant}.{scheme}.{VARIED_AT}ms"]["force_error_mean_N"] for variant in ("usual", "pose_noise"))
        summary[f"pose_noise.{scheme}.{VARIED_AT}ms.force_error_over_without_noise"] = noisy / quiet
    if settings.pictures:
        from plots import teleop

        teleop.draw_unsynchronised(output, FIGURE_5_5, float(VARIED_AT))
        teleop.draw_variants(found, tuple(description["variants"]), f"{VARIED_AT}ms", output / "variants.png")
    return summary


def _long_delay(description: dict, output: Path) -> dict[str, object]:
    wrong = teleop_runs.wrong(description["wrong"])
    common: teleop_runs.Case = {"delay_ms": LONG_MS, "seconds": 15.0, "object": description["object"], **wrong}
    cases = [{"name": f"long_delay.{way}.{LONG_MS}ms", **common, **keys} for way, keys in LONG.items()]
    found = teleop_runs.run(description["scene"], cases, output)
    return {f"{name}.{key}": one[key] for name, one in found.items() for key in LONG_FIGURES}


def _unmodelled(description: dict, settings: Settings, output: Path) -> dict[str, object]:
    grid = description["grid"]
    acted = description | {"grid": grid | {"wrong": grid["unmodelled"]}}
    names = teleop_grid.unmodelled(grid, settings.grid_scenes, map(str, settings.grid_delay))
    found = teleop_grid.run(acted, names, teleop_grid.WITH_LOSS, output, settings.grid_set)
    _write_grid(output / "unmodelled.csv", found)
    return teleop_grid.summary(found, "unmodelled.")


def _grid(description: dict, settings: Settings, output: Path) -> dict[str, object]:
    grid = description["grid"]
    scenes, wrongs = settings.grid_scenes, settings.grid_wrong
    schemes = dict.fromkeys([*settings.grid_schemes, "never_corrected"])
    more = settings.grid_set
    delays = list(map(str, settings.grid_delay))
    summary: dict[str, object] = {}
    if settings.grid_seeds:
        drawn = teleop_grid.drawn(settings.grid_seeds)
        unseen = description | {"grid": grid | {"wrong": drawn}}
        found = teleop_grid.run(unseen, teleop_grid.cases(grid, scenes, drawn, delays, "0"), [*schemes, teleop_grid.BOUND], output, more)
        _write_grid(output / "grid_unseen.csv", found)
        summary |= teleop_grid.summary(found, "grid.unseen.")
    for loss in map(_percent, settings.grid_loss):
        names = teleop_grid.cases(grid, scenes, wrongs, delays, loss)
        # With losses, the default is asked against what it has to beat there.
        asked = [*schemes, teleop_grid.BOUND] if loss == "0" else [one for one in schemes if one in teleop_grid.WITH_LOSS]
        found = teleop_grid.run(description, names, asked, output, more)
        prefix = "grid." if loss == "0" else f"grid.loss_{loss}pct."
        _write_grid(output / ("grid.csv" if loss == "0" else f"grid_loss_{loss}pct.csv"), found)
        summary |= teleop_grid.summary(found, prefix)
    return summary


def _write_grid(path: Path, found: teleop_grid.Found) -> None:
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        for scheme, results in found.items():
            for name, figures in results.items():
                keys = sorted(key for key in figures if key != "bins")
                if file.tell() == 0:
                    header = keys
                    writer.writerow(["scheme", "scene", "hand", "wrong", "delay_ms", "loss_pct", "worse", "diverged", *keys])
                verdict = [
                    int(teleop_grid.is_worse(name, figures, found["never_corrected"][name])),
                    int(teleop_grid.has_diverged(figures)),
                ]
                values = (f"{figures[key]:.6g}" if key in figures else "" for key in header)
                writer.writerow([scheme, *name.replace("ms", "").replace("pct", "").split("."), *verdict, *values])


def best(found: dict[str, dict[str, float]]) -> str:
    """At 100 ms without loss: no step that can be felt, then the least force error."""
    candidates = {name: figures for name, figures in found.items() if name.endswith(".100ms.0pct")}
    candidates = {name: figures for name, figures in candidates.items() if name.split(".")[0] in CORRECTIONS[1:]}
    unfelt = {name: one for name, one in candidates.items() if one["correction_force_step_max_N"] <= 0.02}
    among = unfelt or candidates

    def rank(name: str) -> tuple[float, float]:
        # Force errors that differ by less than a thousandth of a newton are equal.
        return round(among[name]["force_error_mean_N"], 3), among[name]["correction_force_step_max_N"]

    return min(among, key=rank) if among else ""


def _write_table(path: Path, found: dict[str, dict[str, float]]) -> None:
    names = sorted({key for figures in found.values() for key in figures})
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["correction", "derivation", "delay_ms", "loss_pct", *names])
        for name in sorted(found):
            *scheme, delay, loss = name.split(".")
            row = [*scheme, *[""] * (2 - len(scheme)), delay.removesuffix("ms"), loss.removesuffix("pct")]
            writer.writerow([*row, *(f"{found[name][key]:.9g}" if key in found[name] else "" for key in names)])
