"""Flexure beside CasADi's C, Pinocchio and MuJoCo on one core: the same inputs, the same numbers, ratios.

    python3 benches/peers/run.py [--quick] [--docs] [--json FILE] [--markdown FILE] [ROW...]

Installs the peers from PyPI into an environment below target/, writes and compiles their programs with the system's compilers,
builds Flexure's in the profile of the command, and runs every row in rounds A B A B. Exit code 1: they disagree.
"""

import argparse
import json
import os
import platform
import random
import struct
import subprocess
import sys
import venv
from dataclasses import dataclass, field
from pathlib import Path

import mujoco_model

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
FOLDER = ROOT / "target" / "peers"
STATES = 256

# Works that are functions: what they are called, vectors in, peers, and by how much results may differ relatively.
CALLS = {
    "law7": ("v-CBC law, 7 joints, gravity, tanh", 7 * 9, ["casadi"], 1e-12),
    "law2": ("v-CBC law, planar two-link, tanh", 2 * 9, ["casadi"], 1e-12),
    "law2-lanes": ("v-CBC law, planar two-link, tanh, several states in lanes", 2 * 9, ["casadi"], 1e-12),
    "law7-lanes": ("v-CBC law, 7 joints, gravity, tanh, several states in lanes", 7 * 9, ["casadi"], 1e-12),
    "rnea7": ("inverse dynamics, 7 joints", 7 * 3, ["casadi", "pinocchio"], 1e-12),
    "fd7": ("forward dynamics, 7 joints", 7 * 3, ["casadi", "pinocchio"], 1e-12),
    "rates7": ("τ, τ', τ'' exact, 7 joints", 7 * 5, ["casadi", "pinocchio"], 1e-12),
    "crba7": ("mass matrix, 7 joints", 7, ["casadi", "pinocchio"], 1e-12),
}
# Works that go on in time: Flexure's methods, and MuJoCo's with their step in s.
INTEGRATORS = [("Euler", "1e-3"), ("implicitfast", "1e-3"), ("RK4", "1e-3"), ("RK4", "0.25e-3")]
# With the loosest tolerance, of those with one digit, that keeps a plant to 1e-9 rad after a second.
PLANTS = {
    "plant2": ("1 ms of plant, elastic two-link", "two_link", "1e-5"),
    "plant7": ("1 ms of plant, elastic 7 joints", "panda", "3e-7"),
}
LOOPS = {
    "loop2": ("1 ms of law + plant, two-link", "plant2", "two_link"),
    "loop7": ("1 ms of law + plant, 7 joints", "plant7", "panda"),
    "batch2": ("1 ms of law + plant, two-link, of 16 loops together", "plant2", "two_link"),
    "batch7": ("1 ms of law + plant, 7 joints, of 16 loops together", "plant7", "panda"),
}
# Whole loops of built-in scenarios, which no peer has: sensors, estimator, law, guard, drive and plant.
OWN = ["two-link-everything", "two-link-hardware", "two-link-tanh-smooth", "panda-tanh-smooth"]
PAGE = ROOT / "docs" / "speed.md"
# Flexure's tightest steps and MuJoCo's RK4 at 1e-5 s: by how much the same second may differ, in rad.
SAME_PLANT = 1e-9
# Loops, after a second on their references, and the same with Flexure's tightest steps, in rad: those of the midpoint rule are the farthest.
SAME_LOOP = 1e-5
# Beyond this error, in rad after a second, an integrator has lost the motion.
LOST = 0.1
PINOCCHIO = (
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30 -DBOOST_MPL_LIMIT_VECTOR_SIZE=30 "
    "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS -DBOOST_FUSION_INVOKE_MAX_ARITY=12"
).split()


@dataclass
class Side:
    """A program that does a work, what it takes at best over the rounds, and what came out."""

    name: str
    command: list
    out: Path
    ns: float = float("inf")
    differs: float = 0.0
    failed: str = ""

    def run(self, milliseconds):
        if self.failed:
            return
        command = [*self.command, str(milliseconds)]
        done = subprocess.run(command, cwd=FOLDER, capture_output=True, text=True, env={**os.environ, "RAYON_NUM_THREADS": "1"})
        if done.returncode:
            self.failed = (done.stderr.strip().splitlines() or ["failed"])[-1]
        else:
            self.ns = min(self.ns, float(done.stdout))

    def numbers(self):
        return doubles(self.out) if not self.failed else []


@dataclass
class Row:
    key: str
    title: str
    flexure: Side
    peers: list
    limit: float
    # Where a plant is after a second, if it is about that.
    reference: tuple = ()
    unequal: list = field(default_factory=list)


def is_loop(row):
    return row.key.split("-")[0] in LOOPS


def is_in_lanes(work):
    return work.endswith("-lanes") or work.startswith("batch")


def doubles(path):
    data = Path(path).read_bytes()
    return struct.unpack(f"{len(data) // 8}d", data)


def write(path, values):
    values = list(values)
    path.write_bytes(struct.pack(f"{len(values)}d", *values))


def sh(*command, **more):
    done = subprocess.run([str(x) for x in command], cwd=FOLDER, capture_output=True, text=True, **more)
    if done.returncode:
        raise RuntimeError(f"{command[0]}: {(done.stderr.strip() or done.stdout.strip())[:2000]}")
    return done.stdout


def environment():
    """The peers in an environment of their own: its Python and its packages."""
    place, wanted = FOLDER / "venv", (HERE / "requirements.txt").read_text()
    python, stamp = place / "bin" / "python", place / "installed.txt"
    if not stamp.exists() or stamp.read_text() != wanted:
        venv.create(place, with_pip=True, clear=True)
        sh(python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt")
        stamp.write_text(wanted)
    return python, Path(sh(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip())


def flexure_program():
    subprocess.run(
        ["cargo", "build", "--quiet", "--release", "--workspace", "--locked", "--example", "peers"], cwd=ROOT, check=True
    )
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    return (target / "release" / "examples" / "peers").resolve()


def wide_program():
    """Flexure's program for the processor's registers of eight numbers, as `tools/package.sh` builds it; none if it has none."""
    flags = next((line.split() for line in open("/proc/cpuinfo") if line.startswith("flags")), [])
    if not {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"} <= set(flags):
        return None
    target = FOLDER / "x86-64-v4"
    command = ["cargo", "build", "--quiet", "--release", "--locked", "-p", "flexure", "--example", "peers", "--target-dir", target]
    flags = "-C target-cpu=x86-64-v4 -C llvm-args=-slp-max-reg-size=128"
    subprocess.run(command, cwd=ROOT, check=True, env={**os.environ, "RUSTFLAGS": flags})
    return target / "release" / "examples" / "peers"


def fresh(program, *sources):
    """Whether `program` is younger than what it is made of."""
    return program.exists() and all(program.stat().st_mtime > Path(source).stat().st_mtime for source in sources)


def casadi_program(python, work):
    program, script = FOLDER / f"casadi-{work}", HERE / "casadi_c.py"
    if not fresh(program, script, HERE / "driver.c", FOLDER / "model.json"):
        sh(python, script, FOLDER / "model.json", FOLDER, work)
        sh("gcc", "-O3", "-march=native", f"{work}.c", HERE / "driver.c", "-o", program, "-lm")
    return program


def pinocchio_program(packages, name):
    program, source = FOLDER / name, HERE / f"{name}.cpp"
    if not fresh(program, source, HERE / "pinocchio.hpp", HERE / "jet.hpp"):
        prefix = packages / "cmeel.prefix" / "include"
        include = ["-isystem", prefix, "-isystem", prefix / "eigen3"]
        print(f"compiling {source.name}: minutes", file=sys.stderr)
        sh("g++", "-std=c++17", "-O3", "-march=native", "-DNDEBUG", "-w", *PINOCCHIO, source, *include, "-o", program)
    return program


def mujoco_program(packages):
    program, source, wheel = FOLDER / "mujoco", HERE / "mujoco_c.c", packages / "mujoco"
    if not fresh(program, source):
        [library] = wheel.glob("libmujoco.so*")
        rpath = f"-Wl,-rpath,{wheel}"
        sh("gcc", "-O3", "-march=native", source, "-I", wheel / "include", library, rpath, "-lm", "-o", program)
    return program


def files(program):
    """What the programs read: models, and inputs drawn once for all."""
    text = sh(program, "model")
    path = FOLDER / "model.json"
    if not path.exists() or path.read_text() != text:
        path.write_text(text)
    model = json.loads(text)
    panda = model["panda"]
    rows = [
        [*sum(b["rotation"], []), *b["translation"], b["mass"], *b["com"], *sum(b["inertia"], [])] for b in panda["bodies"]
    ]
    write(FOLDER / "panda.robot", panda["gravity"] + sum(rows, []))
    for name, robot in model.items():
        xml, drive = mujoco_model.xml(robot)
        (FOLDER / f"{name}.xml").write_text(xml)
        (FOLDER / f"{name}.drive").write_bytes(drive)
    numbers = random.Random(20261124)
    for work, (_, inputs, _, _) in CALLS.items():
        write(FOLDER / f"{work}.in", (numbers.uniform(-1, 1) for _ in range(inputs * STATES)))


def side(name, out, *command):
    out = FOLDER / f"{out}.out"
    return Side(name, [*map(str, command), str(out)], out)


def call_row(work, flexure, python, packages, what=""):
    title, _, peers, limit = CALLS[work]
    title += what
    # A peer does the same, one state at a time.
    same, made = work.removesuffix("-lanes"), []
    for peer in peers:
        one = side(peer, f"{work}.{peer}")
        try:
            if peer == "casadi":
                one.name, command = "CasADi C", [casadi_program(python, same), f"{work}.in"]
            else:
                name = "pinocchio_rates" if work == "rates7" else "pinocchio"
                one.name = "Pinocchio C++, on series" if work == "rates7" else "Pinocchio C++"
                command = [pinocchio_program(packages, name), "panda.robot", work, f"{work}.in"]
            one.command = [*map(str, command), str(one.out)]
        except RuntimeError as error:
            one.failed = str(error).splitlines()[0][:200]
        made.append(one)
    return Row(work, title, side("Flexure", f"{work}.flexure", flexure, "time", work, f"{work}.in"), made, limit)


def motion(flexure, work):
    return side("Flexure", f"{work}.flexure", flexure, "time", work, "-")


def motion_rows(work, flexure, packages, what=""):
    """A row for each method of Flexure beside all of MuJoCo's; times with errors after a second."""
    rows = []
    loop = work in LOOPS
    title, plant, robot = LOOPS[work] if loop else (PLANTS[work][0], work, PLANTS[work][1])
    title += what
    mujoco = mujoco_program(packages)

    def peer(integrator, step):
        name = f"MuJoCo {integrator} {1e3 * float(step):g} ms" + (", no law" if loop else "")
        return side(name, f"{work}.{integrator}{step}", mujoco, f"{robot}.xml", f"{robot}.drive", integrator, step)

    if loop:
        tight = motion(flexure, f"{work.replace('batch', 'loop')}-tight")
        tight.run(0)
        methods = [("", "")] + [("-midpoint", ", midpoint 1 ms")] * work.startswith("batch")
        return [
            Row(work + method, title + name, motion(flexure, work + method), [peer("Euler", "1e-3")], SAME_LOOP, tight.numbers())
            for method, name in methods
        ]
    tight, check = motion(flexure, f"{work}-tight"), peer("RK4", "1e-5")
    tight.run(0)
    check.run(0)
    apart = distance(tight.numbers(), check.numbers())
    loose = PLANTS[work][2]
    methods = (("", "collocation"), (f"-{loose}", f"collocation, tolerance {loose}"), ("-midpoint", "midpoint 1 ms"))
    for method, name in methods:
        own = motion(flexure, work + method)
        row = Row(work + method, f"{title}: {name}", own, [peer(*one) for one in INTEGRATORS], SAME_PLANT, tight.numbers())
        if not apart <= SAME_PLANT:
            row.unequal.append(f"{work}: references of Flexure and MuJoCo differ by {apart:.1e} rad")
        rows.append(row)
    print(f"{work}: Flexure's reference and MuJoCo's RK4 of 0.01 ms differ by {apart:.1e} rad after a second", file=sys.stderr)
    return rows


def distance(a, b):
    return max(abs(x - y) for x, y in zip(a, b, strict=True)) if a and b else float("nan")


def relative(a, b):
    """Largest difference of a line's numbers over the largest of them."""
    size, worst = len(a) // STATES, 0.0
    if len(a) != len(b):
        return float("inf")
    for i in range(0, len(a), size):
        x, y = a[i : i + size], b[i : i + size]
        worst = max(worst, distance(x, y) / max(map(abs, x)))
    return worst


def measure(row, rounds, milliseconds):
    sides = [row.flexure, *row.peers]
    for _ in range(rounds):
        for one in sides:
            one.run(milliseconds)
    if row.flexure.failed:
        row.unequal.append(f"{row.key}: Flexure: {row.flexure.failed}")
        return
    if row.reference:
        for one in sides[: 1 if is_loop(row) else None]:
            one.differs = distance(one.numbers(), row.reference)
        if is_loop(row) and not row.flexure.differs <= row.limit:
            row.unequal.append(f"{row.key}: {row.flexure.differs:.1e} rad from the loop with the tightest tolerance")
        return
    for one in row.peers:
        if one.failed:
            continue
        one.differs = relative(row.flexure.numbers(), one.numbers())
        if not one.differs <= row.limit:
            row.unequal.append(f"{row.key}: {one.name} differs by {one.differs:.1e}, more than {row.limit:.0e}")


def table(rows):
    lines = ["| work | Flexure, ns | peer | peer, ns | Flexure / peer | they differ by |", "| --- | ---: | --- | ---: | ---: | ---: |"]
    for row in rows:
        own = f"{row.flexure.ns:,.0f}"
        if row.reference:
            own += f" (error {row.flexure.differs:.0e})"
        for one in row.peers:
            if one.failed:
                lines.append(f"| {row.title} | {own} | {one.name} | could not be made | | |")
                continue
            differs = "" if is_loop(row) else f"{one.differs:.0e}"
            if row.reference and not is_loop(row):
                differs = f"error {differs}" if one.differs < LOST else "unstable"
            lines.append(f"| {row.title} | {own} | {one.name} | {one.ns:,.0f} | {row.flexure.ns / one.ns:.2f} | {differs} |")
    return "\n".join(lines)


def own_table(flexure, rounds, milliseconds):
    """Control periods of whole loops."""
    lines = ["| loop | ns a period | periods a second |", "| --- | ---: | ---: |"]
    for name in OWN:
        one = side(name, f"loop-{name}", flexure, "time", f"loop-{name}", "-")
        for _ in range(rounds):
            one.run(milliseconds)
        lines.append(f"| `{name}` | {one.ns:,.0f} | {1e9 / one.ns:,.0f} |")
    return "\n".join(lines)


def into_page(text):
    """The tables of docs/speed.md, between its two marks."""
    page = PAGE.read_text()
    before, rest = page.split("<!-- measured -->\n", 1)
    after = rest.split("<!-- /measured -->", 1)[1]
    PAGE.write_text(f"{before}<!-- measured -->\n{text}\n<!-- /measured -->{after}")


def machine():
    names = [line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
    compilers = [sh(c, "--version").splitlines()[0] for c in ("gcc", "rustc")]
    return f"{names[0]} ({platform.machine()}), {len(names)} cores; {'; '.join(compilers)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rows", nargs="*", metavar="ROW", help=f"of {', '.join([*CALLS, *PLANTS, *LOOPS])}; all if none")
    parser.add_argument("--quick", action="store_true", help="one short round: are they equal?")
    parser.add_argument("--docs", action="store_true", help="writes the tables into docs/speed.md")
    parser.add_argument("--json", type=Path, metavar="FILE")
    parser.add_argument("--markdown", type=Path, metavar="FILE")
    options = parser.parse_args()
    known = [*CALLS, *PLANTS, *LOOPS]
    if unknown := [row for row in options.rows if row not in known]:
        parser.error(f"no row is {', '.join(unknown)}; there are {', '.join(known)}")
    FOLDER.mkdir(parents=True, exist_ok=True)
    python, packages = environment()
    flexure = flexure_program()
    files(flexure)
    rounds, milliseconds = (1, 10) if options.quick else (7, 60)
    rows = []
    works = options.rows or [*CALLS, *PLANTS, *LOOPS]
    wide = wide_program() if any(map(is_in_lanes, works)) else None
    for work in works:
        made = []
        for program, what in [(flexure, ""), (wide, ", AVX-512")][: 2 if wide and is_in_lanes(work) else 1]:
            if work in CALLS:
                made.append(call_row(work, program, python, packages, what))
            else:
                made += motion_rows(work, program, packages, what)
        for row in made:
            measure(row, rounds, milliseconds)
            rows.append(row)
    text = f"{machine()}\n\n{table(rows)}"
    if not options.rows:
        text += f"\n\n{own_table(flexure, rounds, milliseconds)}"
    print(text)
    if options.markdown:
        options.markdown.write_text(text + "\n")
    if options.docs:
        into_page(text)
    if options.json:
        keep = lambda one: {"name": one.name, "ns": one.ns, "difference": one.differs, "failed": one.failed}
        document = [
            {"work": row.key, "title": row.title, "flexure": keep(row.flexure), "peers": list(map(keep, row.peers))} for row in rows
        ]
        options.json.write_text(json.dumps({"machine": machine(), "rows": document}, indent=1) + "\n")
    unequal = [line for row in rows for line in row.unequal]
    failed = [f"{row.key}: {one.name}: {one.failed}" for row in rows for one in row.peers if one.failed]
    print(*unequal, *failed, sep="\n", file=sys.stderr)
    return 1 if unequal or failed else 0


if __name__ == "__main__":
    sys.exit(main())
