// The engine alone: fields by MuJoCo's names, rays, contacts, states.
import { Data, Model } from "labspec";

using model = Model.fromXML(`<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/>
  <body name='bob' pos='0 0 1'><freejoint/><geom name='ball' size='0.1' mass='2'/></body></worldbody></mujoco>`);
using data = new Data(model);
model.opt.gravity = [0, 0, -5];
data.qvel[2] = 1;
const saved = data.save();
while (data.time < 2) data.step();
console.log(`qpos has the shape [${data.qpos.shape.join(", ")}], ${data.ncon} contact`);
for (const { geom1, geom2, force } of data.contacts) {
  const names = model.names("geom");
  console.log(`${names[geom1]} and ${names[geom2]}: ${(force[0] ?? NaN).toFixed(2)} N`);
}
const hit = data.ray([0, 0, 3], [0, 0, -1]);
console.log(`a ray meets ${model.names("geom")[hit?.geom ?? -1]} after ${hit?.distance.toFixed(2)} m`);
data.restore(saved);
console.log(`again at ${data.time} s`);
