"""The ways to touch over a network that every experiment compares, each with its best settings (./run experiment tuning).

With a model of the far side: never corrected; pose alone, the thesis's; velocities, its equation 3.1; passive updates,
whose corrections are paid for by what touch has taken; pointers carried along with a corrected object, translated or turned (thesis
3.1.4); and the default. Without one, direct teleoperation: as it is, through a network compensation spring, which is softer the
older a force is (thesis 2.1; Kroep and others 2023), and with each scheme that keeps it passive.
"""

from measuring.teleop_runs import PASSIVITY, Case

DEFAULT = "default"
COMPENSATION_SPRING = "traditional_compensation_spring"
# What 24 rounds of ./run experiment tuning have found best. The default stays what it is: what wins there by a
# fourteenth fades six times as fast, and is felt.
TUNED: dict[str, Case] = {
    "pose_only": {"states_every": 22},
    "velocities": {"states_every": 48},
    "passive_updates": {"update_bring_in": 0.0411, "update_take_out": 0.0264, "update_tank": 0.0652},
    "compensation_spring": {"softening_ms": 676},
    "wave_variables": {"wave_impedance": 4.39, "wave_cutoff": 3.78, "drift_rate": 0.503},
    "time_domain": {
        "reserve": 0.0078, "lightest_hand": 0.0215, "largest_damping": 3.76, "far_store": 0.0923, "drift_rate": 1.09,
    },
    "two_layers": {
        "reserve": 0.00941, "lightest_hand": 0.0318, "tank": 0.047, "refill": 363, "tank_share": 0.272, "far_store": 0.0523,
    },
}  # fmt: skip
# The default is what TeleopSettings says; the others are what it is measured against.
MODELS: dict[str, Case] = {
    DEFAULT: {},
    "never_corrected": {"correction": "none"},
    "pose_only": {"correction": "pose", "derivation": "none"},
    "velocities": {"correction": "pose_velocity", "derivation": "velocity"},
    "passive_updates": {"correction": "passive"},
    "carried_translate": {"correction": "stealthy_translate"},
    "carried_turn": {"correction": "stealthy_turn"},
}
MODELS = {scheme: keys | TUNED.get(scheme, {}) for scheme, keys in MODELS.items()}
TRADITIONAL: dict[str, Case] = {
    "traditional": {"traditional": 1},
    COMPENSATION_SPRING: {"traditional": 1, **TUNED["compensation_spring"]},
    **{f"traditional_{scheme}": {"traditional": 1, "passivity": scheme, **TUNED[scheme]} for scheme in PASSIVITY},
}
SCHEMES: dict[str, Case] = MODELS | TRADITIONAL
# These say of themselves that no touch gives the hand more than it has put in.
PASSIVE = ("passive_updates", *(f"traditional_{scheme}" for scheme in PASSIVITY))
# The thesis's own link: every sample and every state is sent once in its tick, the newest one wins, and the pose of a state is
# set as it comes, one delay old (thesis 4.4.5, 5.4).
THESIS_SYSTEM: Case = {"correction": "pose", "derivation": "none", "states_every": 1, "repeats": 1, "newest": 1}

LABELS = {
    DEFAULT: "default", "never_corrected": "never corrected", "pose_only": "pose alone (thesis)",
    "velocities": "velocities (eq. 3.1)", "passive_updates": "passive updates", "carried_translate": "carried, translated (3.1.4)",
    "carried_turn": "carried, turned (3.1.4)", "traditional": "direct", COMPENSATION_SPRING: "… compensation spring",
    "traditional_wave_variables": "… wave variables", "traditional_time_domain": "… time domain",
    "traditional_two_layers": "… two layers",
}  # fmt: skip


def with_model(scheme: str, wrong: Case) -> Case:
    """The scheme's keys, and what the model gets wrong, where there is one."""
    return SCHEMES[scheme] | (wrong if scheme in MODELS else {})
