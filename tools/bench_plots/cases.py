"""Flat bench results (CASE.metric keys) as tables."""

import csv
import json
from pathlib import Path


def read(result: Path) -> dict[str, dict[str, float]]:
    """One dictionary of metrics a case, in the order of the file."""
    cases: dict[str, dict[str, float]] = {}
    for key, value in json.loads(result.read_text()).items():
        case, _, metric = key.rpartition(".")
        cases.setdefault(case, {})[metric] = value
    return cases


def write_csv(cases: dict[str, dict[str, float]], path: Path) -> None:
    metrics = list(dict.fromkeys(metric for case in cases.values() for metric in case))
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["case", *metrics])
        for name, case in cases.items():
            rows.writerow([name, *(case.get(metric, "") for metric in metrics)])
