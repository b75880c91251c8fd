/**
 * What the 3D view draws, and how a lab controls it. Field names are those of MuJoCo's mjModel and mjData; arrays are flat and
 * row-major. The view reads plain arrays, so that a lab may run in a worker, and a test may draw without an engine.
 */

export type Numbers = Float32Array | Float64Array | Int32Array | Uint8Array;
type Fields<Names extends string> = { readonly [Name in Names]: Numbers };

/** Constants of a model. Sent once; sent again when a program writes one of them. */
export type SceneModel = Fields<
  | "geom_type" | "geom_bodyid" | "geom_group" | "geom_size" | "geom_rgba" | "geom_matid" | "geom_dataid"
  | "mesh_vertadr" | "mesh_vertnum" | "mesh_faceadr" | "mesh_facenum" | "mesh_normaladr" | "mesh_texcoordadr" | "mesh_texcoordnum"
  | "mesh_vert" | "mesh_normal" | "mesh_texcoord" | "mesh_face" | "mesh_facenormal" | "mesh_facetexcoord"
  | "hfield_size" | "hfield_nrow" | "hfield_ncol" | "hfield_adr" | "hfield_data"
  | "mat_texid" | "mat_texuniform" | "mat_texrepeat" | "mat_emission" | "mat_specular" | "mat_shininess" | "mat_reflectance" | "mat_rgba"
  | "site_type" | "site_bodyid" | "site_group" | "site_size" | "site_rgba" | "site_matid"
  | "light_type" | "light_castshadow" | "light_active" | "light_attenuation" | "light_cutoff" | "light_exponent"
  | "light_ambient" | "light_diffuse" | "light_specular"
  | "cam_fovy" | "cam_projection" | "jnt_type" | "jnt_bodyid" | "body_parentid" | "body_mass" | "body_subtreemass"
  | "tendon_width" | "tendon_rgba"
> & {
  /** Centre (3) and extent of the scene, m (`stat.center`, `stat.extent`). */
  readonly center: ArrayLike<number>;
  readonly extent: number;
  /** Field of view of the free camera, degrees (`vis.global.fovy`); 45 when not given. */
  readonly fovy?: number;
  /** Names of cameras, by id; empty where a camera has none. */
  readonly cameras: readonly string[];
  /** Textures, by id, where the model has them. */
  readonly textures?: readonly SceneTexture[];
};

/** A texture: `type` is mjtTexture (0 2d, 1 cube, 2 skybox); the rows of a cube's six faces follow each other. */
export interface SceneTexture {
  readonly type: number;
  readonly width: number;
  readonly height: number;
  readonly channels: number;
  readonly data: Uint8Array;
}

/** What changes in every frame. */
export type SceneFrame = Fields<
  | "geom_xpos" | "geom_xmat" | "site_xpos" | "site_xmat" | "xpos" | "xmat" | "xipos" | "subtree_com" | "xanchor" | "xaxis"
  | "cam_xpos" | "cam_xmat" | "light_xpos" | "light_xdir" | "ten_wrapadr" | "ten_wrapnum" | "wrap_obj" | "wrap_xpos"
> & {
  readonly time: number;
  readonly contacts: readonly SceneContact[];
};

/** A contact: position and normal in the world frame, and the force on the second geom in the world frame, N. */
export interface SceneContact {
  readonly pos: readonly [number, number, number];
  readonly normal: readonly [number, number, number];
  readonly force: readonly [number, number, number];
  readonly geom1: number;
  readonly geom2: number;
}

/** Overlays that a lab may switch, by the names of the lab format. */
export type Overlay = "frames" | "joints" | "contacts" | "forces" | "com" | "sites" | "cameras" | "shadows";

/** Where the scene is seen from: around a target, or through a camera of the model. */
export interface CameraPose {
  /** Degrees, as MuJoCo's free camera. */
  azimuth: number;
  elevation: number;
  /** m. */
  distance: number;
  target: [number, number, number];
  /** Id of a camera of the model, instead of the above. */
  fixed?: number;
  /** Id of a body that the target follows. */
  track?: number;
}

/** What lies under a point of the picture. */
export interface Pick {
  readonly geom: number;
  readonly body: number;
  /** World frame, m. */
  readonly point: [number, number, number];
  readonly distance: number;
}

export interface ViewOptions {
  /** m per N of drawn forces; 0.02 when not given. */
  readonly forceScale?: number;
  /** Id of a site whose path is drawn. */
  readonly trail?: number;
  readonly camera?: Partial<CameraPose>;
  readonly overlays?: Partial<Record<Overlay, boolean>>;
}

/** One picture of a scene in one canvas. All views of a page share one WebGL context. */
export interface View {
  readonly camera: CameraPose;
  readonly overlays: Record<Overlay, boolean>;
  /** New constants; geometry is uploaded again only where it differs. */
  setModel(model: SceneModel): void;
  /** The poses of the next picture. */
  setFrame(frame: SceneFrame): void;
  /** Forgets the trail. */
  clearTrail(): void;
  /** The spring that drags a body, drawn while it is set: from the grabbed point to the pointer, world frame. */
  setDrag(drag: { from: readonly number[]; to: readonly number[] } | null): void;
  /** Draws now. Cheap when nothing has changed since the last call. */
  draw(): void;
  /** What lies under a point of the canvas, in CSS pixels from its upper left corner. */
  pick(x: number, y: number): Pick | null;
  /** The point in the plane through `through` that faces the camera, under a point of the canvas. */
  unproject(x: number, y: number, through: readonly number[]): [number, number, number];
  /** Colours of the page: background (CSS) or transparent; whether lines need high contrast. */
  setTheme(theme: { background: string | null; highContrast: boolean }): void;
  /** A PNG of what `draw` shows, at a size in pixels. */
  toPng(width: number, height: number): Promise<Blob>;
  dispose(): void;
}

export type CreateView = (canvas: HTMLCanvasElement, model: SceneModel, options?: ViewOptions) => View;
