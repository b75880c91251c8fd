// The plugin of MyST, loaded by mystmd: the tree that its themes get.
import assert from "node:assert/strict";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { spawnSync } from "node:child_process";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test from "node:test";
import { hostileLab, HOSTILE, lessonFiles, lessons, withoutClaims } from "./course.mjs";
import { repository, root, tool } from "./tools.mjs";

const myst = tool("myst");

/** Builds a project; gives the nodes of its pages by file, and what was printed. */
function build(t, files, options = {}) {
  const folder = mkdtempSync(join(tmpdir(), "labspec-myst-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  mkdirSync(join(folder, "lessons"));
  copyFileSync(join(root, "dist/myst.mjs"), join(folder, "plugin.mjs"));
  writeFileSync(join(folder, "labspec-elements.js"), "export default { render() {} };\n");
  writeFileSync(join(folder, "labspec.mjs"), `import { createPlugin } from "./plugin.mjs";\nexport default createPlugin(${JSON.stringify(options)});\n`);
  writeFileSync(join(folder, "myst.yml"), "version: 1\nproject:\n  title: T\n  plugins: [labspec.mjs]\nsite:\n  title: T\n");
  for (const [name, text] of Object.entries(files)) writeFileSync(join(folder, name), text);
  // The content of the site comes before its theme, which is fetched from the network; whether it is there does not matter here.
  const { stdout, stderr } = spawnSync(myst, ["build", "--site"], { cwd: folder, encoding: "utf8", timeout: 120_000, env: { ...process.env, MYSTMD_DISABLE_VERSION_CHECK: "1" } });
  const content = join(folder, "_build/site/content");
  assert.ok(existsSync(content), stdout + stderr);
  const pages = readdirSync(content).filter((name) => name.endsWith(".json")).map((name) => JSON.parse(readFileSync(join(content, name), "utf8")));
  const nodesOf = (node) => [node, ...(node.children ?? []).flatMap(nodesOf)];
  const nodes = Object.fromEntries(pages.map((page) => [page.location.replace(/^\//, ""), nodesOf(page.mdast)]));
  return { folder, nodes, printed: stdout + stderr, widgets: (name) => nodes[name].filter(({ type }) => type === "anywidget") };
}

test("every lesson: widgets with the contents of its fences and their models", { skip: myst === null && "mystmd is not installed" }, (t) => {
  const files = Object.fromEntries(lessonFiles.map((name) => [`lessons/${name}`, readFileSync(join(lessons, name), "utf8")]));
  const { folder, widgets, printed } = build(t, files, { root: repository, models: "specs/models" });
  assert.doesNotMatch(printed, /cannot be displayed/);
  for (const name of lessonFiles) {
    const expected = [...files[`lessons/${name}`].matchAll(/^```(lab simlab|lab integrators|quiz)\n([^]*?)\n```$/gm)].map(([, info, body]) => [info === "quiz" ? "quiz" : "lab", withoutClaims(JSON.parse(body)), [...body.matchAll(/"model": "(\w+)"/g)].map(([, model]) => model)]);
    const found = widgets(`lessons/${name}`);
    assert.equal(found.length, expected.length, name);
    for (const [i, [kind, content, models]] of expected.entries()) {
      const { model, esm } = found[i];
      assert.deepEqual(model[kind], content, name);
      assert.deepEqual(model.models ?? {}, Object.fromEntries(models.map((m) => [m, readFileSync(join(repository, "specs/models", `${m}.xml`), "utf8")])), name);
      assert.ok(existsSync(join(folder, "_build/site/public", esm.replace(/^\//, ""))), `the theme gets the script of the elements: ${esm}`);
    }
  }
});

test("broken fences, other widgets and hostile texts", { skip: myst === null && "mystmd is not installed" }, (t) => {
  const plain = HOSTILE.filter((text) => !text.includes("\u0000"));
  const { nodes, widgets, printed } = build(t, {
    "index.md": "---\ntitle: T\n---\n\n# One\n\n```lab playground\n{}\n```\n\n```lab simlab\n{\"title\": 1\n```\n\n- x\n\n  ```lab\n  {\"title\": \"in a list\"}\n  ```\n",
    "hostile.md": `# Two\n\n${plain.map((text) => `~~~~lab simlab\n${hostileLab(text)}\n~~~~\n`).join("\n")}`,
  });
  assert.match(printed, /index\.md:11.*This lab cannot be displayed: invalid JSON/);
  const index = nodes["index.md"];
  assert.deepEqual(index.filter(({ type }) => type === "code").map(({ value }) => value), ["{}", '{"title": 1']);
  assert.match(JSON.stringify(index.find(({ type }) => type === "admonition")), /This lab cannot be displayed/);
  assert.deepEqual(widgets("index.md").map(({ model }) => model), [{ lab: { title: "in a list" } }]);
  assert.deepEqual(widgets("hostile.md").map(({ model }) => model.lab), plain.map((text) => JSON.parse(hostileLab(text))));
});
