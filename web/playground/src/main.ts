/** The playground: a model and a lab beside the running scene. */
import { CheckerClient, mountEditor, type CheckedFinding, type EditorHandle } from "labspec-editor";
import { zipSync } from "fflate";
import { checkClaims } from "./claims.js";
import { Course } from "./course.js";
import { byId, h, saveFile } from "./dom.js";
import { filesOfDrop, filesOfInput, openGiven, type GivenFile, type GivenLab } from "./import.js";
import { decodeProject, encodeProject } from "./link.js";
import { LAB_PATH, lessonOf, modelPath, modelsOf, OpenError, titleOf, type Project } from "./project.js";
import { sayClaims, showClaims, showFindings, type FindingActions } from "./results.js";
import { Stage } from "./stage.js";

/** Milliseconds after a change until the scene starts again, and until claims are checked. */
const PAUSE = 350;
const CLAIMS_PAUSE = 1000;

const checker = new CheckerClient(() => new Worker(new URL("./checker/worker.js", import.meta.url), { type: "module" }));
const stage = new Stage(byId("scene", HTMLDivElement));
const course = new Course(document.querySelector<HTMLMetaElement>("meta[name=labspec-course]")?.content ?? "course/");
const findings = new Map<string, readonly CheckedFinding[]>();
/** What the last check with runs found in the lab, as it is written now. */
let runFindings: readonly CheckedFinding[] = [];
/** The state of the lab in the link that was opened, until the project changes. */
let linkedState = "";
/** The files that a reader has opened, whose labs can be chosen. */
let given: readonly GivenFile[] = [];
let project: Project = { lab: "{}", models: {}, files: {}, model: null, lesson: null };
let editors: { model: EditorHandle | null; lab: EditorHandle } | null = null;
let [turn, timer, claimsTimer] = [0, 0, 0];

const status = byId("status", HTMLParagraphElement);
function say(text: string, failed = false): void {
  status.textContent = text;
  status.classList.toggle("failed", failed);
}
const reasonOf = (e: unknown): string => (e instanceof Error ? e.message : String(e));

const findLabs = (path: string, text: string): ReturnType<typeof checker.ask<"labs">> => checker.ask("labs", path, text);

/** Opens a project in the editors and on the stage; `labs` can be chosen in its place. */
async function open(next: Project, told: string, state = "", labs: readonly GivenLab[] = [], place: string | null = null): Promise<void> {
  offerLabs(labs, place);
  project = next;
  linkedState = state;
  findings.clear();
  runFindings = [];
  stage.forget();
  stage.isOpen = false;
  checker.models = modelsOf(project);
  mountEditors();
  say(told);
  await update();
}

function mountEditors(): void {
  editors?.model?.dispose();
  editors?.lab.dispose();
  editors = { model: mountModel(), lab: mountText("lab-text", LAB_PATH, "json", project.lab, "Lab as JSON", (lab) => ({ ...project, lab })) };
  const names = Object.keys(project.models);
  const choice = byId("models", HTMLSelectElement);
  choice.replaceChildren(...names.map((name) => h("option", { value: name }, modelPath(name))));
  choice.value = project.model ?? "";
  choice.disabled = names.length < 2;
}

function mountModel(): EditorHandle | null {
  const name = project.model;
  if (name === null) {
    byId("model", HTMLDivElement).replaceChildren(h("p", { class: "keys" }, "The model is part of the lab, or there is none. Open a file to add one."));
    return null;
  }
  byId("model", HTMLDivElement).replaceChildren();
  const change = (xml: string): Project => ({ ...project, models: { ...project.models, [name]: xml } });
  return mountText("model", modelPath(name), "mjcf", project.models[name] ?? "", "Model as MJCF", change);
}

function mountText(id: string, path: string, language: "json" | "mjcf", text: string, label: string, change: (text: string) => Project): EditorHandle {
  return mountEditor(byId(id, HTMLDivElement), {
    text, language, path, label, checker,
    onChange(now) {
      project = change(now);
      runFindings = [];
      linkedState = "";
      say("");
      clearTimeout(timer);
      timer = window.setTimeout(() => void update(), PAUSE);
    },
    onSave: () => void saveLesson(),
    onFindings: (now) => {
      findings.set(path, now);
      showAllFindings();
    },
    onFailure: (why) => say(why, true),
  });
}

function showAllFindings(): void {
  const group = (path: string, editor: EditorHandle | null | undefined, more: readonly CheckedFinding[] = []): { findings: readonly CheckedFinding[]; actions: FindingActions } => ({
    findings: [...(findings.get(path) ?? []), ...more],
    actions: {
      show: editor === null || editor === undefined ? null : (finding) => editor.select(finding.start ?? 0, finding.end ?? 0),
      fix(finding, index) {
        if (editor?.fix(finding, index) !== true) say("The text has changed meanwhile; look at the new findings.");
      },
    },
  });
  const model = project.model === null ? [] : [group(modelPath(project.model), editors?.model)];
  showFindings([...model, group(LAB_PATH, editors?.lab, runFindings)]);
}

/** What the texts are now, on the stage: unless they have errors and something runs. */
async function update(): Promise<void> {
  const [now, own] = [project, ++turn];
  checker.models = modelsOf(now);
  const fragment = await encodeProject(now);
  if (own !== turn) return;
  history.replaceState(history.state, "", fragment === null ? `${location.pathname}${location.search}` : `${fragment}${linkedState}`);
  try {
    const count = await errorsOf(now);
    if (own !== turn) return;
    if (count > 0 && stage.isOpen) say(`${count} ${count === 1 ? "error" : "errors"}: the scene is the last one without errors.`);
    else if (await stage.open(now)) say(count === 0 ? "The scene is up to date." : "");
  } catch (e) {
    if (own === turn) say(`The lab does not run: ${reasonOf(e)}`, true);
  }
  clearTimeout(claimsTimer);
  claimsTimer = window.setTimeout(() => void runLab(now), CLAIMS_PAUSE);
}

async function errorsOf({ lab, model, models }: Project): Promise<number> {
  const texts: [string, string][] = [[LAB_PATH, lab]];
  if (model !== null) texts.push([modelPath(model), models[model] ?? ""]);
  const all = await Promise.all(texts.map(([path, text]) => checker.ask("findings", path, text)));
  return all.flat().filter((finding) => finding.severity === "error").length;
}

async function runLab(now: Project): Promise<void> {
  sayClaims("Checking…");
  try {
    const claims = await checkClaims(checker, now, findings.get(LAB_PATH) ?? []);
    if (now !== project) return;
    showClaims(claims.entries);
    runFindings = claims.findings;
    showAllFindings();
  } catch (e) {
    if (now === project) sayClaims(reasonOf(e));
  }
}

/** Does something that may fail, and says why. */
async function attempt(what: () => Promise<void>): Promise<void> {
  try {
    await what();
  } catch (e) {
    say(e instanceof OpenError ? e.message : reasonOf(e), true);
  }
}

async function openFiles(files: readonly GivenFile[]): Promise<void> {
  const { project: next, labs, place } = await openGiven(files, editors === null ? null : project, findLabs);
  history.replaceState(history.state, "", location.pathname);
  if (place !== null) given = files;
  await open(next, `${files.length} ${files.length === 1 ? "file" : "files"} opened.`, "", labs, place);
}

/** Opens another lab of the files that are open. */
async function openLab(chosen: string): Promise<void> {
  const { project: next, labs, place } = await openGiven(given, null, findLabs, chosen);
  history.replaceState(history.state, "", location.pathname);
  await open(next, `${chosen} is open.`, "", labs, place);
}

/** Shows the labs and questions that can be chosen, if there are several. */
function offerLabs(labs: readonly GivenLab[], place: string | null): void {
  const choice = byId("labs", HTMLSelectElement);
  choice.replaceChildren(...labs.map((lab) => h("option", { value: lab.place }, lab.title === "" ? lab.place : `${lab.title} (${lab.place})`)));
  choice.value = place ?? "";
  byId("labs-choice", HTMLLabelElement).hidden = labs.length < 2;
}

async function share(): Promise<void> {
  const fragment = await encodeProject(project);
  if (fragment === null) throw new OpenError("This is too large for a link. Download the folder instead.");
  history.replaceState(history.state, "", fragment);
  try {
    await navigator.clipboard.writeText(location.href);
    say("The link is copied; it holds the lab and its models.");
  } catch {
    say("The address of this page is the link; the browser does not let it be copied.");
  }
}

async function saveLesson(): Promise<void> {
  saveFile("lesson.md", new Blob([lessonOf(project)], { type: "text/markdown" }));
  say("The lesson is downloaded: the lab, and a listing of each model.");
  return Promise.resolve();
}

async function saveFolder(): Promise<void> {
  const encode = (text: string): Uint8Array => new TextEncoder().encode(text);
  const models = Object.entries(project.models).map(([name, xml]) => [`models/${modelPath(name)}`, encode(xml)] as const);
  const files = Object.entries(project.files).map(([path, bytes]) => [`models/${path}`, bytes] as const);
  const lesson = `# ${titleOf(project.lab).replaceAll(/\s+/g, " ")}\n\n\`\`\`lab simlab\n${project.lab.trim()}\n\`\`\`\n`;
  const archive = zipSync({ "lesson.md": encode(lesson), ...Object.fromEntries([...models, ...files]) });
  saveFile("course.zip", new Blob([archive as BlobPart], { type: "application/zip" }));
  return Promise.resolve();
}

function listen(): void {
  const [files, folder] = [byId("files", HTMLInputElement), byId("folder", HTMLInputElement)];
  const click = (id: string, what: () => void): void => byId(id, HTMLButtonElement).addEventListener("click", what);
  click("open-files", () => files.click());
  click("open-folder", () => folder.click());
  click("share", () => void attempt(share));
  click("save-lesson", () => void attempt(saveLesson));
  click("save-course", () => void attempt(saveFolder));
  click("format", () => void editors?.lab.format());
  for (const input of [files, folder]) {
    input.addEventListener("change", () => {
      const { files: chosen } = input;
      if (chosen !== null && chosen.length > 0) void attempt(async () => openFiles(await filesOfInput(chosen))).finally(() => { input.value = ""; });
    });
  }
  byId("models", HTMLSelectElement).addEventListener("change", (event) => {
    project = { ...project, model: (event.target as HTMLSelectElement).value };
    mountEditors();
    void update();
  });
  byId("labs", HTMLSelectElement).addEventListener("change", (event) => void attempt(() => openLab((event.target as HTMLSelectElement).value)));
  byId("examples", HTMLSelectElement).addEventListener("change", (event) => {
    const place = (event.target as HTMLSelectElement).value;
    if (place !== "") void attempt(() => openPlace(place));
  });
  addEventListener("hashchange", () => void attempt(async () => void (await openFragment())));
  listenToDrops();
}

function listenToDrops(): void {
  const shade = byId("drop", HTMLDivElement);
  const hasFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") === true;
  addEventListener("dragover", (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    shade.hidden = false;
  });
  addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) shade.hidden = true;
  });
  // Before an editor takes the file as text.
  addEventListener("drop", (event) => {
    shade.hidden = true;
    const { dataTransfer } = event;
    if (!hasFiles(event) || dataTransfer === null) return;
    event.preventDefault();
    event.stopPropagation();
    void attempt(async () => openFiles(await filesOfDrop(dataTransfer)));
  }, { capture: true });
}

async function openPlace(place: string): Promise<void> {
  say("Opening…");
  const next = await course.open(place, findLabs);
  history.replaceState(history.state, "", `?lab=${encodeURIComponent(place)}`);
  await open(next, `${place} is open.`);
}

async function openFragment(): Promise<boolean> {
  const linked = await decodeProject(location.hash);
  if (linked === null) return false;
  const place = new URLSearchParams(location.search).get("lab");
  // Without the lesson, the lab is opened all the same.
  const lesson = place === null ? null : await course.around(place, findLabs).catch(() => null);
  const state = location.hash.split("&").filter((part) => part.startsWith("lab.")).map((part) => `&${part}`).join("");
  await open({ ...linked, lesson }, "The project of the link is open.", state);
  return true;
}

async function listExamples(): Promise<string | null> {
  const lessons = await course.list();
  const groups = lessons.map((lesson) => {
    const group = h("optgroup", { label: lesson.title });
    group.append(...lesson.labs.map((lab) => h("option", { value: `${lesson.path}${lab.address}` }, lab.title === "" ? lab.address : lab.title)));
    return group;
  });
  byId("examples", HTMLSelectElement).append(...groups);
  const [first] = lessons;
  return first === undefined ? null : `${first.path}${first.labs[0]?.address ?? ""}`;
}

const FALLBACK: Project = {
  lab: `${JSON.stringify({ title: "A fall", model: "fall", plots: [{ ylabel: "height (m)", traces: [{ label: "ball", expr: "data.body('ball').xpos[2]" }] }] }, null, 2)}\n`,
  models: { fall: '<mujoco>\n  <worldbody>\n    <geom type="plane" size="1 1 1"/>\n    <body name="ball" pos="0 0 1">\n      <freejoint/>\n      <geom size="0.1"/>\n    </body>\n  </worldbody>\n</mujoco>\n' },
  files: {}, model: "fall", lesson: null,
};

async function start(): Promise<void> {
  listen();
  let first: string | null = null;
  let refused: string | null = null;
  try {
    first = await listExamples();
  } catch (e) {
    refused = reasonOf(e);
  }
  const asked = new URLSearchParams(location.search).get("lab");
  try {
    if (await openFragment()) return;
    if (asked !== null) return await openPlace(asked);
  } catch (e) {
    refused = reasonOf(e);
  }
  const opened = first === null ? open(FALLBACK, "") : openPlace(first);
  await opened.catch(() => open(FALLBACK, ""));
  if (refused !== null) say(refused, true);
}

void start();
