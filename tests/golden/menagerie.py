#!/usr/bin/env python3
"""Makes random models that use everything at once, and records what MuJoCo 3.14.0 computes for them: the zoo shows each
feature alone, these show that features get on with each other.

    mj/bin/python menagerie.py FOLDER [--count 50] [--seed 1]

FOLDER gets SEED.xml and SEED.json, as zoo.py writes it. tests/conformance.rs runs this when LABSPEC_ORACLE is set.
"""
import argparse
import pathlib
from xml.sax.saxutils import quoteattr

import numpy as np

import recording


class Maker:
    """Writes one model, and remembers what there is to refer to."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)
        self.lines, self.indent = [], 0
        self.joints, self.sites, self.bodies, self.geoms, self.round = [], [], [], [], []
        self.tendons, self.actuators = [], []

    # Chances and numbers.
    def some(self, chance=0.5):
        return self.rng.random() < chance

    def pick(self, items):
        return items[self.rng.integers(len(items))]

    def near(self, size, n=1):
        return " ".join(f"{x:.4g}" for x in self.rng.uniform(-size, size, n))

    def size(self, low, high, n=1):
        return " ".join(f"{x:.4g}" for x in self.rng.uniform(low, high, n))

    def count(self, low, high):
        return self.rng.integers(low, high + 1)

    # XML.
    def put(self, tag, attributes=None, close=True):
        text = "".join(f" {k}={quoteattr(str(v))}" for k, v in (attributes or {}).items() if v is not None)
        self.lines.append("  " * self.indent + f"<{tag}{text}{'/' if close else ''}>")

    def open(self, tag, attributes=None):
        self.put(tag, attributes, close=False)
        self.indent += 1

    def close(self, tag):
        self.indent -= 1
        self.lines.append("  " * self.indent + f"</{tag}>")

    def turn(self):
        """One way to state an orientation, or none."""
        return self.pick([{}, {"euler": self.near(90, 3)}, {"quat": self.near(1, 4)}, {"axisangle": self.near(1, 3) + " " + self.near(90)},
                          {"xyaxes": self.near(1, 6)}, {"zaxis": self.near(1, 3)}])

    def maybe(self, **choices):
        """Each attribute in half of the cases."""
        return {k: v() for k, v in choices.items() if self.some()}

    def joint(self, kinds):
        kind = self.pick(kinds)
        name = f"j{len(self.joints)}"
        a = {"name": name, "type": kind, "armature": self.size(0.01, 0.1)}
        a |= self.maybe(pos=lambda: self.near(0.1, 3), damping=lambda: self.pick([self.size(0, 0.3), self.size(0, 0.1, 3)]),
                        stiffness=lambda: self.pick([self.size(0, 5), self.size(0, 2, 3)]))
        if kind != "ball":
            a |= {"axis": self.near(1, 3)} | self.maybe(
                ref=lambda: self.near(0.2 if kind == "slide" else 30), springref=lambda: self.near(0.2 if kind == "slide" else 30),
                actuatorfrcrange=lambda: f"-{self.size(0.2, 1)} {self.size(0.2, 1)}", range=lambda: "-0.1 0.2", margin=lambda: "0.05")
        if self.some(0.2):
            a["actuatorgravcomp"] = "true"
        self.joints.append((name, kind))
        self.put("joint", a)

    def geom(self, shell):
        kind = self.pick(["sphere", "capsule", "cylinder", "ellipsoid", "box"])
        n = {"sphere": 1, "capsule": 2, "cylinder": 2}.get(kind, 3)
        name = f"g{len(self.geoms)}"
        a = {"name": name, "type": kind, "size": self.size(0.03, 0.12, n), "pos": self.near(0.15, 3)} | self.turn()
        a |= self.pick([{}, {"mass": self.size(0.2, 2)}, {"density": self.size(300, 3000)}])
        if shell:
            a["shellinertia"] = "true"
        if self.some(0.2):
            a |= {"fluidshape": "ellipsoid"} | self.maybe(fluidcoef=lambda: self.size(0.1, 1.5, 5))
        self.geoms.append(name)
        if kind in ("sphere", "cylinder"):
            self.round.append(name)
        self.put("geom", a)

    def body(self, depth):
        name = f"b{len(self.bodies)}"
        self.bodies.append(name)
        a = {"name": name, "pos": self.near(0.3, 3)} | self.turn()
        if self.some(0.2):
            a["gravcomp"] = self.size(0, 1.5)
        self.open("body", a)
        if depth == 0 and self.some(0.4):
            self.joints.append((f"j{len(self.joints)}", "free"))
            self.put("freejoint", {"name": self.joints[-1][0]})
        else:
            # A ball turns about everything: nothing else of the body may turn, too.
            for kinds in self.pick([[["hinge"]], [["ball"]], [["slide"]], [["hinge"], ["hinge", "slide"]], [["slide"], ["slide", "ball"]], []]):
                self.joint(kinds)
        for _ in range(self.count(1, 2)):
            self.geom(shell=self.some(0.1))
        if self.some(0.2):
            self.put("inertial", {"pos": self.near(0.05, 3), "mass": self.size(0.2, 2)} | self.pick([
                {"diaginertia": self.size(0.01, 0.015, 3)} | self.turn(),
                {"fullinertia": self.size(0.01, 0.02, 3) + " " + self.near(0.003, 3)}]))
        for _ in range(self.count(1, 2)):
            self.sites.append(f"s{len(self.sites)}")
            self.put("site", {"name": self.sites[-1], "pos": self.near(0.2, 3)} | self.turn())
        if self.some(0.3):
            mode = self.pick(["fixed", "track", "trackcom"])
            self.put("camera", {"pos": self.near(1, 3), "mode": mode} | self.turn())
        if depth < 3:
            for _ in range(self.count(0, 2)):
                self.body(depth + 1)
        self.close("body")

    def spatial(self):
        """A path through up to five sites, around round geoms, with a pulley."""
        if len(self.sites) < 2:
            return
        wraps = self.some(0.5)
        a = {"stiffness": self.pick([0, self.size(1, 20), self.size(0, 5, 3)]), "damping": self.size(0, 0.3)}
        a |= self.maybe(springlength=lambda: "0.1 0.4") | ({} if wraps else self.maybe(armature=lambda: self.size(0, 0.2)))
        self.tendons.append(f"t{len(self.tendons)}")
        self.open("spatial", {"name": self.tendons[-1]} | a)
        path = list(self.rng.permutation(self.sites)[:5])
        branch = 2 if len(path) > 3 and self.some(0.3) else len(path)
        for i, site in enumerate(path):
            if i == branch:
                self.put("pulley", {"divisor": self.size(1, 3)})
            elif i and wraps and self.round:
                self.put("geom", {"geom": self.pick(self.round)} | self.maybe(sidesite=lambda: self.pick(self.sites)))
            self.put("site", {"site": site})
        self.close("spatial")

    def fixed(self):
        scalar = [n for n, kind in self.joints if kind in ("hinge", "slide")]
        if not scalar:
            return
        self.tendons.append(f"t{len(self.tendons)}")
        self.open("fixed", {"name": self.tendons[-1]} | self.maybe(stiffness=lambda: self.size(0, 5), damping=lambda: self.size(0, 0.5),
                                                                 armature=lambda: self.size(0, 0.2)))
        for n in self.rng.permutation(scalar)[:2]:
            self.put("joint", {"joint": n, "coef": self.near(2)})
        self.close("fixed")

    def transmission(self):
        choices = [{"site": self.pick(self.sites), "gear": self.near(1, 6)},
                   {"site": self.pick(self.sites), "refsite": self.pick(self.sites), "gear": self.near(1, 6)},
                   {"cranksite": self.pick(self.sites), "slidersite": self.pick(self.sites), "cranklength": "1.5"}]
        if self.joints:
            name, kind = self.pick(self.joints)
            n = {"free": 6, "ball": 3}.get(kind, 1)
            choices += 3 * [{self.pick(["joint", "jointinparent"]): name, "gear": self.near(1.5, n)}]
        if self.tendons:
            choices += 2 * [{"tendon": self.pick(self.tendons), "gear": self.near(1.5)}]
        return self.pick(choices)

    def actuator(self):
        self.actuators.append(f"a{len(self.actuators)}")
        a = {"name": self.actuators[-1]} | self.transmission()
        a |= self.maybe(ctrlrange=lambda: "-0.7 0.9", forcerange=lambda: "-1 1.5")
        kind = self.pick(["motor", "position", "velocity", "intvelocity", "cylinder", "muscle", "general", "general"])
        if kind == "position":
            a |= {"kp": self.size(0.5, 5)} | self.pick([{}, {"kv": self.size(0, 0.5)}, {"timeconst": self.size(0.05, 0.3)}])
        elif kind == "intvelocity":
            a |= {"kp": self.size(0.5, 5), "actrange": "-0.5 0.6"}
        elif kind == "cylinder":
            a |= {"timeconst": self.size(0.1, 1), "bias": self.near(0.3, 3)}
        elif kind == "muscle" and "site" in a:
            kind = "motor"
        elif kind == "muscle":
            a |= {"lengthrange": "-1 2", "force": self.size(0.5, 2)} | self.maybe(timeconst=lambda: "0.03 0.06", range=lambda: "0.7 1.1")
        elif kind == "general":
            a |= {"gainprm": self.near(2), "dyntype": self.pick(["none", "integrator", "filter", "filterexact"]), "dynprm": self.size(0.03, 0.3)}
            a |= self.pick([{}, {"biastype": "affine", "biasprm": "0.1 " + f"-{self.size(0, 3)} -{self.size(0, 0.3)}"}])
            a |= self.pick([{}, {"actearly": "true"}, {"actrange": "-0.3 0.8"}] if a["dyntype"] != "none" else [{}])
            a |= {"gaintype": "affine", "gainprm": self.near(1, 3)} if self.some(0.2) else {}
        if self.some(0.2):
            a |= {"delay": "0.006", "nsample": "5", "interp": self.pick(["zoh", "linear", "cubic"])}
        a |= {"group": "1"} if self.some(0.2) else {}
        self.put(kind, a)

    def sensor(self):
        frame = lambda: self.pick([("body", self.pick(self.bodies)), ("xbody", self.pick(self.bodies)), ("geom", self.pick(self.geoms)),
                                   ("site", self.pick(self.sites))])
        kind = self.pick(["accelerometer", "velocimeter", "gyro", "force", "torque", "magnetometer", "framepos", "framequat", "framexaxis",
                          "frameyaxis", "framezaxis", "framelinvel", "frameangvel", "framelinacc", "frameangacc", "subtreecom",
                          "subtreelinvel", "subtreeangmom", "clock", "e_potential", "e_kinetic", "tendonpos", "tendonvel", "actuatorpos",
                          "actuatorvel", "actuatorfrc", "jointpos", "jointvel", "jointactuatorfrc", "ballquat", "ballangvel"])
        scalar = [n for n, k in self.joints if k in ("hinge", "slide")]
        balls = [n for n, k in self.joints if k == "ball"]
        a = {}
        if kind.startswith("frame"):
            objtype, name = frame()
            a = {"objtype": objtype, "objname": name}
            if "acc" not in kind and self.some(0.4):
                a["reftype"], a["refname"] = frame()
        elif kind.startswith("subtree"):
            a = {"body": self.pick(self.bodies)}
        elif kind.startswith("tendon"):
            a = {"tendon": self.pick(self.tendons)} if self.tendons else None
        elif kind.startswith("actuator"):
            a = {"actuator": self.pick(self.actuators)} if self.actuators else None
        elif kind.startswith("joint"):
            a = {"joint": self.pick(scalar)} if scalar else None
        elif kind.startswith("ball"):
            a = {"joint": self.pick(balls)} if balls else None
        elif kind not in ("clock", "e_potential", "e_kinetic"):
            a = {"site": self.pick(self.sites)}
        if a is None:
            return
        if self.some(0.15) and "axis" not in kind and "quat" not in kind:
            a["cutoff"] = self.size(0.1, 2)
        if self.some(0.1):
            a |= {"delay": "0.008", "nsample": "6", "interp": self.pick(["zoh", "linear", "cubic"])}
        self.put(kind, a)

    def model(self):
        self.open("mujoco")
        option = self.maybe(gravity=lambda: self.near(9, 3)) | self.pick([{}, {}, {"density": self.size(0, 30), "viscosity": self.size(0, 0.2)}])
        option |= {"wind": self.near(1, 3)} if self.some(0.2) else {}
        option |= {"actuatorgroupdisable": "1"} if self.some(0.2) else {}
        self.open("option", option)
        self.put("flag", {"energy": "enable"})
        self.close("option")
        self.open("worldbody")
        self.sites.append("s0")
        self.put("site", {"name": "s0", "pos": self.near(1, 3)})
        if self.some(0.2):
            self.open("body", {"name": "hand", "mocap": "true", "pos": self.near(1, 3)} | self.turn())
            self.sites.append("s1")
            self.put("site", {"name": "s1", "pos": self.near(0.1, 3)})
            self.put("geom", {"size": "0.05"})
            self.close("body")
        for _ in range(self.count(1, 3)):
            self.body(0)
        self.close("worldbody")
        self.open("tendon")
        for _ in range(self.count(0, 3)):
            self.pick([self.spatial, self.spatial, self.fixed])()
        self.close("tendon")
        self.open("actuator")
        for _ in range(self.count(0, 5)):
            self.actuator()
        self.close("actuator")
        self.open("sensor")
        for _ in range(self.count(0, 8)):
            self.sensor()
        self.close("sensor")
        self.close("mujoco")
        return "\n".join(self.lines) + "\n"


def main():
    p = argparse.ArgumentParser()
    p.add_argument("folder", type=pathlib.Path)
    p.add_argument("--count", type=int, default=50)
    p.add_argument("--seed", type=int, default=1)
    a = p.parse_args()
    a.folder.mkdir(parents=True, exist_ok=True)
    seed, made, refused = a.seed, 0, 0
    while made < a.count:
        path = a.folder / f"{seed}.xml"
        path.write_text(Maker(seed).model())
        seed += 1
        try:
            out = recording.record(path, 4, 0.2, short=True, steps=50, every=25)
        except ValueError as e:
            # Not a model: say why, so that the maker can be mended.
            print(path.stem, str(e).splitlines()[0])
            path.unlink()
            refused += 1
            continue
        recording.write(path.with_suffix(".json"), out)
        made += 1
    print(f"{made} models in {a.folder}, {refused} that the library refused")


if __name__ == "__main__":
    main()
