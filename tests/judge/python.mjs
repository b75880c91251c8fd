// The library of a Python interpreter in the place of the JavaScript build: for versions that npm does not have. It offers what
// scene.mjs and named.mjs use, under the same names; models and data are owned by server.py, which answers over two pipes.
//
// A field is kept here from its first reading on, as an array that a lesson may hold and write into. Each side knows what the other one
// has: a call carries all that was written since the last one, its answer all that the call has changed.
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { spawn, spawnSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';

const ARRAYS = { float64: Float64Array, float32: Float32Array, int32: Int32Array, uint8: Uint8Array, int8: Int8Array };
const bytes = (a) => Buffer.from(a.buffer, a.byteOffset, a.byteLength);

// Starts the server; gives the function that sends a message and waits for its answer. Models find their files in `folder`.
function connect(python, folder) {
  if (folder) fs.accessSync(folder);
  const script = fileURLToPath(new URL('server.py', import.meta.url)), probe = spawnSync(python, [script], { encoding: 'utf8' });
  if (probe.status !== 0) throw new Error(`${python} does not serve: ${probe.error?.message ?? probe.stderr.trim().split('\n').pop()}`);
  const dir = fs.mkdtempSync(path.join(os.tmpdir(), 'judge-')), [asked, answers] = ['asked', 'answers'].map((name) => path.join(dir, name));
  const made = spawnSync('mkfifo', [asked, answers]);
  if (made.status !== 0) throw new Error('mkfifo does not make pipes here');
  spawn(python, [script, asked, answers], { cwd: folder ?? dir, stdio: ['ignore', 'ignore', 'inherit'] }).unref();
  // Each of these waits for the other end.
  const [out, back] = [fs.openSync(asked, 'w'), fs.openSync(answers, 'r')];
  process.on('exit', () => fs.rmSync(dir, { recursive: true, force: true }));

  const send = (data) => { try { for (let at = 0; at < data.length;) at += fs.writeSync(out, data, at); } catch { throw new Error('the library gave up'); } };
  const take = (size) => {
    const data = Buffer.alloc(size);
    for (let at = 0; at < size;) { const n = fs.readSync(back, data, at, size - at); if (!n) throw new Error('the library gave up'); at += n; }
    return data;
  };
  return (message, parts) => {
    const head = Buffer.from(JSON.stringify(message)), lengths = Buffer.alloc(8);
    lengths.writeUInt32LE(head.length, 0);
    lengths.writeUInt32LE(parts.reduce((s, p) => s + p.length, 0), 4);
    send(Buffer.concat([lengths, head, ...parts]));
    const size = take(8), reply = JSON.parse(take(size.readUInt32LE(0)).toString());
    return [reply, take(size.readUInt32LE(4))];
  };
}

export function pythonLibrary(python, folder) {
  const exchange = connect(python, folder), live = new Map(), known = {};
  let made = 0;

  // One message with all that was written; then everything here is as it is there. Numbers are arrays of one.
  const ask = (message, buffers = []) => {
    const written = [], parts = [];
    for (const [id, fields] of live) for (const [name, f] of fields) {
      if (f.now.equals(f.told)) continue;
      f.told = Buffer.from(f.now);
      written.push([id, name, f.told.length]);
      parts.push(f.told);
    }
    const [reply, body] = exchange({ ...message, written }, [...parts, ...buffers.map(bytes)]);
    if (reply.error) throw new Error(reply.error);
    let at = 0;
    const next = (to) => { to.set(body.subarray(at, at + to.length)); at += to.length; };
    for (const b of buffers) next(bytes(b));
    if (reply.number) { const x = new Float64Array(1); next(bytes(x)); [reply.result] = x; }
    for (const [id, name, type, count] of reply.changed) {
      const fields = live.get(id);
      let f = fields.get(name);
      if (f?.array.length !== count) { const array = new ARRAYS[type](count); f = { array, now: bytes(array) }; fields.set(name, f); }
      next(f.now);
      f.told = Buffer.from(f.now);
    }
    return reply;
  };
  const field = (id, name) => {
    if (!live.get(id).has(name)) ask({ do: 'read', object: id, path: name });
    return live.get(id).get(name).array;
  };

  // An object with these fields: `prefix` is where it lies in the model or data. A part is made anew at each reading, a list and its
  // members too, so that what a lesson writes into a name that is no field is forgotten, as by the JavaScript build.
  const thing = (id, prefix, fields, of = {}) => {
    for (const [name, kind] of Object.entries(fields)) {
      const at = prefix + name;
      const get = kind === 'array' ? () => field(id, at) : kind === 'number' ? () => field(id, at)[0]
        : kind.part ? () => thing(id, `${at}.`, kind.part) : () => list(id, `${at}.`, kind.list);
      const set = kind === 'number' ? (x) => { field(id, at)[0] = x; } : () => { throw new TypeError(`${name} is a read-only property`); };
      Object.defineProperty(of, name.replace(/_$/, ''), { get, set, enumerable: true }); // Python calls a part of `vis` `global_`
    }
    return of;
  };
  const list = (id, prefix, fields) => {
    const size = () => field(id, `${prefix}length`)[0];
    const get = (i) => {
      const row = { delete() {} };
      for (const name of Object.keys(fields)) Object.defineProperty(row, name, { get: () => {
        const all = field(id, prefix + name), width = all.length / size();
        return width === 1 ? all[i] : all.subarray(i * width, (i + 1) * width);
      } });
      return row;
    };
    return { size, get, delete() {} };
  };

  // The fields are told with the first model and the first data.
  const create = (of, kind, message) => {
    const id = made++;
    live.set(id, new Map());
    try {
      const { fields } = ask({ ...message, as: id, fields: !known[kind] });
      known[kind] ??= fields;
    } catch (e) { live.delete(id); throw e; }
    Object.defineProperty(of, 'handle', { value: id });
    return thing(id, '', known[kind], of);
  };
  class Owned { delete() { ask({ do: 'drop', object: this.handle }); live.delete(this.handle); } }
  class MjModel extends Owned { static from_xml_string(xml) { return create(new MjModel(), 'model', { do: 'load', xml }); } }
  class MjData extends Owned { constructor(model) { super(); create(this, 'data', { do: 'make', model: model.handle }); } }
  class DoubleBuffer { constructor(n) { this.all = new Float64Array(n); } GetView() { return this.all; } delete() {} }

  const call = (name, args) => {
    const buffers = [], buffer = (a) => ({ buffer: buffers.push(a) - 1 });
    const sent = args.map((a) => (a instanceof Owned ? { object: a.handle } : a instanceof DoubleBuffer ? buffer(a.all)
      : Array.isArray(a) || ArrayBuffer.isView(a) ? buffer(Float64Array.from(a)) : typeof a === 'number' && !Number.isFinite(a) ? { number: String(a) } : a));
    return ask({ do: 'call', name, args: sent, buffers: buffers.map((b) => b.length) }, buffers).result;
  };
  const hello = ask({ do: 'hello' });
  const mj = { MjModel, MjData, DoubleBuffer };
  for (const name of hello.functions) mj[name] = (...args) => call(name, args);
  // The names of a model stay what they are.
  const names = new Map();
  for (const name of ['mj_name2id', 'mj_id2name']) mj[name] = (model, ...args) => {
    const key = `${model.handle} ${name} ${args}`;
    if (!names.has(key)) names.set(key, call(name, [model, ...args]));
    return names.get(key);
  };
  for (const [name, members] of Object.entries(hello.enums)) mj[name] = Object.fromEntries(Object.entries(members).map(([k, value]) => [k, { value }]));
  return mj;
}
