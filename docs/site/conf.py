# SPDX-License-Identifier: BSD-3-Clause
"""The documentation site (Sphinx, MyST). Its source is the repository itself: the pages are the Markdown files that are
read there, too. Built by scripts/docs.sh, without network."""
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [os.environ["ISOSTAT_PYTHONPATH"]]  # the package, for its reference

project = "Isostat"
author = "The Isostat authors"
copyright = author  # pylint: disable=redefined-builtin  (the name is Sphinx's)
version = release = re.search(r"project\(\w+ VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text("utf-8"))[1]

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax"]
root_doc = "docs/index"
include_patterns = ["*.md", "docs/*.md", "docs/campaigns/*.md", "docs/guide/*.md", "docs/results/*.md",
                    "docs/results/paper/*.md", "docs/tutorial/*.md", "apps/**.md", "benchmarks/README.md", "studies/README.md",
                    "tests/reference/README.md"]
exclude_patterns = ["build", "results", ".git", "docs/site", "**/figures"]

myst_enable_extensions = ["dollarmath"]
myst_dmath_allow_labels = False
myst_heading_anchors = 4
suppress_warnings = ["myst.header", "toc.excluded"]

html_theme = "furo"
html_title = f"Isostat {version}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_last_updated_fmt = None
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_SVG"  # scripts/docs.sh copies it from the Debian package
myst_update_mathjax = False  # its setting is that of MathJax 3
mathjax2_config = {"tex2jax": {"processClass": "math", "processEnvironments": True},
                   "SVG": {"font": "TeX", "scale": 88, "linebreaks": {"automatic": True}}, "messageStyle": "none"}

autodoc_member_order = "bysource"
autodoc_typehints = "none"
highlight_language = "none"

EQUATION = "```{math}\n:nowrap:\n\n\\\\begin{equation*}\n\\1\\\\end{equation*}\n```"


def as_site(_app, docname, source):
    """What GitHub shows in its own way: equations in blocks named math, and links to folders."""
    folder = (ROOT / docname).parent
    source[0] = re.sub(r"^%", r"\\%", source[0], flags=re.M)  # MyST would take it for a comment
    if not source[0].startswith("# "):  # a generated table
        source[0] = f"# {pathlib.PurePath(docname).name.capitalize()}\n\n{source[0]}"
    text = re.sub(r"^```math\n(.*?)^```$", EQUATION, source[0], flags=re.M | re.S)

    def link(match):
        target = folder / match[2].split("#")[0]
        if match[2].startswith("#") or not target.is_dir():
            return match[0]
        return f"[{match[1]}]({match[2].rstrip('/')}/README.md)" if (target / "README.md").is_file() else match[1]

    source[0] = re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s:]+)\)", link, text)


def as_text(_app, _what, _name, _object, _options, lines):
    """Docstrings are plain text: paragraphs with columns or indents stay as they are, marks mean themselves."""
    paragraphs = [part.split("\n") for part in "\n".join(lines).strip("\n").split("\n\n") if part.strip()]
    lines[:] = []
    for part in paragraphs:
        if any(re.search(r"\S   +\S", line) or line.startswith("  ") for line in part):
            is_going_on = len(lines) > 1 and lines[-2].startswith("    ")
            lines += [*([] if is_going_on else ["::", ""]), *("    " + line for line in part), ""]
        else:
            lines += [*(re.sub(r"([*_|`\\])", r"\\\1", line) for line in part), ""]


def setup(app):
    app.connect("source-read", as_site)
    app.connect("autodoc-process-docstring", as_text)
