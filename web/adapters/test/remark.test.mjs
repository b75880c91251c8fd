// The plugin of remark, in unified's own pipeline to HTML.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import rehypeStringify from "rehype-stringify";
import remarkParse from "remark-parse";
import remarkRehype from "remark-rehype";
import { unified } from "unified";
import { fenceHtml, createPage } from "labspec-adapters";
import remarkLabspec from "labspec-adapters/remark";
import { elementsOf, hostileLab, HOSTILE, lessonFiles, lessons } from "./course.mjs";
import { repository } from "./tools.mjs";

const convert = (value, options = {}, path = undefined) =>
  unified().use(remarkParse).use(remarkLabspec, { root: repository, ...options }).use(remarkRehype).use(rehypeStringify).process({ value, path });

test("every lesson: the elements of its fences in order, without raw HTML", async () => {
  let count = 0;
  for (const name of lessonFiles) {
    const text = readFileSync(join(lessons, name), "utf8");
    const file = await convert(text, {}, join(lessons, name));
    const page = createPage({ root: repository }, join(lessons, name));
    const expected = [...text.matchAll(/^```(lab simlab|lab integrators|quiz)\n([^]*?)\n```$/gm)].flatMap(([, info, body]) => elementsOf(fenceHtml(info, body, page)));
    assert.deepEqual(elementsOf(String(file)), expected, name);
    assert.deepEqual(file.messages, []);
    count += expected.length;
  }
  assert.ok(count >= 30);
});

test("fences in lists and quotes; other code and other widgets stay", async () => {
  const html = String(await convert("> ```lab simlab\n> {\"title\":\n> \"A\"}\n> ```\n\n1. x\n   ```quiz\n   {\"id\": \"q\"}\n   ```\n\n```lab playground\n{}\n```\n\n```js\nlab\n```\n\n    ```quiz\n    {}\n"));
  assert.deepEqual(elementsOf(html).map(({ id, content }) => [id, content]), [["lab-1", { title: "A" }], ["quiz-q", { id: "q" }]]);
  assert.equal(html.match(/<pre>/g).length, 3);
});

test("a broken fence: a message to the author and to the reader, and the source", async () => {
  const file = await convert("```lab simlab\n{\"title\": \"</code><b>\n```\n");
  assert.match(file.messages[0].reason, /^This lab cannot be displayed: invalid JSON/);
  assert.equal(file.messages[0].line, 1);
  assert.match(String(file), /^<div><p class="labspec-message" role="note"><strong>This lab cannot be displayed: .*<\/strong><\/p>\s*<pre><code class="language-lab">\{"title": "&#x3C;\/code>&#x3C;b>\n<\/code><\/pre>\s*<\/div>$/);
});

test("hostile texts, in both forms", async () => {
  for (const text of HOSTILE) {
    const body = hostileLab(text);
    const html = String(await convert(`~~~~lab simlab\n${body}\n~~~~\n`));
    assert.deepEqual(elementsOf(html)[0].content, JSON.parse(body));
    assert.equal(html.match(/<[a-z!/]/gi).length, 4, html);
    assert.match(String(await convert(`~~~~lab simlab\n${body}\n~~~~\n`, { form: "attribute" })), /^<sim-lab id="lab-1" src="data:application\/json;base64,[A-Za-z0-9+/=]*"><\/sim-lab>$/);
  }
});
