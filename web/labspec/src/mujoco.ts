/** The names of `@mujoco/mujoco` 3.14.0 for pages that use that package: they change one import. What is missing throws by name. */
import * as check from "./arguments.js";
import type { ContactInfo } from "./contact.js";
import { LabspecError } from "./error.js";
import { fields, type Field } from "./fields.js";
import { Data, Model, compile, type ObjectKind } from "./model.js";
import { CONSTANTS, ENUMS, LISTS, MISSING_DATA, MISSING_MODEL } from "./mujoco-names.js";

type Numbers = ArrayLike<number>;
/** Where a function writes: an array of numbers or a buffer of this module. */
export type Out = number[] | Float64Array | Float32Array | Int32Array | Uint8Array | MjBuffer;

function missing(name: string): LabspecError {
  return new LabspecError("not-implemented", `\`${name}\` is not available in labspec/mujoco`);
}

/** A list of numbers that functions write into. */
class MjBuffer {
  #view: Float64Array | Float32Array | Int32Array | Uint8Array;

  constructor(view: Float64Array | Float32Array | Int32Array | Uint8Array) {
    this.#view = view;
  }

  GetView(): Float64Array | Float32Array | Int32Array | Uint8Array {
    return this.#view;
  }

  getView(): Float64Array | Float32Array | Int32Array | Uint8Array {
    return this.#view;
  }

  GetElementCount(): number {
    return this.#view.length;
  }

  delete(): void {}

  isDeleted(): boolean {
    return false;
  }
}

function buffers(make: { new (n: number): Float64Array | Float32Array | Int32Array | Uint8Array }, name: string) {
  return class extends MjBuffer {
    /** As many zeros, or the numbers that are given. */
    constructor(given: number | Numbers) {
      const list = typeof given === "number" ? new Float64Array(check.count(given, "a number of elements", 1 << 28)) : check.numbers(given, `the numbers of ${name}`);
      const view = new make(list.length);
      view.set(list);
      super(view);
    }

    static FromArray(given: Numbers): MjBuffer {
      return new this(given);
    }
  };
}
export const DoubleBuffer = buffers(Float64Array, "DoubleBuffer");
export const FloatBuffer = buffers(Float32Array, "FloatBuffer");
export const IntBuffer = buffers(Int32Array, "IntBuffer");
export const Uint8Buffer = buffers(Uint8Array, "Uint8Buffer");

/** Writes a result where a page wants it, plain arrays included. */
function write(out: unknown, values: Numbers, what: string): void {
  const target = out instanceof MjBuffer ? out.GetView() : out;
  if (!Array.isArray(target) && !(ArrayBuffer.isView(target) && !(target instanceof DataView))) {
    throw new LabspecError("wrong-type", `${what} is written into an array of numbers, a typed array or a buffer`);
  }
  const list = target as number[];
  if (list.length !== values.length) throw new LabspecError("wrong-length", `${what} has ${values.length} numbers, not ${list.length}`);
  for (let i = 0; i < values.length; i++) list[i] = values[i] as number;
}

function read(given: unknown, what: string, length?: number): Float64Array {
  return check.numbers(given instanceof MjBuffer ? given.GetView() : given, what, length);
}

/** Files in memory, by name. */
export class MjVFS {
  readonly files: Record<string, string | Uint8Array> = {};

  addBuffer(name: string, content: string | Uint8Array | ArrayBuffer): void {
    const own = content instanceof ArrayBuffer ? new Uint8Array(content) : content;
    Object.assign(this.files, check.models({ [check.text(name, "a file's name")]: own }));
  }

  deleteFile(name: string): void {
    delete this.files[check.text(name, "a file's name")];
  }

  delete(): void {}
}

/** How kinds are called: their fields' prefix, the size that counts them, the number in mjtObj. */
const KINDS: readonly (readonly [kind: ObjectKind, size: string, obj: number, word: string])[] = [
  ["body", "nbody", 1, "body"], ["jnt", "njnt", 3, "joint"], ["geom", "ngeom", 5, "geom"], ["site", "nsite", 6, "site"], ["cam", "ncam", 7, "camera"],
  ["light", "nlight", 8, "light"], ["mesh", "nmesh", 10, "mesh"], ["skin", "nskin", 11, "skin"], ["hfield", "nhfield", 12, "hfield"],
  ["tex", "ntex", 13, "texture"], ["mat", "nmat", 14, "material"], ["pair", "npair", 15, "pair"], ["exclude", "nexclude", 16, "exclude"],
  ["eq", "neq", 17, "equality"], ["tendon", "ntendon", 18, "tendon"], ["actuator", "nu", 19, "actuator"], ["sensor", "nsensor", 20, "sensor"],
  ["numeric", "nnumeric", 21, "numeric"], ["text", "ntext", 22, "text"], ["tuple", "ntuple", 23, "tuple"], ["key", "nkey", 24, "key"],
];

/** An object of a model by name or id, with its rows of the fields. */
export interface Accessor {
  readonly id: number;
  readonly name: string;
  readonly [field: string]: unknown;
}

type Row = (owner: Record<string, unknown>, model: MjModel, id: number) => readonly [number, number];

/** Which elements of a field belong to an object: rows of its kind, or its coordinates and degrees of freedom. */
function rowOf(field: Field, kind: string, size: string): Row | undefined {
  const [first] = field.dims;
  if (first === size || (kind === "actuator" && (first === "nactuator" || first === "nout"))) {
    return (owner, model, id) => {
      const whole = (owner[field.name] as Numbers).length;
      const count = (model as unknown as Record<string, number>)[first] ?? 1;
      const width = count > 0 ? whole / count : 0;
      const at = first === "nout" ? (model.actuator_outadr[id] ?? 0) : id;
      return [at * width, (at + 1) * width];
    };
  }
  if (kind !== "jnt" || (first !== "nq" && first !== "nv")) return undefined;
  const [q, v] = [[7, 4, 1, 1], [6, 3, 1, 1]];
  return (owner, model, id) => {
    const type = model.jnt_type[id] ?? 2;
    const count = first === "nq" ? model.nq : model.nv;
    const whole = (owner[field.name] as Numbers).length;
    const width = count > 0 ? whole / count : 0;
    const at = (first === "nq" ? model.jnt_qposadr : model.jnt_dofadr)[id] ?? 0;
    return [at * width, (at + ((first === "nq" ? q : v)[type] ?? 1)) * width];
  };
}

function accessor(owner: object, object: "model" | "data", model: MjModel, kind: ObjectKind, which: number | string): Accessor {
  const entry = KINDS.find(([k]) => k === kind);
  const [, size, , word] = entry ?? [kind, "", 0, kind];
  const names = model.names(kind);
  const id = typeof which === "number" ? which : names.indexOf(check.text(which, "a name"));
  if (!Number.isInteger(id) || id < 0 || id >= names.length || which === "") {
    const all = names.map((n) => `'${n}'`).join(", ");
    throw new LabspecError("unknown-name", typeof which === "number" ? `Invalid index ${which} for ${word}. Valid indices from 0 to ${names.length - 1}` : `Invalid name '${which}' for ${word}. Valid names: [${all}]`);
  }
  const out = { id, name: names[id] ?? "", delete: () => undefined };
  const fieldsOf = owner as Record<string, unknown>;
  for (const field of fields()) {
    if (field.object !== object) continue;
    const row = rowOf(field, kind, size);
    if (row === undefined) continue;
    const name = field.name.replace(new RegExp(`^(${kind}|${kind === "jnt" ? "dof" : kind === "tendon" ? "ten" : kind})_`), "");
    if (name in out) continue;
    // One number for each object is a number; what belongs to coordinates and degrees of freedom is a list.
    const single = field.dims.length === 1 && !(kind === "jnt" && field.dims[0] !== size);
    const get = (): unknown => {
      const view = fieldsOf[field.name] as Float64Array;
      const [from, to] = row(fieldsOf, model, id);
      if (!single) return view.subarray(from, to);
      return field.elem === "bool" ? view[from] !== 0 : view[from];
    };
    const set = (values: unknown): void => {
      if (!field.writable) throw new LabspecError("read-only", `\`${field.name}\` cannot be written`);
      const view = fieldsOf[field.name] as Float64Array;
      const [from, to] = row(fieldsOf, model, id);
      write(view.subarray(from, to), typeof values === "number" || typeof values === "boolean" ? [Number(values)] : read(values, name), name);
    };
    Object.defineProperty(out, name, { enumerable: true, get, set });
  }
  if (object === "data" && kind === "sensor") {
    const [from, count] = [model.sensor_adr[id] ?? 0, model.sensor_dim[id] ?? 0];
    Object.defineProperty(out, "data", { enumerable: true, get: () => (fieldsOf["sensordata"] as Float64Array).subarray(from, from + count) });
  }
  return new Proxy(out as Accessor, {
    get: (target, key) => {
      if (key in target || typeof key === "symbol" || key === "then" || key === "toJSON") return Reflect.get(target, key) as unknown;
      throw missing(`${object}.${kind}(…).${key}`);
    },
  });
}

/** A compiled model under the official names. */
export class MjModel extends Model {
  static from_xml_string(xml: string, vfs?: MjVFS): MjModel {
    return new MjModel(compile(check.text(xml, "MJCF"), { ...(vfs?.files ?? {}) }));
  }

  static mj_loadXML(path: string, vfs?: MjVFS): MjModel {
    const content = vfs?.files[check.text(path, "a path")];
    if (content === undefined) throw new LabspecError("unknown-name", `there is no file "${path}": add it to the MjVFS`);
    return MjModel.from_xml_string(typeof content === "string" ? content : new TextDecoder().decode(content), vfs);
  }

  static from_xml_path(path: string, vfs?: MjVFS): MjModel {
    return MjModel.mj_loadXML(path, vfs);
  }

  declare actuator: (which: number | string) => Accessor;
  declare body: (which: number | string) => Accessor;
  declare cam: (which: number | string) => Accessor;
  declare eq: (which: number | string) => Accessor;
  declare geom: (which: number | string) => Accessor;
  declare jnt: (which: number | string) => Accessor;
  declare light: (which: number | string) => Accessor;
  declare mat: (which: number | string) => Accessor;
  declare mesh: (which: number | string) => Accessor;
  declare sensor: (which: number | string) => Accessor;
  declare site: (which: number | string) => Accessor;
  declare tendon: (which: number | string) => Accessor;
  declare key: (which: number | string) => Accessor;

  delete(): void {
    this.free();
  }
}

/** Contacts as the official package lists them. */
class MjContactVec {
  readonly #list: readonly ContactInfo[];

  constructor(list: readonly ContactInfo[]) {
    this.#list = list;
  }

  size(): number {
    return this.#list.length;
  }

  get(i: number): (ContactInfo & { readonly geom: Int32Array; delete(): void }) | undefined {
    const contact = this.#list[i];
    return contact && { ...contact, geom: Int32Array.of(contact.geom1, contact.geom2), delete: () => undefined };
  }

  delete(): void {}
}

/** Data under the official names. */
export class MjData extends Data {
  declare readonly model: MjModel;
  declare actuator: (which: number | string) => Accessor;
  declare body: (which: number | string) => Accessor;
  declare cam: (which: number | string) => Accessor;
  declare geom: (which: number | string) => Accessor;
  declare jnt: (which: number | string) => Accessor;
  declare light: (which: number | string) => Accessor;
  declare sensor: (which: number | string) => Accessor;
  declare site: (which: number | string) => Accessor;
  declare tendon: (which: number | string) => Accessor;

  constructor(model: MjModel) {
    if (!(model instanceof MjModel)) throw new LabspecError("wrong-type", "MjData is made for an MjModel");
    super(model);
  }

  get contact(): MjContactVec {
    return new MjContactVec(this.contacts);
  }

  delete(): void {
    this.free();
  }
}

for (const [kind] of KINDS) {
  const define = (prototype: object, object: "model" | "data"): void => {
    Object.defineProperty(prototype, kind, {
      value(this: MjModel & MjData, which: number | string) {
        return accessor(this, object, object === "model" ? this : this.model, kind, which);
      },
    });
  };
  define(MjModel.prototype, "model");
  if (["actuator", "body", "cam", "geom", "jnt", "light", "sensor", "site", "tendon"].includes(kind)) define(MjData.prototype, "data");
}
for (const [prototype, names, of] of [[MjModel.prototype, MISSING_MODEL, "MjModel"], [MjData.prototype, MISSING_DATA, "MjData"]] as const) {
  for (const name of names) {
    if (name in prototype) continue;
    Object.defineProperty(prototype, name, { get() { throw missing(`${of}.${name}`); } });
  }
}

function both(m: unknown, d: unknown): Data {
  if (!(m instanceof Model) || !(d instanceof Data)) throw new LabspecError("wrong-type", "this function takes an MjModel and an MjData");
  if (d.model !== m) throw new LabspecError("foreign-data", "the data belong to another model");
  return d;
}

function kindOf(obj: unknown): ObjectKind {
  const number = typeof obj === "object" && obj !== null ? (obj as { value?: unknown }).value : obj;
  const found = KINDS.find(([, , n]) => n === (number === 2 ? 1 : number));
  if (found === undefined) throw new LabspecError("unknown-kind", `mjtObj ${String(number)} is not a kind of named objects`);
  return found[0];
}

const sqrt = Math.sqrt;
/** The rotation matrix of a quaternion. */
function matrix(q: Numbers): number[] {
  const [w = 0, x = 0, y = 0, z = 0] = Array.from(q);
  return [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z];
}

function product(a: Numbers, b: Numbers): number[] {
  const [w = 0, x = 0, y = 0, z = 0] = Array.from(a);
  const [e = 0, f = 0, g = 0, h = 0] = Array.from(b);
  return [w * e - x * f - y * g - z * h, w * f + x * e + y * h - z * g, w * g - x * h + y * e + z * f, w * h + x * g - y * f + z * e];
}

function times(m: Numbers, v: Numbers): number[] {
  return [0, 3, 6].map((r) => [0, 1, 2].reduce((sum, c) => sum + (m[r + c] ?? 0) * (v[c] ?? 0), 0));
}

function quaternion(m: Numbers): number[] {
  const n = (i: number): number => m[i] ?? 0;
  const trace = n(0) + n(4) + n(8);
  let q: number[];
  if (trace > 0) q = [1 + trace, n(7) - n(5), n(2) - n(6), n(3) - n(1)];
  else if (n(0) > n(4) && n(0) > n(8)) q = [n(7) - n(5), 1 + n(0) - n(4) - n(8), n(1) + n(3), n(2) + n(6)];
  else if (n(4) > n(8)) q = [n(2) - n(6), n(1) + n(3), 1 - n(0) + n(4) - n(8), n(5) + n(7)];
  else q = [n(3) - n(1), n(2) + n(6), n(5) + n(7), 1 - n(0) - n(4) + n(8)];
  const norm = sqrt(q.reduce((sum, x) => sum + x * x, 0));
  return q.map((x) => x / norm);
}

function turn(axis: Numbers, angle: number): number[] {
  const s = Math.sin(angle / 2);
  return [Math.cos(angle / 2), ...Array.from(axis, (x) => x * s)];
}

/** Divides numbers by their norm, in place; the norm. */
function normalize(out: Out, n: number): number {
  const v = read(out, "a vector", n);
  const norm = sqrt(v.reduce((sum, x) => sum + x * x, 0));
  write(out, norm < 1e-15 ? [1, ...new Array<number>(n - 1).fill(0)] : v.map((x) => x / norm), "a vector");
  return norm;
}

const vectors = (n: number) => ({
  pair: (res: Out, a: Numbers, b: Numbers, f: (x: number, y: number) => number): void => {
    const [x, y] = [read(a, "a vector", n), read(b, "a vector", n)];
    write(res, x.map((value, i) => f(value, y[i] ?? NaN)), "the result");
  },
});
const three = vectors(3);

const PASSES = ["mj_step1", "mj_step2", "mj_forward", "mj_inverse", "mj_resetData", "mj_kinematics", "mj_fwdPosition", "mj_fwdVelocity", "mj_collision", "mj_energyPos", "mj_energyVel", "mj_subtreeVel", "mj_rnePostConstraint"] as const;
type PassName = (typeof PASSES)[number];
type PassFunction = (m: MjModel, d: MjData) => void;
const passes = Object.fromEntries(PASSES.map((name) => [name, (m: MjModel, d: MjData) => both(m, d).pass(name)])) as Record<PassName, PassFunction>;

/** A Jacobian into two lists, either of which may be left out. */
function jacobian(d: Data, jacp: Out | null, jacr: Out | null, of: "body" | "bodyCom" | "geom" | "site" | "point", id: number, point: Numbers = []): void {
  const both = d.jacobian(of, id, read(point, "a point"));
  const half = both.length / 2;
  if (jacp !== null && jacp !== undefined) write(jacp, both.subarray(0, half), "jacp");
  if (jacr !== null && jacr !== undefined) write(jacr, both.subarray(half), "jacr");
}

const functions = {
  ...passes,
  mj_step: (m: MjModel, d: MjData): void => both(m, d).step(),
  mj_resetDataKeyframe: (m: MjModel, d: MjData, key: number): void => both(m, d).reset(key),
  mj_setConst: (m: MjModel, d: MjData): void => both(m, d).setConst(),
  mj_name2id: (m: MjModel, type: unknown, name: string): number => (name === "" ? -1 : m.names(kindOf(type)).indexOf(check.text(name, "a name"))),
  mj_id2name: (m: MjModel, type: unknown, id: number): string => m.names(kindOf(type))[check.count(id, "an id")] ?? "",
  mj_contactForce: (m: MjModel, d: MjData, id: number, result: Out): void => {
    const contact = both(m, d).contacts[check.count(id, "a contact")];
    if (contact === undefined) throw new LabspecError("unknown-id", `contact ${id} does not exist: there are ${d.ncon}`);
    write(result, contact.force, "a contact force");
  },
  mj_fullM: (m: MjModel, d: MjData, out: Out): void => write(out, both(m, d).fullM(), "M"),
  mj_mulM: (m: MjModel, d: MjData, res: Out, v: Numbers): void => write(res, both(m, d).mulM(read(v, "a vector")), "M v"),
  mj_solveM: (m: MjModel, d: MjData, x: Out, y: Numbers): void => write(x, both(m, d).solveM(read(y, "a vector")), "the solution"),
  mj_stateSize: (m: MjModel, signature: number): number => new Data(m).getState(signature).length,
  mj_getState: (m: MjModel, d: MjData, out: Out, signature: number): void => write(out, both(m, d).getState(signature), "a state"),
  mj_setState: (m: MjModel, d: MjData, values: Numbers, signature: number): void => both(m, d).setState(read(values, "a state"), signature),
  mj_jac: (m: MjModel, d: MjData, jacp: Out | null, jacr: Out | null, point: Numbers, body: number): void => jacobian(both(m, d), jacp, jacr, "point", body, point),
  mj_jacBody: (m: MjModel, d: MjData, jacp: Out | null, jacr: Out | null, id: number): void => jacobian(both(m, d), jacp, jacr, "body", id),
  mj_jacBodyCom: (m: MjModel, d: MjData, jacp: Out | null, jacr: Out | null, id: number): void => jacobian(both(m, d), jacp, jacr, "bodyCom", id),
  mj_jacGeom: (m: MjModel, d: MjData, jacp: Out | null, jacr: Out | null, id: number): void => jacobian(both(m, d), jacp, jacr, "geom", id),
  mj_jacSite: (m: MjModel, d: MjData, jacp: Out | null, jacr: Out | null, id: number): void => jacobian(both(m, d), jacp, jacr, "site", id),
  mj_jacSubtreeCom: (m: MjModel, d: MjData, jacp: Out, id: number): void => write(jacp, both(m, d).jacobian("subtreeCom", id), "jacp"),
  mj_objectVelocity: (m: MjModel, d: MjData, type: unknown, id: number, res: Out, local: number | boolean): void => write(res, both(m, d).objectVelocity(kindOf(type) as "body", id, Boolean(local)), "a velocity"),
  mj_objectAcceleration: (m: MjModel, d: MjData, type: unknown, id: number, res: Out, local: number | boolean): void => write(res, both(m, d).objectAcceleration(kindOf(type) as "body", id, Boolean(local)), "an acceleration"),
  mj_geomDistance: (m: MjModel, d: MjData, geom1: number, geom2: number, most: number, fromto: Out | null = null): number => {
    const found = both(m, d).geomDistance(geom1, geom2, most);
    if (fromto !== null) write(fromto, found.fromto, "fromto");
    return found.dist;
  },
  mj_ray: (m: MjModel, d: MjData, from: Numbers, along: Numbers, groups: Numbers | null, statics: boolean | number, exclude: number, geom: Out | null = null, normal: Out | null = null): number => {
    if (groups !== null && groups !== undefined && groups.length > 0) throw missing("mj_ray with geomgroup");
    const hit = both(m, d).ray(read(from, "a point", 3), read(along, "a direction", 3), { statics: Boolean(statics), excludeBody: exclude });
    if (geom !== null) write(geom, [hit?.geom ?? -1], "geomid");
    if (normal !== null) write(normal, hit?.normal ?? [0, 0, 0], "normal");
    return hit?.distance ?? -1;
  },
  mj_applyFT: (m: MjModel, d: MjData, force: Numbers, torque: Numbers, point: Numbers, body: number, qfrc: Out): void => {
    const more = both(m, d).generalizedForce(read(force, "a force", 3), read(torque, "a torque", 3), read(point, "a point", 3), body);
    write(qfrc, read(qfrc, "a force").map((x, i) => x + (more[i] ?? 0)), "a force");
  },
  mj_integratePos: (m: MjModel, qpos: Out, v: Numbers, h: number): void => write(qpos, new Data(m).integratePos(read(qpos, "a position"), read(v, "a velocity"), h), "a position"),
  mj_differentiatePos: (m: MjModel, v: Out, h: number, from: Numbers, to: Numbers): void => write(v, new Data(m).differentiatePos(h, read(from, "a position"), read(to, "a position")), "a velocity"),
  mj_getTotalmass: (m: MjModel): number => m.body_mass.reduce((sum, x) => sum + x, 0),
  mj_isPyramidal: (m: MjModel): number => (m.opt.cone === 0 ? 1 : 0),
  mj_isDual: (m: MjModel): number => (m.opt.solver === 0 || m.opt.noslip_iterations > 0 ? 1 : 0),
  mj_versionString: (): string => "3.14.0",
  mj_version: (): number => 3014000,
  mju_add3: (res: Out, a: Numbers, b: Numbers): void => three.pair(res, a, b, (x, y) => x + y),
  mju_sub3: (res: Out, a: Numbers, b: Numbers): void => three.pair(res, a, b, (x, y) => x - y),
  mju_scl3: (res: Out, a: Numbers, s: number): void => write(res, read(a, "a vector", 3).map((x) => x * s), "the result"),
  mju_copy3: (res: Out, a: Numbers): void => write(res, read(a, "a vector", 3), "the result"),
  mju_copy4: (res: Out, a: Numbers): void => write(res, read(a, "a vector", 4), "the result"),
  mju_zero3: (res: Out): void => write(res, [0, 0, 0], "the result"),
  mju_dot3: (a: Numbers, b: Numbers): number => read(a, "a vector", 3).reduce((sum, x, i) => sum + x * (read(b, "a vector", 3)[i] ?? NaN), 0),
  mju_norm3: (a: Numbers): number => sqrt(read(a, "a vector", 3).reduce((sum, x) => sum + x * x, 0)),
  mju_dist3: (a: Numbers, b: Numbers): number => sqrt(read(a, "a vector", 3).reduce((sum, x, i) => sum + (x - (read(b, "a vector", 3)[i] ?? NaN)) ** 2, 0)),
  mju_normalize3: (v: Out): number => normalize(v, 3),
  mju_normalize4: (v: Out): number => normalize(v, 4),
  mju_cross: (res: Out, a: Numbers, b: Numbers): void => {
    const [[x = 0, y = 0, z = 0], [u = 0, v = 0, w = 0]] = [read(a, "a vector", 3), read(b, "a vector", 3)];
    write(res, [y * w - z * v, z * u - x * w, x * v - y * u], "the result");
  },
  mju_mulMatVec3: (res: Out, m: Numbers, v: Numbers): void => write(res, times(read(m, "a matrix", 9), read(v, "a vector", 3)), "the result"),
  mju_rotVecQuat: (res: Out, v: Numbers, q: Numbers): void => write(res, times(matrix(read(q, "a quaternion", 4)), read(v, "a vector", 3)), "the result"),
  mju_quat2Mat: (res: Out, q: Numbers): void => write(res, matrix(read(q, "a quaternion", 4)), "the result"),
  mju_mat2Quat: (res: Out, m: Numbers): void => write(res, quaternion(read(m, "a matrix", 9)), "the result"),
  mju_mulQuat: (res: Out, a: Numbers, b: Numbers): void => write(res, product(read(a, "a quaternion", 4), read(b, "a quaternion", 4)), "the result"),
  mju_negQuat: (res: Out, q: Numbers): void => write(res, read(q, "a quaternion", 4).map((x, i) => (i === 0 ? x : -x)), "the result"),
  mju_axisAngle2Quat: (res: Out, axis: Numbers, angle: number): void => write(res, turn(read(axis, "an axis", 3), angle), "the result"),
  mju_euler2Quat: (res: Out, angles: Numbers, order: string): void => {
    const list = read(angles, "angles", 3);
    let q = [1, 0, 0, 0];
    [...check.text(order, "an order of axes")].forEach((letter, i) => {
      const at = "xyz".indexOf(letter.toLowerCase());
      if (at < 0 || i > 2) throw new LabspecError("wrong-value", "an order of axes is three letters of xyz or XYZ");
      const one = turn([0, 1, 2].map((k) => (k === at ? 1 : 0)), list[i] ?? NaN);
      q = letter === letter.toLowerCase() ? product(q, one) : product(one, q);
    });
    write(res, q, "the result");
  },
  mju_quatIntegrate: (q: Out, v: Numbers, h: number): void => {
    const velocity = read(v, "a velocity", 3);
    const speed = sqrt(velocity.reduce((sum, x) => sum + x * x, 0));
    const axis = speed < 1e-15 ? [1, 0, 0] : velocity.map((x) => x / speed);
    write(q, product(read(q, "a quaternion", 4), turn(axis, speed * h)), "a quaternion");
  },
  mju_zero: (res: Out): void => write(res, new Float64Array(read(res, "a list").length), "the result"),
};

/** Constants as the official package gives them: `mjtGeom.mjGEOM_BOX.value`. */
const enums = Object.fromEntries(Object.entries(ENUMS).map(([name, values]) => [name, Object.fromEntries(Object.entries(values).map(([n, value]) => [n, { value }]))]));

/** The official names: functions, classes, enumerations, constants. */
export type MujocoModule = typeof functions & {
  readonly MjModel: typeof MjModel;
  readonly MjData: typeof MjData;
  readonly MjVFS: typeof MjVFS;
  readonly DoubleBuffer: typeof DoubleBuffer;
  readonly FloatBuffer: typeof FloatBuffer;
  readonly IntBuffer: typeof IntBuffer;
  readonly Uint8Buffer: typeof Uint8Buffer;
  readonly [enumeration: `mjt${string}`]: Readonly<Record<string, { readonly value: number }>>;
  readonly [list: `mj${string}STRING`]: readonly unknown[];
};

const known: Readonly<Record<string, unknown>> = {
  ...CONSTANTS, ...LISTS, ...enums, ...functions, MjModel, MjData, MjVFS, DoubleBuffer, FloatBuffer, IntBuffer, Uint8Buffer,
};

/** What throws its name wherever it is used. */
function absent(name: string): unknown {
  const fail = (): never => {
    throw missing(name);
  };
  return new Proxy(function () {}, { apply: fail, construct: fail, get: fail, set: fail });
}

/** The module under the official names: `import loadMujoco from "labspec/mujoco"`. */
export default async function loadMujoco(): Promise<MujocoModule> {
  return mujoco;
}

/** The same without waiting. */
export const mujoco = new Proxy(known, {
  get: (target, key) => {
    if (typeof key === "symbol" || key in target || !/^(mj|Mj)/.test(key)) return Reflect.get(target, key) as unknown;
    return absent(key);
  },
}) as unknown as MujocoModule;
export { LabspecError } from "./error.js";
