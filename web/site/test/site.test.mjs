// A site that `labspec build` wrote, in Chromium: the example course, its search, offline, on paper, without scripts, on a phone.
import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import test, { after } from "node:test";
import { chromiumOnly, course, findings, folder, labspec, launch, open, opened, repository, serve } from "./pages.mjs";

const HOSTILE = `# Odd <script>window.broken = 1</script>

<img src=x onerror="window.broken = 1"> [a link](javascript:window.broken=1) <a href="java&#10;script:window.broken=1">b</a>
<svg onload="window.broken = 1"></svg> </main></body> $\\vec{F} = \\href{javascript:window.broken=1}{x}$ $\\boxed{\\sqrt{x}}$ and $\\nonsense$

<details><summary>More</summary>

Inside, **bold** and $x^2$.

</details>

\`\`\`lab simlab
{"title": "</script><script>window.broken = 1</script>", "xml": "<mujoco><worldbody><body><joint name='j'/><geom size='1'/></body></worldbody></mujoco>",
 "note": "<img src=x onerror='window.broken = 1'>", "readouts": [{"label": "<b>q", "expr": "data.qpos[0]"}]}
\`\`\`

\`\`\`quiz
{"id": "\\"><script>window.broken = 1</script>", "questions": [{"q": "<script>window.broken = 1</script>", "options": ["<svg/onload=window.broken=1>", "b"], "answer": 0}]}
\`\`\`

\`\`\`lab simlab
{"title": broken
`;

const suite = { after };
const browser = await launch();
after(() => browser.close());
const out = join(folder(suite), "site");
const built = labspec("build", join(repository, "specs/lessons"), "--out", out, "--base-url", "https://example.org/course");
assert.equal(built.status, 0, built.stdout + built.stderr);
const site = (await serve(suite, out)).url;
// A lesson that writes what it likes.
const lessons = join(folder(suite), "lessons");
mkdirSync(join(lessons, "part two"), { recursive: true });
writeFileSync(join(lessons, "part two/odd.md"), HOSTILE);
labspec("build", lessons, "--out", join(lessons, "../odd"));
const own = (await serve(suite, join(lessons, "../odd"))).url;

test("every lesson opens without a word on the console, and its labs run", async (t) => {
  const { page, none } = await open(t, browser, site);
  const names = await page.locator(".lessons h2 a").evaluateAll((links) => links.map((link) => link.href));
  assert.equal(names.length, 10);
  let labs = 0;
  for (const name of names) {
    await page.goto(name);
    await page.evaluate(() => customElements.whenDefined("sim-lab"));
    for (const id of await page.locator("sim-lab").evaluateAll((all) => all.map((lab) => lab.id))) {
      await opened(page, `#${id}`);
      const time = await page.evaluate(async (s) => {
        const lab = document.getElementById(s);
        await lab.step(5);
        return lab.time;
      }, id);
      assert.ok(time > 0, `${name} ${id}`);
      labs += 1;
    }
    assert.equal(await page.locator(".math:not([data-tex])").count(), 0);
    const scripts = await page.locator("msub, msup").evaluateAll((all) => all.filter((script) => script.childElementCount !== 2).map((script) => script.textContent));
    assert.deepEqual(scripts, [], name);
  }
  assert.equal(labs, 19);
  none();
});

for (const [name, path, options] of [
  ["light", "02-bounce-and-swing.html", {}], ["dark", "01-what-a-step-computes.html", { colorScheme: "dark" }],
  ["a phone", "04-friction-on-a-slope.html", { viewport: { width: 320, height: 640 }, hasTouch: true }], ["the index", "index.html", {}], ["the labs", "labs.html", {}],
]) {
  test(`axe finds nothing serious: ${name}`, async (t) => {
    const { page, none } = await open(t, browser, site + path, options);
    if (path.startsWith("0")) await opened(page, "#lab-1");
    assert.deepEqual(await findings(page), []);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page does not scroll sideways");
    none();
  });
}

test("the search finds a heading by the beginnings of its words, and by keyboard alone", async (t) => {
  const { page, none } = await open(t, browser, `${site}01-what-a-step-computes.html`);
  await page.getByRole("searchbox", { name: "Search" }).fill("pendul alik");
  await page.locator(".results a").first().waitFor();
  assert.equal(await page.locator(".results a").first().textContent(), "Two pendulums that begin alike");
  await page.keyboard.press("Enter");
  await page.waitForURL(/06-energy-and-chaos\.html#/);
  await page.getByRole("searchbox", { name: "Search" }).fill("zebra");
  await page.getByText("Nothing found.").waitFor();
  none();
});

test("links between lessons, the skip link, the pages before and after", async (t) => {
  const { page, none } = await open(t, browser, `${site}02-bounce-and-swing.html`);
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Skip to the text");
  await page.keyboard.press("Enter");
  assert.equal(await page.evaluate(() => document.activeElement.id), "main");
  await page.locator(".pager a[rel=next]").click();
  await page.waitForURL(/03-how-soft/);
  assert.equal(await page.locator("link[rel=canonical]").getAttribute("href"), "https://example.org/course/03-how-soft-is-a-floor.html");
  none();
});

test("without scripts, a lab is its twin, and a quiz its questions", chromiumOnly("Playwright cannot switch off scripts in Firefox"), async (t) => {
  const { page } = await open(t, browser, `${site}02-bounce-and-swing.html`, { javaScriptEnabled: false });
  const twin = page.locator("#lab-1").locator("xpath=..").locator("xpath=following-sibling::div[1]");
  assert.ok(await twin.isVisible());
  assert.match(await twin.textContent(), /Rebound[\s\S]*after 2\.000 s[\s\S]*height \(m\)/);
  assert.ok(await twin.locator("svg").isVisible());
  assert.ok(await page.locator(".questions").first().isVisible());
  assert.ok(await page.locator(".verified").first().isVisible());
});

test("on paper, the twin replaces the lab", chromiumOnly("WebDriver BiDi cannot emulate print"), async (t) => {
  const { page } = await open(t, browser, `${site}02-bounce-and-swing.html`);
  await opened(page, "#lab-1");
  const twin = page.locator(".twin").first();
  assert.equal(await twin.isVisible(), false);
  await page.emulateMedia({ media: "print" });
  assert.ok(await twin.isVisible());
  assert.equal(await page.locator("#lab-1").isVisible(), false);
  assert.ok((await page.pdf({ format: "A4" })).length > 20_000);
});

test("a visited site can be read offline", async (t) => {
  const out = join(folder(t), "site");
  labspec("build", course(t), "--out", out);
  const served = await serve(t, out);
  const { page, context } = await open(t, browser, served.url);
  await page.evaluate(() => navigator.serviceWorker.ready);
  await page.reload();
  served.close();
  await page.goto(`${served.url}05-a-servo-and-its-timestep.html`);
  await opened(page, "#lab-1");
  assert.equal(await page.locator("h1").textContent(), "A servo and its timestep");
  assert.equal(context.pages().length, 1);
});

test("what a hostile lesson writes runs nothing and breaks nothing", async (t) => {
  const { page, errors } = await open(t, browser, `${own}part%20two/odd.html`);
  await opened(page, "#lab-1");
  await page.waitForTimeout(300);
  assert.equal(await page.evaluate(() => globalThis.broken), undefined);
  // The elements parse the HTML of a note before they copy what is harmless, and the policy reports what it would have stopped there.
  assert.deepEqual(errors.filter((error) => !error.startsWith("Executing inline event handler violates")), []);
  assert.equal(await page.locator("body > footer").count(), 1);
  assert.equal(await page.locator("main script:not([type])").count(), 0);
  assert.equal(await page.locator("main > .fence, main > .broken").count(), 3);
  await page.getByText("This lab cannot be read.").waitFor();
  assert.equal(await page.locator(".math-wrong").count(), 1);
  await page.getByText("More").click();
  assert.ok(await page.getByText("Inside, bold").isVisible());
});
