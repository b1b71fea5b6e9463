#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks every link of a built site that stays within it: the file is there, and so is the anchor.

    check_links.py build/docs/html

Prints each broken link as page: target and returns 1 if there is one. Links to the network are counted, not followed;
no page may load a script, a style or a picture from it.
"""
import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    """Links and anchors of a page."""

    def __init__(self, path):
        super().__init__()
        self.links, self.loads, self.anchors = set(), set(), set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.anchors.update(given[name] for name in ("id", "name") if given.get(name))
        target = given.get("href") if tag in ("a", "link") else given.get("src")
        if target:
            (self.links if tag == "a" else self.loads).add(target)


def main(folder):
    root = pathlib.Path(folder).resolve()
    pages = {path: Page(path) for path in sorted(root.rglob("*.html")) if "mathjax" not in path.parts}
    broken, inside, outside = [], 0, 0
    for path, page in pages.items():
        for target in sorted(page.links | page.loads):
            url = urllib.parse.urlsplit(target)
            if url.scheme == "data" or target.startswith("javascript:"):
                continue
            if url.scheme or url.netloc:
                outside += 1
                if target in page.loads:
                    broken.append(f"{path.relative_to(root)}: loads {target} from the network")
                continue
            inside += 1
            file = (path.parent / urllib.parse.unquote(url.path)).resolve() if url.path else path
            anchor = urllib.parse.unquote(url.fragment)
            if not file.is_file() or not file.is_relative_to(root):
                broken.append(f"{path.relative_to(root)}: {target} is not there")
            elif anchor and file in pages and anchor not in pages[file].anchors:
                broken.append(f"{path.relative_to(root)}: {target} has no such anchor")
    for line in broken:
        print(line)
    print(f"links: {len(pages)} pages, {inside} links within the site, {outside} to elsewhere, {len(broken)} broken")
    return 1 if broken or not pages else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
