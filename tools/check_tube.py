#!/usr/bin/env python3
"""Checks files of tubes as docs/tube.md states them, with Python and python-flint alone: check_tube.py FILE... [--all] [--sample K]

Checked are the start, `torque` at every instant, and for K control periods spread evenly (20 unless told) or, with --all, for every one: 1 to 5 of that page, and `rate`.
`error` needs every period before: without --all it is compared with the extents of all sections alone. The line of a file says which periods were checked.

Exit code: 0 all proved, 1 a claim does not hold or is not proved here, 2 not a file of a tube, or one of a loop that this program does not know; the worst of all files.
Numbers are balls of 128 bits that contain what they stand for; a comparison of two is true only where it holds for all reals inside.

Of readings that are off P has to be found: besides the periods that are to be checked it takes those from the oldest reading on that is kept there. `torque` is then compared at the
first instants of those that are checked alone.

How, where readings are exact: everything is a function of y in the unit ball, known as its value and its slopes at 0 and its second derivatives anywhere (Form). The law's torques are
such functions, c + g y + s w with |w| <= 1/2 for what is of second order; so are the coefficients and the remainder of the robot's Taylor polynomial in time. Slopes of G_k at the
centre, by y and by w, and how far they change bound lambda; where the centre goes, rho.

Where they are off: all is linear in y, z and e (Line), and torques and motions are functions (Form) of y and of as many numbers in [-1, 1] as they have: what readings make of them, in
a frame that is made for it. What torques are beside their slopes at 0 is a number more for each; second derivatives of motions go to lambda and sigma."""
import sys
from math import ceil
from flint import arb, arb_mat
from balls import *

ORDERS = range(11, 30)  # of Taylor polynomials of motions: the first that leaves so little beside extents
LITTLE = 1e-12
LARGER = 4  # w is as much smaller, so that there is little of it beside y
PARTS = [arb(0.5)]  # of extents, evenly up to all of them
LAW_PARTS = [arb(k) / 4 for k in range(1, 5)]  # of y, evenly up to all of it
PACE = 0.7  # in a piece of a period, the fastest rate times its length is at most this

# ---- Linear functions of y, |y| <= 1, and of others
class Others:  # beside `ball` numbers of y: |z_j| <= slopes_j |y| + most_j, and two z_j of the same readings differ by slopes_j times what y does
    def __init__(self, ball, most):
        self.ball, self.slopes, self.most = ball, [ZERO] * len(most), most
    def reach(self, row):
        return (length_of(row[:self.ball]) + sum((abs(x) * (a + b) for x, a, b in zip(row[self.ball:], self.slopes, self.most)), ZERO)).abs_upper()

class Line(Sums):
    def __init__(self, on, c, m):
        self.on, self.c, self.m = on, c, m
    def radius(self):
        return self.on.reach(self.m.entries())
    def range(self):
        return self.c + UNIT * self.radius()
    def __add__(self, other):
        return Line(self.on, self.c + other.c, self.m + other.m) if isinstance(other, Line) else Line(self.on, self.c + other, self.m)
    def __mul__(self, other):
        return Line(self.on, self.c * other, self.m * other)

def spectral(matrix):  # at most the largest singular value of all in it
    middle = arb_mat(matrix.nrows(), matrix.ncols(), [x.mid() for x in matrix.entries()])
    return (largest(middle * middle.transpose(), 30).sqrt() + length_of(x.rad() for x in matrix.entries())).abs_upper()
def together(columns, sizes):  # |sum of columns times numbers|, those of such sizes: one by one, or by their length
    if not columns:
        return ZERO
    scaled = [[x * size for x in column] for column, size in zip(columns, sizes)]
    one, all = sum(length_of(column) for column in scaled), spectral(arb_mat(scaled)) * arb(len(sizes)).sqrt()
    return one.min(all).abs_upper()
def frame_of(rows):  # W with W Q near these rows, those of Q orthonormal, the diagonal of W above 0
    found, lower = [], []
    for row in rows:
        left, along = list(row), []
        for unit in found:
            along.append(sum(x * u for x, u in zip(left, unit)))
            left = [x - along[-1] * u for x, u in zip(left, unit)]
        long = max(sum(x * x for x in left) ** 0.5, 1e-12 * sum(x * x for x in row) ** 0.5, 1e-150)
        found.append([x / long for x in left])
        lower.append(along + [long])
    return arb_mat([row + [0] * (len(rows) - len(row)) for row in lower])

# ---- Motions under held torques
def combined(rows, forms):  # rows of numbers times forms
    return [total(form.h * x for form, x in zip(forms, row)) for row in rows]

def piece(robot, x, torques, length):  # from the forms x, under the forms of torques
    n = len(torques)
    inner = x[:n] + [motor - link for link, motor in zip(x, x[n:2 * n])] + x[2 * n:] + torques  # with deflections for motor positions: springs bend little
    sizes = [form.radius() + arb(2) ** -300 for form in inner]
    on = Domain(0, len(inner))
    def within(part):  # the beginning, so far around the middle
        start = [on.along(form.c, [size * part if i == j else ZERO for j in range(on.size)]) for i, (form, size) in enumerate(zip(inner, sizes))]
        start[n:2 * n] = [link + bent for link, bent in zip(start, start[n:2 * n])]
        return start[:len(x)], start[len(x):]
    x0, u = within(1)
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
    # Slopes at a point are those in the middle and the mean of second derivatives on the way there, times the way: in nearer parts of the box they are known more closely (as in law_at)
    after, nearer = [], [(part, sum(robot.motion(*within(part))[2], [])) for part in PARTS]
    def along(series, end):
        for k in reversed(range(order + 1)):
            end = end * length + series[k]
        return end
    for i, (series, late) in enumerate(zip(exact, rest)):
        end, last = along(series, late[order + 1]), late[order + 1].h * length ** (order + 1)
        bends = [end.h] + [along(series[i], ZERO).h / (part * part) + last for part, series in nearer]
        by = [slope / size for slope, size in zip(end.g.entries(), sizes)]
        bent = across.transpose() * (total(bends) / len(bends)) * across
        after.append(Form(x[0].on, end.c, end.g * straight, bent + combined([by], inner)[0]))
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
        self.m, self.off = self.n * ((8 if self.filter else 4) + self.waiting), loop["off"]
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
        if self.off:
            q = [x + Line(x.on, ZERO, arb_mat(1, x.m.ncols(), [int(x.m.ncols() - 2 * self.n + i == j) for j in range(x.m.ncols())])) for i, x in enumerate(q)]
        if not self.filter:
            return q + v, []
        (a1, a2), (b0, b1) = self.filter["feedback"], self.filter["forward"]
        v = [x * b0 + r for x, r in zip(q, r1)]
        return q + v, [x * (b1 - b0) + y * a1 + r for x, y, r in zip(q, v, r2)] + [y * a2 - x * b1 for x, y in zip(q, v)]
    def later(self, x, queue):  # the motion x a period later
        for torques, length in zip(queue, self.lengths):
            x = held(self.robot, x, torques, length)
        return x
    def law_at(self, k, seen):  # what the law asks for at instant k
        span = self.h.low * k, self.h.high * k
        at = reference(self.file["reference"], enclosing(*span), span, self.begins)
        found = [self.law.asked(at, [Form(form.on, form.c, form.g * part, form.h * part ** 2) for form in seen]) for part in LAW_PARTS]
        return [Form(all[-1].on, all[-1].c, all[-1].g, total(form.h / part ** 2 for form, part in zip(all, LAW_PARTS)) / len(LAW_PARTS)) for all in zip(*found)]
    def queue(self, state, asked):  # torques that act in a period, and that are on their way after it
        return [state[self.m - j * self.n:][:self.n] for j in range(self.waiting, 0, -1)] + [asked]
    def waits(self, state):
        return state[self.m - self.waiting * self.n:]

class Exact(Loop):
    def state(self, k):
        return self.sections[k].forms()
    def asked(self, k, state):
        return self.law_at(k, self.seen(state)[0])
    def moved(self, k, _, asked):  # as functions of y and w, torques asked for being c + g y + s w
        n, state = self.n, self.sections[k].forms(self.n)
        on = state[0].on
        queue = self.queue(state, [on.along(form.c, form.g.entries() + [LARGER * bend(form) if i == j else ZERO for j in range(n)]) for i, form in enumerate(asked)])
        return self.later(state[:4 * n], queue) + self.seen(state)[1] + sum(queue[1:], [])
    def steps(self, k, after):  # lambda, rho and sigma. |w_j| is at most 1/(2 LARGER) and changes by at most 1/LARGER of what y does
        inverse = self.sections[k + 1].inverse()
        columns = flipped((inverse * stacked([form.g for form in after])).tolist())
        slopes, of_w, part = arb_mat(columns[:self.m]), sum(length_of(column) for column in columns[self.m:]), self.n / arb(LARGER) ** 2
        bent = largest(total(h.transpose() * h for h in combined(inverse.tolist(), after)), 6) * (1 + part) * (1 + part / 4)
        growth = largest(slopes * slopes.transpose(), 30).sqrt() + of_w / LARGER + bent.sqrt()
        return growth.abs_upper(), self.sections[k + 1].reach([form.c for form in after]), ZERO
    def within(self, k):  # how far readings have moved positions
        return [ZERO] * 2 * self.n
    def needed(self, followed, count):
        return range(count + 1)

class Counted(Loop):  # readings are off. Columns are those of y, of what torques are beside their slopes, of P, of readings now
    past, at = [], -1  # P by columns, and of which instant
    def needed(self, followed, count):
        kept = self.file["kept"]
        return {k for last in followed for k in range(last + kept[last] // (-2 * self.n), last + 1)} | {0}
    def state(self, k):
        if k != self.at:  # from here on anew
            self.past, self.at = [], k
        n, section = self.n, self.sections[k]
        on = Others(self.m, [ZERO] * n + [ONE] * len(self.past) + self.off)
        return [Line(on, c, arb_mat(1, self.m + len(on.most), row + [ZERO] * n + [x[i] for x in self.past] + [ZERO] * 2 * n))
                for i, (c, row) in enumerate(zip(section.c, section.rows))]
    def framed(self, lines):  # as functions of y and of as many numbers in [-1, 1], and these as lines of all but y
        m, on, all = self.m, lines[0].on, [line.m.entries() for line in lines]
        frame = frame_of([[float(x.mid()) for x in row[m:]] for row in all])
        by = (frame.inv() * arb_mat([row[m:] for row in all])).tolist()
        sizes, inner = [on.reach([ZERO] * m + row) + arb(2) ** -300 for row in by], Domain(m, m + len(lines))
        forms = [inner.along(line.c, row[:m] + [w * size for w, size in zip(scale, sizes)]) for line, row, scale in zip(lines, all, frame.tolist())]
        return forms, arb_mat([[x / size for x in row] for row, size in zip(by, sizes)])
    def line(self, on, form, by):  # without what is of second order
        g = form.g.entries()
        return Line(on, form.c, arb_mat([g[:self.m] + (arb_mat([g[self.m:]]) * by).entries()]))
    def parted(self, h):  # second derivatives by y, by y and others, and by others
        rows = h.tolist()
        return [arb_mat([row[part] for row in rows[:self.m]]) for part in (slice(self.m), slice(self.m, None))] + [arb_mat([row[self.m:] for row in rows[self.m:]])]
    def asked(self, k, state):
        seen, on = self.seen(state)[0], state[0].on
        forms, by = self.framed(seen)
        found = self.law_at(k, forms)
        for j, form in enumerate(found):
            of_y, of_both, of_others = self.parted(form.h)
            on.slopes[j] = (spectral(of_y) + length_of(sum((abs(x) for x in row), ZERO) for row in of_both.tolist())).abs_upper()
            on.most[j] = (sum((abs(x) for x in of_others.entries()), ZERO) / 2).abs_upper()
        asked = [self.line(on, form, by) for form in found]
        return [Line(on, line.c, line.m + arb_mat(1, line.m.ncols(), [int(i == self.m + j) for i in range(line.m.ncols())])) for j, line in enumerate(asked)]
    def moved(self, k, state, asked):
        n, queue = self.n, self.queue(state, asked)
        forms, self.by = self.framed(state[:4 * n] + sum(queue[:len(self.lengths)], []))
        self.motion = self.later(forms[:4 * n], [forms[j * n:][:n] for j in range(4, 4 + len(self.lengths))])
        return [self.line(state[0].on, form, self.by) for form in self.motion] + self.seen(state)[1] + sum(queue[1:], [])
    def steps(self, k, after):  # P_{k+1} are the middles of the latest columns
        n, m, section, columns, on = self.n, self.m, self.sections[k + 1], flipped([line.m.entries() for line in after]), after[0].on
        scaled = [[x * most for x in column] for column, most in zip(columns[m + n:], on.most[n:])]
        dropped = max(0, len(scaled) - self.file["kept"][k + 1])
        self.past, self.at = [[x.mid() for x in column] for column in scaled[dropped:]], k + 1
        inverse = section.inverse()
        def back(all):
            return flipped((inverse * arb_mat(flipped(all))).tolist()) if all else []
        beside, of_torques = [sum((abs(column[i] - column[i].mid()) for column in scaled[dropped:]), ZERO).abs_upper() for i in range(m)], back(columns[m:m + n])
        bends = [self.parted(h) for h in combined([row[:4 * n] for row in inverse.tolist()], self.motion)]
        by_y, count = largest(total(h.transpose() * h for h, _, _ in bends), 6).sqrt(), self.by.nrows()
        by_both = [length_of(h[i, j] for _, h, _ in bends for i in range(m)) for j in range(count)]
        by_others = [[length_of(h[i, j] for _, _, h in bends) for j in range(count)] for i in range(count)]
        by_slopes = [sum(abs(x) * slope for x, slope in zip(row, on.slopes[:n])) for row in self.by.tolist()]
        growth = spectral(arb_mat(back(columns[:m]))) + together(of_torques, on.slopes[:n]) + by_y + sum(by_both)
        growth += sum(slope * (both + sum(others)) for slope, both, others in zip(by_slopes, by_both, by_others))
        noise = together(of_torques, on.most[:n]) + together(back(scaled[:dropped]), [ONE] * dropped) + length_of((up(inverse) * arb_mat(m, 1, beside)).entries())
        noise += sum(sum(others) for others in by_others) / 2
        return growth.abs_upper(), section.reach([line.c for line in after]), noise.abs_upper()
    def within(self, k):
        return [sum((abs(column[i]) for column in self.past), ZERO) for i in range(2 * self.n)]
def up(matrix):  # what no entry is larger than
    return arb_mat(matrix.nrows(), matrix.ncols(), [x.abs_upper() for x in matrix.entries()])

def check(data, options):
    file = read_tube(data)
    loop, claims, count = (Counted if file["loop"]["off"] else Exact)(file), file["claims"], file["periods"]
    every = options.all or options.sample >= count
    limit, worst, away = (-claims["rate"] * loop.h).exp(), ZERO, loop.sections[0].reach(loop.start())
    need(away <= 1, f"the start is not in E_0: |y| is {float(away):.6g}")
    def errors_fit(k, times, beside):
        for i, (row, more, claim) in enumerate(zip(loop.sections[k].rows, beside, claims["error"])):
            most = length_of(row) * times + more
            need(most <= claim, f"error: position {i + 1} is up to {float(most):.10g} rad off at instant {k}")
    def torques_fit(k, all):
        for i, form in enumerate(all):
            most = form.range().abs_upper()
            need(most <= claims["torque"][i % loop.n], f"torque: {float(most):.10g} N m at joint {i % loop.n + 1}, instant {k}")
    for k in range(count + 1):
        errors_fit(k, ONE, [ZERO] * 2 * loop.n)
    torques_fit(0, loop.waits(loop.state(0)))
    followed = chosen(options, count)
    for k in range(count + 1) if every else sorted(loop.needed(followed, count)):
        state = loop.state(k)
        asked, whole = loop.asked(k, state), every or k in followed or not loop.off
        if whole:
            torques_fit(k, asked)
            errors_fit(k, 1 + away if every else ONE, loop.within(k))
        if k in followed or k < count and loop.off:
            growth, offset, noise = loop.steps(k, loop.moved(k, state, asked))
        if k in followed:
            need(growth + offset + noise <= 1, f"period {k}: lambda {float(growth):.9g}, rho {float(offset):.3g} and sigma {float(noise):.3g} are more than 1 together")
            need(growth <= limit, f"rate: lambda is {float(growth):.10g} in period {k}, must be at most {float(limit):.10g}")
            worst, away = worst.max(growth), (growth * away + offset).abs_upper()
    some = f"all {count} periods" if every else f"periods {', '.join(map(str, followed))} of {count}, error without |y| of the run"
    return f"{some}: largest lambda {float(worst):.9f} where {float(limit):.9f} is claimed"

if __name__ == "__main__":
    sys.exit(main(check, "tube", "control period"))
