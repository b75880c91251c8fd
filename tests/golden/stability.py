#!/usr/bin/env python3
"""Stiff and extreme scenes, and what MuJoCo 3.14.0 makes of them: the cases of tests/stability.rs and docs/measured/stability.md.

    python3 -m venv mj && mj/bin/pip install mujoco==3.14.0 numpy
    mj/bin/python stability.py

A case is a model and a number of steps. Its outcome: the first warning with its time, or what the run came to: the
largest coordinate on the way, the largest speed at the end, the first coordinates at the end, and how far it went out of what the
case says it keeps (`keep`: a coordinate or a speed by its index, its lowest and highest value, on the way or at the end). A run
whose coordinates leave `bound`, or that goes out, without a warning went wrong silently. A search is a family of models over timesteps: the longest at which
the run stays within `bound` without a warning, all shorter ones included.
"""
import json
import pathlib

import mujoco
import numpy as np

HERE = pathlib.Path(__file__).parent
INTEGRATORS = ["Euler", "RK4", "implicit", "implicitfast", "discrete"]
TIMESTEPS = [1e-6, 1e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 0.1]
KEPT = 7
WARNINGS = {mujoco.mjtWarning.mjWARN_BADQPOS: "qpos", mujoco.mjtWarning.mjWARN_BADQVEL: "qvel",
            mujoco.mjtWarning.mjWARN_BADQACC: "qacc"}


def scene(body, option="", head="", tail=""):
    return (f"<mujoco><option {option}/><default>{head}</default><worldbody>{body}</worldbody>{tail}</mujoco>")


FLOOR = "<geom type='plane' size='50 50 1'/>"


def stack(masses, side=0.1):
    return FLOOR + "".join(
        f"<body pos='0 0 {side * (2 * i + 1):g}'><freejoint/><geom type='box' size='{side:g} {side:g} {side:g}' mass='{m:g}'/>"
        "</body>" for i, m in enumerate(masses))


def chain(masses):
    out = ""
    for m in reversed(masses):
        out = (f"<body pos='0 0 -.2'><joint axis='0 1 0' damping='.001'/><geom type='capsule' fromto='0 0 0 0 0 -.2' size='.02' "
               f"mass='{m:g}' contype='0' conaffinity='0'/>{out}</body>")
    return out.replace("pos='0 0 -.2'", "pos='0 0 2' euler='0 60 0'", 1)


def tied(masses):
    """Free balls, each tied to the one before it."""
    balls = "".join(f"<body name='b{i}' pos='{.2 * (i + 1):g} 0 2'><freejoint/><geom size='.05' mass='{m:g}' contype='0' "
                    "conaffinity='0'/></body>" for i, m in enumerate(masses))
    ties = "".join(f"<connect body1='b{i}' {f'''body2='b{i - 1}' ''' if i else ''}anchor='-.2 0 0'/>" for i in range(len(masses)))
    return balls, f"<equality>{ties}</equality>"


def ball(option="", contact="", speed=0):
    key = f"<keyframe><key qvel='0 0 {-speed} 0 0 0'/></keyframe>" if speed else ""
    body = FLOOR + "<body pos='0 0 .3'><freejoint/><geom size='.1' mass='1'/></body>"
    return scene(body, option, f"<geom {contact}/>", key)


def servo(kp, option, damping):
    body = ("<body><joint name='j' axis='0 1 0' damping='.01'/><geom type='capsule' fromto='0 0 0 .4 0 0' size='.03' mass='.5'/></body>")
    return scene(body, option, tail=f"<actuator><position joint='j' kp='{kp:g}' {damping}/></actuator>"
                 "<keyframe><key ctrl='1'/></keyframe>")


def keep(of, i, low, high, when="way"):
    return {"of": of, "i": i, "low": low, "high": high, "when": when}


def stands(n, side=0.1):
    """Boxes of a stack each of which has sunk by less than three tenths of its height in the end."""
    return [keep("qpos", 7 * i + 2, side * (2 * i + 1 - .6 * (i + 1)), 1e9, "end") for i in range(n)]


# A ball of radius 0.1 m that is never wholly in the floor, and in the end not by three tenths of its height.
ON_FLOOR = [keep("qpos", 2, -.1, 1e9), keep("qpos", 2, .04, 1e9, "end")]


def cases():
    """Section, name, model, seconds, steps, bound."""
    def case(section, name, xml, seconds=2.0, bound=10.0, h=None, long=0, keep=()):
        m = mujoco.MjModel.from_xml_string(xml)
        h = h or m.opt.timestep
        return {"section": section, "case": name, "xml": xml, "bound": bound, "long": long, "keep": list(keep),
                "steps": int(min(20000, max(20, round(seconds / h))))}

    for power in (0, 2, 3, 4, 6):
        r = 10.0 ** power
        yield case("Heavy on light", f"two boxes, 1:{r:g}", scene(stack([1, r])), keep=stands(2))
        yield case("Heavy on light", f"three boxes, 1:{r ** .5:.4g}:{r:g}", scene(stack([1, r ** .5, r])), keep=stands(3))
    yield case("Heavy on light", "two boxes, 1 g under 10 t", scene(stack([1e-3, 1e4])), keep=stands(2))
    for power in (0, 2, 4, 6):
        r = 10.0 ** power
        yield case("Chains", f"ten hinges, the last {r:g} times as heavy", scene(chain([1] * 9 + [r])), bound=1e3)
        yield case("Chains", f"ten hinges, the first {r:g} times as heavy", scene(chain([r] + [1] * 9)), bound=1e3)
        balls, ties = tied([1] * 4 + [r])
        yield case("Chains", f"five tied balls, the last {r:g} times as heavy", scene(balls, tail=ties))
    for cone in ("pyramidal", "elliptic"):
        for solver in ("Newton", "CG", "PGS"):
            yield case("Ten boxes", f"{solver}, {cone}", scene(stack([1] * 10), f"cone='{cone}' solver='{solver}'"), 3, keep=stands(10))
    for solver in ("Newton", "CG", "PGS"):
        for iterations in (1, 2, 3, 100):
            yield case("A solver that stops early", f"twelve boxes, {iterations} iterations at most, {solver}",
                       scene(stack([1] * 12), f"iterations='{iterations}' solver='{solver}'"), 3, keep=stands(12))
    for i in ("Euler", "implicitfast", "discrete"):
        option = f"integrator='{i}'"
        for time in (2e-2, 2e-3, 1e-3, 1e-4):
            yield case("Stiff contacts", f"solref {time:g} 1, {i}", ball(option, f"solref='{time:g} 1'", 1))
        yield case("Stiff contacts", f"solref .02 .2, 20 ms, {i}", ball(option + " timestep='.02'", "solref='.02 .2'"), bound=2)
        yield case("Stiff contacts", f"solref 1e-4 1 without refsafe, {i}",
                   ball(option, "solref='1e-4 1'", 1).replace("/><default>", "><flag refsafe='disable'/></option><default>", 1))
        for power in (2, 4, 5, 6, 8):
            k = 10.0 ** power
            yield case("Stiff contacts", f"solref {-k:g} {-2 * k ** .5:g}, {i}", ball(option, f"solref='{-k:g} {-2 * k ** .5:g}'", 1))
    for i in INTEGRATORS:
        for h in (1e-6, 1e-4, 1e-3, 1e-2, 3e-2, 0.1, 1.0):
            yield case("Timesteps", f"a falling ball, {h:g} s, {i}", ball(f"timestep='{h:g}' integrator='{i}'"), 1, 10, h,
                       keep=ON_FLOOR)
    for i in ("Euler", "discrete"):
        for h in (1e-4, 1e-3, 1e-2, 3e-2, 0.1):
            yield case("Timesteps", f"three boxes, {h:g} s, {i}", scene(stack([1] * 3), f"timestep='{h:g}' integrator='{i}'"), 1, 10, h,
                       keep=stands(3))
    for i in INTEGRATORS:
        for h in (0.01, 0.1, 0.2, 0.5, 1.0):
            body = "<body pos='0 0 1'><joint axis='0 1 0'/><geom type='capsule' fromto='0 0 0 .4 0 0' size='.03' mass='.5'/></body>"
            yield case("A pendulum and its step", f"{h:g} s, {i}", scene(body, f"timestep='{h:g}' integrator='{i}'"), 60, 1e9, h,
                       keep=[keep("qvel", 0, -12, 12)])
    for i in ("Euler", "implicitfast"):
        for damping in (.01, 0, -.01, -.05):
            body = (f"<body pos='0 0 1'><joint axis='0 1 0' damping='{damping:g}'/><geom type='capsule' fromto='0 0 0 .4 0 0' size='.03' "
                    "mass='.5'/></body>")
            yield case("Damping below zero", f"a pendulum, damping {damping:g}, {i}", scene(body, f"integrator='{i}'"), 6, 1e9,
                       keep=[keep("qpos", 0, -.5, 3.64)])
    for i in ("Euler", "discrete"):
        for g in (10, 100, 1e3, 1e4, 1e5, 1e6):
            option = f"gravity='0 0 {-g:g}' integrator='{i}'"
            yield case("Gravity", f"a falling ball, {g:g} m/s^2, {i}", ball(option), 2, 1e9, keep=ON_FLOOR)
            yield case("Gravity", f"three boxes, {g:g} m/s^2, {i}", scene(stack([1] * 3), option), 2, 1e9, keep=stands(3))
    plate = "<geom type='box' size='1 1 .0005'/>"
    for radius in (.01, .1):
        for speed in (.1, 1, 3, 10, 30, 100):
            yield case("A plate 1 mm thick", f"a ball of {radius:g} m at {speed:g} m/s",
                       scene(f"{plate}<body pos='0 0 .15'><freejoint/><geom size='{radius:g}' mass='.1'/></body>",
                             tail=f"<keyframe><key qvel='0 0 {-speed:g} 0 0 0'/></keyframe>"), 1, 1e9,
                       keep=[keep("qpos", 2, 0, 1e9, "end")])
    for speed in (1, 3, 10):
        door = ("<body pos='0 0 1'><joint axis='0 0 1' damping='.1'/><geom type='box' size='.5 .001 .5' pos='.5 0 0' mass='2'/></body>"
                "<body pos='.8 -.2 1'><freejoint/><geom size='.02' mass='.01'/></body>")
        yield case("A plate 1 mm thick", f"a ball of 0.02 m at a door of 2 mm, {speed:g} m/s",
                   scene(door, "gravity='0 0 0'", tail=f"<keyframe><key qvel='0 0 {speed:g} 0 0 0 0'/></keyframe>"), .5, 1e9,
                   keep=[keep("qpos", 2, -1e9, 0, "end")] if speed < 3 else [keep("qpos", 2, -1e9, .1, "end")])
    for cone in ("pyramidal", "elliptic"):
        for mu in (1, 100, 1e3, 1e6, 1e9):
            friction = f"<geom friction='{mu:g} .005 .0001'/>"
            yield case("Friction", f"a ball, {mu:g}, {cone}", ball(f"cone='{cone}'", f"friction='{mu:g} .005 .0001'"), 2, 1e9, keep=ON_FLOOR)
            yield case("Friction", f"a box, {mu:g}, {cone}", scene(stack([1]), f"cone='{cone}'", friction), 2, 1e9, keep=stands(1))
    for i in INTEGRATORS:
        for speed in (10, 100, 1000, 1e4):
            body = ("<body><joint axis='0 1 0' range='-45 45'/><geom type='capsule' fromto='0 0 0 .4 0 0' size='.03' mass='.5'/></body>")
            yield case("Slam into a limit", f"{speed:g} rad/s, {i}",
                       scene(body, f"integrator='{i}'", tail=f"<keyframe><key qvel='{speed:g}'/></keyframe>"), 1, 2)
    pend = ("<body name='p' pos='0 0 1'><joint name='a' axis='0 1 0'/><geom type='capsule' fromto='0 0 0 .4 0 0' size='.03' mass='.5'/>"
            "<body name='q' pos='.4 0 0'><joint name='b' axis='0 1 0'/><geom type='capsule' fromto='0 0 0 .4 0 0' size='.03' mass='.5'/></body></body>")
    tie = "<connect body1='q' anchor='.4 0 0'/>"
    for name, ties in {
        "one tie": tie, "the same tie five times": 5 * tie, "the same tie fifty times": 50 * tie,
        "tied to two places 1 m apart": "<connect body1='q' anchor='.4 0 0'/><connect body1='q' anchor='-.6 0 0'/>",
        "a joint that is to be 0 and 1": "<joint joint1='a' polycoef='0 0 0 0 0'/><joint joint1='a' polycoef='1 0 0 0 0'/>",
        "welded to the world twice, 0.5 m apart": "<weld body1='q'/><weld body1='q' relpose='0 0 .5 1 0 0 0'/>",
        "stiff ties that contradict": "<connect body1='q' anchor='.4 0 0' solref='1e-3 1'/><connect body1='q' anchor='-.6 0 0' solref='1e-3 1'/>",
    }.items():
        for i in ("Euler", "discrete"):
            yield case("Redundant and conflicting ties", f"{name}, {i}", scene(pend, f"integrator='{i}'", tail=f"<equality>{ties}</equality>"), bound=100)
    for i in ("Euler", "implicit", "implicitfast"):
        for thin in (1e-3, 1e-5, 1e-6):
            body = f"<body><freejoint/><geom type='box' size='.1 {thin:g} {thin:g}' mass='1'/></body>"
            yield case("Near-singular inertia", f"a needle {thin:g} m thick, spinning, {i}",
                       scene(body, f"gravity='0 0 0' integrator='{i}'", tail="<keyframe><key qvel='0 0 0 .1 10 .1'/></keyframe>"))
        for mass in (1e-4, 1e-8):
            body = (f"<body pos='0 0 1'><joint axis='0 1 0'/><geom type='capsule' fromto='0 0 0 .4 0 0' size='.03' mass='1'/>"
                    f"<body pos='.4 0 0'><joint axis='0 1 0'/><geom type='capsule' fromto='0 0 0 .01 0 0' size='.001' mass='{mass:g}'/></body></body>")
            yield case("Near-singular inertia", f"a link of {mass:g} kg at the end of one of 1 kg, {i}", scene(body, f"integrator='{i}'"), bound=1e3)
    for size in (1e-3, 1e-2, 1.0, 1e3):
        yield case("Scales", f"three boxes of {size:g} m, density 1000", scene(stack([1000 * (2 * size) ** 3] * 3, size)), bound=max(10, 10 * size),
                   keep=stands(3, size))
    # Where the real library says nothing.
    yield case("Known silent failures", "servo kp 2e4, 10 ms, implicitfast", servo(2e4, "timestep='.01' integrator='implicitfast'", ""), 4)
    yield case("Known silent failures", "ball, h = 1 s", ball("timestep='1'"), 20, keep=ON_FLOOR)
    yield case("Known silent failures", "ball, solref -1e8 -1", ball("", "solref='-1e8 -1'", 1), 2)
    # Long runs: 10 million steps.
    for i in INTEGRATORS:
        box = "<body><freejoint/><geom type='box' size='.1 .05 .02' mass='1'/></body>"
        yield case("Long runs", f"a tumbling box, {i}", scene(box, f"gravity='0 0 0' integrator='{i}'", tail="<keyframe><key qvel='0 0 0 1 6 .5'/></keyframe>"), long=10_000_000)
        pendulum = "<body><joint axis='0 1 0'/><geom type='capsule' fromto='0 0 0 .4 0 0' size='.03' mass='.5'/></body>"
        yield case("Long runs", f"a pendulum, {i}", scene(pendulum, f"integrator='{i}'"), bound=1e3, long=10_000_000)
    yield case("Long runs", "a ball at rest", ball(), long=10_000_000)


def searches():
    for kp in (1e3, 1e4, 1e5, 1e6, 1e7, 1e8):
        for name, damping in (("no damping", ""), ("dampratio 1", "dampratio='1'")):
            for i in INTEGRATORS:
                yield {"section": f"Servo, {name}", "row": f"kp {kp:g}", "column": i, "bound": 10, "steps": 2000,
                       "xml": servo(kp, f"timestep='TIMESTEP' integrator='{i}'", damping)}
    for time in (1e-1, 2e-2, 5e-3, 1e-3, 1e-4):
        for i in INTEGRATORS:
            yield {"section": "Contact of a falling ball", "row": f"solref {time:g} 1", "column": i, "bound": 1, "steps": 2000,
                   "xml": ball(f"timestep='TIMESTEP' integrator='{i}'", f"solref='{time:g} 1'", 1)}
    for k in (1e2, 1e4, 1e6, 1e8):
        for i in INTEGRATORS:
            yield {"section": "Contact of a falling ball", "row": f"solref {-k:g} {-2 * k ** .5:g}", "column": i, "bound": 1,
                   "steps": 2000, "xml": ball(f"timestep='TIMESTEP' integrator='{i}'", f"solref='{-k:g} {-2 * k ** .5:g}'", 1)}


def energy(m, d):
    mujoco.mj_forward(m, d)
    mujoco.mj_energyPos(m, d)
    mujoco.mj_energyVel(m, d)
    return float(d.energy.sum())


def out_of(d, what, when):
    """How far a run is out of what it keeps."""
    far = 0.0
    for k in what:
        if k["when"] == when:
            x = float(getattr(d, k["of"])[k["i"]])
            far = max(far, k["low"] - x, x - k["high"])
    return far


def run(xml, steps, long=0, what=()):
    m = mujoco.MjModel.from_xml_string(xml)
    d = mujoco.MjData(m)
    if m.nkey:
        mujoco.mj_resetDataKeyframe(m, d, 0)
    start = energy(m, d)
    reach = float(np.abs(d.qpos).max())
    out = out_of(d, what, "way")
    before, done = 0.0, 0
    while done < (long or steps):
        n = max(1, long // 1000)
        before = d.time
        mujoco.mj_step(m, d, nstep=n)
        done += n
        for which, name in WARNINGS.items():
            if d.warning[which].number:
                return {"warning": name, "time": before, "dof": int(d.warning[which].lastinfo)}
        reach = max(reach, float(np.abs(d.qpos).max()))
        out = max(out, out_of(d, what, "way"))
    out = {"reach": reach, "out": max(out, out_of(d, what, "end")), "speed": float(np.abs(d.qvel).max()) if m.nv else 0.0, "qpos": d.qpos[:KEPT].tolist()}
    if long:
        out["energy"] = (energy(m, d) - start) / max(abs(start), 1e-12) if start else energy(m, d)
        if m.nq == 7:
            out["norm"] = float(np.linalg.norm(d.qpos[3:7]) - 1)
    return out


def longest(search):
    best = None
    for h in TIMESTEPS:
        found = run(search["xml"].replace("TIMESTEP", f"{h:g}"), search["steps"])
        if "warning" in found or found["reach"] > search["bound"]:
            break
        best = h
    return best


def main():
    mujoco.set_mju_user_warning(lambda text: None)
    table = []
    for c in cases():
        c["theirs"] = run(c["xml"], c["steps"], c["long"], c["keep"])
        table.append(json.dumps(c))
        print(c["section"], c["case"], c["theirs"].get("warning", c["theirs"].get("reach")))
    grid = [json.dumps({**s, "theirs": longest(s)}) for s in searches()]
    text = ('{"timesteps": ' + json.dumps(TIMESTEPS) + ',\n"cases": [\n' + ",\n".join(table) + '\n],\n"searches": [\n' + ",\n".join(grid) + "\n]}\n")
    (HERE / "stability.json").write_text(text)


main()
