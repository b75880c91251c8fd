/** Files that a reader drops or chooses: models, meshes, textures, labs, lessons, and archives of them. */
import { unzipSync } from "fflate";
import { isFileName, labOfModel, LAB_PATH, lessonAround, listedModels, OpenError, readObject, titleOf, type FindLabs, type LessonAround, type Project } from "./project.js";

/** Files and bytes of one project. */
const MOST_FILES = 500;
const MOST_BYTES = 64 << 20;

/** A file with its path in the folder that was chosen. */
export interface GivenFile {
  readonly path: string;
  readonly bytes: Uint8Array;
}

/** A lab among files that a reader has given. */
export interface GivenLab {
  /** `LESSON.md#1`, `LESSON.md#quiz-id.1` or `LAB.json`. */
  readonly place: string;
  readonly title: string;
}

/** What was opened: one of the labs among the files, and all of them. */
export interface OpenedFiles {
  readonly project: Project;
  readonly labs: readonly GivenLab[];
  /** The place of the lab that is open; `null` where no file has a lab. */
  readonly place: string | null;
}

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

/**
 * A project of some files, with the lab at `place`, or the first one. Files with the same path replace those of `current` where no lab is
 * among them.
 */
export async function openGiven(given: readonly GivenFile[], current: Project | null, findLabs: FindLabs, place: string | null = null): Promise<OpenedFiles> {
  const files = given.flatMap((file) => (/\.(zip|mjz)$/i.test(file.path) ? unpack(file.bytes) : [file]));
  if (files.length > MOST_FILES) throw tooMany();
  const usable = files.filter(({ path }) => isFileName(path) && !path.split("/").some((part) => part.startsWith(".")));
  if (usable.length === 0) throw new OpenError("There is no file that a lab can use.");
  const texts = new Map(usable.filter(({ path }) => /\.(xml|json|md|markdown)$/i.test(path)).map(({ path, bytes }) => [path, textOf(path, bytes)]));
  const labs = await labsAmong(texts, findLabs);
  const lab = labs.find((one) => one.place === place) ?? labs[0] ?? null;
  const models = [...texts.keys()].filter((path) => /\.xml$/i.test(path));
  if (lab === null && models.length === 0) return { project: withFiles(usable, current), labs: [], place: null };
  return { project: projectOfLab(lab, usable, texts, models), labs: labs.map(({ place: at, title }) => ({ place: at, title })), place: lab?.place ?? null };
}

/** The project of a lab, or of a model alone, with all files around it. */
function projectOfLab(lab: FoundLab | null, usable: readonly GivenFile[], texts: ReadonlyMap<string, string>, models: readonly string[]): Project {
  const main = mainModel(models, texts, lab?.model ?? null);
  const listed = lab?.listed ?? {};
  const folder = main?.replace(/[^/]*$/, "") ?? "";
  const inside = (path: string): string => (path.startsWith(folder) ? path.slice(folder.length) : path);
  const own = Object.fromEntries(models.map((path) => [nameOf(inside(path)), texts.get(path) ?? ""]));
  const others = usable.filter(({ path }) => !texts.has(path)).map(({ path, bytes }) => [inside(path), bytes] as const);
  const known: Record<string, string> = { ...listed, ...own };
  const named = main === null ? (lab?.model ?? "") : nameOf(inside(main));
  const model = known[named] === undefined ? (Object.keys(listed)[0] ?? null) : named;
  return { lab: lab?.json ?? labOfModel(model ?? "model"), models: known, files: Object.fromEntries(others), model, lesson: lab?.lesson ?? null };
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

interface FoundLab extends GivenLab {
  readonly json: string;
  readonly model: string | null;
  /** Models that the lesson lists. */
  readonly listed: Readonly<Record<string, string>>;
  readonly lesson: LessonAround | null;
}

/** The labs among texts: of JSON files, then of lessons, where those of questions come after the others. */
async function labsAmong(texts: ReadonlyMap<string, string>, findLabs: FindLabs): Promise<FoundLab[]> {
  const found: FoundLab[] = [];
  for (const [path, text] of texts) {
    const json = path.endsWith(".json") ? readObject(text) : null;
    if (json === null || (json["model"] === undefined && json["xml"] === undefined)) continue;
    const model = typeof json["model"] === "string" ? json["model"] : null;
    found.push({ place: path, title: titleOf(text), json: text, model, listed: {}, lesson: null });
  }
  for (const [path, text] of texts) {
    if (!/\.(md|markdown)$/i.test(path)) continue;
    const listed = listedModels(text);
    for (const lab of await findLabs("lesson.md", text)) {
      found.push({ place: `${path}${lab.address}`, title: lab.title, json: lab.json, model: lab.model, listed, lesson: lessonAround("lesson.md", text, lab) });
    }
  }
  return found;
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
