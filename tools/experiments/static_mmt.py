"""Touch of what does not move, over a network: traditional touch and a local model, right and wrong (thesis 5.3).

    ./run experiment static_mmt [--seconds=10] [--clock=virtual|real] [--pictures=1]
        [--mass=1.2 --friction=0.7 --tilt=10 --moved=0.01 --pose_noise=0.001 --phase=500 --late=50 --jitter=3]

--clock   virtual: one process, the same figures on every run. real: two Godot processes over UDP
--mass and the others make every model worse, the right one, too; see Imperfections in measuring/teleop_runs.py

Two paths of the hand, and every key behind the name of its path: thesis_path is the thesis's own (5 waves in a turn of 10 s,
section 5.1), waves a fast one (20 waves on a smaller circle). mmt_wrong is never corrected, mmt_wrong_corrected from the
first touch on, mmt_wrong_told from the start, as the link does by itself.

A model that is put right under a pressing hand is paid for with what is felt of it or with time: PATH.trade.SHARE.* is the
same correction with the share of a just-noticeable difference that may be spent in 100 ms, from careful to careless, and
PATH.trade.WAY.* that of others. The truth comes while both model and truth are pressed: in the fifth wave, or (held) while
the hand presses with 2.5 N and slides slowly. seconds_from_told_until_right counts from then, until the force error stays
below 0.02 N; felt_excess_once_told_100ms leaves out what was felt before.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from measuring import options, rivals, teleop_runs
from measuring.teleop_scene import Scene

FIGURES = (
    *teleop_runs.FIGURES, "force_error_shifted_mean_N", "seconds_until_right", "correction_force_step_max_N",
    "felt_excess_once_told_100ms_N_max", "felt_excess_once_told_100ms_jnd_max",
)  # fmt: skip
TRADE = (
    "felt_excess_once_told_100ms_N_max", "felt_excess_once_told_100ms_jnd_max", "felt_excess_1ms_N_max", "force_error_mean_N",
    "energy_created_J",
)  # fmt: skip
TRADING = ("default", "pose_only", "velocities", "passive_updates")
# A force that is off by less is right (newtons).
RIGHT = 0.02
CORRECTED = "mmt_wrong_corrected_100ms"
# From the start: the model is right before it is touched.
TOLD = "mmt_wrong_told_100ms"
SHARES = ("0.125", "0.25", "0.5", "1", "2", "4", "8", "16")


@dataclass(frozen=True)
class Settings(teleop_runs.Imperfections):
    seconds: float = options.seconds(10.0)
    clock: Literal["virtual", "real"] = "virtual"
    pictures: bool = options.switch(True)


def cases(description: dict, path: str, settings: Settings, output: Path) -> list[teleop_runs.Case]:
    wrong = teleop_runs.wrong(description["wrong"])
    corrected = {"delay_ms": 100, "correct_from_touch": 1, **wrong}
    found: list[teleop_runs.Case] = [
        {"name": f"traditional_{delay}ms", "traditional": 1, "delay_ms": delay} for delay in (0, 100)
    ]
    found += [
        {"name": f"{way}_100ms", **keys, "delay_ms": 100} for way, keys in rivals.TRADITIONAL.items() if way != "traditional"
    ]
    for delay in (0, 100, 500):
        found.append({"name": f"mmt_right_{delay}ms", "delay_ms": delay})
    for delay in (0, 100, 500):
        found.append({"name": f"mmt_wrong_{delay}ms", "delay_ms": delay, "correction": "none", **wrong})
    found.append({"name": CORRECTED, **corrected})
    found.append({"name": TOLD, "delay_ms": 100, **wrong})
    for suffix, scheme in (("pose", "pose_only"), ("velocities", "velocities"), ("passive_updates", "passive_updates")):
        found.append({"name": f"{CORRECTED}_{suffix}", **rivals.SCHEMES[scheme], **corrected})
        found.append({"name": f"mmt_right_{suffix}_100ms", "delay_ms": 100, **rivals.SCHEMES[scheme]})
    for case in found:
        case["rows"] = output / f"{path}.{case['name']}.csv"
    worse = settings.keys(description["scene"])
    return [case | worse | {"seconds": settings.seconds} for case in found]


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description("static_mmt")
    if settings.clock == "real":
        from measuring import teleop_processes

        return teleop_processes.static_mmt(description, settings.seconds, output)
    summary: dict[str, object] = {}
    scene = description["scene"]
    for path, resource in description["paths"].items():
        lines = Scene(scene).along(resource)
        found = teleop_runs.run(scene, cases(description, path, settings, output), output, lines=lines)
        summary |= {f"{path}.{key}": value for key, value in figures(found).items()}
    summary |= trade(description, settings, output)
    if settings.pictures:
        from plots import static_mmt

        for path in description["paths"]:
            static_mmt.draw(output, path)
        static_mmt.draw_trade(summary, "held", SHARES, TRADING, output / "trade.png")
    return summary


def trade(description: dict, settings: Settings, output: Path) -> dict[str, object]:
    from plots.teleop import force_error, read

    scene, summary = description["scene"], {}
    for path, how in description["trade"].items():
        lines = Scene(scene).varied(how) if "path" in how else Scene(scene).along(description["paths"][path])
        common = {"delay_ms": 100, "seconds": how["seconds"], "event.0": f"{how['told_at']},correct"}
        common |= teleop_runs.wrong(description["wrong"]) | settings.keys(scene)
        asked = {share: {"share": share} for share in SHARES} | {way: rivals.SCHEMES[way] for way in TRADING}
        cases = [{"name": name, "rows": output / f"{path}.trade.{name}.csv", **common, **keys} for name, keys in asked.items()]
        for name, one in teleop_runs.run(scene, cases, output, lines=lines).items():
            rows = read(output / f"{path}.trade.{name}.csv")
            last = rows["time"][force_error(rows) > RIGHT].max(initial=how["told_at"])
            summary |= {f"{path}.trade.{name}.{key}": one[key] for key in TRADE}
            summary[f"{path}.trade.{name}.seconds_from_told_until_right"] = float(last) - how["told_at"]
    return summary


def figures(found: dict[str, dict[str, float]]) -> dict[str, object]:
    summary: dict[str, object] = {}
    for name, one in found.items():
        summary |= {f"{name}.{key}": one[key] for key in FIGURES}
    traditional = found["traditional_100ms"]["force_error_mean_N"]
    for case in ("mmt_wrong_0ms", "mmt_wrong_100ms", "mmt_wrong_500ms"):
        summary[f"{case}.over_traditional_100ms"] = found[case]["force_error_mean_N"] / traditional
    return summary
