//! Expressions of every type.

use super::{COMPOUND, Generator, VariableType};

impl Generator {
    pub(super) fn number(&mut self, depth: usize) -> String {
        if depth == 0 {
            return match self.next(7) {
                6 => self.element(),
                0 => self.next(10).to_string(),
                1 => self
                    .random
                    .pick(&["0.1", "2.5", "1e21", "1e-7", "0x1f", "3.7e5", "NaN", "Infinity", "0"])
                    .into(),
                2 => format!("data.qpos[{}]", self.next(14)),
                3 => self.random.pick(&["data.time", "data.ncon", "data.qpos.length"]).into(),
                _ => self.name(VariableType::Number, false).unwrap_or_else(|| "7".into()),
            };
        }
        let d = depth - 1;
        match self.next(27) {
            24 => {
                let op = self.random.pick(&COMPOUND);
                let place = self.element();
                format!("({place} {op} {})", self.number(d))
            }
            25 => {
                let (place, op) = (self.element(), self.random.pick(&["++", "--"]));
                if self.next(2) == 0 { format!("({place}{op})") } else { format!("({op}{place})") }
            }
            26 => self.tie(),
            0..=5 => {
                let op = self.random.pick(&["+", "-", "*", "/", "%", "&", "|", "^", "<<", ">>", ">>>"]);
                let (a, b) = (self.number(d), self.number(d));
                format!("({a} {op} {b})")
            }
            6 => format!("(-{})", self.number(d)),
            7 => format!("(~{})", self.number(d)),
            8 => {
                let f = self.random.pick(&[
                    "abs", "ceil", "floor", "round", "trunc", "sign", "sqrt", "fround", "clz32", "atan",
                    "asin", "acos", "exp", "expm1", "tan", "log2",
                ]);
                format!("Math.{f}({})", self.number(d))
            }
            9 => {
                let f = self.random.pick(&["min", "max", "hypot", "atan2", "imul"]);
                format!("Math.{f}({}, {})", self.number(d), self.number(d))
            }
            10 => format!("({} ? {} : {})", self.truth(d), self.number(d), self.number(d)),
            11 => {
                let op = self.random.pick(&["||", "&&"]);
                format!("({} {op} {})", self.number(d), self.number(d))
            }
            12 => format!("(+{})", self.text(d)),
            13 => format!("{}.length", self.text_atom(d)),
            14 => format!("{}.length", self.list(d)),
            15 => format!("{}.reduce((a, x) => a + x, {})", self.numbers(d), self.number(d)),
            16 => match self.names.iter().rev().find(|n| matches!(n.1, VariableType::Function(_))).cloned() {
                Some((name, VariableType::Function(n), _)) => {
                    let args: Vec<String> = (0..n).map(|_| self.number(d)).collect();
                    format!("{name}({})", args.join(", "))
                }
                _ => self.number(d),
            },
            17 => format!("({} ** 2)", self.number(d)),
            18 => format!("Number({})", self.anything(d)),
            19 => format!(
                "(((a, b) => {{ const c = a + b; return c * a; }})({}, {}))",
                self.number(d),
                self.number(d)
            ),
            20 => format!("Math.max(...{})", self.numbers(d)),
            21 => format!("parseFloat({})", self.text(d)),
            22 => match self.name(VariableType::Number, true) {
                Some(name) => format!("{name}{}", self.random.pick(&["++", "--"])),
                None => self.number(d),
            },
            _ => format!("({}[{}] ?? {})", self.numbers(d), self.next(5), self.number(d)),
        }
    }

    pub(super) fn text_atom(&mut self, depth: usize) -> String {
        if depth > 0 && self.next(2) == 0 {
            return format!("({})", self.text(depth - 1));
        }
        match self.name(VariableType::Text, false) {
            Some(name) if self.next(2) == 0 => name,
            _ => format!(
                "'{}'",
                self.random.pick(&["", "a", "ab c", "12", " 3.5 ", "x,y", "é", "0x10", "-1e3", "true"])
            ),
        }
    }

    pub(super) fn text(&mut self, depth: usize) -> String {
        if depth == 0 {
            return self.text_atom(0);
        }
        let d = depth - 1;
        match self.next(18) {
            13 => {
                let x = if self.next(2) == 0 { self.tie() } else { self.number(d) };
                format!("({}{x}).toString({})", self.random.pick(&["", "-"]), 2 + self.next(35))
            }
            14 => {
                let x = if self.next(2) == 0 { self.tie() } else { self.number(d) };
                let method = self.random.pick(&["toFixed", "toPrecision", "toExponential"]);
                format!("({x}).{method}({})", self.next(102))
            }
            15..=16 => self.at_tie(),
            0..=1 => format!("({} + {})", self.text(d), self.anything(d)),
            2 => format!("`<${{{}}}>${{{}}}`", self.anything(d), self.anything(d)),
            3 => format!("({}).toFixed({})", self.number(d), self.next(4)),
            4 => format!("String({})", self.anything(d)),
            5 => format!("{}.slice({}, {})", self.text_atom(d), self.next(4), self.next(6)),
            6 => format!(
                "{}.{}()",
                self.text_atom(d),
                self.random.pick(&["toUpperCase", "toLowerCase", "trim"])
            ),
            7 => format!("{}.padStart({}, '*')", self.text_atom(d), self.next(8)),
            8 => format!("{}.join({})", self.list(d), self.text_atom(0)),
            9 => format!("({} ? {} : {})", self.truth(d), self.text(d), self.text(d)),
            10 => format!("typeof {}", self.anything(d)),
            11 => format!("({}).toPrecision({})", self.number(d), 1 + self.next(6)),
            12 => format!("{}.repeat({})", self.text_atom(d), self.next(3)),
            _ => format!("({}).toString()", self.number(d)),
        }
    }

    pub(super) fn truth(&mut self, depth: usize) -> String {
        if depth == 0 {
            return self.random.pick(&["true", "false", "(data.time === 0)"]).into();
        }
        let d = depth - 1;
        let compare = ["<", "<=", ">", ">=", "===", "!==", "==", "!="];
        match self.next(8) {
            0..=2 => format!("({} {} {})", self.number(d), self.random.pick(&compare), self.number(d)),
            3 => format!("({} {} {})", self.text(d), self.random.pick(&compare), self.text(d)),
            4 => format!("(!{})", self.anything(d)),
            5 => format!("({} {} {})", self.truth(d), self.random.pick(&["&&", "||"]), self.truth(d)),
            6 => format!(
                "{}.{}(x => x > {})",
                self.numbers(d),
                self.random.pick(&["some", "every"]),
                self.number(d)
            ),
            _ => format!("{}.includes({})", self.list(d), self.anything(d)),
        }
    }

    pub(super) fn anything(&mut self, depth: usize) -> String {
        match self.next(7) {
            0..=2 => self.number(depth),
            3 => self.text(depth),
            4 => self.truth(depth),
            5 => self.name(VariableType::Anything, false).unwrap_or_else(|| "null".into()),
            _ => self.random.pick(&["null", "undefined", "1", "'s'"]).into(),
        }
    }

    /// A list of numbers.
    pub(super) fn numbers(&mut self, depth: usize) -> String {
        if depth == 0 {
            return match self.name(VariableType::Numbers, false) {
                Some(name) => name,
                None => self.random.pick(&["[3, 1, 2]", "data.qvel", "[0.5]", "data.efc_force"]).into(),
            };
        }
        let d = depth - 1;
        match self.next(7) {
            0 => format!("[{}, {}, {}]", self.number(d), self.number(d), self.number(d)),
            1 => format!(
                "{}.map((x, i) => x {} {})",
                self.numbers(d),
                self.random.pick(&["+", "*", "-"]),
                self.random.pick(&["i", "2", "x"])
            ),
            2 => format!("{}.slice({})", self.numbers(d), self.next(3)),
            3 => format!("{}.filter(x => x > {})", self.numbers(d), self.number(0)),
            // A comparison in which NaN equals every number is not a valid order: the standard leaves the
            // result of such a sort open.
            4 => format!(
                "[...{}].sort((a, b) => a !== a ? (b !== b ? 0 : 1) : b !== b ? -1 : a - b)",
                self.numbers(d)
            ),
            5 => format!("[...{}].{}()", self.numbers(d), self.random.pick(&["reverse", "toReversed"])),
            _ => format!("Array.from({{length: {}}}, (_, i) => i * {})", self.next(5), self.number(d)),
        }
    }

    pub(super) fn list(&mut self, depth: usize) -> String {
        if depth == 0 {
            return self.name(VariableType::List, false).unwrap_or_else(|| "[1, 'b', null]".into());
        }
        let d = depth - 1;
        match self.next(9) {
            6 => {
                let f = ["x", "[x]", "[x, [x]]", "typeof x", "[]", "null", "({a: x})", "'ab'"];
                format!("{}.flatMap((x, i) => {})", self.list(d), self.random.pick(&f))
            }
            7 => {
                let (a, b) = (self.anything(d), self.anything(d));
                // A comparison that gives different results for the same values is not a valid order, see `numbers`.
                let order = self.random.pick(&[
                    "",
                    "",
                    "(a, b) => String(a) < String(b) ? 1 : String(a) > String(b) ? -1 : 0",
                    "() => 0",
                ]);
                let sort = self.random.pick(&["sort", "toSorted"]);
                format!("[undefined, {a}, null, undefined, {b}, ...{}].{sort}({order})", self.list(d))
            }
            8 => format!("Array.from({})", self.typed()),
            0 => format!("[{}, {}]", self.anything(d), self.anything(d)),
            1 => format!("[...{}, {}]", self.list(d), self.anything(d)),
            2 => format!("{}.concat({})", self.list(d), self.anything(d)),
            3 => {
                format!("{}.map(x => {})", self.list(d), self.random.pick(&["x", "x + 1", "[x]", "typeof x"]))
            }
            4 => format!("{}.split({})", self.text_atom(d), self.random.pick(&["','", "''", "' '"])),
            _ => format!("[...{}]", self.numbers(d)),
        }
    }
}
