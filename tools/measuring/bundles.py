"""A bundle as an experiment: played again, with its figures and plots made anew."""

import json
from pathlib import Path

import replay


def run(bundle: Path, output: Path) -> dict[str, object]:
    """The flat summary. Fails where something is not the same to the bit, or not all of it could be played."""
    from measuring import records
    from plots import motion

    code = replay.play(bundle, output)
    summary: dict[str, object] = {}
    for report in sorted(output.glob("*_replay.json")):
        side = report.name.removesuffix("_replay.json")
        summary |= {f"{side}.{key}": value for key, value in json.loads(report.read_text()).items()}
        rows = output / f"{side}.csv"
        if len(rows.read_text().splitlines()) > 2:
            record = records.read(rows)
            summary |= {f"{side}.{key}": value for key, value in records.figures(record).items()}
            motion.draw_forces(record, f"{side}: force on the hand", output / f"{side}_force.png")
            motion.draw_object(record, f"{side}: what is moved", output / f"{side}_object.png")
    if code != 0:
        raise RuntimeError(f"{bundle} does not give again what it gave; what it gives is in {output}")
    return summary
