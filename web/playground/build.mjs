// Builds the page: `dist/`, which any server of files can serve.
import { build } from "esbuild";
import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { Checker } from "labspec/checker";

const root = dirname(fileURLToPath(import.meta.url));
const at = (...parts) => join(root, ...parts);
const [elements, checker, specs] = [at("../elements/dist"), at("../labspec/dist/checker"), at("../../specs")];

/** What is in files of its own stays an import of that file. */
const separate = (names) => ({
  name: "separate",
  setup: (b) => {
    for (const [name, path] of Object.entries(names)) b.onResolve({ filter: new RegExp(`^${name}$`) }, () => ({ path, external: true }));
  },
});
const common = { absWorkingDir: root, bundle: true, minify: true, format: "esm", target: "es2022", legalComments: "none", logLevel: "warning" };

rmSync(at("dist"), { recursive: true, force: true });
mkdirSync(at("dist/checker"), { recursive: true });
mkdirSync(at("dist/elements"));
await build({ ...common, entryPoints: [at("src/main.ts")], outfile: at("dist/main.js"), plugins: [separate({ "labspec-elements": "./elements/elements.js" })] });
await build({ ...common, entryPoints: [at("../editor/src/worker.ts")], outfile: at("dist/checker/worker.js"), plugins: [separate({ "labspec/checker": "./checker-browser.js" })] });
for (const name of ["checker-browser.js", "core.js", "error.js", "inline-module.js", "labspec.wasm"]) cpSync(join(checker, name), at("dist/checker", name));
for (const name of ["elements.js", "engine.js", "labspec.wasm"]) cpSync(join(elements, name), at("dist/elements", name));
for (const name of ["index.html", "style.css"]) cpSync(at("src", name), at("dist", name));

// The course: lessons with their models, and the list of their labs.
cpSync(join(specs, "lessons"), at("dist/course"), { recursive: true });
cpSync(join(specs, "models"), at("dist/course/models"), { recursive: true, filter: (path) => !path.endsWith("zoo") });
const list = readdirSync(at("dist/course")).filter((name) => name.endsWith(".md")).sort().map((path) => {
  const text = readFileSync(at("dist/course", path), "utf8");
  const labs = new Checker().labs(path, text).map(({ address, title }) => ({ address, title }));
  return { path, title: /^#\s+(.+)$/m.exec(text)?.[1] ?? path, labs };
});
writeFileSync(at("dist/course/index.json"), JSON.stringify(list.filter(({ labs }) => labs.length > 0)));
for (const folder of ["../editor", "."]) execFileSync(process.execPath, [at("../node_modules/typescript/bin/tsc"), "-p", at(folder, "tsconfig.json")], { stdio: "inherit" });
