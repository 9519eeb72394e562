#!/usr/bin/env python3
"""The documentation as a static site: build.py [--out FOLDER] [--no-api] [--no-live].

The guides of the repository, the Rust interface of `cargo doc`, and pages that the program writes (FLEXURE names it, else the release
build is taken). The site needs no server and no network. Building it twice gives the same bytes. Exit code 1: links that lead
nowhere, or pages that could not be made; they are listed.
"""

import argparse
import json
import os
import re
import shutil
import string
import subprocess
import sys
import tomllib
import venv
from html import escape
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
INSIDE = "FLEXURE_SITE_ENVIRONMENT"
LICENSES = ["LICENSE-MIT", "LICENSE-APACHE"]
# A folder is only replaced if it holds a site.
MARK = "site/site.css"


def enter_environment():
    """Goes on in an environment below target/ that has the packages of requirements.txt."""
    place = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "site-env"
    wanted = (HERE / "requirements.txt").read_text()
    python, stamp = place / "bin" / "python", place / "installed.txt"
    if not stamp.exists() or stamp.read_text() != wanted:
        venv.create(place, with_pip=True, clear=True)
        if subprocess.run([python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt"]).returncode:
            raise SystemExit("the packages of tools/site/requirements.txt could not be installed")
        stamp.write_text(wanted)
    sys.stdout.flush()
    os.execve(python, [str(python), str(Path(__file__).resolve()), *sys.argv[1:]], {**os.environ, INSIDE: "1"})


def navigation(page, pages):
    """The links to all pages, grouped, the current one marked."""
    parts, group = [], None
    for other in pages:
        if other.group != group:
            parts.append(("</ul>\n" if group else "") + f"<h2>{escape(other.group)}</h2>\n<ul>\n")
            group = other.group
        here = ' aria-current="page"' if other is page else ""
        parts.append(f'<li><a href="{page.to(other.address)}"{here}>{escape(other.label or other.title)}</a></li>\n')
    return "".join(parts) + "</ul>"


def outline(page):
    """The headings of a page as a list, or nothing if there are hardly any."""
    shown = [heading for heading in page.headings if heading.level in (2, 3)]
    if len(shown) > 24:
        shown = [heading for heading in shown if heading.level == 2]
    if len(shown) < 3:
        return ""
    items = (f'<li class="h{h.level}"><a href="#{escape(h.anchor)}">{escape(h.title)}</a></li>' for h in shown)
    return "<ul>\n" + "\n".join(items) + "\n</ul>"


def neighbours(page, pages):
    if page not in pages:
        return ""
    at = pages.index(page)
    parts = []
    for kind, word, other in [("previous", "Previous", at - 1), ("next", "Next", at + 1)]:
        if 0 <= other < len(pages):
            to = pages[other]
            parts.append(
                f'<a class="{kind}" rel="{kind[:4]}" href="{page.to(to.address)}"><span>{word}</span>{escape(to.label or to.title)}</a>'
            )
    return f'<nav class="neighbours" aria-label="Neighbours">{"".join(parts)}</nav>'


class Site:
    """The folder of a site, the pages that it has, and what went wrong."""

    def __init__(self, out):
        import links
        import pages

        self.out = out
        self.pages = pages.listed()
        self.links = links.Links(self.pages)
        self.problems = []
        self.template = string.Template((HERE / "page.html").read_text())
        self.version = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]

    def write(self, page):
        name = "Flexure" if page.title == "Flexure" else f"{page.title} · Flexure"
        lines = outline(page)
        origin = ""
        if page.source.endswith(".md"):
            origin = f" · <code>{escape(page.source)}</code>"
        text = self.template.substitute(
            title=escape(name),
            description=escape(self.description(page)),
            root=page.root,
            version=escape(self.version),
            kind="" if lines else " alone",
            here=f"{escape(page.label or page.title)} <span>· all pages</span>",
            navigation=navigation(page, self.pages),
            outline=f'<nav class="outline" aria-label="On this page"><h2>On this page</h2>{lines}</nav>' if lines else "",
            outline_small=f'<details class="outline-small"><summary>On this page</summary>{lines}</details>' if lines else "",
            body=page.body.rstrip(),
            neighbours=neighbours(page, self.pages),
            origin=origin,
        )
        path = self.out / page.address
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def description(self, page):
        text = next((words for _, _, words in page.sections if words), page.title)
        return text if len(text) <= 160 else text[:157].rsplit(" ", 1)[0] + " …"

    def guides(self):
        """All that is Markdown, and then what it names."""
        import markdown

        for page in self.pages:
            if page.source.endswith(".md"):
                markdown.render(page, (ROOT / page.source).read_text(), self.links.of(page))
        self.links.check_anchors()
        front = self.pages[0]
        front.body = front.body.replace("</p>\n", "</p>\n" + self.ways(front), 1)

    def ways(self, front):
        """Where to go from the front page."""
        cards = [
            ("docs/your-robot.html", "Your robot in ten minutes", "From a URDF to a loop that follows its reference"),
            ("live/index.html", "Live pages", "Arms in motion, reports and margins, as the program writes them"),
            ("docs/files.html", "Files and commands", "Every key of a robot and a scenario, every option"),
        ]
        links = (f'<a href="{front.to(to)}"><b>{escape(title)}</b>{escape(words)}</a>' for to, title, words in cards)
        return f'<div class="ways">{"".join(links)}</div>\n'

    def files(self):
        """Pictures, and pages of source files and folders."""
        import source

        for name in sorted(self.links.pictures):
            copy(ROOT / name, self.out / name)
        files = {*self.links.files, *LICENSES}
        for folder in sorted(self.links.folders):
            inside = source.files_of(folder)
            files |= set(inside)
            self.write(source.folder_page(folder, inside))
        for name in sorted(files):
            self.write(source.file_page(name, self.out))

    def live(self, wanted):
        import live

        page = next(page for page in self.pages if page.address == "live/index.html")
        folder = self.out / "live"
        folder.mkdir(parents=True, exist_ok=True)
        shows, problems = live.make(folder) if wanted else ([], [])
        self.problems += problems
        page.title, page.body = "Live pages", live.body(folder, shows)
        page.sections = [("", "", re.sub("<.*?>", "", " ".join(f"{show.title}. {show.says}" for show in shows)))]

    def api(self, wanted):
        """A copy of what `cargo doc` leaves, with a page of its crates."""
        page = next(page for page in self.pages if page.address == "api/index.html")
        if wanted:
            subprocess.run(["cargo", "doc", "--quiet", "--workspace", "--no-deps", "--locked"], cwd=ROOT, check=True)
        doc = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "doc"
        crates = self.crates(doc) if doc.is_dir() else {}
        if crates:
            # Its own list of crates, if it has one, gives way to the page made here.
            spare = {".lock", "index.html"}
            shutil.copytree(doc, self.out / "api", ignore=lambda at, names: spare if Path(at) == doc else set())
        page.title = "Rust API"
        page.body = "<h1>Rust API</h1>\n<p>The interface of every crate, as <code>cargo doc</code> writes it.</p>\n"
        if crates:
            rows = (
                f'<tr><td><a href="{name}/index.html"><code>{name}</code></a></td><td>{escape(words)}</td></tr>'
                for name, words in crates.items()
            )
            page.body += (
                '<div class="scroll"><table><thead><tr><th>crate</th><th>what it is</th></tr></thead>'
                f"<tbody>{''.join(rows)}</tbody></table></div>\n"
            )
        else:
            page.body += (
                "<p>It is not in this copy of the site, which was built without it: "
                "<code>cargo doc --workspace --no-deps --open</code> shows it.</p>\n"
            )
        page.sections = [("", "", " ".join(f"{name} {words}" for name, words in crates.items()))]

    def crates(self, doc):
        """Crates of the workspace that have pages, with what their manifests say of them."""
        found = {}
        for manifest in sorted((ROOT / "crates").glob("*/Cargo.toml")):
            about = tomllib.loads(manifest.read_text())
            for name in (about.get("lib", {}).get("name", ""), about["package"]["name"].replace("-", "_")):
                if name and (doc / name / "index.html").is_file():
                    found[name] = about["package"].get("description", "")
        # What the others are built on or bind to comes last.
        return dict(sorted(found.items(), key=lambda item: (not item[0].startswith("flexure"), item[0])))

    def search(self):
        """The index: page, heading, address and text of each section."""
        entries = []
        for page in self.pages:
            for anchor, heading, words in page.sections:
                address = page.address + (f"#{anchor}" if anchor else "")
                entries.append([page.label or page.title, heading if heading != page.title else "", address, words])
        lines = ",\n".join(json.dumps(entry, ensure_ascii=False) for entry in entries)
        (self.out / "site" / "index.js").write_text(f"window.searchIndex = [\n{lines}\n];\n")

    def build(self, api, live):
        for name in ("site.css", "search.js", "icon.svg"):
            copy(HERE / name, self.out / "site" / name)
        self.guides()
        self.api(api)
        self.live(live)
        for page in self.pages:
            self.write(page)
        self.files()
        self.search()
        return self.links.problems + self.problems


def copy(origin, to):
    to.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(origin, to)


def emptied(out):
    if out.exists() and any(out.iterdir()):
        if not (out / MARK).exists():
            raise SystemExit(f"{out} is not empty and is no site: not replaced")
        shutil.rmtree(out)
    out.mkdir(parents=True, exist_ok=True)
    return out


def main():
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    parse = argparse.ArgumentParser(description=re.split(r"\n\n", __doc__)[0])
    parse.add_argument(
        "--out", type=Path, default=target / "site", help="the folder, replaced if it holds a site (target/site)"
    )
    parse.add_argument("--no-api", action="store_true", help="do not run cargo doc; what is in target/doc is taken")
    parse.add_argument("--no-live", action="store_true", help="without the pages that the program writes")
    given = parse.parse_args()
    if not os.environ.get(INSIDE):
        enter_environment()
    problems = Site(emptied(given.out.resolve())).build(not given.no_api, not given.no_live)
    for problem in problems:
        print(problem, file=sys.stderr)
    print(given.out / "index.html")
    sys.exit(bool(problems))


if __name__ == "__main__":
    main()
