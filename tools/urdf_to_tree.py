#!/usr/bin/env python3
"""Writes the [links] of a Flexure robot file (kind = "tree") from a URDF.

    tools/urdf_to_tree.py panda.urdf [--lock JOINT]...

Joints of type fixed, and those locked at zero, become kind = "fixed"; the reader merges them. Numbers are copied as they
stand in the URDF. Refuses what a tree of the robot file cannot say.
"""

import argparse
import sys
import xml.etree.ElementTree as ElementTree

KINDS = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic", "fixed": "fixed"}
ZEROS = ["0", "0", "0"]


def attribute(element, name, count):
    """The `count` numbers of an attribute, as text; None if it is absent or all zero."""
    if element is None or element.get(name) is None:
        return None
    words = element.get(name).split()
    if len(words) != count:
        sys.exit(f"{element.tag} {name}: {count} numbers expected, got {len(words)}")
    return words if any(float(word) for word in words) else None


def array(words):
    return "[" + ", ".join(word if any(c in word for c in ".e") else f"{word}.0" for word in words) + "]"


def body(link):
    """Lines for mass, com and inertia of a link."""
    inertial = link.find("inertial")
    if inertial is None or float(inertial.find("mass").get("value")) == 0.0:
        return ["mass = 0.0"]
    origin, matrix = inertial.find("origin"), inertial.find("inertia")
    six = [matrix.get(key) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")]
    lines = [
        f"mass = {float(inertial.find('mass').get('value'))!r}",
        f"com = {array(attribute(origin, 'xyz', 3) or ZEROS)}",
        f"inertia = {array(six)}",
    ]
    rpy = attribute(origin, "rpy", 3)
    return lines + ([f"inertia_rpy = {array(rpy)}"] if rpy else [])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("urdf")
    parser.add_argument("--lock", action="append", default=[], metavar="JOINT", help="hold at zero")
    arguments = parser.parse_args()
    root = ElementTree.parse(arguments.urdf).getroot()
    links = {link.get("name"): link for link in root.findall("link")}
    joints = root.findall("joint")
    unknown = set(arguments.lock) - {joint.get("name") for joint in joints}
    if unknown:
        sys.exit(f"no such joint: {', '.join(sorted(unknown))}")
    of_child = {joint.find("child").get("link"): joint.get("name") for joint in joints}
    print('[links]\nkind = "tree"')
    written, waiting = set(), list(joints)
    while waiting:  # parents before children
        joint = next((j for j in waiting if of_child.get(j.find("parent").get("link")) in written | {None}), None)
        if joint is None:
            sys.exit("the joints form a loop")
        waiting.remove(joint)
        written.add(joint.get("name"))
        if joint.get("type") not in KINDS:
            sys.exit(f"{joint.get('name')}: type {joint.get('type')} is not supported")
        kind = "fixed" if joint.get("name") in arguments.lock else KINDS[joint.get("type")]
        parent = of_child.get(joint.find("parent").get("link"))
        origin, axis = joint.find("origin"), joint.find("axis")
        xyz, rpy = attribute(origin, "xyz", 3), attribute(origin, "rpy", 3)
        print(f'\n[[links.joint]]\nname = "{joint.get("name")}"')
        if parent:
            print(f'parent = "{parent}"')
        print(f'kind = "{kind}"')
        if kind != "fixed":
            print(f"axis = {array(axis.get('xyz').split() if axis is not None else ['1', '0', '0'])}")
        if xyz:
            print(f"xyz = {array(xyz)}")
        if rpy:
            print(f"rpy = {array(rpy)}")
        print("\n".join(body(links[joint.find("child").get("link")])))


if __name__ == "__main__":
    main()
