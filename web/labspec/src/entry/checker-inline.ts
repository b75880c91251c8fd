export * from "./inline.js";
export { Checker, type Entry, type Report } from "../checker.js";
