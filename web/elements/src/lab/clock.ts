/** One loop for all elements of a page that move. */

type Tick = (now: number) => void;

const ticking = new Set<Tick>();
let isRunning = false;

/** Calls `tick` in every frame of the page until the returned function is called. */
export function onEveryFrame(tick: Tick): () => void {
  ticking.add(tick);
  if (!isRunning) {
    isRunning = true;
    requestAnimationFrame(run);
  }
  return () => void ticking.delete(tick);
}

function run(now: number): void {
  for (const tick of ticking) tick(now);
  isRunning = ticking.size > 0;
  if (isRunning) requestAnimationFrame(run);
}
