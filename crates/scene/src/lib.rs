//! Pictures of scenes, drawn without a graphics processor: by the ray through each pixel.
//!
//! [`draw`] takes a model, its data and a [`View`]; it returns a [`Picture`]. The picture is the one that the elements of pages draw
//! (`web/elements/src/view`): the same camera, lights, colours, floor and overlays, so that a page can show it until its own is there, and a
//! printed lesson shows what a reader of the page sees. Equal arguments give equal bytes.
//!
//! The modules follow the light backwards: `eye` gives the ray of a pixel, `content` the solids of the scene, `shape` where a ray meets a solid,
//! `surface` the colour that is seen there, `texture` and `image` those of textures, `light` what arrives there, and `picture` the pixels.
#![forbid(unsafe_code)]

mod content;
mod eye;
mod image;
mod light;
mod mesh;
mod overlay;
mod palette;
mod picture;
mod shape;
mod surface;
#[cfg(test)]
mod tests;
mod texture;

pub use eye::Camera;
pub use image::Images;
pub use picture::{Picture, draw};

/// What is drawn over a scene, by the names of the lab format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlays {
    /// Frames of the bodies.
    pub frames: bool,
    /// Joints with their axes.
    pub joints: bool,
    /// Contacts as discs.
    pub contacts: bool,
    /// Contact forces as arrows.
    pub forces: bool,
    /// Centres of mass.
    pub com: bool,
    /// Sites.
    pub sites: bool,
    /// Cameras of the model.
    pub cameras: bool,
    /// Shadows.
    pub shadows: bool,
}

impl Default for Overlays {
    fn default() -> Overlays {
        Overlays {
            frames: false,
            joints: false,
            contacts: false,
            forces: false,
            com: false,
            sites: false,
            cameras: false,
            shadows: true,
        }
    }
}

/// How a scene is seen.
#[derive(Clone, Debug)]
pub struct View {
    /// Where it is seen from.
    pub camera: Camera,
    /// What is drawn over it.
    pub overlays: Overlays,
    /// Length of a drawn force, m/N.
    pub force_scale: f64,
    /// The pictures of textures. Those that are not among them are white.
    pub images: Images,
    /// The path of a point up to now, world frame, m.
    pub trail: Vec<[f64; 3]>,
    /// Width and height, pixels; at most [`View::MAX_SIDE`] each.
    pub size: [usize; 2],
}

impl View {
    /// The largest width and height, pixels.
    pub const MAX_SIDE: usize = 4096;
}

impl Default for View {
    fn default() -> View {
        View {
            camera: Camera::default(),
            overlays: Overlays::default(),
            force_scale: 0.02,
            images: Images::default(),
            trail: Vec::new(),
            size: [800, 300],
        }
    }
}
