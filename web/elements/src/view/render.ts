/** Draws a list of instances and lines into the lower left part of the shared canvas. */
import { projectionOf, type Eye } from "./camera.js";
import type { SharedContext } from "./context.js";
import type { Geometry } from "./geometry.js";
import { UNIT, type Gpu, type Program } from "./gpu.js";
import { INSTANCE_SIZE, LAYER, LINE_SIZE, type DrawList, type Run } from "./instances.js";
import { SHADOW_SIZE, type Lights } from "./lights.js";
import { multiply, scale, type Mat4 } from "./matrix.js";
import { frontOf, mirrorEye, reflection, type Mirror } from "./mirror.js";

export interface Picture {
  readonly width: number;
  readonly height: number;
  readonly eye: Eye;
  readonly list: DrawList;
  readonly lights: Lights;
  readonly geometry: Geometry;
  /** Distance of grid lines; where infinite planes begin to fade, and end, m; opacity of the lines. */
  readonly grid: readonly [cell: number, near: number, far: number, opacity: number];
  readonly hiddenAlpha: number;
  /** Device pixels of a CSS pixel. */
  readonly density: number;
}

/** A plane that has everything in front of it. */
const EVERYWHERE = [0, 0, 0, 1];

function drawRun(context: SharedContext, run: Run): void {
  const { gl, instances } = context.gpu, shape = context.shape(run.shape);
  if (!shape) return;
  gl.bindVertexArray(shape.vertexArray);
  gl.bindBuffer(gl.ARRAY_BUFFER, instances);
  const stride = 4 * INSTANCE_SIZE;
  for (let i = 0; i < 7; i++) gl.vertexAttribPointer(3 + i, 4, gl.FLOAT, false, stride, run.first * stride + 16 * i);
  gl.drawElementsInstanced(gl.TRIANGLES, shape.count, shape.indexType, 0, run.count);
}

function drawShadows(context: SharedContext, p: Picture): void {
  const { gl, shadow, shadowBuffer } = context.gpu;
  gl.bindFramebuffer(gl.FRAMEBUFFER, shadowBuffer);
  gl.viewport(0, 0, SHADOW_SIZE, SHADOW_SIZE);
  gl.disable(gl.SCISSOR_TEST);
  gl.clear(gl.DEPTH_BUFFER_BIT);
  gl.useProgram(shadow.program);
  gl.uniformMatrix4fv(shadow.uniform("u_projection"), false, p.lights.shadow);
  gl.disable(gl.CULL_FACE);
  gl.enable(gl.POLYGON_OFFSET_FILL);
  gl.polygonOffset(1.5, 4);
  for (const run of p.list.shadowRuns) drawRun(context, run);
  gl.disable(gl.POLYGON_OFFSET_FILL);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
}

function bind(gpu: Gpu, unit: number, target: number, texture: WebGLTexture): void {
  gpu.gl.activeTexture(gpu.gl.TEXTURE0 + unit);
  gpu.gl.bindTexture(target, texture);
}

function setLights(gpu: Gpu, { uniform }: Program, p: Picture): void {
  const { gl } = gpu, l = p.lights;
  gl.uniform1i(uniform("u_lights"), l.count);
  gl.uniform1i(uniform("u_shadowLight"), l.shadowLight);
  gl.uniform4fv(uniform("u_lightPosition"), l.position);
  gl.uniform4fv(uniform("u_lightDirection"), l.direction);
  gl.uniform4fv(uniform("u_lightDiffuse"), l.diffuse);
  gl.uniform3fv(uniform("u_lightSpecular"), l.specular);
  gl.uniform3fv(uniform("u_lightAttenuation"), l.attenuation);
  gl.uniform3fv(uniform("u_sky"), l.sky);
  gl.uniform3fv(uniform("u_ground"), l.ground);
  gl.uniformMatrix4fv(uniform("u_shadowMatrix"), false, l.shadow);
  gl.uniform3f(uniform("u_shadowTexel"), 1 / SHADOW_SIZE, 2 * l.shadowPixel, 0.0003);
}

/** Prepares the program of surfaces for what is in front of a plane, seen from an eye. */
function setSurface(gpu: Gpu, p: Picture, projection: Mat4, eye: Eye, front: readonly number[]): void {
  const { gl, surface } = gpu, { uniform } = surface;
  gl.useProgram(surface.program);
  gl.uniformMatrix4fv(uniform("u_projection"), false, projection);
  const place = eye.isOrthographic ? scale(eye.forward, -1) : eye.position;
  gl.uniform4f(uniform("u_eye"), place[0], place[1], place[2], eye.isOrthographic ? 0 : 1);
  setLights(gpu, surface, p);
  gl.uniform1i(uniform("u_texture"), UNIT.image);
  gl.uniform1i(uniform("u_cube"), UNIT.cube);
  gl.uniform1i(uniform("u_shadow"), UNIT.shadow);
  gl.uniform4fv(uniform("u_grid"), p.grid);
  gl.uniform1i(uniform("u_mirror"), UNIT.mirror);
  gl.uniform4fv(uniform("u_front"), front);
  gl.uniform1f(uniform("u_alpha"), 1);
  bind(gpu, UNIT.shadow, gl.TEXTURE_2D, gpu.shadowTexture);
  bind(gpu, UNIT.mirror, gl.TEXTURE_2D, gpu.mirrorTexture);
}

function drawLayer(context: SharedContext, p: Picture, layer: number): void {
  const { gpu } = context, { gl } = gpu;
  for (const run of p.list.runs) {
    if (run.layer !== layer) continue;
    const texture = context.texture(p.geometry.textures[run.texture] ?? "");
    bind(gpu, UNIT.image, gl.TEXTURE_2D, texture && !texture.isCube ? texture.texture : gpu.noImage);
    bind(gpu, UNIT.cube, gl.TEXTURE_CUBE_MAP, texture?.isCube ? texture.texture : gpu.noCube);
    drawRun(context, run);
  }
}

function drawSky(context: SharedContext, p: Picture): void {
  const { gl, sky, emptyArray } = context.gpu, texture = context.texture(p.geometry.textures[p.geometry.sky] ?? "");
  if (!texture?.isCube) return;
  gl.useProgram(sky.program);
  bind(context.gpu, UNIT.cube, gl.TEXTURE_CUBE_MAP, texture.texture);
  gl.uniform1i(sky.uniform("u_cube"), UNIT.cube);
  const { forward, right, up } = p.eye, half = p.eye.isOrthographic ? 0.4 : p.eye.halfHeight;
  gl.uniform3fv(sky.uniform("u_forward"), forward);
  gl.uniform3fv(sky.uniform("u_right"), scale(right, (half * p.width) / p.height));
  gl.uniform3fv(sky.uniform("u_up"), scale(up, half));
  gl.bindVertexArray(emptyArray);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
}

function drawLines(gpu: Gpu, p: Picture, projection: Mat4, alpha: number): void {
  const { gl, line, lineArray, lines } = gpu;
  if (p.list.lineCount === 0) return;
  gl.useProgram(line.program);
  gl.uniformMatrix4fv(line.uniform("u_projection"), false, projection);
  gl.uniform2f(line.uniform("u_size"), p.width / p.density, p.height / p.density);
  gl.uniform1f(line.uniform("u_alpha"), alpha);
  gl.bindVertexArray(lineArray);
  gl.bindBuffer(gl.ARRAY_BUFFER, lines);
  for (const [location, size, first] of [[1, 3, 0], [2, 3, 3], [3, 4, 6], [4, 1, 10]] as const) {
    gl.vertexAttribPointer(location, size, gl.FLOAT, false, 4 * LINE_SIZE, 4 * first);
  }
  gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, p.list.lineCount);
}

/** Overlays: faint behind surfaces, then plain in front of them. */
function drawOverlays(context: SharedContext, p: Picture, projection: Mat4): void {
  const { gl, surface } = context.gpu;
  gl.enable(gl.BLEND);
  for (const isHidden of [true, false]) {
    const alpha = isHidden ? p.hiddenAlpha : 1;
    gl.depthFunc(isHidden ? gl.GREATER : gl.LEQUAL);
    gl.depthMask(!isHidden);
    gl.useProgram(surface.program);
    gl.uniform1f(surface.uniform("u_alpha"), alpha);
    gl.enable(gl.CULL_FACE);
    drawLayer(context, p, LAYER.overlay);
    gl.disable(gl.CULL_FACE);
    drawLines(context.gpu, p, projection, alpha);
  }
}

/** Everything but overlays. */
function drawSurfaces(context: SharedContext, p: Picture): void {
  const { gl } = context.gpu;
  gl.enable(gl.BLEND);
  gl.depthMask(true);
  gl.enable(gl.CULL_FACE);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  drawLayer(context, p, LAYER.opaque);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  gl.disable(gl.CULL_FACE);
  drawLayer(context, p, LAYER.plane);
  gl.enable(gl.CULL_FACE);
  gl.depthMask(false);
  drawLayer(context, p, LAYER.transparent);
  gl.depthMask(true);
}

/** The scene in the mirror, as a texture of the size of the picture. It is drawn into the picture first, whose edges are smooth. */
function drawMirror(context: SharedContext, p: Picture, projection: Mat4, mirror: Mirror): void {
  const { gl, mirrorTexture } = context.gpu;
  setSurface(context.gpu, p, multiply(projection, reflection(mirror)), mirrorEye(p.eye, mirror), frontOf(mirror, 1e-3 * p.eye.near));
  // Mirrored triangles turn the other way.
  gl.frontFace(gl.CW);
  drawSurfaces(context, p);
  gl.frontFace(gl.CCW);
  bind(context.gpu, UNIT.mirror, gl.TEXTURE_2D, mirrorTexture);
  gl.copyTexImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 0, 0, p.width, p.height, 0);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
}

function upload(gpu: Gpu, p: Picture): void {
  const { gl } = gpu;
  for (const [buffer, data] of [[gpu.instances, p.list.instances], [gpu.lines, p.list.lines]] as const) {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    if (data.length > 0) gl.bufferData(gl.ARRAY_BUFFER, data, gl.STREAM_DRAW);
  }
}

export function drawPicture(context: SharedContext, p: Picture): void {
  const { gpu } = context, { gl } = gpu;
  upload(gpu, p);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  gl.depthMask(true);
  gl.disable(gl.BLEND);
  if (p.lights.shadowLight >= 0) drawShadows(context, p);
  gl.viewport(0, 0, p.width, p.height);
  gl.enable(gl.SCISSOR_TEST);
  gl.scissor(0, 0, p.width, p.height);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  const projection = projectionOf(p.eye, p.width / p.height);
  if (p.list.mirror !== null) drawMirror(context, p, projection, p.list.mirror);
  gl.disable(gl.BLEND);
  drawSky(context, p);
  setSurface(gpu, p, projection, p.eye, EVERYWHERE);
  drawSurfaces(context, p);
  drawOverlays(context, p, projection);
}
