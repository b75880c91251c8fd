// A fence becomes an element: its content, its models, and what stays a code block.
import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test from "node:test";
import { convertFence, createPage, elementHtml, fenceHtml, fenceKind } from "labspec-adapters";
import { elementsOf, fences, hostileLab, HOSTILE, withoutClaims } from "./course.mjs";
import { repository, root, run } from "./tools.mjs";

const specs = { root: repository, models: "specs/models" };

test("the kinds of fences", () => {
  const kinds = { lab: "lab", "lab simlab": "lab", " lab\tsimlab {#drop}": "lab", "lab {.wide}": "lab", "lab integrators": "lab", "lab integrators {#x}": "lab", quiz: "quiz", "quiz {#q}": "quiz" };
  for (const [info, kind] of Object.entries(kinds)) assert.equal(fenceKind(info), kind, info);
  for (const info of ["", "lab playground", "lab simlabs", "lab integrator", "labs", "quizzes", "json lab", "python file=lab", "{lab}"]) assert.equal(fenceKind(info), null, info);
});

test("every fence of the example course: the same content without claims, and its models", () => {
  assert.ok(fences.length >= 30);
  for (const { name, info, body } of fences) {
    const [element, ...rest] = elementsOf(fenceHtml(info, body, createPage(specs)) ?? "");
    assert.deepEqual(rest, [], name);
    assert.deepEqual(element.content, withoutClaims(JSON.parse(body)), name);
    const named = [...body.matchAll(/"model": "(\w+)"/g)].map(([, model]) => model);
    assert.deepEqual(element.models, [...new Set(named)], name);
  }
});

test("claims are removed where a check reads them, and nowhere else", () => {
  const lab = '{"verify": 1, "lint": {}, "xml": "<mujoco/>", "overlays": {"verify": true}, "controls": [{"lint": 2}]}';
  assert.deepEqual(elementsOf(fenceHtml("lab", lab, createPage()))[0].content, { xml: "<mujoco/>", overlays: { verify: true }, controls: [{ lint: 2 }] });
  const quiz = '{"id": "q", "lint": 1, "questions": [{"q": "?", "verify": 1, "lint": 2, "sim": {"xml": "", "verify": 3}, "options": ["verify"]}, 5]}';
  assert.deepEqual(elementsOf(fenceHtml("quiz", quiz, createPage()))[0].content, { id: "q", questions: [{ q: "?", sim: { xml: "" }, options: ["verify"] }, 5] });
});

test("a lab that compares integrators has a list of them", () => {
  const listOf = (info, lab) => elementsOf(fenceHtml(info, lab, createPage()))[0].content.integrators;
  assert.deepEqual(listOf("lab integrators", '{"integrators": ["RK4"]}'), ["RK4"]);
  for (const lab of ["{}", '{"integrators": "RK4"}', '{"integrators": null}']) assert.deepEqual(listOf(" lab  integrators {.wide}", lab), []);
  for (const info of ["lab", "lab simlab", "quiz"]) assert.equal(listOf(info, "{}"), undefined);
});

test("ids are unique on a page, and every lab counts", () => {
  const page = createPage();
  const ids = ["lab", "lab", "quiz", "quiz", "lab"].map((info, i) => convertFence(info, i === 1 ? "{" : '{"id": "The Q!"}', page)?.element?.attributes.id);
  assert.deepEqual(ids, ["lab-1", undefined, "quiz-the-q", "quiz-the-q-2", "lab-3"]);
});

test("what cannot be an element stays a code block with its source and a message", () => {
  const messages = {
    "{": /^This lab cannot be displayed: invalid JSON \(.*\)$/, "[1]": /JSON is not an object$/, "null": /not an object$/, '{"xml": 1e999}': /out of range$/,
    '{"model": "none"}': /^This lab cannot be displayed: the model `none` does not exist in the folder `specs\/models`$/,
    '{"model": "../labspec"}': /does not exist/, [`{"a": ${"[".repeat(1e5)}${"]".repeat(1e5)}}`]: /JSON/,
  };
  for (const [text, expected] of Object.entries(messages)) {
    const converted = convertFence("lab", text, createPage(specs));
    assert.equal(converted.element, null);
    assert.match(converted.message, expected);
    assert.doesNotMatch(converted.message, /\n/);
  }
  const html = fenceHtml("quiz", '{"</code><script>": <b>', createPage());
  assert.match(html, /^<p class="labspec-message" role="note"><strong>This quiz cannot be displayed: invalid JSON .*<\/strong><\/p><pre><code class="language-json">\{&quot;&lt;\/code&gt;/);
  assert.doesNotMatch(html, /<script|<b>/);
});

test("hostile texts leave neither their script nor their attribute", () => {
  for (const text of HOSTILE) {
    const body = hostileLab(text);
    const html = fenceHtml("lab", body, createPage());
    assert.deepEqual(elementsOf(html)[0].content, JSON.parse(body));
    assert.equal(html.match(/<[a-z!/]/gi).length, 4, `other tags than the element and its script: ${html}`);
    assert.doesNotMatch(html, /[\n\u2028\u2029]/);
    const named = { models: { [text]: "<mujoco/>" }, modelsUrl: undefined };
    const model = elementHtml(convertFence("lab", JSON.stringify({ model: text }), createPage(named)).element);
    assert.equal(model.match(/<[a-z!/]/gi).length, 7, model);
    const attribute = elementHtml(convertFence("lab", body, createPage({ form: "attribute", modelsUrl: text })).element);
    assert.match(attribute, /^<sim-lab id="lab-1" models="[^"<>]*" src="data:application\/json;base64,[A-Za-z0-9+/=]*"><\/sim-lab>$/);
    assert.deepEqual(JSON.parse(Buffer.from(/base64,([^"]*)/.exec(attribute)[1], "base64").toString()), JSON.parse(body));
  }
});

test("models: on one line without comments; one that no script can contain is the `xml` of its labs", () => {
  const convert = (xml, options = {}) => convertFence("lab", '{"model": "m", "title": "T"}', createPage({ models: { m: xml }, ...options })).element;
  assert.equal(convert("<mujoco>\n  <!-- <script> -->\r\n <a b='1\n\n2'/>\n</mujoco>\n").scripts[1].text, "<mujoco> <a b='1 2'/> </mujoco>");
  for (const xml of ["<mujoco></SCRIPT ></mujoco>", "<mujoco><!-- open", "<!<!-- -->-- x", "<!DOCTYPE x><mujoco/>", "<mujoco><script/></mujoco>"]) {
    const [json, ...rest] = convert(xml).scripts;
    assert.deepEqual(rest, []);
    assert.deepEqual(JSON.parse(json.text), { xml, title: "T" });
    assert.doesNotMatch(json.text, /[<>]/);
  }
  const attribute = convert("<mujoco>\n</mujoco>", { form: "attribute" });
  assert.deepEqual(JSON.parse(Buffer.from(attribute.attributes.src.split(",")[1], "base64")), { xml: "<mujoco>\n</mujoco>", title: "T" });
});

test("models with other files need an address; with an address, nothing is written into the page", () => {
  const text = '{"model": "m"}';
  const models = { m: "<mujoco><asset><mesh\n file='a.obj'/></asset></mujoco>" };
  assert.match(convertFence("lab", text, createPage({ models })).message, /reads other files/);
  assert.equal(elementHtml(convertFence("lab", text, createPage({ models, modelsUrl: "/models/" })).element), '<sim-lab id="lab-1" models="/models/"><script type="application/json">{"model":"m"}</script></sim-lab>');
  assert.match(convertFence("lab", '{"model": "x"}', createPage({ models, modelsUrl: "/models/" })).message, /`x` is not among/);
  assert.equal(convertFence("lab", '{"model": "x"}', createPage({ modelsUrl: "/models/" })).element.scripts.length, 1);
  assert.equal(convertFence("lab", '{"model": "x"}', createPage({ models: false })).element.scripts.length, 1);
});

test("models are in the nearest folder beside or above the lesson, and never outside of the root", (t) => {
  const folder = mkdtempSync(join(tmpdir(), "labspec-adapters-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  for (const path of ["root/models", "root/a/models", "root/a/b", "root/c/d"]) mkdirSync(join(folder, path), { recursive: true });
  writeFileSync(join(folder, "root/models/m.xml"), "<mujoco model='above'/>");
  writeFileSync(join(folder, "root/a/models/m.xml"), "<mujoco model='near'/>");
  writeFileSync(join(folder, "secret.xml"), "<mujoco model='secret'/>");
  symlinkSync(join(folder, "secret.xml"), join(folder, "root/models/s.xml"));
  mkdirSync(join(folder, "root/models/folder.xml"));
  const root = join(folder, "root");
  const convert = (name, lesson, options = {}) => convertFence("lab", JSON.stringify({ model: name }), createPage({ root, ...options }, lesson));
  assert.match(elementHtml(convert("m", join(root, "a/b/lesson.md")).element), /near/);
  assert.match(elementHtml(convert("m", "a/lesson.md").element), /near/);
  assert.match(elementHtml(convert("m", "c/d/lesson.md").element), /above/);
  assert.match(convert("s", "c/lesson.md").message, /outside of the root/);
  assert.match(convert("folder", "c/lesson.md").message, /not a file/);
  assert.match(convert("m", "lesson.md", { models: "elsewhere" }).message, /the folder of models `elsewhere` does not exist/);
  assert.match(convert("m", join(folder, "lesson.md"), { root: join(root, "c/d") }).message, /no folder `models`/);
});

test("the tarball has what the package exports", () => {
  const { stdout } = run("npm", ["pack", "--dry-run", "--json", "--silent"], { cwd: root });
  const files = JSON.parse(stdout)[0].files.map(({ path }) => path);
  const { exports, bin, dependencies } = JSON.parse(readFileSync(join(root, "package.json"), "utf8"));
  const named = [...Object.values(exports).flatMap((each) => (typeof each === "string" ? [each] : Object.values(each))), ...Object.values(bin)];
  for (const path of named) assert.ok(files.includes(path.replace(/^\.\//, "")), path);
  assert.equal(dependencies, undefined);
  for (const path of files.filter((each) => /^dist\/[^/]*js$/.test(each))) assert.ok(statSync(join(root, path)).size < 20_000, `${path} is small`);
});
