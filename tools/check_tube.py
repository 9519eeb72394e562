#!/usr/bin/env python3
"""Checks files of tubes as docs/tube.md states them, with Python and python-flint alone: check_tube.py FILE... [--all] [--sample K]

Checked are the start, `torque` at every instant, and for K control periods spread evenly (20 unless told) or, with --all, for every one: 1, 2, 3 and 5 of that page, and `rate`.
`error` needs every period before: without --all it is compared with the extents of all sections alone. The line of a file says which periods were checked.

Exit code: 0 all proved, 1 a claim does not hold or is not proved here, 2 not a file of a tube, or one of a loop that this program does not know; the worst of all files.
Numbers are balls of 128 bits that contain what they stand for; a comparison of two is true only where it holds for all reals inside.

How: everything is a function of y in the unit ball, known as its value and its slopes at 0 and its second derivatives anywhere (Form). The law's torques are such functions,
c + g y + s w with |w| <= 1/2 for what is of second order; so are the coefficients and the remainder of the robot's Taylor polynomial in time. Slopes of G_k at the centre, by y and
by w, and how far they change bound lambda; where the centre goes, rho."""
import sys
from math import ceil
from flint import arb, arb_mat
from balls import *

ORDERS = range(11, 30)  # of Taylor polynomials of motions: the first that leaves so little beside extents
LITTLE = 1e-12
LARGER = 4  # w is as much smaller, so that there is little of it beside y
PACE = 0.7  # in a piece of a period, the fastest rate times its length is at most this

# ---- Motions under held torques
def combined(rows, forms):  # rows of numbers times forms
    return [total(form.h * x for form, x in zip(forms, row)) for row in rows]

def piece(robot, x, torques, length):  # from the forms x, under the forms of torques
    inner = x + torques
    sizes = [form.radius() + arb(2) ** -300 for form in inner]
    on = Domain(0, len(inner))
    start = [on.along(form.c, [size if i == j else ZERO for j in range(on.size)]) for i, (form, size) in enumerate(zip(inner, sizes))]
    x0, u = start[:len(x)], start[len(x):]
    tried = x0
    for _ in range(25):  # until Picard's operator maps these functions of time into themselves, slopes and second derivatives included
        speed = [rate[0] for rate in robot.motion(tried, u)[3]]
        box = [a + v * length.union(ZERO) for a, v in zip(x0, speed)]
        if all(b.c.contains(a.c) and b.g.contains(a.g) and b.h.contains(a.h) for a, b in zip(box, tried)):
            break
        tried = [a + v * length * arb(0.55, 0.8) for a, v in zip(x0, speed)]
    else:
        return None
    across, straight = (stacked([row / size for row, size in zip(rows, sizes)]) for rows in ([f.slope() for f in inner], [f.g for f in inner]))
    exact, rest = (sum(robot.motion(all, u)[2], []) for all in (x0, box))
    for order in ORDERS:
        left = length.abs_upper() ** (order + 1)
        if all(series[order + 1].range().abs_upper() * left <= size * LITTLE for series, size in zip(rest, sizes)):
            break
    after = []
    for series, late in zip(exact, rest):
        end = late[order + 1]
        for k in reversed(range(order + 1)):
            end = end * length + series[k]
        by = [slope / size for slope, size in zip(end.slope().entries(), sizes)]
        after.append(Form(x[0].on, end.c, end.g * straight, across.transpose() * end.h * across + combined([by], inner)[0]))
    return after

def held(robot, x, torques, length):  # in as many pieces as motors need, or more
    fastest = max(max(float(d / m), float((k / m).sqrt())) for d, m, k in zip(robot.D_m, robot.M_m, robot.K))
    need(float(length.abs_upper()) * fastest < 1e4, "motors are too fast to follow them")
    count = max(1, ceil(float(length.abs_upper()) * fastest / PACE))
    for finer in (1, 2, 4, 8, 16, 32):
        now = x
        for _ in range(count * finer):
            now = now and piece(robot, now, torques, length / (count * finer))
        if now:
            return now
    raise AssertionError("motions are not shown to exist until the end of the period")

# ---- Norms
def bend(form):  # its slopes differ from those at 0 by at most so much times |y|
    return largest(form.h.transpose() * form.h, 6).sqrt().abs_upper()

# ---- The file: exactly the keys, lengths and kinds of the specification
def read_tube(data):
    def others(n):
        above, some = [positive] * n, [(number,)] * n
        return {
            "loop": {"control_period": positive, "waiting": int, "offset": (positive,), "off": [not_negative, ...],
                     "filter": ({"feedback": [number] * 2, "forward": [number] * 2},),
                     "limits": {"torque": some, "torque_step": some, "readings": ({"lowest": some, "highest": some, "speed": some, "deflection": some,
                                                                                 "jump": some, "travel": positive},)}},
            "asked": {"extents": above, "rate": positive}, "periods": int,
            "claims": {"rate": number, "error": [number] * 2 * n, "torque": [number] * n}, "kept": [int, ...], "sections": [str, ...]}
    file = read_file(data, "flexure-sampled-tube", 1, others)
    count, n, off, kept = file["periods"], file["robot"]["joints"], file["loop"]["off"], file["kept"]
    need(count >= 1 and len(file["sections"]) == count + 1 == len(kept), "periods, sections and kept do not fit", ValueError)
    need(len(off) in (0, 2 * n), "loop: off has another length", ValueError)
    need(kept[0] == 0 and all(0 <= b <= a + len(off) for a, b in zip(kept, kept[1:])), "kept: not so many columns", ValueError)
    known(not off, "readings that are off")
    return file

class Section:
    def __init__(self, text, m):
        numbers = floats(text)
        need(len(numbers) == m + m * (m + 1) // 2, f"a section has {len(numbers)} numbers", ValueError)
        self.m, self.c, self.rows = m, [arb(x) for x in numbers[:m]], lower(m, numbers[m:])
    def forms(self, more=0):  # of y, and of so many numbers more
        on = Domain(self.m, self.m + more)
        return [on.along(c, row + [ZERO] * more) for c, row in zip(self.c, self.rows)]
    def inverse(self):
        return arb_mat(self.rows).inv()
    def reach(self, state):  # of L^-1 (state - c)
        return length_of((self.inverse() * arb_mat(self.m, 1, [x - c for x, c in zip(state, self.c)])).entries())

# ---- The loop
class Loop:
    def __init__(self, file):
        self.file, self.n = file, file["robot"]["joints"]
        self.robot = Robot(file["robot"], file["gravity"])
        self.law, loop = Law(file["controller"], self.robot), file["loop"]
        self.h, self.filter, first = loop["control_period"], loop["filter"], loop["offset"]
        self.waiting = loop["waiting"]
        need(first is None or self.waiting >= 1 and first.high < self.h.low, "offset is not inside of a period", ValueError)
        self.lengths = [self.h] if first is None else [first, self.h - first]
        self.m = self.n * ((8 if self.filter else 4) + self.waiting)
        self.sections = [Section(text, self.m) for text in file["sections"]]
        self.begins = self.robot.motion(file["initial"], None)[2][0]
    def parts(self, state):  # positions, velocities, r_1, r_2
        return [state[k * 2 * self.n:][:2 * self.n] for k in range(4)]
    def start(self):
        n, x = self.n, self.file["initial"]
        q, v, _, _ = self.parts(x)
        waiting, memory = [(x[n + i] - x[i]) * self.robot.K[i] for i in range(n)] * self.waiting, []
        if self.filter:
            (a1, a2), (b0, b1) = self.filter["feedback"], self.filter["forward"]
            memory = [(a1 + a2 + b1 * self.h) * y - b0 * x for x, y in zip(q, v)] + [a2 * y - b1 * x for x, y in zip(q, v)]
        return x + memory + waiting
    def seen(self, state):  # what the law is given, and what the filter remembers after it
        q, v, r1, r2 = self.parts(state)
        if not self.filter:
            return q + v, []
        (a1, a2), (b0, b1) = self.filter["feedback"], self.filter["forward"]
        v = [x * b0 + r for x, r in zip(q, r1)]
        return q + v, [x * (b1 - b0) + y * a1 + r for x, y, r in zip(q, v, r2)] + [y * a2 - x * b1 for x, y in zip(q, v)]
    def torques(self, k, state):  # of the law at instant k
        span = self.h.low * k, self.h.high * k
        return self.law.asked(reference(self.file["reference"], enclosing(*span), span, self.begins), self.seen(state)[0])
    def period(self, k, asked):  # where all of it is at the next instant, as functions of y and w, torques asked for being c + g y + s w
        n, state = self.n, self.sections[k].forms(self.n)
        x, on = state[:4 * n], state[0].on
        asked = [on.along(form.c, form.g.entries() + [LARGER * bend(form) if i == j else ZERO for j in range(n)]) for i, form in enumerate(asked)]
        queue = [state[self.m - j * n:][:n] for j in range(self.waiting, 0, -1)] + [asked]
        for torques, length in zip(queue, self.lengths):
            x = held(self.robot, x, torques, length)
        return x + self.seen(state)[1] + sum(queue[1:], [])
    def steps(self, k, after):  # lambda and rho. |w_j| is at most 1/(2 LARGER) and changes by at most 1/LARGER of what y does
        inverse = self.sections[k + 1].inverse()
        columns = flipped((inverse * stacked([form.g for form in after])).tolist())
        slopes, of_w, part = arb_mat(columns[:self.m]), sum(length_of(column) for column in columns[self.m:]), self.n / arb(LARGER) ** 2
        bent = largest(total(h.transpose() * h for h in combined(inverse.tolist(), after)), 6) * (1 + part) * (1 + part / 4)
        growth = largest(slopes * slopes.transpose(), 30).sqrt() + of_w / LARGER + bent.sqrt()
        return growth.abs_upper(), self.sections[k + 1].reach([form.c for form in after])

def check(data, options):
    file = read_tube(data)
    loop, claims, count = Loop(file), file["claims"], file["periods"]
    every = options.all or options.sample >= count
    limit, worst, away = (-claims["rate"] * loop.h).exp(), ZERO, loop.sections[0].reach(loop.start())
    need(away <= 1, f"the start is not in E_0: |y| is {float(away):.6g}")
    def errors_fit(k, times):
        for i, (row, claim) in enumerate(zip(loop.sections[k].rows, claims["error"])):
            most = length_of(row) * times
            need(most <= claim, f"error: position {i + 1} is up to {float(most):.10g} rad off at instant {k}")
    def torques_fit(k, all):
        for i, form in enumerate(all):
            most = form.range().abs_upper()
            need(most <= claims["torque"][i % loop.n], f"torque: {float(most):.10g} N m at joint {i % loop.n + 1}, instant {k}")
    for k in range(count + 1):
        errors_fit(k, ONE)
    torques_fit(0, loop.sections[0].forms()[loop.m - loop.waiting * loop.n:])
    followed = chosen(options, count)
    for k in range(count + 1):
        asked = loop.torques(k, loop.sections[k].forms())
        torques_fit(k, asked)
        if every:
            errors_fit(k, 1 + away)
        if k in followed:
            growth, offset = loop.steps(k, loop.period(k, asked))
            need(growth + offset <= 1, f"period {k}: lambda {float(growth):.9g} and rho {float(offset):.3g} are more than 1 together")
            need(growth <= limit, f"rate: lambda is {float(growth):.10g} in period {k}, must be at most {float(limit):.10g}")
            worst, away = worst.max(growth), (growth * away + offset).abs_upper()
    some = f"all {count} periods" if every else f"periods {', '.join(map(str, followed))} of {count}, error without |y| of the run"
    return f"{some}: largest lambda {float(worst):.9f} where {float(limit):.9f} is claimed"

if __name__ == "__main__":
    sys.exit(main(check, "tube", "control period"))
