/** The events of a lab as sentences: in a live region for screen readers, and in a list. */
import { h, setText } from "../dom.js";
import type { EngineEvent } from "../engine/messages.js";
import type { Say } from "../text/messages.js";
import { formatTime } from "../text/numbers.js";

export interface Spoken {
  /** The last events, as a list. */
  readonly log: HTMLElement;
  /** Says something as soon as it is polite. */
  say(text: string): void;
  /** Reports events, and returns the sentence of each of them; the list and the region have one sentence for many contacts. */
  report(events: readonly EngineEvent[]): readonly string[];
  /** The sentences of the list. */
  readonly sentences: readonly string[];
  /** Forgets the list: the lab is back at its start. */
  clear(): void;
  /** Says nothing more. */
  dispose(): void;
}

/** The shortest time between two messages, ms. */
const PAUSE = 1200;
/** The maximum number of contacts that are reported one by one. */
const MOST_CONTACTS = 4;
const MOST_LISTED = 60;

/** `region` is read aloud, politely. */
export function createSpoken(region: HTMLElement, say: Say): Spoken {
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
    log: details, say: speak,
    report(events) {
      for (const sentence of summarize(events, say)) {
        speak(sentence);
        list.append(h("li", {}, sentence));
      }
      while (list.childElementCount > MOST_LISTED) list.firstElementChild?.remove();
      details.hidden = list.childElementCount === 0;
      return events.map((event) => describeEvent(event, say));
    },
    get sentences() { return [...list.children].map((item) => item.textContent ?? ""); },
    clear() {
      list.replaceChildren();
      details.hidden = true;
    },
    dispose: () => clearTimeout(timer),
  };
}

/** Events as sentences; many contacts at once as one. */
export function summarize(events: readonly EngineEvent[], say: Say): string[] {
  const contacts = events.filter((event) => event.type === "contact");
  if (contacts.length <= MOST_CONTACTS) return events.map((event) => describeEvent(event, say));
  const [first, last] = [contacts[0]?.time ?? 0, contacts[contacts.length - 1]?.time ?? 0];
  const others = events.filter((event) => event.type !== "contact").map((event) => describeEvent(event, say));
  return [say("manyContacts", { count: contacts.length, from: formatTime(first), to: formatTime(last) }), ...others];
}

/** An event as a sentence. */
export function describeEvent(event: EngineEvent, say: Say): string {
  const time = formatTime(event.time);
  switch (event.type) {
    case "contact": return capital(say(event.touching ? "touches" : "parts", { ...ordered(event.first, event.second), time }));
    case "stop": return say("stopped", { time });
    case "restart": return say("diverged", { time });
    case "finding": return event.finding.message;
  }
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
