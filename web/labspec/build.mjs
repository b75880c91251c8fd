// Builds the package from the modules that `bindings/xtask` has put into `generated/`.
import { build } from "esbuild";
import { execFileSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { compressed } from "./compress.mjs";

const root = dirname(fileURLToPath(import.meta.url));
const at = (...parts) => join(root, ...parts);
process.chdir(root);

/** The types of fields, from the table in the module. */
async function fieldTypes() {
  const glue = await import(at("generated/checker/labspec.js"));
  glue.initSync({ module: readFileSync(at("generated/checker/labspec_bg.wasm")) });
  const rows = JSON.parse(glue.fieldTable());
  const docs = JSON.parse(glue.fieldDocs());
  const arrays = { f64: "Float64Array", i32: "Int32Array", bool: "Uint8Array" };
  const interfaces = [
    ["model", "ModelFields", "Fields of a model."], ["opt", "OptionFields", "Options of the simulation."],
    ["stat", "StatisticFields", "Statistics of a model."], ["data", "DataFields", "Fields of data."],
  ];
  let text = "// Made by build.mjs from the table of fields of the engine.\nimport type { FieldView } from \"./fields.js\";\n";
  for (const [object, name, doc] of interfaces) {
    text += `\n/** ${doc} */\nexport interface ${name} {\n`;
    rows.forEach(([of, field, elem, dims, , writable], i) => {
      if (of !== object) return;
      const [unit, what] = docs[i];
      const shape = dims.length > 0 ? ` [${dims.join(", ")}]` : "";
      const type = dims.length > 0 ? `FieldView<${arrays[elem]}>` : elem === "bool" ? "boolean" : "number";
      text += `  /** ${what.replaceAll("*/", "* /")}${unit === "" ? "" : `, ${unit}`}${shape} */\n`;
      const setter = writable && dims.length > 0;
      if (setter) text += `  get ${field}(): ${type};\n  set ${field}(values: ${type} | readonly number[]);\n`;
      else text += `  ${writable ? "" : "readonly "}${field}: ${type};\n`;
    });
    text += "}\n";
  }
  const file = at("src/field-types.ts");
  if (!existsSync(file) || readFileSync(file, "utf8") !== text) writeFileSync(file, text);
}

const conditions = ["browser", "inline", "node", "workerd"];
const PLAYER = [...conditions, "slim"];
/** The modules of the package: the folder in `dist`, its entries, and those of them that `require` takes, too. */
const modules = {
  player: {
    folder: "", names: [...PLAYER, ...conditions.map((c) => `mujoco-${c}`), "worker-browser", "worker-node", "worker-host", "worker-host-node"],
    required: ["node", "slim", "mujoco-node", "worker-node"],
  },
  compiled: { folder: "compiled", names: PLAYER, required: ["node", "slim"] },
  checker: { folder: "checker", names: conditions.map((c) => `checker-${c}`), required: ["checker-node"] },
};
/** What the entries share, in one file: see `core.ts`. */
const CORE = ["core", ...readFileSync(at("src/core.ts"), "utf8").matchAll(/export \* from "\.\/([\w-]+)\.js"/g)].map((found) => typeof found === "string" ? found : found[1]);
/** What entries share that do not need the module. */
const ALONE = ["error"];

/** Imports of what is shared become imports of its file; so does the import of an entry by another one, if that is built as well. */
const shared = (names) => ({
  name: "shared",
  setup: (b) => b.onResolve({ filter: /^\.\.?\// }, ({ path, resolveDir }) => {
    const name = relative(at("src"), join(resolveDir, path)).replace(/\.js$/, "");
    const entry = name.replace(/^entry\//, "");
    if (ALONE.includes(name) || (entry !== name && names.includes(entry))) return { path: `./${entry}.js`, external: true };
    return CORE.includes(name) ? { path: "./core.js", external: true } : undefined;
  }),
});
const alone = {
  name: "alone",
  setup: (b) => b.onResolve({ filter: /\/error\.js$/ }, () => ({ path: "./error.js", external: true })),
};

/** One module with its entries. */
async function bundle(module, { folder, names, required }) {
  const out = at("dist", folder);
  mkdirSync(out, { recursive: true });
  const wasm = at("generated", module, "labspec_bg.wasm");
  copyFileSync(wasm, join(out, "labspec.wasm"));
  const packed = at("generated", module, "labspec_bg.packed");
  // The checker is twice as large, and rarely part of a script.
  const text = module === "checker" ? gzipSync(readFileSync(packed), { level: 9 }) : await compressed(packed);
  const texts = { module: text, unpacker: readFileSync(at("generated/unpack.wasm")) };
  writeFileSync(join(out, "inline-module.js"), Object.entries(texts).map(([name, bytes]) => `export const ${name} = "${bytes.toString("base64")}";\n`).join(""));
  const glue = { name: "glue", setup: (b) => b.onResolve({ filter: /^#glue$/ }, () => ({ path: at("generated", module, "labspec.js") })) };
  const outside = ["./labspec.wasm", "./inline-module.js", "node:*"];
  const common = { bundle: true, outdir: out, target: "es2022", legalComments: "none", external: outside, logLevel: "warning" };
  await build({ ...common, entryPoints: [at("src/core.ts")], format: "esm", plugins: [glue, alone] });
  await build({ ...common, entryPoints: ALONE.map((name) => at("src", `${name}.ts`)), format: "esm" });
  await build({ ...common, entryPoints: names.map((name) => at("src/entry", `${name}.ts`)), format: "esm", plugins: [glue, shared(names)] });
  await build({
    ...common, entryPoints: required.map((name) => at("src/entry", `${name}.ts`)), format: "cjs", outExtension: { ".js": ".cjs" }, plugins: [glue],
    define: { "import.meta.url": "importMetaUrl" },
    banner: { js: 'const importMetaUrl = typeof __filename === "string" ? require("node:url").pathToFileURL(__filename).href : "";' },
  });
}

/** The types once more for `require`. */
function requiredTypes() {
  const walk = (folder) => {
    for (const entry of readdirSync(folder, { withFileTypes: true })) {
      const path = join(folder, entry.name);
      if (entry.isDirectory()) walk(path);
      else if (path.endsWith(".d.ts")) {
        const text = readFileSync(path, "utf8").replaceAll(/(from\s+"\.[^"]*)\.js"/g, '$1.cjs"').replaceAll(/(import\("\.[^"]*)\.js"/g, '$1.cjs"');
        writeFileSync(path.replace(/\.d\.ts$/, ".d.cts"), text);
      }
    }
  };
  walk(at("dist/types"));
}

rmSync(at("dist"), { recursive: true, force: true });
await fieldTypes();
for (const [module, entries] of Object.entries(modules)) await bundle(module, entries);
execFileSync(process.execPath, [at("../node_modules/typescript/bin/tsc"), "-p", at("tsconfig.json")], { stdio: "inherit" });
// Nothing that is exported names the module's own types.
for (const file of ["glue.d.ts", "core.d.ts", "worker-host.d.ts", "entry/browser.d.ts", "entry/inline-module.d.ts"]) rmSync(at("dist/types", file), { force: true });
requiredTypes();
