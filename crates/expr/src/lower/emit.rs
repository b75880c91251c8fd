//! SSA form to machine code: names become registers, block parameters become moves, and unused operations are removed. Where
//! possible, an operation whose result is passed to a block parameter writes directly to the register of that parameter.

use super::pure;
use super::registers::{RegisterFile, order_moves};
use crate::code::{MachineCode, MachineFunction, OPERATION};
use crate::row::{RequestedResult, Row};
use crate::ssa::{
    Args, BasicBlock, BlockEdge, BlockId, Num, Op, Operand, OperandUse, Representation, SsaFunction,
    SsaProgram, Terminator, Val,
};
use crate::value::Value;
use labspec_finding::{Span, order};

/// The number of consecutive numeric operations from which a formula is faster, as measured.
const MIN_FORMULA: usize = 5;
/// The maximum number of operations of a formula, so that its registers fit into one byte.
const MAX_FORMULA: usize = 64;

/// Emits the code of a program. `often` states that it runs often enough to use formulas.
pub(crate) fn emit(form: SsaProgram, often: bool) -> MachineCode {
    let units = form.units.iter().map(|function| emit_function(function, often)).collect();
    MachineCode { form, units }
}

/// Emits the code of a function.
fn emit_function(form: &SsaFunction, often: bool) -> MachineFunction {
    let (numbers, values) =
        (RegisterFile::for_names(form.same.numbers.len()), RegisterFile::for_names(form.same.values.len()));
    let (live, starts) = (vec![true; form.ops.len()], vec![None; form.blocks.len()]);
    let (ops, spans) = (Vec::with_capacity(form.ops.len() + 8), Vec::with_capacity(form.ops.len() + 8));
    let code = MachineFunction { ops, spans, ..MachineFunction::default() };
    let worth = if often { MIN_FORMULA } else { usize::MAX };
    let mut emit = Emit { worth, form, code, numbers, values, live, starts, jumps: Vec::new() };
    emit.count_uses();
    emit.first_registers();
    for block in 0..emit.form.blocks.len() as u32 {
        emit.block(block);
    }
    emit.finish()
}

/// The state of the emission of one function.
struct Emit<'f> {
    /// The minimum number of operations of a formula.
    worth: usize,
    form: &'f SsaFunction,
    code: MachineFunction,
    numbers: RegisterFile,
    values: RegisterFile,
    /// Operations whose results are needed.
    live: Vec<bool>,
    /// The first instruction of each block, if the block is reachable.
    starts: Vec<Option<u32>>,
    /// Jumps, and their target blocks.
    jumps: Vec<(usize, BlockId)>,
}

impl<'f> Emit<'f> {
    /// Counts the uses of every name, from the last operation to the first, so that operands of unused
    /// operations are not counted.
    fn count_uses(&mut self) {
        let form = self.form;
        for (id, block) in form.blocks.iter().enumerate().rev() {
            match &block.end {
                Terminator::If(_, test, _) => self.count_use(Operand::Number(*test)),
                Terminator::IfNothing(_, value, _) => self.count_use(Operand::Value(*value)),
                Terminator::Return(Some(operand)) => self.count_use(*operand),
                Terminator::Return(None) | Terminator::Jump(_) | Terminator::Again(_) => {}
            }
            if let Some(edge) = edge(&block.end) {
                self.count_edge_uses(edge, matches!(block.end, Terminator::Again(_)));
            }
            for i in form.range(id as BlockId).rev() {
                self.count_operation_uses(i);
            }
        }
    }

    fn count_use(&mut self, operand: Operand) {
        match self.form.same.at(operand) {
            Operand::Number(n) => self.numbers.used(n.0),
            Operand::Value(v) => self.values.used(v.0),
        }
    }

    /// Counts the values passed along an edge. `back` marks an edge to the start of a loop, whose parameters may be used by
    /// operations that were counted already.
    fn count_edge_uses(&mut self, edge: &BlockEdge, back: bool) {
        let params = self.form.blocks.get(edge.to as usize).map_or(&[][..], |b| &b.params);
        for (param, arg) in params.iter().zip(&edge.args) {
            let needed = match param {
                Operand::Number(n) => self.numbers.uses(n.0) > 0,
                Operand::Value(v) => self.values.uses(v.0) > 0,
            };
            if needed || back {
                self.count_use(*arg);
            }
        }
    }

    /// Determines whether an operation is needed, and counts its operands.
    fn count_operation_uses(&mut self, i: usize) {
        let Emit { form, numbers, values, live, .. } = self;
        let (Some(mut op), Some(keep)) = (form.ops.get(i).copied(), live.get_mut(i)) else { return };
        let mut needed = !op.is_pure();
        op.each(&mut |u| match u {
            OperandUse::Gives(n) => needed |= numbers.uses(n.0) > 0,
            OperandUse::GivesValue(v) => needed |= values.uses(v.0) > 0,
            _ => {}
        });
        *keep = needed;
        if !needed {
            return;
        }
        op.each(&mut |u| match u {
            OperandUse::Reads(n) => numbers.used(form.same.number(*n).0),
            OperandUse::ReadsValue(v) => values.used(form.same.value(*v).0),
            OperandUse::ReadsAll(args) => {
                args.operands(&form.args).iter().for_each(|n| numbers.used(form.same.number(Num(*n)).0));
            }
            OperandUse::ReadsValues(args) => {
                args.operands(&form.args).iter().for_each(|v| values.used(form.same.value(Val(*v)).0));
            }
            OperandUse::Gives(_) | OperandUse::GivesValue(_) => {}
        });
    }

    /// Assigns the first registers to the parameters and captured variables.
    fn first_registers(&mut self) {
        for slot in self.form.params.iter().chain(&self.form.captures) {
            match slot {
                Representation::Value => self.values.register(self.values.count),
                _ => self.numbers.register(self.numbers.count),
            };
        }
    }

    fn number(&mut self, n: Num) -> Num {
        Num(self.numbers.register(self.form.same.number(n).0))
    }

    fn value(&mut self, v: Val) -> Val {
        Val(self.values.register(self.form.same.value(v).0))
    }

    fn push(&mut self, op: Op, span: Span) {
        self.code.ops.push(op);
        self.code.spans.push(span);
    }

    fn block(&mut self, id: BlockId) {
        let form: &'f SsaFunction = self.form;
        let Some(BasicBlock { end, span, .. }) = form.blocks.get(id as usize) else { return };
        // An unreachable block is removed. Edges lead forward, so all edges to this block have been seen.
        let reached = self.starts.get(id as usize).is_some_and(|s| id == 0 || s.is_some());
        if !reached {
            return;
        }
        if let Some(start) = self.starts.get_mut(id as usize) {
            *start = Some(self.code.ops.len() as u32);
        }
        self.write_results_directly(id, end);
        let range = self.form.range(id);
        let (mut i, end_of_block) = (range.start, range.end);
        while i < end_of_block {
            let numeric = |i: &usize| self.form.ops.get(*i).is_some_and(Op::is_numeric);
            let stop = (i..end_of_block.min(i + MAX_FORMULA))
                .find(|i| !numeric(i))
                .unwrap_or(end_of_block.min(i + MAX_FORMULA));
            if !self.formula(i, stop) {
                (i..stop.max(i + 1)).for_each(|i| self.op(i));
            }
            i = stop.max(i + 1);
        }
        self.end(id, end, *span);
    }

    /// Emits consecutive numeric operations as one formula if that is faster, and returns whether it did.
    fn formula(&mut self, first: usize, stop: usize) -> bool {
        if stop - first.min(stop) < self.worth {
            return false;
        }
        let live = (first..stop).filter(|i| self.live.get(*i) == Some(&true));
        let ops: Vec<Op> = live.filter_map(|i| self.form.ops.get(i).copied()).collect();
        if ops.len() < self.worth {
            return false;
        }
        let count = ops.len() as u32;
        let Emit { form, numbers, code, .. } = self;
        let mut inputs = Vec::new();
        let mut input = |n: Num| {
            let register = numbers.register(n.0);
            inputs.push(register);
            register
        };
        let Some((mut formula, given)) = pure::formula_of_operations(form, &ops, &mut input) else {
            return false;
        };
        // The remaining uses of each result, outside these operations.
        let mut left = order::map(given.iter().map(|(n, _)| (n.0, numbers.uses(n.0))));
        for mut op in ops {
            let mut use_up = |n: Num| {
                if let Some(left) = left.get_mut(&form.same.number(n).0) {
                    *left -= 1;
                }
            };
            op.each(&mut |u| match u {
                OperandUse::Reads(n) => use_up(*n),
                OperandUse::ReadsAll(args) => args.operands(&form.args).iter().for_each(|n| use_up(Num(*n))),
                _ => {}
            });
        }
        let outer: Vec<(Num, u32)> =
            given.into_iter().filter(|(n, _)| left.get(&n.0).is_some_and(|left| *left > 0)).collect();
        let mut steps: Vec<u32> = outer.iter().map(|(_, step)| *step).collect();
        formula.finish(&mut steps);
        let mut requested = Vec::with_capacity(outer.len());
        for ((name, _), step) in outer.iter().zip(&steps) {
            let register = numbers.register(name.0);
            let Ok(register) = u8::try_from(register) else { return false };
            let at_once = !inputs.contains(&u32::from(register));
            requested.push(RequestedResult { step: *step, register, at_once });
        }
        // Intermediate results of the formula use the registers after those assigned so far.
        let free =
            (numbers.count..numbers.count + formula.steps.len() as u32).map_while(|r| u8::try_from(r).ok());
        let Some(row) = Row::part(&formula, &requested, free) else { return false };
        numbers.count = numbers.count.max(row.registers());
        let index = code.formulas.len() as u32;
        code.formulas.push((row, count));
        let span = self.form.spans.get(first).copied().unwrap_or_default();
        self.push(Op::Formula(index), span);
        true
    }

    /// Makes operations of a block write their results directly to the registers that its end requires.
    fn write_results_directly(&mut self, id: BlockId, end: &Terminator) {
        let mut moves: Vec<(Operand, Operand)> = Vec::new();
        match end {
            Terminator::Jump(edge) | Terminator::Again(edge) => moves = self.moves(edge),
            Terminator::Return(Some(from @ Operand::Number(_))) => {
                moves.push((Operand::Number(Num(0)), *from))
            }
            Terminator::Return(Some(from @ Operand::Value(_))) => moves.push((Operand::Value(Val(0)), *from)),
            _ => {}
        }
        if moves.is_empty() {
            return;
        }
        let again = matches!(end, Terminator::Again(_));
        // From the last operation to the first: a register that a later operation reads must not be overwritten.
        let mut read: Vec<Operand> =
            if again { moves.iter().map(|(_, from)| *from).collect() } else { Vec::new() };
        for i in self.form.range(id).rev() {
            if self.live.get(i) != Some(&true) {
                continue;
            }
            let Some(mut op) = self.form.ops.get(i).copied() else { continue };
            let mut gives = None;
            op.each(&mut |u| match u {
                OperandUse::Gives(n) => gives = Some(Operand::Number(*n)),
                OperandUse::GivesValue(v) => gives = Some(Operand::Value(*v)),
                _ => {}
            });
            if let Some(gives) = gives
                && let Some((to, _)) = moves.iter().find(|(to, from)| *from == gives && !read.contains(to))
            {
                match (gives, *to) {
                    (Operand::Number(n), Operand::Number(to)) if self.numbers.uses(n.0) == 1 => {
                        let register = if to.0 == 0 { 0 } else { self.numbers.register(to.0) };
                        self.numbers.set(n.0, register);
                    }
                    (Operand::Value(v), Operand::Value(to)) if self.values.uses(v.0) == 1 => {
                        let register = if to.0 == 0 { 0 } else { self.values.register(to.0) };
                        self.values.set(v.0, register);
                    }
                    _ => {}
                }
            }
            if again {
                self.reads(op, &mut read);
            }
        }
    }

    /// The parameters of the target block of an edge with the values passed to them, both as names.
    fn moves(&self, edge: &BlockEdge) -> Vec<(Operand, Operand)> {
        let params = self.form.blocks.get(edge.to as usize).map_or(&[][..], |b| &b.params);
        let needed = |param: &Operand| match param {
            Operand::Number(n) => self.numbers.uses(n.0) > 0,
            Operand::Value(v) => self.values.uses(v.0) > 0,
        };
        let pairs = params.iter().zip(&edge.args).filter(|(param, _)| needed(param));
        pairs.map(|(param, from)| (*param, self.form.same.at(*from))).collect()
    }

    /// Adds the names that an operation reads.
    fn reads(&self, mut op: Op, read: &mut Vec<Operand>) {
        let (same, list) = (&self.form.same, &self.form.args);
        op.each(&mut |u| match u {
            OperandUse::Reads(n) => read.push(Operand::Number(same.number(*n))),
            OperandUse::ReadsValue(v) => read.push(Operand::Value(same.value(*v))),
            OperandUse::ReadsAll(a) => {
                read.extend(a.operands(list).iter().map(|n| Operand::Number(same.number(Num(*n)))))
            }
            OperandUse::ReadsValues(a) => {
                read.extend(a.operands(list).iter().map(|v| Operand::Value(same.value(Val(*v)))))
            }
            OperandUse::Gives(_) | OperandUse::GivesValue(_) => {}
        });
    }

    fn op(&mut self, i: usize) {
        if self.live.get(i) != Some(&true) {
            return;
        }
        let (Some(mut op), Some(&span)) = (self.form.ops.get(i).copied(), self.form.spans.get(i)) else {
            return;
        };
        let Emit { form, numbers, values, code, .. } = self;
        // Operands come first, because the result may use the register of an operand.
        let mut list = |args: Args, name: &mut dyn FnMut(u32) -> u32| {
            let first = code.args.len() as u32;
            code.args.extend(args.operands(&form.args).iter().map(|a| name(*a)));
            first
        };
        let mut args = None;
        op.each(&mut |u| match u {
            OperandUse::Gives(n) => n.0 = numbers.register(n.0),
            OperandUse::GivesValue(v) => v.0 = values.register(v.0),
            OperandUse::Reads(n) => n.0 = numbers.register(form.same.number(*n).0),
            OperandUse::ReadsValue(v) => v.0 = values.register(form.same.value(*v).0),
            OperandUse::ReadsAll(a) => {
                args = Some(list(a, &mut |n| numbers.register(form.same.number(Num(n)).0)))
            }
            OperandUse::ReadsValues(a) => {
                args = Some(list(a, &mut |v| values.register(form.same.value(Val(v)).0)))
            }
        });
        if let (Some(first), Some(place)) = (args, op.args_mut()) {
            place.first = first;
        }
        self.push(op, span);
    }

    fn end(&mut self, id: BlockId, end: &Terminator, span: Span) {
        if let Some(edge) = edge(end) {
            self.move_all(edge, span);
            let jump = match end {
                Terminator::If(when, test, _) => Op::JumpIf(*when, self.number(*test), 0),
                Terminator::IfNothing(when, value, _) => Op::JumpIfNothing(*when, self.value(*value), 0),
                Terminator::Again(_) => Op::Again(0, 0),
                _ => Op::Jump(0),
            };
            let reach = |starts: &mut Vec<Option<u32>>, block: BlockId| {
                if let Some(start) = starts.get_mut(block as usize) {
                    start.get_or_insert(0);
                }
            };
            if matches!(end, Terminator::If(..) | Terminator::IfNothing(..)) {
                reach(&mut self.starts, id + 1);
            }
            if !matches!(end, Terminator::Again(_)) {
                reach(&mut self.starts, edge.to);
            }
            if !(matches!(jump, Op::Jump(_)) && edge.to == id + 1) {
                self.jumps.push((self.code.ops.len(), edge.to));
                self.push(jump, span);
            }
            return;
        }
        match end {
            Terminator::Return(Some(Operand::Number(n))) => {
                let from = self.number(*n);
                if from.0 != 0 {
                    self.push(Op::Move(Num(0), from), span);
                }
            }
            Terminator::Return(Some(Operand::Value(v))) => {
                let from = self.value(*v);
                if from.0 != 0 {
                    self.push(Op::MoveValue(Val(0), from), span);
                }
            }
            _ => {
                let nothing = Val(self.values.count);
                self.values.count += 1;
                self.code.values.push((nothing, Value::Undefined));
                self.push(Op::MoveValue(Val(0), nothing), span);
            }
        }
        self.push(Op::Return, span);
    }

    /// Assigns all parameters of a block at once, independent of the order of the moves.
    fn move_all(&mut self, edge: &BlockEdge, span: Span) {
        let (mut numbers, mut values) = (Vec::new(), Vec::new());
        for (to, from) in self.moves(edge) {
            match (to, from) {
                (Operand::Number(to), Operand::Number(from)) => {
                    numbers.push((self.number(to).0, self.number(from).0))
                }
                (Operand::Value(to), Operand::Value(from)) => {
                    values.push((self.value(to).0, self.value(from).0))
                }
                // A parameter and its argument always have the same representation.
                _ => {}
            }
        }
        for (to, from) in order_moves(numbers, &mut self.numbers.count) {
            self.push(Op::Move(Num(to), Num(from)), span);
        }
        for (to, from) in order_moves(values, &mut self.values.count) {
            self.push(Op::MoveValue(Val(to), Val(from)), span);
        }
    }

    fn finish(mut self) -> MachineFunction {
        for (jump, to) in &self.jumps {
            let here = self.starts.get(*to as usize).copied().flatten().unwrap_or_default();
            if let Some(
                Op::Jump(to) | Op::JumpIf(_, _, to) | Op::JumpIfNothing(_, _, to) | Op::Again(to, _),
            ) = self.code.ops.get_mut(*jump)
            {
                *to = here;
            }
        }
        let Emit { form, mut code, numbers, values, .. } = self;
        // Constants that are used outside formulas are stored in registers.
        let register = |file: &RegisterFile, name: u32| file.registers.get(name as usize).copied().flatten();
        let constants = form.numbers.iter().filter_map(|(n, x)| Some((Num(register(&numbers, n.0)?), *x)));
        code.numbers.extend(constants);
        let constants =
            form.values.iter().filter_map(|(v, x)| Some((Val(register(&values, v.0)?), x.clone())));
        code.values.extend(constants);
        // The cumulative cost before each operation. A formula costs as much as its operations.
        let mut costs = vec![0];
        for op in &code.ops {
            let formula = |f: u32| code.formulas.get(f as usize).map_or(1, |(_, count)| u64::from(*count));
            let cost = if let Op::Formula(f) = op { formula(*f) } else { 1 };
            costs.push(costs.last().copied().unwrap_or(0) + OPERATION * cost);
        }
        let before = |index: usize| costs.get(index).copied().unwrap_or(0);
        for (index, op) in code.ops.iter_mut().enumerate() {
            if let Op::Again(to, cost) = op {
                *cost = u32::try_from(before(index + 1) - before(*to as usize)).unwrap_or(u32::MAX);
            }
        }
        code.cost = before(code.ops.len()) + OPERATION * (code.numbers.len() + code.values.len()) as u64;
        (code.number_count, code.value_count) = (numbers.count, values.count);
        (code.params, code.captures, code.result) = (form.params.clone(), form.captures.clone(), form.result);
        code
    }
}

fn edge(end: &Terminator) -> Option<&BlockEdge> {
    match end {
        Terminator::Jump(edge)
        | Terminator::Again(edge)
        | Terminator::If(_, _, edge)
        | Terminator::IfNothing(_, _, edge) => Some(edge),
        Terminator::Return(_) => None,
    }
}
