"""Hours of virtual time in which everything of a scene comes and goes: does the program's memory stay as it is?

tests/proof/soak.gd plays them. Growth is what the memory of the last quarter is above that of the second, by their medians:
in the first, pools and caches fill.
"""

import json
import os
import re
import statistics
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import build
from measuring import options
from project import FOLDER
from setup import cache, godot
from testing import godot_suite

CASES = ["churn"]


@dataclass(frozen=True)
class Settings:
    hours: float = options.option(8.0, "h", 0.001, 10_000)  # of virtual time


def run(_: list[str], settings: Settings, output: Path) -> dict[str, object]:
    build.build("template_debug", "extension")
    began = time.monotonic()
    environment = os.environ | {"TACTUS_PROOF_HOURS": f"{settings.hours:g}"}
    runner, script = cache.clone() / "tests/godot/run_tests.gd", cache.clone() / "tests/proof/soak.gd"
    command = [str(godot.command()), "--headless", "--path", str(FOLDER), "--script", str(runner), "--", str(script)]
    log = output / "said.txt"
    with log.open("w") as said:
        code = subprocess.run(command, env=environment, stdout=said, stderr=subprocess.STDOUT).returncode
    samples = [json.loads(line) for line in re.findall(r"^SAMPLE (.*)$", log.read_text(), re.M)]
    (output / "samples.json").write_text(json.dumps(samples))
    why = "; ".join(filter(None, godot_suite.judge(log.read_text(), ["test_memory_stays_flat"]).values()))
    if code != 0 or why or len(samples) < 4:
        raise RuntimeError(f"the churn did not come to its end ({code}): {why or log.read_text()[-2000:]}")
    draw(samples, output / "memory.png")
    figures = judge(samples) | {"soak.seconds": time.monotonic() - began}
    print(f"memory {figures['soak.growth_mb']:+.2f} MB in {figures['soak.hours']:.2f} virtual hours", flush=True)
    return figures


def judge(samples: list[dict]) -> dict[str, object]:
    quarter = max(1, len(samples) // 4)
    second, last = samples[quarter : 2 * quarter], samples[-quarter:]

    def growth(name: str) -> float:
        return statistics.median(one[name] for one in last) - statistics.median(one[name] for one in second)

    return {
        "soak.growth_mb": growth("resident_mb"),
        "soak.memory_mb": samples[-1]["resident_mb"],
        "soak.files_growth": growth("files"),
        "soak.threads_growth": growth("threads"),
        "soak.objects_growth": growth("objects"),
        "soak.hours": samples[-1]["time"] / 3600,
        "soak.ticks": samples[-1]["ticks"],
        "soak.changes": sum(samples[-1]["changes"].values()),
        **{f"soak.changes_of_{name}": count for name, count in samples[-1]["changes"].items()},
        **{f"soak.{name}_pressed_frames": count for name, count in samples[-1]["pressed"].items()},
    }


def draw(samples: list[dict], path: Path) -> None:
    from plots import style

    drawn, axes = style.figure(1, 1, 7.0, 3.0)
    hours = [one["time"] / 3600 for one in samples]
    axes[0, 0].plot(hours, [one["resident_mb"] for one in samples], color=style.MEASURED)
    axes[0, 0].set(xlabel="virtual time (h)", ylabel="memory in use (MB)", ylim=(0, None), title="Bodies, devices and links come and go")
    style.save(drawn, path)
