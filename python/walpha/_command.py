"""The command ``walpha``, which comes with the package."""

from __future__ import annotations

import os
import sys
from typing import NoReturn

from . import _walpha


def main() -> NoReturn:
    """Run the command line with the arguments of this process, and end it."""
    code = _walpha.command(["walpha", *sys.argv[1:]])
    # The command has flushed what it wrote, and its threads need not be waited for.
    os._exit(code)


if __name__ == "__main__":
    main()
