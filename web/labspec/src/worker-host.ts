import { asLabspecError, LabspecError } from "./error.js";
import { Lab, LabState, type Models } from "./lab.js";
import type { Port, Reply, Request } from "./worker-protocol.js";

/** What can be asked of a lab, beyond its own methods. */
const READS = ["controls", "shown", "time", "timestep", "isOver", "numbers", "findings", "contacts", "reads", "writes"] as const;
const CALLS = ["value", "set", "press", "reset", "step", "playTo", "record", "names"] as const;

/** Serves labs to the other end of a port. */
export function serve(port: Port, ready: Promise<void>): void {
  const labs = new Map<number, Lab>();
  const states = new Map<number, LabState>();
  const runs = new Map<number, AbortController>();
  let next = 1;

  const lab = (id: number): Lab => {
    const found = labs.get(id);
    if (found === undefined) throw new LabspecError("freed", "this lab was freed");
    return found;
  };
  /** Copies of what a page draws, to be handed over. */
  const frame = (of: Lab): { time: number; numbers: Float64Array; poses: Float32Array } => ({
    time: of.time, numbers: of.numbers, poses: of.poses.slice(),
  });

  const answer = async ({ lab: id, call, args }: Request): Promise<unknown> => {
    await ready;
    if (call === "open") {
      labs.set(next, args.length > 2 && typeof args[2] === "string" ? Lab.ofLesson(args[0] as string, args[1] as string, args[2], args[3] as Models) : new Lab(args[0] as string, args[1] as Models));
      return next++;
    }
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
        return { steps, ...frame(own) };
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
        const parts = typeof result === "object" && result !== null ? [result, ...Object.values(result as object)] : [];
        const buffers = parts.filter((p) => p instanceof Float64Array || p instanceof Float32Array).map((p) => p.buffer as ArrayBuffer);
        port.post({ id: request.id, result } satisfies Reply, [...new Set(buffers)]);
      },
      (e: unknown) => {
        const { code, message: why, findings } = asLabspecError(e);
        port.post({ id: request.id, error: { code, message: why, findings } } satisfies Reply, []);
      },
    );
  });
}
