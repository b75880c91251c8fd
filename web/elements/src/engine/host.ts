/** The end of the channel in the engine: it opens labs and answers the calls of a page. */
import { init, LabspecError, type ControlValue, type Models } from "labspec/slim";
import type { Channel, Drag, Frame, Problem, Reply, Request, Start } from "./messages.js";
import { actOn, advance, describeOpened, openSession, setControl, setDrag, stepSession, type Session } from "./session.js";

/** Serves labs through a channel, whose first message is the module. */
export function serveLabs(channel: Channel): void {
  const sessions = new Map<number, Session>();
  let next = 1;
  const answer = (request: Request): unknown => {
    if (request.call === "open") {
      const [json, models, state] = request.args as [string, Models, Uint8Array | null];
      const session = openSession(json, models, state);
      sessions.set(next, session);
      return describeOpened(next++, session);
    }
    const session = sessions.get(request.lab);
    if (session === undefined) throw new LabspecError("freed", "this lab is closed");
    if (request.call === "free") {
      sessions.delete(request.lab);
      session.lab.free();
      return null;
    }
    return answerLab(session, request);
  };
  channel.onmessage = (event) => {
    const start = event.data as Start;
    init(start.module).then(
      () => {
        channel.onmessage = ({ data }) => reply(channel, data as Request, answer);
        channel.postMessage("ready", []);
      },
      (e: unknown) => channel.postMessage({ failed: describeProblem(e) }, []),
    );
  };
}

function answerLab(session: Session, { call, args }: Request): Frame | Uint8Array {
  switch (call) {
    case "advance": return advance(session, args[0] as number, args[1] as number);
    case "step": return stepSession(session, args[0] as number);
    case "reset": return actOn(session, (lab) => lab.reset());
    case "set": return setControl(session, args[0] as string, args[1] as ControlValue);
    case "press": return actOn(session, (lab) => lab.press(args[0] as string));
    case "drag": return setDrag(session, args[0] as Drag | null);
    case "save": return session.lab.save().toBytes();
    default: throw new LabspecError("unknown-function", `a lab has no \`${String(call)}\``);
  }
}

function reply(channel: Channel, request: Request, answer: (request: Request) => unknown): void {
  try {
    const result = answer(request);
    channel.postMessage({ id: request.id, result } satisfies Reply, buffersOf(result));
  } catch (e) {
    channel.postMessage({ id: request.id, problem: describeProblem(e) } satisfies Reply, []);
  }
}

function describeProblem(e: unknown): Problem {
  if (e instanceof LabspecError) return { code: e.code, message: e.message, findings: e.findings };
  return { code: "internal", message: e instanceof Error ? e.message : String(e), findings: [] };
}

/** The buffers of a frame, which are transferred. The constants of a scene are copied, because the session keeps them. */
function buffersOf(result: unknown): ArrayBuffer[] {
  const frame = result as Partial<Frame> | null;
  if (frame === null || frame.scene === undefined || frame.rows === undefined || frame.numbers === undefined) return [];
  const lists = [frame.rows, frame.numbers, ...Object.values(frame.scene)];
  const views = lists.filter((list): list is Float64Array<ArrayBuffer> => ArrayBuffer.isView(list));
  return [...new Set(views.map((view) => view.buffer))];
}
