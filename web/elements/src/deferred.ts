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
  // A rejection reaches the callers that wait for the promise; waiting is optional.
  promise.catch(() => undefined);
  return { promise, resolve: () => resolve(), reject: (e) => reject(e) };
}
