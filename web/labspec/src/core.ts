// What the entries share: one file of the package. A page fetches an entry, this file and the module.
export * from "./arguments.js";
export * from "./contact.js";
export { LabspecError } from "./error.js";
export * from "./expression.js";
export * from "./fields.js";
export * from "./glue.js";
export * from "./lab.js";
export * from "./lab-events.js";
export * from "./lab-fields.js";
export * from "./lab-state.js";
export * from "./model.js";
export * from "./state.js";
export * from "./weight.js";
