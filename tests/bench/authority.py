"""What a hand feels of bodies that Godot's own physics moves: authority/played.gd with each of Godot's physics engines.

Writes authority.json: the keys of each with "jolt." or "godot." before them.
"""

import json
import os
import sys
from pathlib import Path

CLONE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(CLONE / "tools"))
import bench  # noqa: E402

ENGINES = {"jolt": "Jolt Physics", "godot": "GodotPhysics3D"}


def main() -> int:
    output = Path(os.environ["TACTUS_BENCH_JSON"])
    figures: dict[str, float] = {}
    for name, engine in ENGINES.items():
        print(f"-- {engine}", flush=True)
        part = output.with_name(f"authority_{name}.partial")
        if code := bench.run_in_godot(CLONE / "tests/bench/authority/played.gd", part, engine):
            return code
        figures |= {f"{name}.{key}": value for key, value in json.loads(part.read_text()).items()}
        part.unlink()
    output.write_text(json.dumps(figures, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
