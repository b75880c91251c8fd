// The README's example prints what is written under it.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import test from "node:test";

test("the README's example", () => {
  const readme = readFileSync(new URL("../README.md", import.meta.url), "utf8");
  const [, program] = /```js\n([^]*?)```/.exec(readme);
  const [, printed] = /```text\n([^]*?)```/.exec(readme);
  const cwd = new URL("..", import.meta.url);
  assert.equal(execFileSync(process.execPath, ["--input-type=module", "-e", program], { cwd, encoding: "utf8" }), printed);
});
