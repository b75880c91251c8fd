import type { Finding } from "./error.js";

/** Models by name, as MJCF or as the bytes of `Model.toBytes`, and files that they name, by path. */
export type Models = Readonly<Record<string, string | Uint8Array>>;

/** A value of a control. */
export type ControlValue = number | string | boolean;

/** A slider, a select or a button. */
export interface Control {
  readonly kind: "slider" | "select" | "button";
  readonly label: string;
  readonly start: ControlValue | null;
  readonly min?: number;
  readonly max?: number;
  readonly step?: number;
  readonly unit?: string;
  readonly digits?: number;
  /** Text and value of each option. */
  readonly options?: readonly (readonly [string, ControlValue | null])[];
}

/** A trace of a plot, or a readout. */
export interface Shown {
  readonly label: string;
  readonly unit: string;
  /** The plot of a trace, from 0. */
  readonly plot?: number;
  /** The decimals of a readout. */
  readonly digits?: number;
}

/** What programs of a lab ask of the page: `sim.play()`, `sim.pause()`, `sim.toggle()`. */
export type Playback = "play" | "pause" | "toggle";

/** A texture as the model declares it. Numbers of words are MuJoCo's: `mjtTexture`, `mjtBuiltin`, `mjtMark`. */
export interface TextureDeclaration {
  readonly type: number;
  readonly builtin: number;
  readonly mark: number;
  readonly rgb1: readonly number[];
  readonly rgb2: readonly number[];
  readonly markrgb: readonly number[];
  /** The probability of a random mark at a pixel. */
  readonly random: number;
  readonly width: number;
  readonly height: number;
  /** The channels of a file. */
  readonly channels: number;
  /** Paths of files: none, one, or one for each face (right, left, up, down, front, back; empty where a face has none). */
  readonly files: readonly string[];
  /** Rows and columns of the faces in one file, and the letter of the face in each cell. */
  readonly gridsize: readonly number[];
  readonly gridlayout: string;
  readonly hflip: boolean;
  readonly vflip: boolean;
}

/** Warnings of the engine, by MuJoCo's names: an inertia matrix that is near singular, more contacts or constraints than there is room for, and bad numbers. */
export type WarningKind = "inertia" | "contactfull" | "cnstrfull" | "badqpos" | "badqvel" | "badqacc" | "badctrl";

/** The events of `lab.on`, by type. */
export interface LabEvents {
  /** Two geoms begin or cease to touch. */
  contact: { readonly time: number; readonly geom1: number; readonly geom2: number; readonly touching: boolean };
  /** A shown number crosses a level. */
  crossing: { readonly time: number; readonly index: number; readonly level: number; readonly value: number; readonly rising: boolean };
  /** A program or the engine failed. */
  finding: Finding;
  /** The engine warns. A bad number resets the lab: `time` is then the one before. */
  warning: {
    readonly time: number;
    readonly kind: WarningKind;
    /** The coordinate, degree of freedom or actuator that causes it. */
    readonly index: number;
    /** The number of times since the last reset of the data. */
    readonly count: number;
  };
  /** The lab has stopped by itself. */
  end: { readonly time: number };
}

/** The number and level of a crossing: the number by its place in `shown`, or by its label. */
export interface Crossing {
  readonly number: number | string;
  readonly level: number;
}

/** Options of `play`. */
export interface PlayOptions {
  /** Cancels the run. The lab keeps the state that it has reached. */
  readonly signal?: AbortSignal;
  /** The work before the page gets its turn, ms; 8 by default. */
  readonly budget?: number;
  /** Called after each piece of work. */
  readonly onProgress?: (time: number) => void;
}
