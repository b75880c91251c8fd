// What models that are compiled ahead would gain on a page: the time from the module to the first state of a scene, from MJCF and from the
// bytes of `Model.toBytes`, and the bytes that a page fetches, in Chromium: `node bench/models.mjs`. Every page is new, so that each function
// of the module is compiled for the first time. The medians of 15 pages (PAGES) are printed.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { Model } from "labspec";
import { launch, repository, serve } from "../../elements/test/page/site.mjs";

const PAGES = Number(process.env.PAGES ?? 15);
const NAMES = ["drop", "double_pendulum", "hoist", "book", "pinch", "two_balls"];

/** A closed surface with waves, as OBJ. */
function wavySphere(rings, sides) {
  const vertices = ["v 0 0 0.1", "v 0 0 -0.1"];
  for (let i = 1; i < rings; i++) {
    for (let j = 0; j < sides; j++) {
      const [a, b] = [(Math.PI * i) / rings, (2 * Math.PI * j) / sides];
      const r = 0.1 * (1 + 0.05 * Math.cos(7 * a) * Math.cos(5 * b));
      vertices.push(`v ${[r * Math.sin(a) * Math.cos(b), r * Math.sin(a) * Math.sin(b), r * Math.cos(a)].map((x) => x.toFixed(6)).join(" ")}`);
    }
  }
  const at = (i, j) => 3 + (i - 1) * sides + (j % sides);
  const faces = [];
  for (let j = 0; j < sides; j++) {
    faces.push(`f 1 ${at(1, j)} ${at(1, j + 1)}`, `f 2 ${at(rings - 1, j + 1)} ${at(rings - 1, j)}`);
    for (let i = 1; i < rings - 1; i++) faces.push(`f ${at(i, j)} ${at(i + 1, j)} ${at(i + 1, j + 1)}`, `f ${at(i, j)} ${at(i + 1, j + 1)} ${at(i, j + 1)}`);
  }
  return `${[...vertices, ...faces].join("\n")}\n`;
}

const solid = (count) => `<mujoco><asset>${Array.from({ length: count }, (_, i) => `<mesh name="m${i}" file="m${i}.obj"/>`).join("")}</asset><worldbody>
  <geom type="plane" size="2 2 .1"/>${Array.from({ length: count }, (_, i) => `<body pos="${i} 0 .3"><freejoint/><geom type="mesh" mesh="m${i}"/></body>`).join("")}</worldbody></mujoco>`;
const scenes = Object.fromEntries(NAMES.map((name) => [name, { xml: readFileSync(join(repository, `specs/models/${name}.xml`), "utf8"), files: {} }]));
scenes["a mesh, 1,000 triangles"] = { xml: solid(1), files: { "m0.obj": wavySphere(18, 30) } };
scenes["a mesh, 20,000 triangles"] = { xml: solid(1), files: { "m0.obj": wavySphere(84, 120) } };
scenes["8 meshes, 4,000 triangles each"] = { xml: solid(8), files: Object.fromEntries(Array.from({ length: 8 }, (_, i) => [`m${i}.obj`, wavySphere(41 + i, 50)])) };

const base64 = (bytes) => Buffer.from(bytes).toString("base64");
const page = (make) => `<!doctype html><link rel="icon" href="data:,"><script type="module">
const { Data, Model } = await import("/web/labspec/dist/browser.js");
const { xml, files, bytes } = await (await fetch("SCENE")).json();
const compiled = Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0));
const begun = performance.now();
const model = ${make};
const made = performance.now() - begun;
const data = new Data(model);
data.forward();
globalThis.took = [made, performance.now() - begun];
</script>`;
const MAKES = { mjcf: "Model.fromXML(xml, files)", bytes: "Model.fromBytes(compiled)" };
const pages = {};
for (const [i, scene] of Object.values(scenes).entries()) {
  const bytes = Model.fromXML(scene.xml, scene.files).toBytes();
  const sizes = (parts) => [parts.reduce((sum, part) => sum + part.length, 0), parts.reduce((sum, part) => sum + gzipSync(part).length, 0)];
  Object.assign(scene, { sizes: [sizes([scene.xml, ...Object.values(scene.files)]), sizes([Buffer.from(bytes)])], times: { mjcf: [], bytes: [] } });
  pages[`/scene${i}.json`] = JSON.stringify({ xml: scene.xml, files: scene.files, bytes: base64(bytes) });
  for (const [form, make] of Object.entries(MAKES)) pages[`/${form}${i}.html`] = page(make).replace("SCENE", `/scene${i}.json`);
}
const server = await serve(pages);
const browser = await launch();
for (let run = 0; run <= PAGES; run++) {
  for (const [i, { times }] of Object.values(scenes).entries()) {
    for (const form of Object.keys(MAKES)) {
      const context = await browser.newContext();
      const opened = await context.newPage();
      await opened.goto(`${server.url}/${form}${i}.html`);
      await opened.waitForFunction(() => globalThis.took !== undefined);
      const took = await opened.evaluate(() => globalThis.took);
      // The first run warms up the browser.
      if (run > 0) times[form].push(took);
      await context.close();
    }
  }
}
const middle = (rows, column) => rows.map((row) => row[column]).sort((a, b) => a - b)[PAGES >> 1];
const kilo = ([whole, packed]) => `${(whole / 1000).toFixed(1)} kB (${(packed / 1000).toFixed(1)} gzip)`;
for (const [name, { sizes, times }] of Object.entries(scenes)) {
  const line = Object.keys(MAKES).map((form) => `${form}: model ${middle(times[form], 0).toFixed(1)} ms, state ${middle(times[form], 1).toFixed(1)} ms`);
  console.log(`${name}: ${line.join("; ")}; MJCF ${kilo(sizes[0])}, bytes ${kilo(sizes[1])}`);
}
await browser.close();
server.close();
