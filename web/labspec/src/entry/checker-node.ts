export * from "./node.js";
export { Checker, type CheckedFinding, type Completion, type Entry, type Fix, type Hover, type LabOfLesson, type Report, type TextEdit } from "../checker.js";
