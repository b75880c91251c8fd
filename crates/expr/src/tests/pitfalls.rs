//! Code that JavaScript accepts and that rarely means what it says: the reported rules, and correct code beside it.

use crate::mock::Mock;
use crate::*;

/// The rules and the fixes that a text of statements violates.
fn found(source: &str) -> Vec<(&'static str, String)> {
    let mut globals = Globals::new();
    let found = Compiler::new(&Mock, &mut globals).linting().statements(source).diagnostics;
    let fixed = |f: &Finding| {
        let fix = f.fix.as_ref()?;
        Some(format!("{}{}{}", source.get(..fix.span.start)?, fix.text, source.get(fix.span.end..)?))
    };
    found.iter().map(|f| (f.code, fixed(f).unwrap_or_default())).collect()
}

/// Each text violates the rule once, and its fix, if there is one, gives a text without findings.
fn each(code: &str, sources: &[&str]) {
    for source in sources {
        let all = found(source);
        assert_eq!(all.iter().map(|(code, _)| *code).collect::<Vec<_>>(), [code], "{source}");
        for (_, fixed) in all.iter().filter(|(_, fixed)| !fixed.is_empty()) {
            assert_eq!(found(fixed), [], "{source} fixed as {fixed}");
        }
    }
}

fn none(sources: &[&str]) {
    for source in sources {
        assert_eq!(found(source), [], "{source}");
    }
}

#[test]
fn not_before_a_comparison() {
    each(
        "negated-operand",
        &[
            "if (!data.qvel[0] > 0.1) ctx.a = 1",
            "ctx.a = !data.qvel[0] <= 2 ? 1 : 2",
            "ctx.a = !data.ncon === 0 ? 1 : 2",
        ],
    );
    none(&[
        "if (!(data.qvel[0] > 0.1)) ctx.a = 1",
        "ctx.b = 1; ctx.a = !ctx.b === !ctx.a",
        "ctx.a = (!data.ncon) > 0",
    ]);
}

#[test]
fn powers_of_quotients() {
    each(
        "power-of-quotient",
        &[
            "ctx.a = data.time ** 1/2",
            "ctx.a = data.time ** 1 / 3",
            "ctx.a = (2 * data.time) ** 3/2",
            "ctx.a = data.time ** -1/2",
        ],
    );
    none(&[
        "ctx.a = data.time ** 2 / 2",
        "ctx.a = data.time**2/2",
        "ctx.a = (data.time ** 1) / 2",
        "ctx.a = data.time ** (1/2)",
    ]);
}

#[test]
fn texts_are_joined_first() {
    each(
        "joined-first",
        &[
            "ctx.a = 'it is ' + data.time > 0 ? 'right' : 'left'",
            "ctx.a = 'it is ' + data.time + ' s' > 0 ? 'right' : 'left'",
            "ctx.a = 'it is ' + data.ncon === 2 ? 'right' : 'left'",
            "ctx.a = 'it is ' + data.ncon ? 'touching' : 'free'",
        ],
    );
    none(&[
        "ctx.a = 'it is ' + (data.time > 0 ? 'right' : 'left')",
        "ctx.b = 'x'; ctx.a = 'a' + data.ncon === 'a1' ? 1 : 2",
    ]);
}

#[test]
fn conditions_that_are_always_the_same() {
    each(
        "constant-condition",
        &[
            "if (data.qpos[0] > 0.1 && data.qpos[0] < -0.1) ctx.a = 1",
            "if (data.qpos[0] > 2 && data.ncon > 0 && 1 > data.qpos[0]) ctx.a = 1",
            "ctx.a = data.qpos[0] > -0.1 || data.qpos[0] < 0.1 ? 1 : 2",
            "ctx.a = data.ncon !== 1 || data.ncon !== 2 ? 1 : 2",
            "ctx.a = data.ncon === 1 && data.ncon === 2 ? 1 : 2",
            "ctx.a = data.ncon === 1 || 2 ? 1 : 2",
            "ctx.b = 1; ctx.a = ctx.b === 'x' || 'y' ? 1 : 2",
            "ctx.a = Math.abs(data.time) < 0 ? 1 : 2",
            "ctx.a = Math.sin(data.time) > 1 ? 1 : 2",
            "ctx.a = data.qpos[0] ** 2 >= 0 ? 1 : 2",
            "ctx.a = bodyPos('light') ? 1 : 2",
            "if (!bodyPos('light')) ctx.a = 1",
            "const xs = [1]; while (xs && data.ncon > 0) break",
        ],
    );
    none(&[
        "if (data.qpos[0] > -0.1 && data.qpos[0] < 0.1) ctx.a = 1",
        "if (data.qpos[0] > 0.1 || data.qpos[0] < -0.1) ctx.a = 1",
        "if (data.qpos[0] >= 1 && data.qpos[0] <= 1) ctx.a = 1",
        "if (data.qpos[0] > 1 && data.qpos[1] < 0) ctx.a = 1",
        "ctx.a = Math.abs(data.time) > 0 ? 1 : 2",
        "ctx.a = bodyPos('light').length > 0 ? 1 : 2",
        "ctx.b = ctx.b || 2; ctx.a = 1",
    ]);
}

#[test]
fn indexes_are_no_conditions() {
    each(
        "index-as-condition",
        &["ctx.a = bodyPos('light').indexOf(2) ? 1 : 2", "if (!bodyPos('light').indexOf(2)) ctx.a = 1"],
    );
    none(&["ctx.a = bodyPos('light').indexOf(2) >= 0 ? 1 : 2"]);
}

#[test]
fn exchanged_limits() {
    each(
        "constant-clamp",
        &[
            "ctx.a = Math.min(Math.max(data.time, 2), -2)",
            "ctx.a = Math.max(-1, Math.min(-3, data.time))",
            "const clamp = (x, a, b) => Math.min(Math.max(x, a), b); ctx.a = clamp(data.time, 5, 1)",
        ],
    );
    none(&["ctx.a = Math.min(Math.max(data.time, -2), 2)", "ctx.a = Math.max(0, Math.min(1, data.time))"]);
}

#[test]
fn loops_that_count_away() {
    each(
        "constant-condition",
        &[
            "for (let i = 0; i > model.nq; i++) ctx.a = i",
            "for (let i = 5; i <= 0; i--) ctx.a = i",
            "for (let i = 3; i < 1; i += 1) ctx.a = i",
        ],
    );
    none(&[
        "for (let i = 0; i < model.nq; i++) ctx.a = i",
        "for (let i = 5; i >= 0; i--) ctx.a = i",
        "for (let i = 0; i < 0; i++) ctx.a = i",
    ]);
}

#[test]
fn declarations_that_are_lost() {
    each(
        "lost-declaration",
        &[
            "let f = 0; if (data.time > 1) { let f = 5 } data.qvel[0] = f",
            "let f = 0; for (let i = 0; i < 3; i++) { let f = 0; f = i } data.qvel[0] = f",
        ],
    );
    none(&[
        "let f = 0; if (data.time > 1) { f = 5 } data.qvel[0] = f",
        "let f = 0; if (data.time > 1) { let f = 5; ctx.a = f } data.qvel[0] = f",
        "if (data.time > 1) { let f = 5; data.qvel[0] = f } else { let f = 6; data.qvel[0] = f }",
    ]);
}

#[test]
fn equal_terms_of_sums() {
    each(
        "same-term",
        &[
            "ctx.a = Math.sqrt(data.qvel[0] ** 2 + data.qvel[1] ** 2 + data.qvel[1] ** 2)",
            "ctx.a = data.qvel[0] * data.qvel[0] + data.qvel[0] * data.qvel[0]",
        ],
    );
    none(&["ctx.a = data.qvel[0] ** 2 + data.qvel[1] ** 2", "ctx.a = data.time + data.time"]);
}

#[test]
fn the_time_equals_no_number() {
    each(
        "exact-comparison",
        &[
            "if (data.time == 1) data.qvel[0] = 1",
            "if (data.time > 0 && data.time % 1 === 0) data.qvel[0] = 1",
            "const t = data.time; if (t === 2) data.qvel[0] = 1",
            "if (data.time - 1 == 0.5) data.qvel[0] = 1",
            "ctx.a = data.joint('light_free').qpos[2] === 0.5 ? 1 : 2",
            "if (2 !== data.time) data.qvel[0] = 1",
        ],
    );
    none(&[
        "if (data.time === 0) data.qvel[0] = 1",
        "if (Math.floor(data.time) === 1) data.qvel[0] = 1",
        "if (data.ncon === 1) data.qvel[0] = 1",
        "if (data.ncon % 2 === 0) data.qvel[0] = 1",
    ]);
}

#[test]
fn angles_are_in_radians() {
    each(
        "degrees-for-radians",
        &[
            "ctx.a = data.qvel[11] > 30 ? 1 : 2",
            "ctx.a = Math.abs(data.qvel[11]) > 45 ? 1 : 2",
            "ctx.a = 5 * (45 - data.qvel[11])",
            "const q = data.qvel[11]; ctx.a = 90 < q ? 1 : 2",
            "ctx.a = Math.atan2(data.qpos[1], data.qpos[0]) >= 90 ? 1 : 2",
        ],
    );
    each("degree-factor", &["ctx.a = data.qvel[11] * 180", "ctx.a = 360 * data.qvel[11] / Math.PI"]);
    each("converted-twice", &["ctx.a = data.qvel[11] * Math.PI / 180"]);
    none(&[
        "ctx.a = data.qvel[11] * 180 / Math.PI > 30 ? 1 : 2",
        "ctx.a = data.qvel[11] > 3 ? 1 : 2",
        "ctx.a = data.qpos[0] > 30 ? 1 : 2",
        "ctx.a = 10 * data.qvel[11]",
        "ctx.a = Math.sin(Math.PI / 180 * data.qpos[0])",
    ]);
}

#[test]
fn habits_of_python() {
    let fixed = |source: &str| {
        let mut globals = Globals::new();
        let mut text = source.to_owned();
        let all = Compiler::new(&Mock, &mut globals).linting().statements(source).diagnostics;
        for fix in all.iter().rev().filter_map(|f| f.fix.as_ref()) {
            text.replace_range(fix.span.clone(), &fix.text);
        }
        (all.len(), text)
    };
    for (source, meant) in [
        ("ctx.a = not data.ncon", "ctx.a = !data.ncon"),
        ("ctx.a = not data.time > 1", "ctx.a = !(data.time > 1)"),
        ("if (not (data.time > 1)) ctx.a = 1", "if (!(data.time > 1)) ctx.a = 1"),
        ("ctx.a = data.time > 1 and data.ncon > 0 ? 1 : 2", "ctx.a = data.time > 1 && data.ncon > 0 ? 1 : 2"),
        ("ctx.a = data.time > 1 or data.ncon", "ctx.a = data.time > 1 || data.ncon"),
        ("ctx.a = True", "ctx.a = true"),
        ("ctx.a = None", "ctx.a = null"),
        ("ctx.a = d.time", "ctx.a = data.time"),
        ("ctx.a = m.nq", "ctx.a = model.nq"),
        ("ctx.a = abs(data.time)", "ctx.a = Math.abs(data.time)"),
    ] {
        assert_eq!(fixed(source), (1, meant.to_owned()));
    }
    let help = |source: &str| {
        let mut globals = Globals::new();
        let all = Compiler::new(&Mock, &mut globals).linting().statements(source).diagnostics;
        all.first().and_then(|f| f.help.clone()).unwrap_or_default()
    };
    assert_eq!(help("ctx.a = 1 if data.ncon else 2"), "write `test ? a : b`");
    assert_eq!(help("ctx.a = data.ncon is None"), "write `===`");
    assert_eq!(help("ctx.a = len(data.qpos)"), "write `list.length`");
    assert_eq!(help("# a comment"), "write `//`");
    // Names of variables.
    none(&["const not = (x) => !x; ctx.a = not(data.ncon)", "const and = 2; ctx.a = and"]);
}

#[test]
fn comments_do_not_divide() {
    each(
        "comment-as-division",
        &[
            "ctx.a = data.time // 1",
            "ctx.a = (data.time + 1) // 2;\nctx.b = 1",
            "ctx.a = data.time // model.nq",
        ],
    );
    none(&["ctx.a = data.time // in s", "ctx.a = 'http://2'", "// 2\nctx.a = 1", "ctx.a = 1; // 2"]);
}

#[test]
fn an_assignment_in_an_expression_moves() {
    let report = |source: &str| {
        let mut globals = Globals::new();
        let all = Compiler::new(&Mock, &mut globals).linting().expression(source).diagnostics;
        all.first().map(|f| (f.code, f.help.clone().unwrap_or_default(), f.fix.is_some()))
    };
    let moved = |source: &str| {
        let (code, help, fixed) = report(source).unwrap_or_default();
        assert_eq!((code, fixed), ("expression-only", false), "{source}");
        assert_eq!(help, "move the assignment to `tick`, and write `ctx.peak` here", "{source}");
    };
    moved("ctx.peak = Math.max(ctx.peak || 0, data.time)");
    moved("ctx.peak = data.time + 1");
    assert_eq!(report("data.time = 1 ? 2 : 3").map(|(code, ..)| code), Some("assign-inside"));
    assert_eq!(report("ctx.mode = 1 ? 2 : 3").map(|(code, ..)| code), Some("assign-inside"));
}
