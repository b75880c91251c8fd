// What the engine and the language weigh as WebAssembly by feature, and the modules of the npm package: bytes as they are, by `gzip -9`
// and by brotli 11.
//
//   node bindings/size/weigh.mjs [--out docs/measured/sizes.md]
//
// `npm ci` in `web` gives `wasm-opt`; the modules of the package are weighed where they are built. With `--out`, the tables of that page
// are written anew.
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";
import { writeSection } from "../../web/labspec/bench/section.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const web = join(here, "../../web");
const target = process.env.CARGO_TARGET_DIR ?? join(here, "../../target/size");
// What rustc lets the compiler use, and no more.
const USED = ["bulk-memory", "mutable-globals", "multivalue", "nontrapping-float-to-int", "reference-types", "sign-ext", "simd"].map((name) => `--enable-${name}`);
/** As `bindings/xtask` optimizes the modules of the package. */
const OPTIONS = ["-O3", "--one-caller-inline-max-function-size=200", "--strip-producers"];

/** Name, features. */
const BUILDS = [
  ["engine, MJCF with pictures, convex shapes", ["pictures"]],
  ["without pictures", ["mjcf"]],
  ["without MJCF: compiled models", ["convex"]],
  ["without MJCF and convex shapes", []],
  ["engine and language, MJCF with pictures, convex shapes", ["pictures", "language"]],
  ["engine and language, without MJCF and convex shapes", ["language"]],
];

function built(features) {
  const args = ["build", "--quiet", "--profile", "speed", "--target", "wasm32-unknown-unknown", "--target-dir", target, "--no-default-features", "--features", features.join()];
  execFileSync("cargo", args, { cwd: here, stdio: "inherit", env: { ...process.env, RUSTFLAGS: "-C target-feature=+simd128" } });
  const file = join(target, "wasm32-unknown-unknown/speed/labspec_size.wasm");
  execFileSync(join(web, "node_modules/.bin/wasm-opt"), [...OPTIONS, ...USED, file, "-o", `${file}.opt`]);
  return `${file}.opt`;
}

function cells(file) {
  const bytes = readFileSync(file);
  const brotli = brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length } });
  return [bytes.length, gzipSync(bytes, { level: 9 }).length, brotli.length].map((n) => n.toLocaleString("en"));
}

const lines = [];
/** A build takes minutes: each row is shown when it is there. */
const add = (line) => {
  console.log(line);
  lines.push(line);
};
const head = ["| module | bytes | `gzip -9` | brotli 11 |", "|---|---:|---:|---:|"];
head.forEach(add);
for (const [name, features] of BUILDS) add(`| ${[name, ...cells(built(features))].join(" | ")} |`);
for (const [name, module] of [["player (`labspec`): the same and labs", "player"], ["`labspec/compiled`: the player without MJCF and convex shapes", "compiled"], ["checker (`labspec/checker`): the player and lessons, lint, verification", "checker"]]) {
  const file = join(web, "labspec/generated", module, "labspec_bg.wasm");
  if (existsSync(file)) add(`| ${[name, ...cells(file)].join(" | ")} |`);
}
const at = process.argv.indexOf("--out");
if (at > 0) writeSection(process.argv[at + 1], "weigh.mjs", lines);
