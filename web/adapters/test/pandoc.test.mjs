// The filter of pandoc and Quarto, run by pandoc, beside the adapters in TypeScript.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test from "node:test";
import { convertFence, createPage, fenceHtml } from "labspec-adapters";
import { elementsOf, hostileLab, HOSTILE, lessonFiles, lessons } from "./course.mjs";
import { repository, root, tool } from "./tools.mjs";

const pandoc = tool("pandoc");
const filter = join(root, "quarto/labspec.lua");
const options = { skip: pandoc === null && "pandoc is not installed" };

/** Converts a text or a file; metadata in a file of YAML. */
function convert({ text, file, from = "gfm", to = "html", metadata = null, cwd = repository }) {
  const args = ["--lua-filter", filter, "-f", from, "-t", to, ...(file === undefined ? [] : [file]), ...(metadata === null ? [] : ["--metadata-file", metadata])];
  const { status, stdout, stderr } = spawnSync(pandoc, args, { cwd, input: text ?? "", encoding: "utf8", maxBuffer: 1 << 28 });
  assert.equal(status, 0, stderr);
  return { html: stdout, messages: stderr.split("\n").filter((line) => line.startsWith("labspec: ")) };
}

const expectedOf = (name) => {
  const page = createPage({ root: repository }, join(lessons, name));
  return [...readFileSync(join(lessons, name), "utf8").matchAll(/^```(lab simlab|lab integrators|quiz)\n([^]*?)\n```$/gm)].flatMap(([, info, body]) => elementsOf(fenceHtml(info, body, page)));
};

for (const from of ["gfm", "commonmark_x", "markdown"]) {
  test(`every lesson, read as ${from}: the elements of its fences in order`, options, () => {
    for (const name of lessonFiles) {
      const { html, messages } = convert({ file: `specs/lessons/${name}`, from });
      assert.deepEqual(elementsOf(html), expectedOf(name), name);
      assert.deepEqual(messages, []);
      assert.match(html, /<script type="module" src="labspec-elements\.js"><\/script>\s*$/);
    }
  });
}

test("JSON is copied: numbers, escapes and the order of keys", options, () => {
  const body = '{"b": 1.50, "10": -0.0, "2": 1E-3, "a": [ ], "c": { }, "d": "\\u00e9\\/\\"\\\\ \\u2028", "e": null, "f": 12345678901234567890}';
  const { html } = convert({ text: `\`\`\`lab\n${body}\n\`\`\`\n` });
  assert.match(html, /<script type="application\/json">\{"b":1\.50,"10":-0\.0,"2":1E-3,"a":\[\],"c":\{\},"d":"\\u00e9\\\/\\"\\\\ \\u2028","e":null,"f":12345678901234567890\}<\/script>/);
});

test("what is JSON for JavaScript is JSON for the filter, and nothing else", options, () => {
  const values = [
    "{}", " {} ", '{"a":1}', '{"a":1,}', "{a:1}", "{'a':1}", '{"a":01}', '{"a":+1}', '{"a":.5}', '{"a":1.}', '{"a":1e5}', '{"a":1e}', '{"a":-}', '{"a":NaN}', '{"a":tru}', '{"a":truex}',
    '{"a":"\\x"}', '{"a":"\\u12g4"}', '{"a":"\u007f"}', '{"a":"\n"}', '{"a" 1}', '{"a":1 "b":2}', "{} {}", "{", '{"a', '{"a":[1,2}', '{"a":[1,]}', "[]", "1", '"x"', "null", '{"":0}', '{"a":1,"a":2}',
    '{"a":"\ud83c\udf0d"}', '{"a":"\\ud83c\\udf0d"}', '{"__proto__":1}', "\u00a0{}", '{"a":1e400}', '{"a":0e1}', '{"a":-0}', "{“a”: 1}", "",
  ];
  for (const body of values) {
    const { html, messages } = convert({ text: `\`\`\`\`quiz\n${body}\n\`\`\`\`\n` });
    const expected = convertFence("quiz", body, createPage());
    assert.equal(elementsOf(html).length, expected.element === null ? 0 : 1, body);
    assert.equal(messages.length, expected.element === null ? 1 : 0, body);
    if (expected.element !== null) assert.equal(JSON.stringify(elementsOf(html)[0].content), JSON.stringify(JSON.parse(body)), body);
  }
});

test("a broken fence: a message to the author and to the reader, and the source", options, () => {
  const { html, messages } = convert({ text: "```lab simlab\n{\"title\":\n  \"</code><b>\n```\n\n```quiz\n{\"id\": \"q\"}\n```\n" });
  assert.match(messages[0], /^labspec: This lab cannot be displayed: invalid JSON \(line 2, column 14\)$/);
  assert.match(html, /^<div class="labspec-message" role="note">\s*<p><strong>This lab cannot[^<]*<\/strong><\/p>\s*<\/div>\s*<pre class="lab"><code>/);
  assert.doesNotMatch(html, /<b>/);
  assert.equal(elementsOf(html)[0].id, "quiz-q");
  assert.match(convert({ text: "```lab\n{\"model\": \"../../NOTICE\"}\n```\n" }).messages[0], /is not a file name/);
  assert.match(convert({ text: "```lab\n{\"model\": \"nothing\"}\n```\n" }).messages[0], /the model `nothing` does not exist/);
  assert.match(convert({ text: `\`\`\`lab\n{"a": ${"[".repeat(5000)}${"]".repeat(5000)}}\n\`\`\`\n` }).messages[0], /nested too deeply/);
});

test("hostile texts do not leave their script", options, () => {
  for (const text of HOSTILE) {
    const body = hostileLab(text.replaceAll("\u0000", ""));
    const { html } = convert({ text: `~~~~lab simlab\n${body}\n~~~~\n` });
    assert.deepEqual(elementsOf(html)[0].content, JSON.parse(body));
    assert.equal(html.match(/<[a-z!/]/gi).length, 6, html);
  }
});

test("settings, models in other places, other widgets, other formats", options, (t) => {
  const folder = mkdtempSync(join(tmpdir(), "labspec-pandoc-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  for (const path of ["a/b", "models", "other"]) mkdirSync(join(folder, path), { recursive: true });
  writeFileSync(join(folder, "models/m.xml"), "\ufeff<mujoco>\n<!-- <script> -->\n</mujoco>\n");
  writeFileSync(join(folder, "models/c.xml"), "<mujoco><!-- open </script>\n\"\\\u0001</mujoco>");
  writeFileSync(join(folder, "models/f.xml"), "<mujoco><asset><mesh file='x.obj'/></asset></mujoco>");
  writeFileSync(join(folder, "other/m.xml"), "<mujoco model='other'/>");
  writeFileSync(join(folder, "a/b/lesson.md"), '```lab simlab\n{"model": "m"}\n```\n\n```lab playground\n{"other": 1}\n```\n\n```lab simlab\n{"model": "c"}\n```\n');
  const file = "a/b/lesson.md";
  const metadata = (yaml) => {
    writeFileSync(join(folder, "settings.yml"), `labspec: ${yaml}\n`);
    return join(folder, "settings.yml");
  };
  const { html } = convert({ file, cwd: folder });
  assert.match(html, /data-name="m"><mujoco> <\/mujoco><\/script>/);
  assert.deepEqual(elementsOf(html)[1].content, { xml: "<mujoco><!-- open </script>\n\"\\\u0001</mujoco>" });
  assert.match(html, /<pre class="lab"><code>\{&quot;other&quot;: 1\}<\/code><\/pre>/);
  assert.deepEqual(elementsOf(convert({ file, cwd: folder, metadata: metadata("{models: other, script: /e.js}") }).html)[0].models, ["m"]);
  const address = convert({ file, cwd: folder, metadata: metadata('{models-url: "/m><x", script: false}') }).html;
  assert.match(address, /<sim-lab id="lab-1" models="\/m&gt;&lt;x"><script type="application\/json">\{"model":"m"\}<\/script><\/sim-lab>/);
  assert.doesNotMatch(address, /labspec-elements/);
  assert.match(convert({ text: "```lab\n{\"model\": \"f\"}\n```\n", cwd: folder }).messages[0], /reads other files/);
  writeFileSync(join(folder, "a/b/compared.md"), '```lab integrators\n{"stopAt": 1}\n```\n\n```{.lab .integrators}\n{"integrators": ["RK4"]}\n```\n');
  for (const from of ["commonmark_x", "markdown"]) {
    const compared = elementsOf(convert({ file: "a/b/compared.md", cwd: folder, from }).html).map(({ content }) => content.integrators);
    assert.deepEqual(compared, [[], ["RK4"]], from);
  }
  for (const from of ["commonmark_x", "markdown"]) assert.equal(elementsOf(convert({ text: "```{.lab .simlab}\n{}\n```\n\n```{.lab .other}\n{}\n```\n", from }).html).length, 1);
  assert.doesNotMatch(convert({ file, cwd: folder, to: "latex" }).html, /sim-lab/);
});
