"""How a command of the front door ends: with an exit code, and where it fails with what to do in place of a trace."""

import sys
from collections.abc import Callable


def leave(main: Callable[[list[str]], int]) -> None:
    try:
        sys.exit(main(sys.argv[1:]))
    except (RuntimeError, ValueError) as error:
        print(error, file=sys.stderr)
        sys.exit(1)
    except KeyboardInterrupt:
        sys.exit(130)
