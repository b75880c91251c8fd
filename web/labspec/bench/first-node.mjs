// The first step in node: a new process imports the package, opens free fall and makes a step; labspec and the official package in turn.
//
//   node bench/first-node.mjs
//
// Prints medians and the fastest, ms from before the import.
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";

const XML = "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>";

async function labspec() {
  const { Lab } = await import("../dist/node.js");
  const lab = new Lab({ xml: XML, readouts: [{ label: "z", expr: "data.qpos[2]" }] });
  lab.step();
  return lab.numbers[0];
}

async function official() {
  const { default: load } = await import("@mujoco/mujoco");
  const mujoco = await load();
  const model = mujoco.MjModel.from_xml_string(XML);
  const data = new mujoco.MjData(model);
  mujoco.mj_step(model, data);
  return data.qpos[2];
}

const PACKAGES = { labspec, official };
const which = process.argv[2];
if (which !== undefined) {
  const start = performance.now();
  const z = await PACKAGES[which]();
  const ms = performance.now() - start;
  if (!(z > 0.99 && z < 1)) throw new Error(`${which}: the ball is at ${z}`);
  process.stdout.write(String(ms));
} else {
  const times = Object.fromEntries(Object.keys(PACKAGES).map((name) => [name, []]));
  for (let round = 0; round < 15; round++) {
    for (const name of Object.keys(times)) {
      times[name].push(Number(execFileSync(process.execPath, [fileURLToPath(import.meta.url), name])));
    }
  }
  for (const [name, list] of Object.entries(times)) {
    list.sort((a, b) => a - b);
    console.log(`${name}: ${list[7].toFixed(0)} ms, the fastest ${list[0].toFixed(0)} ms`);
  }
}
