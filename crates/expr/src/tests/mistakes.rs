//! Errors as an author sees them. Each snapshot contains the source, the span, the reason and the help.

use crate::mock::Mock;
use crate::*;

/// Renders all findings of a text: the line, carets under the span, and the fixed text.
fn render(source: &str, found: &[Finding]) -> String {
    let mut out = String::new();
    for d in found {
        let start = source[..d.span.start].rfind('\n').map_or(0, |i| i + 1);
        let end = source[start..].find('\n').map_or(source.len(), |i| start + i);
        let column = source[start..d.span.start].chars().count();
        let width = source[d.span.start..d.span.end.clamp(d.span.start, end.max(d.span.start))]
            .chars()
            .count()
            .max(1);
        out += &format!("{}[{}]: {}\n", d.severity, d.code, d.message);
        out += &format!("  | {}\n  | {}{}\n", &source[start..end], " ".repeat(column), "^".repeat(width));
        for (label, text) in [("why", &d.why), ("help", &d.help)] {
            if let Some(text) = text {
                out += &format!("  {label}: {text}\n");
            }
        }
        if let Some(fix) = &d.fix {
            let fixed = format!("{}{}{}", &source[..fix.span.start], fix.text, &source[fix.span.end..]);
            out += &format!("  fix: {}\n", fixed.replace('\n', "⏎"));
        }
    }
    if found.is_empty() { "nothing found\n".into() } else { out }
}

fn expression(source: &str) -> String {
    let mut globals = Globals::new();
    render(source, &Compiler::new(&Mock, &mut globals).linting().expression(source).diagnostics)
}

fn statements(source: &str) -> String {
    let mut globals = Globals::new();
    render(source, &Compiler::new(&Mock, &mut globals).linting().statements(source).diagnostics)
}

fn target(source: &str) -> String {
    let mut globals = Globals::new();
    render(source, &Compiler::new(&Mock, &mut globals).linting().assignment(source).diagnostics)
}

/// One snapshot per mistake.
macro_rules! mistakes {
    ($($name:ident: $kind:ident($source:expr);)*) => { $(
        #[test]
        fn $name() {
            let source: &str = $source;
            insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false, description => source, omit_expression => true }, {
                insta::assert_snapshot!(stringify!($name), $kind(source));
            });
        }
    )* };
}

mistakes! {
    // Names.
    misspelt_field: expression("data.qpso[2]");
    field_of_the_other_object: expression("data.mass * 2");
    field_of_an_inner_object: statements("model.timestep = 0.02");
    field_with_a_hint: expression("data.position[0]");
    field_without_a_likeness: expression("data.joint('light_free').temperature");
    misspelt_root: expression("dat.time");
    missing_object: expression("1000 * qpos[2]");
    missing_math: expression("sin(data.time)");
    unknown_root: expression("banana + 1");
    unknown_function: statements("launch(3)");
    misspelt_math: expression("Math.squrt(2)");
    random: expression("Math.random()");
    misspelt_joint: expression("data.joint(\"light_fre\").qvel[2]");
    unlike_joint: expression("data.joint('elbow').qvel[0]");
    no_names_at_all: expression("data.sensor('gyro')");
    joint_without_quotes: expression("data.joint(light_free).qvel[0]");
    joint_by_number: expression("data.joint(0).qvel[0]");
    joint_in_brackets: expression("data.joint['light_free'].qvel[0]");
    joint_with_a_point: expression("data.joint.light_free.qvel[0]");
    joint_computed: expression("data.joint('light' + '_free').qvel[0]");
    value_without_a_control: statements("data.qpos[0] = value");
    used_before_its_declaration: statements("data.qpos[0] = a; const a = 1");
    declared_twice: statements("const a = 1; const a = 2");
    declared_over_a_root: statements("const data = 1");
    window: expression("window.innerWidth");
    eval: statements("eval('1')");
    prototype: expression("ctx.constructor");

    // Indexes.
    index_past_the_end: expression("data.qpos[14]");
    index_past_a_joint: expression("data.joint('heavy_free').qvel[6]");
    index_past_rows: expression("data.xpos[9]");
    index_into_nothing: statements("data.ctrl[0] = 1");
    index_negative: expression("data.qpos[-1]");
    index_fraction: expression("data.qpos[3 / 2]");
    index_text: expression("data.qpos['z']");
    index_twice: expression("data.xpos[1][2]");
    index_of_a_number: expression("data.time[0]");
    index_of_an_object: expression("data['qpos'][2]");
    coordinate_by_letter: expression("model.opt.gravity.z");
    computed_variable: statements("ctx['q' + 1] = 2");

    // Values.
    whole_array: expression("2 * data.qpos");
    whole_array_of_unknown_length: expression("data.efc_force > 0");
    whole_object: expression("data");
    result_of_nothing: expression("1 + mj_setConst()");
    string_in_arithmetic: expression("'3' * data.time");
    string_stored: statements("data.qpos[0] = 'high'");
    compared_with_nan: expression("data.time === NaN");
    chained_comparison: expression("0 < data.time < 1");
    caret_as_power: expression("data.time ^ 2");
    power_of_a_sign: expression("-data.time ** 2");
    array_literal: statements("ctx.v = [1, 2]");

    // Calls.
    called_array: expression("data.qpos(2)");
    not_called: statements("mj.mj_resetDataKeyframe");
    math_not_called: expression("Math.sin + 1");
    missing_arguments: statements("mj.mj_setConst(model)");
    arguments_in_the_wrong_order: statements("mj.mj_setConst(data, model)");
    too_many_arguments: statements("fail(1)");
    rounded_to_digits: expression("Math.round(data.time, 2)");
    math_without_argument: expression("Math.sin()");
    text_for_a_number: statements("mj.mj_resetDataKeyframe(model, data, '0')");

    // Assignments.
    derived_field: statements("data.xpos[2] = 1");
    structure: statements("model.nq = 3");
    derived_target: target("data.ncon");
    literal_target: target("3");
    array_target: target("model.opt.gravity");
    target_of_a_sum: target("model.opt.timestep * 1000");
    whole_array_assigned: statements("data.qvel = 0");
    constant_assigned: statements("const a = 1; a = 2");
    undeclared: statements("peak = 3");
    equals_in_a_condition: expression("data.time = 1 ? 2 : 3");
    equals_in_parentheses: statements("ctx.a = (data.ncon = 0) ? 1 : 2");
    increment_inside: statements("ctx.a = ctx.b++ + 1");
    set_beyond_the_end: statements("data.qpos.set([1, 2, 3], 12)");
    fill_derived: statements("data.xpos.fill(0)");
    comparison_as_statement: statements("data.time == 0");
    unused_value: statements("data.qpos[2]; ctx.a = 1");

    // Parsing.
    nothing: expression("  ");
    unclosed_bracket: statements("data.qpos[2 = 3; data.time = 0");
    unclosed_parenthesis: expression("1000 * (data.qpos[2] - 1");
    closed_too_often: expression("(data.time))");
    missing_operator: expression("2 data.time");
    product_without_sign: expression("2x + 1");
    two_operators: expression("data.time + * 2");
    missing_right_side: statements("data.qpos[0] =\n");
    decimal_comma: statements("model.opt.timestep = 0,02");
    unicode_minus: expression("data.time − 1");
    superscript: expression("data.time² / 2");
    smart_quotes: expression("data.joint(“light_free”).qpos[0]");
    unclosed_string: expression("'slides");
    semicolon_in_expression: expression("data.time;");
    two_expressions: expression("data.time; data.ncon");
    choice_without_else: expression("data.time > 1 ? 2");
    field_missing: expression("data.");
    too_deep: expression(&"(".repeat(200));

    // Constructs.
    condition_statement: statements("if (data.time > 1) { data.qpos[0] = 1 } else data.qpos[0] = 2; data.qpso[1] = 3");
    loop_statement: statements("for (let i = 0; i < 3; i++) data.qpos[i] = 0; data.tim = 0");
    arrow: statements("const s = (x) => x * x; ctx.a = s(2) +");
    function: statements("function f(x) { return x } data.qpos[0] = f(2)");
    template: expression("`t = ${data.time}`");
    object_literal: statements("ctx.a = {x: 1}");
    this: expression("this.time");
    new: expression("new Date().getTime()");
    regular_expression: expression("/a+/ + 1");
    var: statements("var a = 1; data.qpos[0] = a");
    declaration_in_expression: expression("const a = 1; a");
    exception: statements("try { fail() } catch (e) { } data.time = 'a' * 1");
    nullish: expression("ctx.a ?? 0");
    array_method: expression("data.qpos.map(x => x)");

    // Constructs that earlier versions refused.
    empty_body: statements("if (data.time > 1); data.qpos[0] = 1");
    else_alone: statements("data.time = 1; else data.time = 2");
    condition_without_parentheses: statements("if data.time > 1 { data.time = 0 }");
    assignment_as_condition: statements("if (data.ncon = 1) { data.time = 0 }");
    loop_past_the_end: statements("for (let i = 0; i < 20; i++) data.qvel[i] = 0");
    loop_up_to_and_with_the_length: statements("let s = 0; for (let i = 0; i <= data.qpos.length; i++) { s += data.qpos[i] }; ctx.s = s");
    loop_over_rows: statements("for (let i = 0; i < 4; i++) ctx.z = data.xpos[3 * i + 2]");
    loop_below_zero: statements("for (let i = 0; i < 3; i++) ctx.z = data.qpos[i - 1]");
    endless_loop: statements("while (true) { ctx.n = 1 }");
    for_in: statements("for (const i in data.qpos) ctx.a = i");
    for_of_without_const: statements("for (x of [1, 2]) ctx.a = x");
    for_of_a_number: statements("for (const i of data.ncon) ctx.a = i");
    for_with_commas: statements("for (let i = 0, i < 3, i++) ctx.a = i");
    break_alone: statements("if (data.time > 1) break");
    label: statements("outer: for (;;) { break outer }");
    switch: statements("switch (data.ncon) { case 0: ctx.a = 1 }");
    unreachable: statements("for (const x of [1, 2]) { break; ctx.a = x }");
    unclosed_block: statements("if (data.time > 1) { data.time = 0");
    block_closed_twice: statements("if (data.time > 1) { data.time = 0 } }");
    return_in_expression: expression("return data.time");
    if_in_expression: expression("if (data.time > 1) 2 else 3");
    function_not_called: expression("1 + (x => x)");
    function_without_name: statements("function (x) { return x }");
    too_few_arguments: statements("const f = (a, b) => a * b; ctx.a = f(2)");
    rest_parameter: statements("const f = (...xs) => xs.length; ctx.a = f(1)");
    getter: statements("ctx.a = {get x() { return 1 }}");
    parameter_twice_meant: statements("const f = (a) => { const b = 2; return a * c }; ctx.a = f(1)");
    mistake_in_a_function: statements("const f = (x) => data.qpso[0] * x; ctx.a = f(1)");
    mistake_in_a_function_never_called: statements("const f = (x) => data.qpos[99] * x");
    list_in_arithmetic: expression("2 * [1, 2]");
    list_as_readout: expression("[1, 2]");
    record_as_readout: expression("energy()");
    record_member_misspelt: expression("energy().kinetik");
    record_key_without_value: statements("ctx.a = {x: , y: 2}");
    destructured_misspelt: statements("const {kinetic, potentail} = energy(); ctx.a = kinetic");
    destructured_nothing: statements("const {a, b}; ctx.a = a");
    element_past_a_known_list: expression("bodyPos('light')[3]");
    element_past_a_literal: expression("[1, 2, 3][3]");
    letter_of_a_list: expression("bodyPos('light').z");
    push_onto_an_array: statements("data.qpos.push(1)");
    concat_of_an_array: expression("data.qpos.concat([1]).length");
    array_kept: statements("ctx.v = data.qpos");
    array_in_a_test: statements("if (data.qpos) data.time = 0");
    maximum_of_a_list: expression("Math.max(data.qpos)");
    spread_into_a_function: statements("mj.mj_setConst(...[model, data])");
    function_that_gets_more: expression("[1, 4].reduce(Math.max)");
    function_of_one_argument: expression("[1, 4].map(Math.sqrt).join() + ['1', '2'].map(Number).join()");
    host_function_without_values: expression("[1, 4].map(mj.mj_setConst)");
    map_without_a_function: expression("data.qpos.map(2)[0]");
    reduce_without_anything: expression("data.qpos.reduce()");
    misspelt_method: expression("[1, 2].psuh(3)");
    method_of_a_number: expression("data.time.toFixd(2)");
    number_without_method: expression("(1).length");
    too_many_for_a_method: expression("'a'.padStart(1, 2, 3)");
    template_without_end: expression("`t = ${data.time`");
    template_with_nothing: expression("`t = ${}`");
    template_with_a_mistake: expression("`t = ${data.tmie} s`");
    nullish_beside_or: expression("ctx.a ?? ctx.b || 1");
    nullish_of_a_number: expression("data.time ?? 1");
    optional_assigned: statements("ctx.a?.b = 1");
    date: expression("new Date()");
    machinery_of_a_value: expression("(1).constructor");
    json: expression("JSON.stringify(ctx)");
    sine_of_degrees: expression("Math.sin(30)");
    sine_of_a_quaternion: expression("Math.sin(data.qpos[3])");
    quaternion_in_degrees: expression("data.qpos[4] * 180 / Math.PI");
    angle_in_degrees: statements("data.qvel[11] = 45");
    computed_name_misspelt_field: statements("for (const n of ['light_free']) ctx.a = data.joint(n).qpso[0]");
    not_a_member_of_mj: statements("mj.mj_launch(model, data)");
    comma_in_a_list: statements("ctx.v = [1, 2 3]");
    computed_from_nothing: statements("ctx.a = undefined.x");
    waiting: statements("await data.time");
    delete: statements("delete ctx.a");
    in_test: expression("'a' in ctx");

    // Several mistakes at once.
    several: statements("data.qpso[0] = 1; data.qpos[20] = unknown + Math.sine(1)\ndata.xpos[0] = ; model.nq = 'a'");
}

#[test]
fn variables_that_nothing_stores() {
    let mut globals = Globals::new();
    globals.define("angle");
    let mut compiler = Compiler::new(&Mock, &mut globals).linting();
    compiler.statements("ctx.peak = Math.max(ctx.peak || 0, data.qpos[2])");
    let source = "ctx.peek + ctx.angle + ctx.start";
    compiler.expression(source);
    let found: Vec<Finding> = globals.unset(Mock.host_terms()).into_iter().map(|(_, d)| d).collect();
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!("variables_that_nothing_stores", render(source, &found));
    });
}
