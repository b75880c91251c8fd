// Runs the texts of a lab in JavaScript: {states, objects, jobs} in, one line of findings for each job out, empty where
// everything agrees to the bit. Functions of the simulation are not run again: what they gave, and the state that they
// left, is recorded with the job.
const input = JSON.parse(require('fs').readFileSync(0, 'utf8'));
const view = new DataView(new ArrayBuffer(8));
const bits = (x) => { view.setFloat64(0, x); return view.getBigUint64(0).toString(16); };
const show = (v) => {
  if (typeof v === 'number') return Number.isNaN(v) ? 'NaN' : `${v} (${bits(v)})`;
  if (v !== null && typeof v === 'object') return '[' + Array.from(v, show).join(' ') + ']';
  return v === undefined ? 'undefined' : JSON.stringify(v);
};
// JSON has no NaN, no infinity and no undefined: they come as {"$": "NaN"}.
const revive = (v) => {
  if (Array.isArray(v)) return v.map(revive);
  if (v === null || typeof v !== 'object') return v;
  if ('$' in v) return v.$ === 'undefined' ? undefined : Number(v.$);
  return Object.fromEntries(Object.entries(v).map(([k, x]) => [k, revive(x)]));
};
const ARRAYS = { F64: Float64Array, I32: Int32Array, Bool: Uint8Array, Size: Int32Array };

// A state as the objects that a page has: typed arrays, and numbers for what is no array.
function open(state, objects) {
  const roots = { model: { opt: {}, stat: {} }, data: {} };
  const holder = (path) => path.reduce((o, name) => o[name], roots);
  const fields = new Map();
  for (const [name, { type, scalar, values }] of Object.entries(state)) {
    const path = name.split('.'), last = path.pop(), parent = holder(path);
    const numbers = revive(values);
    if (!scalar) parent[last] = ARRAYS[type].from(numbers);
    else {
      // A number of the library keeps what its type can hold.
      const place = ARRAYS[type].from(numbers);
      Object.defineProperty(parent, last, { get: () => place[0], set: (x) => { place[0] = x; }, enumerable: true });
    }
    fields.set(name, {
      read: () => (scalar ? [parent[last]] : parent[last]),
      write: (x) => { if (scalar) parent[last] = x[0]; else if (parent[last].length === x.length) parent[last].set(x); else parent[last] = ARRAYS[type].from(x); },
      part: (first, n) => parent[last].subarray(first, first + n),
    });
  }
  for (const [path, names] of Object.entries(objects)) {
    const [side, noun] = path.split('.');
    if (noun in roots[side]) continue;
    roots[side][noun] = (name) => {
      if (!(name in names)) throw new Error(`no ${noun} ${name}`);
      return Object.fromEntries(Object.entries(names[name]).map(([member, m]) => [member, Array.isArray(m) ? fields.get(m[0]).part(m[1], m[2]) : m]));
    };
  }
  return { ...roots, fields };
}

function run({ text, kind, value, state, ctx, calls, gives, after, kept }, states, objects) {
  const { model, data, fields } = open(states[state], objects);
  const queue = calls.slice();
  const recorded = (holder, own) => new Proxy(own, {
    get: (target, name) => {
      if (name in target) return target[name];
      return () => {
        const call = queue.shift();
        if (call?.name !== `${holder}.${name}`) throw new Error(`${holder}.${name} is called, not ${call?.name}`);
        for (const [field, x] of Object.entries(call.after)) fields.get(field).write(revive(x));
        return revive(call.result);
      };
    },
  });
  const id = (side, noun, name) => objects[`${side}.${noun}`][name].id;
  const place = (noun, field) => (name) => { const i = 3 * id('data', noun, name); return [field[i], field[i + 1], field[i + 2]]; };
  const lib = recorded('lib', {
    bodyPos: place('body', data.xpos), sitePos: place('site', data.site_xpos),
    bodyId: (name) => id('data', 'body', name), jointId: (name) => id('data', 'joint', name),
    qpos: (name) => data.qpos[model.jnt_qposadr[id('data', 'joint', name)]],
    norm: (v) => Math.hypot(...v), deg: (r) => (r * 180) / Math.PI, rad: (d) => (d * Math.PI) / 180,
  });
  const sim = recorded('sim', { get time() { return data.time; }, get timestep() { return model.opt.timestep; } });
  const here = revive(ctx);
  const body = { value: `return (${text});`, statements: `${text};`, target: `${text} = value;` }[kind];
  let result, thrown = false;
  try {
    result = new Function('model', 'data', 'sim', 'mj', 'ctx', 'lib', 'value', `"use strict"; ${body}`)(model, data, sim, recorded('mj', {}), here, lib, revive(value));
  } catch (error) { thrown = `throws ${error.message}`; }
  const expected = gives === null ? 'throws' : show(revive(gives));
  const got = thrown || show(kind === 'value' ? result : undefined);
  if (gives === null ? !thrown : got !== expected) return `here ${expected}, JavaScript ${got}`;
  if (queue.length > 0) return `JavaScript does not call ${queue[0].name}`;
  const differ = (a, b) => a.length !== b.length || a.some((x, i) => show(x) !== show(b[i]));
  for (const [name, field] of fields) {
    const x = Array.from(field.read()), y = name in after ? revive(after[name]) : Array.from(ARRAYS[states[state][name].type].from(revive(states[state][name].values)));
    if (differ(x, y)) return `${name}: here ${show(y)}, JavaScript ${show(x)}`;
  }
  for (const [name, x] of Object.entries(revive(kept))) if (show(here[name]) !== show(x)) return `ctx.${name}: here ${show(x)}, JavaScript ${show(here[name])}`;
  return '';
}
console.log(input.jobs.map((job) => run(job, input.states, input.objects)).join('\n'));
