#!/usr/bin/env python3
"""Checks files of funnels as docs/funnel.md states them, with Python and python-flint alone: check_funnel.py FILE... [--all] [--sample K]

Checked of every slab are how it joins the one before, the ellipsoid around, `error` and `velocity_error`; and for K slabs spread evenly (20 unless told) or, with --all, for every one
that errors stay and come back, `rate`, `velocity`, `deflection`, `torque` and `torque_rate`. The line of a file says which slabs these were.

Exit code: 0 all proved, 1 a claim does not hold or is not proved here, 2 not a file of a funnel, or one of a loop that this program does not know; the worst of all files.

How: over a slab everything is a function of y in the unit ball, errors being z = G y, and of time tau in [-1, 1], known as its value and slopes in the middle and its second derivatives
anywhere (Form): so are the rates of z on the model, what each cause of the errors may be, and, by derivatives along accelerations of the links (Dual), the direction in which it pushes them.
Each is split into its part that is linear in y, or goes with tau, and what that leaves open, which is a cause of its own. The inequality is looked at in the coordinates y."""
import sys
from flint import arb, arb_mat
from balls import *

def read_funnel(data):
    def others(n):
        from_zero, some = [not_negative] * n, [(number,)] * n
        return {
            "duration": positive, "limits": {"velocity": some, "deflection": some, "torque": some, "torque_rate": some},
            "tolerances": {key: from_zero for key in ("stiffness", "motor_inertia", "link_damping", "motor_damping", "link_mass")},
            "torques": {"links": from_zero, "motors": from_zero},
            "claims": {"room": positive, "rate": number, "error": [number] * 2 * n, "velocity_error": [number] * 2 * n,
                       "velocity": some, "deflection": some, "torque": some, "torque_rate": some},
            "slabs": [str, ...]}
    file = read_file(data, "flexure-funnel", 2, others)
    need(file["claims"]["room"] >= 1, "room is less than 1", ValueError)
    known(not any(x.high > 0 for x in file["controller"]["link"]["hardening"] or []), "metrics that grow with the error")
    return file

def definite(rows):  # whether a symmetric matrix is positive definite, by the pivots of elimination
    a, n = [list(row) for row in rows], len(rows)
    for k in range(n):
        if not a[k][k] > 0:
            return False
        for i in range(k + 1, n):
            part = a[i][k] / a[k][k]
            for j in range(k + 1, i + 1):
                a[i][j] -= part * a[j][k]
    return True
def exact(x):
    return arb(fmpq(Fraction(x).numerator, Fraction(x).denominator))
def middle(x):
    return arb(x.mid())
def column(entries):
    return arb_mat(len(entries), 1, entries)

class Slab:  # its times, ellipsoids and multipliers
    def __init__(self, text, m, causes):
        numbers, triangle = floats(text), m * (m + 1) // 2
        instants = (len(numbers) - triangle - 2 * causes) // (1 + triangle)
        need(instants >= 2 and len(numbers) == instants * (1 + triangle) + triangle + 2 * causes, f"a slab has {len(numbers)} numbers", ValueError)
        self.times, rest = [Fraction(x) for x in numbers[:instants]], numbers[instants:]
        need(all(a < b for a, b in zip(self.times, self.times[1:])), "times do not increase", ValueError)
        self.shapes = [arb_mat(lower(m, rest[k * triangle:][:triangle])) for k in range(instants)]
        self.around, rest = arb_mat(lower(m, rest[instants * triangle:][:triangle])), rest[(instants + 1) * triangle:]
        self.fixed, self.alpha, self.tau = None, *([arb(x) for x in part] for part in (rest[:causes], rest[causes:]))
    def scaled(self):  # L of the ellipsoids in the coordinates y
        inverse = self.around.inv()
        return [inverse * shape for shape in self.shapes]

class Column:  # numbers c + rate tau for each error, and what is left open of each
    def __init__(self, c, rate, open):
        self.c, self.rate, self.open = c, rate, open
    @staticmethod
    def of(parts):
        return Column(column([middle(part.c) for part in parts]), column([middle(part.rate) for part in parts]),
                      [(part.turns() + part.c.rad() + part.rate.rad()).abs_upper() for part in parts])
    @staticmethod
    def sum(columns, factors, rates=None):  # of columns times numbers that are lines in time
        rates, zero = rates or [ZERO] * len(factors), columns[0].c * 0
        c = sum((x.c * a for x, a in zip(columns, factors)), zero)
        rate = sum((x.rate * a + x.c * b for x, a, b in zip(columns, factors, rates)), zero)
        twice = sum((x.rate * b for x, b in zip(columns, rates)), zero).entries()
        open = [t.abs_upper() + sum((x.open[i] * (abs(a) + abs(b)).abs_upper() for x, a, b in zip(columns, factors, rates)), ZERO) for i, t in enumerate(twice)]
        return Column(c, rate, open)

class Cause:  # sum of n_k w_k with |w| <= size + |slopes y|, n_k being columns
    def __init__(self, columns, size, slopes=()):
        self.columns, self.size, self.slopes = columns, arb(size).abs_upper(), [slope for slope in slopes if length_of(slope) > 0]

def norm(matrix):  # from above
    return largest(matrix.transpose() * matrix, 4).sqrt().abs_upper()

class Parts:  # of a Form: value, slope by tau, slopes by y and their slopes by tau; and what all that leaves open
    def __init__(self, form):
        m = form.on.ball
        h = form.h.tolist()
        turned, mixed = [row[:m] for row in h[:m]], [(h[i][m] + h[m][i]) / 2 for i in range(m)]
        self.c, self.rate, self.y = form.c, form.g[0, m], form.g.entries()[:m]
        self.mixed = [middle(x) for x in mixed]
        self.turned, self.crossed, self.curved = norm(arb_mat(turned)), length_of(mixed), h[m][m].abs_upper()  # of the second derivatives
        self.bent = HALF * (self.turned + self.curved)
        self.open = (self.bent + length_of(x - y for x, y in zip(mixed, self.mixed))).abs_upper()  # beside c + rate tau + (y + tau mixed) . y
    def turns(self):  # the most that it is beside c + rate tau
        return (length_of(self.y) + length_of(self.mixed) + self.open).abs_upper()
    def steady(self):  # the most that it is beside y . y
        return (self.c.abs_upper() + self.rate.abs_upper() + length_of(self.mixed) + self.open).abs_upper()

class Flow:  # rates of z: (straight + tau turning) y, and so much that is left open
    def __init__(self, m):
        self.straight, self.turning = ([arb_mat(1, m) for _ in range(m)] for _ in range(2))
        self.left = [ZERO] * m
    def add(self, row, form, open=ZERO):
        part = Parts(form)
        need(part.c == 0 and part.rate == 0, "on the reference errors are not shown to stay 0")
        self.straight[row] += arb_mat([part.y])
        self.turning[row] += arb_mat([part.mixed])
        self.left[row] += part.open + open
    def accelerate(self, number, rising, own):  # by (number + tau rising) f, the parts of f being own
        n = len(own)
        need(all(part.c == 0 and part.rate == 0 for part in own), "on the reference errors are not shown to stay 0")
        y, mixed = (arb_mat([of(part) for part in own]) for of in (lambda part: part.y, lambda part: part.mixed))
        straight, turning, twice = number * y, number * mixed + rising * y, rising * mixed
        for i in range(n):
            row = 2 * n + i
            self.straight[row] += arb_mat([straight.tolist()[i]])
            self.turning[row] += arb_mat([turning.tolist()[i]])
            self.left[row] += length_of(twice.tolist()[i]) + sum((abs(number[i, j]) + abs(rising[i, j])).abs_upper() * own[j].open for j in range(n))

class Loop:
    def __init__(self, file):
        self.file, self.n = file, file["robot"]["joints"]
        n = self.n
        self.robot = Robot(file["robot"], file["gravity"])
        self.law, self.m, self.off = Law(file["controller"], self.robot), 4 * n, file["tolerances"]
        self.heavier = max((x.high for x in self.off["link_mass"]), default=0)
        need(self.heavier < 1, "a link may have no mass", ValueError)
        causes = 6 * n + (2 * n if self.heavier else 0) + 2 + 4 * n
        self.slabs = [Slab(text, self.m, causes) for text in file["slabs"]]
        self.alone = [Robot(self.only(i), file["gravity"]).links for i in range(n)] if self.heavier else []
        self.initial = self.robot.motion(file["initial"], None)[2][0]
        self.rest_from = causes - 4 * n
    def only(self, link):  # the robot with no masses but those of one link
        raw, nothing = self.file["robot"], Number(0)
        links = raw["links"]
        if links["kind"] == "planar-two-link":
            kept = {key: [x if i == link else nothing for i, x in enumerate(links[key])] for key in ("mass", "inertia")}
            return raw | {"links": links | kept}
        weightless = {"mass": nothing, "inertia": [nothing] * 6}
        return raw | {"links": links | {"bodies": [body if i == link else body | weightless for i, body in enumerate(links["bodies"])]}}
    def reference(self, t, span):
        return reference(self.file["reference"], t, span, self.initial)
    def start(self):  # the errors at t = 0
        n, x = self.n, self.file["initial"]
        q_d = self.reference(ZERO, (Fraction(0), Fraction(0)))
        _, e_m, v_mr, _ = self.law.wanted(q_d, x)
        e_l = [x[i] - q_d[i][0] for i in range(n)]
        v_lr = [q_d[i][1] - self.law.shaped(self.law.link, i, e_l[i]) for i in range(n)]
        return e_l + [e[0] for e in e_m] + [x[2 * n + i] - v_lr[i] for i in range(n)] + [x[3 * n + i] - v[0] for i, v in enumerate(v_mr)]
    def motion(self, z, q_d):  # the state with the errors z, and its torques
        n, law, nothing = self.n, self.law, [ZERO] * self.n
        e_l, e_m, s_l, s_m = (z[k * n:][:n] for k in range(4))
        q_l = [q_d[i][0] + e_l[i] for i in range(n)]
        v_l = [q_d[i][1] - law.shaped(law.link, i, e_l[i]) + s_l[i] for i in range(n)]
        q_md, *_ = law.wanted(q_d, q_l + q_l + v_l + nothing)  # does not depend on the motors
        q_m = [q_md[i][0] + e_m[i] for i in range(n)]
        _, _, v_mr, _ = law.wanted(q_d, q_l + q_m + v_l + nothing)
        v_m = [v_mr[i][0] + s_m[i] for i in range(n)]
        return q_l, q_m, v_l, v_m, law.asked(q_d, q_l + q_m + v_l + v_m)
    def pushed(self, q_d, state, a):  # the direction of z in which accelerations a of the links move it
        n, (q_l, q_m, v_l, v_m, _) = self.n, state
        q_md, _, v_mr, _ = self.law.wanted(q_d, q_l + q_m + [Dual(v, x) for v, x in zip(v_l, a)] + v_m)
        return [q_l[0] * 0] * n + [-q_md[i][0].d for i in range(n)] + list(a) + [-v_mr[i][0].d for i in range(n)]
    def motions(self, slab, span):  # how the errors move but for what drives them, what drives them, and what is bounded
        n, m, robot, off, torques = self.n, self.m, self.robot, self.off, self.file["torques"]
        link, motor, K = self.law.link, self.law.motor, robot.K
        on, (begin, end) = Domain(m, m + 1), map(exact, span)
        z = [on.along(ZERO, row + [ZERO]) for row in slab.around.tolist()]
        zero, (e_l, e_m, s_l, s_m) = z[0] * 0, (z[k * n:][:n] for k in range(4))
        q_d = self.reference(on.along((begin + end) / 2, [ZERO] * m + [(end - begin) / 2]), span)
        state = q_l, q_m, v_l, v_m, u = self.motion(z, q_d)
        q, v, s = ([constant(x) for x in all] for all in (q_l, v_l, s_l))
        at = robot.links.at(q)
        matrix = robot.links.matrix(at)
        def accelerated(load):
            return [a[0] for a in solve(matrix, [constant(zero + x) for x in load])]
        mobility = [accelerated([int(i == j) for i in range(n)]) for j in range(n)]
        turning = robot.links.load(at, v, s, [0] * n, falls=False)
        f = [e_m[i] * K[i] - e_l[i] * link["metric"][i] - series(turning[i])[0] - s_l[i] * (robot.D_l[i] + link["damping"][i]) for i in range(n)]
        flow = Flow(m)
        for i in range(n):
            for k, side, e in ((i, link, e_l[i]), (n + i, motor, e_m[i])):
                phi, open = self.chord(side, i, e)
                flow.add(k, s_l[i] - phi if side is link else s_m[i] - phi - s_l[i] * (K[i] / motor["metric"][i]), open)
            flow.add(3 * n + i, (e_m[i] * motor["metric"][i] + s_m[i] * (robot.D_m[i] + motor["damping"][i])) * (-1 / robot.M_m[i]))
        # Inverse masses: numbers that are lines in time, and L E L' beside them.
        masses, own = [[Parts(mobility[max(i, j)][min(i, j)]) for j in range(n)] for i in range(n)], [Parts(x) for x in f]
        number, rising = (arb_mat([[middle(of(part)) for part in row] for row in masses]) for of in (lambda part: part.c, lambda part: part.rate))
        root = cholesky(number)
        inverse, besides = root.inv(), [[part.c - middle(part.c) + UNIT * (part.rate.rad() + part.turns()) for part in row] for row in masses]
        def size(matrix):  # of E for L E L'
            scaled = inverse * matrix * inverse.transpose()
            return norm(scaled)
        model = size(arb_mat(besides))
        flow.accelerate(number, rising, own)
        through = [Parts(sum((f[i] * root[i, k] for i in range(k, n)), zero)) for k in range(n)]  # L' f
        def beside(columns, radius, more):
            return Cause(columns, radius * length_of(part.steady() for part in through) + more, [[x * radius for x in part.y] for part in through])
        # What torques of 1 do: M'^-1 is between M^-1 / (1 - mu^2) and what mu / (1 - mu^2) M^-1 is more or less.
        mu = exact(self.heavier)
        between = 1 / (1 - mu * mu)
        moved = [Column.of([Parts(x) for x in self.pushed(q_d, state, [zero + int(i == k) for i in range(n)])]) for k in range(n)]  # by accelerations of 1
        on_link = [Column.sum(moved, [number[k, j] * between for k in range(n)], [rising[k, j] * between for k in range(n)]) for j in range(n)]
        on_motor = [Column.of([Parts(zero + (1 / (robot.M_m[i] + UNIT * off["motor_inertia"][i]) if row == 3 * n + i else 0)) for row in range(m)]) for i in range(n)]
        rooted = [Column.sum(moved, [root[i, k] for i in range(n)]) for k in range(n)]
        bends, causes = [q_m[i] - q_l[i] for i in range(n)], []
        def seen(columns, form, tolerance):
            part = Parts(form)
            return Cause(columns, part.steady() * tolerance, [[x * tolerance for x in part.y]])
        for i in range(n):
            speeds_up = u[i] - bends[i] * K[i] - v_m[i] * robot.D_m[i]
            causes += [
                Cause([on_link[i]], torques["links"][i]),
                Cause([on_motor[i]], torques["motors"][i]),
                seen([Column.sum([on_link[i], on_motor[i]], [ONE, -ONE])], bends[i], off["stiffness"][i]),
                seen([on_link[i]], v_l[i], off["link_damping"][i]),
                seen([on_motor[i]], v_m[i], off["motor_damping"][i]),
                seen([on_motor[i]], speeds_up, off["motor_inertia"][i] / robot.M_m[i])]
        felt = [torques["links"][j].abs_upper() + bends[j].range().abs_upper() * off["stiffness"][j] + v_l[j].range().abs_upper() * off["link_damping"][j] for j in range(n)]
        if self.heavier:
            loads = [[zero + x for x in load] for load in self.loads(q_d, q, v, q_l, v_l)]
            felt = [x + sum(loads[i][j].range().abs_upper() * off["link_mass"][i] for i in range(n)) for j, x in enumerate(felt)]
            fixed = slab.fixed = slab.fixed or [[middle(x.c) for x in load] for load in loads]  # of all of the slab, which multipliers are for
            causes += [Cause([Column.sum(on_link, fixed[i])], off["link_mass"][i]) for i in range(n)]
            causes += [Cause([on_link[j]], sum((loads[i][j] - fixed[i][j]).range().abs_upper() * off["link_mass"][i] for i in range(n))) for j in range(n)]
        causes.append(beside([Column(column([root[row - 2 * n, k] if row // n == 2 else ZERO for row in range(m)]), column([ZERO] * m), [ZERO] * m) for k in range(n)], model, ZERO))
        apart = mu * between * (1 + size(arb_mat([[mobility[max(i, j)][min(i, j)].range() for j in range(n)] for i in range(n)]) - root * root.transpose()))
        if self.heavier:
            for row, x in enumerate(self.pushed(q_d, state, [x * (between - 1) for x in accelerated(f)])):
                flow.add(row, x)
        causes.append(beside(rooted, apart, (between * model + apart) * length_of(sum(abs(root[i, k]) * felt[i] for i in range(k, n)) for k in range(n))))
        return flow, causes, {"velocity": v_l, "deflection": bends, "torque": u}
    def loads(self, q_d, q, v, q_l, v_l):  # of each link alone
        moving = [Series(lambda k, i=i: v_l[i] if k == 1 else ZERO, [q_l[i]]) for i in range(self.n)]
        v_lr = [q_d[i].rate() - self.law.shaped(self.law.link, i, moving[i] - q_d[i]) for i in range(self.n)]
        a_lr = [constant(x[1]) for x in v_lr]
        return [[series(x)[0] for x in links.load(links.at(q), v, v, a_lr)] for links in self.alone]
    def chord(self, gains, i, e):  # phi as a linear function of the error, and what that leaves open
        most, shaping = e.radius(), gains["shaping"][i]
        flattest = most.tanh() / most if self.law.phi == "tanh" else ONE
        return e * (shaping * (1 + flattest) / 2), (shaping * (1 - flattest) / 2 * most).abs_upper()

def cholesky(matrix):
    n = matrix.nrows()
    rows = [[ZERO] * n for _ in range(n)]
    for i in range(n):
        for j in range(i + 1):
            left = matrix[i, j] - sum(rows[i][k] * rows[j][k] for k in range(j))
            rows[i][j] = middle(left.sqrt() if i == j else left / rows[j][j])
    return arb_mat(rows)

HALVED = 4  # so often a slab is cut where it is not shown to hold as a whole

def follow(loop, slab, scaled):  # the rate at which errors are shown to come back, speeds, deflections and torques being as small as is claimed
    squares = [outer_of(shape) for shape in scaled]
    def square(t):  # X at a time
        k = max(i for i, begin in enumerate(slab.times[:-1]) if begin <= t)
        part = exact((t - slab.times[k]) / (slab.times[k + 1] - slab.times[k]))
        return squares[k] + (squares[k + 1] - squares[k]) * part
    slowest, open = None, [(slab.times[0], slab.times[-1], 0)]
    while open:
        begin, end, cuts = open.pop()
        flow, causes, seen = loop.motions(slab, (begin, end))
        growth = stays(loop, slab, square, (begin, end), flow, causes)
        lacks = f"errors are not shown to stay at t = {float(begin):.6g} s" if growth is None else exceeds(loop, slab, scaled, (begin, end), flow, causes, seen)
        if lacks:
            need(cuts < HALVED, lacks)
            middle = (begin + end) / 2
            open += [(begin, middle, cuts + 1), (middle, end, cuts + 1)]
        else:
            slowest = growth if slowest is None or growth < slowest else slowest
    return slowest

def exceeds(loop, slab, scaled, span, flow, causes, seen):  # what is not shown to be as small as is claimed, if anything
    def largest_of(form):
        part = Parts(form)
        return part.c.abs_upper() + part.rate.abs_upper() + farthest(part.y, scaled) + length_of(part.mixed) + part.open
    moves = Moves(slab, scaled, span, flow, causes)
    bounds = {what: (forms, largest_of) for what, forms in seen.items()} | {"torque_rate": (seen["torque"], moves.fastest)}
    for what, (forms, bound) in bounds.items():
        for i, (form, claim) in enumerate(zip(forms, loop.file["claims"][what])):
            if claim is not None:
                most = bound(form).abs_upper()
                if not most <= claim:
                    return f"{what} of joint {i + 1} is up to {float(most):.10g}"
def farthest(row, scaled):  # the most that row . y is in the ellipsoids
    return max((length_of((arb_mat([row]) * shape).entries()) for shape in scaled), key=float)

class Moves:  # how fast the errors move in the ellipsoids, in the coordinates y
    def __init__(self, slab, scaled, span, flow, causes):
        self.scaled, self.half, self.inverse = scaled, exact((span[1] - span[0]) / 2), slab.around.inv()
        self.straight, self.turning = self.inverse * stacked(flow.straight), self.inverse * stacked(flow.turning)
        self.left, self.drives = list(flow.left), []
        for cause in causes:
            most = cause.size + length_of(farthest(slope, scaled) for slope in cause.slopes)
            for each in cause.columns:
                self.left = [left + open * most for left, open in zip(self.left, each.open)]
            self.drives.append((most, [(self.inverse * each.c, self.inverse * each.rate) for each in cause.columns]))
        rows = [sum((abs(x).abs_upper() * left for x, left in zip(row, self.left)), ZERO) for row in self.inverse.tolist()]
        self.speed = norm(self.straight) + norm(self.turning) + length_of(rows) + sum(
            (most * length_of(length_of(c.entries()) + length_of(d.entries()) for c, d in pairs) for most, pairs in self.drives), ZERO)
    def fastest(self, form):  # the most that a function changes by [1/s]
        part = Parts(form)
        by_time, along = (part.rate.abs_upper() + part.crossed + part.curved) / self.half, arb_mat([part.y])
        moved = sum(farthest((along * matrix).entries(), self.scaled) for matrix in (self.straight, self.turning))
        driven = sum((most * length_of(abs((along * c)[0, 0]) + abs((along * d)[0, 0]) for c, d in pairs) for most, pairs in self.drives), ZERO)
        open = sum((abs(x).abs_upper() * left for x, left in zip((along * self.inverse).entries(), self.left)), ZERO)
        return by_time + moved + driven + open + (part.turned + part.crossed) * self.speed

def stays(loop, slab, square, span, flow, causes):  # the rate over a span of its times; none where it is not shown
    m = loop.m
    inverse, left, drives = slab.around.inv(), list(flow.left), []
    for cause, alpha, tau in zip(causes, slab.alpha, slab.tau):
        most, pairs = cause.size + length_of(length_of(slope) for slope in cause.slopes), []
        usable = (alpha > 0 or cause.size == 0) and (tau > 0 or not cause.slopes)
        for each in cause.columns if most > 0 else []:
            for i, open in enumerate(each.open):
                left[i] += open * most if usable else (open + abs(each.c[i, 0]) + abs(each.rate[i, 0])).abs_upper() * most
            if usable:
                pairs.append((inverse * each.c, inverse * each.rate))
        drives.append((alpha, tau, cause.size, pairs, [column(slope) for slope in cause.slopes]))
    for i, (size, alpha) in enumerate(zip(left, slab.alpha[loop.rest_from:])):
        unit = inverse * column([arb(i == j) for j in range(m)])
        own = alpha if alpha > 0 else size * length_of(unit.entries())
        drives.append((own, ZERO, size, [(unit, unit * 0)] if size > 0 else [], []))
    growth = sum(alpha for alpha, *_ in drives)
    half, center = (span[1] - span[0]) / 2, (span[0] + span[1]) / 2
    straight, turning = inverse * stacked(flow.straight), inverse * stacked(flow.turning)
    times = [span[0], *(t for t in slab.times if span[0] < t < span[1]), span[1]]
    for begin, end in zip(times, times[1:]):
        step, ends = exact(end - begin), [square(begin), square(end)]
        rising = (ends[1] - ends[0]) / step
        bent = turning * rising * (step * step / 4 / exact(half))
        bent = arb_mat([[x.union(ZERO) for x in row] for row in (bent + bent.transpose()).tolist()])
        for t, x in zip((begin, end), ends):
            late = exact((t - center) / half)
            moved = (straight + turning * late) * x
            rest = rising - moved - moved.transpose() - x * growth + bent
            for alpha, tau, size, pairs, slopes in drives:
                if not pairs:
                    continue
                weight = (size * size / alpha if size > 0 else ZERO) + (tau if slopes else ZERO)
                for c, d in pairs:
                    rest -= outer_of(c + d * late) * weight
                for slope in slopes:
                    rest -= outer_of(x * slope) / tau
            if not definite(rest.tolist()):
                return None
    return growth
def outer_of(matrix):
    return matrix * matrix.transpose()

def check(data, options):
    file = read_funnel(data)
    loop, claims = Loop(file), file["claims"]
    slabs, m = loop.slabs, loop.m
    need(slabs[0].times[0] == 0 and slabs[-1].times[-1] >= file["duration"].high, "the slabs do not cover the run")
    def holds(outside, inside, times):  # whether all that is so many times as large is in there
        difference = outer_of(outside) - outer_of(inside) * (times * times)
        return definite(difference.tolist())
    away = length_of((slabs[0].shapes[0].inv() * column(loop.start())).entries())
    need(away <= 1, f"the start is not in the first ellipsoid: it is {float(away):.6g} times as far out")
    unit = arb_mat([[int(i == j) for j in range(m)] for i in range(m)])
    count, limits = len(slabs), claims["error"] + claims["velocity_error"]
    followed = chosen(options, count)
    slowest = None
    for k, slab in enumerate(slabs):
        at = f"slab {k}, t = {float(slab.times[0]):.6g} s"
        if k > 0:
            last, first = slabs[k - 1].shapes[-1], slab.shapes[0]
            need(slabs[k - 1].times[-1] == slab.times[0], f"{at}: it does not begin where the last one ends")
            need(last.tolist() == first.tolist() or holds(first, last, ONE), f"{at}: it does not hold the last ellipsoid before")
        scaled = slab.scaled()
        need(all(holds(unit, shape, claims["room"]) for shape in scaled), f"{at}: errors so many times as large are not in the ellipsoid around")
        for shape in slab.shapes:
            for i, (row, limit) in enumerate(zip(shape.tolist(), limits)):
                need(length_of(row) <= limit, f"error {i + 1} is up to {float(length_of(row)):.10g} in {at}")
        if k in followed:
            try:
                growth = follow(loop, slab, scaled)
            except AssertionError as error:
                raise AssertionError(f"{at}: {error}") from None
            need(growth >= claims["rate"], f"rate: {float(growth):.10g} 1/s in {at}")
            slowest = growth if slowest is None or growth < slowest else slowest
    acting = [key for key, limit in file["limits"].items() for x, claim in zip(limit, claims[key]) if x is not None and not (claim is not None and claim <= x)]
    limited = any(x is not None for limit in file["limits"].values() for x in limit)
    of = f"all {count} slabs" if len(followed) == count else f"slabs {', '.join(map(str, followed))} of {count}"
    said = f"; {', '.join(acting)} limits may act" if acting else "; no limit of the robot is reached" if limited else ""
    return f"{of}: errors come back at {float(slowest):.6g} 1/s where {float(claims['rate']):.6g} is claimed{said}"

if __name__ == "__main__":
    sys.exit(main(check, "funnel", "slab"))
