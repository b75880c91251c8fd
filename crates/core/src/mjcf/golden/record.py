"""Records what MuJoCo 3.14.0 compiles for each model of this folder: `python record.py` with mujoco==3.14.0.

Writes, beside each NAME.xml, NAME.txt with one line per field: its name, then its numbers in full precision; one line
per kind of object with the names between bars, where any has one;
and schema.txt, a line per element of the XML schema: path, then attribute names. The tests compare against both.
"""

import pathlib
import re

import mujoco

HERE = pathlib.Path(__file__).parent
KINDS = {
    "body": "nbody", "joint": "njnt", "geom": "ngeom", "site": "nsite", "camera": "ncam", "light": "nlight",
    "mesh": "nmesh", "hfield": "nhfield", "texture": "ntex", "material": "nmat", "pair": "npair", "exclude": "nexclude",
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


for xml in sorted(HERE.glob("*.xml")):
    record(xml)
schema()
