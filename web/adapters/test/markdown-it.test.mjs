// The plugin of markdown-it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import markdownIt from "markdown-it";
import { createPage, fenceHtml } from "labspec-adapters";
import markdownItLabspec from "labspec-adapters/markdown-it";
import { elementsOf, hostileLab, HOSTILE, lessonFiles, lessons } from "./course.mjs";
import { repository } from "./tools.mjs";

const converter = (options = {}) => markdownIt().use(markdownItLabspec, { root: repository, ...options });

test("every lesson: the elements of its fences in order; a page begins with each text", () => {
  const md = converter();
  for (const name of lessonFiles) {
    const text = readFileSync(join(lessons, name), "utf8");
    const page = createPage({ root: repository }, join(lessons, name));
    const expected = [...text.matchAll(/^```(lab simlab|lab integrators|quiz)\n([^]*?)\n```$/gm)].flatMap(([, info, body]) => elementsOf(fenceHtml(info, body, page)));
    assert.ok(expected.length > 0);
    for (let i = 0; i < 2; i++) assert.deepEqual(elementsOf(md.render(text, { path: join(lessons, name) })), expected, name);
  }
});

test("other code stays, and a broken fence has a message before its source", () => {
  const html = converter().render("```lab playground\n{}\n```\n\n```js\n1\n```\n\n```quiz\n{<b>\n```\n\n> ```lab\n> {}\n> ```\n");
  assert.match(html, /^<pre><code class="language-lab">\{\}\n<\/code><\/pre>\n<pre><code class="language-js">1/);
  assert.match(html, /<p class="labspec-message" role="note"><strong>This quiz cannot be displayed: invalid JSON .*<\/strong><\/p>\n<pre><code class="language-quiz">\{&lt;b&gt;/);
  assert.deepEqual(elementsOf(html).map(({ id }) => id), ["lab-1"]);
});

test("hostile texts", () => {
  assert.doesNotMatch(converter().render("```lab\n{{ 1 }}\n```\n").replace(/<pre>[^]*/, ""), /[{}]/, "a template of Vue evaluates no message");
  for (const text of HOSTILE) {
    const body = hostileLab(text);
    const html = converter().render(`~~~~lab simlab\n${body}\n~~~~\n`);
    assert.deepEqual(elementsOf(html)[0].content, JSON.parse(body));
    assert.equal(html.match(/<[a-z!/]/gi).length, 4, html);
  }
});
