//! The zoo (`specs/models/zoo`, one model a feature) against what MuJoCo 3.14.0 computes for it.

use crate::recorded::{examine, objects};
use crate::standing::{Exception, Standing};
use crate::support::{models, recording, workspace};
use labspec_core::reflect::{self, Object};
use std::collections::BTreeSet;
use std::path::PathBuf;

/// What is known to differ, and why.
const EXCEPTIONS: &[Exception] = &[];

fn folder() -> PathBuf {
    workspace().join("specs/models/zoo")
}

#[test]
fn every_model_of_the_zoo_is_as_recorded() {
    let mut standing = Standing::default();
    for name in models(&folder()) {
        let model = folder().join(format!("{name}.xml"));
        let outcome = examine(&model, &recording(&format!("zoo/{name}")));
        standing.add(name, outcome);
    }
    standing.check(Some("zoo"), EXCEPTIONS);
}

/// What the library has and we have not, of all that is recorded.
const LACKING: &[&str] = &["model.site_dataid"];

#[test]
fn the_fields_that_we_lack() {
    let mut lacking = BTreeSet::new();
    for name in models(&folder()) {
        let recording = recording(&format!("zoo/{name}"));
        let first = &recording["forward"][0];
        let parts = [
            ("model", Object::Model, &recording["compiled"]["model"]),
            ("model", Object::Model, &recording["compiled"]["single"]),
            ("opt", Object::Option, &recording["compiled"]["opt"]),
            ("stat", Object::Statistic, &recording["compiled"]["stat"]),
            ("data", Object::Data, &first["state"]),
            ("data", Object::Data, &first["data"]),
            ("data", Object::Data, &first["post"]),
        ];
        for (part, object, fields) in parts {
            let names = objects(fields).map(|(name, _)| name);
            let ours = |name: &&String| reflect::field(object, name).is_none();
            lacking.extend(names.filter(ours).map(|name| format!("{part}.{name}")));
        }
    }
    assert_eq!(lacking.iter().map(String::as_str).collect::<Vec<_>>(), LACKING);
}
