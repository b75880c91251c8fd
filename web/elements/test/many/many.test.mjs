// 40 labs on one page, for a minute and a half: one WebGL context, answers from every lab, half of them within 50 ms, memory that does not grow.
// Chromium draws in software here, on the cores of the labs, so the slowest answers depend on the machine (docs/measured/many-labs.md). `bench/many.mjs` runs it longer.
import assert from "node:assert/strict";
import test from "node:test";
import { LABS, quantile, useManyLabs } from "./use.mjs";

test("a page with 40 labs, one of them slower than real time", { timeout: 240_000 }, async (t) => {
  const { answers, memory, contexts, open, realTime, errors } = await useManyLabs(90, 3);
  const mb = memory.map(({ process, objects }) => `${(process / 2 ** 20).toFixed(0)} and ${(objects / 2 ** 20).toFixed(1)} MB`);
  t.diagnostic(`${answers.length} answers, median ${quantile(answers, 0.5).toFixed(1)} ms, 95 % ${quantile(answers, 0.95).toFixed(1)} ms; ${mb.join(", ")}; ${realTime.toFixed(3)} of real time`);
  assert.deepEqual(errors, []);
  assert.equal(open, LABS, "every lab was opened and played");
  assert.deepEqual(contexts, { made: 1, lost: 0 });
  assert.ok(realTime > 0 && realTime < 0.9, `the slow model has ${realTime} of real time`);
  assert.ok(answers.length > 30, `${answers.length} answers`);
  assert.ok(quantile(answers, 0.5) < 50, `half of the answers took more than ${quantile(answers, 0.5)} ms`);
  // The first part opens the labs.
  const [, before, after] = memory;
  // In ten minutes it goes up and down by a tenth, and does not grow.
  assert.ok(after.process < 1.25 * before.process, `the process grew from ${before.process} to ${after.process} bytes`);
  assert.ok(after.objects < 1.15 * before.objects, `objects grew from ${before.objects} to ${after.objects} bytes`);
});
