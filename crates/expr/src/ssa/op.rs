//! The operations of the SSA form and of the virtual machine, on numbers and on values of any type. In SSA form, the first
//! operand of an operation is the unique name of its result; in machine code, all operands are registers.

use crate::ir::{FreeFunctionId, MethodId, UnitId};
use crate::math;
use crate::operators::{BinaryOp, UnaryOp};
use crate::types::{FieldKey, FunctionId};
use crate::value::View;

/// A number, or a boolean as 1 or 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Num(pub(crate) u32);

/// A value of any type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Val(pub(crate) u32);

/// A list of operands: a range in the unit's list of operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Args {
    pub(crate) first: u32,
    pub(crate) count: u32,
}

impl Args {
    pub(crate) fn operands(self, list: &[u32]) -> &[u32] {
        list.get(self.first as usize..(self.first + self.count) as usize).unwrap_or(&[])
    }
}

/// One operation; the first operand is the result.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Op {
    Load(Num, FieldKey, u32),
    LoadAt(Num, View, Num),
    LoadValue(Val, View, u32),
    LoadValueAt(Val, View, Num),
    Length(Num, View),
    Input(Val),
    Global(Val, u32),
    GlobalNumber(Num, u32),
    GlobalNamed(Val, Val),
    Aggregate(Num, u32),

    BoxNumber(Val, Num),
    BoxBoolean(Val, Num),
    ToNumber(Num, Val),
    ToIndex(Num, Val),
    Truthy(Num, Val),
    ToText(Val, Val),
    TypeOf(Val, Val),

    Unary(Num, UnaryOp, Num),
    Binary(Num, BinaryOp, Num, Num),
    /// The second operand if the first is truthy, otherwise the third.
    Select(Num, Num, Num, Num),
    Math(Num, math::MathFunction, Args),
    MathOver(Num, math::MathFunction, Val),
    /// `+` of values.
    Plus(Val, Val, Val),
    /// A comparison of values.
    Compare(Num, BinaryOp, Val, Val),

    CallHost(Val, FunctionId, Args),
    Store(FieldKey, u32, Num),
    StoreAt(View, Num, Num),
    StoreGlobal(u32, Val),
    StoreGlobalNamed(Val, Val),
    Fill(View, Num),

    /// Passes an argument in a register of the function that is called next.
    PassNumber(u32, Num),
    PassValue(u32, Val),
    /// Calls a function of the same program.
    Call(UnitId),
    TakeNumber(Num),
    TakeValue(Val),
    Closure(Val, UnitId, Args),
    Invoke(Val, Val, Args),
    InvokeList(Val, Val, Val),
    NewCell(Val, Val),
    EmptyCell(Val),
    CellGet(Val, Val),
    /// Stores a variable in its cell; `true` if this executes its declaration.
    CellSet(Val, Val, bool),

    List(Val, Args),
    /// Appends a value, or its elements if `true`.
    Append(Val, Val, bool),
    NewRecord(Val),
    Put(Val, Val, Val),
    PutAll(Val, Val),
    Element(Val, Val, Val),
    ElementAt(Val, Val, Num),
    Member(Val, Val, u32),
    /// Stores an element; `true` if the object is certainly a record.
    StoreItem(Val, Val, Val, bool),
    StoreMember(Val, u32, Val, bool),
    /// Calls a method; the receiver is the first argument.
    Method(Val, MethodId, Args),
    MethodList(Val, MethodId, Val, Val),
    Native(Val, FreeFunctionId, Args),
    NativeList(Val, FreeFunctionId, Val),
    Pick(Val, u32, Val),
    PickNumber(Num, u32, Val),

    // Only in machine code: control flow and moves.
    Move(Num, Num),
    MoveValue(Val, Val),
    /// Computes several numbers at once.
    Formula(u32),
    Jump(u32),
    JumpIf(bool, Num, u32),
    /// Jumps if the value is, or is not, `undefined` or `null`.
    JumpIfNothing(bool, Val, u32),
    /// Jumps back to the start of a loop; the second number is the cost of an iteration.
    Again(u32, u32),
    Return,
}

/// How an operation uses an operand.
pub(crate) enum OperandUse<'o> {
    Gives(&'o mut Num),
    GivesValue(&'o mut Val),
    Reads(&'o mut Num),
    ReadsValue(&'o mut Val),
    ReadsAll(Args),
    ReadsValues(Args),
}

#[inline]
fn each_use<const N: usize>(f: &mut impl FnMut(OperandUse<'_>), uses: [OperandUse<'_>; N]) {
    uses.into_iter().for_each(f);
}

impl Op {
    /// Calls `f` for every operand with its use. This complete table ensures that no operation is forgotten.
    pub(crate) fn each(&mut self, f: &mut impl FnMut(OperandUse<'_>)) {
        use OperandUse::{Gives, GivesValue, Reads, ReadsAll, ReadsValue, ReadsValues};
        match self {
            Op::Load(d, ..) | Op::Length(d, _) | Op::Aggregate(d, _) => f(Gives(d)),
            Op::GlobalNumber(d, _) | Op::TakeNumber(d) => f(Gives(d)),
            Op::Input(d) | Op::Global(d, _) | Op::LoadValue(d, ..) | Op::TakeValue(d) => f(GivesValue(d)),
            Op::EmptyCell(d) | Op::NewRecord(d) => f(GivesValue(d)),
            Op::LoadAt(d, _, a) | Op::Unary(d, _, a) | Op::Move(d, a) => each_use(f, [Gives(d), Reads(a)]),
            Op::LoadValueAt(d, _, a) | Op::BoxNumber(d, a) | Op::BoxBoolean(d, a) => {
                each_use(f, [GivesValue(d), Reads(a)])
            }
            Op::ToNumber(d, a) | Op::ToIndex(d, a) | Op::Truthy(d, a) => {
                each_use(f, [Gives(d), ReadsValue(a)])
            }
            Op::MathOver(d, _, a) | Op::PickNumber(d, _, a) => each_use(f, [Gives(d), ReadsValue(a)]),
            Op::GlobalNamed(d, a) | Op::ToText(d, a) | Op::TypeOf(d, a) | Op::MoveValue(d, a) => {
                each_use(f, [GivesValue(d), ReadsValue(a)])
            }
            Op::NewCell(d, a) | Op::CellGet(d, a) | Op::Member(d, a, _) => {
                each_use(f, [GivesValue(d), ReadsValue(a)])
            }
            Op::NativeList(d, _, a) | Op::Pick(d, _, a) => each_use(f, [GivesValue(d), ReadsValue(a)]),
            Op::Binary(d, _, a, b) => each_use(f, [Gives(d), Reads(a), Reads(b)]),
            Op::Select(d, a, b, c) => each_use(f, [Gives(d), Reads(a), Reads(b), Reads(c)]),
            Op::Compare(d, _, a, b) => each_use(f, [Gives(d), ReadsValue(a), ReadsValue(b)]),
            Op::Plus(d, a, b) | Op::Element(d, a, b) => {
                each_use(f, [GivesValue(d), ReadsValue(a), ReadsValue(b)])
            }
            Op::InvokeList(d, a, b) | Op::MethodList(d, _, a, b) => {
                each_use(f, [GivesValue(d), ReadsValue(a), ReadsValue(b)])
            }
            Op::ElementAt(d, a, b) => each_use(f, [GivesValue(d), ReadsValue(a), Reads(b)]),
            Op::Math(d, _, args) => each_use(f, [Gives(d), ReadsAll(*args)]),
            Op::Invoke(d, a, args) => each_use(f, [GivesValue(d), ReadsValue(a), ReadsValues(*args)]),
            Op::CallHost(d, _, args) | Op::Closure(d, _, args) | Op::List(d, args) => {
                each_use(f, [GivesValue(d), ReadsValues(*args)])
            }
            Op::Method(d, _, args) | Op::Native(d, _, args) => {
                each_use(f, [GivesValue(d), ReadsValues(*args)])
            }
            Op::Store(_, _, a) | Op::Fill(_, a) | Op::PassNumber(_, a) | Op::JumpIf(_, a, _) => f(Reads(a)),
            Op::StoreAt(_, a, b) => each_use(f, [Reads(a), Reads(b)]),
            Op::StoreGlobal(_, a) | Op::PassValue(_, a) | Op::JumpIfNothing(_, a, _) => f(ReadsValue(a)),
            Op::StoreGlobalNamed(a, b) | Op::CellSet(a, b, _) | Op::Append(a, b, _) => {
                each_use(f, [ReadsValue(a), ReadsValue(b)])
            }
            Op::PutAll(a, b) | Op::StoreMember(a, _, b, _) => each_use(f, [ReadsValue(a), ReadsValue(b)]),
            Op::Put(a, b, c) | Op::StoreItem(a, b, c, _) => {
                each_use(f, [ReadsValue(a), ReadsValue(b), ReadsValue(c)])
            }
            Op::Call(_) | Op::Formula(_) | Op::Jump(_) | Op::Again(..) | Op::Return => {}
        }
    }

    /// Its list of operands.
    pub(crate) fn args_mut(&mut self) -> Option<&mut Args> {
        match self {
            Op::Math(_, _, args) | Op::CallHost(_, _, args) | Op::Closure(_, _, args) => Some(args),
            Op::Invoke(_, _, args) | Op::List(_, args) => Some(args),
            Op::Method(_, _, args) | Op::Native(_, _, args) => Some(args),
            _ => None,
        }
    }

    /// Whether it only computes a number from numbers.
    pub(crate) fn is_numeric(&self) -> bool {
        matches!(self, Op::Unary(..) | Op::Binary(..) | Op::Select(..) | Op::Math(..))
    }

    /// Whether it can be removed if its result is not used.
    pub(crate) fn is_pure(&self) -> bool {
        self.is_numeric()
            || matches!(self, Op::BoxNumber(..) | Op::BoxBoolean(..) | Op::Truthy(..) | Op::ToIndex(..))
            || matches!(self, Op::TypeOf(..) | Op::Length(..) | Op::Input(_) | Op::Global(..))
            || matches!(self, Op::Aggregate(..) | Op::TakeNumber(_) | Op::TakeValue(_))
    }

    /// Whether it may end the run with an error.
    pub(crate) fn may_fail(&self) -> bool {
        let loads = matches!(self, Op::Load(..) | Op::LoadAt(..) | Op::LoadValue(..) | Op::LoadValueAt(..));
        let passes = matches!(self, Op::PassNumber(..) | Op::PassValue(..) | Op::StoreGlobal(..));
        !(loads || passes || self.is_pure())
    }
}
