import * as check from "./arguments.js";
import { contactsOf, type ContactInfo } from "./contact.js";
import { LabspecError, call } from "./error.js";
import type { DataFields, ModelFields, OptionFields, StatisticFields } from "./field-types.js";
import { FieldCache, defineFields, fields, type FieldSource } from "./fields.js";
import { ready } from "./glue.js";
import { DATA, weight } from "./weight.js";
import type { RawData, RawModel } from "#glue";

/** Kinds of objects, by MuJoCo's words for their lists. */
export type ObjectKind =
  | "body" | "jnt" | "geom" | "site" | "cam" | "light" | "mesh" | "skin" | "hfield" | "tex" | "mat" | "pair" | "exclude" | "eq"
  | "tendon" | "actuator" | "sensor" | "numeric" | "text" | "tuple" | "key";

/** An object by its id, or by its name. */
export type Which = number | string;

let sizes: Map<string, number> | undefined;

/** The numbers of fields that are sizes, by name. */
function sizeField(name: string): number | undefined {
  sizes ??= new Map(fields().filter((f) => f.elem === "size" && f.object === "model").map((f) => [f.name, f.index]));
  return sizes.get(name);
}

class Part {
  readonly cache: FieldCache;

  constructor(cache: FieldCache) {
    this.cache = cache;
  }
}
class Options extends Part {}
class Statistic extends Part {}

/** @internal Compiles MJCF. */
export function compile(text: string, files: Record<string, string | Uint8Array>): RawModel {
  const glue = ready();
  return call(() => glue.RawModel.fromXml(text, files), new Map([["model.xml", text]]));
}

/** A compiled model. Its fields have MuJoCo's names: `model.body_mass`, `model.opt.timestep`. */
export class Model {
  #raw: RawModel | undefined;
  readonly #cache: FieldCache;
  readonly #opt: Options;
  readonly #stat: Statistic;
  readonly #owned = new WeakMap<object, RawModel>();
  #viewed = false;
  #weight: ArrayBuffer | undefined = weight(DATA);

  /** @internal Models are made by `fromXML`, `fromBytes` or `Lab.toModel`. */
  constructor(raw: RawModel) {
    if (!(raw instanceof ready().RawModel)) throw new LabspecError("wrong-type", "a model is made by `Model.fromXML` or `Model.fromBytes`");
    this.#raw = raw;
    defineFields(Model.prototype, "model", (of: Model) => of.#cache);
    defineFields(Options.prototype, "opt", (of: Options) => of.cache);
    defineFields(Statistic.prototype, "stat", (of: Statistic) => of.cache);
    const source: FieldSource = {
      place: (index) => call(() => this.#model().place(index)),
      copy: (index) => call(() => this.#model().field(index)),
      number: (index) => this.#model().number(index),
      write: (index, from, values) => this.#model().write(index, from, values),
      size: (name) => {
        const field = sizeField(name);
        return field === undefined ? undefined : this.#model().number(field);
      },
      keep: (view) => {
        this.#viewed = true;
        this.#owned.set(view, this.#model());
      },
    };
    this.#cache = new FieldCache(source);
    [this.#opt, this.#stat] = [new Options(this.#cache), new Statistic(this.#cache)];
  }

  /** Compiles a model from MJCF. `files` are what it includes or names, by path. */
  static fromXML(xml: string, files: Readonly<Record<string, string | Uint8Array>> = {}): Model {
    const [text, own] = [check.text(xml, "MJCF"), check.models(files)];
    return new Model(compile(text, own));
  }

  /** A model from the bytes of `toBytes`. */
  static fromBytes(bytes: Uint8Array): Model {
    const own = check.bytes(bytes, "a compiled model");
    const glue = ready();
    return new Model(call(() => glue.RawModel.fromBytes(own)));
  }

  /** @internal */
  static adopt(raw: RawModel): Model {
    return new Model(raw);
  }

  /** @internal Gives the module what was written into views, and itself. */
  static use(model: Model): RawModel {
    const raw = model.#model();
    model.#cache.flush();
    return raw;
  }

  /** The model as bytes; they belong to this version of the engine. */
  toBytes(): Uint8Array {
    return call(() => Model.use(this).toBytes());
  }

  /** Options of the simulation. */
  get opt(): OptionFields {
    return this.#opt as unknown as OptionFields;
  }

  /** Statistics. */
  get stat(): StatisticFields {
    return this.#stat as unknown as StatisticFields;
  }

  /** The name of the model. */
  get title(): string {
    return call(() => this.#model().title());
  }

  /** The names of all objects of a kind, by id. */
  names(kind: ObjectKind): readonly string[] {
    const which = check.text(kind, "a kind");
    return call(() => this.#model().names(which));
  }

  /** The id of an object by its name, or by its id. */
  id(kind: ObjectKind, which: Which): number {
    const names = this.names(kind);
    if (typeof which === "number") {
      const at = check.count(which, "an id");
      if (at < names.length) return at;
      throw new LabspecError("unknown-id", `${kind} ${at} does not exist: the model has ${names.length}, counted from 0`);
    }
    const name = check.text(which, "a name");
    const at = name === "" ? -1 : names.indexOf(name);
    if (at >= 0) return at;
    const known = names.filter((n) => n !== "").slice(0, 20).map((n) => `"${n}"`).join(", ");
    throw new LabspecError("unknown-name", `the model has no ${kind} named "${name}"${known === "" ? "" : `; it has ${known}`}`);
  }

  /** Gives the memory back; that of views that are still in use when these are collected. */
  free(): void {
    if (!this.#viewed) this.#raw?.free();
    [this.#raw, this.#weight] = [undefined, undefined];
  }

  [Symbol.dispose](): void {
    this.free();
  }

  #model(): RawModel {
    if (this.#raw === undefined) throw new LabspecError("freed", "this model was freed");
    return this.#raw;
  }
}
export interface Model extends ModelFields {}

/** A hit of a ray. */
export interface RayHit {
  /** Distance in lengths of the ray's direction. */
  readonly distance: number;
  readonly geom: number;
  readonly normal: Float64Array;
}

/** State and results of a simulation of a model. Its fields have MuJoCo's names: `data.qpos`. */
export class Data {
  /** The model to which the data belong. */
  readonly model: Model;
  #raw: RawData | undefined;
  readonly #cache: FieldCache;
  readonly #owned = new WeakMap<object, RawData>();
  #viewed = false;
  #weight: ArrayBuffer | undefined = weight(DATA);
  #poses: Float32Array | undefined;

  constructor(model: Model) {
    if (!(model instanceof Model)) throw new LabspecError("wrong-type", "`Data` must be created with a `Model`");
    this.model = model;
    const glue = ready();
    this.#raw = call(() => new glue.RawData(Model.use(model)));
    defineFields(Data.prototype, "data", (of: Data) => of.#cache);
    this.#cache = new FieldCache({
      place: (index) => call(() => this.#data().place(index)),
      copy: (index) => call(() => this.#data().field(index)),
      number: (index) => this.#data().number(index),
      write: (index, from, values) => this.#data().write(index, from, values),
      size: (name) => {
        const field = sizeField(name);
        return field === undefined ? undefined : Model.use(model).number(field);
      },
      keep: (view) => {
        this.#viewed = true;
        this.#owned.set(view, this.#data());
      },
    });
  }

  /** @internal Runs a call of the module with what was written into views. */
  static use<T>(data: Data, what: (raw: RawData, model: RawModel) => T): T {
    return data.#with(what);
  }

  /**
   * One step, or several (`mj_step`). `work` is the most work of the call, in units of about a nanosecond that are the same on every
   * machine; 100,000,000,000 when not given. What needs more throws `too-much-work`, and the state is the one before the call.
   */
  step(steps = 1, options: { readonly work?: number } = {}): void {
    const most = check.count(steps, "the number of steps", 100_000_000);
    if (typeof options !== "object" || options === null) throw new LabspecError("wrong-type", "the options must be an object");
    const work = options.work === undefined ? undefined : check.count(options.work, "the work of a call", Number.MAX_SAFE_INTEGER);
    this.#with((raw, model) => raw.step(model, most, work));
  }

  /** Computes everything that follows from the state (`mj_forward`). */
  forward(): void {
    this.pass("mj_forward");
  }

  /** `qfrc_inverse` from `qpos`, `qvel` and `qacc` (`mj_inverse`). */
  inverse(): void {
    this.pass("mj_inverse");
  }

  /** Back to the default configuration, or to a keyframe. */
  reset(key?: Which): void {
    if (key === undefined) return this.pass("mj_resetData");
    const id = this.model.id("key", key);
    this.#with((raw, model) => raw.resetKeyframe(model, id));
  }

  /** A part of a step by MuJoCo's name: `mj_step1`, `mj_kinematics`, … */
  pass(name: string): void {
    const which = check.text(name, "a function's name");
    this.#with((raw, model) => raw.pass(model, which));
  }

  /** Computes constants of the model that follow from masses, inertias and poses (`mj_setConst`). */
  setConst(): void {
    this.#with((raw, model) => raw.setConst(model));
  }

  /** The contacts now, with their forces. */
  get contacts(): readonly ContactInfo[] {
    return this.#with((raw, model) => contactsOf(raw.contacts(model)));
  }

  /** The poses of all geoms for drawing, as those of `Lab`. */
  get poses(): Float32Array {
    return this.#with((raw) => {
      const now = raw.poses();
      if (this.#poses?.length !== now.length) this.#poses = new Float32Array(now.length);
      this.#poses.set(now);
      return this.#poses;
    });
  }

  /** All of the simulation as bytes; the model's parameters are not part of it. */
  save(): Uint8Array {
    return this.#with((raw, model) => raw.save(model));
  }

  /** Back to what was saved: from there on every number is the same, to the bit. */
  restore(bytes: Uint8Array): void {
    const own = check.bytes(bytes, "a saved simulation");
    this.#with((raw, model) => raw.restore(model, own));
  }

  /** A state as a list of numbers (`mj_getState`). */
  getState(signature: number): Float64Array {
    const which = check.count(signature, "a signature", 0x7fff_ffff);
    return this.#with((raw, model) => raw.getState(model, which));
  }

  /** Sets a state (`mj_setState`). */
  setState(values: ArrayLike<number>, signature: number): void {
    const [list, which] = [check.numbers(values, "a state"), check.count(signature, "a signature", 0x7fff_ffff)];
    this.#with((raw, model) => raw.setState(model, list, which));
  }

  /** M as a dense matrix, nv x nv. */
  fullM(): Float64Array {
    return this.#with((raw, model) => raw.fullM(model));
  }

  /** M v. */
  mulM(v: ArrayLike<number>): Float64Array {
    const list = check.numbers(v, "a vector");
    return this.#with((raw, model) => raw.massTimes(model, list, false));
  }

  /** The solution of M x = v. */
  solveM(v: ArrayLike<number>): Float64Array {
    const list = check.numbers(v, "a vector");
    return this.#with((raw, model) => raw.massTimes(model, list, true));
  }

  /** A Jacobian, row-major: 3 x nv of translation, then 3 x nv of rotation (not for `subtreeCom`). */
  jacobian(of: "body" | "bodyCom" | "geom" | "site" | "subtreeCom" | "point", which: number, point: ArrayLike<number> = []): Float64Array {
    const [kind, id, at] = [check.text(of, "a kind"), check.count(which, "an id"), check.numbers(point, "a point")];
    return this.#with((raw, model) => raw.jacobian(model, kind, id, at));
  }

  /** The velocity of an object: angular, then linear; in world axes, or in its own. */
  objectVelocity(kind: "body" | "geom" | "site" | "cam", which: Which, local = false): Float64Array {
    const [id, own] = [this.model.id(kind, which), check.boolean(local, "`local`")];
    return this.#with((raw, model) => raw.objectVelocity(model, kind, id, own));
  }

  /** The nearest geom on a ray; `undefined` where it hits none. */
  ray(from: ArrayLike<number>, along: ArrayLike<number>, options: { statics?: boolean; excludeBody?: number } = {}): RayHit | undefined {
    const [point, direction] = [check.numbers(from, "a point", 3), check.numbers(along, "a direction", 3)];
    const { statics = true, excludeBody = -1 } = options ?? {};
    check.boolean(statics, "`statics`");
    const exclude = excludeBody === -1 ? -1 : check.count(excludeBody, "a body", 0x7fff_ffff);
    const hit = this.#with((raw, model) => raw.ray(model, point, direction, statics, exclude));
    if (hit.length === 0) return undefined;
    return { distance: hit[0] ?? NaN, geom: hit[1] ?? NaN, normal: hit.slice(2) };
  }

  /** The acceleration of an object as an accelerometer feels it: angular, then linear. Needs `pass("mj_rnePostConstraint")`. */
  objectAcceleration(kind: "body" | "geom" | "site" | "cam", which: Which, local = false): Float64Array {
    const [id, own] = [this.model.id(kind, which), check.boolean(local, "`local`")];
    return this.#with((raw, model) => raw.objectAcceleration(model, kind, id, own));
  }

  /** The distance of two geoms up to `most`, and the nearest points, m. */
  geomDistance(geom1: Which, geom2: Which, most: number): { readonly dist: number; readonly fromto: Float64Array } {
    const [a, b, limit] = [this.model.id("geom", geom1), this.model.id("geom", geom2), check.number(most, "a distance")];
    const found = this.#with((raw, model) => raw.geomDistance(model, a, b, limit));
    return { dist: found[0] ?? NaN, fromto: found.slice(1) };
  }

  /** The position that a velocity leads to in a time. */
  integratePos(qpos: ArrayLike<number>, v: ArrayLike<number>, h: number): Float64Array {
    const [from, velocity, time] = [check.numbers(qpos, "a position"), check.numbers(v, "a velocity"), check.number(h, "a time")];
    return this.#with((raw, model) => raw.integratePos(model, from, velocity, time));
  }

  /** The velocity that leads from a position to another one in a time. */
  differentiatePos(h: number, from: ArrayLike<number>, to: ArrayLike<number>): Float64Array {
    const [time, a, b] = [check.number(h, "a time"), check.numbers(from, "a position"), check.numbers(to, "a position")];
    return this.#with((raw, model) => raw.differentiatePos(model, time, a, b));
  }

  /** The generalized force of a force and a torque at a point of a body, all in world axes. */
  generalizedForce(force: ArrayLike<number>, torque: ArrayLike<number>, point: ArrayLike<number>, body: Which): Float64Array {
    const parts = [check.numbers(force, "a force", 3), check.numbers(torque, "a torque", 3), check.numbers(point, "a point", 3)];
    const id = this.model.id("body", body);
    const given = Float64Array.from(parts.flatMap((part) => [...part]));
    return this.#with((raw, model) => raw.applyFt(model, given, id, new Float64Array(this.model.nv)));
  }

  /** How often each warning was raised: inertia, contacts, constraints, bad positions, velocities, accelerations, controls. */
  get warnings(): Uint32Array {
    return this.#with((raw) => raw.warnings());
  }

  /** Gives the memory back; that of views that are still in use when these are collected. */
  free(): void {
    if (!this.#viewed) this.#raw?.free();
    [this.#raw, this.#weight] = [undefined, undefined];
  }

  [Symbol.dispose](): void {
    this.free();
  }

  #data(): RawData {
    if (this.#raw === undefined) throw new LabspecError("freed", "these data were freed");
    return this.#raw;
  }

  #with<T>(what: (raw: RawData, model: RawModel) => T): T {
    const raw = this.#data();
    return call(() => {
      const model = Model.use(this.model);
      this.#cache.flush();
      const result = what(raw, model);
      this.#cache.refresh();
      return result;
    });
  }
}
export interface Data extends DataFields {}
