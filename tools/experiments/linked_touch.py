"""One touch over a network, in one way: what a sweep is made of (docs/experiments.md).

    ./run experiment linked_touch [--scene=static|dynamic] [--way=default] [--seconds=10] [--delay=100] [--loss=0]
        [--seed=1] [--hand_shift=0.005] [--set=KEY=VALUE,KEY=VALUE] [--rows=0]
        [--mass=1.2 --friction=0.7 --tilt=1 --moved=0.01 --pose_noise=0.001 --phase=500 --late=50 --jitter=3]

--scene       static: a ground and a sphere. dynamic: a box that is pushed
--way         of measuring/rivals.py; one without a model has none that could be wrong
--delay       there and back (unit: milliseconds)
--loss        of the packets, each way, 0 … 1
--seed        which packets are lost or late, what noise there is, and where the hand goes
--hand_shift  the hand's path is shifted by up to so much along x and z, another way with each seed (unit: meters)
--set         keys of tests/shared/teleop_words.cpp
--rows        1: every tick of it is left as linked_touch.csv
--mass and the others: see Imperfections in measuring/teleop_runs.py

The summary has every figure of the case (tests/shared/teleop_figures.cpp). In virtual time: the same options give the same bits.
"""

import random
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from measuring import options, rivals, teleop_runs

# By the description of the experiment that has the scene.
SCENES = {"static": "static_mmt", "dynamic": "dynamic_mmt"}


@dataclass(frozen=True)
class Settings(teleop_runs.Imperfections):
    scene: Literal["static", "dynamic"] = "dynamic"
    way: Literal[tuple(rivals.SCHEMES)] = rivals.DEFAULT  # type: ignore[valid-type]
    seconds: float = options.seconds(10.0)
    delay: float = options.option(100.0, "ms", 0, options.LONGEST_DELAY_MS)
    loss: float = options.option(0.0, "share", 0, 1)
    seed: int = options.seed()
    hand_shift: float = options.option(0.0, "m", 0, 0.1)
    set: dict[str, str] = options.pairs()
    rows: bool = options.switch(False)


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    settings = options.parse(Settings, given)
    description = teleop_runs.description(SCENES[settings.scene])
    keys = case(description, settings) | ({"rows": output / "linked_touch.csv"} if settings.rows else {})
    (figures,) = teleop_runs.run(description["scene"], [keys], output).values()
    return figures


def case(description: dict, settings: Settings) -> teleop_runs.Case:
    followed = description.get("object")
    keys: teleop_runs.Case = {
        "name": "linked_touch", "seconds": settings.seconds, "delay_ms": settings.delay, "loss": settings.loss, "seed": settings.seed,
    }  # fmt: skip
    keys |= {"object": followed} if followed else {}
    if settings.hand_shift:
        draw = random.Random(f"hand {settings.seed}")
        x, z = (draw.uniform(-settings.hand_shift, settings.hand_shift) for _ in range(2))
        keys["path_shift"] = f"{x},0,{z}"
    keys |= rivals.with_model(settings.way, settings.model(description["scene"], followed)) | settings.link()
    return keys | settings.set
