/** Labs that differ in their integrator, played as one: each call goes to all of them, and a frame has the samples of all. */
import type { ControlValue, Models, Shown } from "labspec/slim";
import { checkState, StateError } from "../state/fragment.js";
import { openRemote, type RemoteLab } from "./client.js";
import { createQueue, mergeRows, pushRows, type RowQueue } from "./merge.js";
import type { Calls, EngineEvent, Frame, Opened } from "./messages.js";
import type { SceneModel } from "../view/types.js";

/** The lab of one integrator. */
export interface ComparedLab {
  readonly name: string;
  readonly json: string;
}

interface Member {
  readonly name: string;
  readonly remote: RemoteLab;
  readonly queue: RowQueue;
  frame: Frame;
  model: SceneModel;
  /** Whether the engine has reset it because of a bad number. It waits for a reset. */
  isBroken: boolean;
}

/** What the members are asked to do. `replaces` states that the reader acts on the lab: a reset heals a broken one. */
interface Request {
  readonly ask: (member: Member) => Promise<Frame> | null;
  readonly replaces: boolean;
}

/** Opens the labs. If one of them cannot be opened, none stays open. */
async function openMembers(labs: readonly ComparedLab[], models: Models, states: readonly (Uint8Array | null)[]): Promise<readonly Member[]> {
  const results = await Promise.allSettled(labs.map(async ({ name, json }, i): Promise<Member> => {
    const remote = await openRemote(json, models, states[i] ?? null);
    const { frame, model } = remote.opened;
    return { name, remote, queue: createQueue(), frame, model, isBroken: false };
  }));
  const members = results.flatMap((result) => (result.status === "fulfilled" ? [result.value] : []));
  const refused = results.find((result) => result.status === "rejected");
  if (refused === undefined) return members;
  for (const { remote } of members) remote.ask("free").catch(() => undefined);
  throw refused.reason;
}

/** Opens the labs. `control` is the label of the select that sets the integrator; here it chooses whose scene is drawn. */
export async function openCompared(labs: readonly ComparedLab[], control: string, models: Models, state: Uint8Array | null): Promise<RemoteLab> {
  const states = state === null ? labs.map(() => null) : splitState(state, labs.length);
  const members = await openMembers(labs, models, states);
  const first = members[0];
  if (first === undefined) throw new Error("a comparison needs a lab");
  const place = first.remote.opened.controls.findIndex(({ label }) => label === control);
  const shown = first.remote.opened.shown;
  let viewed = first;

  const take = (member: Member, frame: Frame, replaces: boolean): void => {
    const isHealed = replaces && frame.isRestarted;
    member.isBroken = (member.isBroken && !isHealed) || frame.events.some(({ type }) => type === "restart");
    member.frame = frame;
    if (frame.model !== undefined) member.model = frame.model;
    pushRows(member.queue, frame.rows, shown.length + 1);
  };
  const joined = (events: readonly EngineEvent[], behind: number, hasModel: boolean, isRestarted: boolean): Frame => {
    const running = members.filter(({ isBroken }) => !isBroken);
    const queues = members.map(({ isBroken, queue }) => (isBroken ? null : queue));
    const numbers = shown.flatMap((_, i) => members.map(({ frame, isBroken }) => (isBroken ? NaN : (frame.numbers[i] ?? NaN))));
    const readouts = first.frame.texts.map((_, i) => members.map(({ frame, isBroken }) => (isBroken ? "–" : (frame.texts[i] ?? ""))));
    const values = first.frame.values.map((value, i): ControlValue | null => (i === place ? viewed.name : value));
    return {
      time: Math.min(...(running.length > 0 ? running : members).map(({ frame }) => frame.time)),
      numbers: Float64Array.from(numbers), texts: readouts.flat(), rows: mergeRows(queues, shown.length + 1),
      scene: viewed.frame.scene, ...(hasModel ? { model: viewed.model } : {}), events, isRestarted,
      isOver: running.every(({ frame }) => frame.isOver), values,
      playback: members.map(({ frame }) => frame.playback).find((playback) => playback !== null) ?? null, behind,
    };
  };
  const askAll = async ({ ask, replaces }: Request): Promise<Frame> => {
    const answers = await Promise.all(members.map(async (member) => [member, await ask(member)] as const));
    const made = answers.filter((answer): answer is readonly [Member, Frame] => answer[1] !== null);
    for (const [member, frame] of made) take(member, frame, replaces);
    const events = made.flatMap(([member, frame]) => frame.events.filter((event) => member === viewed || event.type === "restart" || event.type === "finding"));
    const hasModel = made.some(([member, frame]) => member === viewed && frame.model !== undefined);
    const isRestarted = made.some(([member, frame]) => member === viewed && !member.isBroken && frame.isRestarted);
    return joined(withoutRepeats(events), Math.max(0, ...made.map(([, frame]) => frame.behind)), hasModel, isRestarted);
  };
  /** Advances all to the same time: those that were slower in the last frame catch up before the others go on. */
  const advance = (seconds: number, budget: number): Promise<Frame> => {
    const running = members.filter(({ isBroken }) => !isBroken);
    const target = Math.min(...running.map(({ frame }) => frame.time)) + seconds;
    return askAll({
      ask: (member) => {
        const left = Math.min(seconds, target - member.frame.time);
        return member.isBroken || left <= 0 ? null : member.remote.ask("advance", left, budget);
      },
      replaces: false,
    });
  };
  const calls: { [Name in Exclude<keyof Calls, "open">]: (...args: Calls[Name]["args"]) => Promise<Calls[Name]["answer"]> } = {
    advance,
    step: (steps) => askAll({ ask: ({ isBroken, remote }) => (isBroken ? null : remote.ask("step", steps)), replaces: false }),
    reset: () => askAll({ ask: ({ remote }) => remote.ask("reset"), replaces: true }),
    set: (label, value) => {
      if (label !== control) return askAll({ ask: ({ remote }) => remote.ask("set", label, value), replaces: true });
      viewed = members.find(({ name }) => name === value) ?? viewed;
      return Promise.resolve(joined([], 0, true, false));
    },
    press: (label) => askAll({ ask: ({ remote }) => remote.ask("press", label), replaces: true }),
    drag: (drag) => askAll({ ask: ({ remote }) => remote.ask("drag", drag), replaces: true }),
    save: async () => joinStates(await Promise.all(members.map(({ remote }) => remote.ask("save")))),
    free: async () => {
      await Promise.all(members.map(({ remote }) => remote.ask("free")));
      return null;
    },
  };
  for (const member of members) take(member, member.frame, true);
  const opened: Opened = {
    ...first.remote.opened, shown: shown.flatMap((one): Shown[] => members.map(({ name }) => ({ ...one, label: `${one.label}, ${name}` }))),
    frame: joined(first.frame.events, 0, false, false),
  };
  return { opened, ask: (call, ...args) => calls[call](...args) };
}

/** Events without those that are equal to an earlier one: a restart and a finding are the same for several integrators. */
function withoutRepeats(events: readonly EngineEvent[]): readonly EngineEvent[] {
  const texts = events.map((event) => (event.type === "finding" ? event.finding.message : JSON.stringify(event)));
  return events.filter((_, i) => texts.indexOf(texts[i] ?? "") === i);
}

const text = (bytes: Uint8Array): string => new TextDecoder("utf-8", { fatal: true }).decode(bytes);

/** The states of all labs as one. It has the form of a state, so that its limits are checked in the same way. */
export function joinStates(states: readonly Uint8Array[]): Uint8Array {
  const all = states.map((state) => JSON.parse(text(state)) as unknown);
  const actions = all.flatMap((state) => (state as { labspec?: { actions?: unknown[] } } | null)?.labspec?.actions ?? []);
  return new TextEncoder().encode(JSON.stringify({ labspec: { actions, states: all } }));
}

/** The states of the labs. */
export function splitState(state: Uint8Array, count: number): readonly Uint8Array[] {
  checkState(state);
  const { labspec } = JSON.parse(text(state)) as { labspec: { states?: unknown } };
  const states = Array.isArray(labspec.states) ? (labspec.states as unknown[]) : [];
  if (states.length !== count) throw new StateError("damaged");
  const parts = states.map((one) => new TextEncoder().encode(JSON.stringify(one)));
  for (const part of parts) checkState(part);
  return parts;
}
