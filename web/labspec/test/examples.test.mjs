// The examples are typed strictly, print what docs/embedding.md shows, and stand there as they are.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import { fileURLToPath } from "node:url";
import { transformSync } from "esbuild";

const cwd = fileURLToPath(new URL("..", import.meta.url));
const folder = join(cwd, "examples");
const names = readdirSync(folder).filter((name) => name.endsWith(".ts"));
const guide = readFileSync(join(cwd, "../../docs/embedding.md"), "utf8");

test("the types of the examples", () => {
  const options = ["--noEmit", "--strict", "--exactOptionalPropertyTypes", "--noUncheckedIndexedAccess", "--module", "nodenext", "--target", "es2022", "--lib", "es2022,dom,esnext.disposable", "--types", "node"];
  const done = spawnSync(process.execPath, [join(cwd, "../node_modules/typescript/bin/tsc"), ...options, ...names.map((name) => join(folder, name))], { cwd, encoding: "utf8" });
  assert.equal(done.status, 0, done.stdout);
});

for (const name of names) {
  test(`the example ${name}`, () => {
    const code = readFileSync(join(folder, name), "utf8");
    assert.ok(code.split("\n").length <= 30, "it is long");
    const program = transformSync(code, { loader: "ts", target: "es2022" }).code;
    const printed = execFileSync(process.execPath, ["--input-type=module", "-e", program], { cwd, encoding: "utf8" });
    assert.ok(guide.includes(`\`\`\`ts\n${code}\`\`\``), `docs/embedding.md shows another ${name}`);
    assert.ok(guide.includes(`\`\`\`text\n${printed}\`\`\``), `docs/embedding.md shows another output:\n${printed}`);
  });
}

test("the entry of browsers has what the others have, and shares it with them", async () => {
  const [browser, node, slim] = await Promise.all([import("../dist/browser.js"), import("labspec"), import("labspec/slim")]);
  assert.deepEqual(Object.keys(browser).sort(), Object.keys(node).sort());
  for (const name of Object.keys(node)) assert.ok(browser[name] === node[name] && slim[name] === node[name], name);
});
