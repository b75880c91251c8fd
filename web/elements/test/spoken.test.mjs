// Events as sentences: one for each event, and a short list of many.
import assert from "node:assert/strict";
import test from "node:test";
import { load } from "./load.mjs";

const { describeEvent, summarize } = await load("lab/spoken.ts");
const { english } = await load("text/en.ts");
const say = (name, values = {}) => english[name].replace(/\{(\w+)\}/g, (_, key) => String(values[key]));
const contact = (first, time) => ({ type: "contact", time, first, second: "floor", touching: true });

test("many contacts are one sentence of the list, and each of them has its own", () => {
  const events = [...["a", "b", "c", "d", "e"].map((name, i) => contact(name, 0.1 * i)), { type: "stop", time: 0.5 }];
  assert.deepEqual(summarize(events, say), ["5 contacts begin or end from 0.000 s to 0.400 s.", "The lab stops at 0.500 s."]);
  assert.deepEqual(events.map((event) => describeEvent(event, say)), [
    ...["A", "B", "C", "D", "E"].map((name, i) => `${name} touches floor at 0.${i}00 s.`), "The lab stops at 0.500 s.",
  ]);
});
