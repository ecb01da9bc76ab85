"""build/report/index.html, one file that needs no other, from what the experiments have left in build/experiments."""

import json
import sys
from pathlib import Path

import report_page as html
from measuring import columns, gain, targets
from setup import cache
from sweeps.results import write_whole

CASES = {"static": "Static scene: ground and a sphere", "dynamic": "Dynamic scene: ground and a box of 0.3 kg"}

FIGURES = {
    "mean_period_us": ("Period, mean", "µs"),
    "tick_period_p50_us": ("Period, median", "µs"),
    "tick_period_p90_us": ("Period, 90 % not longer than", "µs"),
    "tick_period_p99_us": ("Period, 99 %", "µs"),
    "tick_period_p999_us": ("Period, 99.9 %", "µs"),
    "tick_period_max_us": ("Period, longest", "µs"),
    "baseline_period_p90_us": ("Bare loop beside it, 90 %", "µs"),
    "baseline_period_p99_us": ("Bare loop beside it, 99 %", "µs"),
    "baseline_period_p999_us": ("Bare loop beside it, 99.9 %", "µs"),
    "baseline_period_max_us": ("Bare loop beside it, longest", "µs"),
    "tick_compute_p50_us": ("Work of a tick, median", "µs"),
    "tick_compute_p99_us": ("Work of a tick, 99 %", "µs"),
    "tick_compute_max_us": ("Work of a tick, longest", "µs"),
    "missed_deadlines": ("Ticks that ended after the next was due", ""),
    "measured_ticks": ("Ticks", ""),
    "force_mean_n": ("Force, mean", "N"),
    "force_mean_while_touching_n": ("Force, mean while touching", "N"),
    "force_max_n": ("Force, largest", "N"),
    "contact_time_share": ("Share of the time in contact", ""),
    "object_travel_m": ("Where the object ends, from its start", "m"),
    "steal_share": ("Processor time taken by the machine's host", ""),
    "rounds": ("Rounds played", ""),
    "round_reported": ("Round reported: the one with the least taken", ""),
}


def main() -> int:
    place = cache.clone() / "build/experiments"
    if not any(place.glob("*/summary.json")):
        print("nothing to report yet: ./run experiment scenario1", file=sys.stderr)
        return 1
    target = cache.clone() / "build/report/index.html"
    target.parent.mkdir(parents=True, exist_ok=True)
    write_whole(target, page(place))
    print(cache.shown(target))
    return 0


def page(place: Path) -> str:
    """Of every experiment that has left a summary in `place`."""
    found = {path.parent.name: json.loads(path.read_text()) for path in sorted(place.glob("*/summary.json")) if "." not in path.parent.name}
    sections = []
    for name, of_scenario in SCENARIOS.items():
        if name in found:
            sections.append(of_scenario(found[name], place / name))
    sections += [_of_any(name, found[name], place / name) for name in found if name not in SCENARIOS]
    sections += [_machine(found["scenario1"])] if "scenario1" in found else []
    return html.page(
        "Tactus: touch in Godot at 1 kHz",
        "A scripted hand is drawn along the thesis's path through two scenes, in Godot itself. Measured on this machine.",
        sections,
    )


def page_of(name: str, summary: targets.Summary, folder: Path) -> str:
    """Of one experiment, from its figures and the pictures in `folder`."""
    return html.page(name, str(summary.get("about.command", "")), [_of_any(name, summary, folder)])


# Of an experiment that has no section of its own; all of them are in its summary.json.
MOST_FIGURES = 60


def _of_any(name: str, summary: targets.Summary, folder: Path) -> str:
    figures = [(key, value) for key, value in summary.items() if not key.startswith(("about.", "machine."))]
    rows = [(key, _of_key(key, value), columns.meaning(key.rsplit(".", 1)[-1])) for key, value in figures[:MOST_FIGURES]]
    left = len(figures) - len(rows)
    about = ", ".join(str(summary[f"about.{key}"]) for key in ("command", "version", "utc", "machine") if f"about.{key}" in summary)
    return html.section(
        name,
        html.paragraph(about),
        *(html.picture(path, path.stem.replace("_", " ")) for path in sorted(folder.glob("*.png"))),
        html.table(("Figure", "Found", "Meaning"), rows, numbers_from=1),
        *([html.paragraph(f"{left} more figures are in summary.json.")] if left else []),
    )


def _of_key(key: str, value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else "–" if value is None else _plain(value)


def _scenario1(summary: targets.Summary, folder: Path) -> str:
    cases = [case for case in CASES if f"{case}.ticks" in summary]
    parts = []
    if all(f"{case}.mean_period_us" in summary for case in cases):
        verdicts = [verdict for case in cases for verdict in targets.scenario1(summary, case)]
        rows = [(one.case, one.what, one.found, one.wanted, one.met) for one in verdicts]
        parts.append(html.table(("Scene", "Figure", "Found", "Wanted", ""), rows, numbers_from=9))
    parts += _pictures(folder, "periods.png", "Periods of the haptic loop and of a bare loop that sleeps beside it, on the same processor.")
    for case in cases:
        parts.append(html.section(CASES[case], *_case(folder, case), level=3))
    parts.append(html.section("All figures", _figures(summary, cases), level=3))
    return html.section("Scenario 1: a hand and a virtual world", *parts)


def _scenario4(summary: targets.Summary, folder: Path) -> str:
    away = f"{float(summary['static.mmt.round_trip_ms']):.0f} ms"
    return html.section(
        f"Scenario 4: a local model, {away} away",
        html.paragraph(
            "Two Godot processes over UDP: the hand is in one of them, what it touches in the other. Over a network the "
            "direct method sends the device position there and the force back. With a local model, which the teleoperator describes "
            "and corrects, the hand is answered at once. Errors are against direct touch with the same hand."
        ),
        html.table(gain.HEAD, gain.rows(summary)),
        *_pictures(
            folder,
            "static_forces.png",
            "The thesis path over a ground and a sphere. The local model is exact; the force of direct teleoperation is late.",
        ),
        *_pictures(folder, "dynamic_forces.png", "Pushing a box whose model is 20 % too heavy and too slippery, corrected all the time."),
    )


def _timing_networked(summary: targets.Summary, folder: Path) -> str:
    rows = [(one.case, one.what, one.found, one.wanted, one.met) for one in targets.timing_networked(summary)]
    return html.section(
        "Scenarios 2 and 4: how evenly both sides tick",
        html.paragraph(
            "Two Godot processes over UDP on one machine. A period is the time from when a recorded tick really ran to when the "
            "next one did. A bare loop that only sleeps runs beside each side, on the same processor."
        ),
        html.table(("Side", "Figure", "Found", "Wanted", ""), rows, numbers_from=9),
        *_pictures(folder, "both_sides_periods.png", "Periods of both sides and of the bare loops beside them (thesis figure 5.3)."),
    )


SEEN = {
    "discovered_s": ("Until the model has all that is there", "s"),
    "place_error_median_mm": ("Model from the true place, median", "mm"),
    "place_error_p95_mm": ("The same, 95 %", "mm"),
    "force_error_mean_N": ("Force on the hand from that of direct touch, mean", "N"),
    "force_error_over_pose_explained": ("That over what the error of place explains", ""),
    "robot_touches_share": ("Of the time in which the hand touches, the robot does", ""),
    "frame_ms_median": ("From an image to its objects, median", "ms"),
}


def _scenario5(summary: targets.Summary, folder: Path) -> str:
    rows = [
        (name, *(f"{summary[f'{case}.{key}']:.3g} {unit}".strip() for case in ("static", "dynamic")))
        for key, (name, unit) in SEEN.items()
    ]
    return html.section(
        "Scenario 5: a camera makes the model, and a robot follows the hand",
        html.paragraph(
            "Two Godot processes over UDP. On the teleoperator a depth camera looks at an undescribed place. What it "
            "finds is the operator's model, and the robot goes where the hand is. In the dynamic scene the cube is pushed back and forth."
        ),
        html.table(("", "Static", "Dynamic"), rows),
        *_pictures(folder, "static_seen.png", "Depths as the camera has them, with its noise, and the meshes of the library where they were found."),
        *_pictures(folder, "static_forces.png", "The force on the hand, on a hand that touches that place directly, and on the robot."),
        *_pictures(folder, "dynamic_forces.png", "The same while the cube is pushed back and forth."),
    )


def _case(folder: Path, case: str) -> list[str]:
    return [
        *_pictures(folder, f"{case}_scene.png", "The largest force. Blue: the proxy, on the surface; red: the device position, inside; yellow: its path."),
        *_pictures(folder, f"{case}_force.png", "The force on the hand during one turn of the path."),
        *_pictures(folder, f"{case}_object.png", "How the hand moves the box."),
    ]


def _pictures(folder: Path, name: str, caption: str) -> list[str]:
    path = folder / name
    return [html.picture(path, caption)] if path.is_file() else []


def _figures(summary: targets.Summary, cases: list[str]) -> str:
    rows = []
    for key, (name, unit) in FIGURES.items():
        found = [summary.get(f"{case}.{key}") for case in cases]
        if any(value is not None for value in found):
            rows.append((name, *(_number(value, key, unit) for value in found)))
    return html.table(("Figure", *cases), rows)


def _number(value: float | None, key: str, unit: str) -> str:
    if value is None:
        return "–"
    if key.endswith("_share"):
        return f"{value:.2%}"
    if isinstance(value, int) or (unit == "" and float(value).is_integer()):
        return f"{int(value):,}"
    return f"{value:.{ {'µs': 1, 'N': 2, 'm': 3}.get(unit, 2) }f} {unit}".strip()


def _machine(summary: targets.Summary) -> str:
    words = {
        "processor": "Processor", "processors": "Processors", "memory_gib": "Memory (GiB)", "virtual": "Virtual machine",
        "kernel": "Kernel", "system": "System",
    }  # fmt: skip
    rows = [(name, _plain(summary[f"machine.{key}"])) for key, name in words.items() if f"machine.{key}" in summary]
    if "static.realtime" in summary:
        rows.append(("The haptic thread", str(summary["static.realtime"])))
    return html.section("The machine", html.table(("", ""), rows, numbers_from=9))


def _plain(value: object) -> str:
    return {True: "yes", False: "no"}[value] if isinstance(value, bool) else str(value)


# The experiments that have a section of their own, in this order.
SCENARIOS = {"scenario1": _scenario1, "timing_networked": _timing_networked, "scenario4": _scenario4, "scenario5": _scenario5}


if __name__ == "__main__":
    sys.exit(main())
