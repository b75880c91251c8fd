//! The controls of a lab: sliders, selects and buttons.

use crate::arguments::{Buffer, VersionedStruct, c_string, check_pointer, store, text, write_struct};
use crate::lab::{LabHandle, with_lab};
use crate::report::item;
use crate::status::{Failure, Outcome, Status, call};
use facade::Value;
use facade::player::ControlKind as Kind;
use std::ffi::{CString, c_char};

/// The kind of a control.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub enum ControlKind {
    /// A number from `min` to `max`, in steps.
    LabspecControlSlider = 0,
    /// One of several options.
    LabspecControlSelect = 1,
    /// A button, which runs statements when it is pressed.
    LabspecControlButton = 2,
}

/// A control. Its texts are valid until the lab is freed.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ControlDescription {
    /// sizeof(labspec_control), set by the caller.
    pub struct_size: usize,
    /// Its label, by which functions denote it.
    pub label: *const c_char,
    /// Its kind.
    pub kind: ControlKind,
    /// The number of decimals of a slider.
    pub digits: u32,
    /// The unit of a slider, or an empty text.
    pub unit: *const c_char,
    /// The lower end of a slider.
    pub min: f64,
    /// The upper end of a slider.
    pub max: f64,
    /// The step of a slider.
    pub step: f64,
    /// The value at the start as a number; NaN if it is not a number.
    pub start: f64,
    /// The number of options of a select.
    pub option_count: usize,
}

// SAFETY: the size is the first field.
unsafe impl VersionedStruct for ControlDescription {
    const FIRST_SIZE: usize = std::mem::offset_of!(ControlDescription, option_count) + size_of::<usize>();
    const NAME: &'static str = "labspec_control";
}

/// A control with its texts for C.
pub(crate) struct ControlTexts {
    label: CString,
    unit: CString,
    kind: Kind,
    start: f64,
    options: Vec<CString>,
}

impl ControlTexts {
    pub(crate) fn new(control: &facade::player::Control) -> ControlTexts {
        let (unit, options) = match &control.kind {
            Kind::Slider { unit, .. } => (unit.as_str(), Vec::new()),
            Kind::Select { options } => ("", options.iter().map(|(text, _)| c_string(text)).collect()),
            Kind::Button => ("", Vec::new()),
        };
        ControlTexts {
            label: c_string(&control.label),
            unit: c_string(unit),
            kind: control.kind.clone(),
            start: number(&control.start),
            options,
        }
    }

    fn describe(&self) -> ControlDescription {
        let (kind, [min, max, step], digits) = match &self.kind {
            Kind::Slider { min, max, step, digits, .. } => {
                (ControlKind::LabspecControlSlider, [*min, *max, *step], *digits)
            }
            Kind::Select { .. } => (ControlKind::LabspecControlSelect, [f64::NAN; 3], 0),
            Kind::Button => (ControlKind::LabspecControlButton, [f64::NAN; 3], 0),
        };
        ControlDescription {
            struct_size: 0,
            label: self.label.as_ptr(),
            kind,
            digits,
            unit: self.unit.as_ptr(),
            min,
            max,
            step,
            start: self.start,
            option_count: self.options.len(),
        }
    }
}

/// A number or a boolean as a number; NaN for other values.
fn number(value: &Value) -> f64 {
    match value {
        Value::Number(x) => *x,
        Value::Boolean(b) => f64::from(u8::from(*b)),
        _ => f64::NAN,
    }
}

/// The number of controls.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_control_count(lab: *const LabHandle, count: *mut usize) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| with_lab(lab, |lab| unsafe { store(count, lab.controls.len(), "the pointer to the count") }))
}

/// The control with this index, from 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_control(
    lab: *const LabHandle,
    index: usize,
    control: *mut ControlDescription,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        with_lab(lab, |lab| {
            check_pointer(control, "the pointer to the control")?;
            write_struct(control, &item(&lab.controls, index, "control")?.describe())
        })
    })
}

/// The displayed text of an option of a select. Valid until the lab is freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_control_option(
    lab: *const LabHandle,
    index: usize,
    option: usize,
    displayed: *mut *const c_char,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        with_lab(lab, |lab| {
            let options = &item(&lab.controls, index, "control")?.options;
            store(displayed, item(options, option, "option")?.as_ptr(), "the pointer to the text")
        })
    })
}

/// The current value of a control as a number; true is 1. NaN for a text, and for a button.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_control_number(
    lab: *const LabHandle,
    label: *const c_char,
    value: *mut f64,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let label = text(label, "the label");
        with_lab(lab, |lab| {
            store(value, number(current_value(&lab.player, label?)?), "the pointer to the value")
        })
    })
}

/// Copies the current value of a control as a text. For a select this is the value of the option, which may differ from its
/// displayed text. `length` receives its length without the NUL, for which the buffer needs room as well.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_control_text(
    lab: *const LabHandle,
    label: *const c_char,
    buffer: *mut c_char,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let label = text(label, "the label");
        with_lab(lab, |lab| {
            let value = current_value(&lab.player, label?)?.to_string();
            Buffer::new(buffer, capacity, length)?.write_text(&value)
        })
    })
}

fn current_value<'l>(player: &'l facade::Player, label: &str) -> Outcome<&'l Value> {
    player.value(label).ok_or_else(|| {
        let labels = player.controls().iter().map(|c| c.label.as_str());
        let similar = labspec_finding::nearest(label, labels);
        let help = similar.map_or(String::new(), |label| format!("; did you mean \"{label}\"?"));
        let message = format!("the lab has no control \"{label}\"{help}");
        Failure::new(Status::LabspecErrorName, "unknown-control", message)
    })
}

/// Moves a slider, or selects the option with this number as its value. The number must be one that a student can choose.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_set_number(
    lab: *mut LabHandle,
    label: *const c_char,
    value: f64,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe { set(lab, text(label, "the label"), Ok(Value::Number(value))) })
}

/// Selects the option with this value or this displayed text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_set_text(
    lab: *mut LabHandle,
    label: *const c_char,
    value: *const c_char,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        set(lab, text(label, "the label"), text(value, "the value").map(|t| Value::String(t.into())))
    })
}

/// Selects the option whose value is true (any number but 0) or false (0).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_set_boolean(
    lab: *mut LabHandle,
    label: *const c_char,
    value: i32,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe { set(lab, text(label, "the label"), Ok(Value::Boolean(value != 0))) })
}

fn set(lab: *mut LabHandle, label: Outcome<&str>, value: Outcome<Value>) -> Outcome {
    with_lab(lab, |lab| {
        let (label, value) = (label?, value?);
        current_value(&lab.player, label)?;
        Ok(lab.player.set(label, value)?)
    })
}

/// Presses a button.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_press(lab: *mut LabHandle, label: *const c_char) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let label = text(label, "the label");
        with_lab(lab, |lab| {
            let label = label?;
            current_value(&lab.player, label)?;
            Ok(lab.player.press(label)?)
        })
    })
}
