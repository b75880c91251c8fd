//! JavaScript errors: a message, a code, and the findings.

use crate::{finding, object};
use js_sys::{Error, Reflect};
use labspec::finding::Finding;
use labspec_core as core;
use serde_json::Value as Json;
use wasm_bindgen::JsValue;

/// An error with a code.
pub(crate) fn call_error(code: &str, message: &str) -> JsValue {
    with_findings(code, message, &[])
}

/// The error for a failure of the library.
pub(crate) fn thrown(e: &labspec::Error) -> JsValue {
    let code = e.findings().first().map_or("call", |f| f.code);
    with_findings(code, &e.to_string(), e.findings())
}

/// The error for a failure of the engine.
pub(crate) fn refused(e: &core::Error) -> JsValue {
    let code = match e {
        core::Error::Model(list) => list.first().map_or("model", |f| f.code),
        core::Error::ForeignData => "foreign-data",
        core::Error::NoName { .. } => "unknown-name",
        core::Error::NoId { .. } => "unknown-id",
        core::Error::NoField(_) => "unknown-field",
        core::Error::NotWritable(_) => "read-only",
        core::Error::Length { .. } => "wrong-length",
        core::Error::Value { .. } => "wrong-value",
        core::Error::NotAModel => "not-a-model",
        core::Error::NoConvex { .. } => "no-convex-shapes",
        core::Error::Restore(_) => "not-a-state",
        _ => "call",
    };
    with_findings(code, &e.to_string(), e.diagnostics())
}

fn with_findings(code: &str, message: &str, findings: &[Finding]) -> JsValue {
    let error = Error::new(message);
    let _ = Reflect::set(&error, &"code".into(), &code.into());
    let findings: Json = findings.iter().map(finding).collect();
    if let Ok(findings) = object(&findings) {
        let _ = Reflect::set(&error, &"findings".into(), &findings);
    }
    error.into()
}
