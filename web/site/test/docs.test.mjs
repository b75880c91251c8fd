// The documentation and the example course as one site, as `xtask site` builds it: every link leads somewhere, nothing is said on the
// console, the search covers both. A model with a picture shows it.
import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import test, { after } from "node:test";
import { png } from "../../elements/test/page/png.mjs";
import { folder, isChromium, labspec, launch, open, opened, repository, serve } from "./pages.mjs";

const SOURCES = "https://github.com/labspec/labspec/blob/main/";
const suite = { after };
const browser = await launch();
after(() => browser.close());
const out = join(folder(suite), "site");
const at = (name) => join(repository, name);
const paths = ["docs", "specs/lessons", "web/labspec/README.md", "web/elements/README.md", "CHANGELOG.md"].map(at);
const built = labspec("build", ...paths, "--index", at("docs/README.md"), "--title", "labspec", "--sources", SOURCES, "--out", out);
assert.equal(built.status, 0, built.stdout + built.stderr);
const site = (await serve(suite, out)).url;

/** What leads from a page to other places of the site, and what is wrong in it. */
const contents = (page) => page.evaluate(() => {
  const links = [...document.querySelectorAll("a[href]")].map((link) => link.href);
  const dead = [...document.querySelectorAll(".dead-link, .image-missing, .image-elsewhere")].map((part) => part.textContent);
  const empty = [...document.images].filter((image) => image.complete && image.naturalWidth === 0).map((image) => image.src);
  return { links, ids: [...document.querySelectorAll("[id]")].map((element) => element.id), dead: [...dead, ...empty] };
});

const reached = isChromium ? "every page is" : "ten pages of each folder are";

test(`from the first page, ${reached} reached; no link is dead, and the console is silent`, async (t) => {
  const first = await open(t, browser, site);
  assert.equal(await first.page.locator("h1").textContent(), "Documentation");
  const waiting = [`${site}index.html`];
  const [seen, wanted, files, others] = [new Map(), [], new Set(), new Map()];
  const [folders, found] = [new Map(), new Set(waiting)];
  /** Whether a page is opened. In Firefox, which has the links and texts that Chromium has, ten pages of each folder are. */
  const isOpened = (address) => {
    const folder = new URL(".", address).href;
    folders.set(folder, (folders.get(folder) ?? 0) + 1);
    return isChromium || folders.get(folder) <= 10;
  };
  /** Reads a page, and adds those to which it leads. */
  async function visit(page, address) {
    const response = await page.goto(address);
    assert.equal(response.status(), 200, address);
    // Firefox reports a request that the service worker is answering when the page is left.
    if (!isChromium && (await page.locator("sim-lab").count()) > 0) await page.waitForLoadState("networkidle");
    const { links, ids, dead } = await contents(page);
    assert.deepEqual(dead, [], address);
    seen.set(address, new Set(ids));
    for (const link of links) {
      const { href, hash } = new URL(link);
      const target = hash === "" ? href : href.slice(0, -hash.length);
      if (!target.startsWith(site)) {
        assert.match(target, /^(https?|mailto):/, `${address}: ${target}`);
        if (target.startsWith(SOURCES)) files.add(target);
      } else if (!target.endsWith(".html")) {
        others.set(target, address);
      } else {
        wanted.push([address, target, decodeURIComponent(hash.slice(1))]);
        if (!found.has(target)) {
          found.add(target);
          if (isOpened(target)) waiting.push(target);
        }
      }
    }
  }
  // Most of the time of a page is waiting: several are open at once.
  const pages = [first, ...await Promise.all(Array.from({ length: 3 }, () => open(t, browser, `${site}index.html`)))];
  for (let next = 0; next < waiting.length; next += pages.length) {
    const addresses = waiting.slice(next, next + pages.length);
    await Promise.all(addresses.map((address, i) => visit(pages[i].page, address)));
  }
  for (const [target, from] of others) assert.equal((await first.page.request.get(target)).status(), 200, `${from}: ${target}`);
  const read = wanted.filter(([, target]) => isChromium || seen.has(target));
  for (const [from, target, id] of read) assert.ok(id === "" || seen.get(target)?.has(id), `${from} links to ${target}#${id}`);
  assert.ok(seen.size > (isChromium ? 300 : 40) && [...seen.keys()].some((address) => address.endsWith("specs/lessons/10-the-book-that-turns-over.html")), String(seen.size));
  t.diagnostic(`${seen.size} pages, ${wanted.length} links between them, ${files.size} to the sources`);
  for (const { none } of pages) none();
});

test("the search covers the documentation and the lessons", async (t) => {
  const { page, none } = await open(t, browser, `${site}docs/measured/speed.html`);
  for (const [words, title, address] of [["pendul alik", "Two pendulums that begin alike", /specs\/lessons\/06-[^#]*#/], ["baseline findings", /baseline/i, /docs\/[^#]*\.html/]]) {
    await page.getByRole("searchbox", { name: "Search" }).fill(words);
    const first = page.locator(".results a").first();
    await first.getByText(title).first().waitFor();
    await first.click();
    await page.waitForURL(address);
  }
  none();
});

test("a texture of a file is on the page", async (t) => {
  const lessons = join(folder(t), "lessons");
  mkdirSync(join(lessons, "models/pictures"), { recursive: true });
  writeFileSync(join(lessons, "models/tiles.xml"), `<mujoco><compiler texturedir="pictures"/><asset><texture name="tiles" type="2d" file="tiles.png"/>
    <material name="tiles" texture="tiles" specular="0"/></asset><worldbody><geom type="plane" size="2 2 .1" material="tiles"/></worldbody></mujoco>`);
  writeFileSync(join(lessons, "models/pictures/tiles.png"), png(Array.from({ length: 32 }, (_, y) => Array.from({ length: 32 }, (_, x) => ((x < 16) === (y < 16) ? [255, 0, 0] : [0, 255, 0])))));
  writeFileSync(join(lessons, "a.md"), "# Tiles\n\n```lab simlab\n{\"model\": \"tiles\"}\n```\n");
  const made = labspec("build", lessons, "--out", join(lessons, "../site"));
  assert.equal(made.status, 0, made.stdout + made.stderr);
  const { page, none } = await open(t, browser, `${(await serve(t, join(lessons, "../site"))).url}a.html`);
  await opened(page, "#lab-1");
  await page.waitForFunction(() => {
    const canvas = document.querySelector("sim-lab").shadowRoot.querySelector(".view canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let [red, green] = [0, 0];
    for (let i = 0; i < data.length; i += 4) {
      if (data[i] > 60 && data[i + 1] < data[i] / 3) red++;
      if (data[i + 1] > 60 && data[i] < data[i + 1] / 3) green++;
    }
    return red > 500 && green > 500;
  });
  none();
});
