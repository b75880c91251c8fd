//! The reference pages under `docs/reference` and the JSON Schemas of lessons under `docs/schema`, generated from the tables.
//!
//! `cargo run -p labspec-cli -- reference docs/reference` writes both, with the schemas of reports; tests fail when they are stale.

use crate::bind::functions;
use crate::rules;
use crate::spec::format;
use labspec_bind::named_field as by_name;
use labspec_core::reflect::{self, Kind, Object, Stage};
use labspec_core::xml::{self, Status};
use labspec_finding::{Layer, Rule, Severity};
use std::fmt::Write;

/// File name and text of each page. The page of a rule is in the folder `rules`.
pub fn pages() -> Vec<(String, String)> {
    let tables = [
        ("format.md", format!("{GENERATED}\n{}", format::page())),
        ("fields.md", fields()),
        ("functions.md", function_list()),
        ("language.md", format!("{GENERATED}\n{}", labspec_expr::language_page(&labspec_bind::HOST_TERMS))),
        ("codes.md", codes()),
        ("compatibility.md", compatibility()),
    ];
    let tables = tables.into_iter().map(|(name, text)| (name.to_string(), text));
    tables.chain(rules::all().map(|rule| (format!("rules/{}.md", rule.code), rule_page(rule)))).collect()
}

/// The page of a rule: what it means, why it matters, a wrong and a right example, and how a course treats it.
fn rule_page(rule: &Rule) -> String {
    let code = rule.code;
    let lesson = match rule.severity {
        Severity::Error => String::new(),
        _ => format!(
            "- If the lesson intends it, suppress it there, with the reason: `\"lint\": {{\"allow\": [\"{code}\"], \"why\": \"…\"}}` in the lab, the quiz or the question, or `<!-- labspec allow {code}: … -->` before a block of text.\n"
        ),
    };
    format!(
        "{GENERATED}\n{}\n## Settings\n\n- `ignore = [\"{code}\"]` in [labspec.toml](../../checking.md#settings), or `--ignore {code}`, skips it.\n- `deny = [\"{code}\"]`, or `--deny {code}`, makes it an error.\n{lesson}",
        rule.explain()
    )
}

/// File name and text of each schema.
pub fn schemas() -> Vec<(&'static str, String)> {
    vec![
        ("lab.json", schema(format::Root::Lab)),
        ("integrators.json", schema(format::Root::Integrators)),
        ("quiz.json", schema(format::Root::Quiz)),
    ]
}

/// A schema as text.
pub fn schema(root: format::Root) -> String {
    format!("{:#}\n", format::schema(root))
}

const GENERATED: &str =
    "<!-- Written from the tables: cargo run -p labspec-cli -- reference docs/reference -->\n";

fn fields() -> String {
    let mut text = format!(
        "{GENERATED}\n# Fields\n\nEvery field that an expression can name. Arrays are flat and row-major: `data.xpos[3 * i + 2]` is the height of body `i`. The part of one object is read by name: `data.body(\"ball\").xpos[2]`.\n"
    );
    let objects = [
        (Object::Data, "data", "State, inputs and results."),
        (Object::Model, "model", "Constants of the model."),
        (Object::Option, "model.opt", "Options of the simulation."),
        (Object::Statistic, "model.stat", "Statistics of the model."),
    ];
    for (object, name, about) in objects {
        let _ = write!(
            text,
            "\n## `{name}`\n\n{about}\n\n| field | shape | by name | unit | kind | meaning |\n|---|---|---|---|---|---|\n"
        );
        for id in reflect::fields().filter(|id| id.info().object == object) {
            let (f, unit, doc) = (id.info(), id.unit(), id.doc());
            let shape = if f.shape.is_empty() { "–".to_string() } else { f.shape.join(" × ") };
            let unit = if unit.is_empty() { "–" } else { unit };
            let named = by_name(id);
            let named = named.map_or("–".to_string(), |path| format!("`{path}`"));
            let kind = kind(f.kind, f.stage);
            let _ = writeln!(text, "| `{}` | {shape} | {named} | {unit} | {kind} | {doc} |", f.name);
        }
    }
    text.push_str(
        "\nKinds: *state* evolves in time and can be set; *input* is set from outside; *constant* takes effect at the next step; *inertial* needs `mj_setConst` after a change; *derived* is computed, so it cannot be set; *structure* is fixed.\n",
    );
    text
}

fn kind(kind: Kind, stage: Stage) -> String {
    match kind {
        Kind::Structure => "structure".into(),
        Kind::State => "state".into(),
        Kind::Input => "input".into(),
        Kind::Constant => "constant".into(),
        Kind::Inertial => "inertial".into(),
        Kind::Derived => format!("derived ({stage:?})"),
    }
}

fn function_list() -> String {
    let mut text = format!(
        "{GENERATED}\n# Functions\n\n[language.md](language.md) describes the language itself, its methods and `Math`. Examples use `specs/models/pendulum.xml`, and measures use a run of 0.1 s; in those of a sweep, `h` is measured with the timesteps 1, 2 and 4 ms.\n"
    );
    let tables = [
        ("In labs and in measures", [false, false]),
        ("Only in the measures of `verify`", [true, false]),
        ("In the claims of `verify` about a run with a `sweep`", [false, true]),
    ];
    for (title, place) in tables {
        let _ = write!(text, "\n## {title}\n\n| function | meaning | example | value |\n|---|---|---|---|\n");
        for f in functions::reference().iter().filter(|f| [f.measure, f.claim] == place) {
            let (code, value) = f.example;
            let _ = writeln!(text, "| `{}` | {} | `{code}` | `{value}` |", f.signature, f.doc);
        }
    }
    text.push_str(
        "\nThe shorthand `mj_setConst`, alone or as `mj_setConst()`, means `mj.mj_setConst(model, data)`.\n",
    );
    text
}

fn codes() -> String {
    let mut text = format!(
        "{GENERATED}\n# Codes\n\nThe meaning of each finding's code, grouped by what the rule needs. The page of a code, which `labspec explain CODE` prints too, has a wrong and a right example, both of which the tests execute.\n"
    );
    for layer in Layer::ALL {
        let title = match layer {
            Layer::Source => "Files",
            Layer::Json => "JSON",
            Layer::Structure => "Labs, quizzes and claims",
            Layer::Model => "Models",
            Layer::Program => "Expressions and statements",
            Layer::Run => "Runs",
            Layer::Claim => "Verdicts",
        };
        let _ =
            write!(text, "\n## {title}\n\n| code | level | meaning | why it matters |\n|---|---|---|---|\n");
        for rule in rules::all().filter(|rule| rule.layer == layer) {
            let cell = |text: &str| text.trim_end_matches('.').replace('|', "\\|");
            let _ = writeln!(
                text,
                "| [`{0}`](rules/{0}.md) | {1} | {2} | {3} |",
                rule.code,
                severities(rule),
                cell(rule.summary),
                cell(rule.why)
            );
        }
    }
    text
}

/// The severities of a rule: `error, sometimes warning`.
fn severities(rule: &Rule) -> String {
    let others: String = rule.exceptions.iter().map(|(other, _)| format!(", sometimes {other}")).collect();
    format!("{}{others}", rule.severity)
}

fn compatibility() -> String {
    let mut text = format!(
        "{GENERATED}\n# Compatibility with MJCF\n\nEvery element and attribute of MuJoCo 3.14.0's format, element by element. *Supported*: it does what MuJoCo does. *Ignored*: accepted, checked, and without effect on physics. *Partly*: some of its values are refused. Everything else is refused by name, with its place in the file; nothing is skipped silently. Defaults take the attributes of the elements that they stand for.\n\n| element | support |\n|---|---|\n"
    );
    let rows = xml::schema_rows();
    for element in rows.iter().filter(|r| r.attribute.is_none() && !r.path.contains("default/")) {
        let done = match element.status {
            Status::Unsupported => "**refused**: not supported yet".to_string(),
            Status::Ignored(what) => format!("ignored: {what}"),
            _ => attributes(rows.iter().filter(|r| r.path == element.path)),
        };
        let _ = writeln!(text, "| `{}` | {done} |", element.path);
    }
    text
}

/// The attributes of one element, grouped by their support.
fn attributes<'a>(rows: impl Iterator<Item = &'a xml::SchemaRow>) -> String {
    let mut groups: [(&str, Vec<String>); 4] = [
        ("supported", Vec::new()),
        ("partly", Vec::new()),
        ("ignored", Vec::new()),
        ("**refused**", Vec::new()),
    ];
    for row in rows {
        let Some(attribute) = row.attribute else { continue };
        let name = format!("`{}`", attribute.name);
        let refused: Vec<&str> = match attribute.kind {
            xml::AttributeType::Keywords(words) => {
                words.iter().filter(|w| !w.supported).map(|w| w.text).collect()
            }
            _ => Vec::new(),
        };
        let (group, entry) = match row.status {
            Status::Supported if refused.is_empty() => (0, name),
            Status::Supported => (1, format!("{name} (not yet {})", refused.join(", "))),
            Status::Only(value) => (1, format!("{name} (only `{value}`)")),
            Status::Ignored(_) => (2, name),
            Status::Unsupported => (3, name),
        };
        groups[group].1.push(entry);
    }
    let filled: Vec<String> = groups
        .iter()
        .filter(|(_, names)| !names.is_empty())
        .map(|(what, names)| format!("{what}: {}", names.join(" ")))
        .collect();
    if filled.is_empty() { "supported".into() } else { filled.join("; ") }
}

#[cfg(test)]
mod tests {
    use crate::bind::functions::{self, FunctionDoc};
    use crate::bind::scene::Models;
    use crate::bind::{ModelNames, Scope, World};
    use crate::check::{self, CheckLevel};
    use crate::lint::ModelFolder;
    use crate::lint::load_lesson;
    use crate::source::SourceFile;
    use labspec_core::{self as core, AccessSet, Data, Model, Plan, Planned, xml};
    use labspec_expr::{Compiler, Context, Globals};

    const PENDULUM: &str = include_str!("../../../specs/models/pendulum.xml");

    /// Data for which everything is computed.
    fn everything(model: &Model) -> Data<Planned> {
        Data::planned(model, Plan::new(model, &AccessSet::ANY))
    }

    /// Runs statements and a last expression; returns its value.
    fn run(model: &Model, code: &str) -> String {
        let (statements, last) = code.rsplit_once("; ").unwrap_or(("", code));
        let names = ModelNames::new(model, Scope::Lab);
        let mut globals = Globals::new();
        let mut compiler = Compiler::new(&names, &mut globals);
        let programs = [compiler.statements(statements), compiler.expression(last)];
        let mut world = World {
            model: model.clone(),
            data: everything(model),
            key: None,
            functions: crate::bind::Functions::new(),
            displayed: Vec::new(),
            numbers: Vec::new(),
            playback: None,
        };
        core::forward(&world.model, &mut world.data).unwrap();
        let mut context = Context::for_globals(&globals);
        let values = programs.map(|p| match p.program {
            Some(program) => program.run(&mut world, &mut context, None).unwrap().to_string(),
            None => format!("{:#?}", p.diagnostics),
        });
        values[1].clone()
    }

    /// The value of a measure over 0.1 s.
    fn measure(code: &str) -> String {
        let lab = serde_json::json!({"xml": PENDULUM, "note": "0", "readouts": [{"label": "time (s)", "expr": "data.time"}], "verify": {
            "runs": {"run": {"until": 0.1}}, "measure": {"m": code}, "says": [["0", "run.m"]],
        }});
        let lesson = load_lesson(SourceFile::new("lab.json", lab.to_string()), &ModelFolder::unknown());
        let models = Models::new(ModelFolder::unknown());
        let checked = check::check_lesson(lesson, &models, CheckLevel::CLAIMS);
        let value = checked.claims.first().and_then(|c| c.judgement.measures.first()).map(|m| m.value);
        crate::verify::significant(value.unwrap_or_else(|| panic!("{code}: {:#?}", checked.findings)))
    }

    /// The value of an expression over runs of 0.1 s with the timesteps 1, 2 and 4 ms, which are measured as `h`.
    fn claimed(code: &str) -> String {
        let lab = serde_json::json!({"xml": PENDULUM, "note": "0", "verify": {
            "runs": {"run": {"sweep": {"option timestep": [0.001, 0.002, 0.004]}, "until": 0.1}},
            "measure": {"h": "initial(model.opt.timestep)"}, "says": [["0", code]],
        }});
        let lesson = load_lesson(SourceFile::new("lab.json", lab.to_string()), &ModelFolder::unknown());
        let models = Models::new(ModelFolder::unknown());
        let checked = check::check_lesson(lesson, &models, CheckLevel::CLAIMS);
        let value = checked.claims.first().and_then(|c| c.judgement.quotes.first()).map(|q| q.computed);
        crate::verify::significant(value.unwrap_or_else(|| panic!("{code}: {:#?}", checked.findings)))
    }

    #[test]
    fn the_examples_of_functions_give_their_results() {
        let model = xml::compile(PENDULUM).unwrap();
        let mut wrong = Vec::new();
        for FunctionDoc { signature, example: (code, value), measure: over, claim, .. } in
            functions::reference()
        {
            let got = match (over, claim) {
                (true, _) => measure(code),
                (_, true) => claimed(code),
                _ => run(&model, code),
            };
            if got != value {
                wrong.push(format!("{code} gives {got}"));
            }
            // The example contains the function that it documents.
            let name = signature.split('(').next().unwrap();
            assert!(code.contains(name), "{signature}: {code}");
        }
        assert!(wrong.is_empty(), "{wrong:#?}");
    }

    #[test]
    fn the_force_of_a_contact_goes_into_a_list() {
        let ball = "<mujoco><worldbody><geom type='plane' size='1 1 .1'/><body pos='0 0 .1'><freejoint/>\
                    <geom size='.1' mass='2'/></body></worldbody></mujoco>";
        let code = "for (let i = 0; i < 1000; i++) { mj.mj_step(model, data) } ctx.f = [7, 7, 7, 7, 7, 7]; \
                    mj.mj_contactForce(model, data, 0, ctx.f); ctx.f.map(x => Math.round(100 * x) / 100 + 0).join()";
        assert_eq!(run(&xml::compile(ball).unwrap(), code), "19.62,0,0,0,0,0");
    }

    #[test]
    fn the_pages_are_up_to_date() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference");
        let pages = super::pages().into_iter().map(|(name, text)| (folder.join(name), text));
        let schemas =
            super::schemas().into_iter().map(|(name, text)| (folder.join("../schema").join(name), text));
        for (path, text) in pages.chain(schemas) {
            let written = std::fs::read_to_string(&path).unwrap_or_default();
            let name = path.display();
            assert!(written == text, "{name} is stale: cargo run -p labspec-cli -- reference docs/reference");
        }
    }
}
