// What a player does with the answers of an engine.
import assert from "node:assert/strict";
import test from "node:test";
import { load } from "./load.mjs";

globalThis.requestAnimationFrame = () => 0;
const { createPlayer } = await load("lab/player.ts");
const settled = () => new Promise((resolve) => setImmediate(resolve));
const frame = { isOver: true };

/** A player, its calls that wait for an answer, and what it tells. */
function playerOf() {
  const [calls, told] = [[], []];
  const ask = (call) => new Promise((resolve, reject) => calls.push({ call, resolve, reject }));
  const tell = (name) => () => told.push(name);
  const player = createPlayer({ opened: { frame }, ask }, {
    frame: tell("frame"), playing: (isPlaying) => told.push(isPlaying ? "play" : "pause"), slow: () => undefined, failed: tell("failed"), resetting: () => undefined,
  });
  return { player, calls, told };
}

test("a closed player tells nothing, whatever is answered then", async () => {
  const { player, calls, told } = playerOf();
  player.play();
  player.step(1);
  const refused = player.press("Kick");
  player.set("gravity", 1);
  const waiting = player.set("gravity", 2);
  player.close();
  assert.deepEqual(calls.map(({ call }) => call), ["reset", "step", "press", "set", "free"]);
  calls[0].resolve(frame);
  calls[1].resolve(frame);
  calls[2].reject(new Error("no"));
  await assert.rejects(refused, /no/);
  calls[3].resolve(frame);
  await settled();
  calls[5].reject(new Error("this lab is closed"));
  await assert.rejects(waiting, /closed/);
  assert.deepEqual([told, player.isPlaying], [[], false]);
});

test("a lab that is over and is played twice begins once", async () => {
  const { player, calls, told } = playerOf();
  player.play();
  player.play();
  for (const { resolve } of calls) resolve({ isOver: false });
  await settled();
  assert.deepEqual(told, ["frame", "frame", "play"]);
});
