"""A box is pushed to the edge of a table and falls or stays, on both sides alike or not (thesis figure 3.2).

    ./run experiment table_edge [--runs=200] [--seed=1] [--delay=100] [--sweep=1] [--pictures=1]

Cases are the schemes C': spring, position (1), position_force (2), position_force_relative (3), and 2 and 3 with a
free force (position_force_free, relative_free); with "_alone" the model is never corrected. Beside them, with the spring:
spring_pose_only, spring_velocities, spring_passive_updates, and traditional touch as it is and with each passive scheme.
--seed: another number, other perturbations. --sweep=1: in their place the terms of C' one at a time, SCHEME.TERM_VALUE and
SCHEME.TERM_VALUE_alone.
"""

from pathlib import Path

from measuring import options, perturbed
from measuring.perturbed import Settings


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    return perturbed.run("table_edge", options.parse(Settings, given), output)
