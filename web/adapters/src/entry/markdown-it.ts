/** A markdown-it plugin: fences with labs and quizzes become elements. */
import { elementHtml } from "../element.js";
import { convertFence, createPage, type Options, type Page } from "../page.js";
import { messageHtml } from "./core.js";

export type { Options } from "../page.js";

/** A rule of the renderer of markdown-it, as far as the plugin calls it. */
type RenderRule = (tokens: Token[], index: number, options: never, env: object, self: Renderer) => string;

interface Token {
  readonly info: string;
  readonly content: string;
}

interface Renderer {
  renderToken(tokens: Token[], index: number, options: never): string;
}

/** The parts of markdown-it that the plugin uses. */
export interface MarkdownIt {
  readonly renderer: { readonly rules: { fence?: RenderRule | undefined } };
}

/** The plugin. `env.path`, as VitePress sets it, is the file of the lesson. */
export default function markdownItLabspec(md: object, options: Options = {}): void {
  const { rules } = (md as MarkdownIt).renderer;
  const listing = rules.fence;
  const pages = new WeakMap<object, Page>();
  rules.fence = (tokens, index, settings, env, self) => {
    const rest = (): string => listing?.(tokens, index, settings, env, self) ?? self.renderToken(tokens, index, settings);
    const token = tokens[index];
    if (token === undefined) return rest();
    const page = pages.get(env) ?? createPage(options, pathOf(env));
    pages.set(env, page);
    const converted = convertFence(token.info, token.content, page);
    if (converted === null) return rest();
    return converted.element === null ? `${messageHtml(converted.message)}\n${rest()}` : `${elementHtml(converted.element)}\n`;
  };
}

function pathOf(env: object): string | null {
  const path = (env as { path?: unknown }).path;
  return typeof path === "string" ? path : null;
}
