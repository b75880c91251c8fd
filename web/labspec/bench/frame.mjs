// One frame of a lab by the package and by the page of `incumbent.mjs`: runs in node and in a page.
import { openPage } from "./incumbent.mjs";

const middle = (list) => list.sort((a, b) => a - b)[list.length >> 1];
const ROUNDS = 9;
const FRAMES = 300;
const SAMPLES = 3000;

/** Microseconds of both, medians of rounds in turn: a frame with its steps, and without them. */
export function measureFrames(Lab, mj, text, models) {
  const lab = new Lab(text, models);
  const page = openPage(mj, JSON.parse(text));
  const frame = [
    () => {
      lab.playTo(lab.time + 1 / 60);
      return lab.numbers;
    },
    () => {
      page.play(page.time + 1 / 60 - 1e-9);
      return page.sample();
    },
  ];
  // To play to the present is no step: what is shown is computed.
  const sample = [
    () => {
      lab.playTo(lab.time);
      return lab.numbers;
    },
    () => page.sample(),
  ];
  const time = (f, times) => {
    const start = performance.now();
    for (let i = 0; i < times; i++) f();
    return ((performance.now() - start) / times) * 1e3;
  };
  const measure = (pair, times) => {
    const all = [[], []];
    for (let round = 0; round < ROUNDS; round++) pair.forEach((f, i) => all[i].push(time(f, times)));
    return all.map(middle);
  };
  warmUp(frame);
  const result = { frame: measure(frame, FRAMES), sample: measure(sample, SAMPLES), shown: lab.shown.length, steps: Math.round(1 / 60 / lab.timestep) };
  page.close();
  lab.free();
  return result;
}

/** The code of both is compiled for speed before it is measured. */
function warmUp(both) {
  for (let i = 0; i < FRAMES; i++) both.forEach((f) => f());
}
