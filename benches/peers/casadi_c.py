"""CasADi's side: writes C for the works, as straight lines of scalar operations, from the bodies of Flexure's robots.

The formulation is the cheapest that we know of: Newton-Euler with three vectors a body on truncated Taylor series, one sine and
cosine a joint for everything, a dense mass matrix with LDL^T, common subexpressions removed.
usage: casadi_c.py MODEL.json FOLDER WORK
"""

import json
import sys

import casadi as ca


class Jet:
    """A truncated Taylor series in time, normalised coefficients; a number is a series of one."""

    def __init__(self, c):
        self.c = list(c)

    def __add__(self, other):
        return Jet(a + b for a, b in zip(self.c, lift(other, len(self.c)).c))

    def __sub__(self, other):
        return Jet(a - b for a, b in zip(self.c, lift(other, len(self.c)).c))

    def __mul__(self, other):
        if not isinstance(other, Jet):
            return Jet(a * other for a in self.c)
        return Jet(
            sum((self.c[j] * other.c[k - j] for j in range(1, k + 1)), self.c[0] * other.c[k])
            for k in range(len(self.c))
        )

    __rmul__ = __mul__

    def of(self, orders):
        return Jet(self.c[:orders])

    def rate(self):
        return Jet((k + 1) * c for k, c in enumerate(self.c[1:]))


def lift(x, orders):
    return x if isinstance(x, Jet) else Jet([x] + [0] * (orders - 1))


def sine_cosine(q, s0, c0):
    """Series of sin q and cos q from their values."""
    s, c = [s0], [c0]
    for k in range(1, len(q.c)):
        s.append(sum(j * q.c[j] * c[k - j] for j in range(1, k + 1)) / k)
        c.append(-sum(j * q.c[j] * s[k - j] for j in range(1, k + 1)) / k)
    return Jet(s), Jet(c)


def tanh(x):
    y = [ca.tanh(x.c[0])]
    slope = [1 - y[0] * y[0]]  # 1 - y^2
    for k in range(1, len(x.c)):
        y.append(sum(j * x.c[j] * slope[k - j] for j in range(1, k + 1)) / k)
        slope.append(-sum((y[j] * y[k - j] for j in range(1, k + 1)), y[0] * y[k]))
    return Jet(y)


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def cross(a, b):
    return [
        term(a[1], b[2]) - term(a[2], b[1]),
        term(a[2], b[0]) - term(a[0], b[2]),
        term(a[0], b[1]) - term(a[1], b[0]),
    ]


def term(x, y):
    return x * y if isinstance(x, Jet) else y * x


def times(matrix, v):
    """A constant matrix times a vector of series."""
    return [v[0] * row[0] + v[1] * row[1] + v[2] * row[2] for row in matrix]


def transposed(matrix):
    return [list(column) for column in zip(*matrix)]


class Arm:
    """Revolute joints about z, one after the other."""

    def __init__(self, model, q):
        self.bodies, self.gravity = model["bodies"], model["gravity"]
        self.planar = all(x == 0.0 for x in model["gravity"])
        # Sine and cosine of each angle, once.
        self.sines = [(ca.sin(q[i]), ca.cos(q[i])) for i in range(len(self.bodies))]

    def inverse_dynamics(self, q, v, v_r, a_r, gravity=True):
        """M a_r + C v_r + g on series, C from the Christoffel symbols."""
        n, orders = len(q), len(q[0].c)
        zero = Jet([ca.SX(0)] * orders)
        turns = [sine_cosine(q[i], *self.sines[i]) for i in range(n)]
        w, wr, al = [[zero] * 3 for _ in range(3)]
        a = [lift(ca.SX(-g), orders) if gravity else zero for g in self.gravity]
        forces = []
        for i, body in enumerate(self.bodies):
            s, c = turns[i]
            inward = transposed(body["rotation"])

            def turned(x, inward=inward, s=s, c=c):
                x = times(inward, x)
                return [c * x[0] + s * x[1], c * x[1] - s * x[0], x[2]]

            p = body["translation"]
            a = add(a, add(cross(al, p), cross(wr, cross(w, p))))
            w, wr, al, a = turned(w), turned(wr), turned(al), turned(a)
            # d/dt of the reference's angular velocity in the body's frame, plus w x (z v_r).
            al = [al[0] + w[1] * v_r[i], al[1] - w[0] * v_r[i], al[2] + a_r[i]]
            w, wr = [w[0], w[1], w[2] + v[i]], [wr[0], wr[1], wr[2] + v_r[i]]
            m, h, inertia = constants(body)
            spread = [[(sum(inertia[k][k] for k in range(3)) / 2 if j == k else 0.0) - inertia[j][k] for k in range(3)] for j in range(3)]
            force = add([x * m for x in a], add(cross(al, h), cross(wr, cross(w, h))))
            moment = add(times(inertia, al), add(cross(times(spread, wr), w), [term(x, -1.0) for x in cross(a, h)]))
            forces.append((force, moment))
        torque = [None] * n
        for i in reversed(range(n)):
            force, moment = forces[i]
            torque[i] = moment[2]
            if i > 0:
                s, c = turns[i]
                rotation, p = self.bodies[i]["rotation"], self.bodies[i]["translation"]

                def outward(x, rotation=rotation, s=s, c=c):
                    return times(rotation, [c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]])

                force, moment = outward(force), outward(moment)
                moment = add(moment, [term(x, -1.0) for x in cross(force, p)])
                forces[i - 1] = (add(forces[i - 1][0], force), add(forces[i - 1][1], moment))
        return torque

    def mass_matrix(self):
        """Composite bodies: mass, first moment, inertia about the joint, summed from the tip."""
        n = len(self.bodies)
        mass = [[None] * n for _ in range(n)]
        composite = None
        for i in reversed(range(n)):
            own = constants(self.bodies[i])
            composite = own if composite is None else sum_of(own, composite)
            m, h, inertia = composite
            # Unit acceleration of joint i: force z x h, moment I z about its origin.
            force, moment = [-h[1], h[0], 0.0], [inertia[0][2], inertia[1][2], inertia[2][2]]
            mass[i][i] = moment[2]
            for j in reversed(range(i)):
                force, moment = self.moved(j + 1, force, moment)
                mass[i][j] = mass[j][i] = moment[2]
            if i > 0:
                composite = self.carried(i, composite)
        return mass

    def moved(self, i, force, moment):
        """A force and a moment in the frame of body i, in that of the body before."""
        force, moment = self.outward(i, force), self.outward(i, moment)
        p = self.bodies[i]["translation"]
        return force, add(moment, plain_cross(p, force))

    def outward(self, i, x):
        s, c = self.sines[i]
        return times(self.bodies[i]["rotation"], [c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]])

    def carried(self, i, composite):
        m, h, inertia = composite
        columns = [self.outward(i, column) for column in transposed(inertia)]
        rotated = [self.outward(i, row) for row in transposed(columns)]
        rotated = [[rotated[max(j, k)][min(j, k)] for k in range(3)] for j in range(3)]
        h, p = self.outward(i, h), self.bodies[i]["translation"]
        dot = 2 * sum(a * b for a, b in zip(h, p)) + m * sum(x * x for x in p)
        shifted = [
            [rotated[j][k] - h[j] * p[k] - p[j] * h[k] - m * p[j] * p[k] + (dot if j == k else 0.0) for k in range(3)]
            for j in range(3)
        ]
        return m, [a + m * b for a, b in zip(h, p)], shifted


def plain_cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def sum_of(a, b):
    return a[0] + b[0], add(a[1], b[1]), [add(x, y) for x, y in zip(a[2], b[2])]


def constants(body):
    """Mass, first moment and inertia about the origin of the link frame."""
    m, r, inertia = body["mass"], body["com"], body["inertia"]
    square = sum(x * x for x in r)
    about = [[inertia[j][k] + m * ((square if j == k else 0.0) - r[j] * r[k]) for k in range(3)] for j in range(3)]
    return m, [m * x for x in r], about


def factor(mass):
    """LDL^T: L below the diagonal, 1/D."""
    n = len(mass)
    low, inverse, scaled = [[None] * n for _ in range(n)], [None] * n, [[None] * n for _ in range(n)]
    for j in range(n):
        d = mass[j][j]
        for k in range(j):
            d = d - low[j][k] * scaled[j][k]
        inverse[j] = 1 / d
        for i in range(j + 1, n):
            x = mass[i][j]
            for k in range(j):
                x = x - low[i][k] * scaled[j][k]
            scaled[i][j], low[i][j] = x, x * inverse[j]
    return low, inverse


def solve(factored, b):
    low, inverse = factored
    n, x = len(inverse), list(b)
    for i in range(n):
        for k in range(i):
            x[i] = x[i] - low[i][k] * x[k]
    x = [x[i] * inverse[i] for i in range(n)]
    for i in reversed(range(n)):
        for k in range(i + 1, n):
            x[i] = x[i] - low[k][i] * x[k]
    return x


def law(model, q_l, q_m, v_l, v_m, *reference):
    """The v-CBC law with tanh on both sides."""
    n, K, D = len(q_l), model["stiffness"], model["link_damping"]
    arm = Arm(model, q_l)
    factored = factor(arm.mass_matrix())
    one = [Jet([x]) for x in v_l]
    bias = arm.inverse_dynamics([Jet([x]) for x in q_l], one, one, [Jet([ca.SX(0)])] * n)
    a = solve(factored, [K[i] * (q_m[i] - q_l[i]) - D[i] * v_l[i] - bias[i].c[0] for i in range(n)])
    v = [Jet([v_l[i], a[i]]) for i in range(n)]
    along = arm.inverse_dynamics([Jet([q_l[i], v_l[i]]) for i in range(n)], v, v, [Jet([x, ca.SX(0)]) for x in a])
    jerk = solve(factored, [K[i] * (v_m[i] - v_l[i]) - D[i] * a[i] - along[i].c[1] for i in range(n)])
    motion = [Jet([q_l[i], v_l[i], a[i] / 2, jerk[i] / 6]) for i in range(n)]
    factorial = [1, 1, 2, 6, 24]
    q_d = [Jet(reference[k][i] / factorial[k] for k in range(5)) for i in range(n)]
    link, motor = model["link"], model["motor"]
    error = [x - d.of(4) for x, d in zip(motion, q_d)]
    v_r = [d.rate() - tanh(e) * gain for d, e, gain in zip(q_d, error, link["shaping"])]
    s_l = [x.rate() - r.of(3) for x, r in zip(motion, v_r)]
    torque = arm.inverse_dynamics(
        [x.of(3) for x in motion], [x.rate() for x in motion], [r.of(3) for r in v_r], [r.rate() for r in v_r]
    )
    u_m = []
    for i in range(n):
        u_l = torque[i] + v_r[i].of(3) * D[i] - error[i].of(3) * link["metric"][i] - s_l[i] * link["damping"][i]
        q_md = motion[i].of(3) + u_l * (1 / K[i])
        e_m = Jet([q_m[i], v_m[i]]) - q_md.of(2)
        v_mr = q_md.rate() - tanh(e_m) * motor["shaping"][i] - s_l[i].of(2) * (K[i] / motor["metric"][i])
        u_m.append(
            model["motor_inertia"][i] * v_mr.c[1]
            + K[i] * (q_m[i] - q_l[i])
            + model["motor_damping"][i] * v_mr.c[0]
            - motor["metric"][i] * e_m.c[0]
            - motor["damping"][i] * (v_m[i] - v_mr.c[0])
        )
    return u_m


def rnea(model, q, v, a):
    speeds = [Jet([x]) for x in v]
    torque = Arm(model, q).inverse_dynamics([Jet([x]) for x in q], speeds, speeds, [Jet([x]) for x in a])
    return [x.c[0] for x in torque]


def forward_dynamics(model, q, v, torque):
    arm = Arm(model, q)
    speeds = [Jet([x]) for x in v]
    bias = arm.inverse_dynamics([Jet([x]) for x in q], speeds, speeds, [Jet([ca.SX(0)])] * len(q))
    return solve(factor(arm.mass_matrix()), [t - b.c[0] for t, b in zip(torque, bias)])


def rates(model, *derivatives):
    factorial = [1, 1, 2, 6, 24]
    series = [Jet(x / f for x, f in zip(row, factorial)) for row in zip(*derivatives)]
    v = [x.rate() for x in series]
    torque = Arm(model, derivatives[0]).inverse_dynamics(
        [x.of(3) for x in series], [x.of(3) for x in v], [x.of(3) for x in v], [x.rate() for x in v]
    )
    return [torque[i].c[k] * (1, 1, 2)[k] for k in range(3) for i in range(len(torque))]


def crba(model, q):
    return [entry for row in Arm(model, q).mass_matrix() for entry in row]


WORKS = {
    "law2": ("two_link", law, 9),
    "law7": ("panda", law, 9),
    "rnea7": ("panda", rnea, 3),
    "fd7": ("panda", forward_dynamics, 3),
    "rates7": ("panda", rates, 5),
    "crba7": ("panda", crba, 1),
}


def main(model, folder, name):
    robot, work, vectors = WORKS[name]
    model = json.load(open(model))[robot]
    n = len(model["bodies"])
    inputs = ca.SX.sym("x", n * vectors)
    rows = [[inputs[n * i + j] for j in range(n)] for i in range(vectors)]
    outputs = ca.cse(ca.vertcat(*work(model, *rows)))
    function = ca.Function("work", [inputs], [outputs])
    function.generate(f"{name}.c", {"with_header": False, "casadi_int": "long long"})
    print(function.n_instructions())


if __name__ == "__main__":
    import os

    model, folder, name = sys.argv[1:]
    model = os.path.abspath(model)
    os.chdir(folder)
    main(model, folder, name)
