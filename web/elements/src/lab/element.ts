/** `<sim-lab>`: a physics lab in a page. */
import type { ControlValue, Models } from "labspec/slim";
import { childrenRead, ContentError, readContent, readModels } from "../content.js";
import { deferred } from "../deferred.js";
import { h, setText, takeOwnProperty } from "../dom.js";
import { EngineError, prepareEngine } from "../engine/client.js";
import { createBadge } from "../proof/badge.js";
import type { Json, LabSpec } from "../spec.js";
import { prepareViews } from "../view/index.js";
import { decodeState, stateInFragment, StateError } from "../state/fragment.js";
import { applyStyles, watchTheme } from "../style/apply.js";
import { messagesFor, type Say } from "../text/messages.js";
import { readSpec } from "./integrators.js";
import { errorPanel, findingText } from "./layout.js";
import { joinLink, type Link } from "./links.js";
import { createOutline, type Outline } from "./outline.js";
import { openPanel, type Panel } from "./panel.js";

const TAG = "sim-lab";
/** A lab is opened when its distance to the window is smaller than this, pixels. */
const MARGIN = 200;
/** A text is read aloud only if it comes some time after its live region. A lab that is open by then does not say that it loads, ms. */
const LOADING_DELAY = 200;

export class SimLab extends HTMLElement {
  static readonly observedAttributes = ["src", "lang", "link"];
  #lab: object | string | null = null;
  #models: Models | null = null;
  #panel: Panel | null = null;
  #outline: Outline | null = null;
  /** The number of openings. The results of older openings are dropped. */
  #turn = 0;
  #isWanted = false;
  /** Whether the lab is in or near the window, as the observer has reported last. */
  #isSeen = false;
  /** Whether the focus was in a panel that was replaced. */
  #hadFocus = false;
  readonly #region = h("p", { class: "hidden", role: "status", "aria-live": "polite", part: "status" });
  #ready = deferred();
  #seen: IntersectionObserver | null = null;
  #unwatch: (() => void) | null = null;
  #state: Uint8Array | null = null;
  #link: Link | null = null;

  /** The lab as an object or as JSON. */
  get lab(): object | string | null { return this.#lab; }
  set lab(lab: object | string | null) {
    this.#lab = lab;
    this.#reopen();
  }

  /** Models by name (MJCF), and files that they name, by path. */
  get models(): Models | null { return this.#models; }
  set models(models: Models | null) {
    this.#models = models;
    this.#reopen();
  }

  /** Fulfilled when the lab is open; rejected with the reason if it cannot be opened. */
  get ready(): Promise<void> {
    this.#want();
    return this.#ready.promise;
  }

  get time(): number { return this.#panel?.frame.time ?? 0; }
  get playing(): boolean { return this.#panel?.player.isPlaying ?? false; }
  /** Whether the lab has reached its end and does not continue without a reset. */
  get isOver(): boolean { return this.#panel?.frame.isOver ?? false; }
  /** Labels and units of the traces and readouts. */
  get shown(): Panel["remote"]["opened"]["shown"] { return this.#panel?.remote.opened.shown ?? []; }
  /** The values of the traces and readouts, in the same order. */
  get numbers(): readonly number[] { return Array.from(this.#panel?.frame.numbers ?? []); }
  /** The traces of the plots, with their samples. */
  get traces(): Panel["traces"] { return this.#panel?.traces ?? []; }
  /** What has happened since the start, in sentences. */
  get events(): readonly string[] { return this.#panel?.events ?? []; }
  /** The readouts as they are printed. */
  get texts(): readonly string[] { return this.#panel?.frame.texts ?? []; }

  play(): void { void this.ready.then(() => this.#panel?.player.play(), () => undefined); }
  pause(): void { this.#panel?.player.pause(); }
  async reset(): Promise<void> { await (await this.#opened()).player.reset(); }
  async step(steps = 1): Promise<void> { await (await this.#opened()).player.step(steps); }
  async set(label: string, value: ControlValue): Promise<void> {
    const { player } = await this.#opened();
    await player.set(label, value);
    this.#link?.moved(label, value);
  }
  async press(label: string): Promise<void> {
    const { player } = await this.#opened();
    await player.press(label);
    this.#link?.pressed(label);
  }
  /** The state as bytes, for `openState`. */
  async saveState(): Promise<Uint8Array> { return (await this.#opened()).save(); }
  /** Opens a saved state. The lab continues from there with the same bits. */
  async openState(state: Uint8Array): Promise<void> {
    this.#state = state;
    this.#reopen();
    await this.ready;
  }

  connectedCallback(): void {
    const root = this.shadowRoot ?? this.attachShadow({ mode: "open" });
    applyStyles(root);
    takeOwnProperty(this, "models");
    takeOwnProperty(this, "lab");
    if (this.#region.parentNode === null) {
      root.append(this.#region);
      this.#showLoading(root);
    }
    addEventListener("hashchange", this.#onHash);
    this.#unwatch = watchTheme(this, () => this.#panel?.restyle());
    this.#seen = new IntersectionObserver((entries) => {
      this.#isSeen = entries[entries.length - 1]?.isIntersecting === true;
      if (this.#isSeen) this.#want();
      if (this.#panel !== null) this.#panel.player.isVisible = this.#isSeen;
    }, { rootMargin: `${MARGIN}px` });
    this.#seen.observe(this);
    // The engine starts while the page is laid out, and a lab in the window does not wait for the observer.
    prepareEngine();
    // A script that adds the element may set its properties afterwards.
    queueMicrotask(() => {
      const { top, bottom } = this.getBoundingClientRect();
      if (this.isConnected && bottom > -MARGIN && top < innerHeight + MARGIN) this.#want();
    });
  }

  disconnectedCallback(): void {
    removeEventListener("hashchange", this.#onHash);
    this.#panel?.release();
    this.#seen?.disconnect();
    this.#unwatch?.();
    // An element that is moved in its page is connected again at once.
    queueMicrotask(() => {
      if (!this.isConnected) this.#close();
    });
  }

  attributeChangedCallback(name: string, before: string | null, after: string | null): void {
    if (before === after) return;
    if (name !== "link") this.#reopen();
    else if (this.#panel !== null) this.#join(this.#panel, false);
  }

  /** Links the lab to those with the same `link`. */
  #join(panel: Panel, keepsOwn: boolean): void {
    this.#link?.leave();
    const name = this.getAttribute("link") ?? "";
    this.#link = name === "" ? null : joinLink(name, {
      controls: panel.remote.opened.controls,
      set: (label, value) => void panel.move(label, value),
      press: (label) => void panel.move(label, null),
    }, keepsOwn);
  }

  readonly #onHash = (): void => {
    if (this.#panel !== null && stateInFragment(location.hash, this.#key()) !== null) this.#reopen();
  };

  async #opened(): Promise<Panel> {
    await this.ready;
    if (this.#panel === null) throw new Error("this lab is closed");
    return this.#panel;
  }

  #want(): void {
    if (this.#isWanted || !this.isConnected) return;
    this.#isWanted = true;
    prepareEngine();
    // The page has nothing to do while the engine starts.
    setTimeout(prepareViews, 0);
    const turn = ++this.#turn;
    setTimeout(() => {
      if (turn === this.#turn && !this.#ready.isSettled) setText(this.#region, messagesFor(this)("loading"));
    }, LOADING_DELAY);
    void this.#open(turn);
  }

  #close(): void {
    this.#turn++;
    this.#isWanted = false;
    this.#link?.leave();
    this.#link = null;
    this.#panel?.dispose();
    this.#panel = null;
    this.#endOutline();
    setText(this.#region, "");
    this.#hadFocus ||= (this.shadowRoot?.activeElement ?? null) !== null;
    // Who waits for a lab that was not open yet waits for the one that is opened next.
    if (this.#ready.isSettled) this.#ready = deferred();
    if (this.shadowRoot !== null) this.#showLoading(this.shadowRoot);
  }

  #reopen(): void {
    if (!this.#isWanted) return;
    this.#close();
    this.#want();
  }

  /** Shows what the lab will look like. */
  #showOutline(root: ShadowRoot, json: Json, spec: LabSpec, say: Say): void {
    this.#endOutline();
    this.#outline = createOutline(json, spec, this.#poster(), say);
    show(root, this.#outline.element);
  }

  #endOutline(): void {
    this.#outline?.dispose();
    this.#outline = null;
  }

  /** The address of the picture of the start; `null` where the lab opens in another state. */
  #poster(): string | null {
    const isAtStart = this.#state === null && stateInFragment(location.hash, this.#key()) === null;
    return isAtStart ? this.getAttribute("poster") : null;
  }

  #showLoading(root: ShadowRoot): void {
    const say = messagesFor(this);
    show(root, h("div", { class: "lab loading" }, h("span", {}, say("loading"))));
  }

  async #open(turn: number): Promise<void> {
    const [root, say] = [this.shadowRoot, messagesFor(this)];
    if (root === null) return;
    const isOld = (): boolean => turn !== this.#turn;
    try {
      await childrenRead();
      const { json, text } = await readContent(this, this.#lab, say("noLab"), say);
      const spec = readSpec(json, text);
      if (isOld()) return;
      this.#showOutline(root, json, spec, say);
      const models = await readModels(this, this.#models, spec.model, say);
      if (isOld()) return;
      const [panel, remark] = await this.#openInState(spec, models, say);
      if (isOld()) return panel.dispose();
      this.#panel = panel;
      this.#endOutline();
      this.#join(panel, remark !== null);
      const badge = createBadge(this, json, models, say);
      if (badge !== null) panel.element.append(badge);
      show(root, panel.element);
      setText(this.#region, "");
      // The reader may have moved the focus meanwhile.
      if (this.#hadFocus && document.activeElement === document.body) panel.focus();
      this.#hadFocus = false;
      panel.restyle();
      panel.player.isVisible = this.#isSeen;
      if (remark !== null) panel.say(remark);
      const mayMove = !matchMedia("(prefers-reduced-motion: reduce)").matches;
      if ((spec.autoplay || panel.frame.playback === "play") && mayMove) panel.player.play();
      this.#ready.resolve();
      this.#tell("lab-ready", {});
    } catch (e) {
      if (isOld()) return;
      this.#endOutline();
      setText(this.#region, "");
      this.#hadFocus = false;
      showError(root, e, say);
      this.#ready.reject(e);
    }
  }

  /** Opens the lab in the requested state. If the state is refused, the lab opens at its start, with the reason. */
  async #openInState(spec: LabSpec, models: Models, say: Say): Promise<[Panel, string | null]> {
    const open = (state: Uint8Array | null): Promise<Panel> => openPanel(spec, models, { state, poster: state === null ? this.#poster() : null, region: this.#region }, this.#key(), say, {
      moved: (label, value) => (value === null ? this.#link?.pressed(label) : this.#link?.moved(label, value)),
      change: (label, value, time) => {
        this.shadowRoot?.querySelector(".failure")?.remove();
        this.#tell("lab-change", { label, value, time });
      },
      event: (event, text) => this.#tell("lab-event", { ...event, text }),
      playing: (isPlaying) => this.#tell(isPlaying ? "lab-play" : "lab-pause", { time: this.time }),
      failed: (e) => this.#fail(e),
      reopen: (state) => void this.openState(state).catch(() => undefined),
    });
    const given = this.#state;
    this.#state = null;
    const linked = stateInFragment(location.hash, this.#key());
    if (given === null && linked === null) return [await open(null), null];
    try {
      return [await open(given ?? (await decodeState(linked ?? ""))), say("stateRestored")];
    } catch (e) {
      const isRefused = e instanceof StateError || (e instanceof EngineError && (e.problem.code === "not-a-state" || given === null));
      if (!isRefused) throw e;
      return [await open(null), say("stateRefused", { why: reasonOf(e, say) })];
    }
  }

  /** Reports an error during the use of the lab. The lab stays on the page. */
  #fail(e: unknown): void {
    const [root, say] = [this.shadowRoot, messagesFor(this)];
    const text = e instanceof StateError ? say("stateRefused", { why: reasonOf(e, say) }) : reasonOf(e, say);
    this.#panel?.say(text);
    root?.querySelector(".failure")?.remove();
    const article = root?.querySelector("article");
    article?.append(h("p", { class: "failure", role: "alert", part: "error" }, text));
  }

  /** The name of the lab in addresses: its `id`, or its place among the labs of the page. */
  #key(): string {
    if (this.id !== "") return this.id;
    return String([...document.querySelectorAll(TAG)].indexOf(this) + 1);
  }

  #tell(type: string, detail: object): void {
    this.dispatchEvent(new CustomEvent(type, { detail, bubbles: true, composed: true }));
  }
}

/** Shows an element in place of the one before it. The live region stays. */
function show(root: ShadowRoot, element: HTMLElement): void {
  root.querySelector(".lab")?.remove();
  root.prepend(element);
}

function reasonOf(e: unknown, say: Say): string {
  if (e instanceof StateError) return say(e.reason === "too-long" ? "stateTooLong" : "stateDamaged");
  return e instanceof Error ? e.message : String(e);
}

function showError(root: ShadowRoot, e: unknown, say: Say): void {
  if (e instanceof ContentError) return show(root, errorPanel(say("broken"), [e.message], null));
  if (e instanceof EngineError) {
    const findings = e.problem.findings.map(findingText);
    return show(root, errorPanel(say("broken"), findings.length > 0 ? findings : [e.message], say("brokenHelp")));
  }
  show(root, errorPanel(say("broken"), [say("engineFailed", { why: e instanceof Error ? e.message : String(e) })], null));
}

/** Defines the element, if the page has not defined it. */
export function defineSimLab(): void {
  if (customElements.get(TAG) === undefined) customElements.define(TAG, SimLab);
}
