#!/usr/bin/env python3
"""Checks certificates. docs/certificate.md is the statement, this its check with Python and mpmath alone.

    check_certificate.py FILE...

A line a file. Exit code: 0 all proved, 1 a claim does not hold, 2 not a certificate; the worst of all files.
Decimals are rationals, bounds are intervals of 80 bits rounded outward. A comparison of intervals is true only where it
holds for all reals inside. The time is that from the text to the verdict, without starting Python.
"""
import itertools
import json
import re
import sys
import time
from fractions import Fraction

from mpmath import iv, mp, mpf

iv.prec, mp.prec = 80, 200  # ends of intervals are never rounded where they are compared
ZERO, ONE = iv.mpf(0), iv.mpf(1)
DECIMAL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,4})?", re.ASCII)


class Malformed(Exception):
    """The text is no certificate."""


class Fails(Exception):
    """A claim does not hold."""


def need(holds, claim, error=Fails):
    if holds is not True:  # None: intervals overlap, nothing is known
        raise error(claim)


# ---- Numbers and intervals

class Number:
    """`exact` is a rational, None for a pair; `set` contains whatever real it may be."""

    def __init__(self, text):
        ends = [decimal(end) for end in (text if isinstance(text, list) else [text])]
        need(len(ends) in (1, 2) and ends[0] <= ends[-1], "a pair is two numbers in order", Malformed)
        self.exact = None if isinstance(text, list) else ends[0]
        self.set = hull(*(iv.mpf(end.numerator) / end.denominator for end in ends))

    def at_most(self, other):
        return self.set <= other.set if None in (self.exact, other.exact) else self.exact <= other.exact


def decimal(text):
    fits = isinstance(text, str) and len(text) <= 1000 and bool(DECIMAL.fullmatch(text))
    need(fits and abs(Fraction(text)) < 2**1024, f"{text!r:.60} is no finite decimal", Malformed)
    return Fraction(text)


def sets(numbers):
    return [number.set for number in numbers]


def hull(*xs):
    return iv.mpf([min(mpf(x.a) for x in xs), max(mpf(x.b) for x in xs)])


def largest(*xs):
    return iv.mpf(max(mpf(x.b) for x in xs))  # upper end


def least(*xs):
    return iv.mpf(min(mpf(x.b) for x in xs))  # the smallest upper end


def root(x):
    return iv.sqrt(iv.mpf([max(mpf(x.a), 0), max(mpf(x.b), 0)]))  # of what is known to be at least 0


def smallest_pivot(a):
    """A lower bound of the pivots of L D L'. If it is at least 0, all matrices inside are positive semidefinite."""
    a, pivots = [list(row) for row in a], []
    for k, row in enumerate(a):
        pivots.append(mpf(row[k].a))
        rest = [i for i in range(k + 1, len(a)) if mpf(abs(row[i]).b) > 0]
        if rest and not pivots[-1] > 0:
            return mpf("-inf")
        for i, j in itertools.combinations_with_replacement(rest, 2):
            a[i][j] = a[j][i] = a[i][j] - (row[i] ** 2 if i == j else row[i] * row[j]) / row[k]
    return min(pivots)


# ---- The file: exactly the keys, lengths and kinds of a specification

def read(value, spec, path="the file"):
    if isinstance(spec, dict):
        need(isinstance(value, dict) and value.keys() == spec.keys(), f"{path}: keys must be {[*spec]}", Malformed)
        return {key: read(value[key], spec[key], f"{path}.{key}") for key in spec}
    if isinstance(spec, list):  # [what, how many], or [what] of any length
        need(isinstance(value, list) and len(value) in (spec[1:] or [len(value)]), f"{path}: must be a list{spec[1:]}", Malformed)
        return [read(entry, spec[0], f"{path}[{i}]") for i, entry in enumerate(value)]
    if isinstance(spec, tuple):  # or null
        return None if value is None else read(value, spec[0], path)
    if isinstance(spec, (set, range)):
        fits = isinstance(value, str if isinstance(spec, set) else int) and not isinstance(value, bool) and value in spec
        need(fits, f"{path}: must be one of {spec}", Malformed)
    elif spec is Number:
        need(isinstance(value, (str, list)), f"{path}: a number is a text", Malformed)
        return Number(value)
    else:
        need(isinstance(value, spec), f"{path}: must be of {spec}", Malformed)
    return value


def read_links(links, n):
    kind, pair, vector = links.get("kind"), [Number, 2], [Number, 3]
    if kind == "planar-two-link" and n == 2:
        return read(links, {"kind": str, "mass": pair, "length": Number, "com": pair, "inertia": pair})
    if kind == "pendulum" and n == 1:
        return read(links, {"kind": str, "mass": Number, "com": Number, "inertia": Number})
    need(kind == "tree", "links: no kind that fits the joints", Malformed)
    links = read(links, {"kind": str, "bodies": [dict, n]})
    for k, body in enumerate(links["bodies"]):
        travel = pair if body.get("kind") == "prismatic" else (set(), None)  # of a revolute joint: null, or not there
        links["bodies"][k] = read({"travel": None} | body if travel != pair else body, {
            "parent": (range(k), None), "kind": {"revolute", "prismatic"}, "axis": vector, "rotation": [vector, 3], "mass": Number,
            "translation": vector, "com": vector, "inertia": [Number, 6], "travel": travel}, f"bodies[{k}]")
    return links


def read_file(text):
    def unique(pairs):
        need(len(dict(pairs)) == len(pairs), "a key is there twice", Malformed)
        return dict(pairs)

    need(len(text.encode()) <= 4 << 20, "larger than 4 MiB", Malformed)
    try:
        raw = json.loads(text, object_pairs_hook=unique, parse_float=lambda _: None, parse_constant=lambda _: None)
    except (ValueError, RecursionError) as error:
        raise Malformed(str(error)) from None
    robot = raw.get("robot") if isinstance(raw, dict) else None
    n = read(robot.get("joints") if isinstance(robot, dict) else None, range(1, 65), "robot.joints")
    coupled = isinstance(raw.get("controller"), dict) and raw["controller"].get("phi") == "coupled-tanh"
    need(not coupled or n <= 16, "coupled-tanh is for 16 joints at most", Malformed)
    numbers, words, side = [Number, n], [str, 4], {"link", "motor"}
    gains = {"metric": numbers, "shaping": numbers, "damping": numbers, "kappa": numbers if coupled else (set(), None)}
    case = {"case": str, "contraction": Number, "convergence": Number}
    witness = {"side": side, "error": numbers, "row": range(n), "column": range(n), "difference": Number}
    file = read(raw, {
        "format": {"flexure-certificate"}, "version": range(1, 2), "name": str, "made_by": str, "assumptions": [str],
        "robot": {"name": str, "joints": int, "stiffness": numbers, "motor_inertia": numbers, "link_damping": numbers,
                  "motor_damping": numbers, "links": dict},
        "controller": {"phi": {"tanh", "linear", "coupled-tanh"}, "link": gains, "motor": gains},
        "region": {"error": [(Number,), 2 * n], "level": (Number,)}, "closed_loop": {"rows": [words, 4], "dissipation": words},
        "blocks": [{"block": str, "contraction": Number, "convergence": Number, "cases": [case]}], "contraction_rate": Number, "convergence_rate": Number,
        "mass_matrix": {"margins": [Number]}, "measures": [{"side": side, "norm": str, "bound": Number}],
        "structure": [{"name": str, "holds": bool, "witness": (witness,)}],
        "tube": ({"disturbance": numbers, "level": Number, "error": [Number, 2 * n]},)})
    file["links"] = read_links(file["robot"]["links"], n)
    return file


def by_name(entries, name, wanted):
    """The entries by name: exactly the wanted ones, each once."""
    names = [name(entry) for entry in entries]
    need(sorted(names) == sorted(wanted), f"there are {names}, must be {wanted}"[:300])
    return dict(zip(names, entries))


def check_signs(file):
    robot, links = file["robot"], file["links"]
    above = robot["stiffness"] + robot["motor_inertia"]
    for gains in (file["controller"]["link"], file["controller"]["motor"]):
        above = above + gains["metric"] + gains["shaping"] + gains["damping"] + (gains["kappa"] or [])
    bodies = links.get("bodies", [links] if links["kind"] == "pendulum" else [])
    if links["kind"] == "planar-two-link":
        above = above + links["mass"] + links["inertia"] + [links["length"]]
    for body in bodies:
        need(not body.get("travel") or body["travel"][0].at_most(body["travel"][1]), "robot: travel is no range")
    others = robot["link_damping"] + robot["motor_damping"] + [body["mass"] for body in bodies]
    others += [links["inertia"]] if links["kind"] == "pendulum" else []
    need(all(number.set > 0 for number in above), "robot, controller: a number is not > 0")
    need(all(number.set >= 0 for number in others), "robot: a number is not >= 0")


# ---- closed_loop: words of letters that do not commute

ROWS = [["-Fl", "0", "1", "0"], ["0", "-Fm", "-Pm^-1 K", "1"], ["-Pl", "K", "-S + 1/2 R - Bl", "0"], ["0", "-Pm", "0", "-Bm"]]
LOSSES = ["Pl Fl", "Pm Fm", "Bl", "Bm"]


def words(text, front=()):
    """`front` times the sum, as a list of (factor, word)."""
    total = []
    for term in text.replace(" - ", " + -").split(" + "):
        sign, letters = (-1 if term.startswith("-") else 1), term.removeprefix("-").split()
        factor = {"0": 0, "1": 1, "1/2": Fraction(1, 2)}.get(letters[0] if letters else "")
        word = " ".join([*front, *letters[factor is not None:]]).replace("Pm Pm^-1", "")
        total.append((sign * (1 if factor is None else factor), tuple(word.split())))
    return sorted(pair for pair in total if pair[0])


def transposed(total):
    letter = {"Fl": "Fl'", "Fm": "Fm'"}
    return [(factor * (-1) ** word.count("S"), tuple(letter.get(x, x) for x in reversed(word))) for factor, word in total]


def check_closed_loop(claimed):
    same = all(words(a) == words(b) for row, own in zip(claimed["rows"], ROWS) for a, b in zip(row, own))
    need(same and list(map(words, claimed["dissipation"])) == list(map(words, LOSSES)), "closed_loop: not that of the law")
    g = [[words(word, front) for word in row] for front, row in zip((["Pl"], ["Pm"], [], []), ROWS)]
    g[2][2] += words("-1/2 R")
    for i, j in itertools.product(range(4), repeat=2):
        total, loss = {}, words(LOSSES[i]) if i == j else []
        for factor, word in g[i][j] + transposed(g[j][i]) + loss + transposed(loss):
            total[word] = total.get(word, 0) + factor
        need(not any(total.values()), f"closed_loop: block ({i}, {j}) does not cancel")


# ---- Position blocks: slopes and chords of tanh, both decreasing in the error

def slope(x):
    return (2 / (iv.exp(x) + iv.exp(-x))) ** 2


def chord(x):
    return (1 - 2 / (iv.exp(2 * x) + 1)) / x


class Side:
    """The law of one side, with the largest errors there."""

    def __init__(self, file, name):
        self.phi, self.n = file["controller"]["phi"], file["robot"]["joints"]
        self.gains = file["controller"][name]
        self.bounds = file["region"]["error"][slice(self.n) if name == "link" else slice(self.n, None)]
        self.metric, self.shaping = sets(self.gains["metric"]), sets(self.gains["shaping"])

    def lower_ends(self, f):
        return [ZERO if bound is None else iv.mpf(max(mpf(f(largest(bound.set)).a), 0)) for bound in self.bounds]

    def entry(self, i, j, a, weight=ONE):
        """sqrt(weight) times the entry of the slope's matrix."""
        if i == j and self.phi != "coupled-tanh":
            return self.shaping[i] * (a if self.phi == "tanh" else 1)
        if self.phi != "coupled-tanh":
            return ZERO
        off = root(weight * self.shaping[j] / self.shaping[i]) * a / max(self.n - 1, 1)
        return off if i != j else 1 + self.gains["kappa"][i].set

    def cases(self):
        alphabet = {"tanh": ["L"], "coupled-tanh": ["L", "H"] if self.n > 1 else [""], "linear": [""]}[self.phi]
        return ["".join(word) for word in itertools.product(alphabet, repeat=self.n)]

    def pivot(self, case, lower, beta):
        a = [low if letter == "L" else ONE for low, letter in zip(lower, case.ljust(self.n))]
        x = [[self.metric[i] * (self.entry(i, j, a[j]) - (beta if i == j else 0)) for j in range(self.n)] for i in range(self.n)]
        return smallest_pivot([[(x[i][j] + x[j][i]) / 2 for j in range(self.n)] for i in range(self.n)])

    def measure(self, norm):
        """The largest of the column sums (norm 1) or row sums (inf): an upper bound."""
        a, sums = [hull(low, ONE) for low in self.lower_ends(slope)], []
        for k in range(self.n):
            sums.append(-self.entry(k, k, a[k]))
            for i, j in [(o, k) if norm == "1" else (k, o) for o in range(self.n) if o != k]:
                sums[k] += largest(self.entry(i, j, a[j], self.metric[i] / self.metric[j]))
        return largest(*sums)


# ---- Momentum blocks and the mass matrix

def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def norm(a):
    return root(sum((x**2 for x in a), ZERO))


def across(x, e):
    return [p - dot(x, e) * q for p, q in zip(x, e)]


def nearest(rows):
    """Contains the nearest unit vector (one row) or rotation: the distance is at most |R R' - 1|."""
    n = len(rows)
    defect = largest(norm([dot(rows[i], rows[j]) - (i == j) for i in range(n) for j in range(n)]))
    need(defect < 1e-6 and (n == 1 or dot(cross(*rows[:2]), rows[2]) > 0), "bodies: an axis or rotation is none")
    return [[x + hull(-defect, defect) for x in row] for row in rows]


class Body:
    def __init__(self, body):
        self.parent, self.travel = body["parent"], body["travel"] and hull(*sets(body["travel"]))
        self.axis = nearest([sets(body["axis"])])[0]
        self.z = [dot(row, self.axis) for row in nearest([sets(row) for row in body["rotation"]])]
        self.o, self.c, self.mass = sets(body["translation"]), sets(body["com"]), body["mass"].set
        xx, xy, xz, yy, yz, zz = sets(body["inertia"])
        self.inertia = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        self.turned = [dot(row, self.axis) for row in self.inertia]
        self.spread = least(norm(sum(self.inertia, [])), largest(*(sum(map(abs, row)) for row in self.inertia)))

    def own_inertia(self):
        zero = all(mpf(abs(x).b) == 0 for row in self.inertia for x in row)
        need(zero or smallest_pivot(self.inertia) > 0, "mass_matrix: an inertia is neither positive definite nor zero")
        lever = sum(x**2 for x in cross(self.axis, self.c))
        return mpf((self.mass if self.travel else dot(self.axis, self.turned) + self.mass * lever).a)

    def slide(self, a, rho, r):
        return (a + self.travel, rho, r + largest(abs(self.travel))) if self.travel else (a, rho, r)

    def start(self):
        return self.slide(dot(self.c, self.axis), largest(norm(across(self.c, self.axis))), largest(norm(self.c)))

    def to(self, parent, a, rho, r):
        """Where the centre of mass can be in the parent's frame: along the axis, from the axis, from the origin."""
        o, z, e = self.o, self.z, parent.axis
        c, normal, ends = dot(z, e), cross(e, z), [iv.mpf(a.a), iv.mpf(a.b)]
        s = norm(normal)
        square = norm(o) ** 2 + r**2 + 2 * largest(*(x * dot(o, z) for x in ends)) + 2 * rho * norm(across(o, z))
        far = least(norm(o) + r, root(square))
        along = dot(o, e) + a * c + rho * hull(-s, s)
        along = iv.mpf([max(mpf(along.a), -mpf(far.b)), min(mpf(along.b), mpf(far.b))])
        off = [far, rho + largest(*(norm(across([p + x * q for p, q in zip(o, z)], e)) for x in ends))]
        if s**2 > 1e-6:
            inward = largest(*(abs(dot(o, across(z, e)) / s + x * s) for x in ends)) + abs(c) * rho
            off.append(root((abs(dot(o, normal)) / s + rho) ** 2 + inward**2))
        return parent.slide(along, least(*off), far)


def mass_bound(bodies):
    bound = [[ZERO] * len(bodies) for _ in bodies]
    for k, body in enumerate(bodies):
        chain, reach = [k], {k: body.start()}
        while bodies[chain[-1]].parent is not None:
            j, i = chain[-1], bodies[chain[-1]].parent
            reach[i] = bodies[j].to(bodies[i], *reach[j])
            chain.append(i)
        for j, i in itertools.combinations_with_replacement(chain, 2):
            tau = [ONE if bodies[x].travel else reach[x][1] for x in (i, j)]
            linear, turning = tau[0] * tau[1], not (bodies[i].travel or bodies[j].travel)
            angular = dot(body.axis, body.turned) if i == k else norm(body.turned) if j == k else body.spread
            if turning and bodies[j].parent == i:
                g = (1 + abs(dot(bodies[i].axis, bodies[j].z))) / 2
                linear = least(linear, g * reach[j][2] ** 2 + norm(cross(bodies[i].axis, bodies[j].o)) * reach[j][1])
                angular = least(angular, g * body.spread)
            bound[i][j] = bound[j][i] = largest(bound[i][j] + body.mass * linear + (angular if turning else 0))
    return bound


def mass_matrices(links):
    """By case, with lower bounds of the pivots of the mass matrix."""
    if links["kind"] == "tree":
        bodies = [Body(body) for body in links["bodies"]]
        return {"": mass_bound(bodies)}, [body.own_inertia() for body in bodies]
    if links["kind"] == "pendulum":
        mass = links["inertia"].set + links["mass"].set * links["com"].set ** 2
        return {"": [[mass]]}, [mpf(mass.a)]
    (m1, m2), (r1, r2), (i1, i2) = (sets(links[key]) for key in ("mass", "com", "inertia"))
    l1, cases = links["length"].set, {}
    a1, a2, b = m1 * r1**2 + m2 * l1**2 + i1, m2 * r2**2 + i2, m2 * l1 * r2
    for case, c in (("L", -1), ("H", 1)):
        cases[case] = [[a1 + a2 + 2 * b * c, a2 + b * c], [a2 + b * c, a2]]
    return cases, [smallest_pivot(m) for m in cases.values()]


# ---- The claims

RATES = (("contraction", slope), ("convergence", chord))


def check_block(block, cases, pivot, name):
    found = by_name(block["cases"], lambda entry: entry["case"], cases)
    for rate, case in itertools.product(RATES, cases):
        beta, margin = block[rate[0]].set, found[case][rate[0]].set
        need(beta > 0, f"{name}: the {rate[0]} is not > 0")
        least_pivot = pivot(case, rate[1], beta)
        need(margin >= 0 and least_pivot >= mpf(margin.b), f"{name}: case '{case}', {rate[0]}: pivot {float(least_pivot):.6g} at that rate")


def check_blocks(file, sides, masses):
    robot, blocks = file["robot"], by_name(file["blocks"], lambda entry: entry["block"], ["phi_l", "phi_m", "sigma_l", "sigma_m"])
    for side, x in ((sides["link"], "l"), (sides["motor"], "m")):
        ends = {f: side.lower_ends(f) for _, f in RATES}
        check_block(blocks["phi_" + x], side.cases(), lambda case, f, beta: side.pivot(case, ends[f], beta), "phi_" + x)
    damping = {x: [d.set + k.set for d, k in zip(robot[x + "_damping"], sides[x].gains["damping"])] for x in sides}
    inertia = sets(robot["motor_inertia"])

    def links(case, _, beta):
        return smallest_pivot([[(damping["link"][i] if i == j else 0) - beta * m for j, m in enumerate(row)] for i, row in enumerate(masses[case])])

    def motors(case, _, beta):
        return min(mpf((d - beta * m).a) for d, m in zip(damping["motor"], inertia))

    check_block(blocks["sigma_l"], list(masses), links, "sigma_l")
    check_block(blocks["sigma_m"], [""], motors, "sigma_m")
    for x in ("sigma_l", "sigma_m"):
        need(blocks[x]["contraction"].exact is not None and blocks[x]["contraction"].exact == blocks[x]["convergence"].exact, f"{x}: the rates differ")
    for rate, _ in RATES:
        top = file[rate + "_rate"]
        need(top.set > 0 and all(top.at_most(block[rate]) for block in blocks.values()), f"{rate}_rate: more than that of a block, or not > 0")
    return blocks


def check_region(file, metric):
    error, level = file["region"]["error"], file["region"]["level"]
    need({bound is None for bound in error} == {level is None}, "region: some bounds are null and some are not")
    if level is not None:
        need(level.set > 0, "region: the level is not > 0")
        need(all(bound.set > 0 and 2 * level.set <= p * bound.set**2 for bound, p in zip(error, metric)), "region: W <= level leaves it")


def check_measures(file, sides, blocks):
    wanted = list(itertools.product(sides, ("1", "2", "inf")))
    for (side, kind), entry in by_name(file["measures"], lambda entry: (entry["side"], entry["norm"]), wanted).items():
        block, bound = blocks["phi_l" if side == "link" else "phi_m"]["contraction"], entry["bound"]
        if kind == "2" and None not in (block.exact, bound.exact):
            holds = bound.exact >= -block.exact
        else:
            holds = bound.set >= (-block.set if kind == "2" else sides[side].measure(kind))
        need(holds, f"measures: {side}, norm {kind} is more than claimed")


def check_structure(file, sides):
    law = next(iter(sides.values()))
    same = all(p.exact is not None and p.exact == q.exact for s in sides.values() for p, q in zip(s.gains["shaping"], s.gains["metric"]))
    truth = {"variational-ph": law.phi != "coupled-tanh" or law.n == 1, "ph-like": law.phi == "linear" and same,
             "strict-differential-passivity": True, "incremental-passivity": True}
    for name, entry in by_name(file["structure"], lambda entry: entry["name"], [*truth]).items():
        witness = entry["witness"]
        need(entry["holds"] == truth[name] == (witness is None), f"structure: {name}: holds is {truth[name]}, or the witness is wrong")
        if witness is None:
            continue
        side, i, j, d = sides[witness["side"]], witness["row"], witness["column"], witness["difference"].set
        for e, bound in zip(witness["error"], side.bounds):
            inside = bound is None or abs(e.set) <= bound.set or e.exact is not None and bound.exact is not None and abs(e.exact) <= bound.exact
            need(inside, f"structure: {name}: the witness is outside the region")
        a, metric = [slope(e.set) for e in witness["error"]], side.metric
        off = side.entry(i, j, a[j]) - (metric[i] if i == j else 0) if name == "ph-like" else \
            side.entry(i, j, a[j]) / metric[j] - side.entry(j, i, a[i]) / metric[i]
        need(d > 0 and abs(off) >= d, f"structure: {name}: the difference is smaller")


def check_tube(file, metric, blocks):
    tube, level, region = file["tube"], file["tube"]["level"], file["region"]["level"]
    need(all(d.set >= 0 for d in tube["disturbance"] + tube["error"] + [level]), "tube: a number is not >= 0")
    strength = sum((d.set**2 / m.set for d, m in zip(tube["disturbance"], file["robot"]["motor_inertia"])), ZERO)
    b, rest = blocks["sigma_m"]["convergence"].set, [blocks[x]["convergence"].set for x in ("phi_l", "phi_m", "sigma_l")]
    beta = iv.mpf([min(mpf(x.a) for x in rest), min(mpf(x.b) for x in rest)])
    fast, slow = strength / (8 * beta * (b - beta)), strength / (2 * b**2)
    known = b >= 2 * beta  # None: either may be the one
    need(all(level.set >= x for x in ([fast] if known else [slow] if known is False else [fast, slow])), "tube: the level is too low")
    need(region is None or level.at_most(region), "tube: the level is more than the region's")
    need(all(p * e.set**2 >= 2 * level.set for p, e in zip(metric, tube["error"])), "tube: an error is too small")


def check(text):
    """The rates that are proved."""
    file = read_file(text)
    check_signs(file)
    check_closed_loop(file["closed_loop"])
    sides = {name: Side(file, name) for name in ("link", "motor")}
    metric = sides["link"].metric + sides["motor"].metric
    masses, pivots = mass_matrices(file["links"])
    margins = sets(file["mass_matrix"]["margins"])
    need(len(margins) == len(pivots) and all(m > 0 and mpf(m.b) <= p for m, p in zip(margins, pivots)), "mass_matrix: a margin is not reached")
    check_region(file, metric)
    blocks = check_blocks(file, sides, masses)
    check_measures(file, sides, blocks)
    check_structure(file, sides)
    if file["tube"]:
        check_tube(file, metric, blocks)
    return [float(mpf(file[rate + "_rate"].set.a)) for rate, _ in RATES]


def main(paths):
    worst = 0 if paths else 2
    for path in paths:
        start = time.perf_counter()
        try:
            with open(path, encoding="utf-8") as opened:
                rates = check(opened.read((4 << 20) + 1))
            text = "proved: contraction {:.10g} 1/s, convergence {:.10g} 1/s".format(*rates)
            print(f"{path}: {text}, checked in {1e3 * (time.perf_counter() - start):.1f} ms")
        except Fails as error:
            worst = max(worst, 1)
            print(f"{path}: does not hold: {error}")
        except (Malformed, OSError, UnicodeDecodeError) as error:
            worst = 2
            print(f"{path}: not a certificate: {error}")
    return worst


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
