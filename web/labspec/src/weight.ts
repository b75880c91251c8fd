/**
 * What an object of the module weighs for the garbage collector, which sees only the few bytes of its handle: a buffer that is never
 * touched makes it collect handles before the module's memory has grown.
 */
export function weight(bytes: number): ArrayBuffer {
  return new ArrayBuffer(bytes);
}

export const LAB = 1 << 19;
export const STATE = 1 << 17;
export const DATA = 1 << 18;
export const EXPRESSION = 1 << 14;
