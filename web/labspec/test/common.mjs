/** A ball over a floor. */
export const drop = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='bob' pos='0 0 1'><freejoint/><geom name='ball' size='.1'/></body></worldbody></mujoco>";
export const lab = {
  model: "drop",
  controls: [
    { label: "gravity", unit: "m/s^2", set: "model.opt.gravity[2]", min: -20, max: -1, step: 0.1, value: -9.8, reset: true },
    { type: "button", label: "kick", run: "data.qvel[2] = 3" },
  ],
  readouts: [{ label: "height (m)", expr: "data.body('bob').xpos[2]" }],
};
/** The bits of numbers. */
export const bits = (list) => [...new BigUint64Array(Float64Array.from(list).buffer)].join();
