// What the tests of pages share: a server of the repository, pages, and what goes wrong in them.
import assert from "node:assert/strict";
import { existsSync, readFileSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { dirname, extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { collectErrors } from "../browser.mjs";

export { chromiumOnly, isChromium, launch, launchWithoutWebGl, newContext, saveFile } from "../browser.mjs";

export const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
export const repository = join(root, "../..");
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm", ".json": "application/json", ".xml": "text/xml" };

/** Serves the repository, pages given as text, and headers for them. */
export async function serve(pages = {}, headers = {}) {
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname));
    if (pages[path] !== undefined) return response.writeHead(200, { "content-type": "text/html", ...headers }).end(pages[path]);
    const file = join(repository, path);
    if (!existsSync(file) || !statSync(file).isFile()) return response.writeHead(404).end();
    return response.writeHead(200, { "content-type": TYPES[extname(file)] ?? "application/octet-stream" }).end(readFileSync(file));
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  server.unref();
  return { url: `http://127.0.0.1:${server.address().port}`, pages, close: () => server.close() };
}

/** Errors of a page: nothing may be said on its console. */
export function watchErrors(page) {
  const errors = collectErrors(page);
  return { none: () => assert.deepEqual(errors, []), errors };
}

/** Waits until the lab of a selector is open. */
export const opened = (page, selector = "sim-lab") => page.evaluate((s) => document.querySelector(s).ready, selector);

const SCRIPT = "/web/elements/dist/labspec-elements.js";

/** A page with some HTML in its body. */
export const pageOf = (body, { script = SCRIPT, head = "", lang = "en" } = {}) => `<!doctype html><html lang="${lang}"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1"><title>Test</title><link rel="icon" href="data:,">
<script type="module" src="${script}"></script>${head}</head><body><main><h1>Test</h1><h2>Lab</h2>${body}</main></body></html>`;

/** A lab as an element. */
export const labOf = (json, { id = "lab", models = {}, attributes = "" } = {}) => `<sim-lab id="${id}" ${attributes}><script type="application/json">${JSON.stringify(json).replaceAll("</", "<\\/")}</script>${
  Object.entries(models).map(([name, xml]) => `<script type="model/mjcf" data-name="${name}">${xml}</script>`).join("")}</sim-lab>`;

/** A ball over a floor. */
export const drop = "<mujoco><worldbody><light pos='0 0 3'/><geom name='floor' type='plane' size='2 2 1' rgba='.8 .8 .8 1'/><body name='bob' pos='0 0 1'><freejoint name='fall'/><geom name='ball' size='.1' rgba='.2 .4 .8 1'/></body></worldbody></mujoco>";
export const dropLab = {
  title: "A drop", model: "drop", toggles: ["contacts", "forces"],
  controls: [
    { label: "gravity", unit: "m/s²", set: "model.opt.gravity[2]", min: -20, max: -1, step: 0.1, value: -9.8, digits: 1, reset: true },
    { type: "select", label: "start", apply: "data.joint('fall').qpos[2] = value", options: [["low", 0.5], ["high", 1]], value: 1, init: true, reset: true },
    { type: "button", label: "Kick", run: "data.joint('fall').qvel[2] = 3" },
  ],
  plots: [{ ylabel: "height (m)", window: 2, refLines: [{ y: 0.1, label: "radius" }], traces: [{ label: "ball", expr: "data.body('bob').xpos[2]" }] }],
  readouts: [{ label: "height (m)", expr: "data.body('bob').xpos[2]" }, { label: "state", expr: "data.ncon > 0 ? 'touching' : 'free'" }],
  note: "Moving the slider drops the ball again. <script>alert(1)</script>",
};
