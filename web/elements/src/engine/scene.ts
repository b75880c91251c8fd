/** Reads the data that the view draws from a lab. */
import type { Lab } from "labspec/slim";
import type { SceneContact, SceneFrame, SceneModel } from "../view/types.js";

const MODEL_FIELDS = [
  "geom_type", "geom_bodyid", "geom_group", "geom_size", "geom_rgba", "geom_matid", "geom_dataid",
  "mesh_vertadr", "mesh_vertnum", "mesh_faceadr", "mesh_facenum", "mesh_normaladr", "mesh_texcoordadr", "mesh_texcoordnum",
  "mesh_vert", "mesh_normal", "mesh_texcoord", "mesh_face", "mesh_facenormal", "mesh_facetexcoord",
  "hfield_size", "hfield_nrow", "hfield_ncol", "hfield_adr", "hfield_data",
  "mat_texid", "mat_texuniform", "mat_texrepeat", "mat_emission", "mat_specular", "mat_shininess", "mat_reflectance", "mat_rgba",
  "site_type", "site_bodyid", "site_group", "site_size", "site_rgba", "site_matid",
  "light_type", "light_castshadow", "light_active", "light_attenuation", "light_cutoff", "light_exponent",
  "light_ambient", "light_diffuse", "light_specular",
  "cam_fovy", "cam_projection", "jnt_type", "jnt_bodyid", "body_parentid", "body_mass", "body_subtreemass",
  "tendon_width", "tendon_rgba",
] as const;

const FRAME_FIELDS = [
  "geom_xpos", "geom_xmat", "site_xpos", "site_xmat", "xpos", "xmat", "xipos", "subtree_com", "xanchor", "xaxis",
  "cam_xpos", "cam_xmat", "light_xpos", "light_xdir", "ten_wrapadr", "ten_wrapnum", "wrap_obj", "wrap_xpos",
] as const;

type ModelArrays = Pick<SceneModel, (typeof MODEL_FIELDS)[number]>;
type FrameArrays = Pick<SceneFrame, (typeof FRAME_FIELDS)[number]>;

/** The constants of a lab's model as they are now. */
export function readSceneModel(lab: Lab): SceneModel {
  const { model } = lab;
  const arrays = Object.fromEntries(MODEL_FIELDS.map((name) => [name, model[name]])) as unknown as ModelArrays;
  return { ...arrays, center: Array.from(model.stat.center), extent: model.stat.extent, cameras: lab.names("cam") };
}

/** The data that change in every frame. */
export function readSceneFrame(lab: Lab): SceneFrame {
  const { data } = lab;
  const arrays = Object.fromEntries(FRAME_FIELDS.map((name) => [name, data[name]])) as unknown as FrameArrays;
  return { ...arrays, time: lab.time, contacts: readContacts(lab) };
}

/** The fields of the scene that programs of the lab write. */
export function writtenSceneFields(lab: Lab): readonly (typeof MODEL_FIELDS)[number][] {
  const written = new Set(lab.writes);
  return MODEL_FIELDS.filter((name) => written.has(`model.${name}`));
}

/** Whether fields of a model differ from those that were sent. */
export function sceneModelChanged(lab: Lab, sent: SceneModel, written: readonly (typeof MODEL_FIELDS)[number][]): boolean {
  return written.some((name) => {
    const [now, before] = [lab.model[name] as ArrayLike<number>, sent[name] as ArrayLike<number>];
    for (let i = 0; i < now.length; i++) if (!Object.is(now[i], before[i])) return true;
    return now.length !== before.length;
  });
}

/** The active contacts, with the force on the second geom: the normal and two tangents, times their forces. */
function readContacts(lab: Lab): SceneContact[] {
  const acting = lab.contacts.filter((contact) => contact.exclude === 0);
  return acting.map(({ pos, frame, force, dim, geom1, geom2 }) => {
    const rows = dim > 1 ? 3 : 1;
    const world: [number, number, number] = [0, 0, 0];
    for (let axis = 0; axis < 3; axis++) {
      for (let row = 0; row < rows; row++) world[axis] = (world[axis] ?? 0) + (frame[3 * row + axis] ?? 0) * (force[row] ?? 0);
    }
    return { pos: vector(pos), normal: vector(frame), force: world, geom1, geom2 };
  });
}

function vector(of: ArrayLike<number>): [number, number, number] {
  return [of[0] ?? 0, of[1] ?? 0, of[2] ?? 0];
}
