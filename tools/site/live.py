"""Pages that the program writes: runs in motion, the report, margins and a comparison, with a page that shows them all."""

import os
import shutil
import subprocess
from dataclasses import dataclass
from html import escape

from markdown import block
from pages import ROOT


@dataclass
class Show:
    """A command of the program, its page and picture, and what is to be seen there, in HTML."""

    folder: str
    title: str
    words: str
    page: str
    picture: str
    says: str
    tag: str = ""


SHOWS = [
    Show(
        "panda",
        "A seven-joint arm in motion",
        "run panda-tanh-smooth --view --out DIR",
        "panda-tanh-smooth.view.html",
        "panda-tanh-smooth.png",
        "Links and motors in three dimensions, deflection of the joints magnified, and charts of every joint under the same clock.",
    ),
    Show(
        "pair",
        "Two laws side by side",
        "run --view two-link-linear-smooth two-link-tanh-smooth --out DIR",
        "two-link-linear-smooth-and-two-link-tanh-smooth.view.html",
        "two-link-tanh-smooth.png",
        "The two-link arm under a linear and a tanh shaping function: the same motion, the same moment, one view.",
    ),
    Show(
        "run",
        "A run, and what is proved of its errors",
        "run two-link-tanh --page DIR --out DIR",
        "two-link-tanh.run.html",
        "two-link-tanh.run.png",
        "What came of a run in a sentence, its figure with the proved bound of the errors, and what it took of every limit.",
    ),
    Show(
        "reproduce",
        "The experiments of the paper",
        "reproduce --out DIR",
        "report.html",
        "two-link-tanh.png",
        "One self-contained report: tables, figures, certified rates, every assumed number and every slip of the paper.",
    ),
    Show(
        "certify",
        "What is proved of a loop",
        "certify two-link-tanh --error-box 3 --page DIR --out DIR/two-link-tanh.certificate.json",
        "two-link-tanh.certify.html",
        "two-link-tanh.certify.png",
        "The region of the proof, the level that is not left, how fast errors shrink, and the run inside.",
    ),
    Show(
        "tune",
        "Gains that were found",
        "tune two-link-hardware --budget 10 --page DIR --out DIR/two-link-hardware-tuned.toml",
        "two-link-hardware.tune.html",
        "two-link-hardware.tune.png",
        "What the loop takes of each limit, what each gain trades, and what the loop bears.",
    ),
    Show(
        "margins",
        "How much a loop bears",
        "margins pendulum-tanh --page DIR",
        "pendulum-tanh.margins.html",
        "pendulum-tanh.margins.png",
        "Delay, torque gain, stiffness error and noise, each raised until the loop no longer follows.",
    ),
    Show(
        "compare",
        "Control laws compared",
        "compare task-ideal-tracking task-soft --budget 1 --seeds 1 --out DIR",
        "compare.html",
        "compare-map.png",
        "Every law on two tasks, with almost no search for gains: how the page looks, not who is best. "
        'The full one is under <a href="../docs/comparison.html">laws compared</a>.',
        "quick look",
    ),
]


def program():
    """The program: what FLEXURE names, else what `cargo build --release` leaves."""
    target = os.environ.get("CARGO_TARGET_DIR", ROOT / "target")
    named = os.environ.get("FLEXURE", f"{target}/release/flexure")
    return shutil.which(named)


def make(out):
    """Runs every command into its folder; the shows that came out, and what went wrong."""
    runs, problems = program(), []
    if not runs:
        return [], ["no program for the live pages: cargo build --release, or FLEXURE=PATH"]
    there = []
    for show in SHOWS:
        folder = out / show.folder
        done = subprocess.run(
            [runs, *show.words.replace("DIR", str(folder)).split()], cwd=out, capture_output=True, text=True, stdin=subprocess.DEVNULL
        )
        if done.returncode not in (0, 1):
            said = (done.stderr.strip().splitlines() or ["nothing said"])[0]
            problems.append(f"flexure {show.words}: exit code {done.returncode}: {said}")
        elif not (folder / show.page).is_file():
            problems.append(f"flexure {show.words}: wrote no {show.page}")
        else:
            drop_unlinked(folder, (folder / show.page).read_text(), show.page)
            there.append(show)
    return there, problems


def drop_unlinked(folder, text, page):
    """Traces of tens of MB and other files that the page does not lead to; its pictures stay."""
    for path in folder.iterdir():
        if path.name != page and path.suffix != ".png" and f'"{path.name}"' not in text:
            path.unlink()


def picture(out, show):
    """The picture of a show, or any of the pictures that its command wrote."""
    wrote = sorted(path.name for path in (out / show.folder).glob("*.png"))
    return show.picture if show.picture in wrote else wrote[0] if wrote else None


def body(out, shows):
    """The page that shows them all."""
    parts = [
        "<h1>Live pages</h1>\n<p>Each of these pages is what the program wrote with the command below it, in one file without a network. "
        "Everything shown is simulated.</p>\n"
    ]
    if not shows:
        return parts[0] + "<p>They are not in this copy of the site, which was built without the program.</p>"
    parts.append('<div class="live">\n')
    for show in shows:
        where, image = f"{show.folder}/{show.page}", picture(out, show)
        tag = f' <span class="tag">{escape(show.tag)}</span>' if show.tag else ""
        parts.append("<section>\n")
        if image:
            parts.append(
                f'<a class="picture" href="{where}" tabindex="-1" aria-hidden="true"><img src="{show.folder}/{image}" alt=""></a>\n'
            )
        parts.append(f'<div><h2><a href="{where}">{escape(show.title)}</a>{tag}</h2>\n<p>{show.says}</p>\n')
        parts.append(block(f"flexure {show.words}\n", "sh") + "</div>\n</section>\n")
    return "".join(parts) + "</div>\n"
