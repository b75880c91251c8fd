//! Programs for the machine.

use std::sync::Arc;

use crate::Span;
use crate::ir::{Picks, Shown};
use crate::math;
use crate::natives;
use crate::operators::BinaryOp;
use crate::schema::{FieldKey, FunctionId, Type};
use crate::value::{Value, View};

/// A register of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Num(pub(crate) u32);

/// A register of values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Val(pub(crate) u32);

/// One operation; the first register is where the result goes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Op {
    Load(Num, FieldKey, u32),
    LoadAt(Num, View, Num),
    LoadValueAt(Val, View, Num),
    Length(Num, View),
    Input(Val),
    Global(Val, u32),
    GlobalNumber(Num, u32),
    GlobalNamed(Val, Val),
    Aggregate(Num, u32),

    Move(Num, Num),
    MoveValue(Val, Val),
    BoxNumber(Val, Num),
    BoxBoolean(Val, Num),
    ToNumber(Num, Val),
    ToIndex(Num, Val),
    Truthy(Num, Val),
    ToText(Val, Val),
    TypeOf(Val, Val),

    Add(Num, Num, Num),
    Subtract(Num, Num, Num),
    Multiply(Num, Num, Num),
    Divide(Num, Num, Num),
    Less(Num, Num, Num),
    Binary(Num, BinaryOp, Num, Num),
    Negate(Num, Num),
    Not(Num, Num),
    BitNot(Num, Num),
    Math(Num, math::Function, Num, u32),
    MathOver(Num, math::Function, Val),
    /// `+` of values.
    Plus(Val, Val, Val),
    /// A comparison of values.
    Compare(Num, BinaryOp, Val, Val),

    Jump(u32),
    JumpIf(bool, Num, u32),
    /// When the value is `undefined` or `null`, or is not.
    JumpIfNothing(bool, Val, u32),
    /// Back to the start of a loop; counts as a step.
    Again(u32),
    Return,

    CallHost(Val, FunctionId, Val, u32),
    Store(FieldKey, u32, Num),
    StoreAt(View, Num, Num),
    StoreGlobal(u32, Val),
    StoreGlobalNamed(Val, Val),
    Fill(View, Num),

    /// Into a register of the function that is called next.
    PassNumber(u32, Num),
    PassValue(u32, Val),
    /// A function of the same text.
    Call(u32),
    TakeNumber(Num),
    TakeValue(Val),
    Closure(Val, u32, Val, u32),
    Invoke(Val, Val, Val, u32),
    InvokeList(Val, Val, Val),
    NewCell(Val, Val),
    EmptyCell(Val),
    CellGet(Val, Val),
    /// `true`: its declaration runs.
    CellSet(Val, Val, bool),

    List(Val, Val, u32),
    /// `true`: its elements.
    Append(Val, Val, bool),
    NewRecord(Val),
    Put(Val, Val, Val),
    PutAll(Val, Val),
    Element(Val, Val, Val),
    ElementAt(Val, Val, Num),
    Member(Val, Val, u32),
    StoreItem(Val, Val, Val),
    StoreMember(Val, u32, Val),
    Method(Val, natives::Name, Val, u32),
    MethodList(Val, natives::Name, Val, Val),
    Native(Val, natives::Free, Val, u32),
    NativeList(Val, natives::Free, Val),
    Pick(Val, u32, Val),
    PickNumber(Num, u32, Val),
}

/// A program for the machine.
#[derive(Clone, Debug, Default)]
pub(crate) struct Code {
    /// The functions; the first is the text itself.
    pub(crate) units: Vec<CodeUnit>,
    /// Names of members.
    pub(crate) texts: Vec<Arc<str>>,
    pub(crate) picks: Vec<Arc<Picks>>,
    /// Arrays that become values.
    pub(crate) views: Vec<Shown>,
}

/// A function for the machine. Its first registers hold its result, the next its parameters and what it uses of
/// the functions around it.
#[derive(Clone, Debug, Default)]
pub(crate) struct CodeUnit {
    pub(crate) ops: Vec<Op>,
    /// Where each operation comes from.
    pub(crate) spans: Vec<Span>,
    /// Constants and the registers that hold them.
    pub(crate) numbers: Vec<(Num, f64)>,
    pub(crate) values: Vec<(Val, Value)>,
    /// Registers used.
    pub(crate) number_count: u32,
    pub(crate) value_count: u32,
    pub(crate) params: Vec<Slot>,
    pub(crate) captures: Vec<Slot>,
    pub(crate) result: Slot,
}

impl CodeUnit {
    /// What running it once costs, without the turns of its loops.
    pub(crate) fn cost(&self) -> u64 {
        super::OPERATION * (self.ops.len() + self.numbers.len() + self.values.len()) as u64
    }
}

/// How a value is handed over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Slot {
    Number,
    /// In a number register, as 1 or 0.
    Boolean,
    #[default]
    Value,
}

impl Slot {
    pub(crate) fn of(ty: Type) -> Slot {
        match ty {
            Type::Number => Slot::Number,
            Type::Boolean => Slot::Boolean,
            _ => Slot::Value,
        }
    }
}
