/** The textures of a model: builtin ones at once, those of files when they are decoded. */
import type { Models, TextureDeclaration } from "labspec/slim";
import type { SceneTexture } from "../view/types.js";
import { BUILTIN, builtinTexture, KIND } from "./builtin.js";
import { countPixels, textureOfFiles } from "./files.js";

/** The largest number of pixels of all builtin textures, and of all files. Textures beyond it stay white. */
const MOST_PIXELS = 1 << 24;

/** The texture in place of a missing one: it does not change colours. */
function white(type: number): SceneTexture {
  const faces = type === KIND.flat ? 1 : 6;
  return { type: type === KIND.sky ? KIND.cube : type, width: 1, height: faces, channels: 3, data: new Uint8Array(3 * faces).fill(255) };
}

/** The textures by id that need no file. */
export function builtinTextures(declared: readonly TextureDeclaration[]): readonly SceneTexture[] {
  let left = MOST_PIXELS;
  return declared.map((t) => {
    const made = left > 0 ? builtinTexture(t) : null;
    left -= made === null ? 0 : made.width * made.height;
    return made ?? white(t.type);
  });
}

/** All textures by id; `null` if no file is named. */
export async function allTextures(declared: readonly TextureDeclaration[], builtin: readonly SceneTexture[], models: Models): Promise<readonly SceneTexture[] | null> {
  let left = MOST_PIXELS;
  const isFile = declared.map((t) => {
    if (t.builtin !== BUILTIN.none || t.files.length === 0) return false;
    const pixels = t.files.reduce((sum, path) => sum + (path === "" ? 0 : countPixels(models[path])), 0);
    if (pixels > left) return false;
    left -= pixels;
    return true;
  });
  if (!isFile.includes(true)) return null;
  return Promise.all(declared.map(async (t, i) => (isFile[i] === true ? await textureOfFiles(t, models) : null) ?? builtin[i] ?? white(t.type)));
}
