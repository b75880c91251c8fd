/** A promise that is settled from outside. */
export interface Deferred {
  readonly promise: Promise<void>;
  readonly isSettled: boolean;
  resolve(): void;
  reject(e: unknown): void;
}

export function deferred(): Deferred {
  let [resolve, reject]: [() => void, (e: unknown) => void] = [() => undefined, () => undefined];
  let isSettled = false;
  const promise = new Promise<void>((fulfil, refuse) => {
    [resolve, reject] = [fulfil, refuse];
  });
  // A rejection reaches the callers that wait for the promise; waiting is optional.
  promise.catch(() => undefined);
  return {
    promise,
    get isSettled() { return isSettled; },
    resolve() {
      isSettled = true;
      resolve();
    },
    reject(e) {
      isSettled = true;
      reject(e);
    },
  };
}
