// The module beside the program: every lab of the corpus, all samples bit for bit; and a lesson checked from its text.
//
//   node bindings/wasm/test.mjs PROGRAM FOLDER-OF-LABS FOLDER-OF-MODELS [FOLDER-OF-LABS FOLDER-OF-MODELS …]
//
// PROGRAM is the `labspec` to compare with; the package is built by `bindings/xtask`.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const { Lab, check } = createRequire(import.meta.url)("./pkg/node/labspec.js");
const [program, ...folders] = process.argv.slice(2);
const json = (args) => JSON.parse(execFileSync(program, args, { maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "ignore"] }));
// Nothing of this file or of the module may evaluate text.
globalThis.eval = () => assert.fail("eval was called");

const bits = (x) => new BigUint64Array(Float64Array.of(x).buffer)[0];

/** A number of the report: what is none is named beside the rows. */
function rowsOf(report) {
  const rows = report.rows.map((row) => row.map((x) => (typeof x === "number" ? x : x === null ? NaN : Number(x))));
  for (const [row, column, name] of report.nonfinite?.rows ?? []) rows[row][column] = Number(name);
  return rows;
}

let labs = 0;
let numbers = 0;
for (let i = 0; i + 1 < folders.length; i += 2) {
  const models = {};
  for (const file of readdirSync(folders[i + 1]).filter((f) => f.endsWith(".xml"))) {
    models[file.slice(0, -4)] = readFileSync(join(folders[i + 1], file), "utf8");
  }
  for (const file of readdirSync(folders[i]).filter((f) => f.endsWith(".json")).sort()) {
    const path = join(folders[i], file);
    const native = json(["run", path, "--models", folders[i + 1], "--format", "json"]);
    const lab = new Lab(readFileSync(path, "utf8"), models);
    assert.deepEqual(lab.findings.filter((f) => f.severity === "error"), [], file);
    const rows = rowsOf(native);
    const texts = native.types?.map((type) => type === "text" || type === "string") ?? [];
    const width = native.columns.length;
    const recorded = lab.record(rows.length - 1);
    assert.equal(recorded.length, rows.length * width, `${file}: as many numbers`);
    rows.forEach((row, r) =>
      row.forEach((x, c) => {
        if (texts[c]) return;
        const y = recorded[r * width + c];
        const same = Number.isNaN(x) ? Number.isNaN(y) : bits(x) === bits(y);
        assert.ok(same, `${file}: ${native.columns[c]} at row ${r}: ${x} natively, ${y} here`);
        numbers += 1;
      }),
    );
    labs += 1;
  }
}
assert.ok(labs > 0 || folders.length === 0, "no lab was run");

// A lab in the hand of a page: controls, a press, a state and back.
const drop = "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body name='bob' pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>";
const lab = new Lab(
  JSON.stringify({
    model: "drop",
    controls: [
      { label: "gravity", unit: "m/s^2", set: "model.opt.gravity[2]", min: -20, max: -1, step: 0.1, value: -9.8, reset: true },
      { type: "button", label: "kick", run: "data.qvel[2] = 3" },
    ],
    readouts: [{ label: "height (m)", expr: "data.body('bob').xpos[2]" }],
  }),
  { drop },
);
assert.deepEqual(lab.controls.map((c) => [c.kind, c.label]), [["slider", "gravity"], ["button", "kick"]]);
assert.deepEqual(lab.shown, [{ label: "height (m)", unit: "m", digits: 3 }]);
lab.playTo(0.1);
const state = lab.save();
lab.press("kick");
lab.playTo(0.2);
const [high] = lab.numbers;
lab.restore(state);
lab.playTo(0.2);
const [low] = lab.numbers;
assert.ok(high > low + 0.2, `${high} ${low}`);
lab.set("gravity", -1.6);
assert.throws(() => lab.set("gravty", 1), /gravity/);
assert.throws(() => new Lab("{\"model\": \"drop\", \"plot\": []}", { drop: "<mujoco" }), (e) => e.findings.length > 0);

// A lesson from its text.
const report = check("fall.md", "```lab\n{\"model\": \"drop\", \"readouts\": [{\"label\": \"x\", \"expr\": \"data.qpso[2]\"}]}\n```\n", { drop });
assert.equal(report.outcome, "findings");
assert.deepEqual(report.findings.map((f) => [f.code, f.line]), [["unknown-field", 2]]);

// A lab of another lesson is found among the neighbours, and only there.
const block = (language, object) => `\`\`\`${language}\n${JSON.stringify(object)}\n\`\`\`\n`;
const other = block("lab", { model: "drop", readouts: [{ label: "height (m)", expr: "data.qpos[2]" }] });
const question = {
  kind: "mcq", q: "Does it fall?", options: ["yes", "no"], answer: 0, explain: "<p>It does.</p>",
  verify: { lab: "labs.md#1", runs: { run: { until: 0.1 } }, measure: { h: "final(shown('height (m)'))" }, options: ["h < 1", "h >= 1"] },
};
const lesson = block("quiz", { id: "fall", questions: [question] });
const unknown = (neighbours) =>
  check("week/fall.md", lesson, { drop }, neighbours).findings.filter((f) => f.code === "unknown-lab").length;
assert.equal(unknown({ "week/labs.md": other }), 0);
assert.ok(unknown({}) > 0 && unknown() > 0 && unknown({ "labs.md": other }) > 0);
assert.throws(() => check("fall.md", lesson, { drop }, "labs.md"), /neighbours/);
console.log(`${labs} labs, ${numbers} numbers with the same bits; controls, states, findings and a check as they should be`);
