#!/usr/bin/env python3
"""What a step of labs of twenty kinds costs beside MuJoCo's, in the same run: docs/measured/speed.md, "Kinds of labs".

    PYTHON tests/speed/kinds.py [KIND...] [--out docs/measured/speed.md] [--rounds 3] [--write FOLDER]

PYTHON has the package `mujoco` 3.14.0. The labs are small and nobody tuned them: a model, a curve or two, a slider for the timestep and
a select for the integrator, as lessons have them. Each is measured as `labs.py` measures those of the corpus. With `--write` they are
written to a folder and not measured.
"""
import argparse
import json
import pathlib
import sys
import tempfile

LINK = "<body name='b{i}' pos='{x} 0 {z}'><joint name='j{i}' axis='0 1 0'/><geom type='capsule' size='.01' fromto='0 0 0 .1 0 0' mass='.05' contype='0' conaffinity='0'/>"


def chain(n):
    links = "".join(LINK.format(i=i, x=0.1 if i else 0, z=0 if i else 3) for i in range(n))
    return f"{links}<geom size='.05' pos='.1 0 0' mass='5' contype='0' conaffinity='0'/>{'</body>' * n}"


def model(body, more="", option=""):
    return f"<mujoco><option {option}/><worldbody>{body}</worldbody>{more}</mujoco>"


def pendulum(mass, inner=""):
    return (f"<body pos='0 0 2'><joint axis='0 1 0'/><geom type='capsule' size='.01' fromto='0 0 0 .5 0 0' mass='.1'/>"
            f"<body pos='.5 0 0'><joint axis='0 1 0'/><geom size='.05' pos='.5 0 0' mass='{mass}'/>{inner}</body></body>")


def slide(name="x", more="", geom="size='.1' mass='1'"):
    return f"<body pos='0 0 1'><joint name='{name}' type='slide' axis='1 0 0' {more}/><geom {geom}/></body>"


FLOOR = "<geom type='plane' size='5 5 1'/>"
BOX = "<body pos='0 0 {z}'><freejoint/><geom type='box' size='.1 .1 .1' mass='1'/></body>"
BUMPER = "<geom type='cylinder' size='.1 .1' pos='{x} {y} .1'/>"
X, V = {"label": "x", "expr": "data.qpos[0]"}, {"label": "v", "expr": "data.qvel[0]"}

# Name: model, whether constraints can act, and what else the lab has.
KINDS = {
    "stiff servo": (model(FLOOR + "<body pos='0 0 2'><joint name='j' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 .5 0 0'/></body>",
                          "<actuator><position joint='j' kp='5000' kv='50'/></actuator>"), False, {"setup": "data.ctrl[0] = 0.5"}),
    "mass ratio 1000": (model(pendulum(100)), False, {}),
    "intermediate axis": (model("<body><freejoint/><geom type='box' size='.1 .2 .05'/></body>", option="gravity='0 0 0'"), False,
                          {"setup": "data.qvel[3] = 0.01; data.qvel[4] = 5", "expr": "data.qvel[3]"}),
    "spring pendulum": (model("<body pos='0 0 2'><joint axis='0 1 0'/><joint type='slide' axis='0 0 -1' stiffness='117.7' springref='0'/>"
                              "<geom size='.05' pos='0 0 -.75' mass='1'/></body>"), False, {"setup": "data.qpos[0] = 0.1"}),
    "fast ball": (model("<geom type='plane' size='5 5 1' zaxis='1 0 0' pos='-1 0 0'/><geom type='plane' size='5 5 1' zaxis='-1 0 0' pos='1 0 0'/>"
                        "<body><joint type='slide' axis='1 0 0'/><geom size='.1' mass='1' solref='.01 .1'/></body>", option="gravity='0 0 0'"), True,
                  {"setup": "data.qvel[0] = 10"}),
    "Van der Pol": (model(slide(), option="gravity='0 0 0'"), False,
                    {"setup": "data.qpos[0] = 2", "controller": "data.qfrc_applied[0] = 5 * (1 - data.qpos[0] * data.qpos[0]) * data.qvel[0] - data.qpos[0]"}),
    "heavy damping": (model(slide(more="damping='50' stiffness='10'")), False, {"setup": "data.qpos[0] = 1"}),
    "long chain": (model(FLOOR.replace("/>", " pos='0 0 -1'/>") + chain(30)), False, {"stop": 2}),
    "gears": (model("<body><joint name='a' axis='0 1 0'/><geom type='cylinder' size='.1 .02' mass='1' contype='0' conaffinity='0'/></body>"
                    "<body pos='.3 0 0'><joint name='b' axis='0 1 0'/><geom type='cylinder' size='.2 .02' mass='2' contype='0' conaffinity='0'/></body>",
                    "<equality><joint joint1='b' joint2='a' polycoef='0 -.5 0 0 0'/></equality><actuator><motor joint='a'/></actuator>"), True,
              {"setup": "data.ctrl[0] = 0.1"}),
    "gyroscope": (model("<body pos='0 0 1'><joint axis='0 0 1'/><joint axis='0 1 0'/><joint axis='1 0 0'/>"
                        "<geom type='cylinder' size='.1 .02' pos='.2 0 0' euler='0 90 0' mass='1'/></body>"), False, {"setup": "data.qvel[2] = 50", "stop": 2}),
    "dry friction": (model(slide(more="frictionloss='1'")), True, {"setup": "data.qvel[0] = 2"}),
    "pulley": (model("<body pos='-.3 0 1'><joint name='a' type='slide' axis='0 0 1'/><geom size='.05' mass='1'/></body>"
                     "<body pos='.3 0 1'><joint name='b' type='slide' axis='0 0 1'/><geom size='.05' mass='1.2'/></body>",
                     "<tendon><fixed name='rope'><joint joint='a' coef='1'/><joint joint='b' coef='1'/></fixed></tendon>"
                     "<equality><tendon tendon1='rope'/></equality>"), True, {"stop": 1}),
    "double pendulum": (model(FLOOR + pendulum(1).replace("pos='0 0 2'", "pos='0 0 3'")), False, {}),
    "driven oscillator": (model(slide(more="stiffness='100' damping='.5'"), "<actuator><motor joint='x'/></actuator>"), False,
                          {"controller": "data.ctrl[0] = Math.sin(9 * data.time)"}),
    "slam": (model(slide(more="range='-.5 .5'")), True, {"setup": "data.qvel[0] = 5"}),
    "pinball": (model("<geom type='plane' size='2 2 1'/>" + "".join(BUMPER.format(x=0.4 * i - 0.6, y=0.5 * (i % 2) + 0.3) for i in range(4))
                      + "<geom type='box' size='1 .05 .1' pos='0 -1 .1'/><geom type='box' size='1 .05 .1' pos='0 1.2 .1'/>"
                      "<body pos='.05 -.5 .05'><freejoint/><geom size='.05' mass='.1'/></body>"), True, {"setup": "data.qvel[1] = 3"}),
    "drag": (model("<body pos='0 0 1'><freejoint/><geom size='.05' mass='.1'/></body>", option="density='1.2' viscosity='.00002'"), False,
             {"setup": "data.qvel[0] = 20"}),
    "filter": (model(slide(more="damping='1'"), "<actuator><general joint='x' dyntype='filter' dynprm='.1' gainprm='3'/></actuator>"), False,
               {"setup": "data.ctrl[0] = 1"}),
    "four-bar": (model("<body name='a' pos='0 0 1'><joint name='a' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 .3' contype='0' conaffinity='0'/>"
                       "<body name='b' pos='0 0 .3'><joint axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 .6 0 .2' contype='0' conaffinity='0'/></body></body>"
                       "<body name='c' pos='.6 0 1'><joint axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 .5' contype='0' conaffinity='0'/></body>",
                       "<equality><connect body1='b' body2='c' anchor='.6 0 .2'/></equality><actuator><motor joint='a'/></actuator>"), True,
                 {"setup": "data.ctrl[0] = 0.3"}),
    "stack": (model(FLOOR + "".join(BOX.format(z=0.1 + 0.2 * i) for i in range(3))), True, {"stop": 2, "expr": "data.qpos[2]"}),
}


# Runs of 200 s break for these kinds: at a timestep of 2 ms, the energy of the chain grows from 4.4 s on, and that of the gyroscope from
# 4.5 s on. Runs of 15 s with a timestep of 0.1 ms do not.
SHORT = {"settings": ["timestep (s)=0.0001"], "lengths": (10_000, 150_000)}
WHOLE = {"long chain": SHORT, "gyroscope": SHORT}


def lab(name):
    xml, _, more = KINDS[name]
    first = {"label": "x", "expr": more.get("expr", "data.qpos[0]")}
    spec = {
        "title": name, "xml": xml, "stopAt": more.get("stop", 5),
        "controls": [
            {"label": "timestep (s)", "set": "model.opt.timestep", "min": 0.0001, "max": 0.01, "step": 0.0001, "value": 0.002},
            {"type": "select", "label": "integrator", "set": "model.opt.integrator", "value": 0,
             "options": [["Euler", 0], ["RK4", 1], ["implicitfast", 3]]},
        ],
        "plots": [{"traces": [first, V]}], "readouts": [X],
    }
    return spec | {key: more[key] for key in ("setup", "controller") if key in more}


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("kinds", nargs="*")
    p.add_argument("--out", type=pathlib.Path)
    p.add_argument("--write", type=pathlib.Path)
    p.add_argument("--rounds", type=int, default=3)
    a = p.parse_intermixed_args()
    names = a.kinds or list(KINDS)
    with tempfile.TemporaryDirectory() as folder:
        folder = a.write or pathlib.Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        files = {name: folder / f"{name.replace(' ', '-')}.json" for name in names}
        for name, file in files.items():
            file.write_text(json.dumps(lab(name), indent=1))
        if a.write:
            return
        import labs

        def row(name, file):
            cells = labs.measure(file, a.rounds, **WHOLE.get(name, {}))
            return [name, *cells[1:]] if cells else sys.exit(f"{name} does not run")

        lines = labs.table("kind", (row(name, file) for name, file in files.items()))
    if a.out:
        labs.replace_table(a.out, "Kinds of labs", lines)


if __name__ == "__main__":
    main()
