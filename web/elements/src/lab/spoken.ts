/** The events of a lab as sentences: in a live region for screen readers, and in a list. */
import { h, setText } from "../dom.js";
import type { EngineEvent } from "../engine/messages.js";
import type { Say } from "../text/messages.js";
import { formatTime } from "../text/numbers.js";

export interface Spoken {
  /** Read aloud, politely. */
  readonly region: HTMLElement;
  /** The last events, as a list. */
  readonly log: HTMLElement;
  /** Says something as soon as it is polite. */
  say(text: string): void;
  /** Reports events, and returns their sentences. */
  report(events: readonly EngineEvent[]): readonly string[];
  /** The sentences of the list. */
  readonly sentences: readonly string[];
  /** Forgets the list: the lab is back at its start. */
  clear(): void;
}

/** The shortest time between two messages, ms. */
const PAUSE = 1200;
/** The maximum number of contacts that are reported one by one. */
const MOST_CONTACTS = 4;
const MOST_LISTED = 60;

export function createSpoken(say: Say): Spoken {
  const region = h("p", { class: "hidden", role: "status", "aria-live": "polite", part: "status" });
  const list = h("ol", { class: "event-list" });
  const details = h("details", { class: "events", part: "events" }, h("summary", {}, say("events")), list);
  details.hidden = true;
  let waiting: string[] = [];
  let [timer, last]: [ReturnType<typeof setTimeout> | undefined, number] = [undefined, -Infinity];
  const flush = (): void => {
    timer = undefined;
    last = performance.now();
    setText(region, waiting.join(" "));
    waiting = [];
  };
  const speak = (text: string): void => {
    waiting = [...waiting, text].slice(-6);
    timer ??= setTimeout(flush, Math.max(0, PAUSE - (performance.now() - last)));
  };
  return {
    region, log: details, say: speak,
    report(events) {
      const sentences = describeEvents(events, say);
      for (const sentence of sentences) {
        speak(sentence);
        list.append(h("li", {}, sentence));
      }
      while (list.childElementCount > MOST_LISTED) list.firstElementChild?.remove();
      details.hidden = list.childElementCount === 0;
      return sentences;
    },
    get sentences() { return [...list.children].map((item) => item.textContent ?? ""); },
    clear() {
      list.replaceChildren();
      details.hidden = true;
    },
  };
}

/** Events as sentences; many contacts at once as one. */
export function describeEvents(events: readonly EngineEvent[], say: Say): string[] {
  const contacts = events.filter((event) => event.type === "contact");
  const out: string[] = [];
  if (contacts.length > MOST_CONTACTS) {
    const [first, last] = [contacts[0]?.time ?? 0, contacts[contacts.length - 1]?.time ?? 0];
    out.push(say("manyContacts", { count: contacts.length, from: formatTime(first), to: formatTime(last) }));
  }
  for (const event of events) {
    const time = formatTime(event.time);
    if (event.type === "contact" && contacts.length <= MOST_CONTACTS) {
      out.push(capital(say(event.touching ? "touches" : "parts", { ...ordered(event.first, event.second), time })));
    } else if (event.type === "stop") out.push(say("stopped", { time }));
    else if (event.type === "restart") out.push(say("diverged", { time }));
    else if (event.type === "finding") out.push(event.finding.message);
  }
  return out;
}

/** Orders two names: the floor, a wall or a table is the second one. */
function ordered(first: string, second: string): { first: string; second: string } {
  const ground = /floor|ground|plane|table|wall|boden|tisch|ramp|slope/i;
  const swap = ground.test(first) && !ground.test(second);
  const plain = (name: string): string => name.replaceAll("_", " ");
  return swap ? { first: plain(second), second: plain(first) } : { first: plain(first), second: plain(second) };
}

function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
