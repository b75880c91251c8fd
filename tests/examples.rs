//! The examples of the library: they run, print the output that the guide shows, and the guide contains their code.

#![allow(clippy::unwrap_used)]

use crate::support::workspace;

#[path = "../crates/labspec/examples/accessor.rs"]
mod accessor;
#[path = "../crates/labspec/examples/function.rs"]
mod function;
#[path = "../crates/labspec/examples/lab.rs"]
mod lab;
#[path = "../crates/labspec/examples/lesson.rs"]
mod lesson;
#[path = "../crates/labspec/examples/rule.rs"]
mod rule;

fn file(path: &str) -> String {
    std::fs::read_to_string(workspace().join(path)).unwrap()
}

#[test]
fn examples_print_the_output_of_the_guide() {
    accessor::main().unwrap();
    function::main().unwrap();
    lab::main().unwrap();
    lesson::main().unwrap();
    rule::main();
    let all = [
        ("accessor", accessor::accessor().unwrap()),
        ("function", function::function().unwrap()),
        ("lab", lab::lab().unwrap()),
        ("lesson", lesson::lesson()),
        ("rule", rule::rule()),
    ];
    let guide = file("docs/embedding.md");
    for (name, printed) in all {
        insta::with_settings!({prepend_module_to_snapshot => false}, {
            insta::assert_snapshot!(format!("example-{name}"), printed);
        });
        let code = file(&format!("crates/labspec/examples/{name}.rs"));
        assert!(code.lines().count() <= 30, "{name} is long");
        assert!(guide.contains(&format!("```rust\n{code}```")), "docs/embedding.md shows another {name}.rs");
        assert!(
            guide.contains(&format!("```text\n{printed}```")),
            "docs/embedding.md shows another output:\n{printed}"
        );
    }
}
