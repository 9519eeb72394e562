#!/usr/bin/env python3
"""What a certificate's `subject` hashes, as docs/certificate.md states it: normal_form.py SCENARIO.toml

Prints the normal form of the robot and of the scenario, a line each, and their SHA-256. With Python's own library alone."""
import hashlib, json, math, pathlib, sys, tomllib
from decimal import Decimal
from xml.etree import ElementTree

KEPT = {"link", "joint", "inertial", "origin", "mass", "inertia", "parent", "child", "axis", "dynamics", "limit", "mimic"}
NAMES = {"name", "link", "joint", "type"}

def number(x):  # RFC 8785: the fewest digits that restore the double, laid out as ECMAScript does
    if x == 0:
        return "0"
    if 1e-6 <= abs(x) < 1e21:
        text = format(Decimal(repr(x)), "f")
        return text.rstrip("0").rstrip(".") if "." in text else text
    digits, power = format(Decimal(repr(x)).normalize(), "e").split("e")
    return f"{digits}e{int(power):+d}"

def canonical(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return number(float(value)) if abs(value) <= 2**53 else json.dumps(str(value))
    if isinstance(value, float):
        return number(value) if math.isfinite(value) else json.dumps({math.inf: "inf", -math.inf: "-inf"}.get(value, "NaN"))
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, dict):
        return "{" + ",".join(f"{canonical(key)}:{canonical(value[key])}" for key in sorted(value)) + "}"
    return "[" + ",".join(map(canonical, value)) + "]"

def attribute(name, text):
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError:
        return text
    return text if name in NAMES or not all(map(math.isfinite, numbers)) else numbers
def element(node):
    children = [element(child) for child in node if child.tag in KEPT]
    return [node.tag, {name: attribute(name, text) for name, text in node.attrib.items()}, children]
def urdf(path):
    return [element(node) for node in ElementTree.parse(path).getroot() if node.tag in ("link", "joint")]
def samples(path):
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]
    return [[float(cell) for cell in line.split(",")] for line in lines[1:]]

def without(table, left_out, defaults):
    return {key: value for key, value in table.items() if key not in left_out and not (key in defaults and value == defaults[key])}
def robot(path):
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    if table["links"]["kind"] == "urdf":
        table["links"]["file"] = urdf(path.parent / table["links"]["file"])
    return without(table, ("name", "sources"), {"gravity": [0, 0, -9.81]})
def scenario(path):
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    if table["reference"].get("file"):
        table["reference"]["file"] = samples(path.parent / table["reference"]["file"])
    name = table["robot"]  # a path, or a robot of this repository
    built_in = pathlib.Path(__file__).parent.parent / "robots" / f"{name}.toml"
    robot_path = path.parent / name if "." in name or "/" in name else built_in
    return without(table, ("robot", "sources"), {"hold": "zero-order", "seed": 0}), robot_path

def main(paths):
    for path in map(pathlib.Path, paths):
        own, robot_path = scenario(path)
        for name, value in ("robot", robot(robot_path)), ("scenario", own):
            text = canonical(value)
            print(f"{name} {hashlib.sha256(text.encode()).hexdigest()} {text}")

if __name__ == "__main__":
    main(sys.argv[1:])
