//! The operations of the SSA form and of the virtual machine, on numbers and on values of any type. In SSA form, the first
//! operand of an operation is the unique name of its result; in machine code, all operands are registers.

use crate::math;
use crate::operators::{BinaryOp, UnaryOp};
use crate::tables::{FreeFunctionId, MethodId, UnitId};
use crate::types::{FieldKey, FunctionId};
use crate::value::View;

/// A number, or a boolean as 1 or 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Num(pub u32);

/// A value of any type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Val(pub u32);

/// A list of operands: a range in the unit's list of operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Args {
    /// The place of the first.
    pub first: u32,
    /// Their number.
    pub count: u32,
}

impl Args {
    /// The registers of the list.
    pub fn operands(self, list: &[u32]) -> &[u32] {
        list.get(self.first as usize..(self.first + self.count) as usize).unwrap_or(&[])
    }
}

/// One operation; the first operand is the result.
#[derive(Clone, Copy, Debug)]
pub enum Op {
    /// An element of a field.
    Load(Num, FieldKey, u32),
    /// An element of a view, at a computed index.
    LoadAt(Num, View, Num),
    /// An element of a view as a value: `undefined` past the end.
    LoadValue(Val, View, u32),
    /// An element of a view as a value, at a computed index.
    LoadValueAt(Val, View, Num),
    /// The number of elements of a view.
    Length(Num, View),
    /// The chosen value of a control.
    Input(Val),
    /// A `ctx` variable.
    Global(Val, u32),
    /// A `ctx` variable as a number.
    GlobalNumber(Num, u32),
    /// A `ctx` variable of a computed name.
    GlobalNamed(Val, Val),
    /// The number that the host computed for an aggregate.
    Aggregate(Num, u32),

    /// A number as a value.
    BoxNumber(Val, Num),
    /// A truth value (0 or 1) as a value.
    BoxBoolean(Val, Num),
    /// A value as a number.
    ToNumber(Num, Val),
    /// A value as an index.
    ToIndex(Num, Val),
    /// Whether a value counts as true: 1 or 0.
    Truthy(Num, Val),
    /// A value as a text.
    ToText(Val, Val),
    /// What `typeof` gives.
    TypeOf(Val, Val),

    /// An operator with one operand.
    Unary(Num, UnaryOp, Num),
    /// An operator between two numbers.
    Binary(Num, BinaryOp, Num, Num),
    /// The second operand if the first is truthy, otherwise the third.
    Select(Num, Num, Num, Num),
    /// A function of `Math`.
    Math(Num, math::MathFunction, Args),
    /// A function of `Math` over the elements of a list.
    MathOver(Num, math::MathFunction, Val),
    /// `+` of values.
    Plus(Val, Val, Val),
    /// A comparison of values.
    Compare(Num, BinaryOp, Val, Val),

    /// Binds a call of a function of the host.
    CallHost(Val, FunctionId, Args),
    /// Stores an element of a field.
    Store(FieldKey, u32, Num),
    /// Stores an element of a view, at a computed index.
    StoreAt(View, Num, Num),
    /// Stores a `ctx` variable.
    StoreGlobal(u32, Val),
    /// Stores a `ctx` variable of a computed name.
    StoreGlobalNamed(Val, Val),
    /// Stores one number in every element of a view.
    Fill(View, Num),

    /// Passes an argument in a register of the function that is called next.
    PassNumber(u32, Num),
    /// Passes a value to the function that is called next.
    PassValue(u32, Val),
    /// Calls a function of the same program.
    Call(UnitId),
    /// Takes the number that a call returned.
    TakeNumber(Num),
    /// Takes the value that a call returned.
    TakeValue(Val),
    /// A function of the text as a value, with its variables.
    Closure(Val, UnitId, Args),
    /// Calls a value that is a function.
    Invoke(Val, Val, Args),
    /// Calls a value that is a function, with the elements of a list.
    InvokeList(Val, Val, Val),
    /// A place that functions share, with a value.
    NewCell(Val, Val),
    /// A place that functions share, without a value.
    EmptyCell(Val),
    /// The value in a place that functions share.
    CellGet(Val, Val),
    /// Stores a variable in its cell; `true` if this executes its declaration.
    CellSet(Val, Val, bool),

    /// A list of values.
    List(Val, Args),
    /// Appends a value, or its elements if `true`.
    Append(Val, Val, bool),
    /// A record without entries.
    NewRecord(Val),
    /// Adds an entry, by its key, to a record.
    Put(Val, Val, Val),
    /// Adds all entries of one record to another.
    PutAll(Val, Val),
    /// An element of a value, by a key.
    Element(Val, Val, Val),
    /// An element of a value, by a number.
    ElementAt(Val, Val, Num),
    /// A member of a value, by its name.
    Member(Val, Val, u32),
    /// Stores an element; `true` if the object is certainly a record.
    StoreItem(Val, Val, Val, bool),
    /// Stores a member of a value, by its name.
    StoreMember(Val, u32, Val, bool),
    /// Calls a method; the receiver is the first argument.
    Method(Val, MethodId, Args),
    /// Calls a method with the elements of a list as arguments.
    MethodList(Val, MethodId, Val, Val),
    /// Calls a function that belongs to nothing.
    Native(Val, FreeFunctionId, Args),
    /// Calls a function that belongs to nothing, with the elements of a list.
    NativeList(Val, FreeFunctionId, Val),
    /// The array that belongs to the object with a computed name.
    Pick(Val, u32, Val),
    /// Reads the number that belongs to the object with a computed name.
    PickNumber(Num, u32, Val),

    // Of the machine alone: ways between the operations.
    /// Copies a number.
    Move(Num, Num),
    /// Copies a value.
    MoveValue(Val, Val),
    /// Computes several numbers at once.
    Formula(u32),
    /// Goes on at an operation.
    Jump(u32),
    /// Goes on at an operation where a number is true, or where it is false.
    JumpIf(bool, Num, u32),
    /// Jumps if the value is, or is not, `undefined` or `null`.
    JumpIfNothing(bool, Val, u32),
    /// Jumps back to the start of a loop; the second number is the cost of an iteration.
    Again(u32, u32),
    /// Returns.
    Return,
}

/// How an operation uses an operand.
pub enum OperandUse<'o> {
    /// A number that the operation writes.
    Gives(&'o mut Num),
    /// A value that the operation writes.
    GivesValue(&'o mut Val),
    /// A number that the operation reads.
    Reads(&'o mut Num),
    /// A value that the operation reads.
    ReadsValue(&'o mut Val),
    /// A list of numbers that the operation reads.
    ReadsAll(Args),
    /// A list of values that the operation reads.
    ReadsValues(Args),
}

#[inline]
fn each_use<const N: usize>(f: &mut impl FnMut(OperandUse<'_>), uses: [OperandUse<'_>; N]) {
    uses.into_iter().for_each(f);
}

impl Op {
    /// Calls `f` for every operand with its use. This complete table ensures that no operation is forgotten.
    pub fn each(&mut self, f: &mut impl FnMut(OperandUse<'_>)) {
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
    pub fn args_mut(&mut self) -> Option<&mut Args> {
        match self {
            Op::Math(_, _, args) | Op::CallHost(_, _, args) | Op::Closure(_, _, args) => Some(args),
            Op::Invoke(_, _, args) | Op::List(_, args) => Some(args),
            Op::Method(_, _, args) | Op::Native(_, _, args) => Some(args),
            _ => None,
        }
    }

    /// Whether it only computes a number from numbers.
    pub fn is_numeric(&self) -> bool {
        matches!(self, Op::Unary(..) | Op::Binary(..) | Op::Select(..) | Op::Math(..))
    }

    /// Whether it can be removed if its result is not used.
    pub fn is_pure(&self) -> bool {
        self.is_numeric()
            || matches!(self, Op::BoxNumber(..) | Op::BoxBoolean(..) | Op::Truthy(..) | Op::ToIndex(..))
            || matches!(self, Op::TypeOf(..) | Op::Length(..) | Op::Input(_) | Op::Global(..))
            || matches!(self, Op::Aggregate(..) | Op::TakeNumber(_) | Op::TakeValue(_))
    }

    /// Whether it may end the run with an error.
    pub fn may_fail(&self) -> bool {
        let loads = matches!(self, Op::Load(..) | Op::LoadAt(..) | Op::LoadValue(..) | Op::LoadValueAt(..));
        let passes = matches!(self, Op::PassNumber(..) | Op::PassValue(..) | Op::StoreGlobal(..));
        !(loads || passes || self.is_pure())
    }
}
