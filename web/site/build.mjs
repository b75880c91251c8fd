// Builds the scripts and styles of pages into `dist`, with the elements, the engine and KaTeX: everything that `labspec build` and
// `labspec preview` put into the folder `page` of a site.
import { build, transform } from "esbuild";
import { execFileSync } from "node:child_process";
import { copyFileSync, cpSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const root = dirname(fileURLToPath(import.meta.url));
const at = (...parts) => join(root, ...parts);
const katex = join(dirname(createRequire(import.meta.url).resolve("katex/package.json")), "dist");
const elements = at("../elements/dist");

execFileSync(process.execPath, [at("../node_modules/typescript/bin/tsc"), "-p", at("tsconfig.json")], { stdio: "inherit" });
rmSync(at("dist"), { recursive: true, force: true });
mkdirSync(at("dist/fonts"), { recursive: true });

const common = { absWorkingDir: root, bundle: true, minify: true, target: "es2022", legalComments: "none", logLevel: "warning" };
// The editor is loaded when the first block is edited.
const separate = { name: "separate", setup: (b) => b.onResolve({ filter: /^\.\/editor\.js$/ }, () => ({ path: "./editor.js", external: true })) };
await build({ ...common, entryPoints: [at("src/preview/main.ts")], outfile: at("dist/preview.js"), format: "esm", plugins: [separate] });
await build({ ...common, entryPoints: [at("src/preview/editor.ts")], outfile: at("dist/editor.js"), format: "esm" });
for (const [entry, name, format] of [["site", "site", "esm"], ["katex", "katex", "esm"], ["offline", "sw", "iife"]]) {
  await build({ ...common, entryPoints: [at(`src/${entry}.ts`)], outfile: at(`dist/${name}.js`), format });
}

/** Style sheets without what only people read, for the browsers that the elements support. */
async function style(text, name) {
  const { code } = await transform(text, { loader: "css", minify: true, target: ["chrome123", "firefox121", "safari17.5"] });
  writeFileSync(at("dist", name), code);
}
await style(readFileSync(at("src/site.css"), "utf8"), "site.css");
await style(readFileSync(at("src/preview/preview.css"), "utf8"), "preview.css");

// Every browser that has these pages has WOFF2.
const fonts = readFileSync(join(katex, "katex.css"), "utf8").replace(/,\s*url\([^)]*\.(?:woff|ttf)\)\s*format\([^)]*\)/g, "");
if (/\.(?:woff|ttf)\)/.test(fonts)) throw new Error("the style sheet of KaTeX has fonts that are not copied");
await style(fonts, "katex.css");
for (const name of readdirSync(join(katex, "fonts")).filter((file) => file.endsWith(".woff2"))) {
  cpSync(join(katex, "fonts", name), at("dist/fonts", name));
}
cpSync(join(katex, "../LICENSE"), at("dist/katex-license.txt"));
for (const name of ["elements.js", "engine.js", "labspec.wasm"]) copyFileSync(join(elements, name), at("dist", name));
