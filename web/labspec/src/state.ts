let up = false;

/** Whether the module is ready. */
export function isReady(): boolean {
  return up;
}

export function markReady(): void {
  up = true;
}

/** Options of `init`. */
export interface InitOptions {
  /** The most memory that the module may take, in bytes. Where it is reached, calls fail. */
  readonly maximumMemory?: number;
}
