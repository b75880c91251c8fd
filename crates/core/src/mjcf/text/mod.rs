//! Conversion of bytes to a tree of elements: limits, XML, values of attributes, and the diagnostics.

pub(crate) mod diagnostic;
pub(crate) mod load;
pub(crate) mod patch;
pub(crate) mod scan;
#[cfg(test)]
pub(crate) mod seen;
pub(crate) mod tree;
pub(crate) mod values;
pub(crate) mod xml;
