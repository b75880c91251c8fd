/** Texts in the language of an element. */
import { german } from "./de.js";
import { english, type MessageName, type Messages } from "./en.js";

const LANGUAGES: Record<string, Messages> = { en: english, de: german };

/** Adds a language, or replaces one: a page calls it before its elements are shown. */
export function addLanguage(code: string, messages: Partial<Messages>): void {
  LANGUAGES[code.toLowerCase()] = { ...english, ...messages };
}

/** A text of an element's language, with values for its names. */
export type Say = (name: MessageName, values?: Readonly<Record<string, string | number>>) => string;

/** The language of an element: its own `lang`, or that of an ancestor; English where there is none. */
export function messagesFor(element: Element): Say {
  const code = languageOf(element);
  const messages = LANGUAGES[code] ?? LANGUAGES[code.split("-")[0] ?? ""] ?? english;
  return (name, values = {}) => messages[name].replace(/\{(\w+)\}/g, (whole, key: string) => String(values[key] ?? whole));
}

function languageOf(element: Element): string {
  for (let at: Node | null = element; at !== null; at = at.parentNode ?? (at instanceof ShadowRoot ? at.host : null)) {
    const lang = at instanceof Element ? at.getAttribute("lang") : null;
    if (lang !== null && lang !== "") return lang.toLowerCase();
  }
  return "en";
}
