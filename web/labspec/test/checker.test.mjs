import assert from "node:assert/strict";
import test from "node:test";
import { Checker, Lab } from "labspec/checker";
import { drop, lab as json } from "./common.mjs";

const block = (language, object) => `\`\`\`${language}\n${JSON.stringify(object)}\n\`\`\`\n`;

test("a lesson is checked from its text", () => {
  const lesson = "é😀\n\n```lab\n{\"model\": \"drop\", \"readouts\": [{\"label\": \"x\", \"expr\": \"data.qpso[2]\"}]}\n```\n";
  const report = new Checker({ drop }).check("fall.md", lesson);
  assert.equal(report.outcome, "findings");
  const [finding] = report.findings;
  assert.deepEqual([finding.code, finding.line, lesson.slice(finding.start, finding.end)], ["unknown-field", 4, "qpso"]);
  assert.equal(finding.startByte - finding.start, 3);
});

test("labs of other lessons are found among the neighbours", () => {
  const other = block("lab", { model: "drop", readouts: [{ label: "height (m)", expr: "data.qpos[2]" }] });
  const question = {
    kind: "mcq", q: "Does it fall?", options: ["yes", "no"], answer: 0, explain: "<p>It does.</p>",
    verify: { lab: "labs.md#1", runs: { run: { until: 0.1 } }, measure: { h: "final(shown('height (m)'))" }, options: ["h < 1", "h >= 1"] },
  };
  const lesson = block("quiz", { id: "fall", questions: [question] });
  const unknown = (checker) => checker.check("week/fall.md", lesson).findings.filter((f) => f.code === "unknown-lab").length;
  assert.equal(unknown(new Checker({ drop }).neighbours({ "week/labs.md": other })), 0);
  assert.ok(unknown(new Checker({ drop })) > 0);
});

test("the checker's module plays labs as well", () => {
  const lab = new Lab(json, { drop });
  assert.equal(lab.playTo(0.1), 50);
});
