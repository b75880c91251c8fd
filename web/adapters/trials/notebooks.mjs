// Trials in notebooks: a widget of anywidget whose module is the one file of the elements.
import { spawn } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { join } from "node:path";
import { withoutClaims } from "../test/course.mjs";
import { repository, run } from "../test/tools.mjs";
import { waitFor } from "../test/page/site.mjs";

const model = (name) => readFileSync(join(repository, `specs/models/${name}.xml`), "utf8");

/** The first lab and the knowledge check of the first lesson. */
function contents() {
  const text = readFileSync(join(repository, "specs/lessons/01-what-a-step-computes.md"), "utf8");
  const bodies = [...text.matchAll(/^```(lab simlab|lab integrators|quiz)\n([^]*?)\n```$/gm)].map(([, , body]) => withoutClaims(JSON.parse(body)));
  return { lab: bodies[0], quiz: bodies.at(-1), models: { drop: model("drop"), fall: model("fall") } };
}

/** Python that reads the contents and defines the two widgets. */
const WIDGETS = `import json
import pathlib

import anywidget
import traitlets

contents = json.loads(pathlib.Path("contents.json").read_text())


class Lab(anywidget.AnyWidget):
    _esm = pathlib.Path("labspec-elements.js")
    lab = traitlets.Dict().tag(sync=True)
    models = traitlets.Dict().tag(sync=True)


class Quiz(anywidget.AnyWidget):
    _esm = pathlib.Path("labspec-elements.js")
    quiz = traitlets.Dict().tag(sync=True)
    models = traitlets.Dict().tag(sync=True)`;
const LAB = 'Lab(lab=contents["lab"], models=contents["models"])';
const QUIZ = 'Quiz(quiz=contents["quiz"], models=contents["models"])';

/** Starts a server and waits until it answers; gives its address. */
async function start(t, program, args, cwd, path) {
  const port = await new Promise((resolve) => {
    const server = createServer().listen(0, "127.0.0.1", () => {
      const { port: free } = server.address();
      server.close(() => resolve(free));
    });
  });
  const server = spawn(program, [...args, "--port", String(port)], { cwd, stdio: "ignore", env: { ...process.env, JUPYTER_PLATFORM_DIRS: "1", HOME: cwd } });
  t.after(() => server.kill());
  const url = `http://127.0.0.1:${port}`;
  await waitFor(() => fetch(url + path).then(({ ok }) => ok, () => false), 60_000);
  return url + path;
}

const versions = (t, ...names) => {
  const { stdout } = run(join(t.python, "pip"), ["list", "--format=json"]);
  const all = JSON.parse(stdout);
  return names.map((name) => `${name} ${all.find((each) => each.name.toLowerCase() === name).version}`).join(", ");
};

export const jupyterlab = {
  python: ["jupyterlab==4.6.6", "anywidget==0.11.0"],
  async try(t) {
    writeFileSync(join(t.folder, "contents.json"), JSON.stringify(contents()));
    const cell = (source, id) => ({ cell_type: "code", id, source, metadata: {}, outputs: [], execution_count: null });
    const kernel = { kernelspec: { name: "python3", display_name: "Python 3", language: "python" } };
    writeFileSync(join(t.folder, "trial.ipynb"), JSON.stringify({ nbformat: 4, nbformat_minor: 5, metadata: kernel, cells: [cell(WIDGETS, "a"), cell(LAB, "b"), cell(QUIZ, "c")] }));
    const args = ["--no-browser", "--allow-root", "--ip=127.0.0.1", "--IdentityProvider.token=", "--ServerApp.password=", `--ServerApp.root_dir=${t.folder}`];
    const url = await start(t, join(t.python, "jupyter-lab"), args, t.folder, "/lab/tree/trial.ipynb");
    const { page, errors } = await t.open(url);
    await page.locator(".jp-Notebook-cell").first().waitFor({ timeout: 60_000 });
    // Cells that run before the kernel does are dropped.
    await page.getByText("Python 3 (ipykernel) | Idle").waitFor({ timeout: 60_000 });
    await page.getByRole("menuitem", { name: "Run", exact: true }).click();
    await page.getByRole("menuitem", { name: "Run All Cells", exact: true }).click();
    // Cells outside of the window are not in the page.
    const showQuiz = async () => {
      await page.locator(".jp-WindowedPanel-outer").hover({ position: { x: 20, y: 300 } });
      await waitFor(async () => {
        await page.mouse.wheel(0, 200);
        await page.waitForTimeout(300);
        return (await page.locator("lesson-quiz").count()) > 0;
      });
    };
    return { page, errors, showQuiz, versions: versions(t, "jupyterlab", "anywidget") };
  },
};

export const marimo = {
  python: ["marimo==0.25.2", "anywidget==0.11.0"],
  async try(t) {
    writeFileSync(join(t.folder, "contents.json"), JSON.stringify(contents()));
    const indented = WIDGETS.replace(/^(?=.)/gm, "    ");
    writeFileSync(join(t.folder, "trial.py"), `import marimo

app = marimo.App()


@app.cell
def _():
    import marimo as mo
${indented}
    return Lab, Quiz, contents, mo


@app.cell
def _(Lab, contents, mo):
    mo.ui.anywidget(${LAB})
    return


@app.cell
def _(Quiz, contents, mo):
    mo.ui.anywidget(${QUIZ})
    return


if __name__ == "__main__":
    app.run()
`);
    const url = await start(t, join(t.python, "marimo"), ["run", "trial.py", "--headless", "--no-token", "--host", "127.0.0.1"], t.folder, "/");
    const { page, errors } = await t.open(url, /was preloaded using link preload/); // Chromium says so of marimo's own pictures.
    return { page, errors, versions: versions(t, "marimo", "anywidget") };
  },
};
