//! Contact pairs and equalities: reading, and writing to the model.

pub(crate) mod fill_constraint;
pub(crate) mod read_contact;
pub(crate) mod read_equality;
