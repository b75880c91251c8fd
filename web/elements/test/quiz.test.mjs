// Answers: right and wrong, and those that a page does not show.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import test from "node:test";
import { load, random } from "./load.mjs";

const { hashAnswer, sha256 } = await load("quiz/hash.ts");
const { readQuiz } = await load("quiz/read.ts");
const { isRightChoice, isRightNumber } = await load("quiz/grade.ts");
const { english } = await load("text/en.ts");
const say = (name, values = {}) => english[name].replace(/\{(\w+)\}/g, (_, key) => String(values[key]));
const read = (question) => readQuiz({ questions: [question] }, say).questions[0];

test("SHA-256 is that of node", () => {
  const next = random(3);
  for (let length = 0; length < 300; length++) {
    const text = Array.from({ length }, () => String.fromCharCode(32 + Math.floor(next() * 2000))).join("");
    assert.equal(sha256(text), createHash("sha256").update(text).digest("hex"));
  }
});

test("the answers of each kind", () => {
  const mcq = read({ q: "?", options: ["a", "b", "c"], answer: 1 });
  assert.deepEqual([0, 1, 2].map((i) => isRightChoice(mcq, [i])), [false, true, false]);
  const multiple = read({ kind: "multiple", q: "?", options: ["a", "b", "c"], answer: [2, 0] });
  assert.deepEqual([[0], [0, 2], [2, 0], [0, 1, 2], []].map((c) => isRightChoice(multiple, c)), [false, true, true, false, false]);
  const truth = read({ kind: "truefalse", q: "?", answer: false });
  assert.deepEqual([0, 1].map((i) => isRightChoice(truth, [i])), [false, true]);
  const number = read({ kind: "numeric", q: "?", answer: 10, unit: "N" });
  assert.deepEqual([9.8, 9.79, 10.2, 10.21].map((x) => isRightNumber(number, x)), [true, false, true, false]);
  assert.equal(read({ kind: "numeric", q: "?", answer: 5.886, tol: 0.01 }).tol, 0.01);
});

test("a hash keeps the answer out of the page", () => {
  const hidden = (kind, answer, options = ["a", "b", "c"]) => read({ kind, q: "?", options, hash: { salt: "s1", sha256: hashAnswer("s1", answer) } });
  const mcq = hidden("mcq", 2);
  assert.deepEqual([0, 1, 2].map((i) => isRightChoice(mcq, [i])), [false, false, true]);
  const multiple = hidden("multiple", [2, 1]);
  assert.deepEqual([[1], [1, 2], [2, 1]].map((c) => isRightChoice(multiple, c)), [false, true, true]);
  const truth = hidden("truefalse", true);
  assert.deepEqual([0, 1].map((i) => isRightChoice(truth, [i])), [true, false]);
  assert.notEqual(hashAnswer("s1", 2), hashAnswer("s2", 2));
});

test("a question that cannot be asked says why", () => {
  for (const [question, why] of [
    [{ options: ["a", "b"], answer: 0 }, /text "q"/], [{ q: "?", options: ["a"], answer: 0 }, /two or more/], [{ q: "?", options: ["a", "b"], answer: 2 }, /names one/],
    [{ q: "?", options: ["a", "b"] }, /names one/], [{ kind: "numeric", q: "?" }, /needs a number/], [{ kind: "essay", q: "?" }, /unknown kind "essay"/],
    [{ q: "?", options: ["a", "b"], hash: { salt: "s", sha256: "x" } }, /hash/], [null, /text "q"/],
  ]) {
    const { kind, why: said } = read(question);
    assert.equal(kind, "broken");
    assert.match(said, why);
  }
  assert.equal(readQuiz({}, say), null);
});
