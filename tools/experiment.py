"""./run experiment NAME [--key=value …]: calls run(options, output) of tools/experiments/NAME.py.
./run experiment SWEEPFILE [--cluster=ADDRESS] [--workers=N]: plays many of them (sweeps/command.py).
./run experiment BUNDLE: plays one again that has left its inputs (measuring/bundles.py).

`options` holds the keys and values as text, `output` is build/experiments/NAME, emptied before; NAME_real where an
experiment in virtual time is asked for real time. run returns the flat summary, which is written to summary.json there.
"""

import importlib
import json
import sys
from pathlib import Path
from types import ModuleType

import entry
import replay
from measuring import bundles
from setup import cache
from sweeps import command as sweep
from sweeps import description


def names() -> list[str]:
    return sorted(path.stem for path in (cache.clone() / "tools/experiments").glob("[!_]*.py"))


def main(arguments: list[str]) -> int:
    is_sweep = bool(arguments) and arguments[0].endswith(description.ENDINGS)
    if len(arguments) == 1 and arguments[0] not in names() and replay.is_bundle(Path(arguments[0])):
        bundle = Path(arguments[0]).resolve()
        output = cache.emptied(cache.clone() / "build/experiments" / f"{bundle.name}_again")
        return _write_summary(bundles.run(bundle, output), output)
    if not arguments or not (is_sweep or arguments[0] in names()):
        print(f"./run experiment NAME [--key=value …], where NAME is one of: {', '.join(names())}", file=sys.stderr)
        print("./run experiment SWEEPFILE [--cluster=ADDRESS] [--workers=N], where SWEEPFILE ends in .toml or .json", file=sys.stderr)
        print("./run experiment BUNDLE, where BUNDLE is a folder that an experiment has left", file=sys.stderr)
        return 2
    name, *rest = arguments
    malformed = [argument for argument in rest if not argument.startswith("--") or "=" not in argument]
    if malformed:
        print(f"not --key=value: {' '.join(malformed)}", file=sys.stderr)
        return 2
    options = dict(argument[2:].split("=", 1) for argument in rest)
    if is_sweep:
        return sweep.run(Path(name), options, names())
    experiment = importlib.import_module(f"experiments.{name}")
    folder = f"{name}_real" if _leaves_virtual_time(experiment, options) else name
    output = cache.emptied(cache.clone() / "build/experiments" / folder)
    return _write_summary(experiment.run(options, output), output)


def _write_summary(summary: dict[str, object], output: Path) -> int:
    path = output / "summary.json"
    path.write_text(json.dumps(summary, indent=2) + "\n")
    print(path.relative_to(cache.clone()))
    return 0


def _leaves_virtual_time(experiment: ModuleType, options: dict[str, str]) -> bool:
    """Asked to run in real time, where virtual time is the rule."""
    return options.get("clock") == "real" and getattr(experiment.Settings, "clock", "real") == "virtual"


if __name__ == "__main__":
    entry.leave(main)
