// What an editor asks of the checker: findings with fixes, completions, hover texts, formatted code.
import assert from "node:assert/strict";
import test from "node:test";
import { Checker, LabspecError } from "labspec/checker";
import { drop } from "./common.mjs";

const block = (json) => `# Ein Würfel 😀\n\n\`\`\`lab simlab\n${json}\n\`\`\`\n`;
const apply = (text, edit) => text.slice(0, edit.start) + edit.text + text.slice(edit.end);
/** The text without `|`, and its offset. */
const marked = (text) => [text.replace("|", ""), text.indexOf("|")];

test("findings have their place and their fixes", () => {
  const lesson = block('{"model": "drop", "readouts": [{"label": "x😀", "expr": "data.qpso[2]"}]}');
  const [finding] = new Checker({ drop }).findings("fall.md", lesson);
  assert.deepEqual([finding.code, finding.line, lesson.slice(finding.start, finding.end)], ["unknown-field", 4, "qpso"]);
  const [fix] = finding.fixes;
  assert.match(fix.title, /qpos/);
  assert.equal(apply(lesson, fix.edits[0]), lesson.replace("qpso", "qpos"));
  const checked = new Checker({ drop }).check("fall.md", lesson).findings.find((f) => f.code === "unknown-field");
  assert.deepEqual(checked.fixes, finding.fixes);
});

test("a warning can be suppressed", () => {
  const lesson = block('{"model": "drop", "controls": [{"label": "k", "min": 0, "max": 1, "value": 0.5, "apply": "data.qvel[2] = 1"}]}');
  const checker = new Checker({ drop });
  const warning = checker.findings("fall.md", lesson).find((f) => f.severity !== "error");
  const fix = warning.fixes.find((f) => f.kind === "suppression");
  const suppressed = checker.findings("fall.md", apply(lesson, fix.edits[0]).replace('"why": ""', '"why": "an example"'));
  assert.ok(!suppressed.some((f) => f.code === warning.code), JSON.stringify(suppressed));
});

test("completions know the format, the language and the model", () => {
  for (const [inside, wanted, not] of [
    ['"con|"', "controls", "model"], ['"setup": "data.|"', "qpos", "geom_size"], ['"setup": "data.body(\'|\')"', "bob", "ball"],
    ['"readouts": [{"label": "a", |}]', "expr", "label"],
  ]) {
    const [text, offset] = marked(block(`{"model": "drop", ${inside}}`));
    const all = new Checker({ drop }).complete("a.md", text, offset);
    const labels = all.map((c) => c.label);
    assert.ok(labels.includes(wanted) && !labels.includes(not), `${inside}: ${labels}`);
    const chosen = all.find((c) => c.label === wanted);
    assert.ok(apply(text, chosen.edit).includes(wanted) && chosen.edit.start <= offset && offset <= chosen.edit.end);
  }
  const [text, offset] = marked('{"model": "|"}');
  assert.deepEqual(new Checker({ drop }).complete("lab.json", text, offset).map((c) => c.label), ["drop"]);
});

test("models are completed and explained from the schema", () => {
  const checker = new Checker();
  const [text, offset] = marked("<mujoco><worldbody><geom type='|'/></worldbody></mujoco>");
  const capsule = checker.complete("drop.xml", text, offset).find((c) => c.label === "capsule");
  assert.equal(apply(text, capsule.edit), text.replace("''", "'capsule'"));
  assert.match(checker.hover("drop.xml", drop, drop.indexOf("size")).text, /\*\*size\*\*: 1 to 3 numbers/);
  const [finding] = checker.findings("drop.xml", drop.replace("size='.1'", "size='x'"));
  assert.deepEqual([finding.severity, drop.replace("size='.1'", "size='x'").slice(finding.start, finding.end)], ["error", "x"]);
  assert.deepEqual(checker.findings("drop.xml", drop), []);
  // A model inside of a lab.
  const [lab, at] = marked('{"xml": "<mujoco><worldbody><geom | size=\'1\'/></worldbody></mujoco>"}');
  const type = checker.complete("lab.json", lab, at).find((c) => c.label === "type");
  assert.equal(apply(lab, type.edit).includes('<geom type=\\"\\"'), true, apply(lab, type?.edit));
});

test("hover tells the meaning and the value at the start", () => {
  const text = block('{"model": "drop", "readouts": [{"label": "x", "expr": "data.qpos[2]"}]}');
  const checker = new Checker({ drop });
  const hover = checker.hover("a.md", text, text.indexOf("qpos[") + 5);
  assert.match(hover.text, /\*\*1\*\*/);
  assert.equal(text.slice(hover.start, hover.end), "data.qpos[2]");
  const key = checker.hover("a.md", text, text.indexOf("expr") + 1);
  assert.match(key.text, /\*\*expr\*\*: .+\n\n.{10}/s);
  assert.equal(checker.hover("a.md", text, 2), null);
});

test("code is formatted, and safe fixes are applied at once", () => {
  const text = block('{"model": "drop", "setup": "ctx.a=1;ctx.b=2", "readouts": [{"label": "x", "exprr": "data.qpos[2]+ctx.a+ctx.b"}]}');
  const checker = new Checker({ drop });
  const formatted = checker.format("a.md", text);
  assert.ok(formatted.includes("ctx.a = 1") && formatted.startsWith("# Ein Würfel 😀"), formatted);
  assert.equal(checker.format("a.md", formatted), formatted);
  const fix = checker.fixAll("a.md", text);
  if (fix !== null) assert.ok(apply(text, fix.edits[0]).includes('"expr"'));
});

test("the labs of a lesson are opened alone", () => {
  const text = `${block('{"model": "drop", "title": "One"}')}\n> \`\`\`lab\n> {"model": "drop",\n>  "title": "Two"}\n> \`\`\`\n`;
  const labs = new Checker({ drop }).labs("a.md", text);
  assert.deepEqual(labs.map(({ address, title, model, json }) => [address, title, model, JSON.parse(json).title]), [["#1", "One", "drop", "One"], ["#2", "Two", "drop", "Two"]]);
  assert.equal(text.slice(labs[0].start, labs[0].end), labs[0].json);
});

test("another text of the same path is another text", () => {
  const checker = new Checker({ drop });
  const [bad, good] = ["qpso", "qpos"].map((name) => block(`{"model": "drop", "readouts": [{"label": "x", "expr": "data.${name}[2]"}]}`));
  for (let i = 0; i < 3; i++) {
    assert.equal(checker.findings("a.md", bad).length, 1);
    assert.equal(checker.findings("a.md", good).length, 0);
    assert.equal(checker.findings("b.md", bad).length, 1);
    if (i === 1) checker.free();
  }
  assert.throws(() => checker.findings("a.md", "x".repeat((16 << 20) + 1)), (e) => e instanceof LabspecError && e.code === "too-large");
});

let seed = 20261126;
const random = (n) => {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return Math.floor((seed / 2 ** 32) * n);
};

test("damaged texts at any offset: places are inside of the text, nothing fails", () => {
  const quiz = '```quiz\n{"id": "q", "questions": [{"q": "Fällt er? 😀", "options": ["ja", "nein"], "answer": 0, "explain": "1.2 m", "verify": {"lab": "#1", "runs": {"run": {"until": 0.1}}, "measure": {"h": "final(data.qpos[2])"}, "options": ["h < 1", "h >= 1"]}}]}\n```\n';
  const lesson = block('{"model": "drop", "setup": "ctx.peak = 0", "controller": "ctx.peak = Math.max(ctx.peak, data.qvel[2])",\n "controls": [{"label": "g", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "value": -9.8}], "plots": [{"traces": [{"label": "h", "expr": "data.body(\'bob\').xpos[2]"}]}]}') + quiz;
  const texts = [["a.md", lesson], ["lab.json", lesson.split("\n").slice(3, 5).join("\n")], ["drop.xml", drop]];
  const pieces = ['"', "{", "}", "😀", "\ud800", "<", ">", "'", "\\", "\n", "data.", "```", "<geom ", "é", ""];
  const checker = new Checker({ drop });
  for (let i = 0; i < 250; i++) {
    const [path, whole] = texts[i % 3];
    let text = whole;
    for (let n = random(4); n > 0; n--) {
      const at = random(text.length);
      text = text.slice(0, at) + pieces[random(pieces.length)] + text.slice(at + random(6));
    }
    const offset = random(text.length + 3);
    const inside = ({ start, end }) => assert.ok(0 <= start && start <= end && end <= text.length, `${path} ${start} ${end} of ${text.length}`);
    for (const finding of checker.findings(path, text)) {
      if (finding.file === path) inside(finding);
      finding.fixes.forEach((fix) => fix.edits.forEach(inside));
    }
    checker.complete(path, text, offset).forEach((c) => inside(c.edit));
    const hover = checker.hover(path, text, offset);
    if (hover !== null) inside(hover);
    assert.equal(typeof checker.format(path, text), "string");
  }
});
