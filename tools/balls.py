"""What the checkers of tubes and of funnels share, with python-flint alone: their command line, functions with their first two derivatives, Taylor series in time, robots, the law, references, and the
parts of files that tell a loop.

Numbers are balls of 128 bits that contain what they stand for; a comparison of two is true only where it holds for all reals inside."""
import argparse, base64, json, re, struct, sys, time
from fractions import Fraction
from functools import partial
from flint import arb, arb_mat, ctx, fmpq

ctx.prec = 128
sys.setrecursionlimit(10000)  # series ask each other
ZERO, ONE, HALF, UNIT = arb(0), arb(1), arb(0.5), arb(0, 1)  # UNIT is [-1, 1]
DECIMAL = re.compile(r"(?!.{101})-?(0|[1-9]\d*)(\.\d+)?([eE][+-]?\d{1,3})?", re.ASCII)

class Unknown(Exception):  # a loop that this program does not know
    pass
def need(holds, claim, error=AssertionError):  # a ValueError where it is no file of a tube
    if holds is not True:
        raise error(claim)
def known(holds, what):
    need(holds, f"this checker does not know {what}", Unknown)

# ---- Functions of y: value and slopes at 0, second derivatives over the domain
class Domain:  # of y: the first `ball` numbers are in the unit ball, each of the others in [-1, 1]
    def __init__(self, ball, size):
        self.ball, self.size = ball, size
        self.all = arb_mat(size, 1, [UNIT] * size)
        self.others = arb_mat(size, 1, [ZERO] * ball + [UNIT] * (size - ball))
        self.round = arb_mat(size, size, [int(i == j < ball) for i in range(size) for j in range(size)])
        self.flat = arb_mat(size, size)
    def along(self, value, slopes):  # a linear function
        return Form(self, value, arb_mat(1, self.size, slopes), self.flat)

class Sums:
    def __sub__(self, other):
        return self + -other
    def __rsub__(self, other):
        return -self + other
    def __neg__(self):
        return self * -1
    def __radd__(self, other):
        return self + other
    def __rmul__(self, other):
        return self * other
    def __truediv__(self, other):  # by a number
        return self * (1 / arb(other))

class Form(Sums):
    __slots__ = ("on", "c", "g", "h", "_radius", "_slope")
    def __init__(self, on, c, g, h):
        self.on, self.c, self.g, self.h, self._radius, self._slope = on, c, g, h, None, None
    def radius(self):  # how far values are from that at 0
        if self._radius is None:
            reach = (self.g * self.on.others)[0, 0].abs_upper() + HALF * (self.on.all.transpose() * (self.h * self.on.all))[0, 0].abs_upper()
            if self.on.ball:
                reach += (self.g * self.on.round * self.g.transpose())[0, 0].abs_upper().sqrt()
            self._radius = reach.abs_upper()
        return self._radius
    def range(self):
        return self.c + UNIT * self.radius()
    def slope(self):  # anywhere
        if self._slope is None:
            self._slope = self.g + (self.h * self.on.all).transpose()
        return self._slope
    def through(self, value, first, first_anywhere, second_anywhere):  # f of it, from f and f' at its value, f' and f'' on its range
        bent = self.slope().transpose() * self.slope() * second_anywhere
        return Form(self.on, value, self.g * first, self.h * first_anywhere + bent)
    def union(self, other):  # what contains both
        other = other if isinstance(other, Form) else self * 0 + other
        entries = [arb_mat(a.nrows(), a.ncols(), [x.union(y) for x, y in zip(a.entries(), b.entries())]) for a, b in ((self.g, other.g), (self.h, other.h))]
        return Form(self.on, self.c.union(other.c), *entries)
    def __add__(self, other):
        if isinstance(other, Form):
            return Form(self.on, self.c + other.c, self.g + other.g, self.h + other.h)
        return NotImplemented if isinstance(other, Dual) else Form(self.on, self.c + other, self.g, self.h)
    def __mul__(self, other):
        if isinstance(other, Dual):
            return NotImplemented
        if not isinstance(other, Form):
            return Form(self.on, self.c * other, self.g * other, self.h * other)
        a, b, cross = self.range(), other.range(), self.slope().transpose() * other.slope()
        return Form(self.on, self.c * other.c, self.g * other.c + other.g * self.c, self.h * b + other.h * a + cross + cross.transpose())
    def inverse(self):
        c, r = 1 / self.c, 1 / self.range()
        return self.through(c, -c * c, -r * r, 2 * r * r * r)
    def sin_cos(self):
        (s, c), (sr, cr) = self.c.sin_cos(), self.range().sin_cos()
        return self.through(s, c, cr, -sr), self.through(c, -s, -sr, -cr)
    def tanh(self):
        c, r = self.c.tanh(), self.range().tanh()
        return self.through(c, 1 - c * c, 1 - r * r, -2 * r * (1 - r * r))
def inverse(x):
    return 1 / x if isinstance(x, arb) else x.inverse()

class Dual(Sums):  # a number or function and its derivative in some direction
    def __init__(self, c, d):
        self.c, self.d = c, d
    def __add__(self, other):
        return Dual(self.c + other.c, self.d + other.d) if isinstance(other, Dual) else Dual(self.c + other, self.d)
    def __mul__(self, other):
        return Dual(self.c * other.c, self.c * other.d + self.d * other.c) if isinstance(other, Dual) else Dual(self.c * other, self.d * other)
    def inverse(self):
        x = inverse(self.c)
        return Dual(x, -(x * x * self.d))
    def sin_cos(self):
        s, c = self.c.sin_cos()
        return Dual(s, c * self.d), Dual(c, -(s * self.d))
    def tanh(self):
        t = self.c.tanh()
        return Dual(t, (1 - t * t) * self.d)

# ---- Taylor series in time, each coefficient computed once, when it is asked for. The number 0 stands for what vanishes
class Series(Sums):
    def __init__(self, rule, start=()):
        self.known, self.rule = list(start), rule
    def __getitem__(self, k):
        while len(self.known) <= k:
            self.known.append(self.rule(len(self.known)))
        return self.known[k]
    def __add__(self, other):
        if isinstance(other, Series):
            return Series(lambda k: self[k] + other[k])
        return self if is_zero(other) else Series(lambda k: self[k] + other if k == 0 else self[k])
    def __mul__(self, other):
        if isinstance(other, Series):
            return Series(lambda k: total(self[i] * other[k - i] for i in range(k + 1)))
        return 0 if is_zero(other) else Series(lambda k: self[k] * other)
    def inverse(self):
        first = Series(None, [inverse(self[0])])
        first.rule = lambda k: -total(self[i] * first[k - i] for i in range(1, k + 1)) * first[0]
        return first
    def sin_cos(self):
        s, c = (Series(None, [x]) for x in self[0].sin_cos())
        s.rule, c.rule = self.follows(c), self.follows(-s)
        return s, c
    def tanh(self):
        y = Series(None, [self[0].tanh()])
        y.rule = self.follows(1 - y * y)
        return y
    def follows(self, slope):  # of a function of this, with that slope
        return lambda k: total(self[i] * slope[k - i] * i for i in range(1, k + 1)) / k
    def rate(self):
        return Series(lambda k: self[k + 1] * (k + 1))
def total(terms):
    terms = iter(terms)
    return sum(terms, next(terms))
def is_zero(x):
    return isinstance(x, (int, arb)) and x == 0
def constant(x):
    return Series(lambda k: ZERO, [x])
def series(x):
    return x if isinstance(x, Series) else constant(arb(x))

def solve(matrix, right):  # a symmetric positive definite matrix, by elimination
    a, x, n, pivots = [list(row) for row in matrix], list(right), len(right), []
    for k in range(n):
        pivots.append(a[k][k].inverse())
        for i in range(k + 1, n):
            part = a[i][k] * pivots[k]
            a[i], x[i] = [a[i][j] - part * a[k][j] if j > k else 0 for j in range(n)], x[i] - part * x[k]
    for k in reversed(range(n)):
        x[k] = (x[k] - sum(a[k][j] * x[j] for j in range(k + 1, n))) * pivots[k]
    return x

# ---- Links: `matrix` is M(q), `load` is M a_r + C(q, v) v_r + gravity with the C of Christoffel
class TwoLink:
    def __init__(self, links):
        (m1, m2), (r1, r2), (i1, i2), l1 = (links[key] for key in ("mass", "com", "inertia", "length"))
        self.a1, self.a2, self.b = m1 * r1 * r1 + m2 * l1 * l1 + i1, m2 * r2 * r2 + i2, m2 * l1 * r2
    def at(self, q):
        return [x * self.b for x in q[1].sin_cos()]
    def matrix(self, at):
        return [[series(x) for x in row] for row in ((at[1] * 2 + (self.a1 + self.a2), at[1] + self.a2), (at[1] + self.a2, self.a2))]
    def load(self, at, v, v_r, a_r, falls=True):
        (s, _), m = at, self.matrix(at)
        turning = [-(s * (v[1] * v_r[0] + (v[0] + v[1]) * v_r[1])), s * (v[0] * v_r[0])]
        return [sum(m[i][j] * a_r[j] for j in range(2)) + turning[i] for i in range(2)]

def dot(a, b):
    return sum(x * y for x, y in zip(a, b))
def cross(a, b):
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]
def plus(*vectors):
    return [sum(x) for x in zip(*vectors)]
def scaled(a, by):
    return [x * by for x in a]
def applied(rows, x):
    return [dot(row, x) for row in rows]
def flipped(rows):
    return [list(column) for column in zip(*rows)]
def nearest(rows):  # contains the nearest unit vector (one row) or rotation: the distance is at most |R R' - 1|
    defect = length_of([dot(x, y) - (x is y) for x in rows for y in rows])
    need(defect < 1e-6 and (len(rows) == 1 or dot(cross(*rows[:2]), rows[2]) > 0), "bodies: an axis or rotation is none")
    return [[thin(x + UNIT * defect) for x in row] for row in rows]
def thin(x):  # sums and products with the number 0 are left out
    return 0 if x == 0 else x

# Velocities and accelerations (angular, of the frame's origin), and forces (moment about the origin, force), in the body's frame
def both(*pairs):
    return tuple(plus(*parts) for parts in zip(*pairs))
def moved(a, b):  # a x b of velocities
    return cross(a[0], b[0]), plus(cross(a[0], b[1]), cross(a[1], b[0]))
def pressed(a, f):  # a x* f of a velocity and a force
    return plus(cross(a[0], f[0]), cross(a[1], f[1])), cross(a[0], f[1])
class Tree:
    def __init__(self, links, gravity):
        self.bodies, self.base, self.rest = links["bodies"], ([0] * 3, [thin(-x) for x in gravity]), ([0] * 3, [0] * 3)
        for body in self.bodies:
            known(body["kind"] == "revolute", "prismatic joints")
            body["e"], body["R"] = nearest([body["axis"]])[0], nearest(body["rotation"])
            body["o"], body["c"], moments = ([thin(x) for x in body[key]] for key in ("translation", "com", "inertia"))
            body["I"] = [[moments[k] for k in row] for row in ((0, 1, 2), (1, 3, 4), (2, 4, 5))]
    def at(self, q):  # rotations into the parents' frames
        found = []
        for body, angle in zip(self.bodies, q):
            s, c = angle.sin_cos()
            turn = flipped([cross(body["e"], unit) for unit in ([1, 0, 0], [0, 1, 0], [0, 0, 1])])
            turned = [[(i == j) + s * turn[i][j] + (1 - c) * dot(turn[i], column) for j, column in enumerate(flipped(turn))] for i in range(3)]
            found.append([[dot(row, column) for column in flipped(turned)] for row in body["R"]])
        return found
    def carried(self, k, at, all, base):  # the velocity of body k from that of its parent, its joint at rest
        body, back = self.bodies[k], flipped(at[k])
        w, x = base if body["parent"] is None else all[body["parent"]]
        return applied(back, w), applied(back, plus(x, cross(w, body["o"])))
    def momentum(self, k, velocity):
        body, (w, x) = self.bodies[k], velocity
        p = scaled(plus(x, cross(w, body["c"])), body["mass"])
        return plus(applied(body["I"], w), cross(body["c"], p)), p
    def gathered(self, at, forces):  # torques about the axes
        for k, body in reversed([*enumerate(self.bodies)]):
            if body["parent"] is not None:
                n, f = applied(at[k], forces[k][0]), applied(at[k], forces[k][1])
                forces[body["parent"]] = both(forces[body["parent"]], (plus(n, cross(body["o"], f)), f))
        return [dot(body["e"], n) for body, (n, _) in zip(self.bodies, forces)]
    def matrix(self, at):
        n, columns = len(self.bodies), []
        for j in range(n):
            moves = []
            for k, body in enumerate(self.bodies):
                moves.append(both(self.carried(k, at, moves, self.rest), (scaled(body["e"], int(k == j)), [0] * 3)))
            column = self.gathered(at, [self.momentum(k, move) for k, move in enumerate(moves)])
            columns.append([series(x) for x in column])
        return [[columns[max(i, j)][min(i, j)] for j in range(n)] for i in range(n)]
    def load(self, at, v, v_r, a_r, falls=True):  # the modified pass of Newton and Euler: with v_r = v it is the usual one
        moves, asked, speeding, forces, base = [], [], [], [], self.base if falls else self.rest
        for k, body in enumerate(self.bodies):
            own, own_r, own_a = ((scaled(body["e"], x[k]), [0] * 3) for x in (v, v_r, a_r))
            move, move_r = both(self.carried(k, at, moves, self.rest), own), both(self.carried(k, at, asked, self.rest), own_r)
            speed = both(self.carried(k, at, speeding, base), own_a, moved(move, own_r))
            moves.append(move), asked.append(move_r), speeding.append(speed)
            turning = both(pressed(move, self.momentum(k, move_r)), self.momentum(k, moved(move_r, move)), pressed(move_r, self.momentum(k, move)))
            forces.append(both(self.momentum(k, speed), tuple(scaled(part, HALF) for part in turning)))
        return self.gathered(at, forces)

# ---- The robot, the law and the reference
class Robot:
    def __init__(self, raw, gravity):
        self.n, links = raw["joints"], raw["links"]
        self.links = TwoLink(links) if links["kind"] == "planar-two-link" else Tree(links, gravity)
        self.K, self.D_l, self.D_m, self.M_m = (raw[key] for key in ("stiffness", "link_damping", "motor_damping", "motor_inertia"))
    def motion(self, x, torques):  # Taylor series of one from x; without torques, motors have no acceleration
        n, a_l, a_m = self.n, [], []
        q_l, q_m, v_l, v_m = parts = [[], [], [], []]
        for j, rates in enumerate((v_l, v_m, a_l, a_m)):
            parts[j] += [Series(lambda k, i=i, rates=rates: rates[i][k - 1] / k, [x[j * n + i]]) for i in range(n)]
        springs, at = [(q_m[i] - q_l[i]) * self.K[i] for i in range(n)], self.links.at(q_l)
        turning = self.links.load(at, v_l, v_l, [0] * n)
        a_l += solve(self.links.matrix(at), [springs[i] - v_l[i] * self.D_l[i] - turning[i] for i in range(n)])
        if torques:
            a_m += [(constant(torques[i]) - springs[i] - v_m[i] * self.D_m[i]) / self.M_m[i] for i in range(n)]
        return at, springs, parts, [*v_l, *v_m, *a_l, *a_m]

class Law:
    def __init__(self, raw, robot):
        self.robot, self.phi, self.link, self.motor = robot, raw["phi"], raw["link"], raw["motor"]
    def shaped(self, gains, i, e):
        return (e.tanh() if self.phi == "tanh" else e) * gains["shaping"][i]
    def wanted(self, q_d, x):  # at x: q_md, q̃_m and q̇_mr along the motion from there, and the torques, of the Taylor coefficients of the reference
        robot, link, motor, n = self.robot, self.link, self.motor, self.robot.n
        at, springs, (q_l, q_m, v_l, v_m), _ = robot.motion(x, None)
        errors = [q_l[i] - q_d[i] for i in range(n)]
        v_lr = [q_d[i].rate() - self.shaped(link, i, errors[i]) for i in range(n)]
        load, found, hardening = robot.links.load(at, v_l, v_lr, [v.rate() for v in v_lr]), [], link["hardening"] or [ZERO] * n
        for i, e in enumerate(errors):
            s, potential = v_l[i] - v_lr[i], e * link["metric"][i] + e * e * e * (hardening[i] / 3)
            q_md = q_l[i] + (load[i] + v_lr[i] * robot.D_l[i] - potential - s * link["damping"][i]) / robot.K[i]
            e_m = q_m[i] - q_md
            v_mr = q_md.rate() - self.shaped(motor, i, e_m) - s * (robot.K[i] / motor["metric"][i])
            inner = v_mr.rate() * robot.M_m[i] + springs[i] + v_mr * robot.D_m[i]
            found.append((q_md, e_m, v_mr, inner - e_m * motor["metric"][i] - (v_m[i] - v_mr) * motor["damping"][i]))
        return zip(*found)
    def asked(self, q_d, x):  # torques at x
        *_, torques = self.wanted(q_d, x)
        return [torque[0] for torque in torques]

def product(a, b):  # of polynomials, the lowest coefficient first
    return [sum(a[i] * b[k - i] for i in range(k + 1) if i < len(a) and k - i < len(b)) for k in range(len(a) + len(b) - 1)]
def polynomial(coefficients, x):
    value = 0
    for c in reversed(coefficients):
        value = value * x + arb(fmpq(c.numerator, c.denominator))
    return value
# Of degree 7, with the first, second and third of (value, rate, second rate) 1 at 0, all others and the third rate 0, and all four 0 at 1: their integrals from 0
BRAKES = [[Fraction(0)] + [Fraction(c, k + 1) for k, c in enumerate(product([0] * i + [1], product([1, -4, 6, -4, 1], [1, 4, 10, 20][:4 - i])))] for i in range(3)]
def stopped(x, settle, span, time):  # from the motion x, Taylor coefficients to the third
    starts = [x[1] * settle, x[2] * settle * settle * 2, x[3] * settle * settle * settle * 3]  # the third polynomial is twice as large
    def along(tau):
        return [polynomial(brake, tau) * start for brake, start in zip(BRAKES, starts)]
    return until(span, settle, sum(along(time / settle), x[0]), constant(sum(along(ONE), x[0])))
def until(span, end, before, after):  # series over times of this span; where that is on both sides of the end, what encloses the two
    (low, high), before, after = span, series(before), series(after)
    if high <= end.low:
        return before
    return after if low >= end.high else Series(lambda k: before[k].union(after[k]))

def reference(raw, t, span, motion):  # its Taylor coefficients at the time t, which is within the span, for each joint; motion has those of the links at 0
    time, all, join = Series(lambda k: ONE if k == 1 else ZERO, [t]), [constant(x) for x in raw["offset"]], raw["join"]
    for term in raw["terms"]:
        waves = [(time * w + phase).sin_cos()[0] * a for a, w, phase in zip(*(term[key] for key in ("amplitude", "frequency", "phase")))]
        all = plus(all, waves)
    if join is None:
        return all
    x = time / join["duration"]
    s = x * x * x * x * x * (126 - x * (420 - x * (540 - x * (315 - x * 70))))
    stops = [stopped(q, join["settle"], span, time) for q in motion]
    return [until(span, join["duration"], p + (q - p) * s, q) for p, q in zip(stops, all)]

def stacked(rows):
    return arb_mat([x for row in rows for x in [row.entries()]])
def largest(square, times):  # of a symmetric positive semidefinite matrix, above its largest eigenvalue: (trace of A^(2^times))^(2^-times)
    for _ in range(times):
        square = square * square
    trace = square.trace().abs_upper()
    for _ in range(times):
        trace = trace.sqrt().abs_upper()
    return trace
def length_of(all):
    return sum((arb(x).abs_upper() ** 2 for x in all), ZERO).abs_upper().sqrt().abs_upper()

# ---- The file: exactly the keys, lengths and kinds of the specification
class Number(arb):  # a decimal, or a pair for a real between two, that knows its rational ends
    pass
def enclosing(low, high):
    a, b = (arb(fmpq(x.numerator, x.denominator)) for x in (low, high))
    x = Number(a if low == high else a.union(b))
    x.low, x.high = low, high
    return x
def number(text, sign=None):
    ends = text if isinstance(text, list) else [text, text]
    need(len(ends) == 2 and all(isinstance(end, str) and DECIMAL.fullmatch(end) for end in ends), f"{text!s:.60} is no number", ValueError)
    values = [Fraction(end) for end in ends]
    need(all(v == 0 or Fraction(1, 10**330) <= abs(v) < 10**100 for v in values) and values[0] <= values[1], f"{text!s:.60} is no number", ValueError)
    need(sign is None or values[0] > 0 or sign == ">= 0" and values[0] == 0, f"{text!s:.60} is not {sign}", ValueError)
    return enclosing(*values)
positive, not_negative = partial(number, sign="> 0"), partial(number, sign=">= 0")
def read(value, spec):  # the value, if it is as specified: (spec,) is that or null, [spec, ...] a list of any length
    if isinstance(spec, tuple):
        return None if value is None else read(value, spec[0])
    if isinstance(spec, dict):
        need(isinstance(value, dict) and value.keys() == spec.keys(), f"keys are {[*value] if isinstance(value, dict) else '?'}, must be {[*spec]}", ValueError)
        return {key: read(value[key], spec[key]) for key in spec}
    if isinstance(spec, list):
        need(isinstance(value, list), f"{value!s:.60} is no list", ValueError)
        wanted = spec[:1] * len(value) if spec[-1:] == [...] else spec
        need(len(value) == len(wanted), f"{value!s:.60} has {len(value)} entries, must have {len(wanted)}", ValueError)
        return [read(*pair) for pair in zip(value, wanted)]
    if isinstance(spec, (set, range, type)):
        fits = type(value) is spec if isinstance(spec, type) else type(value) in (str, int) and value in spec
        need(fits, f"{value!s:.60} is not of {spec}", ValueError)
    return value if isinstance(spec, (set, range, type)) else spec(value)
def digest(text):
    need(isinstance(text, str) and re.fullmatch("[0-9a-f]{64}", text) is not None, f"{text!s:.60} is no SHA-256", ValueError)
def read_body(k, raw):
    slides, vector = raw["kind"] == "prismatic", [number] * 3
    return read(raw if slides else {"travel": None} | raw, {
        "parent": (range(k),), "kind": {"revolute", "prismatic"}, "axis": vector, "rotation": [vector] * 3, "translation": vector,
        "mass": not_negative, "com": vector, "inertia": [number] * 6, "travel": [number] * 2 if slides else type(None)})
def read_file(data, format, version, others):  # what a file tells of a loop, and the keys that others(n) specifies for n joints
    need(len(data) <= 1 << 30, "larger than 1 GiB", ValueError)
    def once(pairs):
        need(len(dict(pairs)) == len(pairs), "a key is there twice", ValueError)
        return dict(pairs)
    raw = json.loads(data.decode("utf-8"), object_pairs_hook=once)
    need(isinstance(raw, dict) and raw.get("format") == format, "another format", ValueError)
    n, kind, phi = raw["robot"]["joints"], raw["robot"]["links"]["kind"], raw["controller"]["phi"]
    read([n, kind, phi], [range(1, 65), {"planar-two-link", "tree", "pendulum"}, {"tanh", "linear", "coupled-tanh"}])
    need(type(n) is int and n == {"planar-two-link": 2, "pendulum": 1}.get(kind, n), f"no {kind} has {n} joints", ValueError)
    known(kind != "pendulum" and phi != "coupled-tanh", f"{kind} with {phi}")
    links = {"planar-two-link": {"mass": [positive] * 2, "length": positive, "com": [number] * 2, "inertia": [positive] * 2},
             "tree": {"bodies": [partial(read_body, k) for k in range(n)]}}
    numbers, from_zero, above = [number] * n, [not_negative] * n, [positive] * n
    gains = {"metric": above, "shaping": above, "damping": above, "kappa": type(None), "hardening": type(None)}
    file = read(raw, {
        "format": str, "version": range(version, version + 1), "name": str, "made_by": str, "subject": ({"robot": digest, "scenario": digest},),
        "robot": {"name": str, "joints": int, "stiffness": above, "motor_inertia": above, "link_damping": from_zero, "motor_damping": from_zero,
                  "links": {"kind": str} | links[kind]},
        "controller": {"phi": str, "link": gains | {"hardening": (from_zero,)}, "motor": gains},
        "gravity": [number] * 3 if kind == "tree" else type(None),
        "reference": ({"offset": numbers, "terms": [{"amplitude": numbers, "frequency": numbers, "phase": numbers}, ...],
                       "join": ({"duration": positive, "settle": positive},)},),
        "initial": [number] * 4 * n} | others(n))
    known(file["reference"] is not None, "references of other forms")
    return file
def chosen(options, count):  # of so many parts those that are followed, spread evenly
    every = options.all or options.sample >= count
    return range(count) if every else sorted({j * (count - 1) // max(1, options.sample - 1) for j in range(options.sample)})
def floats(text):
    data = base64.b64decode(text, validate=True)
    need(len(data) % 8 == 0, "a text is no list of numbers of 64 bits", ValueError)
    numbers = struct.unpack(f"<{len(data) // 8}d", data)
    need(all(-float("inf") < x < float("inf") for x in numbers), "a text has numbers that are not finite", ValueError)
    return numbers
def lower(size, entries):  # rows of a lower triangle with a positive diagonal
    rows = [[arb(x) for x in entries[i * (i + 1) // 2:(i + 1) * (i + 2) // 2]] + [ZERO] * (size - 1 - i) for i in range(size)]
    need(all(row[i] > 0 for i, row in enumerate(rows)), "a diagonal is not positive", ValueError)
    return rows
def at_least_one(text):
    if not re.fullmatch(r"0*[1-9]\d{0,8}", text, re.ASCII):
        raise argparse.ArgumentTypeError(f"{text!s:.60} is no whole number from 1 on")
    return int(text)
def main(check, what, part):  # the files of the command line through check(data, options), which follows all or a sample of their parts: prints what came of each; the worst exit code
    parser = argparse.ArgumentParser(description=f"Checks files of {what}s.")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--all", action="store_true", help=f"every {part}")
    parser.add_argument("--sample", type=at_least_one, metavar="K", default=20, help=f"so many {part}s")
    options, worst = parser.parse_args(), 0
    for path in options.files:
        start = time.perf_counter()
        try:
            code, said = 0, "proved for " + check(open(path, "rb").read(), options)
        except AssertionError as error:
            code, said = 1, f"not proved: {error}"
        except ZeroDivisionError:
            code, said = 1, "not proved: something may be 0 that is divided by"
        except Exception as error:
            code, said = 2, str(error) if isinstance(error, Unknown) else f"not a file of a {what}: {type(error).__name__}: {str(error):.200}"
        print(f"{path}: {said}, checked in {time.perf_counter() - start:.1f} s", flush=True)
        worst = max(worst, code)
    return worst
