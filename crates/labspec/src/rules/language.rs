//! The rules of the language, shown with the names of labs. What a rule says is the language's; its examples are ours, because
//! most of them need fields, objects and functions.

use labspec_expr::rules;
use labspec_finding::{Example, Rule};

macro_rules! pages {
    ($($rule:ident: $bad:expr => $good:expr,)*) => {
        /// Every rule of the language, with its examples.
        pub(super) static PAGES: &[Rule] = &[$(Rule { bad: $bad, good: $good, ..*rules::$rule }),*];
    };
}

pages! {
    TOO_LONG: Example::Long("data.time", " + data.time", 6000, "") => Example::Expression("data.time"),
    TOO_DEEP: Example::Long("", "(", 300, "data.time") => Example::Expression("(data.time)"),
    TOO_MANY_ERRORS: Example::Long("", "§ + ", 100, "1") => Example::Expression("data.time"),
    BAD_CHARACTER: Example::Expression("data.qpos[7] × 2") => Example::Expression("data.qpos[7] * 2"),
    BAD_NUMBER: Example::Expression("2data.qpos[7]") => Example::Expression("2 * data.qpos[7]"),
    BAD_STRING: Example::Expression("data.body('ball).xpos[2]") => Example::Expression("data.body('ball').xpos[2]"),
    UNCLOSED_COMMENT: Example::Expression("data.time /* in s") => Example::Expression("data.time /* in s */"),
    MISSING_VALUE: Example::Expression("data.qpos[7] * ") => Example::Expression("data.qpos[7] * 2"),
    MISSING_OPERATOR: Example::Expression("2 data.qpos[7]") => Example::Expression("2 * data.qpos[7]"),
    MISSING_NAME: Example::Expression("data.") => Example::Expression("data.time"),
    MISSING_BRACKET: Example::Statements("if data.time > 1 { ctx.a = 1 }") => Example::Statements("if (data.time > 1) { ctx.a = 1 }"),
    MISSING_STATEMENT: Example::Statements("if (data.time > 1)") => Example::Statements("if (data.time > 1) { ctx.a = 1 }"),
    DECIMAL_COMMA: Example::Expression("data.qpos[7] * 0,5") => Example::Expression("data.qpos[7] * 0.5"),
    MISPLACED: Example::Statements("else { ctx.a = 1 }") => Example::Statements("if (data.time > 1) { ctx.a = 0 } else { ctx.a = 1 }"),
    UNOPENED: Example::Expression("data.time)") => Example::Expression("(data.time)"),
    HALF_CHOICE: Example::Expression("data.time > 1 ? 2") => Example::Expression("data.time > 1 ? 2 : 3"),
    DO_WITHOUT_WHILE: Example::Statements("do { ctx.a = 1 }") => Example::Statements("do { ctx.a = 1 } while (data.time < 0)"),
    LOOP_HEAD: Example::Statements("for (let i = 0, i < 3, i++) { ctx.a = i }") => Example::Statements("for (let i = 0; i < 3; i++) { ctx.a = i }"),
    LOOP_WITHOUT_CONST: Example::Statements("for (x of [1, 2]) { ctx.a = x }") => Example::Statements("for (const x of [1, 2]) { ctx.a = x }"),
    LONE_DECLARATION: Example::Statements("if (data.time > 1) let a = 1") => Example::Statements("if (data.time > 1) { let a = 1; ctx.a = a }"),
    DECLARED_WITHOUT_VALUE: Example::Statements("const a; ctx.a = a") => Example::Statements("const a = 1; ctx.a = a"),
    OUTSIDE_LOOP: Example::Statements("if (data.time > 1) { break }") => Example::Statements("if (data.time > 1) { return }"),
    UNCLOSED: Example::Expression("Math.sin(data.qpos[7]") => Example::Expression("Math.sin(data.qpos[7])"),
    EMPTY: Example::Expression(" ") => Example::Expression("data.time"),
    NOT_IN_LANGUAGE: Example::Statements("eval('data.time')") => Example::Statements("ctx.t = data.time"),
    AMBIGUOUS_POWER: Example::Expression("-data.qpos[7] ** 2") => Example::Expression("-(data.qpos[7] ** 2)"),
    AMBIGUOUS_DEFAULT: Example::Expression("data.time ?? 0 || 1") => Example::Expression("data.time || 1"),
    UNKNOWN_NAME: Example::Expression("dta.qpos[7]") => Example::Expression("data.qpos[7]"),
    UNKNOWN_FIELD: Example::Expression("data.qpso[7]") => Example::Expression("data.qpos[7]"),
    UNKNOWN_FUNCTION: Example::Expression("Math.sine(data.time)") => Example::Expression("Math.sin(data.time)"),
    UNKNOWN_OBJECT: Example::Expression("data.body('bal').xpos[2]") => Example::Expression("data.body('ball').xpos[2]"),
    COMPUTED_NAME: Example::Expression("data.body(ball).xpos[2]") => Example::Expression("data.body('ball').xpos[2]"),
    NAME_TAKEN: Example::Statements("let x = 1; let x = 2; ctx.x = x") => Example::Statements("let x = 1; x = 2; ctx.x = x"),
    USED_TOO_EARLY: Example::Statements("ctx.x = x; const x = 1") => Example::Statements("const x = 1; ctx.x = x"),
    NO_VALUE_HERE: Example::Expression("value * 2") => Example::Expression("data.time * 2"),
    UNSET_GLOBAL: Example::Expression("ctx.gain * data.time") => Example::Expression("data.time"),
    INDEX_RANGE: Example::Expression("data.qpos[8]") => Example::Expression("data.qpos[7]"),
    INDEX_NEGATIVE: Example::Expression("data.qpos[-1]") => Example::Expression("data.qpos[7]"),
    INDEX_FRACTION: Example::Expression("data.qpos[1.5]") => Example::Expression("data.qpos[1]"),
    INDEX_KIND: Example::Expression("data.qpos[true]") => Example::Expression("data.qpos[1]"),
    NOT_INDEXABLE: Example::Expression("data.time[0]") => Example::Expression("data.time"),
    WHOLE_ARRAY: Example::Expression("data.qpos * 2") => Example::Expression("data.qpos[7] * 2"),
    NOT_A_VALUE: Example::Expression("data + 1") => Example::Expression("data.time + 1"),
    NO_RESULT: Example::Statements("ctx.x = mj.mj_step(model, data) + 1") => Example::Statements("mj.mj_forward(model, data); ctx.x = data.time + 1"),
    STRING_AS_NUMBER: Example::Expression("data.time - '1'") => Example::Expression("data.time - 1"),
    XOR_AS_POWER: Example::Expression("data.qpos[7] ^ 2") => Example::Expression("data.qpos[7] ** 2"),
    CHAINED_COMPARISON: Example::Expression("0 < data.time < 1") => Example::Expression("0 < data.time && data.time < 1"),
    COMPARE_NAN: Example::Expression("data.time === NaN") => Example::Expression("Number.isNaN(data.time)"),
    DEGREES: Example::Expression("Math.sin(90)") => Example::Expression("Math.sin(Math.PI / 2)"),
    NOT_RANDOM: Example::Expression("Math.random()") => Example::Expression("Math.sin(1e3 * data.time)"),
    NOT_CALLABLE: Example::Expression("data.time()") => Example::Expression("data.time"),
    NOT_CALLED: Example::Statements("mj.mj_forward") => Example::Statements("mj.mj_forward(model, data)"),
    ARGUMENT_COUNT: Example::Expression("Math.sin()") => Example::Expression("Math.sin(data.time)"),
    ARGUMENT_TYPE: Example::Statements("mj.mj_forward(data, model)") => Example::Statements("mj.mj_forward(model, data)"),
    NOT_ASSIGNABLE: Example::Statements("data.time + 1 = 2") => Example::Statements("data.time = 2"),
    ASSIGN_DERIVED: Example::Statements("data.xpos[5] = 1") => Example::Statements("data.qpos[2] = 1"),
    ASSIGN_STRUCTURE: Example::Statements("model.nq = 9") => Example::Statements("model.body_mass[1] = 9; mj.mj_setConst(model, data)"),
    ASSIGN_CONST: Example::Statements("const a = 1; a = 2; ctx.a = a") => Example::Statements("let a = 1; a = 2; ctx.a = a"),
    ASSIGN_ARRAY: Example::Statements("data.qpos = 1") => Example::Statements("data.qpos[7] = 1"),
    ASSIGN_INSIDE: Example::Statements("if (data.time = 1) { ctx.a = 1 }") => Example::Statements("if (data.time === 1) { ctx.a = 1 }"),
    EXPRESSION_ONLY: Example::Expression("let a = 1; a") => Example::Expression("1"),
    EMPTY_BODY: Example::Statements("if (data.time > 1); ctx.a = 1") => Example::Statements("if (data.time > 1) ctx.a = 1"),
    UNREACHABLE: Example::Statements("return; ctx.a = 1") => Example::Statements("ctx.a = 1; return"),
    UNUSED_RESULT: Example::Statements("data.qpos[7] + 1") => Example::Statements("data.qpos[7] += 1"),
    BUDGET: Example::Statements("while (true) { ctx.a = 1 }") => Example::Statements("for (let i = 0; i < 3; i++) { ctx.a = i }"),
    CALL_DEPTH: Example::Statements("const f = n => f(n + 1) + 1; ctx.a = f(0)") => Example::Statements("const f = n => n + 1; ctx.a = f(0)"),
    MEMORY: Example::Statements("ctx.all = []; for (let i = 0; i < 1e7; i++) ctx.all.push([i, i, i])") => Example::Statements("ctx.all = [data.time]"),
    NO_PARTS: Example::Statements("ctx.a = ctx.nothing.x") => Example::Statements("ctx.nothing = {x: 1}; ctx.a = ctx.nothing.x"),
    TEXT_TOO_LONG: Example::Statements("ctx.a = 'x'.repeat(1e9)") => Example::Statements("ctx.a = 'x'.repeat(3)"),
    HOST_CALL: Example::Statements("mj.mj_resetDataKeyframe(model, data, 5)") => Example::Statements("mj.mj_resetData(model, data)"),
    HOST_STORE: Example::Statements("model.opt.timestep = 0") => Example::Statements("model.opt.timestep = 0.001"),
    STORE_PAST_END: Example::Statements("let i = 7; i += Math.round(data.time) + 1; data.qpos[i] = 1") => Example::Statements("let i = 7; data.qpos[i] = 1"),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rule_of_the_language_is_shown() {
        let shown: Vec<&str> = PAGES.iter().map(|page| page.code).collect();
        let all: Vec<&str> = rules::ALL.iter().map(|rule| rule.code).collect();
        assert_eq!(shown, all);
        assert!(PAGES.iter().all(|page| page.bad != Example::OfHost && page.good != Example::OfHost));
    }
}
