/** Plays a lab: it requests as much simulated time as has passed, one request at a time. */
import type { ControlValue } from "labspec/slim";
import type { RemoteLab } from "../engine/client.js";
import type { Drag, Frame } from "../engine/messages.js";
import { onEveryFrame } from "./clock.js";

export interface Player {
  readonly isPlaying: boolean;
  /** A closed player tells nothing more. */
  readonly isClosed: boolean;
  /** Simulated seconds per second. */
  speed: number;
  /** Whether the lab is visible. An invisible lab pauses. */
  isVisible: boolean;
  /** Whether a control has a new value that the lab has not taken yet. */
  isMoving(label: string): boolean;
  play(): void;
  pause(): void;
  /** Plays a number of simulated seconds at once. */
  advance(seconds: number): Promise<void>;
  step(steps: number): Promise<void>;
  reset(): Promise<void>;
  set(label: string, value: ControlValue): Promise<void>;
  press(label: string): Promise<void>;
  drag(drag: Drag | null): Promise<void>;
  /** The state as bytes. */
  save(): Promise<Uint8Array>;
  close(): void;
}

export interface PlayerEvents {
  frame(frame: Frame): void;
  playing(isPlaying: boolean): void;
  /** The actual speed, if it is lower than the requested one; otherwise `null`. */
  slow(speed: number | null): void;
  failed(e: unknown): void;
  /** The lab is about to go back to its start. */
  resetting(): void;
}

/** A control that is being moved: the value that waits, and the answer to the one that was sent last. */
interface Move {
  next: ControlValue | undefined;
  sent: Promise<void>;
  done: Promise<void>;
}

/** The maximum time between two frames for which the lab catches up, s. */
const MOST_ELAPSED = 0.1;
/** The time of the engine for one frame, ms. */
const BUDGET = 12;

export function createPlayer(remote: RemoteLab, events: PlayerEvents): Player {
  let [stop, isWaiting, last, isVisible, speed]: [(() => void) | null, boolean, number, boolean, number] = [null, false, 0, true, 1];
  let [isOver, isClosed, lag] = [remote.opened.frame.isOver, false, 0];
  // The last value of a control that is being moved waits for the one before it.
  const moving = new Map<string, Move>();
  const take = (frame: Frame): void => {
    if (isClosed) return;
    isOver = frame.isOver;
    events.frame(frame);
    if (frame.isOver) player.pause();
  };
  /** Shows the answer. Errors are shown to the reader and passed to the caller. */
  const ask = (what: Promise<Frame>): Promise<void> => ignoreRejection(what.then(take, (e: unknown) => {
    if (!isClosed) events.failed(e);
    throw e;
  }));
  const measure = (asked: number, behind: number): void => {
    lag = 0.9 * lag + 0.1 * (asked > 0 ? Math.min(1, behind / asked) : 0);
    events.slow(lag > 0.15 ? speed * (1 - lag) : null);
  };
  const tick = (now: number): void => {
    if (isWaiting || !isVisible) {
      if (!isVisible) last = now;
      return;
    }
    const seconds = Math.min(MOST_ELAPSED, (now - last) / 1000) * speed;
    last = now;
    if (!(seconds > 0)) return;
    isWaiting = true;
    const answer = remote.ask("advance", seconds, BUDGET).then((frame) => {
      measure(seconds, frame.behind);
      return frame;
    });
    ask(answer).then(() => {
      isWaiting = false;
    }, () => {
      isWaiting = false;
      player.pause();
    });
  };
  const send = (label: string, move: Move): void => {
    if (move.next === undefined) return;
    const value = move.next;
    move.next = undefined;
    move.sent = ask(remote.ask("set", label, value));
  };
  /** Sends the values that wait: what the reader does next comes after them. */
  const sendAll = (): void => moving.forEach((move, label) => send(label, move));
  const setOnce = async (label: string, move: Move): Promise<void> => {
    try {
      for (let sent: Promise<void> | null = null; move.next !== undefined || move.sent !== sent;) {
        send(label, move);
        sent = move.sent;
        await sent;
      }
    } finally {
      moving.delete(label);
    }
  };
  const player: Player = {
    get isPlaying() { return stop !== null; },
    get isClosed() { return isClosed; },
    get speed() { return speed; },
    set speed(value) { [speed, lag] = [value, 0]; },
    get isVisible() { return isVisible; },
    set isVisible(value) { isVisible = value; },
    isMoving: (label) => moving.has(label),
    play() {
      if (stop !== null) return;
      const begin = (): void => {
        if (isClosed || stop !== null) return;
        last = performance.now();
        stop = onEveryFrame(tick);
        events.playing(true);
      };
      if (isOver) player.reset().then(begin, () => undefined);
      else begin();
    },
    pause() {
      if (stop === null) return;
      stop();
      stop = null;
      events.slow(null);
      events.playing(false);
    },
    advance(seconds) {
      sendAll();
      return ask(remote.ask("advance", seconds, Infinity));
    },
    step(steps) {
      sendAll();
      return ask(remote.ask("step", steps));
    },
    reset() {
      sendAll();
      events.resetting();
      return ask(remote.ask("reset"));
    },
    set(label, value) {
      const before = moving.get(label);
      if (before !== undefined) {
        before.next = value;
        return before.done;
      }
      const move: Move = { next: value, sent: Promise.resolve(), done: Promise.resolve() };
      moving.set(label, move);
      move.done = ignoreRejection(setOnce(label, move));
      return move.done;
    },
    press(label) {
      sendAll();
      return ask(remote.ask("press", label));
    },
    save() {
      sendAll();
      return remote.ask("save");
    },
    drag: (drag) => ask(remote.ask("drag", drag)),
    close() {
      player.pause();
      isClosed = true;
      remote.ask("free").catch(() => undefined);
    },
  };
  return player;
}

/** A promise that may be ignored, because its rejection has been reported already. */
function ignoreRejection(promise: Promise<void>): Promise<void> {
  promise.catch(() => undefined);
  return promise;
}
