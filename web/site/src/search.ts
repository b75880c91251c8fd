/** The search of a page: words of titles, headings and texts, in an index that is fetched when somebody searches. */
import { siteFile } from "./files.js";

interface Entry {
  readonly url: string;
  readonly title: string;
  readonly heading: string;
  readonly text: string;
}

const MOST_RESULTS = 12;
/** Characters around the first word that a result shows. */
const AROUND = 70;

const isEntry = (x: unknown): x is Entry => typeof x === "object" && x !== null
  && ["url", "title", "heading", "text"].every((key) => typeof (x as Record<string, unknown>)[key] === "string");

/** Words without marks and accents, in lower case. */
export function wordsOf(text: string): string[] {
  return text.normalize("NFKD").replace(/\p{M}/gu, "").toLowerCase().match(/[\p{L}\p{N}]+/gu) ?? [];
}

/** How well an entry fits: 0 where a word begins nowhere. */
export function rank(entry: Entry, wanted: readonly string[]): number {
  const fields: readonly [string, number][] = [[entry.title, 8], [entry.heading, 6], [entry.text, 1]];
  const words = fields.map(([text, weight]) => [wordsOf(text), weight] as const);
  let sum = 0;
  for (const word of wanted) {
    let best = 0;
    for (const [all, weight] of words) {
      for (const one of all) if (one.startsWith(word)) best = Math.max(best, one === word ? 2 * weight : weight);
    }
    if (best === 0) return 0;
    sum += best;
  }
  return sum;
}

async function fetchIndex(): Promise<readonly Entry[]> {
  const response = await fetch(siteFile("search.json"));
  if (!response.ok) throw new Error(`the index of the search is missing (${response.status})`);
  const index: unknown = await response.json();
  return Array.isArray(index) ? (index as unknown[]).filter(isEntry) : [];
}

/** The text around the first word that was searched for. */
function excerpt(entry: Entry, wanted: readonly string[]): string {
  const lower = entry.text.toLowerCase();
  const found = wanted.map((word) => lower.indexOf(word)).filter((at) => at >= 0);
  const at = found.length > 0 ? Math.min(...found) : 0;
  const [start, end] = [Math.max(0, at - AROUND), at + AROUND];
  return `${start > 0 ? "… " : ""}${entry.text.slice(start, end).trim()}${end < entry.text.length ? " …" : ""}`;
}

function result(entry: Entry, wanted: readonly string[]): HTMLElement {
  const [item, link, where, text] = [document.createElement("li"), document.createElement("a"), document.createElement("small"), document.createElement("p")];
  link.href = siteFile(entry.url).href;
  link.textContent = entry.heading === "" ? entry.title : entry.heading;
  where.textContent = entry.heading === "" || entry.heading === entry.title ? "" : entry.title;
  text.textContent = excerpt(entry, wanted);
  item.append(link, " ", where, text);
  return item;
}

/** Makes the search of a page work. It is not there without this script. */
export function startSearch(): void {
  const form = document.querySelector<HTMLFormElement>("form.search");
  const [input, results] = [form?.querySelector("input"), form?.querySelector<HTMLElement>(".results")];
  if (form === null || !input || !results) return;
  form.hidden = false;
  let index: Promise<readonly Entry[]> | undefined;
  const say = (text: string): void => {
    const line = document.createElement("p");
    line.textContent = text;
    results.replaceChildren(line);
  };
  const update = async (): Promise<void> => {
    const wanted = wordsOf(input.value);
    results.hidden = wanted.length === 0;
    if (wanted.length === 0) return results.replaceChildren();
    try {
      const entries = await (index ??= fetchIndex());
      if (wordsOf(input.value).join(" ") !== wanted.join(" ")) return;
      const ranked = entries.map((entry) => ({ entry, score: rank(entry, wanted) })).filter(({ score }) => score > 0);
      ranked.sort((a, b) => b.score - a.score);
      if (ranked.length === 0) return say("Nothing found.");
      const list = document.createElement("ol");
      list.append(...ranked.slice(0, MOST_RESULTS).map(({ entry }) => result(entry, wanted)));
      results.replaceChildren(list);
    } catch (e) {
      index = undefined;
      say(`The search does not work: ${e instanceof Error ? e.message : String(e)}.`);
    }
  };
  const close = (): void => {
    results.hidden = true;
  };
  input.addEventListener("input", () => void update());
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    results.querySelector("a")?.click();
  });
  form.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    close();
    input.focus();
  });
  results.addEventListener("click", (event) => {
    if (event.target instanceof HTMLAnchorElement) close();
  });
  document.addEventListener("click", (event) => {
    if (event.target instanceof Node && !form.contains(event.target)) close();
  });
}
