export * from "./workerd.js";
export { Checker, type Entry, type Report } from "../checker.js";
