//! What a model needs of the build that shall run it.

use crate::model::Model;
use crate::{collision, sensor};

/// Two geoms whose contacts or distance the general algorithm for convex shapes would have to find.
pub(crate) fn search(m: &Model) -> Option<[usize; 2]> {
    collision::searched_pair(m).or_else(|| sensor::searched_pair(m))
}
