/** The bar below the picture: play, step, reset, speed, and a menu. */
import { h, icon, setText, uniqueId, type IconName } from "../dom.js";
import type { Say } from "../text/messages.js";
import { formatBrief } from "../text/numbers.js";

export interface Toolbar {
  readonly element: HTMLElement;
  readonly play: HTMLButtonElement;
  showPlaying(isPlaying: boolean): void;
  showTime(time: number): void;
  /** Shows the actual speed, if it is lower than the selected one. */
  showSlow(speed: number | null): void;
}

export interface ToolbarActions {
  toggle(): void;
  step(): void;
  stepMore(): void;
  reset(): void;
  speed(speed: number): void;
  copyLink(): void;
  saveState(): void;
  openState(file: File): void;
  savePicture(): void;
}

export interface ToolbarOptions {
  readonly speeds: readonly number[];
  /** s; `null` while it is not known. */
  readonly timestep: number | null;
  /** Whether larger steps get a button: for readers who want no motion. */
  readonly hasLargeSteps: boolean;
  readonly hasPicture: boolean;
  /** The first item of the menu. */
  readonly first: HTMLElement | null;
}

export function createToolbar(options: ToolbarOptions, say: Say, actions: ToolbarActions): Toolbar {
  const playText = h("span", {}, say("play"));
  const play = h("button", { type: "button", class: "primary", part: "play" }, playText);
  play.prepend(icon("play"));
  play.addEventListener("click", actions.toggle);
  const button = (name: IconName, text: string, act: () => void, title?: string): HTMLButtonElement => {
    const element = h("button", { type: "button", class: "tool", title }, icon(name), h("span", {}, text));
    element.addEventListener("click", act);
    return element;
  };
  const time = h("output", { class: "clock", "aria-live": "off", "aria-label": say("time") }, "\u00a0");
  const slow = h("span", { class: "slow", role: "note" });
  slow.hidden = true;
  const element = h("div", { class: "toolbar", part: "toolbar", role: "group", "aria-label": say("playback") },
    play,
    button("step", say("step"), actions.step, options.timestep === null ? undefined : say("stepHint", { timestep: formatBrief(options.timestep) })),
    options.hasLargeSteps && button("step", say("stepMore"), actions.stepMore),
    button("reset", say("reset"), actions.reset),
    createSpeeds(options.speeds, say, actions),
    time,
    createMenu(options, say, actions),
    slow,
  );
  return {
    element, play,
    showPlaying(isPlaying) {
      setText(playText, say(isPlaying ? "pause" : "play"));
      play.querySelector("svg")?.replaceWith(icon(isPlaying ? "pause" : "play"));
    },
    showTime: (now) => setText(time, say("timeValue", { time: now.toFixed(2) })),
    showSlow(speed) {
      slow.hidden = speed === null;
      if (speed !== null) setText(slow, say("slower", { speed: speed.toFixed(speed < 0.1 ? 3 : 2) }));
    },
  };
}

function createSpeeds(speeds: readonly number[], say: Say, actions: ToolbarActions): HTMLElement | null {
  if (speeds.length < 2) return null;
  const id = uniqueId();
  const start = speeds.includes(1) ? 1 : (speeds[0] ?? 1);
  const select = h("select", { id, class: "speed" }, ...speeds.map((speed) => {
    const option = h("option", { value: speed, "aria-label": say("speedValue", { speed }) }, `\u2066${formatBrief(speed)}×\u2069`);
    option.selected = speed === start;
    return option;
  }));
  select.addEventListener("change", () => actions.speed(Number(select.value)));
  return h("span", { class: "speeds" }, h("label", { for: id, class: "hidden" }, say("speed")), select);
}

function createMenu({ hasPicture, first }: ToolbarOptions, say: Say, actions: ToolbarActions): HTMLElement {
  const summary = h("summary", { "aria-label": say("more"), title: say("more") }, icon("more"));
  const details = h("details", { class: "menu" }, summary);
  const close = (): void => {
    details.open = false;
    summary.focus();
  };
  const file = h("input", { type: "file", accept: ".json,application/json", hidden: true, tabindex: -1, "aria-label": say("openState") });
  const item = (text: string, act: () => void): HTMLElement => {
    const element = h("button", { type: "button" }, text);
    element.addEventListener("click", () => {
      close();
      act();
    });
    return element;
  };
  file.addEventListener("change", () => {
    const [chosen] = file.files ?? [];
    if (chosen !== undefined) actions.openState(chosen);
    file.value = "";
  });
  details.addEventListener("keydown", (event) => {
    if (event.key === "Escape") close();
  });
  details.addEventListener("focusout", (event) => {
    if (event.relatedTarget instanceof Node && !details.contains(event.relatedTarget)) details.open = false;
  });
  details.append(h("div", { class: "menu-list" }, first,
    item(say("copyLink"), actions.copyLink), item(say("saveState"), actions.saveState), item(say("openState"), () => file.click()),
    hasPicture && item(say("savePicture"), actions.savePicture)), file);
  return details;
}
