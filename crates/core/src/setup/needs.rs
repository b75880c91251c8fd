//! The features of the build that a model requires.

use crate::model::Model;
use crate::{collision, sensor};

/// Two geoms whose contacts or distance require the general algorithm for convex shapes.
pub(crate) fn search(m: &Model) -> Option<[usize; 2]> {
    collision::searched_pair(m).or_else(|| sensor::searched_pair(m))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn searched(rest: &str, geoms: &str) -> Option<[usize; 2]> {
        let model = crate::mjcf::compile(&format!(
            "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/>
             <body name='a'><freejoint/><geom name='a' size='.1 .1 .1' {geoms}/></body>
             <body name='b' pos='1 0 0'><freejoint/><geom name='b' type='box' size='.1 .1 .1'/></body></worldbody>{rest}</mujoco>"
        ));
        search(&model.unwrap())
    }

    #[test]
    fn types_bodies_and_sensors_decide() {
        let distance = "<sensor><distance geom1='a' geom2='b'/></sensor>";
        assert_eq!(searched("", "type='sphere'"), None);
        assert_eq!(searched("", "type='capsule'"), None);
        assert_eq!(searched("", "type='box'"), None);
        assert_eq!(searched("", "type='cylinder'"), Some([1, 2]));
        // The contact bits may change during a run.
        assert_eq!(searched("", "type='ellipsoid' contype='0' conaffinity='0'"), Some([1, 2]));
        assert_eq!(searched("<contact><exclude body1='a' body2='b'/></contact>", "type='cylinder'"), None);
        assert_eq!(searched(distance, "type='sphere'"), None);
        assert_eq!(searched(distance, "type='box'"), Some([1, 2]));
        assert_eq!(
            searched(
                &format!("<contact><exclude body1='a' body2='b'/></contact>{distance}"),
                "type='cylinder'"
            ),
            Some([1, 2])
        );
    }
}
