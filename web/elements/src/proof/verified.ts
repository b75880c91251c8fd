/** What a site builder says of a lab or a quiz that it has checked: how many claims hold, by which version, and for which content. */
import type { Models } from "labspec/slim";
import { sha256 } from "../quiz/hash.js";
import { isObject, numberOf, textOf, type Json } from "../spec.js";

/** The attribute `verified`. */
export interface Verified {
  /** Claims that are true. */
  readonly claims: number;
  /** The version of labspec that checked them. */
  readonly version: string;
  /** `contentHash` of what was checked. */
  readonly hash: string;
}

/** Reads the attribute; null where there is none, or where it is damaged. */
export function readVerified(text: string | null): Verified | null {
  if (text === null || text.length > 10_000) return null;
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch {
    return null;
  }
  if (!isObject(json)) return null;
  const [claims, version, hash] = [numberOf(json["claims"]), textOf(json["version"]), textOf(json["hash"])];
  const isRead = claims !== null && Number.isInteger(claims) && claims > 0 && version !== null && version.length <= 100 && hash !== null && /^[0-9a-f]{64}$/.test(hash);
  return isRead ? { claims, version, hash } : null;
}

/** The names of models in a content: the values of all keys `model`. */
function namedModels(content: unknown): string[] {
  if (Array.isArray(content)) return content.flatMap(namedModels);
  if (!isObject(content)) return [];
  return Object.entries(content).flatMap(([key, value]) => (key === "model" && typeof value === "string" ? [value] : namedModels(value)));
}

/** The models that a content names, and the files that their texts name, sorted. A page may have other models too. */
function usedModels(content: object, models: Models): string[] {
  const used = new Set<string>();
  const waiting = namedModels(content).filter((name) => Object.hasOwn(models, name));
  for (const name of waiting) {
    if (used.has(name)) continue;
    used.add(name);
    const text = models[name];
    if (typeof text !== "string") continue;
    waiting.push(...Object.keys(models).filter((path) => !used.has(path) && text.includes(path.slice(path.lastIndexOf("/") + 1))));
  }
  return [...used].sort();
}

/**
 * The SHA-256 of a lab or a quiz and the models that it names. It does not depend on spaces in the JSON, on the order of the models, or on
 * other models of the page.
 */
export function contentHash(content: object, models: Models = {}): string {
  const decoder = new TextDecoder("latin1");
  const texts = usedModels(content, models).map((name) => {
    const model = models[name] ?? "";
    return `${name}\n${typeof model === "string" ? model : decoder.decode(model)}`;
  });
  return sha256([JSON.stringify(content), ...texts].join("\n"));
}

/** A claim of a check. */
interface Entry {
  readonly subject: string;
  readonly state: string;
  readonly remark: string;
}

/** The module `labspec/checker`, as far as it is used. */
interface CheckerModule {
  readonly Checker: new (models: Models) => { check(path: string, lesson: string): { readonly entries: readonly Entry[] } };
}

/** Subjects of entries that are claims of an author. */
const CLAIMS = ["answer", "quoted number", "closed form", "run"];

/** What a second check finds. */
export interface Again {
  readonly right: number;
  /** Claims that are false or could not be checked, with the reasons. */
  readonly wrong: readonly string[];
}

/** Checks the claims of a lab or a quiz again, with the module at an address. */
export async function checkAgain(address: string, content: Json, models: Models): Promise<Again> {
  const { Checker } = (await import(new URL(address, document.baseURI).href)) as CheckerModule;
  const { entries } = new Checker(models).check("content.json", JSON.stringify(content));
  const claims = entries.filter(({ subject, state }) => CLAIMS.includes(subject) && state !== "not claimed");
  const wrong = claims.filter(({ state }) => state !== "true");
  return { right: claims.length - wrong.length, wrong: wrong.map(({ subject, state, remark }) => (remark === "" ? `${subject}: ${state}` : remark)) };
}
