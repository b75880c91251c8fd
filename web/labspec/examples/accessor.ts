// A model compiled, expressions compiled against it, and their values.
import { Data, Expression, LabspecError, Model } from "labspec";

const model = Model.fromXML(`<mujoco><worldbody><geom type='plane' size='1 1 1'/>
  <body name='bob' pos='0 0 1'><freejoint name='fall'/><geom size='0.1'/></body></worldbody></mujoco>`);
const data = new Data(model);
const height = new Expression(model, "data.joint('fall').qpos[2]");
new Expression(model, "data.joint('fall').qvel[2] = -1", "statements").evaluate(data);
const start = height.number(data);
data.step(1000);
console.log(`${start} m, then ${height.number(data).toFixed(3)} m`);
try {
  new Expression(model, "data.joint('fal').qpos[2]");
} catch (e) {
  if (!(e instanceof LabspecError)) throw e;
  const [finding] = e.findings;
  console.log(`column ${finding?.column}: ${finding?.message}; ${finding?.help}`);
}
