// Access by name, which the JavaScript build has not as lessons write it: `data.joint('arm').qpos[0]`, `model.geom('floor').friction`.
// A member is that part of the array `prefix_member`, or `member`, which belongs to the object; what is written into it is written there.

const KINDS = {
  body: ['BODY', 'nbody', 'body_'], joint: ['JOINT', 'njnt', 'jnt_'], geom: ['GEOM', 'ngeom', 'geom_'], site: ['SITE', 'nsite', 'site_'],
  camera: ['CAMERA', 'ncam', 'cam_'], light: ['LIGHT', 'nlight', 'light_'], tendon: ['TENDON', 'ntendon', 'tendon_', 'ten_'],
  actuator: ['ACTUATOR', 'nu', 'actuator_'], sensor: ['SENSOR', 'nsensor', 'sensor_'], equality: ['EQUALITY', 'neq', 'eq_'], key: ['KEY', 'nkey', 'key_'],
};
const COORDINATES = [7, 4, 1, 1], SPEEDS = [6, 3, 1, 1];

// Where the rows of an object begin in an array of this name, how many there are, and of how many in all.
function rows(model, kind, i, field) {
  if (kind === 'joint') {
    const type = model.jnt_type[i];
    if (/^qpos/.test(field)) return [model.jnt_qposadr[i], COORDINATES[type], model.nq];
    if (/^(q|dof_|cdof)/.test(field)) return [model.jnt_dofadr[i], SPEEDS[type], model.nv];
  }
  if (kind === 'sensor' && field === 'sensordata') return [model.sensor_adr[i], model.sensor_dim[i], model.nsensordata];
  return [i, 1, model[KINDS[kind][1]]];
}

function view(mj, model, of, kind, name) {
  const [type, , ...prefixes] = KINDS[kind];
  const i = typeof name === 'number' ? name : mj.mj_name2id(model, mj.mjtObj[`mjOBJ_${type}`].value, name);
  if (!(i >= 0)) throw new Error(`no ${kind} ${name}`);
  const part = (member) => {
    const named = kind === 'sensor' && member === 'data' ? ['sensordata'] : [member, ...prefixes.map((p) => p + member), ...(kind === 'joint' ? [`dof_${member}`] : [])];
    // The array that is named for the kind comes first: a geom's xpos is geom_xpos, a body's is xpos.
    const field = [...named.slice(1), named[0]].find((f) => of[f] !== undefined && of[f] !== null && of[f].length !== undefined);
    if (field === undefined) throw new ReferenceError(`${kind} has no ${member} here`);
    const [first, count, all] = rows(model, kind, i, field), width = of[field].length / all;
    if (!Number.isInteger(width)) throw new ReferenceError(`${kind} has no ${member} here`);
    return of[field].subarray(first * width, (first + count) * width);
  };
  return new Proxy({}, {
    get: (_, member) => (member === 'id' ? i : member === 'name' ? name : typeof member === 'string' ? part(member) : undefined),
    set: (_, member, value) => { const to = part(member); if (typeof value === 'object') to.set(value); else to[0] = value; return true; },
  });
}

// The JavaScript build hands out no arrays of flags: which equalities are active is read and written as the part of the state that it is.
function active(mj, model, data) {
  const part = mj.mjtState.mjSTATE_EQ_ACTIVE.value, n = model.neq;
  const read = () => { const b = new mj.DoubleBuffer(n); try { mj.mj_getState(model, data, b, part); return Array.from(b.GetView()); } finally { b.delete(); } };
  const write = (i, x) => { const all = read(); all[i] = x ? 1 : 0; mj.mj_setState(model, data, all, part); return true; };
  return new Proxy(n ? read() : [], { set: (_, i, x) => write(Number(i), x) });
}

// Gives a model and its data the functions that lessons call.
export function byName(mj, model, data) {
  for (const of of [model, data]) for (const kind of Object.keys(KINDS)) {
    Object.defineProperty(of, kind, { value: (name) => view(mj, model, of, kind, name) });
  }
  Object.defineProperty(data, 'eq_active', { get: () => active(mj, model, data) });
}
