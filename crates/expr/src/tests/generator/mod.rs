//! Random programs: declarations, assignments, loops, functions, and expressions of every kind. Names are used
//! according to their types.

mod expression;
mod statement;

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

/// The type of a variable of the program.
#[derive(Clone, Copy, PartialEq)]
enum VariableType {
    Number,
    Text,
    Anything,
    List,
    Numbers,
    Record,
    /// An array of integers, bytes or doubles.
    Typed,
    /// A function of this many numbers that returns a number.
    Function(usize),
}

/// Assignments to an element.
const COMPOUND: [&str; 14] =
    ["=", "=", "+=", "-=", "*=", "/=", "%=", "|=", "&=", "<<=", ">>>=", "||=", "&&=", "??="];

pub(super) struct Generator {
    random: Random,
    names: Vec<(String, VariableType, bool)>,
    count: usize,
    /// The number of enclosing loops within the current function; `functions` is the number of enclosing functions.
    loops: usize,
    functions: usize,
}

impl Generator {
    fn next(&mut self, n: usize) -> usize {
        self.random.next(n)
    }

    fn name(&mut self, holds: VariableType, changeable: bool) -> Option<String> {
        let fitting: Vec<&String> =
            self.names.iter().filter(|n| n.1 == holds && (n.2 || !changeable)).map(|n| &n.0).collect();
        let n = fitting.len();
        if n == 0 { None } else { Some(fitting[self.random.next(n)].clone()) }
    }

    /// An assignable element of an array of the host.
    fn element(&mut self) -> String {
        match self.next(5) {
            0 => format!("data.qpos[{}]", self.next(14)),
            1 => format!("data.eq_active[{}]", self.next(4)),
            2 => format!("model.geom_contype[{}]", self.next(4)),
            3 => match self.name(VariableType::Typed, false) {
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
        // The shortest text that parses to this number.
        format!("{x:e}")
    }

    /// A number with so many digits that the dropped part is exactly half a unit of the last digit, or
    /// differs from half by one digit.
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

    /// An array of numbers with a fixed element type.
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

    /// The generator for a seed.
    pub(super) fn new(seed: u64) -> Generator {
        let random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        Generator { random, names: Vec::new(), count: 0, loops: 0, functions: 0 }
    }

    /// Generates the next program.
    pub(super) fn program(&mut self) -> String {
        self.names.clear();
        (self.count, self.loops, self.functions) = (0, 0, 0);
        let n = 1 + self.next(6);
        let mut out = String::new();
        for _ in 0..n {
            out += &self.statement(2);
        }
        let displayed: Vec<String> = self
            .names
            .iter()
            .filter(|n| !matches!(n.1, VariableType::Function(_)))
            .map(|n| n.0.clone())
            .chain([String::new()])
            .collect();
        let last = self.anything(3);
        let displayed = displayed.join(", ");
        out + &format!("ctx.out = [{displayed}{last}, ctx.k];")
    }
}
