/** A project as text of a link: in the fragment, which no server sees. What comes from outside is checked. */
import { collect, fromAddressBase64, streamOf, toAddressBase64 } from "labspec-elements/bytes";
import { isFileName, OpenError, type Project } from "./project.js";

/** The form of links that this page writes. */
const VERSION = 1;
/** Characters of a link, and bytes of what is in it. */
export const MOST_CHARACTERS = 60_000;
const MOST_BYTES = 4 << 20;
const MOST_FILES = 100;

/** A project as a fragment; `null` if it is too long for a link. */
export async function encodeProject(project: Project): Promise<string | null> {
  const { lab, model, models } = project;
  const size = Object.values(project.files).reduce((sum, bytes) => sum + bytes.length, 0);
  if (size > MOST_CHARACTERS) return null;
  const files = Object.fromEntries(Object.entries(project.files).map(([path, bytes]) => [path, toAddressBase64(bytes)]));
  const bytes = new TextEncoder().encode(JSON.stringify({ lab, model, models, files }));
  if (bytes.length > MOST_BYTES) return null;
  const packed = await collect(streamOf(bytes).pipeThrough(new CompressionStream("deflate-raw")), MOST_CHARACTERS);
  const fragment = packed === null ? null : `#play${VERSION}=${toAddressBase64(packed)}`;
  return fragment === null || fragment.length > MOST_CHARACTERS ? null : fragment;
}

/** The project of a fragment; `null` if there is none in it. */
export async function decodeProject(fragment: string): Promise<Project | null> {
  const found = /(?:^#?|&)play(\d{1,6})=([^&]*)/.exec(fragment);
  if (found === null) return null;
  const version = Number(found[1]);
  if (version !== VERSION) {
    const age = version > VERSION ? "a newer" : "an older";
    throw new OpenError(`This link was made by ${age} version of the playground (format ${version}; this page reads format ${VERSION}).`);
  }
  const text = found[2] ?? "";
  if (text.length > MOST_CHARACTERS) throw new OpenError(`This link is longer than ${MOST_CHARACTERS} characters, so it was not opened.`);
  const packed = fromAddressBase64(text);
  if (packed === null || packed.length === 0) throw damaged("it contains invalid characters, or is incomplete");
  return readProject(await inflated(packed));
}

const damaged = (why: string): OpenError => new OpenError(`This link is damaged: ${why}.`);

async function inflated(packed: Uint8Array): Promise<string> {
  let bytes: Uint8Array | null;
  try {
    bytes = await collect(streamOf(packed).pipeThrough(new DecompressionStream("deflate-raw")), MOST_BYTES);
  } catch {
    throw damaged("it cannot be unpacked, so a part of it is missing or was changed");
  }
  if (bytes === null) throw new OpenError(`What this link holds is larger than ${MOST_BYTES >> 20} MB, so it was not opened.`);
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    throw damaged("it does not hold text");
  }
}

function readProject(text: string): Project {
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch {
    throw damaged("it does not hold JSON");
  }
  if (!isObject(json)) throw damaged("it does not hold a project");
  const { lab, model, models, files } = json as { lab?: unknown; model?: unknown; models?: unknown; files?: unknown };
  if (typeof lab !== "string" || !isObject(models) || !isObject(files)) throw damaged("its lab or its models are missing");
  const names = [...Object.keys(models), ...Object.keys(files)];
  if (names.length > MOST_FILES) throw new OpenError(`This link holds more than ${MOST_FILES} files, so it was not opened.`);
  if (!names.every(isFileName)) throw damaged("a file in it has a name that is not allowed");
  const texts = Object.entries(models).map(([name, xml]): [string, string] => {
    if (typeof xml !== "string") throw damaged("a model in it is not text");
    return [name, xml];
  });
  const binaries = Object.entries(files).map(([name, content]): [string, Uint8Array] => {
    const bytes = typeof content === "string" ? fromAddressBase64(content) : null;
    if (bytes === null) throw damaged("a file in it cannot be read");
    return [name, bytes];
  });
  const edited = typeof model === "string" && Object.hasOwn(models, model) ? model : (texts[0]?.[0] ?? null);
  return { lab, models: Object.fromEntries(texts), files: Object.fromEntries(binaries), model: edited, lesson: null };
}

function isObject(x: unknown): x is object {
  return typeof x === "object" && x !== null && !Array.isArray(x);
}
