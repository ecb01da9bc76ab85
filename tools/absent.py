"""Stand-ins for packages that the set-up brings: with them, what an experiment understands is read before the set-up."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.machinery import ModuleSpec
from unittest.mock import MagicMock


class _StandIns:
    """Finds every module that nothing else finds, apart from those of Python itself."""

    def find_spec(self, name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        is_pythons = name.partition(".")[0] in sys.stdlib_module_names
        return None if is_pythons else ModuleSpec(name, self, is_package=True)  # type: ignore[arg-type]

    def create_module(self, spec: ModuleSpec) -> MagicMock:
        return MagicMock(name=spec.name)

    def exec_module(self, module: MagicMock) -> None:
        pass


@contextmanager
def stood_in_for() -> Iterator[None]:
    """Within it, a module that is not installed can be imported and does nothing."""
    finder = _StandIns()
    sys.meta_path.append(finder)  # type: ignore[arg-type]
    try:
        yield
    finally:
        sys.meta_path.remove(finder)  # type: ignore[arg-type]
