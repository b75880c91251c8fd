/** A promise that is settled from outside. */
export interface Deferred {
  readonly promise: Promise<void>;
  resolve(): void;
  reject(e: unknown): void;
}

export function deferred(): Deferred {
  let [resolve, reject]: [() => void, (e: unknown) => void] = [() => undefined, () => undefined];
  const promise = new Promise<void>((fulfil, refuse) => {
    [resolve, reject] = [fulfil, refuse];
  });
  // Whoever waits for it is told; nobody need wait.
  promise.catch(() => undefined);
  return { promise, resolve: () => resolve(), reject: (e) => reject(e) };
}
