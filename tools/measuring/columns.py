"""What the columns of an experiment's tables mean: columns.json beside them, a data dictionary."""

import csv
import functools
import json
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

FILE = "columns.json"
CLASS_REFERENCE = Path(__file__).resolve().parents[2] / "extension/doc_classes"  # of these sources, wherever the results go

# A whole name, or its beginning and its end: with the unit.
_MEANINGS = (
    (r"time_us", "when the tick was due, microseconds"),
    (r"ran_us", "when the tick began, microseconds: time_us where the clock is stepped"),
    (r"force_cut", "why the device's force was cut since the row before, as a sum: 1 a late tick, 2 a silent device, 4 a stuck driver; 0: it was not"),
    (r"force_[xyz]", "force that the proxy asks for, in the world's frame, newtons"),
    (r"displayed_[xyz]", "force that the device was given, behind every limit, in the world's frame, newtons"),
    (r"direct_[xyz]", "force of direct, undelayed touch by the same hand, newtons"),
    (r"far_[xyz]", "force at the teleoperator, newtons; nan: it has not answered this sample"),
    (r"local_force_[xyz]", "force of local touch, newtons"),
    (r"there_hand_[xyz]", "position of the teleoperator's hand in this tick, in the world, meters"),
    (r"there_force_[xyz]", "force at the teleoperator in this tick, newtons"),
    (r"(local_)?velocity_[xyz]", "velocity of the device (local: of the arm that touches without a link), meters per second"),
    (r"local_hand_[xyz]", "position of the arm that touches without a link, meters"),
    (r"correction_force_step_N", "change of the force by the correction of this tick, same hand, newtons"),
    (r"packets_(forth|back)", "packets that the operator (back: the teleoperator) has sent since the start"),
    (r"bytes_(forth|back)", "bytes that the operator (back: the teleoperator) has sent since the start, without the headers of UDP and IP"),
    (r"hand_[xyz]", "position of the device in the world, meters"),
    (r"proxy_[xyz]", "position of the proxy in the world, meters"),
    (r"(object|model|truth)_[xyz]", "position of the followed body in the world (model: in the local model, truth: at the teleoperator), meters"),
    (r"object_q[xyzw]", "rotation of the followed body, a unit quaternion"),
    (r"(model|truth)_final_[xyz]", "position of the followed body at the end, meters"),
    (r"proxy_status", "bits of ProxyPointer.get_status()"),
    (r"contacts", "planes that constrain the proxy"),
    (r"direct_contacts", "planes that constrain the proxy of direct touch"),
    (r"box_error_m", "distance of the followed body in the model from where it is, meters; nan: the teleoperator has not answered this sample"),
    (r"box_rotation_error_rad", "angle between the followed body in the model and as it is, radians; nan: as in box_error_m"),
    (r"far_hand_error_m", "distance of the teleoperator's hand from the operator's, meters; nan: as in box_error_m"),
    (r"touches", "1: the proxy touches the followed body"),
    (r"direct_touches", "1: in direct touch the proxy touches anything"),
    (r"direct_touches_.*", "1: in direct touch the proxy touches the body of this name"),
    (r"jnd_share", "change of the force by corrections in this tick over the just-noticeable change"),
    (r"felt_excess_(1|100)ms_N", "change of the force within 1 or 100 ms beyond that of direct touch, newtons"),
    (r"felt_excess_(1|100)ms_jnd", "change of the force within 1 or 100 ms beyond that of direct touch, just-noticeable differences"),
    (r"offset_m", "distance by which a correction is masked, meters"),
    (r"(local_)?depth_m", "depth of the device below the surface, meters"),
    (r"let_go", "1: the pointer has released the body because the model was too far off"),
    (r"(model|environment)_beyond", "1: the body is beyond the line at the end, on that side"),
    (r"case|scheme|way|scenario|side|scene|hand|wrong|kind|correction|derivation|loop", "which one"),
    (r"run|round", "its number"),
    (r"seed", "which packets are lost or late, what noise there is, and where the hand goes"),
    (r"(recorded|lost)_rows", "rows of the recorder (lost: for which there was no room)"),
    (r"share", "share of the periods that are no longer, 0 … 1"),
    (r"alike", "true: both sides have the same settings"),
    (r"(near|far)_says", "true: the link of that side says what differs"),
    (r"seconds_until_right", "from the first contact to the last force error above 0.02 N, seconds"),
    (r"worse|diverged", "1: it is"),
    (r"settings", "keys of tests/shared/teleop_words.cpp"),
    (r"factor|level|against|measure", "what is compared: a factor's level against another one, by this figure"),
    (r"pairs", "runs that differ in that factor alone"),
    (r"difference(_low|_high)?", "mean difference of the pairs (its 95 % interval), in the figure's unit"),
    (r"hedges_g(_low|_high)?", "that difference over the pooled standard deviation (its 95 % interval)"),
    (r"score", "geometric mean of force errors over those of the reference"),
)
_UNITS = (
    ("_jnd", "just-noticeable differences"), ("_per_s", "per second"), ("_ticks", "ticks"), ("_share", "share, 0 … 1"),
    ("_mm_s", "millimeters per second"), ("_mm", "millimeters"), ("_deg", "degrees"), ("_us", "microseconds"), ("_ms", "milliseconds"),
    ("_J", "joules"), ("_N", "newtons"), ("_n", "newtons"), ("_m", "meters"), ("_s", "seconds"), ("_pct", "percent"),
)  # fmt: skip


def meaning(column: str) -> str:
    """Empty where it is not known."""
    for pattern, words in _MEANINGS:
        if re.fullmatch(pattern, column):
            return words
    if column in _statistics():
        unit = next((unit for ending, unit in _UNITS if column.endswith(ending)), "")
        return _statistics()[column] + (f" ({unit})" if unit else "")
    bare = re.sub(r"_(mean|p50|p90|p95|p99|p999|max|min|most|median)$", "", column)
    for ending, unit in _UNITS:
        if bare.endswith(ending) or f"{ending}_" in bare:
            return f"{bare.replace(ending, '', 1).replace('_', ' ').strip()}, {unit}"
    return ""


@functools.cache
def _statistics() -> dict[str, str]:
    """What get_statistics() of a world or a link has, in the words of the class reference."""
    found: dict[str, str] = {}
    for name in ("MMTLink", "HapticWorld"):
        reference = ElementTree.parse(CLASS_REFERENCE / f"{name}.xml")
        found |= {one.attrib["key"]: " ".join("".join(one.itertext()).split()) for one in reference.iter("statistic")}
    return found


def write(folder: Path) -> None:
    """Of every table in the folder; none: no file."""
    found = {}
    for path in sorted(folder.glob("*.csv")):
        with path.open(newline="") as file:
            found[path.name] = {column: meaning(column) for column in next(csv.reader(file), [])}
    if found:
        (folder / FILE).write_text(json.dumps(found, indent=2, ensure_ascii=False) + "\n")
