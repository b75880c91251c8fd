/** Brings the new text of a page into the open one. What is the same stays, with the states of its labs. */
import { drawFormulas } from "../math.js";
import { actionsFor, repeatActions, type Actions } from "./labs.js";

/** The time that the engine of a lab has to say what was done to it, ms. */
const PATIENCE = 1500;
const blocksOf = (main: ParentNode): HTMLElement[] => [...main.querySelectorAll<HTMLElement>(":scope > .block:not(.stale)")];
const labOf = (block: ParentNode): Element | null => block.querySelector(":scope > .content sim-lab");

/** For each new block, the old one that it continues. */
export function pairBlocks(old: readonly HTMLElement[], fresh: readonly HTMLElement[]): (HTMLElement | undefined)[] {
  const left = new Set(old);
  const take = (fits: (block: HTMLElement) => boolean): HTMLElement | undefined => {
    for (const block of left) {
      if (!fits(block)) continue;
      left.delete(block);
      return block;
    }
    return undefined;
  };
  // The same content first, so that a block keeps its element even where another one of its name was inserted before it.
  const pairs = fresh.map((block) => take((other) => other.dataset["hash"] === block.dataset["hash"]));
  return pairs.map((pair, i) => {
    const [key, source] = [fresh[i]?.dataset["key"], fresh[i]?.dataset["source"]];
    return pair ?? take((other) => other.dataset["source"] === source || (key !== "" && other.dataset["key"] === key));
  });
}

/** Replaces parts of a block; its element stays where it is the same. */
function updateBlock(old: HTMLElement, fresh: HTMLElement, isChecked: boolean): void {
  const isSameSource = old.dataset["source"] === fresh.dataset["source"];
  // Until the check has ended, its last results stay beside what has not changed.
  if (!isChecked && isSameSource) {
    for (const name of ["start", "end"]) old.dataset[name] = fresh.dataset[name] ?? "";
    return;
  }
  const isSame = old.dataset["hash"] === fresh.dataset["hash"];
  const part = (block: HTMLElement, name: string): HTMLElement | null => block.querySelector(`:scope > .${name}`);
  for (const name of isSame ? ["after", "notes"] : ["content", "after", "notes"]) {
    const [from, to] = [part(fresh, name), part(old, name)];
    if (from !== null && to !== null && from.outerHTML !== to.outerHTML) to.replaceWith(from);
  }
  for (const name of ["key", "hash", "source", "start", "end"]) old.dataset[name] = fresh.dataset[name] ?? "";
  old.className = fresh.className;
}

/** What was done to the labs that will be replaced, read before anything is. */
function actionsOf(pairs: readonly (HTMLElement | undefined)[], blocks: readonly HTMLElement[]): Promise<(Actions | null)[]> {
  return Promise.all(blocks.map(async (block, i) => {
    const old = pairs[i];
    if (old === undefined || old.dataset["hash"] === block.dataset["hash"]) return null;
    // An engine that is busy does not hold up the change.
    const late = new Promise<null>((resolve) => setTimeout(() => resolve(null), PATIENCE));
    return Promise.race([actionsFor(labOf(old), labOf(block)).catch(() => null), late]);
  }));
}

/** Removes a block. One with an open editor stays until the editor is closed, so that nothing that was typed is lost. */
function removeBlock(block: HTMLElement): void {
  if (block.querySelector(":scope > .editor-host") === null) return block.remove();
  block.classList.add("stale");
  for (const name of ["content", "after", "notes", "tools"]) block.querySelector(`:scope > .${name}`)?.remove();
  const remark = document.createElement("p");
  remark.setAttribute("role", "status");
  remark.textContent = "This block has changed in the file. Your text is still here, and cannot be saved: copy what you need.";
  block.prepend(remark);
}

/** Brings the new page into the open one. */
export async function patchPage(fresh: Document): Promise<void> {
  const [main, next] = [document.querySelector("main"), fresh.querySelector("main")];
  if (main === null || next === null) return;
  const isChecked = next.dataset["checked"] === "true";
  const [old, blocks] = [blocksOf(main), blocksOf(next)];
  const pairs = pairBlocks(old, blocks);
  const kept = new Set(pairs);
  const actions = await actionsOf(pairs, blocks);
  for (const block of old) if (!kept.has(block)) removeBlock(block);
  let last: Element | null = null;
  blocks.forEach((block, i) => {
    const pair = pairs[i];
    let place: Element | null = last === null ? (main.querySelector(":scope > .block")) : last.nextElementSibling;
    while (place !== null && place.classList.contains("stale")) place = place.nextElementSibling;
    if (pair === undefined) main.insertBefore(document.adoptNode(block), place);
    else {
      // An element that is moved starts again, so only what is out of order moves.
      if (pair !== place) main.insertBefore(pair, place);
      updateBlock(pair, block, isChecked);
    }
    last = pair ?? block;
  });
  for (const name of ["status", "elsewhere"]) {
    const [from, to] = [next.querySelector(`:scope > .${name}`), main.querySelector(`:scope > .${name}`)];
    if (from !== null && to !== null && from.outerHTML !== to.outerHTML) to.replaceWith(document.adoptNode(from));
  }
  replaceModels(main, next);
  for (const name of ["page", "hash", "checked", "models"]) {
    const value = next.dataset[name];
    if (value === undefined) delete main.dataset[name];
    else main.dataset[name] = value;
  }
  document.title = fresh.title;
  await drawFormulas(main);
  actions.forEach((done, i) => {
    // Actions that a lab refuses are no error of the page: the lab says so, and begins at its start. The next change does not wait.
    if (done !== null) repeatActions(labOf(pairs[i] ?? main), done).catch(() => undefined);
  });
}

/** The models of the page. A lab whose model has changed has another hash, and is replaced. */
function replaceModels(main: HTMLElement, next: HTMLElement): void {
  const models = (of: ParentNode): HTMLScriptElement[] => [...of.querySelectorAll<HTMLScriptElement>(":scope > script[type='model/mjcf']")];
  const [old, fresh] = [models(main), models(next)];
  const textOf = (all: readonly Element[]): string => all.map((one) => one.outerHTML).join("");
  if (textOf(old) === textOf(fresh)) return;
  for (const one of old) one.remove();
  main.append(...fresh.map((one) => document.adoptNode(one)));
}
