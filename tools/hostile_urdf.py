#!/usr/bin/env python3
"""Time and memory that `flexure import` takes to refuse URDFs made to break it, and to read good ones.

    tools/hostile_urdf.py target/release/flexure [GOOD.urdf]...

Wall time is the best of five runs, memory the largest resident set; both
include the start of the program, and memory is at least that of this script when it starts it.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def joint(i, more=""):
    return f"<joint name='j{i}' type='revolute'><parent link='l{i}'/><child link='l{i + 1}'/>{more}</joint>\n"


def each(count, entry):
    return "".join(map(entry, range(count)))


def links(count):
    return each(count, lambda i: f"<link name='l{i}'/>")


ENTITIES = "".join(f"<!ENTITY e{i} '&e{i - 1};&e{i - 1};'>" for i in range(1, 30))
BAD_MASS = "<inertial><mass value='1,5'/><inertia ixx='nan' ixy='1e400'/></inertial>"
HOSTILE = {
    "a million nested elements": lambda: "<robot>" + "<a>" * 1_000_000,
    "as many as fit in 2 MiB": lambda: "<robot>" + "<a>" * 690_000,
    "nested links": lambda: "<robot>" + "<link>" * 340_000,
    "quadratic entities": lambda: f"<!DOCTYPE r [<!ENTITY a '{'a' * 50_000}'>]><robot name='{'&a;' * 50_000}'/>",
    "exponential entities": lambda: f"<!DOCTYPE r [<!ENTITY e0 'a'>{ENTITIES}]><robot name='&e29;'/>",
    "many attributes": lambda: f"<robot {each(150_000, lambda i: f'a{i}={chr(39)}1{chr(39)} ')}/>",
    "many namespaces": lambda: "<robot>" + each(60_000, lambda i: f"<a{i} xmlns:n{i}='u{i}'>"),
    "70,000 links": lambda: f"<robot>{links(70_000)}</robot>",
    "19,000 roots": lambda: f"<robot>{links(19_000)}</robot>",
    "a chain of 4,900": lambda: f"<robot>{links(4_901)}{each(4_900, joint)}</robot>",
    "a chain that mimics itself": lambda: f"<robot>{links(3_901)}"
    + each(3_900, lambda i: joint(i, f"<mimic joint='j{(i + 1) % 3_900}'/>"))
    + "</robot>",
    "unknown links": lambda: f"<robot>{links(3_000)}" + each(3_000, joint).replace("='l", "='" + "m" * 60) + "</robot>",
    "bad numbers": lambda: "<robot>" + each(4_900, lambda i: f"<link name='l{i}'>{BAD_MASS}</link>\n") + "</robot>",
    "plug-ins only": lambda: "<robot>" + "<gazebo><x/></gazebo>" * 95_000 + "</robot>",
    "a long comment": lambda: "<robot><!--" + "-x" * 1_000_000,
    "a long name": lambda: f"<robot><link name='{'x' * 2_000_000}'/><link name='b'/></robot>",
    "angle brackets": lambda: "<" * 2_000_000,
    "processing instructions": lambda: "<?x?>" * 400_000,
    "nothing": lambda: "",
}


def measure(flexure, path):
    best, memory, code = float("inf"), 0, 0
    for _ in range(5):
        start = time.perf_counter()
        process = subprocess.Popen([flexure, "import", path], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        said = process.stderr.read().decode()
        _, status, usage = os.wait4(process.pid, 0)
        best = min(best, time.perf_counter() - start)
        memory, code = max(memory, usage.ru_maxrss / 1024), os.waitstatus_to_exitcode(status)
    first = next((line.strip(" ×⚠") for line in said.splitlines() if "×" in line), "")
    return code, 1e3 * best, memory, first


def main(flexure, good):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "hostile.urdf"
        for name, text in HOSTILE.items():
            path.write_text(text())
            code, ms, megabytes, said = measure(flexure, path)
            print(f"{name:28} exit {code}  {ms:6.1f} ms  {megabytes:5.1f} MB  {said[:80]}")
    for path in good:
        code, ms, megabytes, said = measure(flexure, path)
        print(f"{Path(path).name:28} exit {code}  {ms:6.1f} ms  {megabytes:5.1f} MB  {said[:80]}")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
