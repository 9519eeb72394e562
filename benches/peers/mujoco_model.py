"""The elastic arms as MuJoCo has them: joints of the links, a motor for each that turns beside them, and a spring between the two.

A motor is a body on the world that turns about its centre of mass, so that nothing but the spring, its damping and its torque
acts on it: the motors of Flexure's model. The spring is a tendon of length q_m - q_l.
"""

import math
import struct


def xml(robot):
    """The model file, at rest in the springs at its key frame 0, and the numbers of `Drive` in mujoco_c.c."""
    n = len(robot["bodies"])
    links, ends = "", ""
    for i, body in enumerate(robot["bodies"]):
        m = body["inertia"]
        full = [m[0][0], m[1][1], m[2][2], m[0][1], m[0][2], m[1][2]]
        columns = list(zip(*body["rotation"]))
        links += (
            f'<body pos="{numbers(body["translation"])}" xyaxes="{numbers(columns[0] + columns[1])}">'
            f'<joint name="l{i}" axis="0 0 1" damping="{robot["link_damping"][i]!r}"/>'
            f'<inertial pos="{numbers(body["com"])}" mass="{body["mass"]!r}" fullinertia="{numbers(full)}"/>'
        )
        ends += "</body>"
    motors = "".join(
        f'<body><joint name="m{i}" axis="0 0 1" damping="{robot["motor_damping"][i]!r}"/>'
        f'<inertial pos="0 0 0" mass="1" diaginertia="{inertia!r} {inertia!r} {inertia!r}"/></body>'
        for i, inertia in enumerate(robot["motor_inertia"])
    )
    springs = "".join(
        f'<fixed stiffness="{k!r}" springlength="0"><joint joint="m{i}" coef="1"/><joint joint="l{i}" coef="-1"/></fixed>'
        for i, k in enumerate(robot["stiffness"])
    )
    hold = weight(robot)
    q_m = [q + h / k for q, h, k in zip(robot["q_l"], hold, robot["stiffness"])]
    # Not every identified inertia is one that a body can have, and MuJoCo's own figures are for contacts, of which there are none.
    text = (
        f'<mujoco><compiler angle="radian" autolimits="false"/><option gravity="{numbers(robot["gravity"])}">'
        '<flag contact="disable" constraint="disable" energy="disable"/></option>'
        f"<worldbody>{links}{ends}{motors}</worldbody><tendon>{springs}</tendon>"
        f'<keyframe><key qpos="{numbers(robot["q_l"] + q_m)}"/></keyframe></mujoco>'
    )
    amplitude, stiffness = (3.0, 0.5) if n == 2 else (20.0, 200.0)
    drive = [float(n), amplitude, stiffness, *hold, *q_m]
    return text, struct.pack("64d", *drive, *[0.0] * (64 - len(drive)))


def numbers(values):
    return " ".join(repr(float(x)) for x in values)


def weight(robot):
    """Torques that hold the arm at q_l: each body's weight about each axis below it."""
    n = len(robot["bodies"])
    rotation, place = [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]], [0.0] * 3
    joints, torque = [], [0.0] * n
    for body, q in zip(robot["bodies"], robot["q_l"]):
        place = added(place, product(rotation, body["translation"]))
        s, c = math.sin(q), math.cos(q)
        rotation = [product_row(row, body["rotation"], s, c) for row in rotation]
        joints.append((place, [row[2] for row in rotation]))
        centre = added(place, product(rotation, body["com"]))
        for i, (origin, axis) in enumerate(joints):
            arm = [a - b for a, b in zip(centre, origin)]
            lever = [arm[1] * axis[2] - arm[2] * axis[1], arm[2] * axis[0] - arm[0] * axis[2], arm[0] * axis[1] - arm[1] * axis[0]]
            # Along the joint the centre moves by axis x arm = -(arm x axis).
            torque[i] += body["mass"] * sum(g * x for g, x in zip(robot["gravity"], lever))
    return torque


def added(a, b):
    return [x + y for x, y in zip(a, b)]


def product(rotation, v):
    return [sum(a * b for a, b in zip(row, v)) for row in rotation]


def product_row(row, fixed, s, c):
    """A row of rotation * fixed * turn about z."""
    x, y, z = (sum(row[k] * fixed[k][j] for k in range(3)) for j in range(3))
    return [x * c + y * s, y * c - x * s, z]
