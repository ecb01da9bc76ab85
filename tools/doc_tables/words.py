"""How a number stands in a table of the documents."""

import math

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def figure(value: float, digits: int = 2) -> str:
    """So many digits that count, and all before the point; far below 1 with a power of ten. What is not known is empty."""
    if math.isnan(value):
        return ""
    if value == 0.0 or abs(value) < 1e-12:
        return "0"
    if abs(value) < 1e-4:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        mantissa = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
        return f"{mantissa}·10{str(int(exponent)).translate(_RAISED)}"
    rounded = float(f"{value:.{digits}g}")
    return f"{value:.0f}" if abs(rounded) >= 10 ** (digits - 1) else f"{rounded:.10f}".rstrip("0").rstrip(".")


def percent(share: float, decimals: int = 0) -> str:
    return f"{100.0 * share:.{decimals}f} %"


def signed_percent(share: float) -> str:
    """Of what is saved: −94 %."""
    return f"−{100.0 * share:.0f} %" if share > 0.0 else f"+{-100.0 * share:.0f} %"
