#!/usr/bin/env python3
"""Do the commands of the documentation run? commands.py [PAGE...]: each `flexure` line of the shell blocks, as a reader would type it.

One folder a page, commands in the order of the page, the program on the PATH (FLEXURE names it, else the release build is taken),
the repository's robots and scenarios beside, and every TOML block that begins with a file name written under that name. Exit
codes 0 and 1 are answers unless the line names its code; any other is a failure, and so is an option that the program does not know in a
line that is not run or stands in a sentence. Exit code 1 of this script: something failed.

Not here, as the tests of the program run it: docs/your-robot.md (crates/flexure-cli/tests/suite/guide.rs).
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LIMIT = 60.0
COVERED = {"docs/your-robot.md": "crates/flexure-cli/tests/suite/guide.rs runs all of it"}

# What a page takes for granted: files that its reader has, and the commands that make them here.
GIVEN = {
    "docs/identification.md": [
        "flexure excite two-link-plausible --duration 6 --budget 4 --out excite.toml",
        "flexure run excite.toml --out .",
        "mv excite.csv run.csv",
        "cp robots/two-link-plausible.toml arm.toml",
    ],
    # A log in other units: stamps in ns, degrees of the motor's shaft behind a gear of 50, currents.
    "docs/logs.md": [
        "flexure run two-link-hardware --out .",
        "sed '/^\\[joints\\]/a gear_ratio = 50.0' robots/two-link-plausible.toml > geared.toml",
        "sed 's/^robot = .*/robot = \"geared.toml\"/' scenarios/two-link-hardware.toml > arm.toml",
        """awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; print "stamp,m_1,m_2,current_1,current_2"; next }
          { d = 50 * 57.29577951308232; c = 1 / 0.085
            printf "%.0f,%.9g,%.9g,%.9g,%.9g\\n", $at["t"] * 1e9, $at["q_m1"] * d, $at["q_m2"] * d, $at["u_m1"] * c, $at["u_m2"] * c }
          ' two-link-hardware.csv > arm.csv""",
    ],
}
# Commands that are not run, by how they begin, and why.
LEFT_OUT = {
    ("README.md", "flexure compare"): "every law on every task: six minutes",
    (
        "docs/tuning.md",
        "flexure tune",
    ): "minutes, of a robot from the network: crates/flexure-cli/tests/suite/guide.rs runs a part of it",
}
# What is meant to be refused on the page as it stands: page and command, its exit code.
REFUSED = {
    # The numbers that the reader is asked to supply are missing here.
    ("README.md", "flexure check arm.toml"): 2,
}
# Placeholders of a synopsis: words in capitals that stand for something.
SYNOPSIS = re.compile(r"\[--|\[-|\[[A-Z]|…|(?<![\w=/.$-])(ROBOT|SCENARIO|SWEEP|FILE|DIR|URDF|MAP|SPEC)(?![\w.])")
# Beside `flexure`, what a line may begin with here.
HARMLESS = {"echo", "mkdir", "cp", "mv", "cd"}


@dataclass
class Step:
    """A command of a page, or a file that the page shows."""

    line: int
    text: str
    file: str = ""
    answers: tuple = (0, 1)


@dataclass
class Report:
    ran: int = 0
    # Commands inside of sentences whose options were looked up.
    spans: int = 0
    # Answered with a no that the page does not announce.
    noes: list = field(default_factory=list)
    skipped: list = field(default_factory=list)
    failed: list = field(default_factory=list)


def blocks(text):
    """Language, line and lines of every fenced block."""
    lines, at = text.splitlines(), 0
    while at < len(lines):
        if found := re.match(r"```(\w*)", lines[at]):
            end = next(row for row in range(at + 1, len(lines)) if lines[row].startswith("```"))
            yield found[1], at + 2, lines[at + 1 : end]
            at = end
        at += 1


def steps(text):
    for language, line, content in blocks(text):
        if language == "toml" and content and (named := re.match(r"# ([\w-]+\.toml)\s*$", content[0])):
            yield Step(line, "\n".join(content) + "\n", file=named[1])
        if language == "sh" or not language and content and content[0].startswith("flexure "):
            yield from commands(content, line)


def commands(content, line):
    """Lines of a shell block, with those that go on joined."""
    text, start = "", line
    for at, row in enumerate(content):
        start, text = (start, f"{text}\n{row}") if text else (line + at, row)
        following = content[at + 1] if at + 1 < len(content) else ""
        if row.rstrip().endswith(("\\", "|")) or following.startswith((" ", "\t")):
            continue
        if text.strip():
            code = re.search(r"#.*\bexit code (\d)", text)
            yield Step(start, text, answers=(int(code[1]),) if code else (0, 1))
        text = ""


def bare(text):
    """A command on one line and without its remark."""
    return re.sub(r"\s+", " ", re.sub(r"\s#\s.*", "", text)).strip()


def why_not(page, text):
    """Why a command is not run, or None."""
    command = bare(text)
    first = command.split()[0]
    if SYNOPSIS.search(command):
        return "a synopsis"
    if first != "flexure" and first not in HARMLESS:
        return f"no command of the program ({first})"
    return next((why for (of, start), why in LEFT_OUT.items() if of == page and command.startswith(start)), None)


def spans(text):
    """Code inside of sentences that shows a command."""
    prose = re.sub(r"^```.*?^```", lambda block: "\n" * block[0].count("\n"), text, flags=re.M | re.S)
    for row, line in enumerate(prose.splitlines(), 1):
        for span in re.findall(r"`(flexure [a-z][^`]*)`", line):
            yield row, span


@cache
def help_of(words, path):
    """The options that the help of a command names, or None where there is no such command."""
    done = subprocess.run(["flexure", *words, "--help"], capture_output=True, text=True, env={**os.environ, "PATH": path})
    return None if done.returncode else set(re.findall(r"--[a-z][a-z-]*", done.stdout))


def unknown_options(text, environment):
    """Commands of a line that the program does not know, and options that their help does not name."""
    command = bare(text)
    unknown = []
    for call in re.findall(r"\bflexure ([a-z]+)((?:(?! \| |;|&&).)*)", command):
        words, rest = [call[0]], call[1].split()
        if call[0] == "sweep" and rest and rest[0] in ("show", "replay"):
            words.append(rest[0])
        known = help_of(tuple(words), environment["PATH"])
        if known is None:
            unknown.append(" ".join(words))
        else:
            unknown += [option for option in re.findall(r"(?<!\S)\[?(--[a-z][a-z-]*)", call[1]) if option not in known]
    return unknown


def run(command, folder, environment):
    """Exit code, what it said, and seconds; the code is None where the time was up."""
    since = time.monotonic()
    # A group of its own: what is still there when the time is up ends with it.
    with subprocess.Popen(
        ["bash", "-c", f"set -o pipefail; {command}\n"],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    ) as process:
        try:
            said, _ = process.communicate(timeout=LIMIT)
            return process.returncode, said, time.monotonic() - since
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            return None, "", time.monotonic() - since


def try_page(name, program, report, verbose):
    with tempfile.TemporaryDirectory(prefix="flexure-docs-") as temporary:
        folder, home, path = (Path(temporary) / part for part in ("work", "home", "bin"))
        for made in (folder, home, path):
            made.mkdir()
        (path / "flexure").symlink_to(program)
        for beside in ("robots", "scenarios"):
            shutil.copytree(ROOT / beside, folder / beside)
        environment = {
            **os.environ,
            "PATH": f"{path}:{os.environ['PATH']}",
            "HOME": str(home),
            "EDITOR": "true",
            "NO_COLOR": "1",
        }
        for command in GIVEN.get(name, []):
            code, said, _ = run(command, folder, environment)
            if code not in (0, 1):
                report.failed.append((name, 0, f"beforehand: {command}", f"exit code {code}: {last(said)}"))
        text = (ROOT / name).read_text()
        for line, span in spans(text):
            report.spans += 1
            if unknown := unknown_options(span, environment):
                report.failed.append((name, line, span, f"unknown: {', '.join(unknown)}"))
        for step in steps(text):
            if step.file:
                (folder / step.file).write_text(step.text)
                continue
            command = bare(step.text)
            if why := why_not(name, step.text):
                if "flexure " in command and (unknown := unknown_options(step.text, environment)):
                    report.failed.append((name, step.line, command, f"unknown: {', '.join(unknown)}"))
                report.skipped.append((name, step.line, command, why))
                continue
            answers = (REFUSED[name, command],) if (name, command) in REFUSED else step.answers
            code, said, seconds = run(step.text, folder, environment)
            report.ran += 1
            if verbose:
                print(f"{name}:{step.line}: {command}: exit code {code}, {seconds:.1f} s", flush=True)
            if code is None:
                report.failed.append((name, step.line, command, f"not done after {LIMIT:.0f} s"))
            elif code not in answers:
                report.failed.append((name, step.line, command, f"exit code {code}: {last(said)}"))
            elif code == 1 and len(answers) > 1:
                report.noes.append((name, step.line, command))


def last(said):
    lines = [line.strip() for line in said.strip().splitlines() if line.strip()]
    errors = [line for line in lines if line.startswith("error")]
    return (errors or lines or ["nothing said"])[0][:300]


def pages():
    found = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), ROOT / "docs/gallery/README.md"]
    return [path.relative_to(ROOT).as_posix() for path in found if path.exists()]


def main():
    parse = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parse.add_argument("pages", nargs="*", metavar="PAGE", help="as docs/files.md; all that no test covers unless given")
    parse.add_argument("--verbose", action="store_true", help="every command with its exit code and time")
    given = parse.parse_args()
    program = shutil.which(os.environ.get("FLEXURE", str(ROOT / "target/release/flexure")))
    if not program:
        raise SystemExit("no program: cargo build --release, or FLEXURE=PATH")
    report = Report()
    for name in given.pages or [page for page in pages() if page not in COVERED]:
        try_page(name, Path(program).resolve(), report, given.verbose)
    for name, line, command, why in report.skipped:
        print(f"skipped  {name}:{line}: {command} ({why})")
    for name, why in COVERED.items():
        print(f"skipped  {name} ({why})")
    for name, line, command in report.noes:
        print(f"a no     {name}:{line}: {command} (exit code 1)")
    for name, line, command, why in report.failed:
        print(f"FAILED   {name}:{line}: {command}\n         {why}")
    print(
        f"{report.ran} commands ran, {report.spans} in sentences looked up, {len(report.skipped)} skipped, {len(report.failed)} failed"
    )
    sys.exit(bool(report.failed))


if __name__ == "__main__":
    main()
