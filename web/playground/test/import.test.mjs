// Files that are opened: which is the model, where its files are, and what archives may hold.
import assert from "node:assert/strict";
import test from "node:test";
import { zipSync } from "fflate";
import { Checker } from "labspec/checker";
import { load, random } from "./load.mjs";

const { fitting, isFileName, labOfModel, lessonOf, listedModels, openGiven, OpenError, unpack } = await load("import.ts", "project.ts", "values.ts");
const projectOf = async (...args) => (await openGiven(...args)).project;
const bytes = (text) => new TextEncoder().encode(text);
const file = (path, text) => ({ path, bytes: bytes(text) });
const findLabs = async (path, text) => new Checker().labs(path, text);
const refused = (promise, why) => assert.rejects(promise, (e) => e instanceof OpenError && why.test(e.message));

test("a model alone gets a lab that shows it", async () => {
  const project = await projectOf([file("drop.xml", "<mujoco/>")], null, findLabs);
  assert.deepEqual([project.model, project.models], ["drop", { drop: "<mujoco/>" }]);
  assert.equal(project.lab, labOfModel("drop"));
  const problems = new Checker({ drop: "<mujoco/>" }).findings("lab.json", project.lab).filter((f) => f.severity === "error");
  assert.deepEqual(problems, []);
});

test("a folder: the model that no other includes, with paths from its folder", async () => {
  const project = await projectOf([
    file("robot/parts/floor.xml", "<mujoco/>"), file("robot/scene.xml", "<mujoco><include file='parts/floor.xml'/></mujoco>"),
    file("robot/parts/arm.obj", "v 0 0 0"), file("robot/.git/x.xml", "<mujoco/>"), file("robot/notes.txt", "…"),
  ], null, findLabs);
  assert.deepEqual([project.model, Object.keys(project.models).sort(), Object.keys(project.files).sort()], ["scene", ["parts/floor.xml", "scene"], ["notes.txt", "parts/arm.obj"]]);
});

test("a lab names its model, in a lesson or as JSON", async () => {
  const models = [file("models/other.xml", "<mujoco model='o'/>"), file("models/drop.xml", "<mujoco model='d'/>")];
  const json = await projectOf([file("lab.json", '{"model": "drop"}'), ...models], null, findLabs);
  assert.deepEqual([json.model, json.lab], ["drop", '{"model": "drop"}']);
  const lesson = await projectOf([file("a.md", '# A\n\n```lab\n{"model": "drop", "title": "T"}\n```\n'), ...models], null, findLabs);
  assert.deepEqual([lesson.model, lesson.lab], ["drop", '{"model": "drop", "title": "T"}']);
});

test("of a lesson, every lab and the simulation of every question can be opened", async () => {
  const fence = (info, json) => `\`\`\`${info}\n${JSON.stringify(json)}\n\`\`\`\n`;
  const question = { q: "Where?", kind: "predict", options: ["a", "b"], answer: 0, sim: { model: "other", title: "Q" } };
  const lesson = [fence("lab simlab", { model: "drop", title: "One" }), fence("quiz", { id: "z", questions: [{ q: "?", options: ["a", "b"], answer: 0 }, question] }), fence("lab simlab", { model: "other" })].join("\n");
  const given = [file("week/a.md", lesson), file("week/models/drop.xml", "<mujoco model='d'/>"), file("week/models/other.xml", "<mujoco model='o'/>"), file("week/x.json", '{"model": "drop", "title": "J"}')];
  const first = await openGiven(given, null, findLabs);
  assert.deepEqual([first.place, first.project.model, first.project.lesson], ["week/x.json", "drop", null]);
  assert.deepEqual(first.labs, [
    { place: "week/x.json", title: "J" }, { place: "week/a.md#1", title: "One" }, { place: "week/a.md#2", title: "" }, { place: "week/a.md#z.2", title: "Q" },
  ]);
  const asked = await openGiven(given, null, findLabs, "week/a.md#z.2");
  assert.deepEqual([asked.place, asked.project.model, JSON.parse(asked.project.lab)], ["week/a.md#z.2", "other", question.sim]);
  const { before, after, address } = asked.project.lesson;
  assert.deepEqual([`${before}${asked.project.lab}${after}`, address], [lesson, "#z.2"]);
  // A place that is not there is the first lab; a model alone has no labs to choose.
  assert.equal((await openGiven(given, null, findLabs, "week/a.md#9")).place, "week/x.json");
  assert.deepEqual((await openGiven([file("drop.xml", "<mujoco/>")], null, findLabs)).labs, []);
});

test("a lesson that was downloaded is opened again", async () => {
  const project = { lab: '{"model": "drop", "title": "``` 😀"}\n', models: { drop: "<mujoco>\n<!-- ```` -->\n</mujoco>\n", "parts/a b.xml": "<mujoco/>\n" }, files: {}, model: "drop" };
  const lesson = lessonOf(project);
  assert.deepEqual(listedModels(lesson), { drop: project.models.drop, "parts/a b": "<mujoco/>\n" });
  const again = await projectOf([file("lesson.md", lesson)], null, findLabs);
  assert.deepEqual([again.lab, again.model, again.models.drop], [project.lab.trim(), "drop", project.models.drop]);
});

test("meshes alone are added to what is open", async () => {
  const current = { lab: "{}", models: { a: "<mujoco/>" }, files: { "x.obj": bytes("1") }, model: "a" };
  const project = await projectOf([file("meshes/y.stl", "2")], current, findLabs);
  assert.deepEqual([Object.keys(project.files), project.model], [["x.obj", "y.stl"], "a"]);
  await refused(projectOf([file("meshes/y.stl", "2")], null, findLabs), /no model and no lab/);
  await refused(projectOf([file("../y.stl", "2")], current, findLabs), /no file/);
  await refused(projectOf([{ path: "a.xml", bytes: Uint8Array.from([0xff, 0xff]) }], current, findLabs), /UTF-8/);
});

test("archives are opened within limits", async () => {
  const archive = zipSync({ "robot/scene.xml": bytes("<mujoco/>"), "robot/a.obj": bytes("v"), "../evil.xml": bytes("<mujoco/>") });
  const project = await projectOf([{ path: "robot.mjz", bytes: archive }], null, findLabs);
  assert.deepEqual([project.model, Object.keys(project.models), Object.keys(project.files)], ["scene", ["scene"], ["a.obj"]]);
  assert.throws(() => unpack(zipSync(Object.fromEntries(Array.from({ length: 501 }, (_, i) => [`m${i}.xml`, bytes("")])))), /more than 500/);
  assert.throws(() => unpack(zipSync({ a: new Uint8Array(65 << 20) })), /larger than 64 MB/);
  // An archive that lies about sizes, and damaged ones.
  const next = random(7);
  for (let i = 0; i < 400; i++) {
    const damaged = archive.slice(0, i % 4 === 0 ? next(archive.length) : archive.length);
    for (let n = next(6); n > 0 && damaged.length > 0; n--) damaged[next(damaged.length)] = next(256);
    try { unpack(damaged); } catch (e) { assert.ok(e instanceof OpenError, String(e)); }
  }
});

test("values are kept where the controls still have them", () => {
  const values = new Map([["g", -3], ["h", 9], ["start", "low"], ["gone", 1]]);
  const lab = JSON.stringify({ controls: [{ label: "g", min: -9, max: 0 }, { label: "h", min: 0, max: 1 }, { type: "select", label: "start", options: [["Low", "low"]] }, null, 3] });
  assert.deepEqual(fitting(lab, values), [["g", -3], ["start", "low"]]);
  for (const none of ["", "{", "[]", '{"controls": 3}', "null"]) assert.deepEqual(fitting(none, values), []);
});

test("names of files stay in their folder", () => {
  for (const good of ["a", "a/b.xml", "ä 1/…"]) assert.ok(isFileName(good), good);
  for (const bad of ["", "/a", "a/", "../a", "a/./b", "a\\b", "a\nb"]) assert.ok(!isFileName(bad), bad);
});
