export * from "./node.js";
export { Checker, type Entry, type Report } from "../checker.js";
