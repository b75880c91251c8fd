// The attribute `verified`, and the hash of content.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import test from "node:test";
import { load } from "./load.mjs";

const { contentHash, readVerified } = await load("proof/verified.ts");
const hash = "a".repeat(64);

test("the hash does not depend on the order of models, and on nothing but the content", () => {
  const lab = { title: "A", model: "b" };
  assert.equal(contentHash(lab, { b: "<x/>", a: "<y/>" }), contentHash(lab, { a: "<z/>", b: "<x/>" }));
  const model = '<include file="p/part.xml"/>';
  const part = { b: model, "p/part.xml": '<mesh file="m.stl"/>', "q/m.stl": Uint8Array.of(1, 2, 200) };
  const whole = contentHash(lab, part);
  assert.notEqual(whole, contentHash(lab, { ...part, "p/part.xml": "" }));
  assert.notEqual(whole, contentHash(lab, { ...part, "q/m.stl": Uint8Array.of(1, 2, 201) }));
  assert.equal(whole, contentHash(lab, { other: "<x/>", ...part }));
  assert.notEqual(contentHash({ questions: [{ sim: { model: "b" } }] }, { b: "1" }), contentHash({ questions: [{ sim: { model: "b" } }] }, { b: "2" }));
  assert.notEqual(contentHash(lab, { b: "<x/>" }), contentHash(lab, { b: "<x />" }));
  assert.notEqual(contentHash(lab), contentHash({ ...lab, title: "B" }));
  assert.equal(contentHash(lab, { b: "<x/>" }), createHash("sha256").update('{"title":"A","model":"b"}\nb\n<x/>').digest("hex"));
});

test("a damaged attribute is none", () => {
  assert.deepEqual(readVerified(JSON.stringify({ claims: 3, version: "0.1.0", hash })), { claims: 3, version: "0.1.0", hash });
  for (const text of [null, "", "{", "[]", "null", '{"claims": 0, "version": "1", "hash": "' + hash + '"}', JSON.stringify({ claims: 1.5, version: "1", hash }),
    JSON.stringify({ claims: 1, version: 1, hash }), JSON.stringify({ claims: 1, version: "1", hash: "xyz" }), JSON.stringify({ claims: 1, version: "x".repeat(200), hash }),
    " ".repeat(20_000)]) assert.equal(readVerified(text), null);
});
