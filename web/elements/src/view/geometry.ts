/** The meshes, height fields and textures of a model, and their names in the shared context. */
import type { SharedContext } from "./context.js";
import { at } from "./matrix.js";
import { hashNumbers, hfieldShape, meshShape } from "./mesh.js";
import type { GeometryNames } from "./scene.js";
import type { SceneModel } from "./types.js";

/** Names of everything that a model needs uploaded; equal data has equal names, in every view. */
export interface Geometry extends GeometryNames {
  readonly textures: readonly string[];
  /** Id of the sky box, −1 without one. */
  readonly sky: number;
}

/** `mjTEXTURE_SKYBOX`. */
const SKYBOX = 2;

function meshName(m: SceneModel, id: number): string {
  const part = (list: Parameters<typeof hashNumbers>[0], first: number, count: number, width: number): string =>
    hashNumbers(list, width * first, width * (first + count));
  const faces = at(m.mesh_faceadr, id), count = at(m.mesh_facenum, id);
  return `mesh ${part(m.mesh_vert, at(m.mesh_vertadr, id), at(m.mesh_vertnum, id), 3)} ${part(m.mesh_face, faces, count, 3)} ${
    part(m.mesh_facenormal, faces, count, 3)} ${part(m.mesh_facetexcoord, faces, count, 3)}`;
}

export function nameGeometry(m: SceneModel): Geometry {
  const mesh = Array.from(m.mesh_vertadr, (_, id) => meshName(m, id));
  const hfield = Array.from(m.hfield_adr, (first, id) => {
    const [rows, columns] = [at(m.hfield_nrow, id), at(m.hfield_ncol, id)];
    return `hfield ${rows}x${columns} ${hashNumbers(m.hfield_data, first, first + rows * columns)} ${hashNumbers(m.hfield_size, 4 * id, 4 * id + 4)}`;
  });
  const images = m.textures ?? [];
  const textures = images.map(t => `texture ${t.type} ${t.width}x${t.height} ${t.channels} ${hashNumbers(t.data)}`);
  return { mesh, hfield, textures, sky: images.findIndex(t => t.type === SKYBOX) };
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
