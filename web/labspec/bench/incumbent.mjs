// A lab on a page as pages run it today: `@mujoco/mujoco`, and every text of the lab as JavaScript (`new Function`) over views of its memory.

/** What texts of a lab see as `sim`. */
function simulation(mj, model, data, key) {
  const sim = {
    get time() { return data.time; },
    get timestep() { return model.opt.timestep; },
    forward: () => mj.mj_forward(model, data),
    reset() {
      if (key >= 0 && key < model.nkey) mj.mj_resetDataKeyframe(model, data, key);
      else mj.mj_resetData(model, data);
      mj.mj_forward(model, data);
    },
    contacts() {
      const [out, force, list] = [[], new mj.DoubleBuffer(6), data.contact];
      for (let i = 0; i < data.ncon; i++) {
        const c = list.get(i);
        mj.mj_contactForce(model, data, i, force);
        out.push({ geom1: c.geom1, geom2: c.geom2, force: Array.from(force.GetView()) });
        c.delete();
      }
      list.delete();
      force.delete();
      return out;
    },
    energy() {
      const bit = mj.mjtEnableBit.mjENBL_ENERGY.value;
      if (!(model.opt.enableflags & bit)) {
        model.opt.enableflags |= bit;
        mj.mj_forward(model, data);
      }
      return { potential: data.energy[0], kinetic: data.energy[1], total: data.energy[0] + data.energy[1] };
    },
  };
  return sim;
}

/** What texts of a lab see as `lib`, as far as the labs of the corpus use it. */
function library(mj, model, data, sim) {
  const id = (type, name) => mj.mj_name2id(model, mj.mjtObj[type].value, name);
  const xyz = (list, i) => [list[3 * i], list[3 * i + 1], list[3 * i + 2]];
  return {
    sitePos: (name) => xyz(data.site_xpos, id("mjOBJ_SITE", name)),
    bodyPos: (name) => xyz(data.xpos, id("mjOBJ_BODY", name)),
    bodyId: (name) => id("mjOBJ_BODY", name),
    energy: () => sim.energy(),
    normalForce(name = null) {
      const geom = name ? id("mjOBJ_GEOM", name) : -1;
      return sim.contacts().reduce((sum, c) => sum + (geom < 0 || c.geom1 === geom || c.geom2 === geom ? c.force[0] : 0), 0);
    },
  };
}

/** Opens a lab. `models` are files of the official package's memory, which it has already. */
export function openPage(mj, lab) {
  const model = lab.xml ? mj.MjModel.from_xml_string(lab.xml) : mj.MjModel.from_xml_path(`/${lab.model}.xml`);
  const data = new mj.MjData(model);
  const [sim, ctx] = [simulation(mj, model, data, lab.key ?? -1), {}];
  const lib = library(mj, model, data, sim);
  const compile = (body, ...more) => new Function("model", "data", "sim", "mj", "ctx", "lib", ...more, `"use strict"; ${body}`);
  const call = (f, value) => f(model, data, sim, mj, ctx, lib, value);
  sim.forward();
  if (lab.key != null) sim.reset();
  const again = [];
  for (const c of lab.controls ?? []) {
    if (c.type === "button") continue;
    const setter = c.set ? compile(`${c.set} = value;`, "value") : c.apply ? compile(`${c.apply};`, "value") : null;
    if (c.param) ctx[c.param] = c.value;
    if (setter) call(setter, c.value);
    if (c.init && setter) again.push(() => call(setter, c.value));
  }
  if (lab.setup) {
    const setup = compile(`${lab.setup};`);
    again.unshift(() => call(setup));
  }
  again.forEach((f) => f());
  sim.forward();
  const controller = lab.controller ? compile(`${lab.controller};`) : null;
  const traces = (lab.plots ?? []).flatMap((plot) => plot.traces);
  const programs = [...traces, ...(lab.readouts ?? [])].map(({ expr }) => compile(`return (${expr});`));
  return {
    /** All steps of a frame. */
    play(time) {
      for (let n = 0; data.time < time; n++) {
        if (controller !== null) call(controller);
        mj.mj_step(model, data);
      }
    },
    /** All traces and readouts; what throws is shown as nothing. */
    sample: () => programs.map((f) => {
      try {
        return call(f);
      } catch {
        return NaN;
      }
    }),
    get time() { return data.time; },
    close() {
      data.delete();
      model.delete();
    },
  };
}
