/** The meshes, height fields and textures of a model, and their names in the shared context. */
import type { SharedContext } from "./context.js";
import { at } from "./matrix.js";
import { hashNumbers, hfieldShape, meshShape } from "./mesh.js";
import type { GeometryNames } from "./scene.js";
import type { Numbers, SceneModel, SceneTexture } from "./types.js";

/** Names of everything that a model needs uploaded; equal data has equal names, in every view. */
export interface Geometry extends GeometryNames {
  readonly textures: readonly string[];
  /** Id of the sky box, −1 without one. */
  readonly sky: number;
}

/** `mjTEXTURE_SKYBOX`. */
const SKYBOX = 2;

const MESH_FIELDS = [
  "mesh_vertadr", "mesh_vert", "mesh_normaladr", "mesh_normal", "mesh_texcoordadr", "mesh_texcoord", "mesh_faceadr", "mesh_face", "mesh_facenormal",
  "mesh_facetexcoord",
] as const;

function sameNumbers(a: ArrayLike<number>, b: ArrayLike<number>): boolean {
  if (a === b) return true;
  if (a.length !== b.length) return false;
  for (let i = 0; i < a.length; i++) if (a[i] !== b[i]) return false;
  return true;
}

function meshName(m: SceneModel, id: number): string {
  const rows = (list: Numbers, first: number, end: number, width: number): string => hashNumbers(list, width * first, width * end);
  // The rows of a mesh end where those of the next one begin.
  const until = (addresses: Numbers, list: Numbers, width: number): number => addresses[id + 1] ?? list.length / width;
  const face = at(m.mesh_faceadr, id), lastFace = face + at(m.mesh_facenum, id), vertex = at(m.mesh_vertadr, id);
  const texcoord = m.mesh_texcoordadr[id] ?? -1, lastTexcoord = texcoord + at(m.mesh_texcoordnum, id);
  return [
    "mesh", rows(m.mesh_vert, vertex, vertex + at(m.mesh_vertnum, id), 3),
    rows(m.mesh_normal, at(m.mesh_normaladr, id), until(m.mesh_normaladr, m.mesh_normal, 3), 3),
    texcoord < 0 ? "" : rows(m.mesh_texcoord, texcoord, lastTexcoord, 2),
    rows(m.mesh_face, face, lastFace, 3), rows(m.mesh_facenormal, face, lastFace, 3), rows(m.mesh_facetexcoord, face, lastFace, 3),
  ].join(" ");
}

function hfieldName(m: SceneModel, id: number): string {
  const first = at(m.hfield_adr, id), [rows, columns] = [at(m.hfield_nrow, id), at(m.hfield_ncol, id)];
  return `hfield ${rows}x${columns} ${hashNumbers(m.hfield_data, first, first + rows * columns)} ${hashNumbers(m.hfield_size, 4 * id, 4 * id + 4)}`;
}

const textureName = (t: SceneTexture): string => `texture ${t.type} ${t.width}x${t.height} ${t.channels} ${hashNumbers(t.data)}`;

/** The names of a model's geometry. With the model before it, meshes and textures that have stayed the same are not hashed again. */
export function nameGeometry(m: SceneModel, before?: { readonly model: SceneModel; readonly geometry: Geometry }): Geometry {
  const images = m.textures ?? [];
  const hasSameMeshes = before !== undefined && MESH_FIELDS.every(field => sameNumbers(m[field], before.model[field]));
  return {
    mesh: hasSameMeshes ? before.geometry.mesh : Array.from(m.mesh_vertadr, (_, id) => meshName(m, id)),
    // A program may write heights in place.
    hfield: Array.from(m.hfield_adr, (_, id) => hfieldName(m, id)),
    textures: images === before?.model.textures ? before.geometry.textures : images.map(textureName),
    sky: images.findIndex(t => t.type === SKYBOX),
  };
}

export function uploadGeometry(context: SharedContext, m: SceneModel, g: Geometry): void {
  g.mesh.forEach((name, id) => { context.addShape(name, () => meshShape(m, id)); });
  g.hfield.forEach((name, id) => { context.addShape(name, () => hfieldShape(m, id)); });
  g.textures.forEach((name, id) => {
    const image = m.textures?.[id];
    if (image) context.addTexture(name, image);
  });
}

export function releaseGeometry(context: SharedContext, g: Geometry): void {
  for (const name of [...g.mesh, ...g.hfield]) context.removeShape(name);
  for (const name of g.textures) context.removeTexture(name);
}
