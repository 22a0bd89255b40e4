"""The environments of scripts that need packages of Python, which the system need not have."""

import os
import pathlib
import subprocess
import sys
import venv


def enter(folder, packages, patience):
    """Runs the script that calls this again with the Python of an environment that has the packages, and with --inside.
    Ends with 77 where they cannot be had within so many seconds."""
    python = pathlib.Path(folder) / "bin" / "python"
    install = [python, "-m", "pip", "install", "--quiet", "--retries", "1", "--timeout", "20", *packages]
    try:
        if not python.exists():
            venv.create(folder, with_pip=True)
        subprocess.run(install, check=True, timeout=patience)
    except (OSError, subprocess.SubprocessError) as error:
        print(f"skipped: the Python packages cannot be had ({error})")
        sys.exit(77)
    os.execv(python, [str(python), os.path.abspath(sys.argv[0]), "--inside", *sys.argv[1:]])
