// A content package that `labspec build --scorm` wrote, unpacked and started in a frame as a learning system does.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import test, { after } from "node:test";
import { unzipSync } from "fflate";
import { folder, labspec, launch, open, opened, serve } from "./pages.mjs";

const QUIZ = `# A quiz beside a lab

See [the next](week/b.md#next), [data](data.csv) and [the web](https://example.org/).

\`\`\`lab simlab
{"title": "Fall", "model": "first_fall", "readouts": [{"label": "t", "expr": "data.time"}]}
\`\`\`

\`\`\`quiz
{"id": "q", "questions": [{"q": "One?", "options": ["yes", "no"], "answer": 0}, {"kind": "numeric", "q": "Two?", "answer": 2, "tol": 0.1}]}
\`\`\`
`;
const suite = { after };
const browser = await launch();
after(() => browser.close());
const own = join(folder(suite), "lessons");
mkdirSync(join(own, "week"), { recursive: true });
const model = "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>";
mkdirSync(join(own, "models"));
for (const [name, text] of [["models/first_fall.xml", model], ["a.md", QUIZ], ["week/b.md", "# Next\n\nText.\n"], ["data.csv", "1,2\n"]]) writeFileSync(join(own, name), text);
const out = join(folder(suite), "site");
const built = labspec("build", own, "--out", out, "--scorm", "--pass", "0.5");

/** A page that starts a package in a frame, and records what it reports. */
const system = (start) => `<!doctype html><title>System</title><link rel="icon" href="data:,"><script>
  const values = JSON.parse(sessionStorage.getItem("values") ?? "{}");
  globalThis.lms = { values, calls: [] };
  const record = (name, answer) => (...args) => { lms.calls.push([name, ...args]); return answer(...args); };
  globalThis.API_1484_11 = {
    Initialize: record("Initialize", () => "true"), Commit: record("Commit", () => { sessionStorage.setItem("values", JSON.stringify(values)); return "true"; }),
    Terminate: record("Terminate", () => "true"), GetValue: record("GetValue", (name) => values[name] ?? ""),
    SetValue: record("SetValue", (name, value) => { values[name] = value; return "true"; }),
    GetLastError: () => "0", GetErrorString: () => "", GetDiagnostic: () => "",
  };
</script><iframe src="package/${start}" width="900" height="700"></iframe>`;

test("a package starts in a frame, runs its lab, reports grades and gives the answers back", async (t) => {
  assert.ok(existsSync(join(out, "scorm/a.zip")), built.stdout + built.stderr);
  const files = unzipSync(readFileSync(join(out, "scorm/a.zip"))), host = folder(t);
  for (const [name, bytes] of Object.entries(files)) {
    mkdirSync(dirname(join(host, "package", name)), { recursive: true });
    writeFileSync(join(host, "package", name), bytes);
  }
  const manifest = new TextDecoder().decode(files["imsmanifest.xml"]), start = /<resource [^>]*href="([^"]+)"/.exec(manifest)[1];
  assert.equal(start, "a.html");
  writeFileSync(join(host, "index.html"), system(start));
  const { url } = await serve(t, host);
  const { page, none } = await open(t, browser, url);
  const frame = page.frameLocator("iframe"), inside = page.frames()[1];
  await opened(inside, "#lab-1");
  assert.ok(await inside.evaluate(async () => {
    const lab = document.getElementById("lab-1");
    await lab.step(5);
    return lab.time > 0;
  }));
  const question = frame.locator(".question").first();
  await question.getByRole("radio", { name: "yes" }).check();
  await question.getByRole("button", { name: "Check" }).click();
  await page.waitForFunction(() => globalThis.lms.calls.some(([name]) => name === "Commit"));
  const values = await page.evaluate(() => globalThis.lms.values);
  assert.deepEqual(["cmi.score.scaled", "cmi.success_status", "cmi.completion_status", "cmi.interactions.0.id"].map((name) => values[name]), ["0.5", "passed", "incomplete", "q.1"]);
  // No link leaves the frame: to a lesson that is not in the package, to a file of it, to the web.
  assert.equal(await frame.locator("nav, .search").count(), 0);
  assert.equal(await frame.getByText("the next").getAttribute("href"), null);
  assert.equal(await frame.getByRole("link", { name: "data" }).getAttribute("href"), "files/data.csv");
  assert.equal(await frame.getByRole("link", { name: "the web" }).getAttribute("target"), "_blank");
  await page.reload();
  await frame.locator(".badge").first().waitFor();
  none();
});

test("a lesson without questions is an asset, whose page stands alone", async (t) => {
  const files = unzipSync(readFileSync(join(out, "scorm/week/b.zip"))), host = folder(t);
  for (const [name, bytes] of Object.entries(files)) {
    mkdirSync(dirname(join(host, name)), { recursive: true });
    writeFileSync(join(host, name), bytes);
  }
  assert.match(new TextDecoder().decode(files["imsmanifest.xml"]), /adlcp:scormType="asset" href="week\/b\.html"/);
  const { url } = await serve(t, host);
  const { page, none } = await open(t, browser, `${url}week/b.html`);
  assert.equal(await page.locator("h1").textContent(), "Next");
  none();
});
