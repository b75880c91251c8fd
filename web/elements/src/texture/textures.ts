/** The textures of a model: builtin ones at once, those of files when they are decoded. */
import type { Models, TextureDeclaration } from "labspec/slim";
import type { SceneTexture } from "../view/types.js";
import { BUILTIN, builtinTexture, KIND } from "./builtin.js";
import { textureOfFiles } from "./files.js";

/** More textures of a model stay white. */
const MOST_TEXTURES = 64;

/** What stands in for a texture that is missing: it leaves colours as they are. */
function white(type: number): SceneTexture {
  const faces = type === KIND.flat ? 1 : 6;
  return { type: type === KIND.sky ? KIND.cube : type, width: 1, height: faces, channels: 3, data: new Uint8Array(3 * faces).fill(255) };
}

/** The textures by id, as far as they need no file. */
export function builtinTextures(declared: readonly TextureDeclaration[]): readonly SceneTexture[] {
  return declared.map((t, i) => (i < MOST_TEXTURES ? builtinTexture(t) : null) ?? white(t.type));
}

/** The textures by id, with those of files; `null` where no file is named. */
export async function allTextures(declared: readonly TextureDeclaration[], builtin: readonly SceneTexture[], models: Models): Promise<readonly SceneTexture[] | null> {
  const isFile = (t: TextureDeclaration, i: number): boolean => t.builtin === BUILTIN.none && t.files.length > 0 && i < MOST_TEXTURES;
  if (!declared.some(isFile)) return null;
  return Promise.all(declared.map(async (t, i) => (isFile(t, i) ? await textureOfFiles(t, models) : null) ?? builtin[i] ?? white(t.type)));
}
