/**
 * What the labs of a page show in its next frame: first the numbers and plots of all of them, then their pictures, as far as there is time.
 * Without a graphics processor a picture takes the page longer than a frame, and the pictures of several labs would leave no time for what
 * the reader does.
 */

/** No picture is begun in a frame after the pictures before it have taken this time, ms. */
const BUDGET = 10;
/** A picture that takes longer is slow, ms. */
const SLOW = 40;
/** After a slow picture, and after one over the budget while others wait, there is none for this multiple of its time, and at most for this time, ms. */
const REST = 2, MOST_REST = 1000;
/** Pictures that take longer than the budget wait for the answer to what the reader did, at most for this time, ms. */
const ANSWER = 100;

/** What is shown in the next frame. */
const numbers = new Set<() => void>();
/** The pictures that wait, in the order in which they were asked for. */
const pictures = new Set<() => void>();
let isAsked = false;
/** The time of the last picture, ms. */
let took = 0;
/** Until when pictures wait: after a slow one, and for an answer. */
let [restsUntil, answerUntil] = [-Infinity, -Infinity];
/** Whether a picture was drawn since pictures last waited for an answer: what the reader does all the time does not stop them. */
let isDrawnSince = true;

function readerActs(): void {
  if (isDrawnSince) answerUntil = performance.now() + ANSWER;
  isDrawnSince = false;
}

for (const type of ["keydown", "pointerdown", "input"]) addEventListener(type, readerActs, { capture: true, passive: true });
addEventListener("pointermove", ({ buttons }) => {
  if (buttons !== 0) readerActs();
}, { capture: true, passive: true });

/** An error of one lab does not stop the others. */
function guarded(what: () => void): void {
  try {
    what();
  } catch (e) {
    reportError(e);
  }
}

function askForFrame(): void {
  if (isAsked) return;
  isAsked = true;
  requestAnimationFrame(showFrame);
}

function showFrame(): void {
  isAsked = false;
  const shown = [...numbers];
  numbers.clear();
  for (const show of shown) guarded(show);
  const begin = performance.now();
  for (const draw of pictures) {
    const now = performance.now();
    if (now - begin >= BUDGET || now < restsUntil || (took > BUDGET && now < answerUntil)) break;
    pictures.delete(draw);
    guarded(draw);
    isDrawnSince = true;
    took = performance.now() - now;
    if (took > (pictures.size > 0 ? BUDGET : SLOW)) restsUntil = now + took + Math.min(REST * took, MOST_REST);
  }
  if (pictures.size > 0) askForFrame();
}

/** Shows numbers in the next frame, before any picture. */
export function showPaced(show: () => void): void {
  numbers.add(show);
  askForFrame();
}

/** Draws a picture as soon as there is time for it. `draw` is one function for each view, and draws what is current then. */
export function drawPaced(draw: () => void): void {
  pictures.add(draw);
  askForFrame();
}

/** What the reader did is answered: pictures wait no longer. */
export function answered(): void {
  answerUntil = -Infinity;
}

/** A lab that is gone shows nothing more. */
export function forgetPaced(what: () => void): void {
  numbers.delete(what);
  pictures.delete(what);
}
