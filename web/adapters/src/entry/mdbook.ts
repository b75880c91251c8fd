/** A preprocessor of mdBook: fences with labs and quizzes in the chapters of a book become elements. */
import { elementHtml } from "../element.js";
import { isObject } from "../fence.js";
import { findFences } from "../markdown.js";
import { convertFence, createPage, type Options, type Page } from "../page.js";
import { messageHtml } from "./core.js";
import { join } from "node:path";

export type { Options } from "../page.js";

/** A book with its fences converted, and what is to be reported. */
export interface Preprocessed {
  readonly book: unknown;
  readonly messages: readonly string[];
}

/** Whether the preprocessor changes what a renderer gets: only pages can have elements. */
export function supports(renderer: string): boolean {
  return renderer === "html";
}

/** Converts `[context, book]`, the input of a preprocessor. Throws an `Error` if it is something else. */
export function preprocess(input: unknown): Preprocessed {
  const [context, book] = Array.isArray(input) ? (input as unknown[]) : [];
  if (!isObject(context) || !isObject(book)) throw new Error("the input is not a context and a book");
  const settings = readSettings(context);
  const messages: string[] = [];
  // `sections` is the name before mdBook 0.5.
  const waiting = [book["items"], book["sections"]].flatMap((list) => (Array.isArray(list) ? (list as unknown[]) : []));
  for (const item of waiting) {
    const chapter = isObject(item) ? item["Chapter"] : null;
    if (!isObject(chapter)) continue;
    if (Array.isArray(chapter["sub_items"])) waiting.push(...(chapter["sub_items"] as unknown[]));
    convertChapter(chapter as Record<string, unknown>, settings, messages);
  }
  return { book, messages };
}

interface Settings {
  readonly options: Options;
  readonly source: string;
  /** The address of the elements' script from the root of the book. */
  readonly script: string | null;
}

/** Reads the table `preprocessor.labspec` of `book.toml`. */
function readSettings(context: Readonly<Record<string, unknown>>): Settings {
  const tableOf = (from: unknown, key: string): Readonly<Record<string, unknown>> => {
    const value = isObject(from) ? from[key] : null;
    return isObject(value) ? value : {};
  };
  const table = tableOf(tableOf(context["config"], "preprocessor"), "labspec");
  const textOf = (value: unknown): string | undefined => (typeof value === "string" ? value : undefined);
  const root = textOf(context["root"]) ?? ".";
  return {
    options: { root, models: textOf(table["models"]), modelsUrl: textOf(table["models-url"]) },
    source: join(root, textOf(tableOf(context["config"], "book")["src"]) ?? "src"),
    script: table["script"] === false ? null : (textOf(table["script"]) ?? "labspec-elements.js"),
  };
}

function convertChapter(chapter: Record<string, unknown>, { options, source, script }: Settings, messages: string[]): void {
  const [text, path, file] = [chapter["content"], chapter["path"], chapter["source_path"]];
  if (typeof text !== "string") return;
  const page = createPage(options, typeof file === "string" ? join(source, file) : null);
  const converted = convertText(text, page, (message) => messages.push(`${String(file ?? chapter["name"])}: ${message}`));
  const needsScript = script !== null && page.ids.size > 0;
  chapter["content"] = needsScript ? `${converted}\n\n<script type="module" src="${addressFrom(String(path ?? ""), script)}"></script>\n` : converted;
}

/** A Markdown text with the HTML of its fences, each on one line, so that it is one block of HTML in quotes and lists too. */
export function convertText(text: string, page: Page, report: (message: string) => void): string {
  const lines = text.split("\n");
  const out: string[] = [];
  let at = 0;
  for (const { start, end, info, body, prefix, head } of findFences(lines)) {
    const converted = convertFence(info, body, page);
    if (converted === null) continue;
    out.push(...lines.slice(at, start));
    at = end;
    if (converted.element !== null) out.push(`${head}<div class="labspec">${elementHtml(converted.element)}</div>`, prefix.trimEnd());
    else {
      report(converted.message);
      const [first = "", ...rest] = lines.slice(start, end);
      out.push(`${head}${messageHtml(converted.message)}`, prefix.trimEnd(), `${prefix}${first.slice(head.length)}`, ...rest);
    }
  }
  return [...out, ...lines.slice(at)].join("\n");
}

/** An address for a chapter in a folder. Addresses with a scheme, and those of the host's root, stay. */
function addressFrom(chapter: string, address: string): string {
  const escaped = address.replaceAll("&", "&amp;").replaceAll('"', "&quot;").replaceAll("<", "&lt;");
  return /^([a-z][a-z0-9+.-]*:|\/)/i.test(address) ? escaped : "../".repeat(chapter.split(/[/\\]/).length - 1) + escaped;
}
