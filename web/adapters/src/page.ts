/** The fences of one page as elements. */
import { jsonInScript, modelInScript, type DataScript, type FenceElement } from "./element.js";
import { FenceError, fenceKind, mapLabs, readFence, toJson, withComparison, type FenceKind, type Json } from "./fence.js";
import { readModel, type ModelOptions } from "./models.js";

/** How fences become elements. */
export interface Options extends ModelOptions {
  /**
   * Where the content of an element is. `script`, the default: in scripts of data inside it. `attribute`: in its attribute `src`, for tools
   * that compile pages into components, in which no script can be; its policy must allow `connect-src data:`.
   */
  readonly form?: "script" | "attribute" | undefined;
}

/** A page while its fences are converted: their numbers and ids. */
export interface Page {
  readonly options: Options;
  /** The file of the lesson, if there is one. */
  readonly lesson: string | null;
  readonly ids: Set<string>;
  labs: number;
}

/** The element of a fence, or why it stays a code block: a sentence without a full stop. */
export type Converted =
  | { readonly kind: FenceKind; readonly element: FenceElement; readonly content: Json; readonly models: Readonly<Record<string, string>> }
  | { readonly kind: FenceKind; readonly element: null; readonly message: string };

/** A page of which no fence has been converted yet. */
export function createPage(options: Options = {}, lesson: string | null = null): Page {
  return { options, lesson, ids: new Set(), labs: 0 };
}

/** Converts a fence. `null` for a fence that is neither a lab nor a quiz. */
export function convertFence(info: string, text: string, page: Page): Converted | null {
  const kind = fenceKind(info);
  if (kind === null) return null;
  if (kind === "lab") page.labs += 1;
  try {
    const read = withComparison(info, readFence(text));
    const models = modelsOf(kind, read, page);
    const { content, inScripts } = placeModels(kind, read, models, page.options);
    const json = toJson(content);
    const id = uniqueId(kind === "lab" ? `lab-${page.labs}` : `quiz-${slug(content["id"])}`, page);
    return { kind, element: elementOf(kind, id, json, inScripts, page.options), content, models };
  } catch (e) {
    if (!(e instanceof FenceError)) throw e;
    return { kind, element: null, message: `This ${kind} cannot be displayed: ${e.message}` };
  }
}

/** The texts of the models that a content names. */
function modelsOf(kind: FenceKind, content: Json, { options, lesson }: Page): Record<string, string> {
  const models: [string, string][] = [];
  mapLabs(kind, content, (lab) => {
    const name = lab["model"];
    const hasFolder = options.modelsUrl === undefined || options.models !== undefined;
    if (typeof name === "string" && options.models !== false && hasFolder) models.push([name, readModel(name, options, lesson)]);
    return lab;
  });
  return options.modelsUrl === undefined ? Object.fromEntries(models) : {};
}

/** Where the models of a content are: in scripts, or as `xml` in the labs where no script can contain them. */
function placeModels(kind: FenceKind, content: Json, models: Readonly<Record<string, string>>, { form }: Options): { content: Json; inScripts: readonly DataScript[] } {
  const inScripts: DataScript[] = [];
  for (const [name, xml] of Object.entries(models)) {
    const text = form === "attribute" ? null : modelInScript(xml);
    if (text !== null) inScripts.push({ type: "model/mjcf", name, text });
  }
  const placed = mapLabs(kind, content, (lab) => {
    const name = lab["model"];
    const text = typeof name === "string" && Object.hasOwn(models, name) ? models[name] : undefined;
    if (text === undefined || inScripts.some((script) => script.name === name)) return lab;
    return Object.fromEntries(Object.entries(lab).map(([key, value]) => (key === "model" ? ["xml", text] : [key, value])));
  });
  return { content: placed, inScripts };
}

function elementOf(kind: FenceKind, id: string, json: string, models: readonly DataScript[], { form, modelsUrl }: Options): FenceElement {
  const attributes: Record<string, string> = { id };
  if (modelsUrl !== undefined) attributes["models"] = modelsUrl;
  const tag = kind === "lab" ? "sim-lab" : "lesson-quiz";
  if (form === "attribute") {
    attributes["src"] = `data:application/json;base64,${Buffer.from(json, "utf8").toString("base64")}`;
    return { tag, attributes, scripts: [] };
  }
  return { tag, attributes, scripts: [{ type: "application/json", text: jsonInScript(json) }, ...models] };
}

function uniqueId(wanted: string, { ids }: Page): string {
  let id = wanted;
  for (let n = 2; ids.has(id); n += 1) id = `${wanted}-${n}`;
  ids.add(id);
  return id;
}

/** A part of an id: letters and digits in lower case, joined by hyphens. */
function slug(text: unknown): string {
  return typeof text === "string" ? text.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "").slice(0, 80) : "";
}
