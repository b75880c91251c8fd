/** What the view draws, read from a lab. */
import type { Lab } from "labspec/slim";
import type { SceneFrame, SceneModel } from "../view/types.js";
declare const MODEL_FIELDS: readonly ["geom_type", "geom_bodyid", "geom_group", "geom_size", "geom_rgba", "geom_matid", "geom_dataid", "mesh_vertadr", "mesh_vertnum", "mesh_faceadr", "mesh_facenum", "mesh_normaladr", "mesh_texcoordadr", "mesh_texcoordnum", "mesh_vert", "mesh_normal", "mesh_texcoord", "mesh_face", "mesh_facenormal", "mesh_facetexcoord", "hfield_size", "hfield_nrow", "hfield_ncol", "hfield_adr", "hfield_data", "mat_texid", "mat_texuniform", "mat_texrepeat", "mat_emission", "mat_specular", "mat_shininess", "mat_reflectance", "mat_rgba", "site_type", "site_bodyid", "site_group", "site_size", "site_rgba", "site_matid", "light_type", "light_castshadow", "light_active", "light_attenuation", "light_cutoff", "light_exponent", "light_ambient", "light_diffuse", "light_specular", "cam_fovy", "cam_projection", "jnt_type", "jnt_bodyid", "body_parentid", "body_mass", "body_subtreemass", "tendon_width", "tendon_rgba"];
/** The constants of a lab's model as they are now. */
export declare function readSceneModel(lab: Lab): SceneModel;
/** What changes in every frame. */
export declare function readSceneFrame(lab: Lab): SceneFrame;
/** The fields of the scene that programs of the lab write. */
export declare function writtenSceneFields(lab: Lab): readonly (typeof MODEL_FIELDS)[number][];
/** Whether fields of a model differ from those that were sent. */
export declare function sceneModelChanged(lab: Lab, sent: SceneModel, written: readonly (typeof MODEL_FIELDS)[number][]): boolean;
export {};
