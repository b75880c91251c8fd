#!/usr/bin/env python3
"""Writes tests/golden/divergence.json: how many times as large small differences of the start are at the end of the labs of
tests/precision/kinds.md.

    tests/golden/divergence.py > tests/golden/divergence.json      # numpy on a machine whose long double has 64 bits of mantissa

The equations are those of precision.py, by hand, with what it leaves out: the place and the orientation of the free body. A difference
is one of joint coordinates and velocities; the flow's derivative is taken by central differences in numbers of 19 digits. Labs with
contacts and dry friction are followed until shortly before the first force that jumps, where the flow is known in closed form.
"""
import importlib.util, json, pathlib, sys

import numpy as np

spec = importlib.util.spec_from_file_location("precision", pathlib.Path(__file__).with_name("precision.py"))
p = importlib.util.module_from_spec(spec)
spec.loader.exec_module(p)
L, G, num, array = p.L, p.G, p.num, p.array
APART = L(1e-8)
DIRECTIONS = 3


def directions(n):
    """The directions that `labspec stability` takes: xorshift64 from seeds 1, 2, 3, in the order of coordinates and velocities."""
    mask = (1 << 64) - 1
    for seed in range(1, DIRECTIONS + 1):
        bits = seed * 0x9E3779B97F4A7C15 & mask | 1
        values = []
        for _ in range(n):
            bits ^= bits << 13 & mask
            bits ^= bits >> 7
            bits ^= bits << 17 & mask
            values.append((bits >> 11) / (1 << 53) - 0.5)
        values = np.array(values, dtype=L)
        yield values / np.sqrt(values @ values)


class Recorded(Exception):
    pass


def equations(kind):
    """What a kind of precision.py hands to its integrator."""
    kept = {}

    def smooth(f, y, end, traces, h, breaks=()):
        kept.update(f=f, y=y, end=end, h=L(h), breaks=breaks)
        raise Recorded

    before, p.smooth = p.smooth, smooth
    try:
        kind()
    except Recorded:
        pass
    p.smooth = before
    return kept


def growth(flow, n):
    """The norm of a difference of length 1 at the end, for each direction. `flow` takes a difference of the start to one of the end."""
    found = []
    for d in directions(n):
        ahead, back = flow(APART * d), flow(-APART * d)
        change = (ahead - back) / (2 * APART)
        found.append(float(np.sqrt(change @ change)))
    return dict(low=min(found), high=max(found))


def plain(kind, to=None):
    """Of equations whose state is coordinates and velocities, or becomes it by a matrix."""
    e = equations(kind)
    n = len(e["y"])
    to = np.eye(n, dtype=L) if to is None else to
    inverse = np.array(np.linalg.inv(to.astype(float)), dtype=L)
    flow = lambda d: inverse @ p.run(e["f"], e["y"] + to @ d, e["end"], e["h"], e["breaks"])[-1][1]
    return dict(growth(flow, n), until=float(e["end"]))


def relative(n):
    """Absolute angles of a chain from those of its joints."""
    one = np.tril(np.ones((n, n), dtype=L))
    zero = np.zeros((n, n), dtype=L)
    return np.block([[one, zero], [zero, one]])


def product(a, b):
    """Of quaternions, w first."""
    w = a[0] * b[0] - a[1:] @ b[1:]
    return np.concatenate([[w], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])])


def turned(v):
    """The quaternion of a rotation vector."""
    angle = np.sqrt(v @ v)
    return np.concatenate([[np.cos(angle / 2)], v * (np.sin(angle / 2) / angle if angle else L(0.5))])


def vector(q):
    """The rotation vector of a quaternion."""
    q = q if q[0] >= 0 else -q
    size = np.sqrt(q[1:] @ q[1:])
    return q[1:] * (2 * np.arctan2(size, q[0]) / size if size else L(2))


def turning(f, rate, quat, end, h):
    """A body that turns: differences of its orientation, in its own frame, and of its angular velocity."""

    def whole(t, y, inside):
        q, w = y[:4], y[4:]
        return np.concatenate([product(q, np.concatenate([[L(0)], w])) / 2, f(t, q, w)])

    def last(d):
        start = np.concatenate([product(quat, turned(d[:3])), rate + d[3:]])
        y = p.run(whole, start, end, h)[-1][1]
        return y[:4] / np.sqrt(y[:4] @ y[:4]), y[4:]

    q0, w0 = last(np.zeros(6, dtype=L))
    inverse = q0 * np.array([1, -1, -1, -1], dtype=L)

    def flow(d):
        q, w = last(d)
        return np.concatenate([vector(product(inverse, q)), w - w0])

    return flow


def intermediate():
    end = L(4)
    i1, i2, i3 = array(0.01, 0.02, 0.025)
    euler = lambda t, q, w: np.array(
        [(i2 - i3) * w[1] * w[2] / i1, (i3 - i1) * w[2] * w[0] / i2, (i1 - i2) * w[0] * w[1] / i3]
    )
    turn = turning(euler, array(0.1, 6, 0.05), array(1, 0, 0, 0), end, L(4e-3))

    def flow(d):
        # Places, rotation, velocities, angular velocities; the centre of mass moves freely.
        place, rotation, speed, rate = d[:3], d[3:6], d[6:9], d[9:]
        after = turn(np.concatenate([rotation, rate]))
        return np.concatenate([place + end * speed, after[:3], speed, after[3:]])

    return dict(growth(flow, 12), until=float(end))


def gyroscope():
    end, arm = L("1.6"), num(0.5)
    across, along = num(0.01) + arm ** 2, num(0.02)

    def f(t, q, w):
        w0, x, y, z = q
        down = np.array([-2 * (x * z - w0 * y), -2 * (y * z + w0 * x)])
        a, b, c = w
        return np.array([
            (-arm * G * down[1] - (along - across) * b * c) / across,
            (arm * G * down[0] - (across - along) * a * c) / across,
            L(0),
        ])

    start = np.array([np.cos(num(0.25)), np.sin(num(0.25)), 0, 0], dtype=L)
    return dict(growth(turning(f, array(0, 0, 200), start, end, L(5e-4)), 6), until=float(end))


def servo():
    """What is left of a difference is 1e-12 of it, so its own linear equation is integrated beside the motion."""
    inertia = num(0.5) * num(0.4) ** 2 + num(0.001)
    weight = num(0.5) * G * num(0.4)

    def f(t, y, _):
        q, v, a, b = y
        torque = weight * np.cos(q) + 2000 * (1 - q) - 10 * v
        return np.array([v, torque / inertia, b, (-(weight * np.sin(q) + 2000) * a - 10 * b) / inertia])

    end = num(0.48)
    flow = lambda d: p.run(f, np.concatenate([array(-0.2, 0), d]), end, L(1e-3))[-1][1][2:]
    return dict(growth(flow, 2), until=float(end))


def filter_():
    """The activation is that of the first run always: place and speed alone differ."""
    end = num(1.2)
    decay = np.exp(-end)
    flow = np.array([[1, 1 - decay], [0, decay]], dtype=L)
    return dict(growth(lambda d: flow @ d, 2), until=float(end))


def free(n, until):
    """Places and velocities of n degrees of freedom under forces that do not change."""
    t = num(until)
    flow = lambda d: np.concatenate([d[:n] + t * d[n:], d[n:]])
    return dict(growth(flow, 2 * n), until=until)


def slam():
    """Until shortly before it hits."""
    inertia = num(0.1) + 2 * num(0.6) ** 2
    f = lambda t, y, _: np.array([y[1], 2 * G * num(0.6) * np.cos(y[0]) / inertia])
    end = num(0.4)
    return dict(growth(lambda d: p.run(f, array(-0.3, 0) + d, end, L(2e-3))[-1][1], 2), until=float(end))


def square_wave():
    """The pushes depend on time alone."""
    e = equations(p.square_wave)
    f = lambda t, y, _: np.array([y[1], -10 * y[0] - num(0.3) * y[1]])
    flow = lambda d: p.run(f, d, e["end"], e["h"])[-1][1]
    return dict(growth(flow, 2), until=float(e["end"]))


KINDS = {
    "A stiff servo": servo,
    "A mass ratio of a thousand": lambda: plain(p.mass_ratio),
    "The intermediate axis": intermediate,
    "A spring pendulum, 2:1": lambda: plain(p.spring_pendulum),
    "A fast ball between walls": lambda: free(1, 0.014),
    "Van der Pol": lambda: plain(p.van_der_pol),
    "Heavy damping": lambda: plain(p.heavy_damping),
    "A long chain": lambda: plain(p.KINDS["A long chain"], relative(10)),
    "Gears with elastic teeth": lambda: plain(p.gears),
    "A gyroscope": gyroscope,
    "Dry friction": lambda: free(1, 1.2),
    "A pulley with an elastic rope": lambda: plain(p.pulley),
    "A double pendulum": lambda: plain(p.double_pendulum, relative(2)),
    "A driven oscillator": lambda: plain(p.driven),
    "A square wave": square_wave,
    "A slam": slam,
    "A pinball": lambda: free(6, 0.3),
    "Drag": lambda: plain(p.drag),
    "A filter": filter_,
    "A four-bar linkage with an elastic coupler": lambda: plain(p.four_bar),
    "A stack": lambda: free(2, 0.19),
}


if __name__ == "__main__":
    json.dump({title: kind() for title, kind in KINDS.items()}, sys.stdout, indent=1)
    print()
