//! The widgets of a page that labspec does not run: their names, and the JSON Schemas that their blocks must fit.

use super::json_schema::{SchemaViolation, check_schema, validate};
use labspec::finding::{Finding, InFile};
use labspec::json;
use labspec::ledger::{Evidence, State};
use labspec::rules;
use labspec::source::read_text;
use labspec::spec::{Lesson, Widget};
use serde_json::Value;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// The maximum size of a schema in bytes.
const MAX_SCHEMA: u64 = 1 << 20;
/// Maximum number of findings about one block.
const MAX_FINDINGS: usize = 20;

/// A widget that the settings declare.
#[derive(Clone, Debug)]
pub(super) struct PageWidget {
    /// Its name, as in `lab playground`.
    pub(super) name: String,
    /// The path of its schema, as in the settings, and the schema.
    schema: Option<(String, Arc<Value>)>,
}

impl PageWidget {
    /// `playground`, or `playground = schemas/playground.json`.
    pub(super) fn line(&self) -> String {
        match &self.schema {
            Some((path, _)) => format!("{} = {path}", self.name),
            None => self.name.clone(),
        }
    }
}

/// Reads the setting `widgets`: a list of names, or a table of names with the paths of their schemas from the folder of the
/// settings, or `true`.
///
/// # Errors
/// The value has another type, or a schema cannot be used.
pub(super) fn read(folder: &Path, value: Option<&toml::Value>) -> Result<Vec<PageWidget>, String> {
    let wrong = || {
        "`widgets` must be a list of texts, or a table: playground = \"schemas/playground.json\"".to_string()
    };
    let named = |name: &str, schema| PageWidget { name: name.to_string(), schema };
    match value {
        None => Ok(Vec::new()),
        Some(toml::Value::Array(list)) => {
            let names = list.iter().map(|name| name.as_str().map(|name| named(name, None)));
            names.collect::<Option<_>>().ok_or_else(wrong)
        }
        Some(toml::Value::Table(table)) => {
            let one = |(name, value): (&String, &toml::Value)| match value {
                toml::Value::Boolean(true) => Ok(named(name, None)),
                toml::Value::String(path) => {
                    let schema = read_schema(&folder.join(path))
                        .map_err(|why| format!("the schema of `{name}`, {path}: {why}"))?;
                    Ok(named(name, Some((path.clone(), Arc::new(schema)))))
                }
                _ => Err(wrong()),
            };
            table.iter().map(one).collect()
        }
        Some(_) => Err(wrong()),
    }
}

fn read_schema(path: &Path) -> Result<Value, String> {
    let text = read_text(path, MAX_SCHEMA, "a schema")?;
    let schema = serde_json::from_str(&text).map_err(|e| format!("invalid JSON: {e}"))?;
    check_schema(&schema)?;
    Ok(schema)
}

/// Checks the blocks of the declared widgets with their schemas.
pub(super) fn check(lesson: &Lesson, widgets: &[PageWidget], findings: &mut Vec<Finding>) {
    for widget in &lesson.widgets {
        let declared = widgets.iter().find(|declared| declared.name == widget.name);
        if let Some((path, schema)) = declared.and_then(|declared| declared.schema.as_ref()) {
            check_block(lesson, widget, path, schema, findings);
        }
    }
}

fn check_block(lesson: &Lesson, widget: &Widget, path: &str, schema: &Value, findings: &mut Vec<Finding>) {
    for SchemaViolation { span, message, help } in
        violations(lesson, widget, schema).into_iter().flatten().take(MAX_FINDINGS)
    {
        let message = format!("this does not fit the schema of `{}`: {message}", widget.name);
        let finding =
            Finding::new(rules::WIDGET_SCHEMA, span, message).help(format!("{help} (schema: {path})"));
        findings.push(finding.at(&lesson.file));
    }
}

/// Where the JSON of a block does not fit a schema. `None` if it is malformed, which is reported as such.
fn violations(lesson: &Lesson, widget: &Widget, schema: &Value) -> Option<Vec<SchemaViolation>> {
    let block = lesson.scan.blocks.iter().find(|block| block.span == widget.span)?;
    let parsed = json::parse(&block.body.value, &block.body.map);
    let node = parsed.node.filter(|_| !parsed.broken)?;
    let mut violations = Vec::new();
    validate(schema, &node, &mut violations);
    Some(violations)
}

/// The state of the widget of a lesson at a place, and the word for it. `None` if the settings do not declare it.
pub(super) fn state(
    lesson: &Lesson,
    span: &Range<usize>,
    widgets: &[PageWidget],
) -> Option<(State, &'static str)> {
    let widget = lesson.widgets.iter().find(|widget| widget.span == *span)?;
    let declared = widgets.iter().find(|declared| declared.name == widget.name)?;
    let Some((_, schema)) = &declared.schema else { return Some((State::NotClaimed, "not run")) };
    Some(match violations(lesson, widget, schema) {
        Some(violations) if violations.is_empty() => (State::True(Evidence::Computed), "valid"),
        Some(_) => (State::False, "invalid"),
        None => (State::Unchecked, "unreadable"),
    })
}
