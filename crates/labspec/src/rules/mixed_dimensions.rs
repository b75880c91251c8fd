use labspec_finding::{Example, Layer, Rule, Severity};

/// Quantities of different dimensions are added or compared.
pub const MIXED_DIMENSIONS: &Rule = &Rule {
    code: "mixed-dimensions",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "quantities of different dimensions are added or compared",
    why: "A sum of metres and seconds means nothing: often an index is the next one, or a factor is forgotten. In statements it is a note, as a controller may have gains of 1. A factor that is a number of the text may have a unit, and so excuses the sum",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "place", "expr": "⟦data.qpos[0] + data.qvel[0]⟧"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "place", "expr": "data.qpos[0] + data.qvel[0] * data.time"}]}"#,
    ),
};
