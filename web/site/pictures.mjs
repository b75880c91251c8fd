// Pictures of every lesson of a site in light, in dark, on a phone, in forced colours and on paper.
//
//   node pictures.mjs SITE [--full DIR] [--out ../../docs/pictures] [--only light,print]
//
// SITE is a folder that `labspec build` wrote. DIR receives each page in full; `--out` receives one sheet with small pictures of all lessons
// for each of the five.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { parseArgs } from "node:util";
import { launch, serve } from "./test/pages.mjs";

const MODES = {
  light: { viewport: { width: 900, height: 800 }, colorScheme: "light" },
  dark: { viewport: { width: 900, height: 800 }, colorScheme: "dark" },
  phone: { viewport: { width: 320, height: 640 }, colorScheme: "light", hasTouch: true, isMobile: true, deviceScaleFactor: 2 },
  contrast: { viewport: { width: 900, height: 800 }, colorScheme: "dark", forcedColors: "active" },
  // A sheet of A4 without its margins, at 96 pixels per inch.
  print: { viewport: { width: 680, height: 1000 }, colorScheme: "light" },
};
/** The time to which each lab is played, s, and what a page may be high, pixels. */
const PLAYED = 0.8, MOST_HIGH = 16_000;
/** Pixels of a small picture: its width, and what is shown of its height. */
const SMALL = 200, SMALL_HIGH = 1200;

const { values: given, positionals: [site] } = parseArgs({ allowPositionals: true, options: { full: { type: "string" }, out: { type: "string" }, only: { type: "string", default: Object.keys(MODES).join() } } });
if (site === undefined) throw new Error("SITE is missing: node pictures.mjs SITE [--full DIR] [--out DIR]");

/** Opens and plays all labs of a page, in a window that is as high as the page: labs outside a window are not drawn. */
async function settle(page, mode) {
  await page.evaluate(async (until) => {
    const labs = [...document.querySelectorAll("sim-lab")];
    if (labs.length > 0) await customElements.whenDefined("sim-lab");
    for (const lab of labs) {
      await lab.ready;
      for (let i = 0; i < 2000 && lab.time < until && !lab.isOver; i++) await lab.step(10);
    }
    await document.fonts.ready;
  }, PLAYED);
  if (mode === "print") await page.emulateMedia({ media: "print", colorScheme: "light" });
  const { width } = page.viewportSize();
  // Labs and plots follow the window with a delay, and the page with them.
  for (let i = 0; i < 2; i++) {
    const height = await page.evaluate(() => document.documentElement.scrollHeight);
    await page.setViewportSize({ width, height: Math.min(height, MOST_HIGH) });
    await page.waitForTimeout(500);
  }
}

/** One sheet with small pictures side by side. */
async function writeSheet(browser, mode, pictures) {
  const page = await browser.newPage({ viewport: { width: pictures.length * (SMALL + 12) + 12, height: 400 } });
  const figures = pictures.map(({ name, png }) => `<figure><figcaption>${name}</figcaption><div><img src="data:image/png;base64,${png.toString("base64")}"></div></figure>`);
  await page.setContent(`<style>body{margin:0;padding:12px;display:flex;gap:12px;background:#8a8f99;font:12px sans-serif}figure{margin:0;width:${SMALL}px}
    figcaption{color:#fff;white-space:nowrap;overflow:hidden;text-overflow:ellipsis;margin-bottom:4px}div{max-height:${SMALL_HIGH}px;overflow:hidden}img{width:100%;display:block}</style>${figures.join("")}`);
  await page.waitForFunction(() => [...document.images].every((image) => image.complete));
  const file = join(given.out, `lessons-${mode}.jpg`);
  mkdirSync(given.out, { recursive: true });
  writeFileSync(file, await page.screenshot({ fullPage: true, type: "jpeg", quality: 45 }));
  await page.close();
  console.log(file);
}

const closing = [];
const { url } = await serve({ after: (close) => closing.push(close) }, site);
const browser = await launch();
const names = [...readFileSync(join(site, "index.html"), "utf8").matchAll(/<li><h2><a href="([^"]+)"/g)].map((found) => found[1]);
try {
  for (const [mode, options] of Object.entries(MODES).filter(([name]) => given.only.split(",").includes(name))) {
    const pictures = [];
    for (const name of names) {
      const context = await browser.newContext(options), page = await context.newPage();
      page.on("pageerror", (e) => console.error(`${mode} ${name}: ${e.message}`));
      await page.goto(url + name);
      await settle(page, mode);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      if (wide > 0) console.error(`${mode} ${name}: the page is ${wide} pixels wider than its window`);
      const png = await page.screenshot();
      const stem = decodeURIComponent(name).replace(/\.html$/, "").replaceAll("/", "-");
      if (given.full !== undefined) {
        mkdirSync(given.full, { recursive: true });
        writeFileSync(join(given.full, `${stem}-${mode}.png`), png);
      }
      pictures.push({ name: stem, png });
      await context.close();
    }
    if (given.out !== undefined) await writeSheet(browser, mode, pictures);
  }
} finally {
  await browser.close();
  closing.forEach((close) => close());
}
