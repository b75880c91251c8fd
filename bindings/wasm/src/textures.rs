//! The declarations of textures, from which a page computes the pixels.

use crate::{Lab, object};
use serde_json::json;
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = r#"
/** A texture as the model declares it. Words are MuJoCo's numbers: `mjtTexture`, `mjtBuiltin`, `mjtMark`. */
export interface TextureDeclaration {
  type: number;
  builtin: number;
  mark: number;
  rgb1: number[];
  rgb2: number[];
  markrgb: number[];
  random: number;
  width: number;
  height: number;
  channels: number;
  /** No file, one, or one for each face: right, left, up, down, front, back. */
  files: string[];
  /** Rows and columns of the faces in one file, and the face of each cell. */
  gridsize: number[];
  gridlayout: string;
  hflip: boolean;
  vflip: boolean;
}
"#;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(typescript_type = "TextureDeclaration[]")]
    pub type Textures;
}

#[wasm_bindgen]
impl Lab {
    /// The declarations of the textures, by id.
    pub fn textures(&self) -> Result<Textures, JsValue> {
        let one = |t: &labspec_core::Texture| {
            let ([width, height], [hflip, vflip]) = (t.size, t.flip);
            json!({
                "type": t.kind, "builtin": t.builtin, "mark": t.mark, "rgb1": t.rgb1, "rgb2": t.rgb2, "markrgb": t.markrgb,
                "random": t.random, "width": width, "height": height, "channels": t.nchannel, "files": t.files,
                "gridsize": t.gridsize, "gridlayout": t.gridlayout, "hflip": hflip, "vflip": vflip,
            })
        };
        Ok(object(&self.player.model().textures.iter().map(one).collect())?.unchecked_into())
    }
}
