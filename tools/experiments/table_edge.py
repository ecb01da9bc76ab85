"""A box is pushed to the edge of a table and falls or stays, on both sides alike or not (thesis figure 3.2).

    ./run experiment table_edge [--runs=200] [--seed=1] [--delay=100] [--pictures=1]

Cases are the schemes C': spring, position (1), position_force (2), position_force_relative (3); with "_alone" the model
is never corrected. --seed: another number, other perturbations.
"""

from pathlib import Path

from measuring import options, perturbed


def run(given: dict[str, str], output: Path) -> dict[str, object]:
    return perturbed.run("table_edge", options.parse(perturbed.Settings, given), output)
