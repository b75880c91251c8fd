/** A plugin of mystmd: fences with labs and quizzes become nodes `anywidget`, which the themes of MyST open. */
import { readFileSync } from "node:fs";
import { convertFence, createPage, type Converted, type Options as PageOptions, type Page } from "../page.js";

/** How fences become nodes. */
export interface Options extends Omit<PageOptions, "form"> {
  /** The one file of the elements: an address, or a path from the file of the lesson; `/` begins at the folder of `myst.yml`. */
  readonly esm?: string;
}

/** A node of MyST's tree, as far as the plugin reads it. */
interface Node {
  type: string;
  children?: Node[];
  lang?: string;
  value?: string;
  position?: { readonly start: { readonly line: number } } | undefined;
}

/** A file of mystmd, as far as the plugin uses it. */
interface File {
  readonly path?: string | undefined;
  message(reason: string, place?: object): unknown;
}

/** A plugin, as mystmd loads it. */
export interface Plugin {
  readonly name: string;
  readonly transforms: readonly { readonly name: string; readonly stage: "document"; readonly plugin: () => (tree: object, file: object) => void }[];
}

/** Makes the plugin with options; the default export is the plugin without any. */
export function createPlugin(options: Options = {}): Plugin {
  const transform = (tree: object, file: object): void => convertTree(tree as Node, file as File, options);
  return { name: "labspec", transforms: [{ name: "labspec", stage: "document", plugin: () => transform }] };
}

export default createPlugin();

function convertTree(tree: Node, file: File, options: Options): void {
  const page = createPage(options, file.path ?? null);
  const lines = linesOf(file.path);
  const waiting: Node[] = [tree];
  for (let node = waiting.pop(); node !== undefined; node = waiting.pop()) {
    const children = node.children ?? [];
    for (let i = children.length - 1; i >= 0; i -= 1) waiting.push(children[i] as Node);
    if (node.type === "code") convertCode(node, file, lines, page, options);
  }
}

function convertCode(node: Node, file: File, lines: readonly string[], page: Page, options: Options): void {
  const code = { ...node };
  const converted = convertFence(infoOf(code, lines), code.value ?? "", page);
  if (converted === null) return;
  const { position } = code;
  for (const key of Object.keys(node)) delete node[key as keyof Node];
  if (converted.element !== null) Object.assign(node, widgetOf(converted, options), { position });
  else {
    file.message(converted.message, code);
    const title = { type: "admonitionTitle", children: [{ type: "text", value: converted.message }] };
    Object.assign(node, { type: "admonition", kind: "error", children: [title, code], position });
  }
}

/** The node that MyST's own directive makes; the widget reads `lab` or `quiz` and `models`. */
function widgetOf(converted: Converted & { element: object }, { esm = "/labspec-elements.js", modelsUrl }: Options): object {
  const { kind, content, models, element } = converted;
  const model: Record<string, unknown> = { [kind]: content };
  if (modelsUrl !== undefined) model["models"] = modelsUrl;
  else if (Object.keys(models).length > 0) model["models"] = models;
  return { type: "anywidget", esm, model, class: "labspec", id: element.attributes["id"] };
}

/** The info string of a fence. MyST keeps its first word only, so the line of the source has the name of the widget. */
function infoOf({ lang = "", position }: Node, lines: readonly string[]): string {
  const line = position === undefined ? undefined : lines[position.start.line - 1];
  const written = line === undefined ? null : /(?:`{3,}|~{3,})\s*(.*)$/.exec(line)?.[1];
  return written?.split(/\s+/)[0] === lang ? written : lang;
}

function linesOf(path: string | undefined): readonly string[] {
  try {
    return path === undefined ? [] : readFileSync(path, "utf8").split(/\r?\n/);
  } catch {
    // A text that is not a file has no line to read; the kind is then known from the first word.
    return [];
  }
}
