#!/usr/bin/env python3
"""Time and memory that `flexure check` takes to refuse TOML made to break it.

    tools/hostile_toml.py target/release/flexure [SECONDS]

Wall time is the best of three runs, memory the largest resident set by GNU time; both include the start of the
program. What takes more than SECONDS, 60 unless told, is broken off. First files as full as they may be, then 16 MB.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

ROBOT = "name = 'a'\n[links]\nkind = 'pendulum'\nmass = 1\ncom = 0.1\ninertia = 0.1\n[joints]\nstiffness = 1\n"


def files(size, most):
    """Files of about so many bytes, or with at most so many keys: what they are made of, and their text."""

    def repeated(entry, share=1):
        return "".join(entry(i) for i in range(min(size // len(entry(0)), most // share)))

    yield "array of numbers", "a = [" + "1," * min(size // 2, 19 * most) + "]\n"
    yield "keys", repeated(lambda i: f"k{i} = 1\n")
    yield "tables", repeated(lambda i: "[[a]]\n", 2)
    yield "keys in long tables", "[" + ".".join(["k" * 250] * 7) + "]\n" + repeated(lambda i: f"k{i}=1\n")
    yield "one long key", "k" * size + " = 1\n"
    yield "nested tables", "a = " + "{a = " * (size // 12) + "1" + "}" * (size // 12) + "\n"
    yield "dotted key", "a" + ".a" * (size // 2) + " = 1\n"
    yield "slips", repeated(lambda i: "= \n")
    yield "open quotes", '"\n' * min(size // 2, 19 * most)
    yield "one long text", 'a = "' + "x" * size + '"\n'
    yield "comments", "#\n" * min(size // 2, 19 * most)
    keys = repeated(lambda i: f"k{i} = 1\n", 2)
    yield "sources", keys + ROBOT + "[sources]\n" + repeated(lambda i: f"k{i} = 'x'\n", 2)
    yield "imperfections", "robot = 'pendulum-1dof'\n" + repeated(lambda i: "[[imperfection]]\nkind = 'push'\n", 3)
    yield "joints", "name = 'a'\n[links]\nkind = 'tree'\n" + repeated(
        lambda i: f"[[links.joint]]\nname = 'j{i}'\nkind = 'revolute'\naxis = [0,0,1]\nmass = 1\ncom = [0,0,0]\n"
        "inertia = [1,0,0,1,0,1]\n", 11) + "[joints]\nstiffness = 1\nmotor_inertia = 1\nlink_damping = 0\nmotor_damping = 0\n"


def measure(flexure, path, seconds):
    """Seconds, MiB, exit code and what is said."""
    best, memory, code, said = float("inf"), 0, None, ""
    for _ in range(3):
        command = ["timeout", str(seconds), "time", "-f", "time %e %M", flexure, "check", str(path)]
        done = subprocess.run(command, capture_output=True)
        if done.returncode == 124:
            return None
        *lines, last = done.stderr.decode().splitlines()
        _, took, kilobytes = last.split()
        best, memory, code = min(best, float(took)), max(memory, int(kilobytes) / 1024), done.returncode
        said = next((line.strip("× ") for line in lines if "×" in line), "")
        if best > 2:
            break
    return best, memory, code, said.replace(str(path), "it")


def main():
    flexure, seconds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 60
    print("| file | MB | s | MiB | exit code, message |\n| --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "hostile.toml"
        for size, most in ((1_000_000, 4_980), (16_000_000, 16_000_000)):
            for name, text in files(size, most):
                path.write_text(text)
                found = measure(flexure, path, seconds)
                answer = f"> {seconds} | | broken off"
                if found:
                    took, memory, code, said = found
                    answer = f"{took:.2f} | {memory:.0f} | {code}: {said[:60]}"
                print(f"| {name} | {path.stat().st_size / 1e6:.2f} | {answer} |", flush=True)


main()
