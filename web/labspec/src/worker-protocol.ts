import type { FrameMemory } from "./shared-frame.js";

/** A call of the page. */
export interface Request {
  readonly id: number;
  /** The lab; 0 for calls of the worker itself. */
  readonly lab: number;
  readonly call: string;
  readonly args: readonly unknown[];
}

/** The answer of the worker. */
export interface Reply {
  readonly id: number;
  readonly result?: unknown;
  readonly error?: { readonly code: string; readonly message: string; readonly findings: readonly unknown[] };
}

/** An open lab, with the memory of its frames if memory can be shared. */
export interface OpenedLab {
  readonly id: number;
  readonly memory: FrameMemory | undefined;
}

/** The module, which the page fetches and compiles while the worker starts; or the reason that there is none. */
export interface GivenModule {
  readonly module: WebAssembly.Module | undefined;
  readonly why?: string;
}

/** One end of the channel. */
export interface Port {
  post(message: unknown, transfer: readonly ArrayBuffer[]): void;
  listen(listener: (message: unknown) => void): void;
}
