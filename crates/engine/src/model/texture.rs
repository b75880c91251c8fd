//! Declarations of textures. The engine does not draw: a view computes the pixels from them.

/// The declaration of a texture in MJCF (XML reference, asset/texture), with MuJoCo's defaults.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// `mjtTexture`: 0 two-dimensional, 1 cube, 2 sky box.
    pub kind: i32,
    /// `mjtBuiltin`: 0 none, 1 gradient, 2 checker, 3 flat.
    pub builtin: i32,
    /// `mjtMark`: 0 none, 1 edge, 2 cross, 3 random.
    pub mark: i32,
    /// The first colour.
    pub rgb1: [f64; 3],
    /// The second colour.
    pub rgb2: [f64; 3],
    /// The colour of marks.
    pub markrgb: [f64; 3],
    /// The probability of a mark at a pixel.
    pub random: f64,
    /// Width and height of a builtin texture, pixels.
    pub size: [i32; 2],
    /// The number of channels of a file.
    pub nchannel: i32,
    /// Paths in the folder of the model: no file, one, or those of the six faces (right, left, up, down, front, back). A face
    /// without a file has an empty path.
    pub files: Vec<String>,
    /// Rows and columns of the grid of faces in one file.
    pub gridsize: [i32; 2],
    /// The face of each cell of the grid: `R`, `L`, `U`, `D`, `F`, `B`, or `.` for none.
    pub gridlayout: String,
    /// Whether a file is mirrored left to right, and top to bottom.
    pub flip: [bool; 2],
}

impl Default for Texture {
    fn default() -> Texture {
        Texture {
            kind: 1,
            builtin: 0,
            mark: 0,
            rgb1: [0.8; 3],
            rgb2: [0.5; 3],
            markrgb: [0.0; 3],
            random: 0.01,
            size: [0; 2],
            nchannel: 3,
            files: Vec::new(),
            gridsize: [1; 2],
            gridlayout: String::new(),
            flip: [false; 2],
        }
    }
}
