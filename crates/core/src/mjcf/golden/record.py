"""Records what MuJoCo 3.14.0 compiles for each model of this folder: `python record.py` with mujoco==3.14.0.

Writes, beside each NAME.xml, NAME.txt with one line per field: its name, then its numbers in full precision; one line
per kind of object with the names between bars, where any has one;
and schema.txt, a line per element of the XML schema: path, then attribute names. The tests compare against both.
"""

import math
import pathlib
import re
import struct

import mujoco

HERE = pathlib.Path(__file__).parent
KINDS = {
    "body": "nbody", "joint": "njnt", "geom": "ngeom", "site": "nsite", "camera": "ncam", "light": "nlight",
    "mesh": "nmesh", "skin": "nskin", "hfield": "nhfield", "texture": "ntex", "material": "nmat", "pair": "npair", "exclude": "nexclude",
    "equality": "neq", "tendon": "ntendon", "actuator": "nactuator", "sensor": "nsensor", "numeric": "nnumeric",
    "text": "ntext", "tuple": "ntuple", "key": "nkey",
}
FIELDS = HERE.parent.parent / "fields.rs"


def fields(macro):
    """Names of the fields that the compiler or mj_setConst computes, from the field table."""
    table = FIELDS.read_text().split(f"macro_rules! {macro}")[1].split("macro_rules!")[0]
    return re.findall(r"^\s+(\w+): [^,]+(?:, \d\])?.*?, \w+, (?:Compile|SetConst), ", table, re.M)


def numbers(value):
    flat = value.flatten().tolist() if hasattr(value, "flatten") else [value]
    return " ".join(repr(int(x)) if isinstance(x, (bool, int)) else repr(float(x)) for x in flat)


def record(path):
    model = mujoco.MjModel.from_xml_path(str(path))
    lines = []
    for owner, prefix, macro in [
        (model, "model", "model_fields"),
        (model.opt, "opt", "option_fields"),
        (model.stat, "stat", "statistic_fields"),
    ]:
        for name in fields(macro):
            lines.append(f"{prefix}.{name} {numbers(getattr(owner, name))}".rstrip())
    for kind, size in KINDS.items():
        names = [mujoco.mj_id2name(model, getattr(mujoco.mjtObj, f"mjOBJ_{kind.upper()}"), i) for i in range(getattr(model, size))]
        if any(names):
            lines.append(f"names.{kind} {'|'.join(name or '' for name in names)}")
    path.with_suffix(".txt").write_text("\n".join(lines) + "\n")


def schema():
    """Element paths and attribute names from the library's own schema print-out."""
    paths, out = [], {}
    for line in mujoco.mj_printSchema(False, True).splitlines():
        head = re.match(r"^( *)(\S+) \((.)\) *(.*)$", line)
        if head:
            depth = len(head.group(1)) // 3
            paths[depth:] = [head.group(2)]
            out["/".join(paths)] = head.group(4).split()
        else:
            out["/".join(paths)] += line.split()
    rows = [" ".join([path, *sorted(names)]) for path, names in out.items()]
    (HERE / "schema.txt").write_text("\n".join(rows) + "\n")


def glove():
    """A binary skin: a fan of triangles that two bodies carry."""
    n = 8
    vert = [[0.0, 0.0, 0.1]] + [[0.1 * math.cos(k), 0.1 * math.sin(k), 0.01 * k] for k in range(n)]
    texcoord = [[0.5, 0.5]] + [[k / n, 1.0 - k / n] for k in range(n)]
    face = [[0, 1 + k, 1 + (k + 1) % n] for k in range(n)]
    bones = [
        ("upper", [0.0, 0.0, 0.1], [0.5, -0.5, 0.5, 0.5], {i: 1.0 / (1 + i) for i in range(n)}),
        ("lower", [0.1, 0.0, 0.1], [3.0, 0.0, 0.0, 4.0], {i: 0.1 * (1 + i) for i in range(2, n + 1)}),
    ]
    floats = lambda rows: b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows)
    ints = lambda rows: b"".join(struct.pack(f"<{len(row)}i", *row) for row in rows)
    out = struct.pack("<4i", len(vert), len(texcoord), len(face), len(bones)) + floats(vert) + floats(texcoord) + ints(face)
    for body, pos, quat, weights in bones:
        out += body.encode().ljust(40, b"\0") + floats([pos, quat]) + ints([[len(weights)], weights]) + floats([weights.values()])
    (HERE / "parts" / "glove.skn").write_bytes(out)


glove()
for xml in sorted(HERE.glob("*.xml")):
    record(xml)
schema()
