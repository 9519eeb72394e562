"""Where the links of the Markdown lead on the site: pages, pictures, and pages of the source files that are named."""

import posixpath
from urllib.parse import unquote, urlsplit

from pages import ROOT

PICTURES = {".png", ".svg", ".jpg", ".gif"}


class Links:
    """Resolves links of pages; remembers which files and folders they need and what is wrong."""

    def __init__(self, pages):
        self.pages = {page.source: page for page in pages}
        self.files, self.folders, self.pictures = set(), set(), set()
        # (page, line, target, anchor) to be looked at when every heading is known.
        self.anchors, self.problems = [], []

    def of(self, page):
        return lambda href, line, is_image: self.resolve(page, href, line, is_image)

    def resolve(self, page, href, line, is_image=False):
        parts = urlsplit(href)
        if parts.scheme or href.startswith("//"):
            return href
        where = posixpath.normpath(posixpath.join(posixpath.dirname(page.source), unquote(parts.path)))
        anchor = f"#{parts.fragment}" if parts.fragment else ""
        if not parts.path:
            where = page.source
        if where in self.pages:
            if anchor:
                self.anchors.append((page, line, where, unquote(parts.fragment)))
            return anchor if not parts.path else page.to(self.pages[where].address) + anchor
        path = ROOT / where
        if where.startswith("../") or not path.exists():
            self.problems.append(f"{page.source}:{line}: no such file: {href}")
            return href
        if is_image or path.suffix in PICTURES:
            self.pictures.add(where)
            return page.to(where)
        if path.is_dir():
            readme = f"{where}/README.md"
            if readme in self.pages:
                return page.to(self.pages[readme].address)
            self.folders.add(where)
            return page.to(f"source/{where}/index.html")
        if path.suffix == ".md":
            self.problems.append(f"{page.source}:{line}: no page of the site: {href}")
        self.files.add(where)
        return page.to(f"source/{where}.html")

    def check_anchors(self):
        for page, line, where, anchor in self.anchors:
            if anchor not in {heading.anchor for heading in self.pages[where].headings}:
                self.problems.append(f"{page.source}:{line}: no heading #{anchor} in {where}")
