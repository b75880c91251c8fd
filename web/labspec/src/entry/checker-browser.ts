export * from "./browser.js";
export { Checker, type CheckedFinding, type Completion, type Entry, type Fix, type Hover, type LabOfLesson, type Report, type TextEdit } from "../checker.js";
