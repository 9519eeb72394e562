"""Pages of the source files that the documentation names, highlighted, and lists of folders of them."""

import shutil
from html import escape

from markdown import coloured
from pages import ROOT, Page

LANGUAGES = {
    ".rs": "rust",
    ".toml": "toml",
    ".py": "python",
    ".json": "json",
    ".urdf": "xml",
    ".mplstyle": "ini",
    ".txt": "text",
}
# Files beyond this are copied, but not shown in colour.
LARGEST = 200_000


def file_page(name, out):
    """The page of a file; the file itself lies beside it."""
    path = ROOT / name
    copy = out / "source" / name
    copy.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(path, copy)
    text = path.read_text()
    page = Page(name, f"source/{name}.html", title=name)
    language = LANGUAGES.get(path.suffix, "text") if len(text) <= LARGEST else "text"
    page.body = (
        f"<h1 class='path'>{escape(name)}</h1>\n"
        f'<p class="note">{len(text.splitlines())} lines · <a href="{escape(path.name)}">the file itself</a></p>\n'
        f'<div class="code file"><pre tabindex="0"><code>{coloured(text, language)}</code></pre></div>\n'
    )
    return page


def folder_page(name, files):
    """The list of a folder: every file with the comment that it begins with."""
    page = Page(name, f"source/{name}/index.html", title=f"{name}/")
    rows = []
    for file in files:
        short = file.removeprefix(f"{name}/")
        rows.append(
            f'<tr><td><a href="{escape(short)}.html"><code>{escape(short)}</code></a></td><td>{escape(about(file))}</td></tr>'
        )
    page.body = (
        f"<h1 class='path'>{escape(name)}/</h1>\n"
        '<div class="scroll"><table><thead><tr><th>file</th><th>begins with</th></tr></thead>'
        f"<tbody>{''.join(rows)}</tbody></table></div>\n"
    )
    return page


def about(file):
    """The first sentence of the comment at the head of a file, or nothing."""
    words = []
    for line in (ROOT / file).read_text().splitlines():
        if not line.startswith("#"):
            break
        words.append(line.strip("# "))
    text = " ".join(words)
    return text.split(". ")[0].rstrip(".") + ("." if text else "")


def files_of(folder):
    paths = sorted(path for path in (ROOT / folder).iterdir() if path.suffix in LANGUAGES)
    return [path.relative_to(ROOT).as_posix() for path in paths]
