"""How little has to be said: a deadband on positions, forces and states, both ways, fixed and after Weber.

    ./run experiment data_reduction [--seconds=10] [--delay=100] [--pictures=1]

Cases are WAY.BAND: WAY is mmt (the default, its model 20 % too heavy and 30 % too slippery) or one of measuring/rivals.py,
BAND is none, fixed or weber. Beside the packets and bits each way, against what is really sent at full rate: by how much the
force is another one than with everything said, in newtons and in just-noticeable differences (7 % of the force, at least
0.02 N), over the ticks with a touch, and the share of these ticks in which it is more than one
(noticeable_share_of_touch).
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from measuring import options, rivals, teleop_runs

BANDS: dict[str, teleop_runs.Case] = {  # fmt: skip
    "none": {},
    "fixed": {
        "deadband": 1, "deadband_position": 1e-4, "deadband_speed": 0, "deadband_force": 0.1, "deadband_weber": 0,
    },
    "weber": {
        "deadband": 1, "deadband_position": 3e-5, "deadband_speed": 0.01, "deadband_force": 0.02, "deadband_weber": 0.1,
    },
}
FIGURES = (
    "packets_forth_per_s", "packets_back_per_s", "bits_forth_per_s", "bits_back_per_s", "bytes_per_s",
    "box_position_error_rms_mm", *teleop_runs.FIGURES,
)  # fmt: skip
WEBER, LEAST_NOTICEABLE = 0.07, 0.02


@dataclass(frozen=True)
class Settings:
    seconds: float = options.seconds(10.0)
    delay: float = options.option(100.0, "ms", 0, options.LONGEST_DELAY_MS)
    clock: Literal["virtual"] = "virtual"
    pictures: bool = options.switch(True)


def ways(wrong: teleop_runs.Case) -> dict[str, teleop_runs.Case]:
    # What is never corrected hears nothing that could be saved.
    schemes = [scheme for scheme in rivals.SCHEMES if scheme != "never_corrected"]
    return {"mmt" if scheme == rivals.DEFAULT else scheme: rivals.with_model(scheme, wrong) for scheme in schemes}


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description("dynamic_mmt")
    common: teleop_runs.Case = {"delay_ms": settings.delay, "seconds": settings.seconds, "object": description["object"]}
    asked = ways(teleop_runs.wrong(description["wrong"]))
    cases = [
        {"name": f"{way}.{band}", "rows": output / f"{way}.{band}.csv", **common, **keys, **BANDS[band]}
        for way, keys in asked.items()
        for band in BANDS
    ]
    found = teleop_runs.run(description["scene"], cases, output)
    summary: dict[str, object] = {}
    for name, figures in found.items():
        summary |= {f"{name}.{key}": figures[key] for key in FIGURES}
        way = name.split(".")[0]
        full = found[f"{way}.none"]
        for key in ("forth", "back"):
            summary[f"{name}.fewer_{key}_share"] = 1.0 - figures[f"packets_{key}_per_s"] / full[f"packets_{key}_per_s"]
        summary[f"{name}.fewer_bits_share"] = 1.0 - figures["bits_per_s"] / full["bits_per_s"]
        summary |= {f"{name}.{key}": value for key, value in change(output, f"{way}.none", name).items()}
    if settings.pictures:
        from plots import data_reduction

        data_reduction.draw(summary, tuple(asked), tuple(BANDS), output / "data_reduction.png")
    return summary


def change(folder: Path, full: str, reduced: str) -> dict[str, float]:
    """What the deadband alone does to the force."""
    from plots.teleop import force_error, read

    before, after = read(folder / f"{full}.csv"), read(folder / f"{reduced}.csv")
    off = np.sqrt(sum((after[f"force_{axis}"] - before[f"force_{axis}"]) ** 2 for axis in "xyz"))
    size = np.sqrt(sum(before[f"force_{axis}"] ** 2 for axis in "xyz"))
    touched = size > 0.0
    share = (off / np.maximum(WEBER * size, LEAST_NOTICEABLE))[touched]
    found = {
        "force_change_mean_N": float(off.mean()),
        "force_change_median_jnd": float(np.median(share)),
        "noticeable_share_of_touch": float((share > 1.0).mean()),
        "force_error_added_mean_N": float(force_error(after).mean() - force_error(before).mean()),
    }
    spread = {"mean": share.mean(), "p95": np.quantile(share, 0.95), "p99": np.quantile(share, 0.99), "max": share.max()}
    return found | {f"force_change_{how}_jnd": float(value) for how, value in spread.items()}
