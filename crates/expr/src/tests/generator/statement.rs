//! Statements and declarations.

use super::{COMPOUND, Generator, VariableType};

impl Generator {
    pub(super) fn declare(&mut self, holds: VariableType, changes: bool) -> String {
        self.count += 1;
        let name = format!("v{}", self.count);
        self.names.push((name.clone(), holds, changes));
        name
    }

    pub(super) fn block(&mut self, depth: usize, n: usize) -> String {
        let names = self.names.len();
        let mut out = String::from("{ ");
        for _ in 0..n {
            out += &self.statement(depth);
        }
        self.names.truncate(names);
        out + "}"
    }

    pub(super) fn statement(&mut self, depth: usize) -> String {
        let d = depth.saturating_sub(1);
        match self.next(if depth == 0 { 15 } else { 23 }) {
            10 => {
                let place = self.element();
                let op = self.random.pick(&COMPOUND);
                format!("{place} {op} {}; ", self.anything(2))
            }
            11 => {
                let value = self.typed();
                format!("const {} = {value}; ", self.declare(VariableType::Typed, false))
            }
            12 => {
                let i = self.declare(VariableType::Number, true);
                let list = match self.next(4) {
                    0 => self.name(VariableType::Typed, false),
                    _ => None,
                };
                let arrays = ["data.qpos", "data.eq_active", "model.geom_contype"];
                let list = list.unwrap_or_else(|| self.random.pick(&arrays).into());
                let step = self.random.pick(&["++", "--"]);
                let op = self.random.pick(&COMPOUND);
                let value = match self.next(4) {
                    0 => i.clone(),
                    1 => format!("{i}{step}"),
                    2 => format!("({i} += 2)"),
                    _ => self.anything(1),
                };
                format!("let {i} = {}; {list}[{i}{step}] {op} {value}; ", self.next(5))
            }
            13..=14 => self.destructuring(),
            0..=1 => {
                let value = self.number(2);
                let changes = self.next(2) == 0;
                let name = self.declare(VariableType::Number, changes);
                format!("{} {name} = {value}; ", if changes { "let" } else { "const" })
            }
            2 => {
                let value = self.text(2);
                format!("const {} = {value}; ", self.declare(VariableType::Text, false))
            }
            3 => {
                let value = self.list(2);
                format!("const {} = {value}; ", self.declare(VariableType::List, false))
            }
            4 => {
                let value = self.anything(2);
                format!("let {} = {value}; ", self.declare(VariableType::Anything, true))
            }
            5..=6 => match self.name(VariableType::Number, true) {
                Some(name) => {
                    let op =
                        self.random.pick(&["=", "+=", "-=", "*=", "/=", "%=", "|=", "&&=", "||=", "??="]);
                    format!("{name} {op} {}; ", self.number(2))
                }
                None => format!("data.qpos[{}] = {}; ", self.next(14), self.number(2)),
            },
            7 => match self.name(VariableType::Anything, true) {
                Some(name) => format!("{name} {} {}; ", self.random.pick(&["=", "+="]), self.anything(2)),
                None => format!("ctx.k = {}; ", self.anything(2)),
            },
            8 => format!(
                "data.qvel[{}] {} {}; ",
                self.next(12),
                self.random.pick(&["=", "+=", "*="]),
                self.number(2)
            ),
            9 => match self.name(VariableType::List, false) {
                Some(name) => match self.next(4) {
                    0 => format!("{name}.push({}); ", self.anything(1)),
                    // Never past the end: lists have no holes here.
                    1 => format!("if ({name}.length > 3) {name}[{}] = {}; ", self.next(4), self.anything(1)),
                    2 => format!("{name}.reverse(); "),
                    _ => format!("{name}.pop(); "),
                },
                None => {
                    format!("const {{a: {}}} = {{a: {}}}; ", self.declare(VariableType::Anything, false), "4")
                }
            },
            15..=16 => {
                let (test, then) = (self.truth(2), self.block(d, 2));
                match self.next(2) {
                    0 => format!("if ({test}) {then} "),
                    _ => format!("if ({test}) {then} else {} ", self.block(d, 1)),
                }
            }
            17..=18 => {
                let names = self.names.len();
                let i = self.declare(VariableType::Number, false);
                self.loops += 1;
                let n = 1 + self.next(4);
                let body = self.block(d, 2);
                self.loops -= 1;
                self.names.truncate(names);
                format!("for (let {i} = 0; {i} < {n}; {i}++) {body} ")
            }
            19 => {
                let list = self.numbers(1);
                let names = self.names.len();
                let x = self.declare(VariableType::Number, false);
                self.loops += 1;
                let body = self.block(d, 2);
                self.loops -= 1;
                self.names.truncate(names);
                format!("for (const {x} of {list}) {body} ")
            }
            20 if self.loops > 0 => {
                format!("if ({}) {}; ", self.truth(1), self.random.pick(&["break", "continue"]))
            }
            21 if self.functions == 0 => {
                let n = self.next(3);
                self.functions += 1;
                let (outer, loops) = (self.names.len(), std::mem::take(&mut self.loops));
                let params: Vec<String> = (0..n).map(|_| self.declare(VariableType::Number, true)).collect();
                let body: String = (0..2).map(|_| self.statement(d)).collect();
                let result = self.number(2);
                self.names.truncate(outer);
                self.loops = loops;
                self.functions -= 1;
                let name = self.declare(VariableType::Function(n), false);
                format!("const {name} = ({}) => {{ {body}return {result}; }}; ", params.join(", "))
            }
            22 => {
                let i = self.declare(VariableType::Number, false);
                self.names.pop();
                self.loops += 1;
                let body = self.block(d, 1);
                self.loops -= 1;
                format!("let {i} = 0; while ({i} < 3) {{ {i}++; {body} }} ")
            }
            _ => {
                let value = self.number(1);
                let name = self.declare(VariableType::Record, false);
                format!("const {name} = {{p: {value}, q: [{value}]}}; {name}.p += 1; ")
            }
        }
    }

    /// Destructures a value that may not be a list or a record.
    pub(super) fn destructuring(&mut self) -> String {
        let whole = match self.next(6) {
            0 => self.numbers(1),
            1..=2 => self.list(1),
            3 => self.typed(),
            4 => self.text(1),
            _ => self.name(VariableType::Anything, false).unwrap_or_else(|| "ctx.k".into()),
        };
        let fallback = self.anything(1);
        let names = [(); 3].map(|()| self.declare(VariableType::Anything, true));
        let [a, b, c] = &names;
        match self.next(5) {
            0 => format!("let [{a}, {b} = {fallback}] = {whole}, {c} = 1; "),
            1 => format!("let [, {a}, , {b} = {fallback}] = {whole}, {c}; "),
            2 => format!("let {{length: {a}}} = {whole}, {b} = 2, {c} = {fallback}; "),
            3 => format!("let {{p: [{a}, {b}], q: {c} = {fallback}}} = {{q: undefined, p: {whole}}}; "),
            _ => {
                format!("let {a} = 0, {b} = {fallback}, {c} = [{whole}].map(([x, y]) => [y, x]); ")
            }
        }
    }
}
