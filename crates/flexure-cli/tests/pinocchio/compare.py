"""Flexure against Pinocchio on every URDF of example-robot-data with at most 16 moving joints, fingers locked where more
move, and on the robots of this crate's test data.

    compare.py FLEXURE [--perturb]

Mass matrix, bias C q̇ + g and inverse dynamics at random states, relative to the largest entry; the rate of the torque
against Pinocchio's derivatives of inverse dynamics, and its second derivative against differences of those rates.
With --perturb one inertia of one robot that Flexure reads is wrong by a millionth: the comparison has to fail.
Exit status 0 if all agree, 1 if not.
"""

import json
import re
import subprocess
import sys
import tempfile
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pinocchio as pin

STATES = 100
MOST_JOINTS = 16  # that the command line is built for
TOLERANCE = 1e-9  # asked for; what is found is rounding
# Second derivatives: differences of step 1e-3 s, whose error is step⁴/30 times a sixth derivative, some 1e-10 of scale,
# and rounding 1e-16/1e-3 times the ratio of the rate to its rate.
TOLERANCE_DIFFERENCES = 1e-7
STEP = 1e-3
SMALL = 1e-6  # entries all below this, in N m or kg m², count as rounding of zero
FINGERS = re.compile("finger|gripper|hand", re.IGNORECASE)
KEYS = ["q_l", "dq_l", "ddq_l", "d3q_l", "d4q_l"]


def flexure(binary, *arguments, text=None):
    return subprocess.run([binary, *map(str, arguments)], input=text, capture_output=True, text=True)


def pinocchio_model(urdf):
    """Pinocchio's model, or None of a file that it cannot read or that does not move."""
    try:
        model = pin.buildModelFromUrdf(str(urdf))
    except (ValueError, RuntimeError):
        return None
    return model if model.nv > 0 else None


def locks_needed(model):
    """No joints if few enough move, else the fingers, or None if that does not do. Drafts lock what others mimic."""
    fingers = [name for name in model.names[1:] if FINGERS.search(name)]
    if model.nv <= MOST_JOINTS + 1:  # a pair of fingers that mimic each other is locked by itself
        return []
    return fingers if model.njoints - 1 - len(fingers) <= MOST_JOINTS else None


def robot_file(binary, urdf, locks, folder):
    """The drafted robot file with every missing number supplied, or None of a refused URDF."""
    draft = flexure(binary, "import", urdf, "--unknown-limits", *(word for name in locks for word in ("--lock", f"{name}=0")))
    if draft.returncode != 0:
        return None
    path = folder / "robot.toml"
    path.write_text(draft.stdout.replace("= nan", "= 1.0"))
    return path


def reduced(model, urdf, moving, locked):
    """The model with every joint but the `moving` ones held still: `locked` ones as said, others as they mimic those."""
    mimics = {
        joint.get("name"): (mimic.get("joint"), float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0)))
        for joint in ElementTree.parse(urdf).getroot().findall("joint")
        if (mimic := joint.find("mimic")) is not None
    }

    def position(name):
        if name in locked:
            return locked[name]
        master, multiplier, offset = mimics[name]
        return multiplier * position(master) + offset

    held = [name for name in model.names[1:] if name not in moving]
    if not held:
        return model
    q = pin.neutral(model)
    for name in held:
        set_position(model, q, name, position(name))
    return pin.buildReducedModel(model, [model.getJointId(name) for name in held], q)


def set_position(model, q, name, value):
    joint = model.joints[model.getJointId(name)]
    if joint.nq == 1:
        q[joint.idx_q] = value
    else:  # continuous joints are a point of the unit circle
        q[joint.idx_q : joint.idx_q + 2] = np.cos(value), np.sin(value)


def configuration(model, moving, values):
    q = pin.neutral(model)
    for name, value in zip(moving, values):
        set_position(model, q, name, value)
    return q


def order(model, moving):
    """Where each moving joint stands in Pinocchio's vectors of velocities."""
    return [model.joints[model.getJointId(name)].idx_v for name in moving]


def torque_rate(model, data, moving, derivatives):
    """dτ/dt by the chain rule from Pinocchio's partial derivatives."""
    index = order(model, moving)
    vector = [np.empty(model.nv) for _ in range(3)]
    for target, values in zip(vector, derivatives[1:4]):
        target[index] = values
    v, a, jerk = vector
    by_q, by_v, by_a = pin.computeRNEADerivatives(model, data, configuration(model, moving, derivatives[0]), v, a)
    by_a = np.triu(by_a) + np.triu(by_a, 1).T
    return (by_q @ v + by_v @ a + by_a @ jerk)[index]


def along(derivatives, t):
    """Derivatives at time t of the polynomial with these derivatives at 0."""
    shifted = []
    for k in range(len(derivatives)):
        total, factor = np.zeros_like(derivatives[0]), 1.0
        for j, values in enumerate(derivatives[k:]):
            total = total + factor * values
            factor *= t / (j + 1)
        shifted.append(total)
    return shifted


def compare(binary, urdf, model, path, generator):
    """The largest relative deviation of each quantity."""
    locked = tomllib.loads(path.read_text())["links"].get("locked", {})
    checked = json.loads(flexure(binary, "check", path, "--allow-outside", "--json").stdout)
    moving = [row["name"] for row in checked[0]["robot"]]
    model = reduced(model, urdf, moving, locked)
    data, index = model.createData(), order(model, moving)
    states = [
        [scale * generator.uniform(-1, 1, len(moving)) for scale in (np.pi, 2.0, 5.0, 10.0, 20.0)]
        for _ in range(STATES)
    ]
    lines = [
        json.dumps({**dict(zip(KEYS, map(list, state))), "q_m": list(state[0]), "dq_m": list(state[1])})
        for state in states
    ]
    out = flexure(binary, "model", path, "--allow-outside", "--states", "-", text="\n".join(lines))
    if out.returncode != 0:
        raise SystemExit(f"{urdf.name}: flexure model: {out.stderr}")
    worst = dict.fromkeys(["M", "bias", "tau", "dtau", "ddtau"], 0.0)
    for state, line in zip(states, out.stdout.splitlines(), strict=True):
        row = json.loads(line)
        q = configuration(model, moving, state[0])
        v, a = np.empty(model.nv), np.empty(model.nv)
        v[index], a[index] = state[1], state[2]
        mass = pin.crba(model, data, q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        rates = [torque_rate(model, data, moving, along(state, k * STEP)) for k in (-2, -1, 1, 2)]
        difference = (rates[0] - 8 * rates[1] + 8 * rates[2] - rates[3]) / (12 * STEP)
        expected = {
            "M": (row["M_l"], mass[np.ix_(index, index)]),
            "bias": (row["bias"], pin.nonLinearEffects(model, data, q, v)[index]),
            "tau": (row["tau_l"], pin.rnea(model, data, q, v, a)[index]),
            "dtau": (row["dtau_l"], torque_rate(model, data, moving, state)),
            "ddtau": (row["ddtau_l"], difference),
        }
        for key, (found, exact) in expected.items():
            deviation = np.abs(np.array(found) - exact).max() / max(np.abs(exact).max(), SMALL)
            worst[key] = max(worst[key], deviation) if np.isfinite(deviation) else np.inf
    return len(moving), len(set(model.parents[1:])) == model.nv, worst


def impossible(urdf):
    """Whether some inertia of the URDF is none that a body can have, which Flexure refuses: a principal one is below 0."""

    def lowest(inertia):
        xx, xy, xz, yy, yz, zz = (float(inertia.get(key)) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
        return np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])[0]

    return any(lowest(inertia) < -1e-12 for inertia in ElementTree.parse(urdf).getroot().findall("link/inertial/inertia"))


def perturbed(urdf, folder):
    """The URDF with one inertia, of the last link that is no trifle, wrong by a millionth."""
    tree = ElementTree.parse(urdf)
    inertias = tree.getroot().findall("link/inertial/inertia")
    inertia = [inertia for inertia in inertias if float(inertia.get("ixx")) > 2e-3][-1]
    inertia.set("ixx", repr(float(inertia.get("ixx")) * (1 + 1e-6)))
    path = folder / urdf.name
    tree.write(path)
    return path


def main(binary, perturb):
    share = Path(pin.__file__).parents[4] / "share" / "example-robot-data" / "robots"
    files = sorted(share.rglob("*.urdf")) + sorted((Path(__file__).parents[1] / "data").glob("*.urdf"))
    if perturb:
        files = [path for path in files if path.name == "panda.urdf"]
    generator = np.random.default_rng(20261121)
    compared, failed = 0, 0
    for urdf in files:
        model = pinocchio_model(urdf)
        name = urdf.relative_to(share) if urdf.is_relative_to(share) else urdf.name
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            source = perturbed(urdf, folder) if perturb else urdf
            locks = locks_needed(model) if model else []
            if locks is None:
                continue
            path = robot_file(binary, source, locks, folder)
            if path is None and model is not None and impossible(urdf):
                print(f"refused {name}: an inertia is indefinite")
                continue
            if (path is None) != (model is None):
                print(f"FAILED {name}: only one of the two reads it")
                failed += 1
            if path is None or model is None:
                continue
            joints, serial, worst = compare(binary, urdf, model, path, generator)
        limits = {key: TOLERANCE_DIFFERENCES if key == "ddtau" else TOLERANCE for key in worst}
        good = all(worst[key] <= limits[key] for key in worst)
        compared, failed = compared + 1, failed + (not good)
        figures = "  ".join(f"{key} {value:.1e}" for key, value in worst.items())
        print(f"{'ok    ' if good else 'FAILED'} {joints} {'serial' if serial else 'tree  '} {figures}  {name}")
    print(f"{compared} robots compared at {STATES} states each, {failed} failed")
    return 1 if failed or compared == 0 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], "--perturb" in sys.argv[2:]))
