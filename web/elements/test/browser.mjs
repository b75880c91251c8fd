// The browser that the tests of pages drive: Chromium, or Firefox with `LABSPEC_BROWSER=firefox`, both as Debian has them.
//
// Playwright drives Firefox by WebDriver BiDi. The version of Playwright is the last one whose commands Firefox ESR knows. What BiDi cannot
// change in a running browser (colours, motion, WebGL) is a preference of a Firefox of its own. Headless Firefox has no WebGL: with
// `xvfb-run`, it has a window, and draws as on a screen.
import { existsSync, readFileSync } from "node:fs";
import { chromium, firefox } from "playwright-core";

/** The name of the browser, as people write it. */
export const browserName = { chromium: "Chromium", firefox: "Firefox" }[process.env.LABSPEC_BROWSER ?? "chromium"];
if (browserName === undefined) throw new Error(`LABSPEC_BROWSER is "chromium" or "firefox", not "${process.env.LABSPEC_BROWSER}"`);
export const isChromium = browserName === "Chromium";

/** An option of a test: it is skipped, with the reason, in other browsers than Chromium. */
export const chromiumOnly = (reason) => ({ skip: isChromium ? false : reason });

const find = (paths) => paths.find(existsSync);
const PREFERENCES = {
  // A page of a test is drawn without a graphics card.
  "webgl.force-enabled": true,
  // Permissions are not asked for.
  "dom.events.testing.asyncClipboard": true,
};
const MEDIA = {
  colorScheme: { dark: { "layout.css.prefers-color-scheme.content-override": 0 } },
  reducedMotion: { reduce: { "ui.prefersReducedMotion": 1 } },
  forcedColors: { active: { "ui.useAccessibilityTheme": 1, "browser.display.document_color_use": 2 } },
};

/** Starts the browser. `args` are of Chromium, `preferences` of Firefox. */
export function launch({ args = ["--enable-unsafe-swiftshader"], preferences = {} } = {}) {
  if (isChromium) {
    const executablePath = process.env.CHROMIUM ?? find(["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"]);
    return chromium.launch({ executablePath, args: ["--no-sandbox", ...args] });
  }
  const executablePath = process.env.FIREFOX ?? find(["/usr/bin/firefox-esr", "/usr/bin/firefox"]);
  const firefoxUserPrefs = { "layout.css.prefers-color-scheme.content-override": 1, ...PREFERENCES, ...preferences };
  return firefox.launch({ channel: "moz-firefox", executablePath, headless: process.env.DISPLAY === undefined, firefoxUserPrefs });
}

/** A browser without WebGL. */
export const launchWithoutWebGl = () =>
  launch({ args: ["--disable-gpu", "--disable-software-rasterizer", "--disable-3d-apis"], preferences: { "webgl.disabled": true, "webgl.force-enabled": false } });

/** A new context with the options of Playwright; what Firefox does not change in a running browser is a browser of its own. */
export async function newContext(browser, options = {}) {
  if (isChromium) return browser.newContext(options);
  const { colorScheme, reducedMotion, forcedColors, isMobile, permissions, ...rest } = options;
  const preferences = Object.assign({}, MEDIA.colorScheme[colorScheme], MEDIA.reducedMotion[reducedMotion], MEDIA.forcedColors[forcedColors]);
  if (Object.keys(preferences).length === 0) return browser.newContext(rest);
  const own = await launch({ preferences });
  const context = await own.newContext(rest);
  context.on("close", () => own.close());
  return context;
}

/** Name and bytes of the file that a page saves when `press` is called. Playwright does not report downloads of Firefox: the link is read there. */
export async function saveFile(page, press) {
  if (isChromium) {
    const [download] = await Promise.all([page.waitForEvent("download"), press()]);
    return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
  }
  await page.evaluate(() => {
    globalThis.savedFile = new Promise((resolve) => {
      // A strict policy lets no page fetch what it offers.
      const [blobs, { createObjectURL }] = [new Map(), URL];
      URL.createObjectURL = (blob) => {
        const address = createObjectURL(blob);
        blobs.set(address, blob);
        return address;
      };
      const take = (link) => {
        if (!(link instanceof HTMLAnchorElement) || link.download === "") return;
        const blob = blobs.get(link.href) ?? fetch(link.href);
        Promise.resolve(blob).then((blob) => blob.arrayBuffer()).then((bytes) => resolve({ name: link.download, bytes: [...new Uint8Array(bytes)] }));
      };
      addEventListener("click", (event) => take(event.target), { capture: true });
      // A link that is not in the page sends its click to nobody else.
      const { click } = HTMLAnchorElement.prototype;
      HTMLAnchorElement.prototype.click = function () {
        if (!this.isConnected) take(this);
        click.call(this);
      };
    });
  });
  await press();
  const { name, bytes } = await page.evaluate(() => globalThis.savedFile);
  return { name, bytes: Buffer.from(bytes) };
}

/** Collects the errors of a page: nothing may be reported on its console. */
export function collectErrors(page) {
  const errors = [];
  page.on("pageerror", (e) => errors.push(e.message));
  page.on("console", (message) => {
    const isDriver = /GL Driver Message|WEBGL_debug_renderer_info is deprecated/.test(message.text());
    if (!isDriver && ["error", "warning"].includes(message.type())) errors.push(message.text());
  });
  return errors;
}
