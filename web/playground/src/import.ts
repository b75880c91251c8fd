/** Files that a reader drops or chooses: models, meshes, textures, labs, lessons, and archives of them. */
import { unzipSync } from "fflate";
import { isFileName, labOfModel, LAB_PATH, listedModels, OpenError, readObject, type Project } from "./project.js";

/** Files and bytes of one project. */
const MOST_FILES = 500;
const MOST_BYTES = 64 << 20;

/** A file with its path in the folder that was chosen. */
export interface GivenFile {
  readonly path: string;
  readonly bytes: Uint8Array;
}

/** The labs of a lesson, as the checker finds them. */
export type FindLabs = (path: string, text: string) => Promise<readonly { readonly json: string; readonly model: string | null }[]>;

/** The files of a drop, of folders as well. */
export async function filesOfDrop(transfer: DataTransfer): Promise<GivenFile[]> {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
  if (entries.length === 0) return readFiles([...transfer.files].map((file) => [file.name, file]));
  const found: [string, File][] = [];
  const waiting: FileSystemEntry[] = [...entries];
  for (const entry of waiting) {
    if (found.length > MOST_FILES || waiting.length > 10 * MOST_FILES) throw tooMany();
    if (entry.isDirectory) waiting.push(...(await childrenOf(entry as FileSystemDirectoryEntry)));
    else found.push([entry.fullPath.replace(/^\//, ""), await fileOf(entry as FileSystemFileEntry)]);
  }
  return readFiles(found);
}

/** The files of an `<input type="file">`. */
export function filesOfInput(list: FileList): Promise<GivenFile[]> {
  return readFiles([...list].map((file) => [file.webkitRelativePath === "" ? file.name : file.webkitRelativePath, file]));
}

const tooMany = (): OpenError => new OpenError(`These are more than ${MOST_FILES} files.`);
const tooLarge = (): OpenError => new OpenError(`These files are larger than ${MOST_BYTES >> 20} MB together.`);

async function readFiles(files: readonly (readonly [string, File])[]): Promise<GivenFile[]> {
  const wanted = files.filter(([path]) => !path.split("/").some((part) => part.startsWith(".")));
  if (wanted.length > MOST_FILES) throw tooMany();
  if (wanted.reduce((sum, [, file]) => sum + file.size, 0) > MOST_BYTES) throw tooLarge();
  return Promise.all(wanted.map(async ([path, file]) => ({ path, bytes: new Uint8Array(await file.arrayBuffer()) })));
}

function childrenOf(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const all: FileSystemEntry[] = [];
  return new Promise((resolve, reject) => {
    const more = (): void => reader.readEntries((some) => {
      all.push(...some);
      // A reader gives a hundred at a time.
      if (some.length === 0 || all.length > MOST_FILES) resolve(all);
      else more();
    }, reject);
    more();
  });
}

function fileOf(entry: FileSystemFileEntry): Promise<File> {
  return new Promise((resolve, reject) => entry.file(resolve, reject));
}

/** The files of an archive, which is never larger than it says. */
export function unpack(bytes: Uint8Array): GivenFile[] {
  let [count, size] = [0, 0];
  let unpacked: Record<string, Uint8Array>;
  try {
    unpacked = unzipSync(bytes, {
      filter({ name, originalSize }) {
        if (name.endsWith("/")) return false;
        count += 1;
        size += originalSize;
        if (count > MOST_FILES) throw tooMany();
        if (size > MOST_BYTES) throw tooLarge();
        return true;
      },
    });
  } catch (e) {
    throw e instanceof OpenError ? e : new OpenError(`The archive cannot be read: ${e instanceof Error ? e.message : String(e)}.`);
  }
  return Object.entries(unpacked).map(([path, content]) => ({ path, bytes: content }));
}

/** A project of some files. Files with the same path replace those of `current` where no lab is among them. */
export async function projectOf(given: readonly GivenFile[], current: Project | null, findLabs: FindLabs): Promise<Project> {
  const files = given.flatMap((file) => (/\.(zip|mjz)$/i.test(file.path) ? unpack(file.bytes) : [file]));
  if (files.length > MOST_FILES) throw tooMany();
  const usable = files.filter(({ path }) => isFileName(path) && !path.split("/").some((part) => part.startsWith(".")));
  if (usable.length === 0) throw new OpenError("There is no file that a lab can use.");
  const texts = new Map(usable.filter(({ path }) => /\.(xml|json|md|markdown)$/i.test(path)).map(({ path, bytes }) => [path, textOf(path, bytes)]));
  const lab = await labAmong(texts, findLabs);
  const models = [...texts.keys()].filter((path) => /\.xml$/i.test(path));
  if (lab === null && models.length === 0) return withFiles(usable, current);
  const main = mainModel(models, texts, lab?.model ?? null);
  const listed = lab?.listed ?? {};
  const folder = main?.replace(/[^/]*$/, "") ?? "";
  const inside = (path: string): string => (path.startsWith(folder) ? path.slice(folder.length) : path);
  const own = Object.fromEntries(models.map((path) => [nameOf(inside(path)), texts.get(path) ?? ""]));
  const others = usable.filter(({ path }) => !texts.has(path)).map(({ path, bytes }) => [inside(path), bytes] as const);
  const name = main === null ? (Object.keys(listed)[0] ?? null) : nameOf(inside(main));
  return { lab: lab?.json ?? labOfModel(name ?? "model"), models: { ...listed, ...own }, files: Object.fromEntries(others), model: name, lesson: null };
}

/** The name of a model: those in folders keep their paths, which only other models name. */
function nameOf(path: string): string {
  return path.includes("/") ? path : path.replace(/\.xml$/i, "");
}

function textOf(path: string, bytes: Uint8Array): string {
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    throw new OpenError(`${path} is not text in UTF-8.`);
  }
}

interface FoundLab {
  readonly json: string;
  readonly model: string | null;
  /** Models that the lesson lists. */
  readonly listed: Readonly<Record<string, string>>;
}

/** The first lab among texts: of a JSON file, else of a lesson. */
async function labAmong(texts: ReadonlyMap<string, string>, findLabs: FindLabs): Promise<FoundLab | null> {
  for (const [path, text] of texts) {
    const json = path.endsWith(".json") ? readObject(text) : null;
    if (json === null || (json["model"] === undefined && json["xml"] === undefined)) continue;
    return { json: text, model: typeof json["model"] === "string" ? json["model"] : null, listed: {} };
  }
  for (const [path, text] of texts) {
    if (!/\.(md|markdown)$/i.test(path)) continue;
    const [first] = await findLabs("lesson.md", text);
    if (first !== undefined) return { json: first.json, model: first.model, listed: listedModels(text) };
  }
  return null;
}

/** The model that a lab names; else the one that no other includes, nearest to the top. */
function mainModel(paths: readonly string[], texts: ReadonlyMap<string, string>, named: string | null): string | null {
  const byName = paths.find((path) => named !== null && (path === `${named}.xml` || path.endsWith(`/${named}.xml`)));
  if (byName !== undefined) return byName;
  const included = [...texts.values()].flatMap((text) => [...text.matchAll(/<include\s[^>]*file\s*=\s*["']([^"']+)["']/g)].map(([, file]) => file ?? ""));
  const free = paths.filter((path) => !included.some((file) => path === file || path.endsWith(`/${file}`)));
  const depth = (path: string): number => path.split("/").length;
  return [...(free.length > 0 ? free : paths)].sort((a, b) => depth(a) - depth(b) || a.localeCompare(b, "en"))[0] ?? null;
}

/** Meshes and textures alone belong to what is open. */
function withFiles(files: readonly GivenFile[], current: Project | null): Project {
  if (current === null) throw new OpenError("There is no model and no lab among these files.");
  const added = files.filter(({ path }) => path !== LAB_PATH).map(({ path, bytes }) => [path.split("/").at(-1) ?? path, bytes] as const);
  return { ...current, files: { ...current.files, ...Object.fromEntries(added) } };
}
