"""What the experiments compare: every way is named in every picture, and cases are what they say."""

from experiments import closed_loop, data_reduction, tuning
from measuring import perturbed, rivals, teleop_runs
from plots import endings, teleop


def test_every_way_has_a_name_and_a_colour():
    assert set(rivals.LABELS) == set(rivals.SCHEMES) == set(teleop.WAYS)
    assert len({teleop.WAYS[way] for way in rivals.SCHEMES}) == len(rivals.SCHEMES)
    assert all(endings.label_of(case) for case in perturbed.CASES)
    assert set(rivals.PASSIVE) <= set(rivals.SCHEMES)


def test_a_wrong_model_is_told_to_whoever_has_one():
    wrong = teleop_runs.wrong({"Box": {"mass": 2}})
    passive = rivals.with_model("passive_updates", wrong)
    assert passive == {"correction": "passive", **rivals.TUNED["passive_updates"], "wrong.Box.mass": 2}
    assert rivals.with_model("traditional", wrong) == {"traditional": 1}


def test_every_run_of_the_table_is_perturbed_alike_for_every_way():
    settings = perturbed.Settings(runs=2)
    description = teleop_runs.description("table_edge")
    found = perturbed.cases(description, settings)
    assert len(found) == 2 * len(perturbed.CASES)
    second = perturbed.perturbation(description, settings.seed * 100_000 + 1)
    assert all(second.items() <= case.items() for case in found[1::2])


def test_the_most_energy_of_what_is_called_passive_is_found():
    summary: dict[str, object] = {
        "static.traditional_100ms.energy_created_J": 1.0,
        "static.traditional_two_layers_25ms.energy_created_J": 2e-7,
        "dynamic.passive_updates_right_50ms.energy_created_J": 3e-7,
        "dynamic.mmt_50ms.energy_created_J": 0.5,
        "static.traditional_100ms.link_energy_created_J": 2.0,
        "static.traditional_two_layers_25ms.link_energy_created_J": 4e-7,
        "dynamic.passive_updates_right_50ms.link_energy_created_J": 1e-7,
    }
    assert closed_loop.passive(summary) == {
        "passive.energy_created_max_J": 3e-7, "passive.energy_created_max_case": "dynamic.passive_updates_right_50ms",
        "passive.link_energy_created_max_J": 4e-7, "passive.link_energy_created_max_case": "static.traditional_two_layers_25ms",
    }  # fmt: skip


def test_what_never_hears_anything_has_nothing_to_save():
    ways = data_reduction.ways({"wrong.Box.mass": 2})
    assert "never_corrected" not in ways and ways["mmt"] == {"wrong.Box.mass": 2}


def test_every_way_is_tuned_by_as_many_rounds_and_first_as_it_is():
    for way, ranges in tuning.RANGES.items():
        rounds = tuning.choices(way, 5, seed=1)
        assert len(rounds) == 5 and rounds[0] == {} and rounds == tuning.choices(way, 5, seed=1)
        assert all(low * 0.99 <= one[key] <= high * 1.01 for one in rounds[1:] for key, (low, high) in ranges.items())


def test_what_makes_energy_is_not_the_best_of_what_is_passive():
    assert tuning._rank("traditional_time_domain", (0.5, 1e-3)) > tuning._rank("traditional_time_domain", (0.9, 1e-7))
    assert tuning._rank("velocities", (0.5, 1e-3)) < tuning._rank("velocities", (0.9, 0.0))
