import { LabspecError, call } from "./error.js";
import type { DataFields, ModelFields, OptionFields, StatisticFields } from "./field-types.js";
import { FieldCache, defineFields, type FieldSource, fields } from "./fields.js";
import type { Lab as RawLab } from "#glue";

/** The fields of the data of a lab, as copies. */
export interface LabData extends Readonly<DataFields> {}
/** The fields of the model of a lab, as copies. */
export interface LabModel extends Readonly<ModelFields> {
  readonly opt: Readonly<OptionFields>;
  readonly stat: Readonly<StatisticFields>;
}

class LabFields {
  readonly cache: FieldCache;

  constructor(cache: FieldCache) {
    this.cache = cache;
  }
}
class DataOfLab extends LabFields {}
class OptionsOfLab extends LabFields {}
class StatisticOfLab extends LabFields {}
class ModelOfLab extends LabFields {
  readonly opt: OptionsOfLab;
  readonly stat: StatisticOfLab;

  constructor(cache: FieldCache) {
    super(cache);
    [this.opt, this.stat] = [new OptionsOfLab(cache), new StatisticOfLab(cache)];
  }
}

function source(raw: () => RawLab): FieldSource {
  const fail = (): never => {
    throw new LabspecError("read-only", "the fields of a lab are read-only here: move a control, or change a copy of the model (`toModel`)");
  };
  const copy = (index: number): unknown => call(() => raw().field(index));
  const number = (index: number): number => (copy(index) as ArrayLike<number>)[0] ?? NaN;
  return {
    copy,
    number,
    write: fail,
    size: (name) => {
      const size = fields().find((f) => f.elem === "size" && f.name === name);
      return size === undefined ? undefined : number(size.index);
    },
    keep: () => undefined,
  };
}

/** @internal The data of a lab. */
export function dataOfLab(raw: () => RawLab): LabData {
  defineFields(DataOfLab.prototype, "data", (of: DataOfLab) => of.cache);
  return new DataOfLab(new FieldCache(source(raw))) as unknown as LabData;
}

/** @internal The model of a lab. */
export function modelOfLab(raw: () => RawLab): LabModel {
  defineFields(ModelOfLab.prototype, "model", (of: ModelOfLab) => of.cache);
  defineFields(OptionsOfLab.prototype, "opt", (of: OptionsOfLab) => of.cache);
  defineFields(StatisticOfLab.prototype, "stat", (of: StatisticOfLab) => of.cache);
  return new ModelOfLab(new FieldCache(source(raw))) as unknown as LabModel;
}
