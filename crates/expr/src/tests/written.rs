//! Methods that are written in the language itself: a wrong call is reported at the call, described in words.

use crate::mock::Mock;
use crate::natives;
use crate::*;

/// Receivers of calls; the arguments follow.
const RECEIVERS: [&str; 9] = [
    "[1, 2]",
    "[]",
    "data.qpos",
    "data.ctrl",
    "data.efc_force",
    "ctx.list",
    "bodyPos('light')",
    "data.qpos.slice()",
    "[[1], 'a', {b: 2}]",
];
const ARGUMENTS: [&str; 30] = [
    "",
    "1",
    "'a'",
    "true",
    "[1]",
    "{a: 1}",
    "undefined",
    "data",
    "data.qpos",
    "data.time",
    "data.joint",
    "ctx",
    "ctx.f",
    "Math",
    "Math.max",
    "Math.sqrt",
    "Math.hypot, 0",
    "Number",
    "Array",
    "Array.of",
    "parseInt",
    "mj_setConst",
    "fail",
    "energy",
    "x => fail()",
    "x => [x]",
    "x => ({a: x})",
    "x => data.qpos",
    "(a, b) => y => a",
    "x => x, 1, 2, 3",
];

#[test]
fn messages_about_calls_contain_no_empty_text() {
    let written = natives::public_rows().filter(|row| row.calls());
    let mut calls: Vec<String> = Vec::new();
    for row in written {
        for args in ARGUMENTS {
            match row.name.contains('.') {
                true => calls.extend(RECEIVERS.map(|on| format!("{}({on}, {args})", row.name))),
                false => calls.extend(RECEIVERS.map(|on| format!("{on}.{}({args})", row.name))),
            }
        }
    }
    assert!(calls.len() > 3000);
    let mut reported = 0;
    for call in calls {
        for source in
            [call.clone(), format!("1 + {call} * 2"), format!("const f = () => {call}; ctx.a = f()[0]")]
        {
            let mut globals = Globals::new();
            for finding in Compiler::new(&Mock, &mut globals).linting().statements(&source).diagnostics {
                reported += 1;
                let words = [Some(&finding.message), finding.why.as_ref(), finding.help.as_ref()];
                for text in words.into_iter().flatten() {
                    let quoted: Vec<&str> = text.split('`').skip(1).step_by(2).collect();
                    let fine =
                        text.matches('`').count() % 2 == 0 && quoted.iter().all(|s| !s.trim().is_empty());
                    assert!(fine, "{source}: {text}");
                    // The message must not show the source of the methods.
                    assert!(
                        !text.contains("v[") && !text.contains("v.length") && !text.contains(", v)"),
                        "{source}: {text}"
                    );
                }
                assert!(
                    source.get(finding.span.clone()).is_some_and(|s| !s.is_empty()),
                    "{source}: {finding:?}"
                );
            }
        }
    }
    assert!(reported > 3000, "{reported}");
}
