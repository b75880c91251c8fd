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

/** Serves labs to the other end of a port. */
export function serve(port: Port, ready: Promise<void>): void {
  const labs = new Map<number, Lab>();
  const frames = new WeakMap<Lab, SharedFrames>();
  const states = new Map<number, LabState>();
  const runs = new Map<number, AbortController>();
  let next = 1;

  const lab = (id: number): Lab => {
    const found = labs.get(id);
    if (found === undefined) throw new LabspecError("freed", "this lab was freed");
    return found;
  };
  /** The data that a page draws: copies, which are transferred, or null if they are in shared memory. */
  const frame = (of: Lab): Frame | null => {
    const shared = frames.get(of);
    if (shared === undefined) return { time: of.time, numbers: of.numbers, poses: of.poses.slice() };
    shared.write(of);
    return null;
  };
  const open = (args: readonly unknown[]): OpenedLab => {
    const [first, second, address, models] = args as [string, string & Models, string | undefined, Models];
    const opened = typeof address === "string" ? Lab.ofLesson(first, second, address, models) : new Lab(first, second);
    const shared = canShare() ? SharedFrames.like(opened) : undefined;
    if (shared !== undefined) frames.set(opened, shared);
    labs.set(next, opened);
    return { id: next++, memory: shared?.memory };
  };

  const answer = async ({ lab: id, call, args }: Request): Promise<unknown> => {
    await ready;
    if (call === "open") return open(args);
    if (call === "cancel") return runs.get(args[0] as number)?.abort();
    const own = lab(id);
    if (call === "free") {
      labs.delete(id);
      return own.free();
    }
    if (call === "frame") return frame(own);
    if (call === "play") {
      const [time, run, budget] = args as [number, number, number | undefined];
      const control = new AbortController();
      runs.set(run, control);
      try {
        const steps = await own.play(time, { signal: control.signal, ...(budget === undefined ? {} : { budget }) });
        return { steps, frame: frame(own) };
      } finally {
        runs.delete(run);
      }
    }
    if (call === "save") {
      states.set(next, own.save());
      return next++;
    }
    if (call === "restore") {
      const state = states.get(args[0] as number);
      if (state === undefined) throw new LabspecError("wrong-type", "a state is what `save` gave");
      return own.restore(state);
    }
    if (call === "forget") return void states.delete(args[0] as number);
    if (call === "stateBytes") return states.get(args[0] as number)?.toBytes();
    if ((READS as readonly string[]).includes(call)) return own[call as (typeof READS)[number]];
    if ((CALLS as readonly string[]).includes(call)) return (own[call as (typeof CALLS)[number]] as (...a: unknown[]) => unknown).apply(own, [...args]);
    throw new LabspecError("unknown-function", `a lab has no \`${call}\``);
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
