/** Models by name: files of one folder, of which nothing outside of the root is opened. */
import { existsSync, readFileSync, readdirSync, realpathSync, statSync } from "node:fs";
import { dirname, join, relative, resolve, sep } from "node:path";
import { FenceError } from "./fence.js";

/** The maximum size of the text of a model in bytes. */
const MAX_TEXT = 16 << 20;
/** The attributes with which a model names other files. */
const FILES = /\sfile(right|left|up|down|front|back)?\s*=/;

/** Where models come from. */
export interface ModelOptions {
  /**
   * The folder of the MJCF files, relative to `root`; or their texts by name. Without it, the nearest folder `models` beside the lesson or
   * above it, up to `root`. `false`: the page has the models by other means, and nothing is looked up.
   */
  readonly models?: string | Readonly<Record<string, string>> | false | undefined;
  /** The folder outside of which no file is opened; by default the working directory. */
  readonly root?: string | undefined;
  /** The address from which pages fetch models by name. With it, no model is written into a page. */
  readonly modelsUrl?: string | undefined;
}

/** The text of a model. Throws a `FenceError`. */
export function readModel(name: string, options: ModelOptions, lesson: string | null): string {
  if (typeof options.models === "object") {
    const text = Object.hasOwn(options.models, name) ? options.models[name] : undefined;
    if (text === undefined) throw new FenceError(`the model \`${name}\` is not among the given models`);
    return inlineable(name, text, options);
  }
  const root = resolve(options.root ?? ".");
  const folder = modelFolder(options, root, lesson);
  // Only listed names are opened, so no separator and no `..` gets into the path.
  if (!readdirSync(folder).includes(`${name}.xml`)) {
    throw new FenceError(`the model \`${name}\` does not exist in the folder \`${relative(root, folder).split(sep).join("/") || "."}\``);
  }
  const file = realpathSync(join(folder, `${name}.xml`));
  const isInside = [root, folder].some((outer) => file.startsWith(`${realpathSync(outer).replace(/[/\\]$/, "")}${sep}`));
  if (!isInside || !statSync(file).isFile()) throw new FenceError(`the model \`${name}\` is outside of the root, or not a file`);
  if (statSync(file).size > MAX_TEXT) throw new FenceError(`the model \`${name}\` is larger than ${MAX_TEXT >> 20} MB`);
  return inlineable(name, readFileSync(file, "utf8"), options);
}

function inlineable(name: string, text: string, { modelsUrl }: ModelOptions): string {
  if (modelsUrl === undefined && FILES.test(text.replace(/<!--[^]*?-->/g, ""))) {
    throw new FenceError(`the model \`${name}\` reads other files, so pages must fetch it: set the address of the folder of models`);
  }
  return text;
}

function modelFolder({ models }: ModelOptions, root: string, lesson: string | null): string {
  if (typeof models === "string") {
    const folder = resolve(root, models);
    if (isFolder(folder)) return folder;
    throw new FenceError(`the folder of models \`${models}\` does not exist`);
  }
  for (let at = lesson === null ? root : dirname(resolve(root, lesson)); ; at = dirname(at)) {
    const folder = join(at, "models");
    if (isFolder(folder)) return folder;
    if (at === root || at === dirname(at)) throw new FenceError("no folder `models` is beside the lesson or above it");
  }
}

function isFolder(path: string): boolean {
  return existsSync(path) && statSync(path).isDirectory();
}
