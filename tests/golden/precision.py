#!/usr/bin/env python3
"""Writes tests/golden/precision.json: when things happen in the labs of tests/precision/kinds.md, and how they end.

    tests/golden/precision.py > tests/golden/precision.json      # numpy on a machine whose long double has 64 bits of mantissa

The equations are derived by hand for each lab (Lagrange's, Euler's, or a closed form), and are none of any engine's. They are
integrated by extrapolation of the midpoint rule to 16th order in numbers of 19 digits, with two steps that agree; times are found
by integrating again from the step before, to the last digit. Of labs with contacts, limits or dry friction only what is before the
first force that jumps is recorded.
"""
import json, sys

import numpy as np

L = np.longdouble
G = L("9.81")
SEQUENCE = [2, 4, 6, 8, 10, 12, 14, 16]
PASSES, TURNS = 1e-5, 1e-3


def num(text):
    return L(str(text))


def array(*values):
    return np.array([num(v) for v in values], dtype=L)


def gbs(f, t, y, h):
    """A step of Gragg's midpoint rule, extrapolated in the square of its substep."""
    rows = []
    for n in SEQUENCE:
        s = h / n
        before, now = y, y + s * f(t, y)
        for k in range(1, n):
            before, now = now, before + 2 * s * f(t + k * s, now)
        rows.append((before + now + s * f(t + h, now)) / 2)
    for j in range(1, len(rows)):
        for i in range(len(rows) - 1, j - 1, -1):
            ratio = (L(SEQUENCE[i]) / SEQUENCE[i - j]) ** 2
            rows[i] = rows[i] + (rows[i] - rows[i - 1]) / (ratio - 1)
    return rows[-1]


def root(f, t, y, h, g):
    """The time at which g(t, y) leaves its sign within a step, by halving."""
    low, high = L(0), h
    sign = np.sign(g(t, y))
    for _ in range(64):
        middle = (low + high) / 2
        if np.sign(g(t + middle, gbs(f, t, y, middle))) == sign:
            low = middle
        else:
            high = middle
    return t + (low + high) / 2


def run(f, y, end, h, breaks=()):
    """States at all steps; a step ends at each break."""
    times = sorted(set([L(0), num(end)] + [b for b in breaks if 0 < b < end]))
    states = [(L(0), y)]
    for a, b in zip(times, times[1:]):
        n = int(np.ceil((b - a) / h))
        for k in range(n):
            t = a + (b - a) * k / n
            y = gbs(lambda s, z, a=a, b=b: f(s, z, (a + b) / 2), t, y, (b - a) / n)
            states.append((a + (b - a) * (k + 1) / n, y))
    return states


def events(f, states, label, value, rate):
    """The first passage through zero and the first turning point, found in steps and refined."""
    found = {}
    values = [value(t, y) for t, y in states]
    size = max(values) - min(values)
    side, candidate = 0, None
    steps = list(zip(states, states[1:]))
    for k, v in enumerate(values):
        if k and side and v * side <= 0 < values[k - 1] * side:
            candidate = steps[k - 1]
        if abs(v) > PASSES * size:
            if side and np.sign(v) != side:
                (t, y), (after, _) = candidate
                middle = (t + after) / 2
                found[f'"{label}" passes through zero'] = root(lambda s, z: f(s, z, middle), t, y, after - t, value)
                break
            side = np.sign(v)
    low = high = values[0]
    way, best = 0, 0
    for k, v in enumerate(values):
        low, high = min(low, v), max(high, v)
        if not way:
            way = 1 if v - low > TURNS * size else -1 if high - v > TURNS * size else 0
            best = k
        elif (v - values[best]) * way > 0:
            best = k
        elif abs(v - values[best]) > TURNS * size:
            name = f'first {"maximum" if way > 0 else "minimum"} of "{label}"'
            for (t, y), (after, z) in steps[max(0, best - 1):best + 1]:
                middle = (t + after) / 2
                slope = lambda s, z: rate(z, f(s, z, middle))
                if slope(t, y) * way > 0 >= slope(after, z) * way:
                    found[name] = root(lambda s, z: f(s, z, middle), t, y, after - t, slope)
            break
    return found


def smooth(f, y, end, traces, h, breaks=()):
    """Events and end of a scene without jumps, with how far two steps differ."""
    both = []
    for step in (L(h), L(h) / 2):
        states = run(f, y, end, step, breaks)
        found = {}
        for label, value, rate in traces:
            found.update(events(f, states, label, value, rate))
        both.append((found, {label: value(*states[-1]) for label, value, _ in traces}))
    (found, ends), (finer, fine_ends) = both
    doubt = max([abs(found[k] - finer[k]) for k in finer] + [abs(ends[k] - fine_ends[k]) for k in fine_ends])
    return dict(events=finer, end=fine_ends, doubt=doubt)


def coordinate(i, label, scale=1):
    return label, lambda t, y: scale * y[i], lambda y, d: scale * d[i]


def solve(a, b):
    """Linear equations by elimination: numpy's own has no long doubles. The matrix is positive definite."""
    a, b, n = a.copy(), b.copy(), len(b)
    for i in range(n):
        for k in range(i + 1, n):
            m = a[k, i] / a[i, i]
            a[k, i:] -= m * a[i, i:]
            b[k] -= m * b[i]
    for i in range(n - 1, -1, -1):
        b[i] = (b[i] - a[i, i + 1:] @ b[i + 1:]) / a[i, i]
    return b


def servo():
    inertia = num(0.5) * num(0.4) ** 2 + num(0.001)

    def f(t, y, _):
        q, v = y
        torque = num(0.5) * G * num(0.4) * np.cos(q) + 2000 * (1 - q) - 10 * v
        return np.array([v, torque / inertia])

    return smooth(f, array(-0.2, 0), 0.48, [coordinate(0, "angle (rad)")], 1e-3)


def mass_ratio():
    def f(t, y, _):
        a, s, va, vs = y
        # 1000 a'' + (a + s)'' = -40000 a;  (a + s)'' = -100 s
        aa = (-40000 * a + 100 * s) / 1000
        return np.array([va, vs, aa, -100 * s - aa])

    traces = [coordinate(0, "large (m)"), coordinate(1, "small (m)")]
    # The point's own inertia does not turn.
    return smooth(f, array(0.1, -0.05, 0, 0), 2, traces, 4e-3)


def intermediate():
    i1, i2, i3 = array(0.01, 0.02, 0.025)

    def f(t, w, _):
        a, b, c = w
        return np.array([(i2 - i3) * b * c / i1, (i3 - i1) * c * a / i2, (i1 - i2) * a * b / i3])

    return smooth(f, array(0.1, 6, 0.05), 4, [coordinate(1, "spin (rad/s)"), coordinate(0, "along (rad/s)")], 4e-3)


def spring_pendulum():
    k, own = num(29.43), num(1e-6)

    def f(t, y, _):
        q, s, w, v = y
        r = 1 + s
        turn = (-G * r * np.sin(q) - 2 * r * v * w) / (r * r + own)
        return np.array([w, v, turn, r * w * w + G * np.cos(q) - k * s])

    traces = [coordinate(0, "angle (rad)"), coordinate(1, "stretch (m)")]
    return smooth(f, array(0.1, 0.8, 0, 0), 4, traces, 4e-3)


def fast_ball():
    return dict(events={"first contact": num(1.45) / 97, '"place (m)" passes through zero': num(0.5) / 97})


def van_der_pol():
    f = lambda t, y, _: np.array([y[1], 5 * (1 - y[0] ** 2) * y[1] - y[0]])
    return smooth(f, array(1, 0), 6, [coordinate(0, "x (m)")], 2e-3)


def heavy_damping():
    f = lambda t, y, _: np.array([y[1], -20 * y[1] - 50 * y[0]])
    return smooth(f, array(1, -60), 1.6, [coordinate(0, "x (m)")], 2e-3)


def chain(n, length, mass, own, start, end, traces, h):
    """Point masses on links, by absolute angles."""
    length, mass = num(length), num(mass)
    below = np.array([[mass * length ** 2 * (n - max(i, j)) for j in range(n)] for i in range(n)], dtype=L)
    turning = np.eye(n, dtype=L) * num(own)
    weight = np.array([mass * G * length * (n - i) for i in range(n)], dtype=L)

    def f(t, y, _):
        q, w = y[:n], y[n:]
        apart = q[:, None] - q[None, :]
        force = -(below * np.sin(apart)) @ (w * w) - weight * np.sin(q)
        return np.concatenate([w, solve(below * np.cos(apart) + turning, force)])

    y = np.concatenate([np.cumsum(array(*start)), np.zeros(n, dtype=L)])
    return smooth(f, y, end, traces, h)


def gears():
    i1, i2, d2 = array(0.02, 0.1, 0.05)

    def f(t, y, _):
        a, b, va, vb = y
        pull = -300 * (a + 2 * b) - num(0.2) * (va + 2 * vb)
        return np.array([va, vb, (pull + num(0.5)) / i1, (2 * pull - d2 * vb) / i2])

    mesh = "mesh (rad)", lambda t, y: y[0] + 2 * y[1], lambda y, d: d[0] + 2 * d[1]
    return smooth(f, array(0.4, -0.2, -3, 0), 1.2, [coordinate(1, "driven (rad)"), mesh], 2e-3)


def gyroscope():
    arm = num(0.5)
    across, along = num(0.01) + arm ** 2, num(0.02)

    def f(t, y, _):
        w, x, yy, z = y[:4]
        a, b, c = y[4:]
        # Downwards in the body's frame; its weight pulls at (0, 0, arm).
        down = np.array([-2 * (x * z - w * yy), -2 * (yy * z + w * x)])
        torque = np.array([-arm * G * down[1], arm * G * down[0]])
        rate = [(torque[0] - (along - across) * b * c) / across, (torque[1] - (across - along) * a * c) / across, L(0)]
        turn = [-(x * a + yy * b + z * c), w * a + yy * c - z * b, w * b + z * a - x * c, w * c + x * b - yy * a]
        return np.array([t / 2 for t in turn] + rate)

    height = (
        "height of the axis",
        lambda t, y: 1 - 2 * (y[1] ** 2 + y[2] ** 2),
        lambda y, d: -4 * (y[1] * d[1] + y[2] * d[2]),
    )
    start = np.concatenate([np.array([np.cos(num(0.25)), np.sin(num(0.25)), 0, 0], dtype=L), array(0, 0, 200)])
    return smooth(f, start, 1.6, [height, coordinate(4, "across (rad/s)")], 5e-4)


def friction():
    # It slides: x = -1 + 3 t - t².
    return dict(events={'"place (m)" passes through zero': (3 - np.sqrt(L(5))) / 2})


def pulley():
    def f(t, y, _):
        a, b, va, vb = y
        pull = -2000 * (a + b) - 3 * (va + vb)
        return np.array([va, vb, pull / 2 - G, pull - G])

    rope = "rope (m)", lambda t, y: y[0] + y[1], lambda y, d: d[0] + d[1]
    return smooth(f, array(1, -1, 0, 0), 1.2, [coordinate(0, "heavy (m)"), rope], 1e-3)


def double_pendulum():
    lower = "lower (rad)", lambda t, y: y[1] - y[0], lambda y, d: d[1] - d[0]
    return chain(2, 1, 1, 1e-6, (2, 0.5), 2.4, [coordinate(0, "upper (rad)"), lower], 2e-3)


def driven():
    f = lambda t, y, _: np.array([y[1], -10 * y[0] - num(0.3) * y[1] + 2 * np.cos(3 * t)])
    return smooth(f, array(0.2, 0), 4, [coordinate(0, "x (m)")], 4e-3)


def square_wave():
    pi = 4 * np.arctan(L(1))
    breaks = [(k * pi - num(0.1)) / 7 for k in range(1, 10)]

    def f(t, y, inside):
        push = np.sign(np.sin(7 * inside + num(0.1)))
        return np.array([y[1], -10 * y[0] - num(0.3) * y[1] + push])

    return smooth(f, array(0.2, 0), 4, [coordinate(0, "x (m)")], 4e-3, breaks)


def slam():
    inertia = num(0.1) + 2 * num(0.6) ** 2
    f = lambda t, y, _: np.array([y[1], 2 * G * num(0.6) * np.cos(y[0]) / inertia])
    states = run(f, array(-0.3, 0), 0.8, L(2e-3))
    gap = lambda t, y: 1 - num(1.2) * np.sin(y[0]) - num(0.1)
    plain = lambda t, y: f(t, y, None)
    found = {}
    for name, g in (("first contact", gap), ('"angle (rad)" passes through zero', lambda t, y: y[0])):
        start = next(a for a, b in zip(states, states[1:]) if g(*a) * g(*b) <= 0)
        found[name] = root(plain, *start, L(2e-3), g)
    return dict(events=found)


def halved(g, low, high):
    low, high = L(low), L(high)
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if g(middle) > 0 else (low, middle)
    return (low + high) / 2


def pinball():
    height = lambda t: num(0.95) + num(1.7) * t - G * t * t / 2
    gap = lambda t: np.sqrt((2 - 5 * t) ** 2 + (height(t) - 1) ** 2) - num(0.35)
    return dict(
        events={
            "first contact": halved(gap, 0, 0.4),
            '"height (m)" passes through zero': halved(lambda t: 1 - height(t), 0, 0.1),
            'first maximum of "height (m)"': num(1.7) / G,
        }
    )


def drag():
    f = lambda t, y, _: np.array([y[1], -G - num(0.2) * y[1] * abs(y[1])])
    return smooth(f, array(5, 0), 2, [coordinate(0, "height (m)")], 2e-3)


def filter_():
    f = lambda t, y, _: np.array([y[1], 3 * (1 - np.exp(-5 * t)) - y[1]])
    force = "force (N)", lambda t, y: 3 * (1 - np.exp(-5 * t)), lambda y, d: L(1)
    return smooth(f, array(-0.1, -0.3), 1.2, [coordinate(0, "place (m)"), force], 2e-3)


def four_bar():
    la, lb, ma, mb, own = array(0.5, 0.8, 1, 0.7, 1e-6)

    def f(t, y, _):
        a, b, va, vb = y
        x = 1 - lb * np.sin(b) + la * np.sin(a)
        z = -lb * np.cos(b) + la * np.cos(a)
        length = np.sqrt(x * x + z * z)
        by_a = (x * la * np.cos(a) - z * la * np.sin(a)) / length
        by_b = (-x * lb * np.cos(b) + z * lb * np.sin(b)) / length
        pull = -800 * (length - num(1.04)) - 2 * (by_a * va + by_b * vb)
        return np.array([
            va, vb,
            (pull * by_a - ma * G * la * np.sin(a)) / (ma * la * la + own),
            (pull * by_b - mb * G * lb * np.sin(b)) / (mb * lb * lb + own),
        ])

    traces = [coordinate(0, "crank (rad)"), coordinate(1, "rocker (rad)")]
    return smooth(f, array(0.9, 0.5, 0, 0), 1.6, traces, 1e-3)


def stack():
    t = np.sqrt(2 * num(0.2) / G)
    return dict(events={"first contact": t, '"lower (m)" passes through zero': t})


KINDS = {
    "A stiff servo": servo,
    "A mass ratio of a thousand": mass_ratio,
    "The intermediate axis": intermediate,
    "A spring pendulum, 2:1": spring_pendulum,
    "A fast ball between walls": fast_ball,
    "Van der Pol": van_der_pol,
    "Heavy damping": heavy_damping,
    "A long chain": lambda: chain(10, 0.2, 1, 1e-6, (1,) + (0,) * 9, 0.8, [coordinate(0, "first link (rad)")], 4e-3),
    "Gears with elastic teeth": gears,
    "A gyroscope": gyroscope,
    "Dry friction": friction,
    "A pulley with an elastic rope": pulley,
    "A double pendulum": double_pendulum,
    "A driven oscillator": driven,
    "A square wave": square_wave,
    "A slam": slam,
    "A pinball": pinball,
    "Drag": drag,
    "A filter": filter_,
    "A four-bar linkage with an elastic coupler": four_bar,
    "A stack": stack,
}


def main():
    truth = {}
    for title, kind in KINDS.items():
        found = kind()
        doubt = float(found.get("doubt", 0))
        print(f"{title}: two steps differ by {doubt:.1e}", file=sys.stderr)
        plain = lambda some: {k: float(v) for k, v in some.items()}
        truth[title] = dict(events=plain(found["events"]), end=plain(found.get("end", {})))
    json.dump(truth, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
