/** A lab that is played. The page asks for frames. */
import { Lab, type ControlValue, type Models, type Playback } from "labspec/slim";
import { decimate } from "./decimate.js";
import { springForce } from "./drag.js";
import type { Drag, EngineEvent, Frame, Opened } from "./messages.js";
import { readSceneFrame, readSceneModel, sceneModelChanged, writtenSceneFields } from "./scene.js";

/** The number of steps during which the force of a drag is constant. */
const PIECE = 8;
/** The part of a step that rounding may take from a time that is a whole number of steps. */
const ROUNDING = 1e-9;
/** Warnings of the engine after which it has reset the data. */
const BREAKDOWNS: readonly string[] = ["badqpos", "badqvel", "badqacc"];
const NO_FORCE = [0, 0, 0, 0, 0, 0];

export interface Session {
  readonly lab: Lab;
  readonly names: readonly string[];
  readonly controls: Lab["controls"];
  /** The columns of samples that are plotted. */
  readonly traces: readonly number[];
  readonly written: ReturnType<typeof writtenSceneFields>;
  /** The number of findings that were sent to the page. */
  reported: number;
  sent: ReturnType<typeof readSceneModel>;
  rows: number[][];
  events: EngineEvent[];
  drag: Drag | null;
  /** Whether the time has gone back since the last frame. */
  isRestarted: boolean;
  /** What programs have asked of the page since the last frame. */
  playback: Playback | null;
  /** The requested time that no step has used yet, shorter than a step, s. */
  carry: number;
}

/** Opens a lab, or one in a saved state. */
export function openSession(json: string, models: Models, state: Uint8Array | null): Session {
  const lab = state === null ? new Lab(json, models) : Lab.resume(state, json, models);
  const traces = lab.shown.flatMap((one, i) => (one.plot === undefined ? [] : [i]));
  const session: Session = {
    lab, names: geomNames(lab), controls: lab.controls, traces, written: writtenSceneFields(lab), sent: readSceneModel(lab),
    reported: lab.findings.length, rows: [], events: [], drag: null, isRestarted: false, playback: null, carry: 0,
  };
  lab.on("contact", ({ time, geom1, geom2, touching }) => {
    const [first, second] = [session.names[geom1] ?? "", session.names[geom2] ?? ""];
    session.events.push({ type: "contact", time, first, second, touching });
  });
  lab.on("warning", ({ time, kind }) => {
    if (BREAKDOWNS.includes(kind)) session.events.push({ type: "restart", time });
  });
  lab.on("end", ({ time }) => session.events.push({ type: "stop", time }));
  sample(session);
  session.playback = lab.takePlayback();
  return session;
}

/** The description of an opened lab, for the page. */
export function describeOpened(id: number, session: Session): Opened {
  const { lab } = session;
  const dofs = lab.model.body_dofnum;
  const parents = lab.model.body_parentid;
  const movable: boolean[] = [];
  for (let body = 0; body < dofs.length; body++) movable.push(body > 0 && ((dofs[body] ?? 0) > 0 || movable[parents[body] ?? 0] === true));
  return {
    id, controls: session.controls, shown: lab.shown, findings: lab.findings, model: session.sent, textures: lab.textures, frame: takeFrame(session, 0),
    timestep: lab.timestep, bodies: lab.names("body"), sites: lab.names("site"), movable,
  };
}

/** Plays for a number of simulated seconds. The work ends after `budget` milliseconds. */
export function advance(session: Session, seconds: number, budget: number): Frame {
  const { lab } = session;
  const deadline = performance.now() + budget;
  const time = createBudget(session.carry + seconds);
  outer: while (!lab.isOver && time.allows(lab.timestep)) {
    pull(session);
    for (let i = 0; i < PIECE && time.allows(lab.timestep); i++) {
      time.use(lab.timestep);
      const isRestarted = stepOnce(session);
      // A program that pauses the page pauses it at this step.
      const isPaused = session.playback === "pause" || session.playback === "toggle";
      if (isPaused) time.end();
      if (lab.isOver || isRestarted || isPaused || performance.now() >= deadline) break outer;
    }
  }
  const left = lab.isOver ? 0 : time.left();
  session.carry = Math.min(left, lab.timestep);
  return takeFrame(session, Math.max(0, left - lab.timestep));
}

/** Simulated time that steps use up. */
export interface Budget {
  left(): number;
  /** Whether a step fits. */
  allows(timestep: number): boolean;
  use(timestep: number): void;
  end(): void;
}

/** A budget of some seconds. Steps of the same length are counted, so that their rounding does not add up. */
export function createBudget(seconds: number): Budget {
  let [asked, length, count] = [seconds, 0, 0];
  const left = (): number => asked - count * length;
  return {
    left,
    allows: (timestep) => left() >= timestep * (1 - ROUNDING),
    use(timestep) {
      if (timestep !== length) [asked, length, count] = [left(), timestep, 0];
      count++;
    },
    end() {
      [asked, count] = [0, 0];
    },
  };
}

/** Makes a number of steps. */
export function stepSession(session: Session, steps: number): Frame {
  session.carry = 0;
  for (let i = 0; i < steps && !session.lab.isOver; i++) {
    if (i % PIECE === 0) pull(session);
    stepOnce(session);
  }
  return takeFrame(session, 0);
}

/** Changes the lab and samples it. */
export function actOn(session: Session, what: (lab: Lab) => void): Frame {
  if (observe(session, what)) session.carry = 0;
  return takeFrame(session, 0);
}

/** Sets a control. */
export function setControl(session: Session, label: string, value: ControlValue): Frame {
  return actOn(session, (lab) => lab.set(label, value));
}

/** Drags a body with a spring, or lets it go. */
export function setDrag(session: Session, drag: Drag | null): Frame {
  const { lab } = session;
  const body = session.drag?.body;
  if (body !== undefined && body !== drag?.body) lab.applyForce(body, NO_FORCE);
  session.drag = drag;
  pull(session);
  return takeFrame(session, 0);
}

function pull(session: Session): void {
  if (session.drag !== null) session.lab.applyForce(session.drag.body, springForce(session.lab, session.drag));
}

/** Makes one step. Returns whether the lab was reset: by a program, or by the engine because of a bad number. */
function stepOnce(session: Session): boolean {
  return observe(session, (lab) => lab.step());
}

/** Acts on the lab and samples it. Returns whether the time has gone back: earlier samples are forgotten then. */
function observe(session: Session, act: (lab: Lab) => void): boolean {
  const before = session.lab.time;
  act(session.lab);
  const isRestarted = session.lab.time < before;
  if (isRestarted) [session.rows, session.isRestarted] = [[], true];
  sample(session);
  notePlayback(session);
  return isRestarted;
}

/** Keeps the last request of programs to play or to pause. */
function notePlayback(session: Session): void {
  session.playback = session.lab.takePlayback() ?? session.playback;
}

function sample(session: Session): void {
  session.rows.push([session.lab.time, ...session.lab.numbers]);
}

/** The next frame: the changes since the last one. */
function takeFrame(session: Session, behind: number): Frame {
  const { lab, events } = session;
  const found = lab.findings;
  for (const finding of found.slice(session.reported)) events.push({ type: "finding", time: lab.time, finding });
  session.reported = found.length;
  const rows = Float64Array.from(decimate(session.rows, session.traces).flat());
  const { playback, isRestarted } = session;
  [session.rows, session.events, session.playback, session.isRestarted] = [[], [], null, false];
  const changed = session.written.length > 0 && sceneModelChanged(lab, session.sent, session.written);
  if (changed) session.sent = readSceneModel(lab);
  return {
    time: lab.time, numbers: lab.numbers, texts: lab.readoutTexts, rows, scene: readSceneFrame(lab),
    ...(changed ? { model: session.sent } : {}), events, isRestarted, isOver: lab.isOver,
    values: session.controls.map((control) => lab.value(control.label)), playback, behind,
  };
}

/** Names of geoms for readers: the name of the geom, otherwise that of its body. */
function geomNames(lab: Lab): string[] {
  const [geoms, bodies, of] = [lab.names("geom"), lab.names("body"), lab.model.geom_bodyid];
  return geoms.map((name, i) => {
    const body = bodies[of[i] ?? 0] ?? "";
    return name !== "" ? name : body !== "" && (of[i] ?? 0) > 0 ? body : `geom ${i}`;
  });
}
