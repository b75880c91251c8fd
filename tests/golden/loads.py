#!/usr/bin/env python3
"""Which models MuJoCo loads when one attribute of a zoo model is set to something odd.

    $PY tests/golden/loads.py [SEED] > tests/golden/loads.json

Written are the edits, as bytes of the model's text, and what the real library (3.14.0) says: an empty text, or why it refuses.
A child process loads them: some of these models end or hang the library, and are left out.
"""
import glob, json, os, random, re, select, subprocess, sys

HERE = os.path.dirname(os.path.abspath(__file__))
ZOO = os.path.join(HERE, "../../specs/models/zoo")
VALUES = ["0", "-1", "1", "0 0", "1 2 3", "0.5 0.5", "-1 -1 -1", "0 0 0", "1e12", "200", "", "x", "true", "0 0 0 0", "-1 1", "1 -1", "nan"]
CASES = 3000


def load(path):
    import mujoco
    try:
        mujoco.MjModel.from_xml_path(path)
        return ""
    except Exception as e:
        return " ".join(str(e).split())[:100] or "refused"


def attributes():
    """Attributes by element, as our page of compatibility names them."""
    table = {}
    for line in open(os.path.join(HERE, "../../docs/reference/compatibility.md")):
        row = re.match(r"\| `mujoco/(?:[^`]*/)?(\w+)` \| (.*) \|$", line)
        if row:
            for kind, names in re.findall(r"(supported|ignored|partly)[^:;]*: ([^;]*)", row[2]):
                table.setdefault(row[1], set()).update(re.findall(r"`(\w+)`", names))
    return table


def cases(seed):
    pick = random.Random(seed)
    table, spots = attributes(), {}
    for path in sorted(glob.glob(ZOO + "/*.xml")):
        text = open(path).read()
        if "file=" in text or len(text) != len(text.encode()):
            continue
        bare = re.sub(r"<!--.*?-->", lambda m: " " * len(m[0]), text, flags=re.S)
        for tag in re.finditer(r"<(\w+)((?:\s+\w+\s*=\s*(?:\"[^\"]*\"|'[^']*'))*)\s*/?>", bare):
            spots.setdefault(tag[1], []).append((os.path.basename(path), text, tag))
    names = [(e, a) for e in sorted(table) for a in sorted(table[e]) if e in spots]
    for _ in range(CASES):
        element, attribute = pick.choice(names)
        file, text, tag = pick.choice(spots[element])
        value = pick.choice(VALUES)
        old = re.search(rf"\s{attribute}\s*=\s*(\"[^\"]*\"|'[^']*')", tag[2])
        if old:
            start, end = tag.start(2) + old.start(1), tag.start(2) + old.end(1)
            yield file, text, start, end, f'"{value}"'
        else:
            at = tag.end(1)
            yield file, text, at, at, f' {attribute}="{value}"'


def main(seed):
    scratch = os.path.join("/tmp", f"loads-{os.getpid()}.xml")
    child, out = None, []
    for file, text, start, end, new in cases(seed):
        open(scratch, "w").write(text[:start] + new + text[end:])
        if child is None:
            child = subprocess.Popen([sys.executable, __file__, "--child"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, bufsize=1)
        child.stdin.write(scratch + "\n")
        child.stdin.flush()
        ready, _, _ = select.select([child.stdout], [], [], 10)
        line = child.stdout.readline() if ready else ""
        if not line:
            child.kill()
            child = None
            continue
        # Memory that the text itself limits: ours grows as needed.
        if "engine error" in line:
            continue
        out.append([file, start, end, new, json.loads(line)])
    print("[" + ",\n".join(json.dumps(c, ensure_ascii=False) for c in out) + "]")


if sys.argv[1:] == ["--child"]:
    for path in sys.stdin:
        print(json.dumps(load(path.strip())), flush=True)
else:
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1)
