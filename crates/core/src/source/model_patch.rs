//! Patches of a model's text, which are applied before it is compiled.

/// A patch: an attribute of an element, and its new text; or an element, and the element that replaces it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Patch {
    /// The kind of the element, its name if it has one, and the attribute: `geom ball friction`, `option timestep`,
    /// `default steel geom friction` for an attribute in a default class. Without the attribute for an element: `motor drive`.
    pub path: String,
    /// The new text of the attribute, or the XML of the new element: `<position joint="arm" kp="50"/>`.
    pub value: String,
}

impl Patch {
    /// Whether it replaces an element.
    pub(crate) fn is_element(&self) -> bool {
        self.value.trim_start().starts_with('<')
    }
}

/// The reason why a patch is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The problem, as a sentence.
    pub message: String,
    /// A suggestion what to write instead.
    pub help: String,
}
