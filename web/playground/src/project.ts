/** What is open in the playground: a lab, its models and their files. */
import type { LabOfLesson } from "labspec-editor";
import type { Models } from "labspec/slim";

/** The labs of a lesson, as the checker finds them. */
export type FindLabs = (path: string, text: string) => Promise<readonly LabOfLesson[]>;

export interface Project {
  /** The JSON of the lab. */
  readonly lab: string;
  /** MJCF by name, without `.xml` for those that a lab can name. */
  readonly models: Readonly<Record<string, string>>;
  /** Meshes, textures and other files, by path. */
  readonly files: Readonly<Record<string, Uint8Array>>;
  /** The model that is edited; `null` if there is none. */
  readonly model: string | null;
  /** The lesson that has the lab, and quotes its numbers; `null` for a lab alone. */
  readonly lesson: LessonAround | null;
}

/** A lesson without one of its labs. */
export interface LessonAround {
  readonly path: string;
  readonly address: string;
  readonly before: string;
  readonly after: string;
}

/** The lesson around one of its labs; `null` if the lab is not a part of its text as it stands there. */
export function lessonAround(path: string, text: string, lab: LabOfLesson): LessonAround | null {
  const isWhole = /\.json$/i.test(path) || text.slice(lab.start, lab.end) !== lab.json;
  return isWhole ? null : { path, address: lab.address, before: text.slice(0, lab.start), after: text.slice(lab.end) };
}

/** Why something cannot be opened: a sentence for readers. */
export class OpenError extends Error {}

/** The names under which the parts of a lesson know them. */
export const LAB_PATH = "lab.json";
export const modelPath = (name: string): string => (name.endsWith(".xml") ? name : `${name}.xml`);

/** What the engine and the checker take. */
export function modelsOf(project: Project): Models {
  return { ...project.files, ...project.models };
}

const MOST_NAME = 200;

/** Whether a name of a file stays inside of its folder. */
export function isFileName(name: string): boolean {
  const isPlain = name.length > 0 && name.length <= MOST_NAME && !/[\u0000-\u001f\u007f\\]/.test(name);
  return isPlain && name.split("/").every((part) => part !== "" && part !== "." && part !== "..");
}

/** A lab that only shows a model. */
export function labOfModel(name: string): string {
  return `${JSON.stringify({ title: name, model: name, controls: [], plots: [], readouts: [{ label: "time (s)", expr: "data.time" }] }, null, 2)}\n`;
}

/** The title of a lab; its own name where it has none or cannot be read. */
export function titleOf(lab: string): string {
  const json = readObject(lab);
  return typeof json?.["title"] === "string" && json["title"] !== "" ? json["title"] : "Lab";
}

export function readObject(text: string): Readonly<Record<string, unknown>> | null {
  try {
    const json: unknown = JSON.parse(text);
    return typeof json === "object" && json !== null && !Array.isArray(json) ? (json as Readonly<Record<string, unknown>>) : null;
  } catch {
    return null;
  }
}

/** The lab as a lesson: the lab in a fence, and each model in a listing. */
export function lessonOf(project: Project): string {
  const fence = (text: string): string => "`".repeat(Math.max(3, ...[...text.matchAll(/`+/g)].map(([run]) => run.length + 1)));
  const block = (info: string, text: string): string => {
    const marks = fence(text);
    return `${marks}${info}\n${text.replace(/\n$/, "")}\n${marks}\n`;
  };
  const title = titleOf(project.lab).replaceAll(/\s+/g, " ");
  const listings = Object.entries(project.models).map(([name, xml]) => block(`xml file=models/${encodeURI(modelPath(name))}`, xml));
  return [`# ${title}\n`, block("lab simlab", project.lab), ...listings].join("\n");
}

/** The models that a lesson of the playground lists. */
export function listedModels(lesson: string): Record<string, string> {
  const listings = lesson.matchAll(/^(`{3,})xml file=models\/(\S+)\n([^]*?\n)\1[ \t]*$/gm);
  const pairs = [...listings].map(([, , path, xml]): [string, string] => [decoded(path ?? ""), xml ?? ""]);
  return Object.fromEntries(pairs.filter(([path]) => isFileName(path)).map(([path, xml]) => [path.replace(/\.xml$/, ""), xml]));
}

function decoded(path: string): string {
  try {
    return decodeURI(path);
  } catch {
    return path;
  }
}
