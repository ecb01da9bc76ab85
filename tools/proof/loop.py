"""When the haptic loop's ticks begin, beside cyclictest, the tool by which real-time Linux is measured: same priority, same
processor, same period, in turns, idle and with both processors kept busy by ordinary processes.

The loop's tick is a hand that pushes boxes about (tests/bench/pacing.cpp, case "touch"). Lateness counts from the deadline
to the first instruction of the tick; cyclictest's latency is the same of a thread that does nothing.
"""

import json
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from os import cpu_count
from pathlib import Path
from shutil import which

import build
import numpy as np
from measuring import host, options
from setup import cache

CASES = ["idle", "loaded"]
MOST_LATE = 20_000  # that is told apart (unit: microseconds)
PRIORITY = 70  # HapticWorld.realtime_priority
LOOPS = {"loop": "haptic loop, a hand among boxes", "cyclictest": "cyclictest"}


@dataclass(frozen=True)
class Settings:
    seconds: float = options.option(10.0, "s", 1)  # of each turn
    rounds: int = options.option(6, "count", 1, 10_000)


def run(cases: list[str], settings: Settings, output: Path) -> dict[str, object]:
    if which("cyclictest") is None:
        raise RuntimeError("cyclictest is missing: install rt-tests")
    build.build("template_release", "build/template_release/bench/pacing")
    figures: dict[str, object] = {}
    for case in cases:
        counts = {loop: np.zeros(0, dtype=np.int64) for loop in LOOPS}
        before = host.processor_times()
        with busy(case == "loaded"):
            for number in range(settings.rounds):
                counts["loop"] = added(counts["loop"], ours(settings, output))
                counts["cyclictest"] = added(counts["cyclictest"], theirs(settings))
                said = ", ".join(f"{loop} p999 {quantile(one, 0.999)} µs" for loop, one in counts.items())
                print(f"{case}, round {number + 1}: {said}", flush=True)
        (output / f"{case}.json").write_text(json.dumps({loop: one.tolist() for loop, one in counts.items()}))
        figures[f"loop.{case}.p999_over_cyclictest"] = quantile(counts["loop"], 0.999) / max(1, quantile(counts["cyclictest"], 0.999))
        figures[f"loop.{case}.steal_share"] = host.steal_share(before, host.processor_times())
        for loop, one in counts.items():
            figures[f"loop.{case}.{loop}_ticks"] = int(one.sum())
            for name, share in {"p50": 0.5, "p99": 0.99, "p999": 0.999, "p9999": 0.9999}.items():
                figures[f"loop.{case}.{loop}_{name}_us"] = quantile(one, share)
            figures[f"loop.{case}.{loop}_most_us"] = int(np.flatnonzero(one)[-1])
    figures |= {f"loop.machine.{key}": value for key, value in host.description().items()}
    draw(output)
    return figures


def totals(figures: dict[str, object]) -> dict[str, object]:
    """The worse of the two."""
    ratios = [value for key, value in figures.items() if key.endswith(".p999_over_cyclictest")]
    return {"loop.p999_over_cyclictest": max(ratios)} if ratios else {}


@contextmanager
def busy(wanted: bool) -> Iterator[None]:
    """Each processor with an ordinary process that never rests."""
    command = [sys.executable, "-c", "while True: pass"]
    loads = [subprocess.Popen(command) for _ in range(cpu_count() or 1)] if wanted else []
    try:
        yield
    finally:
        for load in loads:
            load.kill()
            load.wait()


def ours(settings: Settings, output: Path) -> np.ndarray:
    result = output / "turn.json"
    program = cache.clone() / "build/template_release/bench/pacing"
    command = [program, f"--seconds={round(settings.seconds)}", "--only=touch", "--alone", f"--output={result}"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    figures = json.loads(result.read_text())
    result.unlink()
    return np.array(figures["touch.lateness_counts"])


def theirs(settings: Settings) -> np.ndarray:
    command = [
        "cyclictest", "--quiet", "--mlockall", "--policy=fifo", f"--priority={PRIORITY}", "--interval=1000",
        f"--affinity={(cpu_count() or 1) - 1}", "--threads=1", f"--duration={round(settings.seconds)}", f"--histogram={MOST_LATE}",
    ]  # fmt: skip
    done = subprocess.run(command, check=True, text=True, capture_output=True)
    return read_cyclictest(done.stdout)


def read_cyclictest(text: str) -> np.ndarray:
    """Its histogram, one count for each whole microsecond; what was later than all of them counts as the last."""
    counts = np.zeros(MOST_LATE + 1, dtype=np.int64)
    for late, count in re.findall(r"^(\d{6}) (\d+)\s*$", text, re.M):
        counts[int(late)] += int(count)
    overflows = re.search(r"^# Histogram Overflows: (\d+)", text, re.M)
    counts[MOST_LATE] += int(overflows[1]) if overflows else 0
    if not counts.any():
        raise RuntimeError(f"cyclictest has counted nothing:\n{text[-1000:]}")
    return counts


def added(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    size = max(len(one), len(other))
    return np.pad(one, (0, size - len(one))) + np.pad(other, (0, size - len(other)))


def quantile(counts: np.ndarray, share: float) -> int:
    """The first whole microsecond that so large a share of all does not exceed."""
    return int(np.searchsorted(np.cumsum(counts), share * counts.sum()))


def draw(output: Path) -> Path:
    from plots import style

    looks = {"loop": (style.MEASURED, "-"), "cyclictest": (style.REFERENCE, "--")}
    cases = [case for case in CASES if (output / f"{case}.json").is_file()]
    drawn, axes = style.figure(1, len(cases), 4.6 * len(cases), 3.4)
    for column, case in enumerate(cases):
        every = {loop: np.array(one) for loop, one in json.loads((output / f"{case}.json").read_text()).items()}
        for loop, label in LOOPS.items():
            colour, line = looks[loop]
            late = np.flatnonzero(every[loop])
            shares = every[loop][late] / every[loop].sum()
            axes[0, column].step(late + 0.5, shares, where="mid", label=label, color=colour, linestyle=line)
        axes[0, column].set(
            title=f"Both processors {'busy' if case == 'loaded' else 'idle'}", xscale="log", yscale="log", xlabel="start after the deadline (µs)",
            ylabel="share of ticks",
        )  # fmt: skip
        axes[0, column].legend(fontsize=8)
    style.save(drawn, output / "lateness.png")
    return output / "lateness.png"
