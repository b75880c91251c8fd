/**
 * When the pictures of playing labs are drawn. Without a graphics processor, a picture takes the page longer than a frame, and many labs
 * leave no time for what the reader does. After a slow picture, all labs of the page wait before the next one.
 */

/** A picture that takes longer is slow, ms. */
const SLOW = 40;
/** The page rests for this multiple of the time of a slow picture, and at most for this time, ms. */
const REST = 2, MOST_REST = 1000;
/** Slow pictures wait for the answer to what the reader did, at most for this time, ms. */
const ANSWER = 100;

/** The views that wait, in the order in which they asked. */
const waiting = new Set<() => void>();
let timer: ReturnType<typeof setTimeout> | undefined;
/** When the reader did something last. */
let touched = -Infinity;

for (const type of ["keydown", "pointerdown", "pointermove", "input"]) {
  addEventListener(type, () => {
    touched = performance.now();
  }, { capture: true, passive: true });
}

function drawNow(draw: () => void): void {
  const start = performance.now();
  draw();
  const took = performance.now() - start;
  if (took > SLOW) timer = setTimeout(drawNext, Math.min(REST * took, MOST_REST));
}

function drawNext(): void {
  const left = touched + ANSWER - performance.now();
  timer = left > 0 && waiting.size > 0 ? setTimeout(drawNext, left) : undefined;
  if (timer !== undefined) return;
  for (const draw of waiting) {
    waiting.delete(draw);
    drawNow(draw);
    if (timer !== undefined) return;
  }
}

/** Draws now, or after a rest and after the views that wait already. `draw` is one function for each view, and draws what is current then. */
export function drawPaced(draw: () => void): void {
  if (timer === undefined) drawNow(draw);
  else waiting.add(draw);
}

/** A view that is gone waits no longer. */
export function forgetPaced(draw: () => void): void {
  waiting.delete(draw);
}
