# SPDX-License-Identifier: BSD-3-Clause
"""A figure of matplotlib as SVG for a page: small, with its own ids, without links to anything outside."""
import io
import itertools
import re

from matplotlib.collections import Collection, LineCollection, QuadMesh
from matplotlib.lines import Line2D

from figures.common import plt

MOST_PARTS = 1500  # segments and marks of a figure; more become images, because each would be an element of its own
FEW_PARTS = 50  # of an artist that stays as it is
DIGITS = 2  # of coordinates, in points: 0.01 pt is a seventieth of a pixel of a screen
IMAGE_DPI = 180  # of what becomes an image
NO_METADATA = {"Date": None, "Creator": None, "Format": None, "Type": None}

LONG_NUMBER = re.compile(r"-?\d+\.\d{3,}")
PATH_DATA = re.compile(r'(?<= )(d|x|y)="([^"]*)"')
IDENTIFIER = re.compile(r'\bid="|(?<=href=")#|(?<=url\()#')


def parts_of(artist):
    """The number of elements that an artist would become, if each of its parts is one; else 0."""
    if isinstance(artist, LineCollection):
        return len(artist.get_paths())
    if isinstance(artist, Collection):
        return len(artist.get_offsets())
    has_marks = isinstance(artist, Line2D) and artist.get_marker() not in ("", " ", "None", None)
    return len(artist.get_xdata()) if has_marks else 0


def rasterize(figure):
    """Makes images of meshes, and of all artists in parts if they are too many together."""
    for artist in figure.findobj(QuadMesh):
        artist.set_rasterized(True)
    others = [artist for artist in figure.findobj(parts_of) if not isinstance(artist, QuadMesh)]
    if sum(map(parts_of, others)) > MOST_PARTS:
        for artist in others:
            artist.set_rasterized(parts_of(artist) > FEW_PARTS)


def shortened(text):
    """Coordinates with DIGITS digits; numbers of transformations keep all."""
    def number(match):
        return f"{float(match[0]):.{DIGITS}f}".rstrip("0").rstrip(".")
    return PATH_DATA.sub(lambda match: f'{match[1]}="{LONG_NUMBER.sub(number, match[2])}"', text)


def height_of_title(figure):
    """Points at the top of the figure, as it was drawn last, that its title takes; the title is removed."""
    title = figure._suptitle  # pylint: disable=protected-access  (3.6 has no way to ask)
    if title is None or not title.get_text():
        return 0.0
    extent, whole = title.get_window_extent(), figure.bbox
    title.set_text("")
    return 72 / figure.dpi * max(0.0, whole.y1 - extent.y0)


def element(figure, prefix):
    """The element <svg> of a figure that has been drawn, and its width in points. Every id begins with `prefix`.

    The figure keeps its layout except for its title, which is in the page. Lines are simplified as in the image;
    meshes, and what has too many parts, become images within the SVG.
    """
    top = height_of_title(figure)
    figure.set_layout_engine("none")
    rasterize(figure)
    text = io.StringIO()
    with plt.rc_context({"svg.fonttype": "path", "svg.hashsalt": prefix}):
        figure.savefig(text, format="svg", dpi=IMAGE_DPI, metadata=NO_METADATA)
    svg = text.getvalue()
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r"<!--.*?-->\s*", "", svg, flags=re.S)
    svg = shortened(svg.replace("xlink:href", "href"))
    number = itertools.count()  # ids of images follow from their pixels, which may be the same in two panels
    svg = re.sub(r'(?<= id=")image[0-9a-f]+', lambda _: f"image{next(number)}", svg)
    svg = IDENTIFIER.sub(lambda match: match[0] + prefix + "-", svg)
    width, height = map(float, re.search(r'viewBox="0 0 (\S+) (\S+)"', svg).groups())
    view = f"0 {round(top, 1):g} {width:g} {round(height - top, 1):g}"
    opening = f'<svg viewBox="{view}" preserveAspectRatio="xMidYMid meet"'
    return re.sub(r"<svg[^>]*", opening, svg, count=1), width
