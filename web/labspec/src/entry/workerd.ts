import module from "./labspec.wasm";
import { start } from "../glue.js";

start(module);

export * from "../api.js";
