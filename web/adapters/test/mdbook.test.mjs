// The preprocessor of mdBook: its protocol, the fences of its texts beside those of a Markdown parser, and books made by mdBook itself.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test from "node:test";
import markdownIt from "markdown-it";
import { createPage } from "labspec-adapters";
import { convertText, preprocess } from "labspec-adapters/mdbook";
import { elementsOf, hostileLab, HOSTILE, lessonFiles, lessons } from "./course.mjs";
import { repository, root, run, tool } from "./tools.mjs";

const program = join(root, "dist/mdbook-labspec.js");
const mdbook = tool("mdbook");
const md = markdownIt({ html: true });

/** The fences of a text as a parser finds them: info strings and bodies. */
const parsed = (text) => md.parse(text, {}).filter(({ type }) => type === "fence").map(({ info, content }) => [info.trim(), content.trimEnd()]);

const TRICKY = [
  "```lab\n{}\n```", "~~~quiz\n{}\n~~~", "````md\n```lab\n{}\n```\n````\n\n```quiz\n{}\n```", "   ```lab\n   {\"a\":\n     1}\n  ```", "    ```lab\n    {}\n    ```",
  "- x\n  ```lab\n  {}\n  ```\n- ```quiz\n  {}\n  ```", "1. a\n\n   - b\n\n     ```lab\n     {\"a\":\n\n     2}\n     ```\n\nend\n\n    ```lab\n    {}\n", "> ```lab\n> {}\n> ```\nx",
  "> > ```lab\n> > {}\n> ```quiz\n", "> - a\n>   ```lab\n>   {}\n>   ```\n", "<!--\n```lab\n{}\n```\n-->\n\n```quiz\n{}\n```", "<pre>\n```lab\n</pre>\n\n```quiz\n{}\n```",
  "text\n```lab\n{}\n```\ntext", "```lab `x`\n{}\n```", "``` lab  simlab \n{}\n`````", "```lab\n{}\n``` x\n```", "```lab\n{}", "- ```lab\n  {}\ntext", "```\n~~~lab\n{}\n~~~\n```",
  "```lab\r\n{}\r\n```\r\n", "-\t```lab\n\t{}\n\t```", "10) a\n\n    ```lab\n    {}\n    ```", "-     ```lab\n      {}\n", "* * *\n```lab\n{}\n```", "- a\n\n\n\n  ```lab\n  {}\n  ```",
  "- a\n ```lab\n {}\n ```", "> a\n```lab\n{}\n```",
];

test("the fences of tricky texts are those of a Markdown parser", () => {
  for (const text of TRICKY) {
    const bodies = parsed(text).filter(([info]) => /^(lab|quiz)\b/.test(info)).map(([, content]) => content);
    const broken = [];
    const elements = elementsOf(convertText(text, createPage(), (message) => broken.push(message)));
    assert.equal(elements.length + broken.length, bodies.length, JSON.stringify(text));
    const readable = bodies.filter((body) => { try { return JSON.parse(body); } catch { return false; } });
    assert.deepEqual(elements.map(({ content }) => content), readable.map((body) => JSON.parse(body)), JSON.stringify(text));
  }
});

test("a converted text has the same other blocks, and each element is one block of HTML", () => {
  for (const text of [...TRICKY, ...lessonFiles.map((name) => readFileSync(join(lessons, name), "utf8"))]) {
    const count = parsed(text).filter(([info]) => /^(lab|quiz)\b/.test(info)).length;
    const broken = [];
    const converted = convertText(text, createPage({ root: repository, models: "specs/models" }), (message) => broken.push(message));
    const blocks = (from) => md.parse(from, {}).filter(({ type }) => type !== "html_block" && type !== "fence").map(({ type, content }) => `${type} ${content}`);
    const elements = md.parse(converted, {}).filter(({ type, content }) => type === "html_block" && content.trimStart().startsWith('<div class="labspec">'));
    assert.equal(elements.length + broken.length, count, converted);
    for (const { content } of elements) assert.match(content, /^ *<div class="labspec">.*<\/div>\n*$/);
    if (!text.includes("<") && broken.length === 0) assert.deepEqual(blocks(converted).filter((b) => !b.startsWith("text")), blocks(text).filter((b) => !b.startsWith("text")), JSON.stringify(text));
  }
});

const context = (labspec, renderer = "html") => ({ root: repository, config: { book: { src: "specs" }, preprocessor: { labspec } }, renderer, mdbook_version: "0.5.4" });
const chapter = (content, path, rest = {}) => ({ Chapter: { name: "C", content, number: null, sub_items: [], path, source_path: path, parent_names: [], ...rest } });

test("the protocol: chapters in chapters, parts, drafts, both names of the list", () => {
  const lab = "```lab simlab\n{\"model\": \"drop\"}\n```\n";
  for (const list of ["items", "sections"]) {
    const book = { [list]: [{ PartTitle: "P" }, "Separator", chapter(lab, "lessons/a.md", { sub_items: [chapter(lab, "lessons/b/c.md")] }), chapter("", null), chapter("# none", "d.md")] };
    const { book: made, messages } = preprocess([context({}), book]);
    assert.deepEqual(messages, []);
    assert.deepEqual([made[list][0], made[list][1], made[list][3], made[list][4].Chapter.content], [{ PartTitle: "P" }, "Separator", chapter("", null), "# none"]);
    assert.match(made[list][2].Chapter.content, /^<div class="labspec"><sim-lab id="lab-1">.*data-name="drop".*<\/div>\n\n\n\n<script type="module" src="\.\.\/labspec-elements\.js"><\/script>\n$/);
    assert.match(made[list][2].Chapter.sub_items[0].Chapter.content, /src="\.\.\/\.\.\/labspec-elements\.js"/);
  }
  const address = preprocess([context({ script: "https://x.org/e.js", "models-url": "/m" }), { items: [chapter(lab, "lessons/a.md")] }]).book.items[0].Chapter.content;
  assert.match(address, /<sim-lab id="lab-1" models="\/m">.*\n\n\n\n<script type="module" src="https:\/\/x\.org\/e\.js">/);
  assert.doesNotMatch(preprocess([context({ script: false }), { items: [chapter(lab, "lessons/a.md")] }]).book.items[0].Chapter.content, /labspec-elements\.js/);
  for (const input of [null, 5, [], [{}], [1, 2]]) assert.throws(() => preprocess(input), /not a context and a book/);
});

test("the program: `supports`, a book, broken input and broken fences", () => {
  const start = (args, input = "") => spawnSync(process.execPath, [program, ...args], { input, encoding: "utf8" });
  assert.deepEqual([start(["supports", "html"]).status, start(["supports", "markdown"]).status], [0, 1]);
  const large = chapter(`${"x ".repeat(500_000)}\n\n> \`\`\`quiz\n> {\n> \`\`\`\n`, "a.md");
  const { status, stdout, stderr } = start([], JSON.stringify([context({}), { items: [large] }]));
  assert.equal(status, 0);
  assert.match(stderr, /^mdbook-labspec: a\.md: This quiz cannot be displayed: invalid JSON/);
  assert.match(JSON.parse(stdout).items[0].Chapter.content, /\n> <p class="labspec-message" role="note"><strong>This quiz.*<\/p>\n>\n> ```quiz\n> \{\n> ```\n$/);
  const broken = start([], "{");
  assert.equal(broken.status, 1);
  assert.match(broken.stderr, /^mdbook-labspec: /);
});

test("books of mdBook: the lessons, hostile texts, and lists and quotes", { skip: mdbook === null && "mdBook is not installed" }, (t) => {
  const folder = mkdtempSync(join(tmpdir(), "labspec-mdbook-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  mkdirSync(join(folder, "src/lessons"), { recursive: true });
  const texts = Object.fromEntries(lessonFiles.map((name) => [`lessons/${name}`, readFileSync(join(lessons, name), "utf8")]));
  texts["hostile.md"] = HOSTILE.map((text) => `~~~~lab simlab\n${hostileLab(text)}\n~~~~\n`).join("\n");
  texts["nested.md"] = [...TRICKY.slice(5, 8), TRICKY[9]].join("\n\n# Next\n\n");
  for (const [name, text] of Object.entries(texts)) writeFileSync(join(folder, "src", name), text);
  writeFileSync(join(folder, "src/SUMMARY.md"), Object.keys(texts).map((name) => `- [${name}](${name})\n`).join(""));
  writeFileSync(join(folder, "book.toml"), `[book]\ntitle = "T"\n[preprocessor.labspec]\ncommand = ${JSON.stringify(`"${process.execPath}" "${program}"`)}\nmodels = ${JSON.stringify(join(repository, "specs/models"))}\nafter = ["links"]\n`);
  const { stderr } = run(mdbook, ["build", folder]);
  assert.doesNotMatch(stderr, /WARN|ERROR|cannot be displayed/);
  for (const [name, text] of Object.entries(texts)) {
    const html = readFileSync(join(folder, "book", name.replace(/md$/, "html")), "utf8");
    const wanted = elementsOf(convertText(text, createPage({ root: repository, models: "specs/models" }), () => {}));
    assert.ok(wanted.length > 0, name);
    assert.deepEqual(elementsOf(html), wanted, name);
    assert.doesNotMatch(html.replace(/<script[^]*?<\/script>/g, ""), /onerror=|language-lab|language-quiz/);
  }
});
