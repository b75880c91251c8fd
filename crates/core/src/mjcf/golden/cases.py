"""What MuJoCo 3.14.0 says of small texts: `python cases.py` with mujoco==3.14.0 writes texts.txt, sizes.txt, margins.txt.

texts.txt: text between, before and after elements; sizes.txt: numbers at the edge of what they may be. A line is `loads` or
`refused`, a bar, and the text (line breaks as \\n). margins.txt: two overlapping shapes with negative margins: shapes, margin,
number of contacts, number of constraint rows, distances.
"""

import pathlib

import mujoco

HERE = pathlib.Path(__file__).parent


def answer(xml):
    try:
        mujoco.MjModel.from_xml_string(xml)
        return "loads"
    except ValueError:
        return "refused"


def write(name, texts):
    lines = [f"{answer(text)}|" + text.replace("\n", "\\n") for text in texts]
    (HERE / name).write_text("\n".join(lines) + "\n")


PIECES = [
    "hello", ">", "/>", "x=1", "a=\"b\" />", "geom size='1'/>", "'", "\"", "]]>", "&", "&amp;", "&bogus;", "&#65;", "é = ü", "-->", "--", "?>",
    "<![CDATA[x]]>", "<![CDATA[<geom/>]]>", "a\nb > c\n", "\ufeff", "1 2 3", "<!-- c -->> <!-- d -->",
]


def texts():
    world = "<worldbody>{}<geom size='1'/>{}<body><geom size='1'/></body>{}</worldbody>"
    for piece in PIECES:
        for i in range(3):
            yield f"<mujoco>{world.format(*(piece if i == k else '' for k in range(3)))}</mujoco>"
        empty = world.format("", "", "")
        yield f"{piece}<mujoco>{empty}</mujoco>"
        yield f"<mujoco>{piece}{empty}</mujoco>"
        yield f"<mujoco>{empty}{piece}</mujoco>"
        yield f"<mujoco>{empty}</mujoco>{piece}"
        yield f"<mujoco><option>{piece}<flag contact='disable'/></option>{empty}</mujoco>"
        yield f"<mujoco><default>{piece}<geom size='1'/></default>{empty}</mujoco>"
        yield f"<mujoco><worldbody><geom size='1'>{piece}</geom></worldbody></mujoco>"
        yield f"<mujoco>{piece}</mujoco>"


def sizes():
    body = (
        "<worldbody><geom size='1' user='1 2'/><body user='1 2'><joint user='1 2' name='j'/><geom size='1'/>"
        "<site name='s' user='1 2'/><camera name='c' user='1 2'/></body></worldbody><tendon><fixed user='1 2'>"
        "<joint joint='j' coef='1'/></fixed></tendon><actuator><motor joint='j' user='1 2'/></actuator><sensor>"
        "<clock user='1 2'/></sensor>"
    )
    for name in "body jnt geom site cam tendon actuator sensor data".split():
        for n in (-2, -1, 0, 1, 2, 3):
            name = "userdata" if name == "data" else name
            yield f"<mujoco><size n{'' if name == 'userdata' else 'user_'}{name}='{n}'/>{body}</mujoco>"
    for n in (-2, -1, 0, 2):
        yield f"<mujoco><size nkey='{n}'/>{body}</mujoco>"
    for resolution in ("1 1", "-1 1", "0 0", "0 5", "1 -1", "2147483647 2147483647"):
        yield f"<mujoco><worldbody><camera resolution='{resolution}'/></worldbody></mujoco>"
        yield f"<mujoco><worldbody><camera resolution='{resolution}' sensorsize='1 1' focal='1 1'/></worldbody></mujoco>"
        yield (
            f"<mujoco><worldbody><camera name='c' resolution='{resolution}'/><site name='s'/></worldbody>"
            "<sensor><camprojection camera='c' site='s'/></sensor></mujoco>"
        )
    for kind in ("none", "integrator", "filter", "muscle"):
        for n in (-2, -1, 0, 1, 2):
            yield (
                "<mujoco><worldbody><body><joint name='j'/><geom size='1'/></body></worldbody><actuator>"
                f"<general joint='j' dyntype='{kind}' actdim='{n}' lengthrange='0 1'/></actuator></mujoco>"
            )
    for rows, cols in ((0, 1), (1, 1), (1, 5), (5, 1), (2, 2), (-1, 2)):
        yield (
            f"<mujoco><asset><hfield name='h' nrow='{rows}' ncol='{cols}' size='1 1 1 1'/></asset>"
            "<worldbody><geom type='hfield' hfield='h'/></worldbody></mujoco>"
        )
    for n in (-1, 0, 1, 500, 501, 1000000):
        yield f"<mujoco><custom><numeric name='n' size='{n}'/></custom><worldbody/></mujoco>"
    yield "<mujoco><custom><numeric name='n'/></custom><worldbody/></mujoco>"
    used = "<mujoco><default><default class='u'><geom material='none'/></default></default><worldbody><geom size='1'/>{}</worldbody></mujoco>"
    for use in ("", "<geom class='u' size='1'/>", "<body childclass='u'/>", "<body childclass='u'><geom size='1'/></body>"):
        yield used.format(use)
    bone = "<bone body='b' bindpos='0 0 0' bindquat='1 0 0 0' vertid='0 1 2' vertweight='1 1 1'/>"
    skin = "<skin name='s' vertex='0 0 0 1 0 0 0 1 0' face='0 1 2'>{}</skin>"
    world = "<worldbody><body name='b'><geom size='1'/></body></worldbody>"
    yield f"<mujoco><asset>{skin.format(bone)}</asset>{world}</mujoco>"
    yield f"<mujoco><deformable>{skin.format(bone)}</deformable>{world}</mujoco>"
    yield f"<mujoco><asset>{skin.format(bone)}{skin.format(bone)}</asset>{world}</mujoco>"
    yield f"<mujoco><asset>{skin.format(bone.replace('b', 'x', 1).replace(chr(34) + 'b', 'x'))}</asset>{world}</mujoco>"


def margins():
    shapes = [
        "sphere sphere", "sphere capsule", "capsule capsule", "sphere cylinder", "sphere box", "plane sphere", "plane capsule",
        "plane box", "capsule box", "plane cylinder", "plane ellipsoid",
    ]
    lines = []
    for pair in shapes:
        first, second = pair.split()
        for margin in (0, -0.001, -0.02, -0.08, -0.3, -0.5, -1):
            size, height = ("1 1 .1", 0.08) if first == "plane" else (".1 .1 .1", 0.18)
            xml = (
                f"<mujoco><worldbody><geom type='{first}' size='{size}' margin='{margin}'/><body pos='0.001 0.002 {height}'>"
                f"<freejoint/><geom type='{second}' size='.1 .1 .1' margin='{margin}' euler='10 20 0'/></body></worldbody></mujoco>"
            )
            model = mujoco.MjModel.from_xml_string(xml)
            data = mujoco.MjData(model)
            mujoco.mj_forward(model, data)
            distances = " ".join(repr(c.dist) for c in data.contact)
            lines.append(f"{data.ncon} {data.nefc} {distances}".rstrip() + f"|{xml}")
    (HERE / "margins.txt").write_text("\n".join(lines) + "\n")


def ties():
    """Boxes as meshes whose sides differ, and which are turned, by so little that their axes are a matter of a tolerance."""
    import math

    lines = []
    for z in (0.25, 0.5, 2, 4, 6, 10, 30):
        for k in (0, 1, 2, 3, 6, 12, 16, 64, 256):
            for angle in (0, 0.3):
                if angle and k in (1, 2, 3, 6):
                    continue  # a turn of single-precision corners changes the shape by as much
                c, s = math.cos(angle), math.sin(angle)
                corners = [(x * (1 + k * 2**-23), y, n * z) for x in (-1, 1) for y in (-1, 1) for n in (-1, 1)]
                text = " ".join(f"{v:.9g}" for x, y, h in corners for v in (c * x - s * y, s * x + c * y, h))
                xml = f"<mujoco><asset><mesh name='m' inertia='convex' vertex='{text}'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>"
                quat = mujoco.MjModel.from_xml_string(xml).geom_quat[0]
                lines.append(" ".join(repr(float(q)) for q in quat) + f"|{xml}")
    (HERE / "ties.txt").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    write("texts.txt", texts())
    write("sizes.txt", sizes())
    margins()
    ties()
