// The tarball as others use it: node, bundlers, other hosts, pages.
import assert from "node:assert/strict";
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { copyFileSync, cpSync, existsSync, mkdtempSync, rmSync, symlinkSync } from "node:fs";
import { createServer } from "node:net";
import { join, resolve } from "node:path";
import test, { after } from "node:test";
import { firefoxPath, startFirefox } from "../page.mjs";
import { REPORT, chromium, expected, installed, program, resultOf, root, serve, web, write } from "./server.mjs";

const { folder, tarball } = installed();
const browser = await chromium();
after(() => browser.close());
const run = (command, args, options = {}) => execFileSync(command, args, { cwd: folder, encoding: "utf8", ...options }).trim();
const page = (script, more = "") => `<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,">${more}<script type="module" src="${script}"></script>`;

const CSP = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; connect-src 'self'; worker-src 'self'; img-src data:";

/** Runs a page of a folder in Chromium. */
async function inChromium(path, { headers = {}, at = folder } = {}) {
  const server = await serve(at, headers);
  const tab = await browser.newPage();
  try {
    return { ...(await resultOf(tab, server, path)), requests: server.requests };
  } finally {
    await tab.close();
    server.close();
  }
}

test("node: ESM and CommonJS", () => {
  write(folder, { "app.mjs": program(), "app.cjs": program().replace(/import (.*) from (.*);/, "const $1 = require($2);").replace("export ", "") });
  assert.equal(run("node", ["app.mjs"]), expected);
  assert.equal(run("node", ["app.cjs"]), expected);
  for (const entry of ["checker", "compiled", "compiled/slim", "mujoco", "worker", "slim"]) {
    assert.match(run("node", ["-e", `console.log(Object.keys(require("labspec/${entry}")).join())`]), /\w/);
    assert.match(run("node", ["--input-type=module", "-e", `console.log(Object.keys(await import("labspec/${entry}")).join())`]), /\w/);
  }
  const again = (entry, sample) => run("node", ["--input-type=module", "-e", `import { ${sample} as a } from "labspec"; import * as b from "labspec/${entry}"; console.log(b.${sample} === undefined || a === b.${sample})`]);
  assert.equal(again("mujoco", "LabspecError"), "true");
});

/** The folder in which npm has installed other hosts: `npm i deno bun workerd`. */
const hosts = process.env.LABSPEC_HOSTS === undefined ? "" : resolve(process.env.LABSPEC_HOSTS);
// In CI a test that would be skipped fails.
const skipped = (found) => found === undefined && process.env.LABSPEC_REQUIRE !== "all" ? "LABSPEC_HOSTS is not set" : false;
const hostAt = (name) => [join(hosts, "node_modules/.bin", name)].find((path) => hosts !== "" && existsSync(path));
for (const [host, args] of [["deno", ["run", "--allow-read"]], ["bun", ["run"]]]) {
  const found = hostAt(host);
  test(host, { skip: skipped(found) }, () => {
    assert.equal(run(found, [...args, "app.mjs"]), expected);
  });
}

const workerd = hostAt("workerd");
test("workerd", { skip: skipped(workerd) }, async () => {
  const { build } = await import("esbuild");
  write(folder, { "src/workerd.mjs": `${program().replace("export const", "const")}\nexport default { async test() { if (result !== ${JSON.stringify(expected)}) throw new Error(result); } };` });
  await build({
    absWorkingDir: folder, entryPoints: ["src/workerd.mjs"], bundle: true, format: "esm", conditions: ["workerd"], outfile: join(folder, "out/workerd.js"),
    external: ["./labspec.wasm"], logLevel: "error",
  });
  copyFileSync(join(folder, "node_modules/labspec/dist/labspec.wasm"), join(folder, "out/labspec.wasm"));
  write(folder, {
    "out/config.capnp": `using Workerd = import "/workerd/workerd.capnp";
const unitTests :Workerd.Config = (services = [(name = "main", worker = (modules = [(name = "workerd.js", esModule = embed "workerd.js"), (name = "labspec.wasm", wasm = embed "labspec.wasm")], compatibilityDate = "2025-01-01"))]);`,
  });
  const done = spawnSync(workerd, ["test", "config.capnp"], { cwd: join(folder, "out"), encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
});

const next = hostAt("next");
test("next: a component and a route on the server", { skip: skipped(next) }, async () => {
  // The app lies in the folder of `next`, so that it finds it; the package is the installed one.
  const app = mkdtempSync(join(hosts, "next-app-"));
  const port = await freePort();
  const body = program().replace("export const", "const").replace(/globalThis.result = result;[^]*/, "");
  write(app, {
    "package.json": JSON.stringify({ private: true, type: "module" }),
    "next.config.mjs": `export default { turbopack: { root: ${JSON.stringify(hosts)} } };`,
    "app/layout.js": "export default function Layout({ children }) { return <html><body>{children}</body></html>; }",
    "app/page.js": `${body}\nexport const dynamic = "force-dynamic";\nexport default function Page() { return <p>{result}</p>; }`,
    "app/lab/route.js": `${body}\nexport const dynamic = "force-dynamic";\nexport function GET() { return Response.json({ result }); }`,
  });
  cpSync(join(folder, "node_modules/labspec"), join(app, "node_modules/labspec"), { recursive: true });
  const env = { ...process.env, NEXT_TELEMETRY_DISABLED: "1" };
  const built = spawnSync(next, ["build"], { cwd: app, env, encoding: "utf8" });
  assert.equal(built.status, 0, built.stdout + built.stderr);
  const server = spawn(process.execPath, [join(hosts, "node_modules/next/dist/bin/next"), "start", "-p", String(port)], { cwd: app, env });
  try {
    await new Promise((resolve) => server.stdout.on("data", (text) => /Ready/.test(String(text)) && resolve()));
    const got = (path) => fetch(`http://localhost:${port}/${path}`);
    assert.deepEqual(await (await got("lab")).json(), { result: expected });
    assert.match(await (await got("")).text(), new RegExp(`<p>${expected}</p>`));
  } finally {
    server.kill();
    rmSync(app, { recursive: true, force: true });
  }
});

/** A port that nobody uses. */
async function freePort() {
  const server = createServer();
  await new Promise((resolve) => server.listen(0, resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  return port;
}

test("a page without a bundler: an import map", async () => {
  const map = JSON.stringify({ imports: { labspec: "/node_modules/labspec/dist/browser.js" } });
  write(folder, { "app.js": program(), "map.html": page("/app.js", `<script type="importmap">${map}</script>`) });
  const { result, requests, problems } = await inChromium("map.html");
  assert.equal(result, expected);
  assert.deepEqual(problems, []);
  assert.deepEqual(requests.filter((r) => /inline/.test(r)), [], "the inlined module is fetched only where it is needed");
  // What the page has asked for already is not fetched again.
  const dist = "/node_modules/labspec/dist";
  const early = `<link rel="modulepreload" href="${dist}/core.js"><link rel="preload" as="fetch" crossorigin href="${dist}/labspec.wasm">`;
  write(folder, { "early.html": page("/app.js", `${early}<script type="importmap">${map}</script>`) });
  const ahead = await inChromium("early.html");
  assert.deepEqual([ahead.result, ahead.problems], [expected, []]);
  assert.deepEqual(ahead.requests.filter((r) => r.startsWith(dist)).sort(), ["browser.js", "core.js", "error.js", "labspec.wasm"].map((file) => `${dist}/${file}`));
  const inline = JSON.stringify({ imports: { labspec: "/node_modules/labspec/dist/inline.js" } });
  write(folder, { "inline.html": page("/app.js", `<script type="importmap">${inline}</script>`) });
  const other = await inChromium("inline.html");
  assert.equal(other.result, expected);
  assert.deepEqual(other.requests.filter((r) => r.endsWith(".wasm")), []);
});

test("a page with a compiled model fetches the smaller module and no other", async () => {
  const compiled = run("node", ["--input-type=module", "-e", `${program().split("\n").filter((line) => /^(import|const drop)/.test(line)).join("\n").replace("{ Lab }", "{ Model }")}
    console.log(Buffer.from(Model.fromXML(drop).toBytes()).toString("base64"));`]);
  const bytes = `const drop = Uint8Array.from(atob(${JSON.stringify(compiled)}), (c) => c.charCodeAt(0));`;
  const dist = "/node_modules/labspec/dist/compiled";
  const map = JSON.stringify({ imports: { "labspec/compiled": `${dist}/browser.js` } });
  write(folder, {
    "src/compiled.js": program("labspec/compiled").replace(/^const drop = .*$/m, bytes),
    "compiled.html": page("/src/compiled.js", `<script type="importmap">${map}</script>`),
  });
  const { result, requests, problems } = await inChromium("compiled.html");
  assert.deepEqual([result, problems], [expected, []]);
  assert.deepEqual(requests.filter((r) => r.startsWith("/node_modules")).sort(), ["browser.js", "core.js", "error.js", "labspec.wasm"].map((file) => `${dist}/${file}`));
  const { build } = await import("esbuild");
  await build({ absWorkingDir: folder, entryPoints: ["src/compiled.js"], bundle: true, format: "esm", outfile: join(folder, "dist-compiled/app.js"), logLevel: "error" });
  write(folder, { "dist-compiled/index.html": page("app.js") });
  assert.equal((await inChromium("dist-compiled/index.html")).result, expected);
});

const firefox = firefoxPath();
test("Firefox: the same page", { skip: firefox === undefined && process.env.LABSPEC_REQUIRE !== "all" ? "Firefox is not installed" : false }, async () => {
  const map = JSON.stringify({ imports: { labspec: "/node_modules/labspec/dist/browser.js" } });
  write(folder, { "app.js": program(), "firefox.html": page("/app.js", `<script type="importmap">${map}</script>`) });
  const server = await serve(folder, { "content-security-policy": CSP.replace("script-src", "script-src 'unsafe-inline'") });
  const stop = startFirefox(`${server.url}/firefox.html`);
  try {
    const late = new Promise((_, reject) => setTimeout(() => reject(new Error("no result")), 60_000).unref());
    assert.deepEqual(await Promise.race([server.result, late]), { result: expected, origin: server.url, isolated: "false" });
  } finally {
    await stop();
    server.close();
  }
});

test("esbuild", async () => {
  const { build } = await import("esbuild");
  write(folder, { "src/app.js": program(), "dist-esbuild/index.html": page("app.js") });
  await build({ absWorkingDir: folder, entryPoints: ["src/app.js"], bundle: true, format: "esm", outfile: join(folder, "dist-esbuild/app.js"), logLevel: "error" });
  assert.equal((await inChromium("dist-esbuild/index.html")).result, expected);
  copyFileSync(join(folder, "node_modules/labspec/dist/labspec.wasm"), join(folder, "dist-esbuild/labspec.wasm"));
  assert.deepEqual((await inChromium("dist-esbuild/index.html")).problems, []);
});

test("vite, with a worker", async () => {
  const { build } = await import("vite");
  write(folder, {
    "vite/index.html": page("./app.js"),
    "vite/app.js": program().replace(/globalThis.result = result;[^]*/, "") + `
import { startWorker } from "labspec/worker";
const far = await startWorker().open({ model: "drop", readouts: [{ label: "height (m)", expr: "data.body('bob').xpos[2]" }] }, { drop });
await far.playTo(0.2);
globalThis.result = (await far.numbers)[0] === lab.numbers[0] ? result : "other numbers in the worker";
${REPORT}`,
  });
  await build({ root: join(folder, "vite"), base: "./", logLevel: "error", build: { outDir: join(folder, "dist-vite"), target: "es2022", assetsInlineLimit: 0 } });
  const { result, problems } = await inChromium("dist-vite/index.html");
  assert.equal(result, expected);
  assert.deepEqual(problems, []);
});

test("a worker shares its memory with a page that is isolated from other origins, and only with such a page", async () => {
  const map = JSON.stringify({ imports: { labspec: "/node_modules/labspec/dist/browser.js", "labspec/worker": "/node_modules/labspec/dist/worker-browser.js" } });
  write(folder, {
    "worker.js": program().replace(/globalThis.result = result;[^]*/, "") + `
import { startWorker } from "labspec/worker";
const far = await startWorker().open({ model: "drop", readouts: [{ label: "height (m)", expr: "data.body('bob').xpos[2]" }] }, { drop });
const first = await far.frame;
const same = (frame) => frame.time === lab.time && frame.numbers[0] === lab.numbers[0] && lab.poses.every((x, i) => frame.poses[i] === x);
const { steps, ...played } = await far.play(0.2);
globalThis.result = [result, far.isShared, steps, same(played), same(await far.frame), first.time].join();
${REPORT}`,
    "worker.html": page("/worker.js", `<script type="importmap">${map}</script>`),
  });
  const plain = await inChromium("worker.html");
  assert.deepEqual([plain.result, plain.isolated, plain.problems], [`${expected},false,100,true,true,0`, "false", []]);
  const headers = { "cross-origin-opener-policy": "same-origin", "cross-origin-embedder-policy": "require-corp" };
  const isolated = await inChromium("worker.html", { headers });
  assert.deepEqual([isolated.result, isolated.isolated, isolated.problems], [`${expected},true,100,true,true,0`, "true", []]);
});

test("webpack", async () => {
  const { default: webpack } = await import("webpack");
  const stats = await new Promise((resolve, reject) => webpack({
    context: folder, mode: "production", entry: "./src/app.js", output: { path: join(folder, "dist-webpack"), filename: "app.js", module: true },
    experiments: { outputModule: true }, performance: false,
  }, (e, s) => (e ? reject(e) : resolve(s))));
  assert.ok(!stats.hasErrors(), stats.toString("errors-only"));
  write(folder, { "dist-webpack/index.html": page("app.js") });
  const { result, problems } = await inChromium("dist-webpack/index.html");
  assert.equal(result, expected);
  assert.deepEqual(problems, []);
});

test("rolldown", async () => {
  const { rolldown } = await import("rolldown");
  const bundle = await rolldown({ cwd: folder, input: "src/app.js", platform: "browser", logLevel: "silent" });
  await bundle.write({ dir: join(folder, "dist-rolldown"), format: "esm" });
  write(folder, { "dist-rolldown/index.html": page("app.js") });
  assert.equal((await inChromium("dist-rolldown/index.html")).result, expected);
});

test("a strict policy: 'self' and 'wasm-unsafe-eval' are enough", async () => {
  const { result, problems } = await inChromium("dist-vite/index.html", { headers: { "content-security-policy": CSP } });
  assert.equal(result, expected);
  assert.deepEqual(problems, []);
});

test("the official package needs more than this policy", async () => {
  symlinkSync(join(web, "node_modules/@mujoco/mujoco"), join(folder, "official"));
  write(folder, {
    "official.html": page("/official.js"),
    "official.js": "import load from './official/mujoco.js'; try { const m = await load(); m.MjModel.from_xml_string('<mujoco/>'); globalThis.result = 'works'; } catch (e) { globalThis.result = String(e); } " + REPORT,
  });
  const free = await inChromium("official.html");
  assert.equal(free.result, "works");
  const strict = await inChromium("official.html", { headers: { "content-security-policy": CSP } });
  assert.match(strict.result, /EvalError|unsafe-eval|Content Security Policy/);
});

test("a sandboxed frame of another origin", async () => {
  const inner = await serve(folder, { "access-control-allow-origin": "*", "content-security-policy": "script-src 'self' 'wasm-unsafe-eval' " });
  const tab = await browser.newPage();
  write(folder, { "outer/index.html": `<!doctype html><link rel="icon" href="data:,"><iframe sandbox="allow-scripts" src="${inner.url}/dist-webpack/index.html"></iframe>` });
  const outer = await serve(join(folder, "outer"));
  await tab.goto(`${outer.url}/index.html`);
  const seen = await inner.result;
  assert.deepEqual(seen, { result: expected, origin: "null", isolated: "false" });
  await tab.close();
  inner.close();
  outer.close();
});

test("publint and the types", () => {
  const lint = spawnSync("npx", ["publint", "--strict", tarball], { cwd: web, encoding: "utf8" });
  assert.equal(lint.status, 0, lint.stdout + lint.stderr);
  const args = ["attw", tarball, "--profile", "node16", "--exclude-entrypoints", "labspec.wasm", "compiled.wasm", "checker.wasm", "--no-emoji", "--format", "ascii"];
  const types = spawnSync("npx", args, { cwd: web, encoding: "utf8" });
  assert.equal(types.status, 0, types.stdout + types.stderr);
});

test("the types are strict", () => {
  write(folder, {
    "typed.ts": `
import { Data, Expression, Lab, LabspecError, Model, type Control } from "labspec";
import { Checker } from "labspec/checker";
import { startWorker } from "labspec/worker";
import { init } from "labspec/slim";
const model: Model = Model.fromXML("<mujoco/>");
const data = new Data(model);
const qpos: Float64Array = data.qpos;
const shape: readonly number[] = data.qpos.shape;
model.opt.timestep = 0.001;
data.qpos = [1, 2];
// @ts-expect-error there is no such field
data.qpso;
// @ts-expect-error sizes cannot be written
model.nq = 3;
const controls: readonly Control[] = new Lab("{}").controls;
export { Checker, Expression, LabspecError, controls, init, qpos, shape, startWorker };`,
    "tsconfig.json": JSON.stringify({ compilerOptions: { strict: true, noEmit: true, module: "nodenext", target: "es2022", lib: ["es2022", "dom", "esnext.disposable"], types: [], skipLibCheck: false, exactOptionalPropertyTypes: true }, files: ["typed.ts"] }),
  });
  const done = spawnSync(process.execPath, [join(web, "node_modules/typescript/bin/tsc"), "-p", "."], { cwd: folder, encoding: "utf8" });
  assert.equal(done.status, 0, done.stdout);
  assert.equal(spawnSync("grep", ["-rnwE", ": any|<any>|any\\[\\]", join(root, "dist/types")], { encoding: "utf8" }).stdout, "");
});
