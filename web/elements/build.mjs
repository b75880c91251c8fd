// Builds the elements: `dist/labspec-elements.js`, one file with everything, and `dist/elements.js` with files beside it.
import { build } from "esbuild";
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { compressed } from "../labspec/compress.mjs";

const root = dirname(fileURLToPath(import.meta.url));
const at = (...parts) => join(root, ...parts);
const wasm = at("../labspec/dist/labspec.wasm");

const common = {
  absWorkingDir: root, bundle: true, write: false, minify: true, target: "es2022", legalComments: "none", logLevel: "warning",
  loader: { ".css": "text" },
};

/** Style sheets without what only people read. */
const styles = {
  name: "styles",
  setup: (b) => b.onLoad({ filter: /\.css$/ }, async ({ path }) => {
    const { transform } = await import("esbuild");
    const { code } = await transform(readFileSync(path, "utf8"), { loader: "css", minify: true, target: ["chrome123", "firefox120", "safari17.5"] });
    return { contents: code, loader: "text" };
  }),
};

/** Classes of the package that the engine of labs never constructs. A bundler keeps them, because methods that nothing calls name them. */
const UNUSED = ["RawData", "RawExpression", "RawModel", "Model"];
const withoutUnused = {
  name: "without unused",
  setup: (b) => b.onLoad({ filter: /labspec[/\\]dist[/\\]core\.js$/ }, ({ path }) => {
    let text = readFileSync(path, "utf8");
    for (const name of UNUSED) {
      const written = new RegExp(`^var ${name} = class[^{\\n]*\\{\\n[^]*?\\n\\};\\n(if \\(Symbol\\.dispose\\) ${name}\\..*\\n)?`, "m");
      if (!written.test(text)) throw new Error(`${path} has no class ${name}`);
      text = text.replace(written, `var ${name} = class {};\n`);
    }
    return { contents: text, loader: "js" };
  }),
};

/** The engine as a program that uses nothing but `channel`. */
async function engine() {
  const { outputFiles } = await build({ ...common, entryPoints: [at("src/entry/engine.ts")], format: "iife", plugins: [withoutUnused] });
  return outputFiles[0].text;
}

const generated = (name) => at("../labspec/generated", name);
const program = await engine();
const packed = { module: await compressed(generated("player/labspec_bg.packed")), unpacker: readFileSync(generated("unpack.wasm")) };
const made = {
  name: "made",
  setup(b) {
    b.onResolve({ filter: /^#(engine|module)$/ }, ({ path }) => ({ path, namespace: "made" }));
    b.onLoad({ filter: /^#engine$/, namespace: "made" }, () => ({ contents: `export function serve(channel) {\n${program}\n}` }));
    const texts = Object.fromEntries(Object.entries(packed).map(([name, bytes]) => [name, bytes.toString("base64")]));
    const contents = `import { compilePacked } from "./packed.js"; export const compile = () => compilePacked(${JSON.stringify(texts)});`;
    b.onLoad({ filter: /^#module$/, namespace: "made" }, () => ({ contents, resolveDir: at("../labspec/src") }));
  },
};

rmSync(at("dist"), { recursive: true, force: true });
mkdirSync(at("dist"));
for (const [entry, name] of [["entry/one-file", "labspec-elements.js"], ["entry/elements", "elements.js"], ["bytes", "bytes.js"]]) {
  const { outputFiles } = await build({ ...common, entryPoints: [at(`src/${entry}.ts`)], format: "esm", plugins: [styles, made] });
  writeFileSync(at("dist", name), outputFiles[0].contents);
}
writeFileSync(at("dist/engine.js"), `(function(channel){${program}})(self);\n`);
copyFileSync(wasm, at("dist/labspec.wasm"));
execFileSync(process.execPath, [at("../node_modules/typescript/bin/tsc"), "-p", at("tsconfig.json")], { stdio: "inherit" });
