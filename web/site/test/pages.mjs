// What the tests of pages share: the program, servers, pages, and what goes wrong in them.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { collectErrors, newContext } from "../../elements/test/browser.mjs";

export { chromiumOnly, isChromium, launch } from "../../elements/test/browser.mjs";

export const root = join(dirname(fileURLToPath(import.meta.url)), "..");
export const repository = join(root, "../..");
const program = process.env.LABSPEC ?? join(repository, "target/debug/labspec");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const TYPES = {
  ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".json": "application/json",
  ".woff2": "font/woff2", ".xml": "text/xml", ".png": "image/png", ".svg": "image/svg+xml",
};

/** A folder that is removed after the tests. */
export function folder(t) {
  const path = mkdtempSync(join(tmpdir(), "labspec-site-"));
  t.after(() => rmSync(path, { recursive: true, force: true }));
  return path;
}

/** A copy of the example course that a test may change. */
export function course(t) {
  const path = folder(t);
  cpSync(join(repository, "specs"), path, { recursive: true });
  return join(path, "lessons");
}

/** Runs the program to its end. */
export function labspec(...args) {
  const { status, stdout, stderr } = spawnSync(program, args, { encoding: "utf8", env: { ...process.env, LABSPEC_PAGE: join(root, "dist") } });
  return { status, stdout, stderr };
}

/** Starts the preview; gives its address. */
export async function preview(t, path) {
  const running = spawn(program, ["preview", path], { env: { ...process.env, LABSPEC_PAGE: join(root, "dist") }, stdio: ["ignore", "pipe", "pipe"] });
  t.after(() => running.kill());
  let said = "";
  return new Promise((resolve, reject) => {
    for (const stream of [running.stdout, running.stderr]) {
      stream.on("data", (data) => {
        said += data;
        const url = /http:\/\/127\.0\.0\.1:\d+\//.exec(said);
        if (url) resolve(url[0]);
      });
    }
    running.on("exit", (code) => reject(new Error(`the preview ended with ${code}: ${said}`)));
  });
}

/** Serves a folder as any host does. */
export async function serve(t, path) {
  const server = createServer((request, response) => {
    const name = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname));
    const file = join(path, name.endsWith("/") ? `${name}index.html` : name);
    if (!existsSync(file) || !statSync(file).isFile()) return response.writeHead(404).end();
    return response.writeHead(200, { "content-type": TYPES[extname(file)] ?? "application/octet-stream" }).end(readFileSync(file));
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const close = () => {
    server.closeAllConnections();
    server.close();
  };
  t.after(close);
  return { url: `http://127.0.0.1:${server.address().port}/`, close };
}

/** Opens a page; nothing may be said on its console. */
export async function open(t, browser, url, options = {}) {
  const context = await newContext(browser, options);
  t.after(() => context.close());
  const page = await context.newPage();
  const errors = collectErrors(page);
  await page.goto(url);
  return { page, context, errors, none: () => assert.deepEqual(errors, []) };
}

/** Waits until the lab of a selector is open. */
export const opened = (page, selector) => page.evaluate(async (s) => {
  await customElements.whenDefined("sim-lab");
  await document.querySelector(s).ready;
}, selector);

/**
 * What axe finds that is serious. The title of a lab is a heading of level 3 whatever is around it, which axe calls moderate where a
 * lab comes before the second heading of a lesson.
 */
export async function findings(page) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ["violations"] }));
  const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
  return serious.map(({ id, impact, nodes }) => `${impact}: ${id} at ${nodes.map((n) => n.target.join(" ")).slice(0, 3).join(", ")}: ${nodes[0].failureSummary}`);
}
