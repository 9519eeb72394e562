#!/usr/bin/env python3
"""Checks certificates as docs/certificate.md states them, with Python and mpmath alone: check_certificate.py FILE...

Exit code: 0 all proved, 1 a claim does not hold, 2 not a certificate; the worst of all files. Numbers are intervals of 80
bits rounded outward; a comparison of two is true only where it holds for all reals inside. Any other error refuses the file."""
import json, re, sys, time
from fractions import Fraction
from functools import partial, reduce
from itertools import combinations_with_replacement, permutations, product
from math import ceil, floor, nan, prod
from mpmath import iv, mp, mpf

iv.prec, mp.prec = 80, 200  # ends of intervals are not rounded again where they are taken out
ZERO, ONE = iv.mpf(0), iv.mpf(1)
DECIMAL = re.compile(r"(?!.{101})-?(0|[1-9]\d*)(\.\d+)?([eE][+-]?\d{1,3})?", re.ASCII)
SMALLEST, LARGEST = Fraction(1, 10**330), 10**100

def need(holds, claim, error=AssertionError):  # a ValueError where it is not even a certificate
    if holds is not True:  # None: intervals overlap, nothing is known
        raise error(claim)

# ---- Intervals and matrices: x.a and x.b are the ends of x
def span(low, high):
    return iv.mpf([mpf(low.a), mpf(high.b)])
def root(x):
    return iv.sqrt(span(max(x.a, ZERO), max(x.b, ZERO)))  # of what is known to be at least 0
def diagonal(xs):
    return [[x if i == j else ZERO for j in range(len(xs))] for i, x in enumerate(xs)]

def smallest_pivot(matrix):  # a lower bound for L D L'; if it is at least 0, all matrices inside are positive semidefinite
    a, pivots = [list(row) for row in matrix], [iv.inf]
    for k, row in enumerate(a):
        pivots.append(row[k].a)
        below = [i for i in range(k + 1, len(a)) if row[i] != 0]
        if below and not row[k].a > 0:
            return iv.ninf
        for i, j in combinations_with_replacement(below, 2):
            a[i][j] = a[j][i] = a[i][j] - (row[i] ** 2 if i == j else row[i] * row[j]) / row[k]
    return min(pivots)

# ---- The file: exactly the keys, lengths and kinds of a specification; what has a key twice stays a list
def enclosed(low, high):
    sets = [iv.mpf(value.numerator) / value.denominator for value in (low, high)]
    return span(*sets)
def few_digits(value, digits, up):  # the nearest number of so many digits above, or below
    size = abs(value)
    unit = Fraction(10) ** (len(str(size.numerator)) - len(str(size.denominator)) - digits - 1 if size else 0)
    while size >= 10**digits * unit:
        unit *= 10
    return (ceil if up else floor)(value / unit) * unit

WRONG = []  # signs: complained of once the file is read, so that what is no certificate is called that
def number(text, sign=None, rounded=None):  # a decimal, or a pair for a real between two, as an interval that knows its rational ends
    ends = text if isinstance(text, list) else [text]
    need(all(map(DECIMAL.fullmatch, ends)), f"{text!s:.60} is no number", ValueError)
    values = [Fraction(end) for end in ends]
    need(all(value == 0 or SMALLEST <= abs(value) < LARGEST for value in values), f"{text!s:.60} is too small or large", ValueError)
    low, high = values if ends is text else values * 2
    need(low <= high, f"{text!s:.60} is the wrong way round", ValueError)
    if not {None: True, "> 0": low > 0, ">= 0": low >= 0}[sign]:
        WRONG.append(f"{text!s:.60} is not {sign}")
    x = enclosed(low, high)
    x.low, x.high, x.exact = low, high, nan if ends is text else low  # a pair equals nothing
    x.claimed = enclosed(*(few_digits(end, *rounded) for end in (low, high))) if rounded else x
    return x
positive, not_negative = partial(number, sign="> 0"), partial(number, sign=">= 0")

def read(value, spec):  # the value, if it is as specified: (spec,) is that or null, [spec, ...] a list of any length
    if isinstance(spec, tuple):
        return None if value is None else read(value, spec[0])
    if isinstance(spec, dict):
        need(value.keys() == spec.keys(), f"keys are {[*value]}, must be {[*spec]}", ValueError)
        return {key: read(value[key], spec[key]) for key in spec}
    if isinstance(spec, list):
        need(isinstance(value, list), f"{value!s:.60} is no list", ValueError)
        return [read(*pair) for pair in zip(value, spec[:1] * len(value) if spec[-1] is ... else spec, strict=True)]
    if isinstance(spec, (set, range, type)):
        fits = type(value) is spec if isinstance(spec, type) else type(value) in (str, int) and value in spec
        need(fits, f"{value!s:.60} is not of {spec}", ValueError)
    return value if isinstance(spec, (set, range, type)) else spec(value)
def both(down, up, text):  # a level that is claimed to be enough, and from which errors follow
    x = down(text)
    x.reached = up(text).claimed
    return x
def digest(text):
    need(re.fullmatch("[0-9a-f]{64}", text) is not None, f"{text!s:.60} is no SHA-256", ValueError)
    return text
def read_body(k, raw):
    slides, vector = raw["kind"] == "prismatic", [number] * 3
    return read(raw if slides else {"travel": None} | raw, {
        "parent": (range(k),), "kind": {"revolute", "prismatic"}, "axis": vector, "rotation": [vector] * 3, "translation": vector,
        "mass": not_negative, "com": vector, "inertia": [number] * 6, "travel": [number] * 2 if slides else type(None)})

def whole(digits):
    need(digits.isdigit(), f"{digits:.60} is no index", ValueError)
    return int(digits)
def read_file(data):
    need(len(data) <= 4 << 20, "larger than 4 MiB", ValueError)
    text = data.decode("utf-8")
    raw = json.loads(text, object_pairs_hook=lambda pairs: dict(pairs) if len(dict(pairs)) == len(pairs) else pairs, parse_int=whole)
    json.dumps(raw, ensure_ascii=False).encode("utf-8")  # half of a surrogate pair is no text
    WRONG.clear()
    version = read(raw["version"], range(1, 4))
    def claim(sign, digits, up):  # from version 2 on rounded to the side that claims more
        return partial(number, sign=sign, rounded=(digits, up) if version > 1 else None)
    coupled, kind = raw["controller"]["phi"] == "coupled-tanh", raw["robot"]["links"]["kind"]
    n = read(raw["robot"]["joints"], range(1, 17 if coupled else 65))
    above, from_zero, side = [positive] * n, [not_negative] * n, {"link", "motor"}
    links = {
        ("planar-two-link", 2): {"mass": [positive] * 2, "length": positive, "com": [number] * 2, "inertia": [positive] * 2},
        ("pendulum", 1): {"mass": not_negative, "com": number, "inertia": not_negative},
        ("tree", n): {"bodies": [partial(read_body, k) for k in range(n)]}}[kind, n]
    shapes = [type(None) if body["parent"] is None else [number] * (21 if body["kind"] == "prismatic" else 7)
              for body in raw["robot"]["links"].get("bodies", [])]
    forms = {} if version == 1 else {"forms": shapes if kind == "tree" else type(None)}
    gains = {"metric": above, "shaping": above, "damping": above, "kappa": above if coupled else type(None)}
    motor = gains | ({"hardening": type(None)} if version > 2 else {})
    gains = gains | ({"hardening": type(None) if coupled else (from_zero,)} if version > 2 else {})
    rate, margin = claim("> 0", 13, True), partial(number, sign="> 0" if version > 1 else ">= 0", rounded=(1, True))
    rates, margins = ({"contraction": kind, "convergence": kind} for kind in (rate, margin))
    witness = {"side": side, "error": [number] * n, "row": range(n), "column": range(n), "difference": claim("> 0", 1, True)}
    about = {"subject": ({"robot": digest, "scenario": digest},)} if version > 1 else {}
    about |= {"stretched": ({"velocity_error": from_zero * 2, "exponent": [(positive,)] * 2 * n, "rate": claim("> 0", 9, True)},)} if version > 2 else {}
    file = read(raw, about | {
        "format": {"flexure-certificate"}, "version": range(1, 4), "name": str, "made_by": str, "assumptions": [str, ...],
        "robot": {"name": str, "joints": int, "stiffness": above, "motor_inertia": above, "link_damping": from_zero,
                  "motor_damping": from_zero, "links": {"kind": str} | links},
        "controller": {"phi": {"tanh", "linear", "coupled-tanh"}, "link": gains, "motor": motor},
        "region": {"error": [(positive,)] * 2 * n, "level": (claim("> 0", 9, True),)}, "contraction_rate": (positive,) if version > 2 else positive,
        "closed_loop": {"rows": [[str] * 4] * 4, "dissipation": [str] * 4}, "convergence_rate": positive,
        "blocks": [{"block": str, "cases": [{"case": str} | margins, ...]} | rates, ...],
        "mass_matrix": {"margins": [partial(number, sign="> 0", rounded=(1, True)), ...]} | forms,
        "measures": [{"side": side, "norm": str, "bound": claim(None, 9, False)}, ...],
        "structure": [{"name": str, "holds": bool, "witness": (witness,)}, ...],
        "tube": ({"disturbance": from_zero, "level": partial(both, claim(">= 0", 9, False), claim(">= 0", 9, True)), "error": [claim(">= 0", 9, False)] * 2 * n},)})
    need(not WRONG, "; ".join(WRONG[:3]))
    return file

def by_name(entries, wanted, *keys):  # the entries by name: exactly the wanted ones, each once
    names = ["/".join(entry[key] for key in keys) for entry in entries]
    need(sorted(names) == sorted(wanted), f"there are {names}, must be {wanted}"[:300])
    return dict(zip(names, entries))

# ---- closed_loop: words of letters that do not commute
ROWS = [["-Fl", "0", "1", "0"], ["0", "-Fm", "-Pm^-1 K", "1"], ["-Pl", "K", "-S + 1/2 R - Bl", "0"], ["0", "-Pm", "0", "-Bm"]]
LOSSES = ["Pl Fl", "Pm Fm", "Bl", "Bm"]
def terms(front, text):  # `front` times a sum of products, as pairs of a factor and a tuple of letters
    for term in re.sub(r"(?<!\^)-", "+ -1 ", text).strip("+").split("+"):
        factors = [Fraction(token) for token in term.split() if not token[0].isalpha()]
        letters = " ".join([front, *term.split()[len(factors):]]).replace("Pm Pm^-1", "")
        yield prod(factors), tuple(letters.split())
def check_closed_loop(claimed):
    need(claimed == {"rows": ROWS, "dissipation": LOSSES}, "closed_loop: not that of the law")
    entries = [(i, j, ["Pl", "Pm", "", ""][i], ROWS[i][j]) for i, j in product(range(4), repeat=2)]
    entries += [(2, 2, "", "-1/2 R"), *((i, i, "", loss) for i, loss in enumerate(LOSSES))]
    left = {}
    for i, j, front, text in entries:
        for factor, word in terms(front, text):
            back = tuple({"Fl": "Fl'", "Fm": "Fm'"}.get(letter, letter) for letter in reversed(word))
            left[i, j, word] = left.get((i, j, word), 0) + factor
            left[j, i, back] = left.get((j, i, back), 0) + factor * (-1) ** word.count("S")
    need(not any(left.values()), "closed_loop: G + G' is not what is lost")

# ---- Position blocks: slopes and chords of tanh, both decreasing in the error
def slope(x):
    return (2 / (iv.exp(x) + iv.exp(-x))) ** 2
RATES = {"contraction": slope, "convergence": lambda x: (1 - 2 / (iv.exp(2 * x) + 1)) / x}

class Side:  # the law of one side: its slope has the entries factor[i][j] * a_j, on the diagonal with a_j for tanh only
    def __init__(self, file, name):
        n, self.phi, law = file["robot"]["joints"], file["controller"]["phi"], file["controller"][name]
        self.joints, self.metric, self.shaping, self.damping, kappa = range(n), *[law[key] for key in ("metric", "shaping", "damping", "kappa")]
        self.hardening = law.get("hardening") or [ZERO] * n
        self.bounds = file["region"]["error"][slice(n) if name == "link" else slice(n, None)]
        self.low = {rate: [ZERO if r is None else max(f(r.b).a, ZERO) for r in self.bounds] for rate, f in RATES.items()}
        self.factor = diagonal([1 + k for k in kappa] if kappa else self.shaping)
        for i, j in permutations(self.joints if kappa else [], 2):
            self.factor[i][j] = root(self.shaping[j] / self.shaping[i]) / (n - 1)
        letters = {"tanh": "L", "coupled-tanh": "LH" if n > 1 else [""], "linear": [""]}[self.phi]
        self.cases = ["".join(word) for word in product(letters, repeat=n)]
    def slope(self, i, j, a):
        return self.factor[i][j] * a if i != j or self.phi == "tanh" else self.factor[i][j]
    def matrix(self, case, rate, beta):  # sym(metric * slope) - beta * metric at a vertex of the box of slopes, or of chords
        a = [low if letter == "L" else ONE for low, letter in zip(self.low[rate], case.ljust(len(self.metric)))]
        x = [[p * (self.slope(i, j, a[j]) - (beta if i == j else 0)) for j in self.joints] for i, p in enumerate(self.metric)]
        return [[(x[i][j] + x[j][i]) / 2 if i != j else x[i][i] for j in self.joints] for i in self.joints]
    def measures(self):  # upper bounds of the matrix measures for norm 1 (of columns) and inf (of rows)
        a, p = [span(low, ONE) for low in self.low["contraction"]], [root(metric) for metric in self.metric]
        rows = [[self.slope(i, j, a[j]) * (p[i] / p[j] if i != j else 1) for j in self.joints] for i in self.joints]
        return {norm: max((sum(line[:k]) + sum(line[k + 1:]) - line[k]).b for k, line in enumerate(lines))
                for norm, lines in (("1", list(zip(*rows))), ("inf", rows))}

# ---- The mass matrix, and the momentum blocks
def dot(a, b):
    return sum(x * y for x, y in zip(a, b))
def cross(a, b):
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]
def norm(a):
    return root(sum(x**2 for x in a))
def across(x, e):
    return [p - dot(x, e) * q for p, q in zip(x, e)]
def nearest(rows):  # contains the nearest unit vector (one row) or rotation: the distance is at most |R R' - 1|
    defect = norm([dot(x, y) - (x is y) for x, y in product(rows, repeat=2)]).b
    need(defect < 1e-6 and (len(rows) == 1 or dot(cross(*rows[:2]), rows[2]) > 0), "bodies: an axis or rotation is none")
    return [[x + span(-defect, defect) for x in row] for row in rows]

class Body:
    def __init__(self, body):
        self.parent, self.slides, (low, high) = body["parent"], body["kind"] == "prismatic", body["travel"] or (number("0"),) * 2
        need(low.high <= high.low, "bodies: a travel is the wrong way round")
        self.axis, self.o, self.c, self.mass = nearest([body["axis"]])[0], body["translation"], body["com"], body["mass"]
        self.rotation, self.ends, self.travel = nearest(body["rotation"]), (low, high), span(low, high)
        self.z = [dot(row, self.axis) for row in self.rotation]
        self.inertia = [[body["inertia"][k] for k in row] for row in ((0, 1, 2), (1, 3, 4), (2, 4, 5))]
        self.turned = [dot(row, self.axis) for row in self.inertia]
        self.spread = min(norm(sum(self.inertia, [])).b, max(sum(map(abs, row)).b for row in self.inertia))
    def own_inertia(self):
        kept = [i for i in range(3) if any(x != 0 for x in self.inertia[i])]  # thin rods have two, points none
        need(smallest_pivot([[self.inertia[i][j] for j in kept] for i in kept]) > 0, "mass_matrix: an inertia is not >= 0")
        return (self.mass if self.slides else dot(self.axis, self.turned) + self.mass * norm(cross(self.axis, self.c)) ** 2).a
    def slide(self, along, rho, r):
        return along + self.travel, rho, (r + abs(self.travel)).b
    def to(self, parent, along, rho, r):  # where a centre of mass can be for the parent: along its axis, from it, from its origin
        o, z, e, ends = self.o, self.z, parent.axis, (along.a, along.b)
        c, s, out, turned = dot(z, e), norm(cross(e, z)), across(o, e), across(z, e)
        square = norm(o) ** 2 + r**2 + 2 * max((x * dot(o, z)).b for x in ends) + 2 * rho * norm(across(o, z))
        far = min((norm(o) + r).b, root(square).b)
        axial = dot(o, e) + along * c + rho * span(-s, s)
        off = [far, (rho + max(norm([p + x * q for p, q in zip(out, turned)]).b for x in ends)).b]
        if s**2 > 1e-6:
            inward = max(abs(dot(o, turned) / s + x * s).b for x in ends) + abs(c) * rho
            off.append(root((abs(dot(o, cross(e, z))) / s + rho) ** 2 + inward**2).b)
        return parent.slide(span(max(axial.a, -far), min(axial.b, far)), min(off), far)

def mass_bound(bodies):
    bound = diagonal([ZERO] * len(bodies))
    for k, body in enumerate(bodies):
        j, reach = k, {k: body.slide(dot(body.c, body.axis), norm(across(body.c, body.axis)).b, norm(body.c).b)}
        while (i := bodies[j].parent) is not None:
            j, reach[i] = i, bodies[j].to(bodies[i], *reach[j])
        for j, i in combinations_with_replacement(reach, 2):  # from the body to the base: i is j or before it
            linear = prod(ONE if bodies[x].slides else reach[x][1] for x in (i, j))
            angular = dot(body.axis, body.turned) if i == k else norm(body.turned) if j == k else body.spread
            turning = not bodies[i].slides and not bodies[j].slides
            if turning and bodies[j].parent == i:
                g = (1 + abs(dot(bodies[i].axis, bodies[j].z))) / 2
                linear = min(linear.b, (g * reach[j][2] ** 2 + norm(cross(bodies[i].axis, bodies[j].o)) * reach[j][1]).b)
                angular = min(angular.b, (g * body.spread).b)
            bound[i][j] = bound[j][i] = (bound[i][j] + body.mass * linear + (angular if turning else 0)).b
    return bound

def times(*factors):
    return reduce(lambda a, b: [[dot(row, column) for column in zip(*b)] for row in a], factors)
def plus(a, b, factor=ONE):
    return [[x + factor * y for x, y in zip(*rows)] for rows in zip(a, b)]
def flipped(a):
    return [list(column) for column in zip(*a)]
def turning(v):  # v x
    return [[ZERO, -v[2], v[1]], [v[2], ZERO, -v[0]], [-v[1], v[0], ZERO]]
def four(a, b, c, d):
    return [x + y for x, y in [*zip(a, b), *zip(c, d)]]
def moved(rotation, offset):  # velocities, angular first, in a frame that stands so in another
    back = flipped(rotation)
    return four(back, NOTHING, plus(NOTHING, times(back, turning(offset)), -ONE), back)
NOTHING, UNIT = diagonal([ZERO] * 3), diagonal([ONE] * 3)
def inertia_of(body):  # twice the kinetic energy, as a form of the velocity
    c, mass = turning(body.c), diagonal([body.mass] * 3)
    moment = times(mass, c)
    return four(plus(body.inertia, times(moment, flipped(c))), moment, flipped(moment), mass)
def form_of(body, y):
    if body.slides:
        return [[y[max(i, j) * (max(i, j) + 1) // 2 + min(i, j)] for j in range(6)] for i in range(6)]
    along = [[p * q if p is not q else p**2 for q in body.axis] for p in body.axis]
    angular, linear, mixed = (plus(plus(NOTHING, plus(UNIT, along, -ONE), p), along, q) for p, q in (y[:2], y[2:4], y[4:6]))
    mixed = plus(mixed, turning(body.axis), y[6])
    return four(angular, mixed, flipped(mixed), linear)
def chain_matrix(bodies, forms, damping, k, travelled, rate, beta):
    body, carried = bodies[k], [[ZERO] * 6] * 6
    for child, form in zip(bodies, forms):
        if child.parent == k:
            placed = moved(child.rotation, child.o)
            carried = plus(carried, times(flipped(placed), form_of(child, form), placed))
    carried, rest = plus(carried, inertia_of(body), beta), [ZERO] * 3
    own = [[x] for x in (rest + body.axis if body.slides else body.axis + rest)]
    if body.parent is None:
        return [[damping[k] - times(flipped(own), carried, own)[0][0]]]
    lift = [p + q for p, q in zip(moved(UNIT, [travelled * x for x in body.axis]), own)]
    bound = [row + [ZERO] for row in form_of(body, forms[k])] + [[ZERO] * 6 + [damping[k]]]
    return plus(bound, times(flipped(lift), carried, lift), -ONE)
def chain(bodies, forms, damping):  # what shows that damping - beta * mass matrix is positive definite, by case
    cases = {}
    for k, body in enumerate(bodies):
        halves = [("", ZERO)] if forms[k] is None or not body.slides else zip("LH", body.ends)
        cases |= {f"{k}{letter}": partial(chain_matrix, bodies, forms, damping, k, end) for letter, end in halves}
    return cases

def mass_matrices(links):  # by case, with lower bounds of the pivots of the mass matrix
    if links["kind"] == "pendulum":
        mass = links["inertia"] + links["mass"] * links["com"] ** 2
        return {"": [[mass]]}, [mass.a]
    (m1, m2), (r1, r2), (i1, i2), l1 = links["mass"], links["com"], links["inertia"], links["length"]
    a1, a2, b = m1 * r1**2 + m2 * l1**2 + i1, m2 * r2**2 + i2, m2 * l1 * r2
    cases = {case: [[a1 + a2 + 2 * b * c, a2 + b * c], [a2 + b * c, a2]] for case, c in (("L", -1), ("H", 1))}
    return cases, [smallest_pivot(matrix) for matrix in cases.values()]
def momentum_matrix(damping, mass, rate, beta):
    return [[(damping[i] if i == j else 0) - beta * m for j, m in enumerate(row)] for i, row in enumerate(mass)]
def momentum_cases(file, damping):  # of both sides, by case a function of which rate and the rate; pivots of the mass matrix
    links, forms = file["robot"]["links"], file["mass_matrix"].get("forms")
    def of(side, masses):
        return {case: partial(momentum_matrix, damping[side], mass) for case, mass in masses.items()}
    motors = of("motor", {"": diagonal(file["robot"]["motor_inertia"])})
    if links["kind"] != "tree":
        masses, pivots = mass_matrices(links)
        return {"link": of("link", masses), "motor": motors}, pivots
    bodies = [Body(body) for body in links["bodies"]]
    cases = chain(bodies, forms, damping["link"]) if forms else of("link", {"": mass_bound(bodies)})
    return {"link": cases, "motor": motors}, [body.own_inertia() for body in bodies]

# ---- The claims
def check_block(block, cases):  # by case, a function of which rate and the rate: a matrix with pivots of at least the margin
    for case, margins in by_name(block["cases"], [*cases], "case").items():
        for rate in RATES:
            pivot = smallest_pivot(cases[case](rate, block[rate].claimed))
            need(margins[rate].claimed <= pivot, f"{block['block']}: case '{case}', {rate}: pivot {float(pivot):.6g} at that rate")
def check_blocks(file, blocks, sides, momenta):
    for name, side in sides.items():
        phi, sigma = blocks["phi_" + name[0]], blocks["sigma_" + name[0]]
        check_block(phi, {case: partial(side.matrix, case) for case in side.cases})
        check_block(sigma, momenta[name])
        need(sigma["contraction"].exact == sigma["convergence"].exact, f"{sigma['block']}: the rates differ")
    hardens = file["controller"]["link"].get("hardening") is not None
    need((file["contraction_rate"] is None) == hardens, "contraction_rate: null where, and only where, the metric hardens")
    for block, rate in product(blocks.values(), [*RATES][hardens:]):
        need(file[rate + "_rate"].high <= block[rate].low, f"{rate}_rate: more than that of {block['block']}")
def check_measures(file, blocks, sides):
    own = {f"{name}/{norm}": bound for name, side in sides.items() for norm, bound in side.measures().items()}
    for name, claim in by_name(file["measures"], [*own, "link/2", "motor/2"], "side", "norm").items():
        bound, rate = claim["bound"], blocks["phi_" + claim["side"][0]]["contraction"]
        need(own[name] <= bound.claimed if name in own else -rate.low <= bound.low, f"measures: {name} is more than claimed")

def check_structure(file, sides):
    if file["contraction_rate"] is None:
        return need(file["structure"] == [], "structure: nothing is claimed where the metric depends on the error")
    phi = file["controller"]["phi"]
    equal = all(p.exact == q.exact for side in sides.values() for p, q in zip(side.metric, side.shaping))
    truth = {"variational-ph": phi != "coupled-tanh" or file["robot"]["joints"] == 1, "ph-like": phi == "linear" and equal,
             "strict-differential-passivity": True, "incremental-passivity": True}
    for name, entry in by_name(file["structure"], [*truth], "name").items():
        need(entry["holds"] == truth[name] == (entry["witness"] is None), f"structure: {name}: wrong, or without its witness")
        need(truth[name] or is_witness(name, sides, *entry["witness"].values()), f"structure: {name}: that witness shows nothing")
def is_witness(name, sides, side, errors, i, j, difference):
    law, p = sides[side], sides[side].metric
    inside = all(r is None or -r.low <= e.low and e.high <= r.low for e, r in zip(errors, law.bounds))
    entry, mirrored = law.slope(i, j, slope(errors[j])), law.slope(j, i, slope(errors[i]))
    off = entry - (p[i] if i == j else 0) if name == "ph-like" else entry / p[j] - mirrored / p[i]
    return inside and abs(off) >= difference.claimed
def check_tube(tube, file, blocks, metric):
    level, region = tube["level"], file["region"]["level"]
    strength = sum(d**2 / m for d, m in zip(tube["disturbance"], file["robot"]["motor_inertia"]))
    b, rest = blocks["sigma_m"]["convergence"], [blocks[name]["convergence"] for name in ("phi_l", "phi_m", "sigma_l")]
    beta = span(min(x.a for x in rest), min(x.b for x in rest))
    fast, slow = strength / (8 * beta * (b - beta)), strength / (2 * b**2)
    need(all(level.claimed >= x for x in {True: [fast], False: [slow], None: [fast, slow]}[b >= 2 * beta]), "tube: the level is too low")
    need(region is None or level.high <= region.low, "tube: the level is more than the region's")
    need(all(p * e.claimed**2 >= 2 * level.reached for p, e in zip(metric, tube["error"])), "tube: an error is too small")

def stretched_rest(side, i, b, drift, beta):  # own rate less beta while it drifts outwards, and (P - metric)^2 / P, for errors in the region
    def lost(chord):  # of the rate that the metric has without its growth, where phi is at least the chord times the error
        return (root(chord**2 + side.hardening[i] / side.metric[i] * drift**2) - chord) / 2 if side.hardening[i] != 0 else ZERO
    if side.phi == "linear":
        rate = side.shaping[i] - lost(side.shaping[i]) - beta
        need(b is None and rate > 0, "stretched: a position error alone contracts more slowly, or is stretched")
        return rate, ZERO
    need(side.bounds[i] is not None, "stretched: errors have no bound")
    error = iv.mpf(side.bounds[i].b)
    flat, tanh, square, growth = slope(error), 1 - 2 / (iv.exp(2 * error) + 1), ONE, ZERO
    need(b is None or b > flat or b <= flat, "stretched: an exponent is too close to sech^2 of the largest error")
    if b is not None and b > flat:
        square = iv.exp(b * iv.log(tanh**2 / flat * b / (1 - b))) * (1 - b) / tanh**2
        growth = (b - flat) / tanh
    rate = side.shaping[i] * (flat + growth * tanh) - growth * drift - lost(side.shaping[i] * tanh / error) - beta
    need(rate > 0, "stretched: a position error alone contracts more slowly")
    ratio = root(square)  # of the largest r and the least; P is the metric times r^2 / (largest times least)
    return rate, (side.metric[i] + side.hardening[i] * error**2) * (ratio - 1) ** 2 / ratio
def check_stretched(claim, file, blocks, sides, damping):
    (link, motor), n, beta, links = sides.values(), file["robot"]["joints"], claim["rate"].claimed, file["robot"]["links"]
    need(link.phi != "coupled-tanh", "stretched: is for tanh or linear")
    need(all(b is None or b < 1 for b in claim["exponent"]), "stretched: an exponent is not < 1")
    left = []
    for i in range(n):
        speed, b = claim["velocity_error"][i::n], claim["exponent"][i::n]
        coupling = file["robot"]["stiffness"][i] / motor.metric[i]
        rate, mismatch = stretched_rest(link, i, b[0], speed[0], beta)
        fast, other = stretched_rest(motor, i, b[1], speed[1] + coupling * speed[0], beta)
        spare = damping["motor"][i] - beta * file["robot"]["motor_inertia"][i]
        need(spare > 0 and fast - other / (4 * spare) > 0, "stretched: a motor does not reach the rate")
        left.append(damping["link"][i] - mismatch / (4 * rate) - coupling**2 * other / (4 * (fast - other / (4 * spare))))
    if links["kind"] == "tree":
        masses = [diagonal([d / blocks["sigma_l"]["contraction"] for d in damping["link"]])]
    else:
        masses = mass_matrices(links)[0].values()
    need(all(smallest_pivot(momentum_matrix(left, mass, None, beta)) > 0 for mass in masses), "stretched: the damping does not bear it")

def check(data):  # the rates that are proved, and what the loop's files hash to
    file = read_file(data)
    check_closed_loop(file["closed_loop"])
    sides = {name: Side(file, name) for name in ("link", "motor")}
    metric, errors, level = sides["link"].metric + sides["motor"].metric, *file["region"].values()
    bounded = all(bound and level and 2 * level.claimed <= p * bound**2 for bound, p in zip(errors, metric))
    need(bounded or {*errors, level} == {None}, "region: W <= level leaves it, or some are null and some are not")
    damping = {name: [d + k for d, k in zip(file["robot"][name + "_damping"], side.damping)] for name, side in sides.items()}
    momenta, pivots = momentum_cases(file, damping)
    margins = file["mass_matrix"]["margins"]
    need(len(margins) == len(pivots) and all(m.claimed <= p for m, p in zip(margins, pivots)), "mass_matrix: a margin is not reached")
    blocks = by_name(file["blocks"], ["phi_l", "phi_m", "sigma_l", "sigma_m"], "block")
    check_blocks(file, blocks, sides, momenta)
    check_measures(file, blocks, sides)
    check_structure(file, sides)
    if file["tube"]:
        check_tube(file["tube"], file, blocks, metric)
    if file.get("stretched"):
        check_stretched(file["stretched"], file, blocks, sides, damping)
    rates = {rate: file[rate + "_rate"] for rate in RATES}
    return {rate: float(claim.low) for rate, claim in rates.items() if claim}, file.get("subject") or {}

def main(paths):
    worst = 0 if paths else 2
    for path in paths:
        code, start = 0, time.perf_counter()
        try:
            rates, subject = check(open(path, "rb").read())
            said = "proved: " + ", ".join(f"{name} {rate:.10g} 1/s" for name, rate in rates.items())
            said += "".join(f", {key} {hash}" for key, hash in subject.items())
        except AssertionError as error:
            code, said = 1, f"does not hold: {error}"
        except Exception as error:
            code, said = 2, f"not a certificate: {error!r:.300}"
        print(f"{path}: {said}, checked in {1e3 * (time.perf_counter() - start):.1f} ms")
        worst = max(worst, code)
    return worst

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
