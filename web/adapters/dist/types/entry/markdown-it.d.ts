import { type Options } from "../page.js";
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
    readonly renderer: {
        readonly rules: {
            fence?: RenderRule | undefined;
        };
    };
}
/** The plugin. `env.path`, as VitePress sets it, is the file of the lesson. */
export default function markdownItLabspec(md: object, options?: Options): void;
