// The first lesson in pages of each tool, opened in Chromium: its lab plays, its quiz answers, and nothing is on the console.
import assert from "node:assert/strict";
import { build } from "esbuild";
import markdownIt from "markdown-it";
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import test from "node:test";
import rehypeStringify from "rehype-stringify";
import remarkParse from "remark-parse";
import remarkRehype from "remark-rehype";
import { unified } from "unified";
import markdownItLabspec from "labspec-adapters/markdown-it";
import remarkLabspec from "labspec-adapters/remark";
import { HOSTILE, hostileLab, lessonFiles, lessons } from "../course.mjs";
import { nodeModules, repository, root, run, tool } from "../tools.mjs";
import { elements, folder, launch, open, readLesson, serve, waitFor } from "./site.mjs";

assert.ok(existsSync(elements), "the elements are built");
const lesson = join(lessons, lessonFiles[0]);
const text = readFileSync(lesson, "utf8");
const options = { root: repository };
const required = (name) => ({ skip: tool(name) === null && `${name} is not installed` });

const pageOf = (body) => `<!doctype html><html lang="en"><meta charset="utf-8"><title>Lesson</title><link rel="icon" href="data:,">
<script type="module" src="labspec-elements.js"></script><main>${body}</main></html>`;

/** Serves a folder with the elements' script beside its pages. */
function serveWith(t, path) {
  copyFileSync(elements, join(path, "labspec-elements.js"));
  return serve(t, path);
}

test("remark and markdown-it, in both forms; models by address", async (t) => {
  const path = folder(t);
  mkdirSync(join(path, "models"));
  for (const name of ["drop", "fall"]) copyFileSync(join(repository, `specs/models/${name}.xml`), join(path, `models/${name}.xml`));
  const remark = async (more) => String(await unified().use(remarkParse).use(remarkLabspec, { ...options, ...more }).use(remarkRehype).use(rehypeStringify).process({ value: text, path: lesson }));
  const pages = {
    remark: await remark({}), attribute: await remark({ form: "attribute" }), address: await remark({ modelsUrl: "models" }),
    "markdown-it": markdownIt().use(markdownItLabspec, options).render(text, { path: lesson }),
  };
  for (const [name, body] of Object.entries(pages)) writeFileSync(join(path, `${name}.html`), pageOf(body));
  const [url, browser] = [await serveWith(t, path), await launch(t)];
  for (const name of Object.keys(pages)) await t.test(name, () => readLesson(browser, `${url}${name}.html`));
});

test("pandoc, in a page of its own", required("pandoc"), async (t) => {
  const path = folder(t);
  for (const from of ["gfm", "markdown"]) {
    run(tool("pandoc"), ["-f", from, "-t", "html", "-s", "--mathml", "--metadata", "title=Lesson", "--lua-filter", join(root, "quarto/labspec.lua"), "-o", join(path, `${from}.html`), lesson], { cwd: repository });
  }
  const [url, browser] = [await serveWith(t, path), await launch(t)];
  for (const from of ["gfm", "markdown"]) await t.test(from, () => readLesson(browser, `${url}${from}.html`, /favicon/));
});

test("mdBook, in a chapter of a folder", required("mdbook"), async (t) => {
  const path = folder(t);
  mkdirSync(join(path, "src/part"), { recursive: true });
  copyFileSync(lesson, join(path, "src/part/lesson.md"));
  copyFileSync(elements, join(path, "src/labspec-elements.js"));
  writeFileSync(join(path, "src/SUMMARY.md"), "# Summary\n\n- [Lesson](part/lesson.md)\n");
  const command = JSON.stringify(`"${process.execPath}" "${join(root, "dist/mdbook-labspec.js")}"`);
  writeFileSync(join(path, "book.toml"), `[book]\ntitle = "Course"\n[preprocessor.labspec]\ncommand = ${command}\nmodels = ${JSON.stringify(join(repository, "specs/models"))}\n`);
  run(tool("mdbook"), ["build", path]);
  const [url, browser] = [await serve(t, join(path, "book")), await launch(t)];
  await readLesson(browser, `${url}part/lesson.html`);
});

test("MyST: its tree, opened by the component of its themes", required("myst"), async (t) => {
  const path = folder(t);
  copyFileSync(join(root, "dist/myst.mjs"), join(path, "plugin.mjs"));
  copyFileSync(elements, join(path, "labspec-elements.js"));
  copyFileSync(lesson, join(path, "index.md"));
  writeFileSync(join(path, "labspec.mjs"), `import { createPlugin } from "./plugin.mjs";\nexport default createPlugin(${JSON.stringify({ ...options, models: "specs/models" })});\n`);
  writeFileSync(join(path, "myst.yml"), "version: 1\nproject:\n  plugins: [labspec.mjs]\nsite: {}\n");
  spawnSync(tool("myst"), ["build", "--site"], { cwd: path, encoding: "utf8", timeout: 120_000 });
  const [content, out] = [join(path, "_build/site/content"), join(path, "out")];
  mkdirSync(out);
  const page = readdirSync(content).map((name) => JSON.parse(readFileSync(join(content, name), "utf8")))[0];
  writeFileSync(join(out, "tree.json"), JSON.stringify(page.mdast));
  const entry = `
    import { createElement } from "react";
    import { createRoot } from "react-dom/client";
    import { ANY_RENDERERS } from "@myst-theme/anywidget";
    const tree = await (await fetch("tree.json")).json();
    const nodesOf = (node) => [node, ...(node.children ?? []).flatMap(nodesOf)];
    const nodes = nodesOf(tree).filter(({ type }) => type === "anywidget");
    const root = createRoot(document.querySelector("main"));
    root.render(nodes.map((node) => createElement(ANY_RENDERERS.anywidget, { node, key: node.id })));
    globalThis.leave = () => root.render(null);`;
  const { outputFiles } = await build({
    stdin: { contents: entry, resolveDir: nodeModules }, nodePaths: [nodeModules], bundle: true, write: false, format: "esm", logLevel: "error", define: { "process.env.NODE_ENV": '"production"' },
  });
  writeFileSync(join(out, "page.js"), outputFiles[0].contents);
  writeFileSync(join(out, "index.html"), '<!doctype html><html lang="en"><title>Lesson</title><link rel="icon" href="data:,"><main></main><script type="module" src="page.js"></script></html>');
  const [url, browser] = [await serve(t, out, join(path, "_build/site/public")), await launch(t)];
  await t.test("a lab and a quiz", () => readLesson(browser, url));
  await t.test("another page takes them away", async () => {
    const { page: view, errors } = await open(browser, url);
    await view.locator("sim-lab").first().waitFor();
    await view.evaluate(() => globalThis.leave());
    await waitFor(async () => (await view.locator("sim-lab").count()) === 0);
    assert.deepEqual(errors, []);
  });
});

test("hostile texts run nothing in a page", async (t) => {
  const path = folder(t);
  const hostile = HOSTILE.map((each) => `~~~~lab simlab\n${hostileLab(each)}\n~~~~\n`).join("\n");
  writeFileSync(join(path, "index.html"), pageOf(markdownIt().use(markdownItLabspec, options).render(hostile)));
  writeFileSync(join(path, "attribute.html"), pageOf(markdownIt().use(markdownItLabspec, { ...options, form: "attribute" }).render(hostile)));
  const [url, browser] = [await serveWith(t, path), await launch(t)];
  for (const name of ["", "attribute.html"]) {
    const { page } = await open(browser, url + name);
    await page.waitForFunction(() => customElements.get("sim-lab") !== undefined);
    for (const lab of await page.locator("sim-lab").all()) {
      await lab.scrollIntoViewIfNeeded();
      await lab.evaluate((element) => Promise.race([Promise.resolve(element.ready).catch(() => {}), new Promise((resolve) => setTimeout(resolve, 3000))]));
    }
    assert.equal(await page.evaluate(() => globalThis.hacked), undefined);
    assert.deepEqual(await page.locator("main > *").evaluateAll((all) => [...new Set(all.map(({ localName }) => localName))]), ["sim-lab"]);
  }
});
