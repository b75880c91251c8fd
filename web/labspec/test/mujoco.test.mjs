// The names of the official package: the examples of its README and a viewer's main loop, here and, where it is installed, there.
import assert from "node:assert/strict";
import test from "node:test";
import loadOfficial from "@mujoco/mujoco";
import loadMujoco, { LabspecError } from "labspec/mujoco";

const xml = `<mujoco><option timestep='0.002'/><worldbody><geom name='floor' type='plane' size='1 1 1'/><light name='sun' pos='0 0 3'/>
  <body name='arm' pos='0 0 1'><joint name='swing' axis='0 1 0'/><geom name='rod' type='capsule' fromto='0 0 0 .5 0 0' size='.03'/><site name='tip' pos='.5 0 0'/></body>
  <body name='ball' pos='1 0 .3'><freejoint name='free'/><geom name='shell' size='.1'/></body></worldbody>
  <actuator><motor name='motor' joint='swing' gear='2'/></actuator><sensor><framepos name='where' objtype='site' objname='tip'/></sensor>
  <keyframe><key name='up' qpos='1 1 0 .5 1 0 0 0'/></keyframe></mujoco>`;

const packages = [["labspec/mujoco", loadMujoco], ["@mujoco/mujoco", loadOfficial]];

/** All numbers that a page reads in some seconds. */
function loop(mj) {
  const seen = [];
  const model = mj.MjModel.from_xml_string(xml);
  const data = new mj.MjData(model);
  // A viewer's main loop: step until the simulation has caught up with the clock, then read the poses.
  for (let frame = 1; frame <= 60; frame++) {
    while (data.time < frame / 60) {
      data.ctrl[0] = Math.sin(data.time);
      mj.mj_step(model, data);
    }
    for (let b = 0; b < model.nbody; b++) seen.push(...data.xpos.subarray(b * 3, b * 3 + 3), ...data.xquat.subarray(b * 4, b * 4 + 4));
    for (let g = 0; g < model.ngeom; g++) seen.push(model.geom_type[g], ...model.geom_rgba.subarray(g * 4, g * 4 + 4), ...data.geom_xpos.subarray(g * 3, g * 3 + 3));
  }
  const contacts = data.contact;
  seen.push(contacts.size(), data.ncon, contacts.get(0).dist, contacts.get(0).geom1, ...contacts.get(0).frame, ...contacts.get(0).pos);
  contacts.delete();
  const force = new mj.DoubleBuffer(6);
  mj.mj_contactForce(model, data, 0, force);
  seen.push(...force.GetView());
  const dense = mj.DoubleBuffer.FromArray(new Array(model.nv * model.nv).fill(0));
  mj.mj_fullM(model, data, dense);
  seen.push(...dense.GetView());
  const size = mj.mj_stateSize(model, mj.mjtState.mjSTATE_PHYSICS.value);
  const state = new mj.DoubleBuffer(size);
  mj.mj_getState(model, data, state, mj.mjtState.mjSTATE_PHYSICS.value);
  seen.push(size, ...state.GetView());
  const [jacp, jacr] = [new mj.DoubleBuffer(3 * model.nv), new mj.DoubleBuffer(3 * model.nv)];
  mj.mj_jacSite(model, data, jacp, jacr, 0);
  seen.push(...jacp.GetView(), ...jacr.GetView());
  const velocity = new mj.DoubleBuffer(6);
  mj.mj_objectVelocity(model, data, mj.mjtObj.mjOBJ_BODY.value, 1, velocity, 0);
  seen.push(...velocity.GetView());
  seen.push(mj.mj_name2id(model, mj.mjtObj.mjOBJ_GEOM.value, "rod"), mj.mjNEQDATA, mj.mjtDisableBit.mjDSBL_CLAMPCTRL.value);
  assert.equal(mj.mj_id2name(model, mj.mjtObj.mjOBJ_GEOM.value, 1), "rod");
  mj.mj_resetDataKeyframe(model, data, 0);
  mj.mj_forward(model, data);
  seen.push(data.time, ...data.qpos, ...data.xpos);
  for (const [q, v] of [[[0.8, 0, 0.6, 0], [1, 2, 3]], [[0.5, 0.5, -0.5, 0.5], [-1, 0.1, 2]]]) {
    for (const [name, n, ...args] of [["mju_rotVecQuat", 3, v, q], ["mju_quat2Mat", 9, q], ["mju_mulQuat", 4, q, [1, 0, 0, 1]], ["mju_negQuat", 4, q], ["mju_axisAngle2Quat", 4, [0, 0, 1], 0.7], ["mju_euler2Quat", 4, v, "xyz"], ["mju_euler2Quat", 4, v, "XZY"], ["mju_cross", 3, v, [1, 1, 2]]]) {
      const out = new mj.DoubleBuffer(n);
      mj[name](out, ...args);
      seen.push(...out.GetView());
    }
  }
  // Named access.
  seen.push(...model.geom("rod").size, model.geom("rod").id, ...data.geom("rod").xpos, ...data.body("ball").xpos, ...data.jnt("free").qpos, ...data.jnt("swing").qvel);
  seen.push(...data.sensor("where").data, data.actuator("motor").ctrl, data.actuator("motor").force, ...model.jnt("swing").axis, model.body("ball").mass, ...data.site("tip").xpos);
  seen.push(model.geom("rod").type, Number(model.jnt("swing").limited), model.actuator("motor").gear[0], ...model.key("up").qpos, ...model.jnt("free").damping);
  model.body("ball").mass = 3;
  data.actuator("motor").ctrl = 0.5;
  seen.push(model.body_mass[2], data.ctrl[0]);
  assert.throws(() => model.geom("rood"), /Invalid name 'rood' for geom. Valid names: \['floor', 'rod', 'shell'\]/);
  data.delete();
  model.delete();
  return seen;
}

const runs = [];
for (const [name, load] of packages) {
  test(`the same page on ${name}`, async () => {
    runs.push(loop(await load()));
  });
}

test("both give the same numbers", () => {
  const [ours, theirs] = runs;
  assert.equal(ours.length, theirs.length);
  ours.forEach((x, i) => assert.ok(Math.abs(x - theirs[i]) <= 1e-6 * (1 + Math.abs(theirs[i])), `number ${i}: ${x}, ${theirs[i]}`));
});

test("the README's example of a buffer, which the official package refuses, and plain arrays", async () => {
  const mj = await loadMujoco();
  const res = new mj.DoubleBuffer([0, 0, 0]);
  try {
    mj.mju_rotVecQuat(res, [1, 0, 0], [Math.SQRT1_2, 0, 0, Math.SQRT1_2]);
    assert.ok(Math.abs(res.getView()[1] - 1) < 1e-12);
  } finally {
    res.delete();
  }
  const model = mj.MjModel.from_xml_string(xml);
  const data = new mj.MjData(model);
  for (let i = 0; i < 500; i++) mj.mj_step(model, data);
  const force = [0, 0, 0, 0, 0, 0];
  mj.mj_contactForce(model, data, 0, force);
  assert.ok(force[0] > 0);
  assert.throws(() => mj.mj_contactForce(model, data, 0, [0]), (e) => e instanceof LabspecError && e.code === "wrong-length");
  assert.throws(() => mj.mj_contactForce(model, data, 99, force), /contact 99 does not exist/);
});

test("files in memory", async () => {
  const mj = await loadMujoco();
  const vfs = new mj.MjVFS();
  vfs.addBuffer("part.xml", new TextEncoder().encode("<mujoco><worldbody><geom name='part' size='1'/></worldbody></mujoco>"));
  vfs.addBuffer("whole.xml", "<mujoco><include file='part.xml'/></mujoco>");
  assert.equal(mj.MjModel.mj_loadXML("whole.xml", vfs).geom("part").id, 0);
  vfs.deleteFile("part.xml");
  assert.throws(() => mj.MjModel.mj_loadXML("whole.xml", vfs), LabspecError);
});

test("what is missing throws by name", async () => {
  const mj = await loadMujoco();
  const absent = (what, name) => assert.throws(what, (e) => e instanceof LabspecError && e.code === "not-implemented" && e.message.includes(name));
  absent(() => mj.mjv_updateScene(), "mjv_updateScene");
  absent(() => new mj.MjvScene(), "MjvScene");
  absent(() => mj.mjtNothing.x, "mjtNothing");
  const model = mj.MjModel.from_xml_string(xml);
  const data = new mj.MjData(model);
  absent(() => model.flex_vert, "MjModel.flex_vert");
  absent(() => data.timer, "MjData.timer");
  absent(() => data.body("ball").nothing, "nothing");
});
