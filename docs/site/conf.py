"""Configuration of the documentation site; script/docs builds it."""

import os
import re
import sys
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

SITE = Path(__file__).parent
PROJECT = Path(os.environ["CRASHSIM_PROJECT"])
sys.path.insert(0, str(SITE))


def read_version() -> str:
    """Version of the project, from its CMakeLists.txt."""
    found = re.search(r"^project\(crashsim VERSION ([0-9.]+)", (PROJECT / "CMakeLists.txt").read_text(), re.MULTILINE)
    if found is None:
        raise ValueError("CMakeLists.txt: no project(crashsim VERSION ...)")
    return found[1]


project = "crashsim"
author = "the crashsim authors"
copyright = author
version = release = read_version()
language = "en"

extensions = [
    "_extensions.mathml",
    "_extensions.shell_cells",
    "breathe",
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
]
exclude_patterns = ["project/**"]
nitpicky = False

# Markdown. ```math blocks are what GitHub shows as equations, too.
myst_enable_extensions = ["attrs_block", "attrs_inline", "colon_fence", "deflist", "dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 3
myst_url_schemes = ["http", "https", "mailto"]

# Examples: every cell is run on every build; one that fails is a warning, and warnings are errors.
nb_execution_mode = "force"
nb_execution_timeout = 300
nb_execution_show_tb = True
nb_merge_streams = True

# C++
breathe_projects = {"crashsim": os.environ["CRASHSIM_DOXYGEN_XML"]}
breathe_default_project = "crashsim"
breathe_default_members = ("members",)
breathe_show_include = False
breathe_order_parameters_first = True
cpp_maximum_signature_line_length = 90

# Python
napoleon_use_param = False
napoleon_use_rtype = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 90
python_use_unqualified_type_names = True

# Look
html_theme = "furo"
html_title = f"crashsim {version}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "navigation_with_keys": True,
    "light_css_variables": {"color-brand-primary": "#00598f", "color-brand-content": "#00598f"},
    "dark_css_variables": {"color-brand-primary": "#6cc0f0", "color-brand-content": "#6cc0f0"},
}
pygments_style = "tango"
pygments_dark_style = "monokai"
copybutton_selector = "div.highlight-bash pre, div.highlight-cmake pre, div.highlight-cpp pre, div.cell_input pre"
copybutton_exclude = ".linenos, .gp"


def plain_types(*event: Any) -> tuple[str, str] | None:
    """Signatures without the module that the classes live in."""
    arguments, result = event[-2:]
    if arguments is None:
        return None
    return arguments.replace("crashsim._core.", ""), (result or "").replace("crashsim._core.", "")


OVERLOAD = re.compile(r"(\d+\. )(\w+\(.*)$")


def literal_overloads(*event: Any) -> None:
    """Signatures of overloads stand in the docstring: as code, not as text with stars."""
    lines = event[-1]
    lines[:] = [OVERLOAD.sub(r"\1``\2``", line).replace("crashsim._core.", "") for line in lines]


def setup(app: Sphinx) -> None:
    """Registers what the configuration itself does."""
    app.connect("autodoc-process-docstring", literal_overloads, priority=400)
    app.connect("autodoc-process-signature", plain_types)
