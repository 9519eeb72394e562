"""Which pages the site has: their files, their place in the navigation, and their addresses."""

import posixpath
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Groups of the navigation: files below the repository's root, or an address ending in .html of a page that is made here.
# The order is that of previous and next. A second word is what the navigation says, where the heading is too long for it.
NAVIGATION = {
    "Start": [
        ("README.md", "Overview"),
        ("docs/your-robot.md", "Your robot in ten minutes"),
        ("docs/gallery/README.md", "Gallery of scripts"),
        ("live/index.html", "Live pages"),
    ],
    "Guides": [
        ("docs/real-loops.md",),
        ("docs/tuning.md", "Finding gains"),
        ("docs/proofs.md", "Proofs"),
        ("docs/identification.md",),
        ("docs/logs.md", "Logs of a robot"),
        ("docs/sweeps.md",),
        ("docs/python.md",),
    ],
    "Reference": [
        ("docs/files.md",),
        ("docs/controllers.md",),
        ("docs/estimators.md",),
        ("docs/certificate.md",),
        ("docs/funnel.md",),
        ("docs/tube.md",),
        ("docs/notation.md",),
        ("docs/equations.md", "Equations"),
        ("docs/errata.md",),
        ("api/index.html", "Rust API"),
    ],
    "Project": [
        ("docs/comparison.md", "Laws compared"),
        ("docs/speed.md",),
        ("docs/robustness.md",),
        ("docs/dependencies.md",),
        ("ARCHITECTURE.md",),
        ("viewer/README.md",),
        ("CONTRIBUTING.md",),
        ("CHANGELOG.md",),
    ],
}


@dataclass
class Heading:
    level: int
    anchor: str
    title: str


@dataclass
class Page:
    """A page: where its text is, where it goes, and what rendering it finds."""

    source: str
    address: str
    group: str = ""
    label: str = ""
    title: str = ""
    body: str = ""
    headings: list[Heading] = field(default_factory=list)
    # (anchor, heading, text) of every section, for the search.
    sections: list[tuple[str, str, str]] = field(default_factory=list)

    def to(self, address):
        """The way from this page to an address of the site."""
        return posixpath.relpath(address, posixpath.dirname(self.address) or ".")

    @property
    def root(self):
        return "../" * self.address.count("/")


def address_of(source):
    """docs/files.md is at docs/files.html, a README at its folder."""
    if not source.endswith(".md"):
        return source
    folder, name = posixpath.split(source)
    return posixpath.join(folder, "index.html" if name == "README.md" else name.removesuffix(".md").lower() + ".html")


def listed():
    """Every page of the navigation in its order. A guide that has no place there is an error."""
    pages = []
    for group, entries in NAVIGATION.items():
        for source, *label in entries:
            if not source.endswith(".md") or (ROOT / source).exists():
                pages.append(Page(source, address_of(source), group, label[0] if label else ""))
    known = {page.source for page in pages}
    lost = [name for path in sorted((ROOT / "docs").glob("*.md")) if (name := path.relative_to(ROOT).as_posix()) not in known]
    if lost:
        raise SystemExit(f"no place in the navigation (tools/site/pages.py): {', '.join(lost)}")
    return pages
