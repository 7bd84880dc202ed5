"""Configuration of Sphinx for the documentation as a site. tools/site.py calls it."""
import logging
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))

project = "Tyndall"
copyright = "The authors of Tyndall"
release = re.search(r'TYNDALL_VERSION_STRING "([^"]*)"', (ROOT / "include/tyndall/version.h").read_text()).group(1)
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
root_doc = "index"
exclude_patterns = ["site"]
html_theme = "sphinx_rtd_theme"
html_theme_options = {"navigation_depth": 2, "collapse_navigation": False}
html_show_sourcelink = False
html_static_path = []
# Anchors as on the pages of the repository.
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # decisions are numbered in their titles
breathe_projects = {"tyndall": os.environ.get("TYNDALL_DOXYGEN_XML", str(ROOT / "build/site-doxygen/xml"))}
breathe_default_project = "tyndall"
# The Python sources are documented without the extension module, so that nothing has to be built.
autodoc_mock_imports = ["tyndall._core"]
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True}
highlight_language = "none"


class NoDuplicates(logging.Filter):
    """Doxygen declares a structure in C twice, as struct and as typedef, and Sphinx warns."""

    def filter(self, record):
        return "Duplicate" not in str(record.msg)


def listed(app, what, name, obj, options, lines):
    """Turns the arguments of our docstrings, lines such as "name: meaning", into a list."""
    out, inside = [], False
    for line in lines:
        match = re.match(r"([a-z_]+(?:, [a-z_]+)*): (.*)", line)
        if match:
            out += [] if inside else [""]
            out.append(f"* ``{match[1]}``: {match[2]}")
            inside = True
        elif inside and line.startswith("    "):
            out.append("  " + line.strip())
        else:
            out += [""] if inside and line else []
            out.append(line)
            inside = False
    lines[:] = out + [""]


def setup(app):
    app.connect("autodoc-process-docstring", listed)
    for handler in logging.getLogger("sphinx").handlers:
        handler.filters.insert(0, NoDuplicates())  # before the filter that counts
