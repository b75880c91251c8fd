import { asLabspecError, LabspecError } from "./error.js";
import { Lab } from "./lab.js";
import type { LabState } from "./lab-state.js";
import type { Models } from "./lab-types.js";
import { SharedFrames, canShare, type Frame } from "./shared-frame.js";
import type { OpenedLab, Port, Reply, Request } from "./worker-protocol.js";

/** The properties and methods of a lab that a page can call by name. */
const READS = ["controls", "shown", "time", "timestep", "isOver", "numbers", "findings", "contacts", "reads", "writes", "textures"] as const;
const CALLS = ["value", "set", "press", "reset", "step", "playTo", "record", "names", "takePlayback"] as const;

/** The buffers of numbers in a result, at any depth. They are transferred. */
function buffersOf(result: unknown): ArrayBuffer[] {
  if (result instanceof Float64Array || result instanceof Float32Array) return result.buffer instanceof ArrayBuffer ? [result.buffer] : [];
  return typeof result === "object" && result !== null && !ArrayBuffer.isView(result) ? Object.values(result).flatMap(buffersOf) : [];
}

/** A lab with what is deleted together with it: the memory of its frames, if memory can be shared, and its saved states. */
interface ServedLab {
  readonly lab: Lab;
  readonly frames: SharedFrames | undefined;
  readonly states: Map<number, LabState>;
  /** The number of states that were saved, which is the id of the last one. */
  saved: number;
}

/** The data that a page draws: copies, which are transferred, or null if they are in shared memory. */
function frameOf({ lab, frames }: ServedLab): Frame | null {
  if (frames === undefined) return { time: lab.time, numbers: lab.numbers, poses: lab.poses.slice() };
  frames.write(lab);
  return null;
}

function stateOf({ states }: ServedLab, id: unknown): LabState {
  const state = states.get(id as number);
  if (state === undefined) throw new LabspecError("freed", "this state was freed");
  return state;
}

/** Answers a call that needs nothing but the lab. */
function answerLab(served: ServedLab, call: string, args: readonly unknown[]): unknown {
  const { lab: calledLab, states } = served;
  if (call === "frame") return frameOf(served);
  if (call === "save") {
    states.set(++served.saved, calledLab.save());
    return served.saved;
  }
  if (call === "restore") return calledLab.restore(stateOf(served, args[0]));
  if (call === "stateBytes") return stateOf(served, args[0]).toBytes();
  if ((READS as readonly string[]).includes(call)) return calledLab[call as (typeof READS)[number]];
  if ((CALLS as readonly string[]).includes(call)) return (calledLab[call as (typeof CALLS)[number]] as (...a: unknown[]) => unknown).apply(calledLab, [...args]);
  throw new LabspecError("unknown-function", `a lab has no \`${call}\``);
}

/** Serves labs to the other end of a port. */
export function serve(port: Port, ready: Promise<void>): void {
  const labs = new Map<number, ServedLab>();
  const runs = new Map<number, AbortController>();
  let next = 1;

  const open = (args: readonly unknown[]): OpenedLab => {
    const [first, second, address, models] = args as [string, string & Models, string | undefined, Models];
    const lab = typeof address === "string" ? Lab.ofLesson(first, second, address, models) : new Lab(first, second);
    const frames = canShare() ? SharedFrames.like(lab) : undefined;
    labs.set(next, { lab, frames, states: new Map(), saved: 0 });
    return { id: next++, memory: frames?.memory };
  };
  const play = async (served: ServedLab, args: readonly unknown[]): Promise<unknown> => {
    const [time, run, budget] = args as [number, number, number | undefined];
    const control = new AbortController();
    runs.set(run, control);
    try {
      const steps = await served.lab.play(time, { signal: control.signal, ...(budget === undefined ? {} : { budget }) });
      return { steps, frame: frameOf(served) };
    } finally {
      runs.delete(run);
    }
  };

  const answer = async ({ lab: id, call, args }: Request): Promise<unknown> => {
    await ready;
    if (call === "open") return open(args);
    if (call === "cancel") return runs.get(args[0] as number)?.abort();
    const served = labs.get(id);
    // The states of a freed lab are gone already.
    if (call === "forget") return void served?.states.delete(args[0] as number);
    if (served === undefined) throw new LabspecError("freed", "this lab was freed");
    if (call === "free") {
      labs.delete(id);
      return served.lab.free();
    }
    return call === "play" ? play(served, args) : answerLab(served, call, args);
  };

  port.listen((message) => {
    const request = message as Request;
    answer(request).then(
      (result) => {
        port.post({ id: request.id, result } satisfies Reply, [...new Set(buffersOf(result))]);
      },
      (e: unknown) => {
        const { code, message: why, findings } = asLabspecError(e);
        port.post({ id: request.id, error: { code, message: why, findings } } satisfies Reply, []);
      },
    );
  });
}
