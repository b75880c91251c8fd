// WebKit as Debian has it: MiniBrowser of WebKitGTK, driven by the commands of WebDriver. `xvfb-run` and `dbus-run-session` give it a screen and a bus.
import { spawn } from "node:child_process";
import { existsSync, readdirSync } from "node:fs";
import { createServer } from "node:net";

const LIBRARIES = "/usr/lib";
/** Milliseconds until the driver answers, at most. */
const START = 20_000;

/** MiniBrowser; `undefined` where WebKitGTK or its driver is not installed. */
export function webkitPath() {
  if (process.env.WEBKIT !== undefined) return process.env.WEBKIT;
  if (!existsSync("/usr/bin/WebKitWebDriver")) return undefined;
  const folders = readdirSync(LIBRARIES).filter((name) => name.endsWith("linux-gnu"));
  return folders.flatMap((name) => ["4.1", "6.0"].map((version) => `${LIBRARIES}/${name}/webkit${version === "6.0" ? "gtk" : "2gtk"}-${version}/MiniBrowser`)).find(existsSync);
}

const freePort = () => new Promise((resolve) => {
  const server = createServer().listen(0, "127.0.0.1", () => {
    const { port } = server.address();
    server.close(() => resolve(port));
  });
});

/** Sends one command of WebDriver; throws its error. */
async function send(base, method, path, body) {
  const response = await fetch(base + path, { method, body: body === undefined ? undefined : JSON.stringify(body) });
  const { value } = await response.json();
  if (value?.error !== undefined) throw new Error(`${value.error}: ${value.message}`);
  return value;
}

/** Starts WebKit with one page. */
export async function launchWebKit() {
  const port = await freePort();
  // Containers have no user namespaces, which the sandbox of WebKit needs.
  const env = { ...process.env, WEBKIT_DISABLE_SANDBOX_THIS_IS_DANGEROUS: "1", LIBGL_ALWAYS_SOFTWARE: "1" };
  const driver = spawn("WebKitWebDriver", [`--port=${port}`], { stdio: "ignore", env });
  const base = `http://127.0.0.1:${port}`;
  const end = Date.now() + START;
  while (!(await fetch(`${base}/status`).then(() => true, () => false))) {
    if (Date.now() > end) throw new Error("WebKitWebDriver does not start");
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  const options = { binary: webkitPath(), args: ["--automation"] };
  const { sessionId, capabilities } = await send(base, "POST", "/session", { capabilities: { alwaysMatch: { "webkitgtk:browserOptions": options } } });
  const session = `${base}/session/${sessionId}`;
  return {
    version: capabilities.browserVersion,
    ...pageOf((method, path, body) => send(session, method, path, body)),
    async close() {
      await send(session, "DELETE", "").catch(() => undefined);
      driver.kill();
    },
  };
}

const ELEMENT = "element-6066-11e4-a52e-4f735466cecf";

/** What tests do with a page. Functions run in the page, and may be asynchronous. */
function pageOf(ask) {
  const evaluate = async (f, ...args) => {
    const script = `const done = arguments[arguments.length - 1];
      Promise.resolve().then(() => (${f})(...Array.prototype.slice.call(arguments, 0, -1))).then((result) => done({ result }), (e) => done({ error: String(e) }));`;
    const { result, error } = await ask("POST", "/execute/async", { script, args });
    if (error !== undefined) throw new Error(error);
    return result;
  };
  const find = (f, ...args) => ask("POST", "/execute/sync", { script: `return (${f})(...arguments);`, args });
  const keys = async (text) => {
    const actions = [...text].flatMap((value) => [{ type: "keyDown", value }, { type: "keyUp", value }]);
    await ask("POST", "/actions", { actions: [{ type: "key", id: "keyboard", actions }] });
  };
  return {
    evaluate,
    keys,
    goto: (url) => ask("POST", "/url", { url }),
    reload: () => ask("POST", "/refresh", {}),
    /** Clicks the element that a function of the page finds. */
    async click(f, ...args) {
      const element = await find(f, ...args);
      if (element === null) throw new Error(`no element: ${f}`);
      await ask("POST", `/element/${element[ELEMENT]}/click`, {});
    },
    async waitFor(f, ...args) {
      const limit = Date.now() + 30_000;
      while (!(await evaluate(f, ...args))) {
        if (Date.now() > limit) throw new Error(`after 30 s: ${f}`);
        await new Promise((resolve) => setTimeout(resolve, 50));
      }
    },
  };
}
