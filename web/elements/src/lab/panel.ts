/** An open lab: its parts, which receive the frames of the engine. */
import type { ControlValue, Models } from "labspec/slim";
import { fileName, saveFile } from "../dom.js";
import { openRemote, type RemoteLab } from "../engine/client.js";
import { openCompared } from "../engine/compared.js";
import type { EngineEvent, Frame } from "../engine/messages.js";
import { createPlot } from "../plot/plot.js";
import { createSeries, type Series } from "../plot/series.js";
import type { LabSpec } from "../spec.js";
import { checkState, encodeState, fragmentWith } from "../state/fragment.js";
import type { Say } from "../text/messages.js";
import { formatTime } from "../text/numbers.js";
import { allTextures } from "../texture/textures.js";
import { createComparison } from "./comparison.js";
import { createControls } from "./controls.js";
import { INTEGRATOR } from "./integrators.js";
import { layOut } from "./layout.js";
import { answered, forgetPaced, showPaced } from "./pace.js";
import { createPlayer, type Player } from "./player.js";
import { createReadouts } from "./readouts.js";
import { createSpoken } from "./spoken.js";
import { createToolbar } from "./toolbar.js";
import { createViewBar } from "./view-bar.js";
import { createViewport } from "./viewport.js";

/** The events of an open lab for its element. */
export interface PanelEvents {
  /** The reader moves a control, or presses a button (null). */
  moved(label: string, value: ControlValue | null): void;
  change(label: string, value: ControlValue | null, time: number): void;
  event(event: EngineEvent, text: string): void;
  playing(isPlaying: boolean): void;
  failed(e: unknown): void;
  /** Requests that a saved state is opened in place of this lab. */
  reopen(state: Uint8Array): void;
}

/** A trace: its samples are those of trace number `trace` of a series. */
export interface Trace {
  readonly label: string;
  readonly series: Series;
  readonly trace: number;
}

export interface Panel {
  readonly element: HTMLElement;
  readonly remote: RemoteLab;
  readonly player: Player;
  /** Moves a control or presses a button (null), and tells the page. */
  move(label: string, value: ControlValue | null): Promise<void>;
  readonly frame: Frame;
  /** The traces of the plots, with their samples. */
  readonly traces: readonly Trace[];
  /** What has happened since the start, in sentences. */
  readonly events: readonly string[];
  /** Announces a text in the live region. */
  say(text: string): void;
  restyle(): void;
  /** Lets go of the body that the reader holds. */
  release(): void;
  describe(): string;
  save(): Promise<Uint8Array>;
  /** Gives the focus to the play button. */
  focus(): void;
  dispose(): void;
}

/** How a lab starts: in a saved state, and with a picture of its start until it has drawn its own. */
export interface PanelStart {
  readonly state: Uint8Array | null;
  readonly poster: string | null;
  /** The live region of the element. */
  readonly region: HTMLElement;
}

/** Opens a lab, and builds its parts. `key` is its name in addresses. */
export async function openPanel(spec: LabSpec, models: Models, { state, poster, region }: PanelStart, key: string, say: Say, events: PanelEvents): Promise<Panel> {
  const compares = spec.compared.length > 0;
  const remote = await (compares ? openCompared(spec.compared, INTEGRATOR, models, state) : openRemote(spec.json, models, state));
  const { opened } = remote;
  const title = spec.title === "" ? say("lab") : spec.title;
  const spoken = createSpoken(region, say);
  const wantsNoMotion = matchMedia("(prefers-reduced-motion: reduce)").matches;
  let [frame, atStart]: [Frame, boolean] = [opened.frame, true];

  const show = (): void => {
    viewport.setFrame(frame.scene);
    viewport.draw();
    for (const plot of plots) plot.draw();
    showValues();
    toolbar.showTime(frame.time);
  };
  const showValues = (): void => {
    readouts.show(frame.texts);
    controls.show(frame.values, player.isMoving);
  };
  const take = (next: Frame): void => {
    if (next.isRestarted) {
      spoken.clear();
      for (const plot of plots) plot.clear();
      viewport.clearTrail();
      viewport.grab(null);
    }
    frame = next;
    atStart = false;
    if (next.model !== undefined) viewport.setModel(next.model);
    obey(next.playback);
    for (const plot of plots) plot.add(next.rows, opened.shown.length + 1);
    const sentences = spoken.report(next.events);
    next.events.forEach((event, i) => events.event(event, sentences[i] ?? ""));
    showPaced(show);
  };
  /** Obeys a request of a program. */
  const obey = (playback: Frame["playback"]): void => {
    if (playback === null) return;
    const plays = playback === "toggle" ? !player.isPlaying : playback === "play";
    if (plays) player.play();
    else player.pause();
  };
  const failed = (e: unknown): void => {
    if (!player.isClosed) events.failed(e);
  };
  const player = createPlayer(remote, {
    frame: take,
    playing(isPlaying) {
      toolbar.showPlaying(isPlaying);
      spoken.say(isPlaying ? say("started") : describe());
      events.playing(isPlaying);
    },
    slow: (speed) => toolbar.showSlow(speed),
    failed: events.failed,
    resetting: () => viewport.grab(null),
  });
  const move = (label: string, value: ControlValue | null): Promise<void> => {
    const done = value === null ? player.press(label) : player.set(label, value);
    return done.then(() => {
      if (player.isClosed) return;
      showValues();
      answered();
      events.change(label, value, frame.time);
    }, () => undefined);
  };
  const viewport = createViewport(opened, spec, poster, say, {
    drag: (drag) => void player.drag(drag), say: spoken.say, released: () => viewBar.showReleased(),
  });
  const viewBar = createViewBar(opened, spec, viewport, say);
  const controls = createControls(opened.controls, {
    set: (label, value) => {
      events.moved(label, value);
      void move(label, value);
    },
    press: (label) => {
      events.moved(label, null);
      void move(label, null);
    },
  });
  const plots = spec.plots.map((plot, p) => {
    const columns = opened.shown.flatMap((one, i) => (one.plot === p ? [i] : []));
    return createPlot(plot, columns, title, say);
  });
  const names = spec.compared.map(({ name }) => name);
  const readouts = compares
    ? createComparison(names, opened.shown, plots[0]?.series ?? createSeries(names.length), say)
    : createReadouts(opened.shown, say("readouts"));
  const describe = (): string => {
    const traces = plots.flatMap((plot) => plot.describe());
    return [say("paused", { time: formatTime(frame.time) }), readouts.describe(frame.texts), ...traces].filter((text) => text !== "").join(" ");
  };
  const save = (): Promise<Uint8Array> => player.save();
  const toolbar = createToolbar(
    { speeds: spec.speeds, timestep: opened.timestep, hasLargeSteps: wantsNoMotion, hasPicture: viewport.isDrawn, first: viewBar.bodies }, say, {
      toggle: () => (player.isPlaying ? player.pause() : player.play()),
      step: () => {
        player.pause();
        void player.step(1);
      },
      stepMore: () => {
        player.pause();
        void player.advance(0.1).then(() => spoken.say(describe()), () => undefined);
      },
      reset: () => {
        void player.reset();
        spoken.say(say("wasReset"));
      },
      speed: (speed) => {
        player.speed = speed;
      },
      copyLink: () => void copyLink(save, key, say, spoken.say).catch(failed),
      saveState: () => void save().then((bytes) => saveFile(`${fileName(title)}.json`, new Blob([bytes as BlobPart], { type: "application/json" }))).catch(failed),
      openState: (file) => void file.arrayBuffer().then((buffer) => {
        const bytes = new Uint8Array(buffer);
        checkState(bytes);
        events.reopen(bytes);
      }).catch(failed),
      savePicture: () => void viewport.savePicture(title).catch(failed),
    });
  player.speed = spec.speeds.includes(1) ? 1 : (spec.speeds[0] ?? 1);
  const element = layOut({
    spec, title, say, view: viewport.element, viewBar: viewBar.element, toolbar: toolbar.element, controls: controls.elements,
    buttons: controls.buttons, readouts: readouts.element, plots: plots.map((plot) => plot.element), spoken: [spoken.log],
    findings: opened.findings,
  });
  // A reader who has left the lab holds no body: Tab moves from the picture to the buttons of the lab, and the body stays held.
  element.addEventListener("focusout", ({ relatedTarget }) => {
    if (!(relatedTarget instanceof Node && element.contains(relatedTarget))) viewport.grab(null);
  });
  for (const plot of plots) plot.add(opened.frame.rows, opened.shown.length + 1);
  const textures = allTextures(opened.textures, viewport.textures, models).catch(() => null);
  // Drivers take long for the first picture. The rest of the lab is painted before it.
  let timer: ReturnType<typeof setTimeout> | undefined;
  const firstFrame = requestAnimationFrame(() => {
    show();
    timer = setTimeout(() => viewport.begin(textures), 0);
  });
  return {
    element, remote, player, move, say: spoken.say, describe, save,
    get frame() { return frame; },
    get traces() {
      return plots.flatMap(({ series }, p) => (spec.plots[p]?.traces ?? []).map(({ label }, trace) => ({ label, series, trace })));
    },
    get events() { return spoken.sentences; },
    restyle() {
      viewport.restyle();
      for (const plot of plots) plot.restyle();
      if (atStart) show();
    },
    release: () => viewport.grab(null),
    focus: () => toolbar.play.focus(),
    dispose() {
      cancelAnimationFrame(firstFrame);
      clearTimeout(timer);
      forgetPaced(show);
      player.close();
      spoken.dispose();
      viewport.dispose();
      for (const plot of plots) plot.dispose();
    },
  };
}

/** Writes the state into the address of the page, and copies the address. */
async function copyLink(save: () => Promise<Uint8Array>, key: string, say: Say, speak: (text: string) => void): Promise<void> {
  const text = await encodeState(await save());
  if (text === null) return speak(say("linkTooLong"));
  const address = new URL(location.href);
  address.hash = fragmentWith(address.hash, key, text);
  history.replaceState(history.state, "", address);
  try {
    await navigator.clipboard.writeText(address.href);
    speak(say("linkCopied"));
  } catch {
    // The address of the page has the state even without the clipboard.
    speak(address.href);
  }
}
