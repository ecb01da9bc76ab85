"""Touch of what does not move, over a network: traditional touch and a local model, right and wrong (thesis 5.3).

    ./run experiment static_mmt [--turns=3] [--seconds=10] [--clock=virtual|real] [--pictures=1]
        [--mass=1.2 --friction=0.7 --tilt=10 --moved=0.01 --pose_noise=0.001 --phase=500 --late=50 --jitter=3]

--turns    of the thesis path, 10 s each
--seconds  of the other path
--clock    virtual: one process, the same figures on every run. real: two Godot processes over UDP
--mass and the others make every model worse, the right one, too; see Imperfections in measuring/teleop_runs.py

Every key begins with the name of a path. thesis_path is the thesis's own path in a scene made for it: a ground under the whole
circle, and a sphere on it (section 5.1, figure 5.1 a). waves is faster, on a smaller circle in a smaller scene. The wrong model
has its ground tilted by 10 degrees, and its sphere where the hand meets it earlier. mmt_wrong is never corrected,
mmt_wrong_corrected from the first touch on, mmt_wrong_told from the start, as the link does by itself.

PATH.BODY_contact_share is the share of ticks in which direct touch has that body in contact.
thesis_path.CASE.force_error_last_turn_over_first is the mean force error of the last turn over that of the first (inference 7:
the error does not grow); 1 where both are 0.

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
# There and back (milliseconds): the thesis's static claim reaches to 5 s (section 3.1.2).
DELAYS = (0, 100, 500, 1000, 2000, 5000)
SHARES = ("0.125", "0.25", "0.5", "1", "2", "4", "8", "16")


@dataclass(frozen=True)
class Settings(teleop_runs.Imperfections):
    turns: int = options.option(3, "count", 1, 1000)
    seconds: float = options.seconds(10.0)
    clock: Literal["virtual", "real"] = "virtual"
    pictures: bool = options.switch(True)


@dataclass(frozen=True)
class Place:
    """A path of the hand, and what it goes through."""

    name: str
    scene: str
    path: str  # a resource
    wrong: dict[str, dict]  # of the model, by body
    turn_s: float  # one turn of the path; 0: its turns are not compared
    seconds: float


def places(description: dict, settings: Settings) -> list[Place]:
    found = []
    for name, how in description["paths"].items():
        turn = how.get("turn_s", 0.0)
        seconds = settings.turns * turn if turn else settings.seconds
        scene, wrong = (how.get(key, description[key]) for key in ("scene", "wrong"))
        found.append(Place(name, scene, how["path"], wrong, turn, seconds))
    return found


def cases(place: Place, settings: Settings, output: Path) -> list[teleop_runs.Case]:
    wrong = teleop_runs.wrong(place.wrong)
    corrected = {"delay_ms": 100, "correct_from_touch": 1, **wrong}
    found: list[teleop_runs.Case] = [
        {"name": f"traditional_{delay}ms", "traditional": 1, "delay_ms": delay} for delay in (0, 100)
    ]
    found += [
        {"name": f"{way}_100ms", **keys, "delay_ms": 100} for way, keys in rivals.TRADITIONAL.items() if way != "traditional"
    ]
    for delay in DELAYS:
        found.append({"name": f"mmt_right_{delay}ms", "delay_ms": delay})
    for delay in DELAYS:
        found.append({"name": f"mmt_wrong_{delay}ms", "delay_ms": delay, "correction": "none", **wrong})
    found.append({"name": CORRECTED, **corrected})
    found.append({"name": TOLD, "delay_ms": 100, **wrong})
    for suffix, scheme in (("pose", "pose_only"), ("velocities", "velocities"), ("passive_updates", "passive_updates")):
        found.append({"name": f"{CORRECTED}_{suffix}", **rivals.SCHEMES[scheme], **corrected})
        found.append({"name": f"mmt_right_{suffix}_100ms", "delay_ms": 100, **rivals.SCHEMES[scheme]})
    for case in found:
        case["rows"] = output / f"{place.name}.{case['name']}.csv"
    worse = settings.keys(place.scene)
    return [case | worse | {"seconds": place.seconds} for case in found]


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description("static_mmt")
    if settings.clock == "real":
        from measuring import teleop_processes

        return teleop_processes.static_mmt(places(description, settings), DELAYS, output)
    summary: dict[str, object] = {}
    for place in places(description, settings):
        lines = Scene(place.scene).along(place.path)
        found = teleop_runs.run(place.scene, cases(place, settings, output), output, lines=lines)
        summary |= {f"{place.name}.{key}": value for key, value in (figures(found, place) | growth(found, place, output)).items()}
    summary |= trade(description, settings, output)
    if settings.pictures:
        from plots import static_mmt

        for place in places(description, settings):
            static_mmt.draw(output, place.name, place.turn_s or 5.0)
        static_mmt.draw_trade(summary, "held", SHARES, TRADING, output / "trade.png")
    return summary


def trade(description: dict, settings: Settings, output: Path) -> dict[str, object]:
    from plots.teleop import force_error, read

    scene, summary = description["scene"], {}
    for path, how in description["trade"].items():
        lines = Scene(scene).varied(how) if "path" in how else Scene(scene).along(description["paths"][path]["path"])
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


def growth(found: dict[str, dict[str, float]], place: Place, output: Path) -> dict[str, object]:
    """The mean force error of the last turn over that of the first."""
    from plots.teleop import force_error, read

    if not place.turn_s or place.seconds < 2 * place.turn_s:
        return {}
    turn, summary = round(1e3 * place.turn_s), {}
    for name in found:
        error = force_error(read(output / f"{place.name}.{name}.csv"))
        first, last = float(error[:turn].mean()), float(error[-turn:].mean())
        summary[f"{name}.force_error_last_turn_over_first"] = last / first if first else float(last == first)
    return summary


def figures(found: dict[str, dict[str, float]], place: Place) -> dict[str, object]:
    share = "_contact_share"
    right = found["mmt_right_0ms"]
    summary: dict[str, object] = {f"{body.lower()}{share}": right[f"{body}{share}"] for body in Scene(place.scene).bodies()}
    for name, one in found.items():
        summary |= {f"{name}.{key}": one[key] for key in FIGURES}
    traditional = found["traditional_100ms"]["force_error_mean_N"]
    for case in (f"mmt_wrong_{delay}ms" for delay in DELAYS):
        summary[f"{case}.over_traditional_100ms"] = found[case]["force_error_mean_N"] / traditional
    return summary
