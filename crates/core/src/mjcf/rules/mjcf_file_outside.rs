use labspec_finding::{Example, Layer, Rule, Severity};

/// A file that the model names is outside the allowed folder.
pub const OUTSIDE: &Rule = &Rule {
    code: "mjcf-file-outside",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a file that the model names is outside the allowed folder",
    why: "a lesson from elsewhere must not read the files of the person who checks it",
    bad: Example::Files(&[("models/model.xml", "<mujoco><asset><mesh name='m' file='⟦../other/mesh.obj⟧'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>".as_bytes()), ("other/mesh.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")]),
    good: Example::Files(&[("models/model.xml", b"<mujoco><asset><mesh name='m' file='mesh.obj'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>"), ("models/mesh.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")]),
};
