/**
 * A remark plugin: fences with labs and quizzes become elements. The nodes carry `hName`, `hProperties` and `hChildren`, so that neither
 * raw HTML nor another plugin is needed.
 */
import type { FenceElement } from "../element.js";
import { convertFence, createPage, type Options } from "../page.js";

export type { Options } from "../page.js";

/** A node of mdast, as far as the plugin reads it. */
interface Node {
  type: string;
  children?: Node[];
  lang?: string | null;
  meta?: string | null;
  value?: string;
  data?: object;
  position?: object | undefined;
}

/** A file of unified, as far as the plugin uses it. */
interface File {
  readonly path?: string | undefined;
  message(reason: string, place?: object): unknown;
}

/** The plugin. */
export default function remarkLabspec(options: Options = {}): (tree: object, file: object) => void {
  return (tree, file) => convertTree(tree as Node, file as File, options);
}

function convertTree(tree: Node, file: File, options: Options): void {
  const page = createPage(options, file.path ?? null);
  // Fences keep their order, and a tree of any depth is walked without recursion.
  const waiting: Node[] = [tree];
  for (let node = waiting.pop(); node !== undefined; node = waiting.pop()) {
    const children = node.children ?? [];
    for (let i = children.length - 1; i >= 0; i -= 1) waiting.push(children[i] as Node);
    if (node.type !== "code") continue;
    const code = { ...node };
    const converted = convertFence([code.lang, code.meta].filter((part) => typeof part === "string").join(" "), code.value ?? "", page);
    if (converted === null) continue;
    if (converted.element !== null) become(node, { type: "labspecElement", data: hastOf(converted.element) });
    else {
      file.message(converted.message, code);
      const text = { type: "strong", children: [{ type: "text", value: `${converted.message}.` }] };
      const message = { type: "paragraph", data: { hProperties: { className: ["labspec-message"], role: "note" } }, children: [text] };
      become(node, { type: "labspecMessage", data: { hName: "div" }, children: [message, code] });
    }
  }
}

/** Makes a node another one, in its place. */
function become(node: Node, other: Node): void {
  const { position } = node;
  for (const key of Object.keys(node)) delete node[key as keyof Node];
  Object.assign(node, other, position === undefined ? {} : { position });
}

/** What remark-rehype makes of a node. */
function hastOf({ tag, attributes, scripts }: FenceElement): object {
  const hChildren = scripts.map(({ type, name, text }) => ({
    type: "element", tagName: "script", properties: name === undefined ? { type } : { type, dataName: name }, children: [{ type: "text", value: text }],
  }));
  return { hName: tag, hProperties: attributes, hChildren };
}
