#!/usr/bin/env python3
"""Is a built site whole? check.py FOLDER: lists what is wrong; exit code 1 if anything is.

Every link and anchor inside the site resolves, every picture, style and script is there, nothing is fetched from elsewhere, no
element is left open, no id is there twice, no link ends in .md, and no page names a folder of the machine that built it.
Pages of `cargo doc` and of the program are only asked for what their links need.
"""

import argparse
import re
import sys
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parents[2]
VOID = set("area base br col embed hr img input link meta source track wbr".split())
# Written by others: their pages need not be well-formed in our sense, but must be there.
OTHERS = ("api/", "live/")


class Reader(HTMLParser):
    """What a page has: ids, links, what it loads, and what is wrong with its elements."""

    def __init__(self):
        super().__init__()
        self.ids, self.links, self.loads, self.wrong, self.open = set(), [], [], [], []

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        line = self.getpos()[0]
        if (name := given.get("id") or (given.get("name") if tag == "a" else None)) is not None:
            if name in self.ids:
                self.wrong.append((line, f"id {name} twice"))
            self.ids.add(name)
        if tag == "a" and given.get("href") is not None:
            self.links.append((line, given["href"]))
        if tag == "img" and "alt" not in given:
            self.wrong.append((line, "a picture without alt"))
        for key in ("src", "href") if tag == "link" else ("src",):
            if given.get(key):
                self.loads.append((line, given[key]))
        if tag not in VOID:
            self.open.append((tag, line))

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if self.open and self.open[-1][0] == tag:
            self.open.pop()
        else:
            self.wrong.append((self.getpos()[0], f"</{tag}> closes nothing"))

    def end(self):
        self.wrong += [(line, f"<{tag}> is not closed") for tag, line in self.open]


@cache
def read(path):
    reader = Reader()
    reader.feed(path.read_text())
    reader.close()
    reader.end()
    return reader


def problems(site):
    """Pairs of a place and what is wrong there."""
    machine = [str(ROOT), str(site), str(Path.home()) + "/"]
    for path in sorted(site.rglob("*.html")):
        name = path.relative_to(site).as_posix()
        reader, text = read(path), path.read_text()
        if any(folder in text for folder in machine):
            yield name, "names a folder of this machine"
        others = name.startswith(OTHERS) and name not in ("api/index.html", "live/index.html")
        if name.startswith("api/") and others:
            continue
        for line, href in reader.links + reader.loads:
            if wrong := unresolved(site, path, href, loaded=(line, href) in reader.loads):
                yield f"{name}:{line}", wrong
        if not others:
            for line, wrong in reader.wrong:
                yield f"{name}:{line}", wrong
    yield from index(site)


def unresolved(site, path, href, loaded):
    """Why a link leads nowhere, or None."""
    parts = urlsplit(href)
    if parts.scheme in ("data", "blob", "javascript"):
        return None
    if parts.scheme or href.startswith("//"):
        return f"loads {href} from a network" if loaded else None
    if parts.path.endswith(".md"):
        return f"a link to Markdown: {href}"
    if parts.path.startswith("/"):
        return f"an absolute path: {href}"
    to = (path.parent / unquote(parts.path)).resolve() if parts.path else path
    if not to.is_relative_to(site.resolve()):
        return f"leads out of the site: {href}"
    if not to.is_file():
        return f"no such file: {href}"
    if parts.fragment and to.suffix == ".html" and not parts.fragment.startswith("t="):
        if unquote(parts.fragment) not in read(to).ids:
            return f"no such anchor: {href}"
    return None


def index(site):
    """What the search leads to is there."""
    text = (site / "site" / "index.js").read_text()
    addresses = re.findall(r'^\["(?:[^"\\]|\\.)*", "(?:[^"\\]|\\.)*", "((?:[^"\\]|\\.)*)"', text, re.M)
    if not addresses:
        yield "site/index.js", "an empty index"
    for address in addresses:
        if wrong := unresolved(site, site / "index.html", address, loaded=False):
            yield "site/index.js", wrong


def main():
    parse = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parse.add_argument("site", type=Path, metavar="FOLDER")
    site = parse.parse_args().site.resolve()
    if not (site / "index.html").is_file():
        raise SystemExit(f"{site}: no site")
    found = list(problems(site))
    for place, wrong in found:
        print(f"{place}: {wrong}")
    pages = [path for path in site.rglob("*.html") if "api" not in path.relative_to(site).parts[:1]]
    links = sum(len(read(path).links) for path in pages)
    print(f"{len(pages)} pages, {links} links, {len(found)} problems", file=sys.stderr)
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
