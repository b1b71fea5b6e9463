# SPDX-License-Identifier: BSD-3-Clause
"""How to cite Isostat, from the CITATION.cff next to it: in the source tree or among the installed documents."""
import pathlib
import re

from . import html

HERE = pathlib.Path(__file__).resolve().parent
PLACES = (HERE.parents[1] / "doc/isostat/CITATION.cff", HERE.parents[1] / "CITATION.cff")


def read():
    """The text of CITATION.cff; empty if there is none."""
    for place in PLACES:
        try:
            return place.read_text(encoding="utf-8")
        except OSError:
            continue
    return ""


def sentence(text, version):
    """Authors, title and version in one line."""
    title = re.search(r'^title: *"?(.*?)"?$', text, re.M)
    names = re.findall(r'^ +-? *name: *"?(.*?)"?$', text, re.M)
    names += [f"{given} {family}" for family, given in
              re.findall(r'^ +- *family-names: *"?(.*?)"?\n +given-names: *"?(.*?)"?$', text, re.M)]
    doi = re.search(r'^doi: *"?(.*?)"?$', text, re.M)
    words = [", ".join(names), title[1] if title else "Isostat", f"Version {version}" if version else "",
             f"doi:{doi[1]}" if doi else ""]
    return ". ".join(word for word in words if word) + "."


def parts(version):
    """Paragraphs: what to cite, with the version that made the results."""
    text = read()
    message = re.search(r'^message: *"?(.*?)"?$', text, re.M)
    return [html.paragraph(message[1]) if message else "", html.text_block(sentence(text, version), "citation")]
