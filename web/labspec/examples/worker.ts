// A lab in a worker: the page stays free, and draws frames.
import { startWorker } from "labspec/worker";

const drop = `<mujoco><worldbody><geom type='plane' size='1 1 1'/>
  <body name='bob' pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>`;
const worker = startWorker();
const lab = await worker.open({ model: "drop", readouts: [{ label: "height (m)", expr: "data.body('bob').xpos[2]" }] }, { drop });
const { steps, time, numbers, poses } = await lab.play(0.2);
console.log(`${steps} steps, ${time.toFixed(1)} s, ${numbers[0]?.toFixed(4)} m, ${poses.length / 16} poses`);
await worker.open("{", {}).catch((e: Error) => console.log(e.message));
worker.terminate();
