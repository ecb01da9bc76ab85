"""The tables of the documents that a command makes: which command, and what it puts where.

Each figure is computed in virtual time: the same sources give the same digits on every machine.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from doc_tables.words import figure, percent, signed_percent
from measuring import rivals

Summary = Mapping[str, object]
Rows = list[list[str]]

LABELS = {scheme: f"**{label}**" if scheme == rivals.DEFAULT else label for scheme, label in rivals.LABELS.items()}


@dataclass(frozen=True)
class Table:
    """`rows` makes the lines below the head of the summary of ./run experiment EXPERIMENT OPTIONS."""

    document: str  # in docs/
    experiment: str
    options: tuple[tuple[str, str], ...]
    head: tuple[str, ...]
    rows: Callable[[Summary], Rows]

    @property
    def command(self) -> str:
        return " ".join(["./run experiment", self.experiment, *(f"--{key}={value}" for key, value in self.options)])


def number(summary: Summary, key: str) -> float:
    """Not a number where the summary has none: there is nothing to tell."""
    value = summary.get(key, "nan")
    return float(value)  # type: ignore[arg-type]


def cell(summary: Summary, key: str, digits: int = 2) -> str:
    return figure(number(summary, key), digits)


# --- static_mmt


def static_errors(summary: Summary) -> Rows:
    lines = {
        "direct, 0 ms": "traditional_0ms.force_error_mean_N",
        "direct, 100 ms": "traditional_100ms.force_error_mean_N",
        **{f"{LABELS[way]}, 100 ms": f"{way}_100ms.force_error_mean_N" for way in rivals.TRADITIONAL if way != "traditional"},
        **{f"right model, {delay} ms": f"mmt_right_{delay}ms.force_error_mean_N" for delay in (100, 500, 5000)},
        **{f"wrong model, never corrected, {delay} ms": f"mmt_wrong_{delay}ms.force_error_mean_N" for delay in (0, 100, 500, 5000)},
        "… over direct, 100 ms": "mmt_wrong_100ms.over_traditional_100ms",
        "… the third turn over the first": "mmt_wrong_100ms.force_error_last_turn_over_first",
        "wrong model, default": "mmt_wrong_told_100ms.force_error_mean_N",
        "wrong model, corrected from the first touch on": "mmt_wrong_corrected_100ms.force_error_mean_N",
        "… right after the first touch (s)": "mmt_wrong_corrected_100ms.seconds_until_right",
        "… with passive updates": "mmt_wrong_corrected_100ms_passive_updates.force_error_mean_N",
        "… then right after the first touch (s)": "mmt_wrong_corrected_100ms_passive_updates.seconds_until_right",
    }
    shares = {f"{body} in contact": f"{body}_contact_share" for body in ("ground", "sphere")}
    paths = ("thesis_path", "waves")
    found = [[label, *(percent(number(summary, f"{path}.{key}")) for path in paths)] for label, key in shares.items()]
    return found + [[label, *(cell(summary, f"{path}.{key}") for path in paths)] for label, key in lines.items()]


def static_trade(summary: Summary) -> Rows:
    lines = {f"share {share}": share for share in ("0.125", "0.5", "2", "8")}
    lines |= {LABELS[way]: way for way in ("default", "pose_only", "passive_updates")}
    keys = ("seconds_from_told_until_right", "felt_excess_once_told_100ms_jnd_max")
    return [
        [label, *(cell(summary, f"{path}.trade.{name}.{key}") for path in ("waves", "held") for key in keys)] for label, name in lines.items()
    ]


# --- dynamic_mmt

DYNAMIC = {
    "never corrected": "none.none", "pose alone (thesis)": "pose.none", "pose alone, eq. 3.1": "pose.velocity",
    "velocities (eq. 3.1)": "pose_velocity.velocity", "pose and rates, re-simulated": "pose_velocity.resimulate",
    "passive updates, re-simulated": "passive.resimulate", "stealthy, size kept, re-simulated": "stealthy_magnitude.resimulate",
    "**stealthy, direction kept, re-simulated**": "stealthy_direction.resimulate",
}  # fmt: skip
DYNAMIC_FIGURES = (
    "box_position_error_rms_mm", "force_error_mean_N", "force_error_p95_N", "force_error_p99_N", "force_error_max_N",
    "felt_excess_100ms_jnd_mean", "felt_excess_100ms_jnd_p99", "felt_excess_100ms_jnd_max", "correction_force_step_max_N",
    "energy_created_J", "energy_at_hand_most_J", "link_energy_created_J",
)  # fmt: skip


def dynamic_schemes(summary: Summary) -> Rows:
    """Each correction with what its settings are by default, and those of rivals as 24 rounds have tuned them."""
    lines = {label: f"{case}.100ms.0pct" for label, case in DYNAMIC.items()}
    lines |= {f"{LABELS[way]}, tuned": f"usual.{way}.100ms" for way in ("pose_only", "velocities", "passive_updates")}
    lines |= {LABELS[way] + (", tuned" if way != "traditional" else ""): f"{way}.100ms.0pct" for way in rivals.TRADITIONAL}
    return [[label, *(cell(summary, f"{case}.{key}") for key in DYNAMIC_FIGURES)] for label, case in lines.items()]


VARIANTS = ("usual", "unsynchronised", "pose_noise", "light_rough", "tilted", "moved", "jitter")


def dynamic_variants(key: str) -> Callable[[Summary], Rows]:
    def rows(summary: Summary) -> Rows:
        return [[LABELS[way], *(cell(summary, f"{variant}.{way}.100ms.{key}") for variant in VARIANTS)] for way in LABELS]

    return rows


def dynamic_losses(summary: Summary) -> Rows:
    schemes = ("stealthy_direction.resimulate", "none.none")
    return [
        [f"{delay} ms", *(cell(summary, f"{scheme}.{delay}ms.{loss}pct.force_error_mean_N") for scheme in schemes for loss in (0, 10, 50))]
        for delay in (0, 25, 50, 100, 200, 500)
    ]


# --- closed_loop

CLOSED = (
    *(f"{delay}ms.{key}" for key in ("settled_contact_share", "settled_force_error_N", "force_error_mean_N") for delay in (25, 100, 500)),
)  # fmt: skip
CLOSED_WRONG = {"mmt_wrong": "default, ground 5 mm too high", "never_corrected_wrong": "never corrected, ground 5 mm too high"}
MOST = ("energy_created_J", "energy_at_hand_most_J", "link_energy_created_J", "restless_mm_s")


def closed_loop(scene: str) -> Callable[[Summary], Rows]:
    def rows(summary: Summary) -> Rows:
        found = []
        for way, label in (LABELS | (CLOSED_WRONG if scene == "static" else {})).items():
            name = f"{scene}.{'mmt' if way == rivals.DEFAULT else way}"
            keys = [f"{name}_{key}" for key in CLOSED]
            # A way that has lost the contact has no force error there.
            shown = [percent(number(summary, key)) if "share" in key else cell(summary, key) or "–" for key in keys]
            most = [max(number(summary, f"{name}_{delay}ms.{key}") for delay in (0, 25, 50, 100, 200, 500)) for key in MOST]
            found.append([label, *shown, *map(figure, most)])
        return found

    return rows


# --- data_reduction


def data_reduction(summary: Summary) -> Rows:
    found = []
    for way in rivals.LABELS:
        if way == "never_corrected":
            continue
        for band in ("weber", "fixed"):
            name = f"{'mmt' if way == rivals.DEFAULT else way}.{band}"
            packets = [
                f"{number(summary, f'{name}.packets_{way_of}_per_s'):.0f} ({signed_percent(number(summary, f'{name}.fewer_{way_of}_share'))})"
                for way_of in ("forth", "back")
            ]
            bits = f"{number(summary, f'{name}.bits_per_s') / 1e3:.0f} ({signed_percent(number(summary, f'{name}.fewer_bits_share'))})"
            jnd = [cell(summary, f"{name}.force_change_{how}_jnd") for how in ("mean", "p95", "p99")]
            share = percent(number(summary, f"{name}.noticeable_share_of_touch"), 1)
            found.append([f"{LABELS[way]}, {band}", *packets, bits, *jnd, share])
    return found


# --- table_edge, gate

ENDINGS = {
    "spring": "spring", "1 position": "position", "2 position and force": "position_force",
    "3 position, force, relative position": "position_force_relative", "2, the force free": "position_force_free",
    "3, the force free": "relative_free",
}  # fmt: skip


def table_edge(summary: Summary) -> Rows:
    lines = {label: case for label, case in ENDINGS.items()}
    lines |= {f"spring, {LABELS[way]}": f"spring_{way}" for way in ("pose_only", "velocities", "passive_updates")}
    lines |= {LABELS[way]: way for way in rivals.TRADITIONAL}
    found = []
    for label, case in lines.items():
        alone = f"{case}_alone" if f"{case}_alone.ends_alike_share" in summary else ""
        found.append(
            [
                label, percent(number(summary, f"{alone}.ends_alike_share"), 1) if alone else "",
                percent(number(summary, f"{case}.ends_alike_share"), 1), cell(summary, f"{alone}.apart_median_mm") if alone else "",
                cell(summary, f"{case}.apart_median_mm"), percent(number(summary, f"{case}.off_by_10mm_share")),
                cell(summary, f"{case}.force_error_mean_N"), cell(summary, f"{case}.energy_created_max_J"),
            ]
        )  # fmt: skip
    return found


def gate(summary: Summary) -> Rows:
    return [
        [label, *(percent(number(summary, f"{case}{end}.ends_alike_share"), 1) for end in ("_alone", ""))] for label, case in ENDINGS.items()
    ]


# --- carried

CARRIED = {
    "carried, translated": "stealthy_translate", "carried, turned": "stealthy_turn", "masked, size kept": "stealthy_magnitude",
    "**masked, direction kept**": "stealthy_direction", "neither": "pose_velocity",
}  # fmt: skip
TURNS = (0, 5, 10, 15, 20)
CARRIED_FIGURES = ("felt_excess_100ms_jnd_p99", "force_error_over_never_corrected")


def carried(summary: Summary) -> Rows:
    return [
        [label, *(cell(summary, f"{scheme}.{turn}deg.{key}") for key in CARRIED_FIGURES for turn in TURNS)] for label, scheme in CARRIED.items()
    ]


DYNAMIC_RUN = (("grid", "0"), ("pictures", "0"))
PLAIN = (("pictures", "0"),)
_VARIANT_HEAD = ("", *(variant.replace("_", " ") for variant in VARIANTS))
_CLOSED_HEAD = (
    "", "in contact while it holds, 25 ms", "100 ms", "500 ms", "force off then, 25 ms (N)", "100 ms", "500 ms",
    "force error, mean, 25 ms (N)", "100 ms", "500 ms", "energy made in a contact, most (J)", "given to the hand since the start, most (J)",
    "made by the link, most (J)", "still moving, most (mm/s)",
)  # fmt: skip
_PAGE = "teleoperation.md"

TABLES: dict[str, Table] = {
    "static_errors": Table(_PAGE, "static_mmt", PLAIN, ("", "thesis path", "waves"), static_errors),
    "static_trade": Table(
        _PAGE, "static_mmt", PLAIN, ("", "waves: right after (s)", "excess force (JND)", "held: right after (s)", "excess force (JND)"), static_trade
    ),
    "dynamic_schemes": Table(
        _PAGE, "dynamic_mmt", DYNAMIC_RUN,
        ("", "box off, RMS (mm)", "force error, mean (N)", "p95", "p99", "max", "excess force in 100 ms, mean (JND)", "p99", "max",
         "largest step (N)", "energy made in a contact (J)", "given to the hand, most (J)", "made by the link, most (J)"),
        dynamic_schemes,
    ),
    "dynamic_variants_force": Table(_PAGE, "dynamic_mmt", DYNAMIC_RUN, _VARIANT_HEAD, dynamic_variants("force_error_mean_N")),
    "dynamic_variants_place": Table(_PAGE, "dynamic_mmt", DYNAMIC_RUN, _VARIANT_HEAD, dynamic_variants("box_position_error_rms_mm")),
    "dynamic_losses": Table(
        _PAGE, "dynamic_mmt", DYNAMIC_RUN, ("", "default, nothing lost (N)", "10 %", "50 %", "never corrected (N)", "10 %", "50 %"), dynamic_losses
    ),
    "table_edge": Table(
        _PAGE, "table_edge", PLAIN,
        ("C′", "ends alike, never corrected", "corrected", "boxes apart, median, never corrected (mm)", "corrected", "off by 10 mm at some time",
         "force error, mean (N)", "energy made in a contact, most (J)"),
        table_edge,
    ),
    "gate": Table(_PAGE, "gate", PLAIN, ("C′", "never corrected", "default"), gate),
    "closed_loop_static": Table(_PAGE, "closed_loop", PLAIN, _CLOSED_HEAD, closed_loop("static")),
    "closed_loop_dynamic": Table(_PAGE, "closed_loop", PLAIN, _CLOSED_HEAD, closed_loop("dynamic")),
    "carried": Table(
        _PAGE, "carried", PLAIN,
        ("", "excess force in 100 ms, 99 % (JND), 0°", "5°", "10°", "15°", "20°", "force error over never correcting, 0°", "5°", "10°", "15°", "20°"),
        carried,
    ),
    "data_reduction": Table(
        _PAGE, "data_reduction", PLAIN,
        ("", "packets there (1/s)", "back (1/s)", "kbit/s", "force changed by, mean (JND)", "p95", "p99", "touching ticks above one JND"),
        data_reduction,
    ),
}  # fmt: skip
