use super::Check;
use crate::json::{encode, nearest, read::named};
use crate::spec::Lab;
use labspec_core::{Model, Obj};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// `trail` names a site that the model does not have.
pub const TRAIL_MISSING: &Rule = &Rule {
    code: "trail-missing",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "`trail` names a site that the model does not have",
    why: "the page silently draws no path",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/><site name='tip' pos='0 0 -1'/></body></worldbody></mujoco>", "trail": "⟦tipp⟧"}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/><site name='tip' pos='0 0 -1'/></body></worldbody></mujoco>", "trail": "tip"}"#,
    ),
};

pub(super) const CHECK: Check = Check::Model(check_lab);

/// The maximum number of listed sites.
const MOST_LISTED: usize = 12;

fn check_lab(lab: &Lab, model: &Model, findings: &mut Vec<Finding>) {
    // An empty name requests no path.
    let Some(trail) = lab.trail.as_ref().filter(|t| !t.as_str().is_empty()) else { return };
    let name = trail.as_str();
    let sites = || model.names.of_kind(Obj::Site).iter().map(String::as_str).filter(|site| !site.is_empty());
    if sites().any(|site| site == name) {
        return;
    }
    let others = [(Obj::Body, "body"), (Obj::Geom, "geom"), (Obj::Joint, "joint")];
    let other = others
        .into_iter()
        .find(|(kind, _)| model.names.of_kind(*kind).iter().any(|existing| existing == name));
    let message = match other {
        Some((_, kind)) => format!("{} is a {kind} of the model, but a trail follows a site", named(name)),
        None => format!("the model has no site {}", named(name)),
    };
    let found = Finding::new(TRAIL_MISSING, trail.span(), message);
    let listed: Vec<&str> = sites().take(MOST_LISTED).collect();
    let more = if sites().count() > listed.len() { ", …" } else { "" };
    findings.push(match nearest(name, sites()) {
        Some(right) => found.help(format!("did you mean `{right}`?")).guess(trail.span(), encode(right)),
        None if listed.is_empty() => found.help(
            "name a site in the model, which has none: add <site name=\"…\"/> where the path should be drawn",
        ),
        None => found.help(format!("use one of its sites: {}{more}", listed.join(", "))),
    });
}

#[cfg(test)]
mod tests {
    use crate::bind::scene::Models;
    use crate::check::{self, CheckLevel};
    use crate::finding::Finding;
    use crate::lint::{ModelFolder, load_lesson};
    use crate::source::SourceFile;

    /// The findings for a lab with this trail, whose model has these sites in its body `rod`.
    fn found(trail: &str, sites: &str) -> Vec<Finding> {
        let model = format!(
            "<mujoco><worldbody><body name='rod'><geom name='bar' size='1'/>{sites}</body></worldbody></mujoco>"
        );
        let lab = serde_json::json!({"xml": model, "trail": trail});
        let folder = ModelFolder::unknown();
        let lesson = load_lesson(SourceFile::new("t.md", format!("```lab simlab\n{lab}\n```\n")), &folder);
        check::check_lesson(lesson, &Models::new(folder), CheckLevel::STATIC).findings
    }

    #[test]
    fn an_unknown_site_is_reported_with_the_existing_ones() {
        let reported = |trail, sites| {
            let [one] = found(trail, sites).try_into().unwrap();
            let Finding { code, message, help, .. } = one;
            assert_eq!(code, "trail-missing");
            (message, help.unwrap())
        };
        let tip = "<site name='tip'/><site/><site name='end'/>";
        let (message, help) = reported("tpi", tip);
        assert_eq!((message.as_str(), help.as_str()), ("the model has no site `tpi`", "did you mean `tip`?"));
        let (message, help) = reported("rod", tip);
        assert_eq!(message, "`rod` is a body of the model, but a trail follows a site");
        assert_eq!(help, "use one of its sites: tip, end");
        let (message, help) = reported("bar", "<site/>");
        assert!(message.contains("a geom") && help.contains("name a site in the model"), "{message}: {help}");
    }

    #[test]
    fn a_site_and_no_name_are_in_order() {
        for (trail, sites) in [("tip", "<site name='tip'/>"), ("rod", "<site name='rod'/>"), ("", "")] {
            assert_eq!(found(trail, sites), [], "{trail}");
        }
    }
}
