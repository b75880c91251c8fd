// Modules of the sources, for tests in node.
import { build } from "esbuild";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const root = join(dirname(fileURLToPath(import.meta.url)), "..");

/** The exports of one or more modules, which share what they import. */
export async function load(...paths) {
  const stdin = { contents: paths.map((path) => `export * from "./${path}";`).join("\n"), resolveDir: join(root, "src") };
  const { outputFiles } = await build({ stdin, bundle: true, write: false, format: "esm", target: "es2022", loader: { ".css": "text" } });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}

/** Random numbers from a seed, the same in every run. */
export function random(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = state;
    t = Math.imul(t ^ (t >>> 15), t | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}
