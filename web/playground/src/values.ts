/** Which values of controls a changed lab can keep. */
import type { ControlValue } from "labspec/slim";
import { readObject } from "./project.js";

/** The values that the controls of a lab can have. */
export function fitting(lab: string, values: ReadonlyMap<string, ControlValue>): [string, ControlValue][] {
  const controls = readObject(lab)?.["controls"];
  const fits = (control: unknown): [string, ControlValue][] => {
    if (typeof control !== "object" || control === null) return [];
    const { label, min, max, options } = control as { label?: unknown; min?: unknown; max?: unknown; options?: unknown };
    const value = typeof label === "string" ? values.get(label) : undefined;
    if (typeof label !== "string" || value === undefined) return [];
    const inRange = typeof min === "number" && typeof max === "number" && typeof value === "number" && min <= value && value <= max;
    const isOption = Array.isArray(options) && (options as unknown[]).some((option) => Array.isArray(option) && option[1] === value);
    return inRange || isOption ? [[label, value]] : [];
  };
  return Array.isArray(controls) ? (controls as unknown[]).flatMap(fits) : [];
}
