//! Random programs: declarations, assignments, loops, functions, and expressions of every kind, in which names are of the types
//! that they are used as.

/// Marsaglia's xorshift.
struct Random(u64);

impl Random {
    fn next(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % n.max(1)
    }

    fn pick<'a>(&mut self, words: &[&'a str]) -> &'a str {
        words[self.next(words.len())]
    }
}

/// What a variable of the program holds.
#[derive(Clone, Copy, PartialEq)]
enum Holds {
    Number,
    Text,
    Anything,
    List,
    Numbers,
    Record,
    /// An array of integers, bytes or doubles.
    Typed,
    /// Takes so many numbers, gives a number.
    Function(usize),
}

/// Assignments to an element.
const COMPOUND: [&str; 14] =
    ["=", "=", "+=", "-=", "*=", "/=", "%=", "|=", "&=", "<<=", ">>>=", "||=", "&&=", "??="];

pub(super) struct Generator {
    random: Random,
    names: Vec<(String, Holds, bool)>,
    count: usize,
    /// Inside of a function: no changes of what is outside, so that folding stays visible.
    loops: usize,
    functions: usize,
}

impl Generator {
    fn next(&mut self, n: usize) -> usize {
        self.random.next(n)
    }

    fn name(&mut self, holds: Holds, changeable: bool) -> Option<String> {
        let fitting: Vec<&String> =
            self.names.iter().filter(|n| n.1 == holds && (n.2 || !changeable)).map(|n| &n.0).collect();
        let n = fitting.len();
        if n == 0 { None } else { Some(fitting[self.random.next(n)].clone()) }
    }

    fn number(&mut self, depth: usize) -> String {
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
                _ => self.name(Holds::Number, false).unwrap_or_else(|| "7".into()),
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
            16 => match self.names.iter().rev().find(|n| matches!(n.1, Holds::Function(_))).cloned() {
                Some((name, Holds::Function(n), _)) => {
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
            22 => match self.name(Holds::Number, true) {
                Some(name) => format!("{name}{}", self.random.pick(&["++", "--"])),
                None => self.number(d),
            },
            _ => format!("({}[{}] ?? {})", self.numbers(d), self.next(5), self.number(d)),
        }
    }

    fn text_atom(&mut self, depth: usize) -> String {
        if depth > 0 && self.next(2) == 0 {
            return format!("({})", self.text(depth - 1));
        }
        match self.name(Holds::Text, false) {
            Some(name) if self.next(2) == 0 => name,
            _ => format!(
                "'{}'",
                self.random.pick(&["", "a", "ab c", "12", " 3.5 ", "x,y", "é", "0x10", "-1e3", "true"])
            ),
        }
    }

    fn text(&mut self, depth: usize) -> String {
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

    /// An element of an array of the host that can be set.
    fn element(&mut self) -> String {
        match self.next(5) {
            0 => format!("data.qpos[{}]", self.next(14)),
            1 => format!("data.eq_active[{}]", self.next(4)),
            2 => format!("model.geom_contype[{}]", self.next(4)),
            3 => match self.name(Holds::Typed, false) {
                Some(name) => format!("{name}[{}]", self.next(4)),
                None => "data.eq_active[3]".into(),
            },
            _ => "model.opt.iterations".into(),
        }
    }

    /// A number with few binary places, a very small or a very large one.
    fn tie(&mut self) -> String {
        let size = 1 << (1 + self.next(20));
        let odd = 2.0 * self.next(size) as f64 + 1.0;
        let x = match self.next(6) {
            0..=3 => odd / 2f64.powi(self.next(60) as i32),
            4 => odd * 2f64.powi(self.next(900) as i32),
            _ => odd * 2f64.powi(-1074 + self.next(200) as i32),
        };
        // The shortest text that reads back as this number.
        format!("{x:e}")
    }

    /// A number in so many digits that what is left out is exactly half of the last one, or one digit beside it.
    fn at_tie(&mut self) -> String {
        let places = 1 + self.next(50);
        let size = 1 << (1 + self.next(20));
        let whole = self.next(size) as f64 / 2f64.powi(self.next(2 * places) as i32);
        let x = whole + 2f64.powi(-(places as i32));
        let exact = format!("{x:.1100}");
        let exact = exact.trim_end_matches('0');
        let places = exact.split('.').nth(1).map_or(0, str::len);
        let digits = exact.replace('.', "").trim_start_matches('0').len();
        let near = |n: usize, random: &mut Random| (n + random.next(3)).saturating_sub(2).min(100);
        let sign = self.random.pick(&["", "-"]);
        let last = match self.next(3) {
            0 => format!("toFixed({})", near(places, &mut self.random)),
            1 => format!("toPrecision({})", near(digits, &mut self.random)),
            _ => format!("toExponential({})", near(digits.saturating_sub(1), &mut self.random)),
        };
        format!("({sign}{x:e}).{last}")
    }

    /// An array of numbers whose elements are of a fixed type.
    fn typed(&mut self) -> String {
        match self.next(7) {
            0 => "data.eq_active".into(),
            1 => "model.geom_contype".into(),
            2 => "data.eq_active.slice()".into(),
            3 => "model.geom_contype.slice(1)".into(),
            4 => format!("data.eq_active.map(x => x * {})", self.number(0)),
            5 => format!("model.geom_contype.filter(x => x > {})", self.number(0)),
            _ => "data.qpos.subarray(2, 6)".into(),
        }
    }

    fn truth(&mut self, depth: usize) -> String {
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

    fn anything(&mut self, depth: usize) -> String {
        match self.next(7) {
            0..=2 => self.number(depth),
            3 => self.text(depth),
            4 => self.truth(depth),
            5 => self.name(Holds::Anything, false).unwrap_or_else(|| "null".into()),
            _ => self.random.pick(&["null", "undefined", "1", "'s'"]).into(),
        }
    }

    /// A list of numbers.
    fn numbers(&mut self, depth: usize) -> String {
        if depth == 0 {
            return match self.name(Holds::Numbers, false) {
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
            // An order in which NaN equals everything is none: the standard leaves open what such a sort gives.
            4 => format!(
                "[...{}].sort((a, b) => a !== a ? (b !== b ? 0 : 1) : b !== b ? -1 : a - b)",
                self.numbers(d)
            ),
            5 => format!("[...{}].{}()", self.numbers(d), self.random.pick(&["reverse", "toReversed"])),
            _ => format!("Array.from({{length: {}}}, (_, i) => i * {})", self.next(5), self.number(d)),
        }
    }

    fn list(&mut self, depth: usize) -> String {
        if depth == 0 {
            return self.name(Holds::List, false).unwrap_or_else(|| "[1, 'b', null]".into());
        }
        let d = depth - 1;
        match self.next(9) {
            6 => {
                let f = ["x", "[x]", "[x, [x]]", "typeof x", "[]", "null", "({a: x})", "'ab'"];
                format!("{}.flatMap((x, i) => {})", self.list(d), self.random.pick(&f))
            }
            7 => {
                let (a, b) = (self.anything(d), self.anything(d));
                // What orders differently in two comparisons is no order, see `numbers`.
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

    fn declare(&mut self, holds: Holds, changes: bool) -> String {
        self.count += 1;
        let name = format!("v{}", self.count);
        self.names.push((name.clone(), holds, changes));
        name
    }

    fn block(&mut self, depth: usize, n: usize) -> String {
        let names = self.names.len();
        let mut out = String::from("{ ");
        for _ in 0..n {
            out += &self.statement(depth);
        }
        self.names.truncate(names);
        out + "}"
    }

    fn statement(&mut self, depth: usize) -> String {
        let d = depth.saturating_sub(1);
        match self.next(if depth == 0 { 15 } else { 23 }) {
            10 => {
                let place = self.element();
                let op = self.random.pick(&COMPOUND);
                format!("{place} {op} {}; ", self.anything(2))
            }
            11 => {
                let value = self.typed();
                format!("const {} = {value}; ", self.declare(Holds::Typed, false))
            }
            12 => {
                let i = self.declare(Holds::Number, true);
                let list = match self.next(4) {
                    0 => self.name(Holds::Typed, false),
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
                let name = self.declare(Holds::Number, changes);
                format!("{} {name} = {value}; ", if changes { "let" } else { "const" })
            }
            2 => {
                let value = self.text(2);
                format!("const {} = {value}; ", self.declare(Holds::Text, false))
            }
            3 => {
                let value = self.list(2);
                format!("const {} = {value}; ", self.declare(Holds::List, false))
            }
            4 => {
                let value = self.anything(2);
                format!("let {} = {value}; ", self.declare(Holds::Anything, true))
            }
            5..=6 => match self.name(Holds::Number, true) {
                Some(name) => {
                    let op =
                        self.random.pick(&["=", "+=", "-=", "*=", "/=", "%=", "|=", "&&=", "||=", "??="]);
                    format!("{name} {op} {}; ", self.number(2))
                }
                None => format!("data.qpos[{}] = {}; ", self.next(14), self.number(2)),
            },
            7 => match self.name(Holds::Anything, true) {
                Some(name) => format!("{name} {} {}; ", self.random.pick(&["=", "+="]), self.anything(2)),
                None => format!("ctx.k = {}; ", self.anything(2)),
            },
            8 => format!(
                "data.qvel[{}] {} {}; ",
                self.next(12),
                self.random.pick(&["=", "+=", "*="]),
                self.number(2)
            ),
            9 => match self.name(Holds::List, false) {
                Some(name) => match self.next(4) {
                    0 => format!("{name}.push({}); ", self.anything(1)),
                    // Never beyond the end: a list has no holes here.
                    1 => format!("if ({name}.length > 3) {name}[{}] = {}; ", self.next(4), self.anything(1)),
                    2 => format!("{name}.reverse(); "),
                    _ => format!("{name}.pop(); "),
                },
                None => format!("const {{a: {}}} = {{a: {}}}; ", self.declare(Holds::Anything, false), "4"),
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
                let i = self.declare(Holds::Number, false);
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
                let x = self.declare(Holds::Number, false);
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
                let params: Vec<String> = (0..n).map(|_| self.declare(Holds::Number, true)).collect();
                let body: String = (0..2).map(|_| self.statement(d)).collect();
                let result = self.number(2);
                self.names.truncate(outer);
                self.loops = loops;
                self.functions -= 1;
                let name = self.declare(Holds::Function(n), false);
                format!("const {name} = ({}) => {{ {body}return {result}; }}; ", params.join(", "))
            }
            22 => {
                let i = self.declare(Holds::Number, false);
                self.names.pop();
                self.loops += 1;
                let body = self.block(d, 1);
                self.loops -= 1;
                format!("let {i} = 0; while ({i} < 3) {{ {i}++; {body} }} ")
            }
            _ => {
                let value = self.number(1);
                let name = self.declare(Holds::Record, false);
                format!("const {name} = {{p: {value}, q: [{value}]}}; {name}.p += 1; ")
            }
        }
    }

    /// Names for the parts of what may be no list, or no record.
    fn destructuring(&mut self) -> String {
        let whole = match self.next(6) {
            0 => self.numbers(1),
            1..=2 => self.list(1),
            3 => self.typed(),
            4 => self.text(1),
            _ => self.name(Holds::Anything, false).unwrap_or_else(|| "ctx.k".into()),
        };
        let fallback = self.anything(1);
        let names = [(); 3].map(|()| self.declare(Holds::Anything, true));
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

    /// The generator that begins with a seed.
    pub(super) fn new(seed: u64) -> Generator {
        let random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        Generator { random, names: Vec::new(), count: 0, loops: 0, functions: 0 }
    }

    /// The next program.
    pub(super) fn program(&mut self) -> String {
        self.names.clear();
        (self.count, self.loops, self.functions) = (0, 0, 0);
        let n = 1 + self.next(6);
        let mut out = String::new();
        for _ in 0..n {
            out += &self.statement(2);
        }
        let shown: Vec<String> = self
            .names
            .iter()
            .filter(|n| !matches!(n.1, Holds::Function(_)))
            .map(|n| n.0.clone())
            .chain([String::new()])
            .collect();
        let last = self.anything(3);
        let shown = shown.join(", ");
        out + &format!("ctx.out = [{shown}{last}, ctx.k];")
    }
}
