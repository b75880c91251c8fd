/** The messages between a page and the engine. The engine runs in a worker, or in the page where a policy forbids workers. */
import type { Control, ControlValue, Finding, Models, Playback, Shown, TextureDeclaration } from "labspec/slim";
import type { SceneFrame, SceneModel } from "../view/types.js";

/** Something that happened in a lab, with the simulated time in seconds. */
export type EngineEvent =
  | { readonly type: "contact"; readonly time: number; readonly first: string; readonly second: string; readonly touching: boolean }
  | { readonly type: "finding"; readonly time: number; readonly finding: Finding }
  | { readonly type: "stop"; readonly time: number }
  /** The engine has reset the data because of a bad number. */
  | { readonly type: "restart"; readonly time: number };

/** The state of a lab after a call. */
export interface Frame {
  /** Simulated time, s. */
  readonly time: number;
  /** The values of the traces and readouts, in the order of `shown`; NaN for a value that is not a number. */
  readonly numbers: Float64Array;
  /** The readouts as they are printed. */
  readonly texts: readonly string[];
  /** Samples since the last frame: time, then `numbers`. Of many steps, those that keep every peak of a trace. */
  readonly rows: Float64Array;
  readonly scene: SceneFrame;
  /** The constants of the scene, if a program has changed them. */
  readonly model?: SceneModel;
  readonly events: readonly EngineEvent[];
  /** Whether the time has gone back since the last frame. */
  readonly isRestarted: boolean;
  /** Whether the lab does not continue without a reset. */
  readonly isOver: boolean;
  /** The values of the controls, in their order; `null` for buttons. */
  readonly values: readonly (ControlValue | null)[];
  /** What programs of the lab ask of the page. */
  readonly playback: Playback | null;
  /** The requested simulated time that was not reached within the budget, s. */
  readonly behind: number;
}

/** A lab that was opened. */
export interface Opened {
  readonly id: number;
  readonly controls: readonly Control[];
  readonly shown: readonly Shown[];
  readonly findings: readonly Finding[];
  readonly model: SceneModel;
  /** The textures as the model declares them, by id. */
  readonly textures: readonly TextureDeclaration[];
  readonly frame: Frame;
  readonly timestep: number;
  /** Names of bodies and sites, by id. */
  readonly bodies: readonly string[];
  readonly sites: readonly string[];
  /** Whether a body can move, by id. */
  readonly movable: readonly boolean[];
}

/** A spring that drags a body: a point in the frame of the body, and where it is pulled to in the world frame, m. */
export interface Drag {
  readonly body: number;
  readonly local: readonly [number, number, number];
  readonly target: readonly [number, number, number];
}

/** The calls of a page: arguments and answers. */
export interface Calls {
  open: { args: [lab: string, models: Models, state: Uint8Array | null]; answer: Opened };
  advance: { args: [seconds: number, budget: number]; answer: Frame };
  step: { args: [steps: number]; answer: Frame };
  reset: { args: []; answer: Frame };
  set: { args: [label: string, value: ControlValue]; answer: Frame };
  press: { args: [label: string]; answer: Frame };
  drag: { args: [drag: Drag | null]; answer: Frame };
  save: { args: []; answer: Uint8Array };
  free: { args: []; answer: null };
}

/** A call of the page. `lab` is 0 for `open`. */
export interface Request {
  readonly id: number;
  readonly lab: number;
  readonly call: keyof Calls;
  readonly args: readonly unknown[];
}

/** An error as a plain object. */
export interface Problem {
  readonly code: string;
  readonly message: string;
  readonly findings: readonly Finding[];
}

/** The answer of the engine. */
export interface Reply {
  readonly id: number;
  readonly result?: unknown;
  readonly problem?: Problem;
}

/** The first message to the engine: its compiled module. It answers "ready". */
export interface Start {
  readonly module: WebAssembly.Module;
}

/** One end of the channel between a page and the engine. */
export interface Channel {
  postMessage(message: unknown, transfer: Transferable[]): void;
  onmessage: ((event: MessageEvent) => void) | null;
}
