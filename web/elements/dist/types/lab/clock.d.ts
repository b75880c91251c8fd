/** One loop for all elements of a page that move. */
type Tick = (now: number) => void;
/** Calls `tick` in every frame of the page until the returned function is called. */
export declare function onEveryFrame(tick: Tick): () => void;
export {};
