/** Labs of a course that is beside the page: lessons, and models in a folder `models`. */
import { fetchModel } from "labspec-elements";
import type { LabOfLesson } from "labspec-editor";
import { isFileName, lessonAround, OpenError, type FindLabs, type LessonAround, type Project } from "./project.js";

/** A lesson of the course with its labs, as the build lists them. */
export interface ListedLesson {
  readonly path: string;
  readonly title: string;
  readonly labs: readonly { readonly address: string; readonly title: string }[];
}

export class Course {
  readonly #folder: string;

  /** `folder` is an address relative to the page. */
  constructor(folder: string) {
    this.#folder = folder;
  }

  /** All lessons that have labs. */
  async list(): Promise<readonly ListedLesson[]> {
    const response = await this.#fetch("index.json");
    const list: unknown = await response.json().catch(() => null);
    if (!Array.isArray(list)) throw new OpenError("The list of lessons cannot be read.");
    return (list as unknown[]).filter(isListed);
  }

  /** Opens a lab by its place: `LESSON.md#1`. */
  async open(place: string, findLabs: FindLabs): Promise<Project> {
    const { lab, lesson, path } = await this.#find(place, findLabs);
    if (lab.model === null) return { lab: lab.json, models: {}, files: {}, model: null, lesson };
    if (!isFileName(lab.model)) throw new OpenError(`The lab names no model: “${shorten(lab.model)}”.`);
    const found = await this.#model(path, lab.model);
    const entries = Object.entries(found);
    const models = entries.filter((pair): pair is [string, string] => typeof pair[1] === "string");
    const files = entries.filter((pair): pair is [string, Uint8Array] => typeof pair[1] !== "string");
    return { lab: lab.json, models: Object.fromEntries(models), files: Object.fromEntries(files), model: lab.model, lesson };
  }

  /** The lesson around the lab at a place; `null` if the lab is not a part of its text as it stands there. */
  async around(place: string, findLabs: FindLabs): Promise<LessonAround | null> {
    return (await this.#find(place, findLabs)).lesson;
  }

  async #find(place: string, findLabs: FindLabs): Promise<{ lab: LabOfLesson; lesson: LessonAround | null; path: string }> {
    const [, path = "", address = ""] = /^([^#]*)(#.*)?$/.exec(place) ?? [];
    if (!isFileName(path) || !/\.(md|markdown|json)$/i.test(path)) throw new OpenError(`“${shorten(place)}” is not the address of a lab: write LESSON.md#1.`);
    const text = await (await this.#fetch(path)).text();
    const labs = await findLabs(path, text);
    const lab = labs.find((one) => one.address === (address === "" ? "#1" : address));
    if (lab === undefined) {
      const has = labs.length === 0 ? "it has none" : `it has ${labs.map((one) => one.address).join(", ")}`;
      throw new OpenError(`${path} has no lab ${shorten(address === "" ? "#1" : address)}; ${has}.`);
    }
    return { lab, lesson: lessonAround(path, text, lab), path };
  }

  /** A model and its files, from the nearest folder `models` beside the lesson or above it. */
  async #model(lesson: string, name: string): Promise<Record<string, string | Uint8Array>> {
    const above = lesson.split("/").slice(0, -1);
    for (let depth = above.length; ; depth--) {
      const folder = [...above.slice(0, depth), "models", ""].join("/");
      try {
        return await fetchModel(name, (path) => this.#fetch(`${folder}${path}`));
      } catch (e) {
        if (depth === 0) throw e;
      }
    }
  }

  async #fetch(path: string): Promise<Response> {
    const address = new URL(path.split("/").map(encodeURIComponent).join("/"), new URL(this.#folder, document.baseURI));
    const response = await fetch(address).catch(() => null);
    if (response === null || !response.ok) throw new OpenError(`${path} is not in the course${response === null ? "" : ` (${response.status})`}.`);
    return response;
  }
}

function isListed(x: unknown): x is ListedLesson {
  const lesson = x as Partial<ListedLesson> | null;
  return typeof lesson === "object" && lesson !== null && typeof lesson.path === "string" && typeof lesson.title === "string" && Array.isArray(lesson.labs);
}

function shorten(text: string): string {
  return text.length > 80 ? `${text.slice(0, 80)}…` : text;
}
