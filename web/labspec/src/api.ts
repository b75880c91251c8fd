export { LabspecError, type Finding } from "./error.js";
export {
  Lab, LabState, type Control, type ControlValue, type Crossing, type LabData, type LabEvents, type LabModel, type Models, type PlayOptions, type Shown,
} from "./lab.js";
export { Data, Model, type ObjectKind, type RayHit, type Which } from "./model.js";
export { Expression, type ExpressionValue } from "./expression.js";
export type { ContactInfo } from "./contact.js";
export type { FieldView } from "./fields.js";
export type { DataFields, ModelFields, OptionFields, StatisticFields } from "./field-types.js";
export { isReady, type InitOptions } from "./state.js";
