"""The grid of dynamic_mmt: what is run, and how its cases are pooled."""

from measuring import teleop_grid, teleop_runs
from measuring.teleop_scene import Scene

DESCRIPTION = teleop_runs.description("dynamic_mmt")


def _names(wrong: str, loss: str = "0") -> list[str]:
    return teleop_grid.cases(DESCRIPTION["grid"], ["one", "hinge"], [wrong], ["50", "200"], loss)


def test_what_is_never_corrected_does_not_depend_on_the_delay():
    keys = [teleop_grid._keys(DESCRIPTION, name, "never_corrected") for name in _names("heavy")]
    assert keys[0] == keys[1] and keys[0]["wrong.Box.mass"] == 3
    assert all("delay_ms" in teleop_grid._keys(DESCRIPTION, name, "default") for name in _names("heavy"))


def test_the_bound_is_told_of_places_before_and_of_the_rest_one_delay_late():
    keys = [teleop_grid._keys(DESCRIPTION, name, teleop_grid.BOUND) for name in _names("all")]
    assert all(one["correction"] == "none" and one["wrong.Box.mass"] == 3 for one in keys)
    assert not any(key.endswith((".move", ".swing", ".turn")) for one in keys for key in one)
    assert [one["known_after_ms"] for one in keys[:2]] == ["50", "200"]


def test_traditional_touch_has_no_model_that_could_be_wrong():
    keys = [teleop_grid._keys(DESCRIPTION, name, "traditional") for name in _names("all")]
    assert not any(key.startswith("wrong.") for one in keys for key in one)


def test_what_hangs_on_a_hinge_is_moved_about_it():
    one, hinged = (teleop_grid._keys(DESCRIPTION, name, "default") for name in _names("moved")[::4])
    assert one["wrong.Box.move"] == "0.05,0,0"
    assert 10 < hinged["wrong.Box.swing"] < 30 and "wrong.Box.move" not in hinged


def test_what_chance_makes_wrong_is_the_same_every_time_and_within_what_the_grid_says():
    drawn = teleop_grid.drawn(20)
    assert drawn == teleop_grid.drawn(20) and len({str(wrong) for wrong in drawn.values()}) == 20
    assert all(1 / 3 <= wrong[what] <= 3 for wrong in drawn.values() for what in ("mass", "friction"))
    assert all(abs(wrong.get("moved", 0)) <= 0.05 and abs(wrong.get("tilt", 0)) <= 5 for wrong in drawn.values())


def test_every_way_is_touched_by_the_same_hand():
    description = DESCRIPTION | {"grid": DESCRIPTION["grid"] | {"wrong": teleop_grid.drawn(1)}}
    keys = [teleop_grid._keys(description, "one.arm.seed_1.50ms.0pct", one) for one in (*teleop_grid.SCHEMES, teleop_grid.BOUND)]
    assert len({one["path_shift"] for one in keys}) == 1


def test_what_else_acts_is_in_the_scene_and_not_in_the_model():
    grid = DESCRIPTION["grid"]
    names = teleop_grid.unmodelled(grid, grid["scenes"], ["50", "100", "200"])
    assert len(names) == len(set(names)) >= 120
    assert not any(name.startswith("hinge.") and ".joint." in name for name in names)
    acted = DESCRIPTION | {"grid": grid | {"wrong": grid["unmodelled"]}}
    for name in names:
        keys = [teleop_grid._keys(acted, name, one) for one in teleop_grid.WITH_LOSS]
        acts = [{key: value for key, value in one.items() if key.startswith(teleop_grid.UNMODELLED)} for one in keys]
        assert acts[0] and acts.count(acts[0]) == len(acts)


def test_copies_stand_elsewhere_with_the_same_shapes():
    lines = Scene(DESCRIPTION["scene"]).varied({"copies": {"Other": {"of": "Box", "at": [1, 2, 3]}}}).splitlines()
    of, other = (next(i for i, line in enumerate(lines) if line.startswith(f"body {name} ")) for name in ("Box", "Other"))
    assert lines[other].split()[2:10] == lines[of].split()[2:10]
    assert lines[other].split()[10:13] == ["1.0", "2.0", "3.0"]
    assert lines[other + 1] == lines[of + 1]


def test_pooled_ticks_are_counted_together():
    pooled = teleop_grid.pool([{"0": 98, "100": 1}, {"0": 1}])
    assert pooled == {0: 99, 100: 1}
    assert teleop_grid.pooled_percentile(pooled, 0.99) == 10**0.01
    assert teleop_grid.pooled_percentile(pooled, 1.0) == 10**1.01


def test_errors_that_nobody_tells_apart_are_not_worse():
    def one(error: float) -> dict[str, float]:
        return {"force_error_mean_N": error, "box_position_error_rms_mm": 1.0}

    assert not teleop_grid.is_worse("one.arm.heavy.50ms.0pct", one(0.1005), one(0.1))
    assert teleop_grid.is_worse("one.arm.heavy.50ms.0pct", one(0.102), one(0.1))
    assert teleop_grid.is_worse("one.arm.heavy.50ms.0pct", one(float("nan")), one(0.1))


def test_a_body_that_comes_back_within_the_delay_is_not_lost():
    def is_lost(name: str, seconds: float) -> bool:
        return teleop_grid.is_lost(name, {"box_lost_longest_s": seconds})

    assert not is_lost("one.arm.heavy.200ms.0pct", 0.25)
    assert is_lost("one.arm.heavy.50ms.0pct", 0.25)
    assert is_lost("one.arm.heavy.200ms.0pct", 0.31)
    assert is_lost("one.arm.heavy.200ms.0pct", float("nan"))


def test_an_error_of_nothing_without_noise_has_no_ratio():
    results = {
        "one.scripted.usual_noise.50ms.0pct": {"force_error_mean_N": 0.02},
        "one.scripted.usual.50ms.0pct": {"force_error_mean_N": 0.01},
        "stack.scripted.usual_noise.50ms.0pct": {"force_error_mean_N": 0.0},
        "stack.scripted.usual.50ms.0pct": {"force_error_mean_N": 0.0},
        "hinge.scripted.usual_noise.50ms.0pct": {"force_error_mean_N": 0.3},
    }
    assert teleop_grid._noise_ratios(results) == [2.0]
