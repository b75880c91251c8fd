/** A promise that is settled from outside. */
export interface Deferred {
    readonly promise: Promise<void>;
    resolve(): void;
    reject(e: unknown): void;
}
export declare function deferred(): Deferred;
