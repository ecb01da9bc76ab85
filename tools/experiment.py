"""./run experiment NAME [--key=value …]: calls run(options, output) of tools/experiments/NAME.py.
./run experiment SWEEPFILE [--cluster=ADDRESS] [--workers=N]: plays many of them (sweeps/command.py).
./run experiment BUNDLE: plays one again that has left its inputs (measuring/bundles.py).

`options` holds the keys and values as text, which have been checked; what run leaves in the folder `output` becomes
build/experiments/NAME when it is whole, NAME_real where an experiment in virtual time is asked for real time. run returns
the flat summary, which is written to summary.json there. The exit code is 2 where the command was refused.
"""

import importlib
import json
import math
import sys
from collections.abc import Callable
from datetime import datetime, timezone
from pathlib import Path
from types import ModuleType

import entry
import replay
import report
from measuring import bundles, columns, host, made_by, options, outputs
from setup import cache
from sweeps import command as sweep
from sweeps import description, sources

# Significant ones of a figure: another program that computes it from the same rows finds them all.
DIGITS = 12


def names() -> list[str]:
    return sorted(path.stem for path in (cache.clone() / "tools/experiments").glob("[!_]*.py"))


def main(arguments: list[str]) -> int:
    is_sweep = bool(arguments) and arguments[0].endswith(description.ENDINGS)
    if len(arguments) == 1 and arguments[0] not in names() and replay.is_bundle(Path(arguments[0])):
        bundle = Path(arguments[0]).resolve()
        return _carry_out(f"{bundle.name}_again", lambda output: bundles.run(bundle, output))
    if not arguments or not (is_sweep or arguments[0] in names()):
        print(f"./run experiment NAME [--key=value …], where NAME is one of: {', '.join(names())}", file=sys.stderr)
        print("./run experiment SWEEPFILE [--cluster=ADDRESS] [--workers=N], where SWEEPFILE ends in .toml or .json", file=sys.stderr)
        print("./run experiment BUNDLE, where BUNDLE is a folder that an experiment has left", file=sys.stderr)
        return 2
    name, *rest = arguments
    given = options.of_words(rest)
    if is_sweep:
        return sweep.run(Path(name), given, names())
    experiment = importlib.import_module(f"experiments.{name}")
    settings = options.parse(experiment.Settings, given)
    folder = f"{name}_real" if _leaves_virtual_time(experiment, given) else name
    asked = {"about.options": options.words(settings)}  # with those that were not given, such as the seed
    return _carry_out(folder, lambda output: asked | experiment.run(given, output))


def _carry_out(name: str, run: Callable[[Path], dict[str, object]]) -> int:
    place = cache.clone() / "build/experiments"
    with outputs.output(place, name) as output:
        try:
            summary = {**citation(), **{key: printed(value) for key, value in run(output.folder).items()}}
            (output.folder / "summary.json").write_text(json.dumps(summary, indent=2, allow_nan=False) + "\n")
            columns.write(output.folder)
            (output.folder / "report.html").write_text(report.page_of(name, summary, output.folder))
            folder = output.keep()
        except (RuntimeError, ValueError, OSError) as error:
            if not isinstance(error, options.Refused):
                print(f"Not whole: {output.folder} is what there is of it. The results of before are as they were.", file=sys.stderr)
            raise
    print(cache.shown(folder / "summary.json"))
    return 0


def citation() -> dict[str, str]:
    """What a figure is cited with: the version, what was asked, when and where."""
    machine = host.description()
    return {
        "about.version": f"Tactus {made_by.version()} ({made_by.commit()})",
        "about.sources": sources.digest(),
        "about.command": " ".join(["./run", "experiment", *sys.argv[1:]]),
        "about.utc": datetime.now(timezone.utc).isoformat(timespec="seconds"),
        "about.machine": f"{machine['processor']}, {machine['system']}, {machine['kernel']}",
    }


def printed(value: object) -> object:
    """As it stands in a summary: JSON has no word for what is no number, and the order of a sum decides the last digits."""
    if not isinstance(value, float):
        return value
    return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None


def _leaves_virtual_time(experiment: ModuleType, given: dict[str, str]) -> bool:
    """Asked to run in real time, where virtual time is the rule."""
    return given.get("clock") == "real" and getattr(experiment.Settings, "clock", "real") == "virtual"


if __name__ == "__main__":
    entry.leave(main)
