"""The grid of dynamic_mmt: models that are wrong in every way, scenes, hands and delays, each with every scheme.

A case is SCENE.HAND.WRONG.DELAYms.LOSSpct. What does not depend on the delay, the loss or the model is run once.
"""

import math
import random
from collections.abc import Iterable
from pathlib import Path

from measuring import teleop_runs
from measuring.rivals import SCHEMES
from measuring.teleop_scene import Scene

# What is left to any way: never corrected, of a model that was described right where one can look, and right itself one
# delay after its first mistake has shown (assume_known in tests/shared/teleop_figures.cpp).
BOUND = "bound"
BOUND_FIGURES = (
    "force_error_over_never_corrected_median", "force_error_over_never_corrected_p95", "felt_excess_100ms_jnd_p99",
    "felt_excess_100ms_N_p99", "felt_excess_100ms_N_max",
)  # fmt: skip
WITH_LOSS = ("default", "never_corrected", "traditional")
HANDS: dict[str, teleop_runs.Case] = {"scripted": {}, "arm": {"arm": 1}}
# Mean force errors that differ by less are equal (newtons): a twentieth of the least force that is noticed.
SAME_FORCE = 1e-3
# Places that differ by less are equal (millimetres).
SAME_PLACE = 0.01
# A body farther from where it is than its own edge is long has nothing to do with it any more (millimetres).
DIVERGED_MM = 150.0
# It is lost where it is so far off for longer than the delay there and back and this (seconds): a state has come since, and
# has not brought it back. What no side is told of moves a body 0.2 m within a delay of 200 ms at 1 m/s, whatever corrects it.
LOST_S = 0.1
# A right model whose sides are not synchronised (thesis figure 5.5) is judged by where its bodies are: its force is that
# of a right model as long as nothing corrects it.
BY_PLACE = "unsynchronised"
NOISY = {"usual_noise": "usual"}

# Of the scene alone: keys that act on its bodies, or hang them, and that no model is told of.
UNMODELLED = ("acts.", "hinge.")

Found = dict[str, dict[str, dict]]  # by scheme, by case


def cases(grid: dict, scenes: Iterable[str], wrongs: Iterable[str], delays: Iterable[str], loss: str) -> list[str]:
    return [
        f"{scene}.{hand}.{wrong}.{delay}ms.{loss}pct"
        for scene in scenes
        for hand in HANDS
        for wrong in wrongs
        for delay in delays
    ]


def unmodelled(grid: dict, scenes: Iterable[str], delays: Iterable[str]) -> list[str]:
    """What else acts, in every scene; a body that hangs on a hinge that is known is not hung there again."""
    kinds, delays = grid["unmodelled"], list(delays)
    return [
        name
        for scene in scenes
        for kind, how in kinds.items()
        if not any(key.removeprefix("hinge.") in grid["scenes"][scene].get("hinges", {}) for key in how)
        for name in cases(grid, [scene], [kind], delays, "0")
    ]


def drawn(count: int) -> dict[str, dict]:
    """Wrong models that nothing has been tuned on: each seed's own mistakes, under a hand that comes another way."""
    wrongs: dict[str, dict] = {}
    for seed in range(1, count + 1):
        draw = random.Random(f"grid {seed}")
        mass, friction = (3 ** draw.uniform(-1, 1) for _ in range(2))
        moved, tilt = draw.uniform(-0.05, 0.05), draw.uniform(-5, 5)
        x, z = (draw.uniform(-0.005, 0.005) for _ in range(2))
        wrong: dict[str, object] = {"mass": mass, "friction": friction, "path_shift": f"{x},0,{z}"}
        # Each second one stands elsewhere, each third one on another slope.
        wrongs[f"seed_{seed}"] = wrong | ({"moved": moved} if seed % 2 == 0 else {}) | ({"tilt": tilt} if seed % 3 == 0 else {})
    return wrongs


def run(description: dict, names: list[str], schemes: Iterable[str], output: Path, more: teleop_runs.Case) -> Found:
    """`more`: keys of tests/bench/teleop.cpp for the default scheme, to try something out."""
    found: Found = {scheme: {} for scheme in schemes}
    for scene in dict.fromkeys(name.split(".")[0] for name in names):
        unique: dict[tuple, teleop_runs.Case] = {}
        wanted: dict[tuple[str, str], str] = {}
        for name in (name for name in names if name.startswith(f"{scene}.")):
            for scheme in found:
                keys = _keys(description, name, scheme) | (more if scheme == "default" else {})
                case = unique.setdefault(tuple(sorted(keys.items())), {"name": f"{scheme}:{name}", **keys})
                wanted[scheme, name] = str(case["name"])
        variation = description["grid"]["scenes"][scene]
        lines = Scene(description["scene"]).varied(variation)
        results = teleop_runs.run(description["scene"], list(unique.values()), output, bins=True, lines=lines)
        for (scheme, name), case in wanted.items():
            found[scheme][name] = results[case]
    return found


def _keys(description: dict, name: str, scheme: str) -> teleop_runs.Case:
    scene, hand, wrong, delay, loss = name.split(".")
    keys: teleop_runs.Case = {"object": description["object"], "seconds": description["grid"]["seconds"]}
    keys |= HANDS[hand] | SCHEMES["never_corrected" if scheme == BOUND else scheme]
    how = dict(description["grid"]["wrong"][wrong])
    if "path_shift" in how:
        keys["path_shift"] = how.pop("path_shift")
    keys |= {key: how.pop(key) for key in list(how) if key.startswith(UNMODELLED)}
    if scheme == BOUND:
        how = {key: value for key, value in how.items() if key in ("mass", "friction")}
        return keys | _wrong(description, scene, how) | {"known_after_ms": delay.removesuffix("ms")}
    link = {key: how.pop(key) for key in ("pose_noise", "phase_us", "late_ms", "jitter_ms") if key in how}
    if scheme != "never_corrected" or wrong == BY_PLACE:
        # What is never corrected hears nothing; where its bodies should be is judged without a delay.
        keys |= link | {"delay_ms": delay.removesuffix("ms"), "loss": float(loss.removesuffix("pct")) / 100}
    if not scheme.startswith("traditional"):
        keys |= _wrong(description, scene, how)
    return keys


def _wrong(description: dict, scene: str, how: dict[str, float]) -> teleop_runs.Case:
    variation = description["grid"]["scenes"][scene]
    hinged = variation.get("hinges", {})
    moving = [*Scene(description["scene"]).dynamic(), *variation.get("copies", {})]
    resting = [body for body in Scene(description["scene"]).bodies() if body not in moving]
    keys: teleop_runs.Case = {}
    for body in moving:
        if "mass" in how:
            keys[f"wrong.{body}.mass"] = how["mass"]
        if "moved" in how and body in hinged:
            # As far along its own way: about the hinge.
            centre, at = (Scene(description["scene"]).place(body), hinged[body]["at"])
            keys[f"wrong.{body}.swing"] = math.degrees(how["moved"] / math.dist(centre, at))
        elif "moved" in how:
            keys[f"wrong.{body}.move"] = f"{how['moved']},0,0"
    for body in (*moving, *resting):
        if "friction" in how:
            keys[f"wrong.{body}.friction"] = how["friction"]
    for body in resting:
        if "tilt" in how:
            keys[f"wrong.{body}.turn"] = f"1,0,0,{how['tilt']}"
    return keys


def summary(found: Found, prefix: str) -> dict[str, object]:
    """The keys of every scheme behind `prefix`: the default's as they are, the others' with their names before them."""
    result: dict[str, object] = {f"{prefix}worse_than_never_corrected_tolerance_N": SAME_FORCE}
    for scheme, results in found.items():
        start = prefix if scheme == "default" else f"{prefix}{scheme}."
        all_figures = figures(results, found["never_corrected"])
        result |= {f"{start}{key}": all_figures[key] for key in (BOUND_FIGURES if scheme == BOUND else all_figures)}
    return result


def figures(results: dict[str, dict], never: dict[str, dict]) -> dict[str, object]:
    worse = [name for name in results if is_worse(name, results[name], never[name])]
    ratios = [
        results[name]["force_error_mean_N"] / never[name]["force_error_mean_N"]
        for name in results
        if never[name]["force_error_mean_N"] > 5.0 * SAME_FORCE and name.split(".")[2] != BY_PLACE
    ]
    found: dict[str, object] = {
        "cases": len(results),
        "worse_than_never_corrected": len(worse),
        "worse_by_most": max(worse, key=lambda n: results[n]["force_error_mean_N"] - never[n]["force_error_mean_N"], default=""),
        "diverged": sum(has_diverged(one) for one in results.values()),
        "lost": sum(is_lost(name, one) for name, one in results.items()),
        "force_error_over_never_corrected_median": percentile(ratios, 0.5),
        "force_error_over_never_corrected_p95": percentile(ratios, 0.95),
        "force_error_over_never_corrected_max": max(ratios, default=0.0),
        "force_error_mean_N": _mean(one["force_error_mean_N"] for one in results.values()),
        "box_position_error_rms_median_mm": percentile([one["box_position_error_rms_mm"] for one in results.values()], 0.5),
        "energy_at_hand_max_J": max(one["energy_at_hand_J"] for one in results.values()),
        "energy_created_max_J": max(one["energy_created_J"] for one in results.values()),
        "bits_per_s": _mean(one["bits_per_s"] for one in results.values()),
        "let_go_share": _mean(one["let_go_ticks"] > 0 for one in results.values()),
    }
    for key in ("felt_excess_1ms_jnd", "felt_excess_1ms_N", "felt_excess_100ms_jnd", "felt_excess_100ms_N"):
        pooled = pool(one["bins"][key] for one in results.values())
        found[f"{key}_mean"] = _mean(one[f"{key}_mean"] for one in results.values())
        found[f"{key}_p95"] = pooled_percentile(pooled, 0.95)
        found[f"{key}_p99"] = pooled_percentile(pooled, 0.99)
        found[f"{key}_max"] = max(one[f"{key}_max"] for one in results.values())
    if noisy := _noise_ratios(results):
        found["force_error_with_pose_noise_over_without_median"] = percentile(noisy, 0.5)
        found["force_error_with_pose_noise_over_without_max"] = max(noisy)
    adrift = [one["box_position_error_final_mm"] for name, one in results.items() if name.split(".")[2] == BY_PLACE]
    if adrift:
        found["unsynchronised.box_position_error_final_median_mm"] = percentile(adrift, 0.5)
        found["unsynchronised.box_position_error_final_max_mm"] = max(adrift)
    return found


def _noise_ratios(results: dict[str, dict]) -> list[float]:
    """Force errors with noise over those without. The bound may have none."""
    noisy = [(name, wrong) for name in results if (wrong := name.split(".")[2]) in NOISY]
    pairs = [(results[name], results.get(name.replace(f".{wrong}.", f".{NOISY[wrong]}."))) for name, wrong in noisy]
    errors = [(one["force_error_mean_N"], without["force_error_mean_N"]) for one, without in pairs if without is not None]
    return [error / without for error, without in errors if without > 0.0]


def is_worse(name: str, one: dict[str, float], never: dict[str, float]) -> bool:
    if name.split(".")[2] == BY_PLACE:
        return one["box_position_error_rms_mm"] > never["box_position_error_rms_mm"] + SAME_PLACE
    return not one["force_error_mean_N"] <= never["force_error_mean_N"] + SAME_FORCE


def has_diverged(one: dict[str, float]) -> bool:
    return not (one["box_position_error_max_mm"] <= DIVERGED_MM and math.isfinite(one["force_error_mean_N"]))


def is_lost(name: str, one: dict[str, float]) -> bool:
    delay = float(name.split(".")[3].removesuffix("ms")) / 1e3
    return not one["box_lost_longest_s"] <= delay + LOST_S


def percentile(values: list[float], share: float) -> float:
    return sorted(values)[round(share * (len(values) - 1))] if values else 0.0


def pool(bins: Iterable[dict[str, int]]) -> dict[int, int]:
    pooled: dict[int, int] = {}
    for one in bins:
        for place, count in one.items():
            pooled[int(place)] = pooled.get(int(place), 0) + count
    return pooled


def pooled_percentile(pooled: dict[int, int], share: float) -> float:
    """The upper end of the bin (tests/shared/teleop_figures.hpp): at most 2.4 % too large."""
    left = share * sum(pooled.values())
    for place in sorted(pooled):
        left -= pooled[place]
        if left <= 0:
            return 10 ** ((place + 1) / 100)
    return 0.0


def _mean(values: Iterable[float]) -> float:
    listed = list(values)
    return sum(listed) / len(listed) if listed else 0.0
