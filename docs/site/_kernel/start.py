"""Runs first in the kernel of every page: a folder with the project's data, and %%bash cells that must succeed."""

import os
import subprocess
import tempfile
from pathlib import Path

from IPython import get_ipython
from matplotlib_inline.backend_inline import set_matplotlib_formats

work = Path(tempfile.mkdtemp(dir=os.environ["CRASHSIM_DOCS_WORK"]))
(work / "data").symlink_to(Path(os.environ["CRASHSIM_PROJECT"]) / "data")
os.chdir(work)


def bash(line: str, cell: str) -> None:
    """Runs a cell as a script. Raises CalledProcessError when it fails; what it printed is shown before."""
    script = ["bash", "-euo", "pipefail", "-c", cell]
    result = subprocess.run(script, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(result.stdout, end="")
    result.check_returncode()


get_ipython().register_magic_function(bash, "cell")
set_matplotlib_formats("svg")
del bash, work
