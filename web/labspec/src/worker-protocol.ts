import type { FrameMemory } from "./shared-frame.js";

/** What a page asks of the worker. */
export interface Request {
  readonly id: number;
  /** The lab; 0 for calls of the worker itself. */
  readonly lab: number;
  readonly call: string;
  readonly args: readonly unknown[];
}

/** What the worker answers. */
export interface Reply {
  readonly id: number;
  readonly result?: unknown;
  readonly error?: { readonly code: string; readonly message: string; readonly findings: readonly unknown[] };
}

/** A lab that the worker has opened; with memory for its frames where that can be shared. */
export interface OpenedLab {
  readonly id: number;
  readonly memory: FrameMemory | undefined;
}

/** The module, which the page fetches and compiles while the worker starts; or why there is none. */
export interface GivenModule {
  readonly module: WebAssembly.Module | undefined;
  readonly why?: string;
}

/** Either end. */
export interface Port {
  post(message: unknown, transfer: readonly ArrayBuffer[]): void;
  listen(listener: (message: unknown) => void): void;
}
