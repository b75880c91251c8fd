// A lab that a page opens, moves, plays and brings back.
import { Lab } from "labspec";

const drop = `<mujoco><worldbody><geom type='plane' size='1 1 1'/>
  <body name='bob' pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>`;
const json = {
  model: "drop",
  controls: [{ label: "gravity", unit: "m/s^2", set: "model.opt.gravity[2]", min: -20, max: -1, step: 0.1, value: -9.8, reset: true }],
  plots: [{ ylabel: "height (m)", traces: [{ label: "bob", expr: "data.body('bob').xpos[2]" }] }],
};

const lab = new Lab(json, { drop });
const height = (): string => (lab.numbers[0] ?? NaN).toFixed(4);
lab.playTo(0.2);
const [earth, saved] = [height(), lab.save()];
lab.set("gravity", -1.6);
lab.playTo(0.2);
console.log(`${lab.shown[0]?.label}: ${earth} m, on the moon ${height()}`);
lab.restore(saved);
console.log(`restored: ${height()}, ${lab.findings.length} findings`);
