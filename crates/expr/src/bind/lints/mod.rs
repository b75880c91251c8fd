//! The third pass: what is allowed, but hardly ever meant. It looks at the text and at what is known of its parts, and changes
//! nothing.

mod angles;
mod compare;
mod idle;
mod numbers;
mod pass;
mod twice;

pub(super) use pass::lint;
