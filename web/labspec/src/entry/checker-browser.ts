export * from "./browser.js";
export { Checker, type Entry, type Report } from "../checker.js";
