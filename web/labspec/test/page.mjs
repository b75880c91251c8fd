// A page with the package in a browser: what tests and measurements in pages share.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium, root, serve } from "./packed/server.mjs";

/** A page that has run a script as a module; `/dist` is the built package, and `links` are other folders by name. */
export async function chromiumPage(script, { links = {}, headers = {} } = {}) {
  const site = siteOf(`${script}\nglobalThis.isReady = true;`, links);
  const server = await serve(site, headers);
  const browser = await chromium();
  const page = await browser.newPage();
  const close = async () => {
    await browser.close();
    server.close();
    rmSync(site, { recursive: true, force: true });
  };
  await page.goto(`${server.url}/index.html`);
  await page.waitForFunction("globalThis.isReady !== undefined");
  return { page, browser, server, evaluate: (f, argument) => page.evaluate(f, argument), close };
}

/** Gives a page of Chromium `heapSize()`: bytes of objects of JavaScript after the garbage is collected. */
export async function exposeHeap(page) {
  const protocol = await page.context().newCDPSession(page);
  await page.exposeFunction("heapSize", async () => {
    await protocol.send("HeapProfiler.collectGarbage");
    return (await protocol.send("Runtime.getHeapUsage")).usedSize;
  });
}

/** Where Firefox is; `undefined` where it is not installed. */
export function firefoxPath() {
  return process.env.FIREFOX ?? ["/usr/bin/firefox-esr", "/usr/bin/firefox"].find(existsSync);
}

/** Milliseconds that a page may take to answer. */
const LONGEST = 120_000;

/** What a page of `firefoxPage` does: it asks its server what to run. */
const ASK = `for (;;) {
  const { f, argument } = await (await fetch("/ask")).json();
  let answer;
  try { answer = { result: await (0, eval)("(" + f + ")")(argument) }; } catch (e) { answer = { error: String(e) }; }
  await fetch("/answer", { method: "POST", body: JSON.stringify(answer) });
}`;

/** Starts Firefox with a new profile and no window. */
export function startFirefox(url) {
  const profile = mkdtempSync(join(tmpdir(), "labspec-firefox-"));
  const program = spawn(firefoxPath(), ["--headless", "--no-remote", "--profile", profile, url], { stdio: "ignore" });
  const ended = new Promise((resolve) => program.on("exit", resolve));
  process.on("exit", () => program.kill());
  return async () => {
    program.kill();
    await ended;
    rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
  };
}

/** The same page in Firefox, which needs no driver for it. */
export async function firefoxPage(script, { links = {}, headers = {} } = {}) {
  const site = siteOf(`${script}\n${ASK}`, links);
  let [asked, answered] = [undefined, undefined];
  const waiting = [];
  const send = () => {
    if (asked === undefined || waiting.length === 0) return;
    const { question, resolve } = waiting.shift();
    asked.writeHead(200, { "content-type": "application/json" }).end(JSON.stringify(question));
    [asked, answered] = [undefined, resolve];
  };
  const server = await serve(site, headers, {
    "/ask": (_, response) => {
      asked = response;
      send();
    },
    "/answer": (request, response) => {
      let text = "";
      request.on("data", (part) => { text += part; });
      request.on("end", () => {
        response.writeHead(204).end();
        answered(JSON.parse(text));
      });
    },
  });
  const stop = startFirefox(`${server.url}/index.html`);
  const evaluate = async (f, argument) => {
    const answer = await new Promise((resolve, reject) => {
      setTimeout(() => reject(new Error("Firefox does not answer")), LONGEST).unref();
      waiting.push({ question: { f: String(f), argument }, resolve });
      send();
    });
    if (answer.error !== undefined) throw new Error(answer.error);
    return answer.result;
  };
  const close = async () => {
    await stop();
    server.close();
    rmSync(site, { recursive: true, force: true });
  };
  return { evaluate, server, close };
}

function siteOf(script, links) {
  const site = mkdtempSync(join(tmpdir(), "labspec-page-"));
  for (const [name, folder] of Object.entries({ dist: join(root, "dist"), ...links })) symlinkSync(folder, join(site, name));
  writeFileSync(join(site, "index.html"), `<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,"><script type="module">
${script}
</script>`);
  return site;
}
