/** Programs, buffers and textures of one WebGL context. */
import {
  LINE_FRAGMENT, LINE_VERTEX, SHADOW_FRAGMENT, SHADOW_VERTEX, SKY_FRAGMENT, SKY_VERTEX, SURFACE_FRAGMENT, SURFACE_VERTEX,
} from "./programs.js";
import { SHADOW_SIZE } from "./lights.js";
import { STRIDE, type Shape } from "./shapes.js";
import type { SceneTexture } from "./types.js";

type Gl = WebGL2RenderingContext;

/** Texture units. */
export const UNIT = { image: 0, cube: 1, shadow: 2, mirror: 3 } as const;

export interface Program {
  /** The linked program. It is linked while other work goes on, and checked at its first use. */
  readonly program: WebGLProgram;
  /** Place of a uniform; null where the program has no use for it. */
  readonly uniform: (name: string) => WebGLUniformLocation | null;
}

export interface UploadedShape {
  readonly vertexArray: WebGLVertexArrayObject;
  readonly buffers: readonly WebGLBuffer[];
  readonly count: number;
  readonly indexType: number;
}

export interface UploadedTexture {
  readonly texture: WebGLTexture;
  readonly isCube: boolean;
}

/** What a context holds for all scenes. */
export interface Gpu {
  readonly gl: Gl;
  readonly surface: Program;
  readonly shadow: Program;
  readonly line: Program;
  readonly sky: Program;
  readonly instances: WebGLBuffer;
  readonly lines: WebGLBuffer;
  readonly lineArray: WebGLVertexArrayObject;
  readonly emptyArray: WebGLVertexArrayObject;
  readonly shadowBuffer: WebGLFramebuffer;
  readonly shadowTexture: WebGLTexture;
  /** The picture of the last mirror. */
  readonly mirrorTexture: WebGLTexture;
  readonly noImage: WebGLTexture;
  readonly noCube: WebGLTexture;
}

function compile(gl: Gl, vertex: string, fragment: string): Program {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
    const shader = gl.createShader(kind);
    // A lost context has no shaders, and its pictures are not shown.
    if (!shader) continue;
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    gl.deleteShader(shader);
  }
  gl.linkProgram(program);
  let isChecked = false;
  const check = (): void => {
    if (isChecked) return;
    isChecked = true;
    if (gl.getProgramParameter(program, gl.LINK_STATUS) || gl.isContextLost()) return;
    const shaders = (gl.getAttachedShaders(program) ?? []).map(s => gl.getShaderInfoLog(s)).join("\n");
    throw new Error(`a program of the 3D view does not compile: ${gl.getProgramInfoLog(program)}\n${shaders}`);
  };
  const places = new Map<string, WebGLUniformLocation | null>();
  const uniform = (name: string): WebGLUniformLocation | null => {
    check();
    let place = places.get(name);
    if (place === undefined) {
      place = gl.getUniformLocation(program, name);
      places.set(name, place);
    }
    return place;
  };
  return {
    get program() {
      check();
      return program;
    },
    uniform,
  };
}

function lineArray(gl: Gl): WebGLVertexArrayObject {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, Float32Array.of(0, -1, 1, -1, 0, 1, 1, 1), gl.STATIC_DRAW);
  gl.enableVertexAttribArray(0);
  gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
  for (let location = 1; location <= 4; location++) {
    gl.enableVertexAttribArray(location);
    gl.vertexAttribDivisor(location, 1);
  }
  return array;
}

function shadowMap(gl: Gl): { texture: WebGLTexture; buffer: WebGLFramebuffer } {
  const texture = gl.createTexture();
  gl.activeTexture(gl.TEXTURE0 + UNIT.shadow);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, SHADOW_SIZE, SHADOW_SIZE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
  for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.LINEAR);
  for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
  const buffer = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, buffer);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return { texture, buffer };
}

const WHITE: SceneTexture = { type: 0, width: 1, height: 1, channels: 3, data: Uint8Array.of(255, 255, 255) };
const WHITE_CUBE: SceneTexture = { type: 1, width: 1, height: 6, channels: 3, data: new Uint8Array(18).fill(255) };

export function createGpu(gl: Gl): Gpu {
  const { texture, buffer } = shadowMap(gl);
  return {
    gl,
    surface: compile(gl, SURFACE_VERTEX, SURFACE_FRAGMENT),
    shadow: compile(gl, SHADOW_VERTEX, SHADOW_FRAGMENT),
    line: compile(gl, LINE_VERTEX, LINE_FRAGMENT),
    sky: compile(gl, SKY_VERTEX, SKY_FRAGMENT),
    instances: gl.createBuffer(), lines: gl.createBuffer(), lineArray: lineArray(gl), emptyArray: gl.createVertexArray(),
    shadowBuffer: buffer, shadowTexture: texture, mirrorTexture: uploadTexture(gl, WHITE).texture,
    noImage: uploadTexture(gl, WHITE).texture, noCube: uploadTexture(gl, WHITE_CUBE).texture,
  };
}

export function uploadShape(gl: Gl, shape: Shape): UploadedShape {
  const vertexArray = gl.createVertexArray(), vertices = gl.createBuffer(), indices = gl.createBuffer();
  gl.bindVertexArray(vertexArray);
  gl.bindBuffer(gl.ARRAY_BUFFER, vertices);
  gl.bufferData(gl.ARRAY_BUFFER, shape.vertices, gl.STATIC_DRAW);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, shape.indices, gl.STATIC_DRAW);
  for (const [location, size, first] of [[0, 4, 0], [1, 3, 4], [2, 2, 7]] as const) {
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, size, gl.FLOAT, false, 4 * STRIDE, 4 * first);
  }
  for (let location = 3; location <= 9; location++) {
    gl.enableVertexAttribArray(location);
    gl.vertexAttribDivisor(location, 1);
  }
  gl.bindVertexArray(null);
  const indexType = shape.indices instanceof Uint32Array ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT;
  return { vertexArray, buffers: [vertices, indices], count: shape.indices.length, indexType };
}

export function deleteShape(gl: Gl, shape: UploadedShape): void {
  gl.deleteVertexArray(shape.vertexArray);
  for (const buffer of shape.buffers) gl.deleteBuffer(buffer);
}

/** A texture with mipmaps. Grey and grey with alpha become colours. */
export function uploadTexture(gl: Gl, t: SceneTexture): UploadedTexture {
  const isCube = t.type !== 0, target = isCube ? gl.TEXTURE_CUBE_MAP : gl.TEXTURE_2D;
  const height = isCube ? Math.floor(t.height / 6) : t.height;
  const formats = [gl.LUMINANCE, gl.LUMINANCE_ALPHA, gl.RGB, gl.RGBA];
  const format = formats[t.channels - 1] ?? gl.RGB;
  const texture = gl.createTexture();
  gl.activeTexture(gl.TEXTURE0 + (isCube ? UNIT.cube : UNIT.image));
  gl.bindTexture(target, texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  const bytes = t.width * height * t.channels;
  for (let face = 0; face < (isCube ? 6 : 1); face++) {
    const pixels = t.data.subarray(face * bytes, (face + 1) * bytes);
    const place = isCube ? gl.TEXTURE_CUBE_MAP_POSITIVE_X + face : target;
    if (pixels.length === bytes) gl.texImage2D(place, 0, format, t.width, height, 0, format, gl.UNSIGNED_BYTE, pixels);
  }
  gl.generateMipmap(target);
  gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
  for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(target, wrap, isCube ? gl.CLAMP_TO_EDGE : gl.REPEAT);
  return { texture, isCube };
}
