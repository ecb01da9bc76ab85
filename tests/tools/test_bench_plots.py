"""The charts of the benches."""

import json

import pytest

from bench_plots import credibility, proxy

SPHERE = {"contact_median_us": 0.5, "contact_p99_us": 2.0, "free_median_us": 0.05, "error_max": 1e-10}
ROUGH = {"mean_us": 2.0, "p95_us": 4.0, "p99_us": 8.0, "max_us": 20.0}


def flat(cases):
    return {f"{name}.{metric}": value for name, case in cases.items() for metric, value in case.items()}


@pytest.mark.parametrize(
    ("cases", "charts"),
    [
        ({"sphere_320_r0.05": SPHERE}, {"proxy.png"}),
        ({"rough_gear_182856_r0.2_walk": ROUGH, "rough": {"cases": 1.0}}, {"proxy_rough.png"}),
        ({"sphere_320_r0.05": SPHERE, "rough_gear_182856_r0.2_walk": ROUGH}, {"proxy.png", "proxy_rough.png"}),
    ],
)
def test_what_was_measured_is_drawn_and_nothing_else(tmp_path, cases, charts):
    result = tmp_path / "proxy.json"
    result.write_text(json.dumps(flat(cases)))
    proxy.main(result)
    assert {path.name for path in tmp_path.glob("*.png")} == charts


def test_rough_cases_stand_with_the_latest_first():
    cases = {f"rough_gear_{size}_r0.2_walk": {**ROUGH, "p99_us": p99} for size, p99 in ((1000, 3.0), (2000, 9.0), (3000, 5.0))}
    assert [name for name, _ in proxy.rough(cases)] == [f"gear, {size}, r 0.2, walk" for size in ("2,000", "3,000", "1,000")]


def test_credibility_compares_with_the_closed_form_where_there_is_one_and_else_with_mujoco():
    ours = {"rod.force.ours": 0.6, "disc.stop.ours": 0.12, "disc.stop.right": 0.125, "disc.stop": 4.0, "stack20.stands_s": 120.0}
    values = credibility.compared(ours, {"rod.force": 0.8, "disc.stop": 0.1, "square.stop": 1.0})
    assert values["rod.force"] == pytest.approx(25.0)
    assert values["disc.stop"] == 4.0
    assert values["disc.stop.from_mujoco"] == pytest.approx(20.0)
    assert not any(key.startswith("square") for key in values)
    rows = credibility.table(values).splitlines()
    assert any("0.8 N" in row and "25 %" in row for row in rows)
    assert any("120 s" in row for row in rows)
