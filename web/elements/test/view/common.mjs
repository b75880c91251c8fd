// What the tests of the 3D view share: its modules, compiled; recorded scenes; a page in Chromium.
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { build } from "esbuild";
import { chromium } from "playwright-core";

const SOURCE = new URL("../../src/view/", import.meta.url);

/** The view's modules in one, as text. */
export async function bundle(text, format = "esm") {
  const { outputFiles } = await build({
    stdin: { contents: text, resolveDir: SOURCE.pathname, loader: "ts" }, bundle: true, write: false, format, target: "es2022", minify: format === "iife",
  });
  return outputFiles[0].text;
}

/** Modules of the view, for node. */
export async function modules(...names) {
  const text = await bundle(names.map(name => `export * from "./${name}.ts";`).join("\n"));
  return import(`data:text/javascript;base64,${Buffer.from(text).toString("base64")}`);
}

const INTEGERS = /_(type|bodyid|group|matid|dataid|\w*adr|\w*num|face|facenormal|facetexcoord|nrow|ncol|texid|castshadow|active|projection|parentid|obj)$/;

/** Arrays of numbers become typed arrays; runs of ids become one id for each pixel. */
export function decode(scene) {
  const typed = fields => Object.fromEntries(Object.entries(fields).map(([name, value]) => {
    if (name === "textures") return [name, value.map(t => ({ ...t, data: Uint8Array.from(t.data) }))];
    if (!Array.isArray(value) || ["cameras", "contacts", "center"].includes(name)) return [name, value];
    return [name, (INTEGERS.test(name) ? Int32Array : Float64Array).from(value)];
  }));
  return { ...scene, model: typed(scene.model), frame: typed(scene.frame) };
}

const read = name => JSON.parse(readFileSync(new URL(`golden/${name}.json`, import.meta.url), "utf8"));
const RECORDED = read("scenes");
export const TEXTURED = read("textures");
export const NAMES = Object.keys(RECORDED);
export const SIZE = [320, 240];

export const recorded = name => RECORDED[name];
export const scene = name => decode(RECORDED[name]);

/** The id of every pixel, from run lengths. */
export function pixels(runs) {
  const out = [];
  for (let i = 0; i < runs.length; i += 2) for (let k = 0; k < runs[i + 1]; k++) out.push(runs[i]);
  return Int32Array.from(out);
}

/** The camera of a view: what a scene records, and values for the rest. */
export const poseOf = recordedCamera => ({ azimuth: 0, elevation: 0, distance: 1, target: [0, 0, 0], ...recordedCamera });

/** A page with the view as `view`, under a strict policy; close it with `stop`. */
export async function openPage(scale = 1) {
  const text = await bundle(`import { createView, labCamera } from "./index.ts"; import { sharedContext } from "./context.ts"; import { brightness } from "./theme.ts";
    Object.assign(globalThis, { view: { createView, labCamera, sharedContext, brightness }, decode: ${decode.toString().replaceAll("INTEGERS", INTEGERS.toString())} });`, "iife");
  const server = createServer((request, response) => {
    const isScript = request.url === "/view.js";
    response.writeHead(200, {
      "content-type": isScript ? "text/javascript" : "text/html",
      "content-security-policy": "default-src 'none'; script-src 'self'; base-uri 'none'; form-action 'none'",
    });
    response.end(isScript ? text : "<!doctype html><title>view</title><script src='/view.js'></script>");
  });
  await new Promise(resolve => server.listen(0, "127.0.0.1", resolve));
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
  });
  const page = await browser.newPage({ deviceScaleFactor: scale, viewport: { width: 900, height: 700 } });
  const errors = [];
  page.on("pageerror", e => errors.push(String(e)));
  // The tests read pixels, which a page does not.
  const isOfTests = text => text.includes("willReadFrequently");
  page.on("console", m => { if ((m.type() === "error" || m.type() === "warning") && !isOfTests(m.text())) errors.push(m.text()); });
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.evaluate(helpers);
  return { page, errors, stop: async () => { await browser.close(); server.close(); } };
}

/** Functions of the page: a view of a recorded scene, and the pixels of its canvas (base64). */
function helpers() {
  globalThis.show = (recordedScene, { width = 320, height = 240, theme = null, edit = null, ...options } = {}) => {
    const scene = globalThis.decode(recordedScene);
    if (edit) Object.assign(scene.model, globalThis.decode({ model: edit, frame: {} }).model);
    const canvas = document.createElement("canvas");
    canvas.style.width = `${width}px`;
    canvas.style.height = `${height}px`;
    canvas.style.display = "block";
    document.body.append(canvas);
    const view = globalThis.view.createView(canvas, scene.model, { camera: scene.camera, ...options });
    if (theme) view.setTheme(theme);
    view.setFrame(scene.frame);
    view.draw();
    return { canvas, view, scene };
  };
  globalThis.read = canvas => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let text = "";
    for (let i = 0; i < data.length; i += 8192) text += String.fromCharCode(...data.subarray(i, i + 8192));
    return btoa(text);
  };
}
