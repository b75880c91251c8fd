// Trials in other hosts, too heavy for every change: installs each host with the version named beside it, makes a page with the first
// lesson, opens it in Chromium, plays the lab and answers the quiz.
//
//   node trials/run.mjs                  all of them
//   node trials/run.mjs jupyterlab ...   some
//
// Packages go to LABSPEC_TRIALS, or target/trials of the repository.
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { answerQuiz, elements, launch, open, playLab } from "../test/page/site.mjs";
import { repository, run } from "../test/tools.mjs";
import * as notebooks from "./notebooks.mjs";
import * as sites from "./sites.mjs";

const hosts = { ...notebooks, ...sites };
const packages = process.env.LABSPEC_TRIALS ?? join(repository, "target/trials");
const names = process.argv.length > 2 ? process.argv.slice(2) : Object.keys(hosts);

/** Installs the packages of a host in a folder of its own. */
function install(name, { python, node }) {
  const folder = join(packages, name);
  mkdirSync(folder, { recursive: true });
  if (python !== undefined) {
    if (!existsSync(join(folder, "py"))) run("python3", ["-m", "venv", join(folder, "py")]);
    run(join(folder, "py/bin/pip"), ["install", "--quiet", ...python]);
  }
  if (node !== undefined) run("npm", ["install", "--no-audit", "--no-fund", "--silent", "--prefix", folder, ...node]);
  return folder;
}

/** One trial; gives a line of the report. Whatever it starts ends with it. */
async function trial(name) {
  const undo = [];
  const host = hosts[name];
  try {
    const installed = install(name, host);
    const folder = mkdtempSync(join(tmpdir(), `labspec-${name}-`));
    const t = { after: (f) => undo.push(f), folder, installed, python: join(installed, "py/bin"), open: null };
    t.after(() => rmSync(folder, { recursive: true, force: true, maxRetries: 5 }));
    copyFileSync(elements, join(folder, "labspec-elements.js"));
    const browser = await launch(t);
    t.open = (url, expected) => open(browser, url, expected);
    const { page, errors, versions, showQuiz } = await host.try(t);
    const screenshot = process.env.SCREENSHOTS === undefined ? null : join(process.env.SCREENSHOTS, `${name}.png`);
    if (screenshot !== null) t.after(() => page.screenshot({ path: screenshot }));
    // What the host reports before its first lab is its own.
    await page.locator("sim-lab").first().waitFor({ state: "attached", timeout: 90_000 });
    const before = errors.splice(0);
    const time = await playLab(page, 60_000);
    await showQuiz?.();
    const { correct } = await answerQuiz(page, 60_000);
    const after = errors.splice(0);
    const passed = correct === true && after.length === 0;
    return { passed, line: `${name} (${versions}): the lab played ${time.toFixed(2)} s, the quiz answered ${correct ? "correct" : "wrong"}, ${after.length} errors of the page${after.map((e) => `\n  ${e}`).join("")}${before.length > 0 ? `; before the lab, the host reported ${before.length}:${before.map((e) => `\n  ${e.slice(0, 200)}`).join("")}` : ""}` };
  } catch (e) {
    return { passed: false, line: `${name}: ${e.stack}` };
  } finally {
    for (const f of undo.reverse()) await f();
  }
}

let failed = 0;
for (const name of names) {
  if (hosts[name] === undefined) throw new Error(`${name} is not one of ${Object.keys(hosts).join(", ")}`);
  const { passed, line } = await trial(name);
  failed += passed ? 0 : 1;
  console.log(`${passed ? "passed" : "FAILED"}: ${line}`);
}
process.exitCode = failed === 0 ? 0 : 1;
