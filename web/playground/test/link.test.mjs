// Links: what goes in comes out; whatever else is in a fragment is refused with a sentence, and quickly.
import assert from "node:assert/strict";
import test from "node:test";
import { deflateRawSync } from "node:zlib";
import { load, random } from "./load.mjs";

const { decodeProject, encodeProject, MOST_CHARACTERS, OpenError } = await load("link.ts", "project.ts");
const project = { lab: '{"model": "drop", "title": "Würfel 😀"}\n', models: { drop: "<mujoco/>", "parts/floor.xml": "<mujoco><!-- ü --></mujoco>" }, files: { "a.obj": Uint8Array.from([0, 1, 2, 255]) }, model: "drop", lesson: null };
const pack = (text) => `#play1=${deflateRawSync(text).toString("base64url")}`;
const refused = (fragment, why) => assert.rejects(decodeProject(fragment), (e) => e instanceof OpenError && why.test(e.message), fragment.slice(0, 80));

test("a project goes through a link", async () => {
  const fragment = await encodeProject(project);
  assert.match(fragment, /^#play1=[\w-]+$/);
  assert.deepEqual(await decodeProject(fragment), project);
  assert.deepEqual(await decodeProject(`${fragment}&lab.lab=abc`), project);
  for (const none of ["", "#", "#section", "#lab.drop=abc", "#display1=x"]) assert.equal(await decodeProject(none), null);
});

test("what is too large is not put into a link", async () => {
  const next = random(1);
  const noise = Array.from({ length: 100_000 }, () => String.fromCharCode(33 + next(90))).join("");
  assert.equal(await encodeProject({ ...project, models: { drop: noise } }), null);
  assert.equal(await encodeProject({ ...project, files: { "a.obj": new Uint8Array(MOST_CHARACTERS + 1) } }), null);
  assert.equal(await encodeProject({ ...project, lab: "x".repeat(5 << 20) }), null);
});

test("links of other versions and damaged ones say why", async () => {
  await refused("#play0=abc", /older version/);
  await refused("#play2=abc", /newer version of the playground \(format 2; this page reads format 1\)/);
  await refused("#play1=", /damaged/);
  await refused("#play1=a b", /characters/);
  await refused(`#play1=${"a".repeat(MOST_CHARACTERS + 1)}`, /longer than/);
  await refused("#play1=AAAA", /unpacked|JSON/);
  await refused(pack("{"), /JSON/);
  await refused(pack(Buffer.from([0xff, 0xfe])), /text/);
  for (const json of ["null", "[]", "1", '{"lab": 1}', '{"lab": "", "models": []}', '{"lab": "", "models": {"a": 1}, "files": {}}', '{"lab": "", "models": {}, "files": {"a": "*"}}']) await refused(pack(json), /damaged/);
  for (const name of ["../a", "/a", "a//b", "a\\b", "", ".", "a/../b", "a\u0000b", "x".repeat(201)]) await refused(pack(JSON.stringify({ lab: "", models: { [name]: "" }, files: {} })), /name/);
  await refused(pack(JSON.stringify({ lab: "", models: Object.fromEntries(Array.from({ length: 101 }, (_, i) => [`m${i}`, ""])), files: {} })), /more than 100 files/);
  // A hundred megabytes in a hundred kilobytes, and more than a link may have.
  await refused(pack(" ".repeat(30 << 20)), /larger than 4 MB/);
});

test("a name of the prototype is a name", async () => {
  const linked = await decodeProject(pack('{"lab": "{}", "models": {"__proto__": "<mujoco/>", "constructor": "<mujoco/>"}, "files": {}, "model": "toString"}'));
  assert.deepEqual(Object.keys(linked.models), ["__proto__", "constructor"]);
  assert.equal(linked.model, "__proto__");
  assert.equal({}.polluted, undefined);
});

test("random fragments are projects or refused", async () => {
  const [next, whole] = [random(20261126), await encodeProject(project)];
  const alphabet = "ABCxyz019-_=&#%play.";
  let opened = 0;
  for (let i = 0; i < 1500; i++) {
    let fragment = whole;
    for (let n = 1 + next(3); n > 0; n--) {
      const at = i % 2 === 0 ? next(fragment.length) : 7 + next(fragment.length - 7);
      fragment = fragment.slice(0, at) + Array.from({ length: next(4) }, () => alphabet[next(alphabet.length)]).join("") + fragment.slice(at + next(5));
    }
    try {
      const found = await decodeProject(fragment);
      if (found === null) continue;
      opened += 1;
      assert.equal(typeof found.lab, "string");
      assert.ok(Object.values(found.models).every((xml) => typeof xml === "string") && Object.values(found.files).every((bytes) => bytes instanceof Uint8Array));
    } catch (e) {
      assert.ok(e instanceof OpenError, `${fragment}: ${e}`);
    }
  }
  assert.ok(opened < 1500);
});
