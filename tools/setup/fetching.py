"""What is said where something could not be fetched."""

import re

_UNREACHABLE = re.compile(
    r"name resolution|resolve host|resolving|unreachable|unable to connect|could not connect|connection (refused|timed out|reset)"
    r"|NewConnectionError|proxy",
    re.IGNORECASE,
)


class Unreachable(RuntimeError):
    """One line: there is no network, or none that leads there."""


def trouble(program: str, said: str) -> RuntimeError:
    """What has stopped a program that fetches: the network, or what its last words say."""
    if _UNREACHABLE.search(said):
        return Unreachable(
            f"{program} cannot reach its server. Connect this machine, or name a proxy in https_proxy and http_proxy, and give the same"
            " command again: it goes on from there."
        )
    return RuntimeError(f"{program} failed:\n{said[-2000:]}")
