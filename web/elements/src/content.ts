/** Where the content of an element comes from: a property, an attribute, or a script inside it. */
import type { Models } from "labspec/slim";
import { fetchModel } from "./model-files.js";
import { isObject, type Json } from "./spec.js";
import type { Say } from "./text/messages.js";

/** Messages for readers about faulty content of an element. */
export class ContentError extends Error {}

/** The JSON of an element, as an object and as it is written. */
export interface Content {
  readonly json: Json;
  readonly text: string;
}

/** Reads the content of an element: its property, then `src`, then a `<script type="application/json">` inside. */
export async function readContent(element: Element, property: unknown, missing: string, say: Say): Promise<Content> {
  if (isObject(property)) return { json: property, text: JSON.stringify(property) };
  const src = element.getAttribute("src");
  const inside = element.querySelector(":scope > script[type='application/json']");
  const text = typeof property === "string" ? property : src !== null ? await fetchText(src, say) : (inside?.textContent ?? null);
  if (text === null || text.trim() === "") throw new ContentError(missing);
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch (e) {
    throw new ContentError(say("notJson", { why: e instanceof Error ? e.message : String(e) }));
  }
  if (!isObject(json)) throw new ContentError(say("notAnObject"));
  return { json, text };
}

/**
 * The models of an element: its property, `<script type="model/mjcf" data-name="…">` inside it or anywhere on the page, and, for a model
 * that is named and not there, the file of that name, with the files that it names, in the folder that `models` or `data-models` names.
 */
export async function readModels(element: Element, property: Models | null, name: string | null, say: Say): Promise<Models> {
  const models: Record<string, string | Uint8Array> = {};
  const scripts = [...document.querySelectorAll("script[type='model/mjcf']"), ...element.querySelectorAll("script[type='model/mjcf']")];
  for (const script of scripts) {
    const called = script.getAttribute("data-name");
    if (called !== null && !(script.closest("sim-lab, lesson-quiz") ?? element).isSameNode(element)) continue;
    if (called !== null) models[called] = script.textContent ?? "";
  }
  Object.assign(models, property ?? {});
  const folder = element.getAttribute("models") ?? element.closest("[data-models]")?.getAttribute("data-models") ?? null;
  if (name !== null && folder !== null && models[name] === undefined && /^[\w.-]+$/.test(name)) {
    Object.assign(models, await fetchModel(name, (path) => fetchFile(`${folder.replace(/\/?$/, "/")}${path}`, say)));
  }
  return models;
}

async function fetchText(address: string, say: Say): Promise<string> {
  return (await fetchFile(address, say)).text();
}

async function fetchFile(address: string, say: Say): Promise<Response> {
  const refuse = (why: string): ContentError => new ContentError(say("notFetched", { url: address, why }));
  try {
    const response = await fetch(new URL(address, document.baseURI));
    if (!response.ok) throw refuse(`${response.status} ${response.statusText}`.trim());
    return response;
  } catch (e) {
    throw e instanceof ContentError ? e : refuse(e instanceof Error ? e.message : String(e));
  }
}

/** Waits until the children of an element have been read. */
export function childrenRead(): Promise<void> {
  if (document.readyState !== "loading") return Promise.resolve();
  return new Promise((resolve) => document.addEventListener("DOMContentLoaded", () => resolve(), { once: true }));
}
