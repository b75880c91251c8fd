// Builds the adapters: each is one file without dependencies, so that a tool can take it by its path or its address.
import { build } from "esbuild";
import { execFileSync } from "node:child_process";
import { chmodSync, mkdirSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const root = dirname(fileURLToPath(import.meta.url));
const at = (...parts) => join(root, ...parts);
const FILES = {
  core: "core.js", remark: "remark.js", "markdown-it": "markdown-it.js", mdbook: "mdbook.js", "mdbook-labspec": "mdbook-labspec.js", myst: "myst.mjs",
};

rmSync(at("dist"), { recursive: true, force: true });
mkdirSync(at("dist"));
for (const [entry, name] of Object.entries(FILES)) {
  const { outputFiles } = await build({
    absWorkingDir: root, entryPoints: [at(`src/entry/${entry}.ts`)], bundle: true, write: false, format: "esm", platform: "node", target: "node20",
    legalComments: "none", logLevel: "warning",
  });
  writeFileSync(at("dist", name), outputFiles[0].contents);
}
chmodSync(at("dist/mdbook-labspec.js"), 0o755);
execFileSync(process.execPath, [at("../node_modules/typescript/bin/tsc"), "-p", at("tsconfig.json")], { stdio: "inherit" });
