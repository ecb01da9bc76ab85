"""The machine that a measurement ran on, and what else it had to do meanwhile."""

import os
import platform
from dataclasses import dataclass
from pathlib import Path

PROCESSOR_TIMES = Path("/proc/stat")


@dataclass(frozen=True)
class ProcessorTimes:
    """Of all processors together, since the machine started (unit: clock ticks)."""

    total: int
    steal: int  # in which a virtual machine had work to do and its host ran somebody else


def processor_times(text: str | None = None) -> ProcessorTimes:
    first = (PROCESSOR_TIMES.read_text() if text is None else text).partition("\n")[0]
    # cpu user nice system idle iowait irq softirq steal guest guest_nice; guest time is in user time already.
    times = [int(word) for word in first.split()[1:9]]
    return ProcessorTimes(sum(times), times[7] if len(times) > 7 else 0)


def steal_share(before: ProcessorTimes, after: ProcessorTimes) -> float:
    """0 … 1 of the processors' time between the two."""
    return (after.steal - before.steal) / max(after.total - before.total, 1)


def description() -> dict[str, str | int]:
    return {
        "processor": _processor_name(Path("/proc/cpuinfo").read_text()),
        "processors": os.cpu_count() or 1,
        "memory_gib": round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30),
        "virtual": " hypervisor" in Path("/proc/cpuinfo").read_text(),
        "kernel": platform.release(),
        "system": _system_name(Path("/etc/os-release").read_text()),
    }


def _processor_name(cpuinfo: str) -> str:
    return next((line.partition(":")[2].strip() for line in cpuinfo.splitlines() if line.startswith("model name")), "")


def _system_name(os_release: str) -> str:
    return next((line.partition("=")[2].strip('"') for line in os_release.splitlines() if line.startswith("PRETTY_")), "")
