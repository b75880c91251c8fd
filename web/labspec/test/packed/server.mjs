// What the tests of the tarball share: an installed copy, a server, Chromium.
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { dirname, extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";

export const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
export const web = join(root, "..");

/** Packs the package and installs it into a new folder. */
export function installed() {
  const folder = mkdtempSync(join(tmpdir(), "labspec-packed-"));
  process.on("exit", () => rmSync(folder, { recursive: true, force: true }));
  execFileSync("npm", ["pack", "--silent", "--pack-destination", folder], { cwd: root });
  const tarball = join(folder, readdirSync(folder).find((f) => f.endsWith(".tgz")));
  writeFileSync(join(folder, "package.json"), JSON.stringify({ private: true, type: "module" }));
  execFileSync("npm", ["install", "--silent", "--no-audit", "--no-fund", "--offline", tarball], { cwd: folder });
  return { folder, tarball };
}

/** A page tells its server: what evaluates text in a page would need another policy than the page has. */
export const REPORT = `if (globalThis.document !== undefined) fetch("/result?" + new URLSearchParams({ result: globalThis.result, origin: globalThis.origin, isolated: globalThis.crossOriginIsolated }));`;

/** A program that plays a lab and gives what it shows. */
export const program = (from = "labspec") => `
import { Lab } from ${JSON.stringify(from)};
const drop = "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body name='bob' pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>";
const lab = new Lab({ model: "drop", readouts: [{ label: "height (m)", expr: "data.body('bob').xpos[2]" }] }, { drop });
lab.playTo(0.2);
export const result = "height " + lab.numbers[0];
globalThis.result = result;
console.log(result);
${REPORT}
`;
export const expected = "height 0.8057620000000003";

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".wasm": "application/wasm", ".json": "application/json", ".xml": "text/xml" };

/** Serves a folder; `headers` are added to all answers. `answers` are functions of request and response, by path. */
export async function serve(folder, headers = {}, answers = {}) {
  const requests = [];
  let report;
  const result = new Promise((resolve) => { report = resolve; });
  const server = createServer((request, response) => {
    const { pathname, searchParams } = new URL(request.url, "http://x");
    const path = normalize(decodeURIComponent(pathname));
    if (path === "/result") {
      response.writeHead(204, headers).end();
      return report(Object.fromEntries(searchParams));
    }
    if (Object.hasOwn(answers, path)) return answers[path](request, response);
    requests.push(path);
    const file = join(folder, path);
    if (!existsSync(file) || path.endsWith("/")) {
      response.writeHead(404, headers).end();
      return;
    }
    response.writeHead(200, { "content-type": TYPES[extname(file)] ?? "application/octet-stream", ...headers }).end(readFileSync(file));
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  server.unref();
  return { url: `http://127.0.0.1:${server.address().port}`, requests, result, close: () => server.close() };
}

/** Chromium, as Debian has it. */
export async function chromium() {
  const { chromium } = await import("playwright-core");
  const executablePath = process.env.CHROMIUM ?? ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
  return chromium.launch({ executablePath, args: ["--no-sandbox", "--js-flags=--expose-gc"] });
}

/** What a page of a server made of the program. */
export async function resultOf(page, server, path) {
  const problems = [];
  page.on("pageerror", (e) => problems.push(e.message));
  page.on("console", (m) => m.type() === "error" && problems.push(m.text()));
  await page.goto(`${server.url}/${path}`);
  const late = new Promise((_, reject) => setTimeout(() => reject(new Error(`no result: ${problems.join("; ")}`)), 20_000).unref());
  return { ...(await Promise.race([server.result, late])), problems };
}

export function write(folder, files) {
  for (const [name, text] of Object.entries(files)) {
    mkdirSync(dirname(join(folder, name)), { recursive: true });
    writeFileSync(join(folder, name), text);
  }
}
