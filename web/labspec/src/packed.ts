/** A module as a script contains it. */
export interface PackedModule {
  /** The module in another order, in which gzip makes it smaller (`bindings/unpack`), compressed, in base64. */
  readonly module: string;
  /** The module that restores the order, in base64. */
  readonly unpacker: string;
}

/** What the module that restores the order exports. Addresses and sizes are in bytes; 0 stands for a damaged module. */
interface Unpacker {
  readonly memory: WebAssembly.Memory;
  reserved(length: number): number;
  size(packed: number, length: number): number;
  unpacked(packed: number, length: number): number;
}

/** Bytes of base64, without a loop over characters where the engine has one. */
function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  const native = (Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array<ArrayBuffer> }).fromBase64;
  if (native !== undefined) return native.call(Uint8Array, text);
  const binary = atob(text);
  const out = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) out[i] = binary.charCodeAt(i);
  return out;
}

/** Restores a module, and compiles it. */
export async function compilePacked({ module, unpacker }: PackedModule): Promise<WebAssembly.Module> {
  const inflated = new Response(new Blob([fromBase64(module)]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  const [packed, { instance }] = await Promise.all([inflated, WebAssembly.instantiate(fromBase64(unpacker))]);
  const { memory, reserved, size, unpacked } = instance.exports as unknown as Unpacker;
  const place = reserved(packed.byteLength);
  new Uint8Array(memory.buffer, place).set(new Uint8Array(packed));
  const [length, start] = [size(place, packed.byteLength), unpacked(place, packed.byteLength)];
  if (start === 0) throw new Error("the module in this script is damaged");
  return WebAssembly.compile(new Uint8Array(memory.buffer, start, length));
}
