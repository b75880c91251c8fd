//! Every attribute that the schema declares as supported is looked up by a pass.

use crate::mjcf::schema::{Element, ROOT, Status};
use crate::mjcf::text::seen;
use crate::mjcf::{Folder, check_xml};

/// A model with the attributes that no model of the folders below has.
const OTHERS: &str = r#"<mujoco>
  <default>
    <mesh scale="1 1 1"/>
    <geom fluidcoef="0.5"/>
    <camera fovy="40"/>
    <light mode="fixed"/>
    <default class="motor"><motor gear="2"/></default>
    <default class="adhesion"><adhesion gain="2"/></default>
    <default class="orientation"><orientation kp="3"/></default>
  </default>
  <asset>
    <texture name="sky" type="cube" builtin="flat" width="4" height="4"/>
    <mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>
  </asset>
  <worldbody>
    <camera/>
    <light type="image" texture="sky"/>
    <site name="s"/>
    <body name="b">
      <joint name="j" type="ball"/>
      <geom type="box" mesh="m" fluidshape="ellipsoid"/>
    </body>
  </worldbody>
  <actuator>
    <motor class="motor" joint="j"/>
    <adhesion class="adhesion" body="b" ctrlrange="0 1"/>
    <orientation class="orientation" joint="j"/>
  </actuator>
</mujoco>"#;

#[test]
fn every_supported_attribute_is_looked_up() {
    let here = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in ["src/mjcf/golden", "../../specs/models/zoo", "../../tests/golden/models"] {
        let folder = here.join(folder);
        let files = Folder::new(&folder).unwrap();
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|e| e == "xml") {
                check_xml(
                    &std::fs::read_to_string(&path).unwrap(),
                    &files,
                    path.file_name().unwrap().to_str(),
                );
            }
        }
    }
    let other = crate::mjcf::compile(OTHERS).unwrap();
    assert_eq!(other.light_texid, [0]);

    let (mut unread, mut visited, mut count) = (Vec::new(), Vec::<&'static Element>::new(), 0);
    let mut stack = vec![("mujoco".to_string(), &ROOT)];
    while let Some((path, element)) = stack.pop() {
        if element.status == Status::Unsupported || visited.iter().any(|e| std::ptr::eq(*e, element)) {
            continue;
        }
        visited.push(element);
        if !matches!(element.status, Status::Ignored(what) if !what.contains("programs")) {
            for a in element.attributes().filter(|a| a.status == Status::Supported) {
                count += 1;
                if !seen::was_looked_up(element, a.name) {
                    unread.push(format!("{path} {}", a.name));
                }
            }
        }
        stack.extend(element.children.iter().map(|c| (format!("{path}/{}", c.name), *c)));
    }
    assert!(count > 700, "{count}");
    assert!(
        unread.is_empty(),
        "{} are called supported, and nothing reads them:\n{}",
        unread.len(),
        unread.join("\n")
    );
}
