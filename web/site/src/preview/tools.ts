/** The buttons of blocks: edit the source, apply a fix, ask for proposals and accept one. */
import type { Assist } from "./editor.js";
import { ask, lessonOf } from "./server.js";

const textOf = (x: unknown): string => (typeof x === "string" ? x : "");

function say(block: HTMLElement, text: string): void {
  const line = block.querySelector<HTMLElement>(":scope > .tools > .message");
  if (line !== null) line.textContent = text;
}

function rangeOf(block: HTMLElement): { start: number; end: number } {
  return { start: Number(block.dataset["start"]), end: Number(block.dataset["end"]) };
}

/** A place for an editor in a block. It goes when the editor does, and takes a block along that the page has no more. */
function editorHost(block: HTMLElement): HTMLElement {
  const host = document.createElement("div");
  host.className = "editor-host";
  block.append(host);
  new MutationObserver((_, observer) => {
    if (host.childElementCount > 0) return;
    observer.disconnect();
    host.remove();
    if (block.classList.contains("stale")) block.remove();
  }).observe(host, { childList: true });
  return host;
}

async function edit(main: HTMLElement, block: HTMLElement): Promise<void> {
  if (block.querySelector(".editor-host") !== null) return;
  const [lesson, range] = [lessonOf(main), rangeOf(block)];
  const { text } = await ask("source", { ...lesson, ...range });
  // The place of the block when the editor was opened: a text that has changed since is not overwritten.
  const { mountEditor } = await import("./editor.js");
  const assist: Assist = (question, now, offset) => ask(question, { ...lesson, ...range, text: now, offset });
  mountEditor(editorHost(block), textOf(text), assist, async (changed) => void (await ask("edit", { ...lesson, ...range, text: changed }))).focus();
}

async function fix(main: HTMLElement, button: HTMLElement): Promise<void> {
  await ask("fix", { ...lessonOf(main), finding: Number(button.dataset["finding"]) });
}

interface Proposal {
  readonly id: number | null;
  readonly name: string;
  readonly text: string;
  readonly note: string;
}

function readProposals(answer: Readonly<Record<string, unknown>>): Proposal[] {
  const all = answer["proposals"];
  return (Array.isArray(all) ? (all as unknown[]) : []).flatMap((one) => {
    if (typeof one !== "object" || one === null) return [];
    const { id, name, text, note } = one as Record<string, unknown>;
    return [{ id: typeof id === "number" ? id : null, name: textOf(name), text: textOf(text), note: textOf(note) }];
  });
}

/** Shows what the runs of a lesson suggest for a block. Nothing is written until a proposal is accepted. */
async function propose(main: HTMLElement, block: HTMLElement): Promise<void> {
  say(block, "Running the labs of this lesson …");
  const lesson = lessonOf(main);
  const proposals = readProposals(await ask("propose", { ...lesson, ...rangeOf(block) }));
  block.querySelector(":scope > .proposals")?.remove();
  say(block, proposals.length === 0 ? "Nothing to propose for this block." : "");
  if (proposals.length === 0) return;
  const list = document.createElement("ul");
  list.className = "proposals";
  for (const { id, name, text, note } of proposals) {
    const [item, title, pre, remark, accept] = [
      document.createElement("li"), document.createElement("b"), document.createElement("pre"), document.createElement("p"), document.createElement("button"),
    ];
    [title.textContent, pre.textContent, remark.textContent, accept.textContent, accept.type] = [name, text, note, "Accept", "button"];
    pre.tabIndex = 0;
    item.append(title, ...(note === "" ? [] : [remark]), ...(text === "" ? [] : [pre]));
    if (id !== null) item.append(accept);
    accept.addEventListener("click", () => {
      accept.disabled = true;
      ask("accept", { ...lesson, proposal: id }).then(() => list.remove(), (e: unknown) => {
        accept.disabled = false;
        say(block, e instanceof Error ? e.message : String(e));
      });
    });
    list.append(item);
  }
  block.append(list);
}

/** Makes the buttons of all blocks work, those that come later included. */
export function startTools(main: HTMLElement): void {
  main.addEventListener("click", (event) => {
    const button = event.target instanceof Element ? event.target.closest<HTMLButtonElement>("button[data-do]") : null;
    const block = button?.closest<HTMLElement>(".block") ?? null;
    if (button === null || block === null) return;
    const work = { edit: () => edit(main, block), fix: () => fix(main, button), propose: () => propose(main, block) }[button.dataset["do"] ?? ""];
    if (work === undefined) return;
    button.disabled = true;
    say(block, "");
    work().catch((e: unknown) => say(block, e instanceof Error ? e.message : String(e))).finally(() => {
      button.disabled = false;
    });
  });
}
