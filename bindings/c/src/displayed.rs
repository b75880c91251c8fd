//! The displayed values of a lab: traces of plots, then readouts.

use crate::arguments::{Buffer, VersionedStruct, c_string, check_pointer, store, write_struct};
use crate::lab::{LabHandle, with_lab};
use crate::report::item;
use crate::status::{Status, call};
use facade::player::{DisplayedIn, DisplayedValue};
use facade::run::Cell;
use std::ffi::{CString, c_char};

/// Where a value is displayed.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub enum DisplayedPlace {
    /// As a curve of a plot.
    LabspecDisplayedTrace = 0,
    /// As a readout.
    LabspecDisplayedReadout = 1,
}

/// A displayed value. Its texts are valid until the lab is freed.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct DisplayedDescription {
    /// sizeof(labspec_displayed), set by the caller.
    pub struct_size: usize,
    /// Its label.
    pub label: *const c_char,
    /// Its unit, or an empty text.
    pub unit: *const c_char,
    /// Where it is displayed.
    pub place: DisplayedPlace,
    /// The number of decimals of a readout.
    pub digits: u32,
    /// The plot of a trace, from 0.
    pub plot: usize,
}

// SAFETY: the size is the first field.
unsafe impl VersionedStruct for DisplayedDescription {
    const FIRST_SIZE: usize = std::mem::offset_of!(DisplayedDescription, plot) + size_of::<usize>();
    const NAME: &'static str = "labspec_displayed";
}

/// A displayed value with its texts for C.
pub(crate) struct DisplayedTexts {
    label: CString,
    unit: CString,
    place: DisplayedIn,
}

impl DisplayedTexts {
    pub(crate) fn new(value: &DisplayedValue) -> DisplayedTexts {
        DisplayedTexts { label: c_string(&value.label), unit: c_string(&value.unit), place: value.place }
    }

    fn describe(&self) -> DisplayedDescription {
        let (place, digits, plot) = match self.place {
            DisplayedIn::Plot(plot) => (DisplayedPlace::LabspecDisplayedTrace, 0, plot),
            DisplayedIn::Readout(digits) => (DisplayedPlace::LabspecDisplayedReadout, digits, 0),
        };
        DisplayedDescription {
            struct_size: 0,
            label: self.label.as_ptr(),
            unit: self.unit.as_ptr(),
            place,
            digits,
            plot,
        }
    }
}

/// The number of displayed values: traces of the plots, then readouts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_displayed_count(lab: *const LabHandle, count: *mut usize) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| with_lab(lab, |lab| unsafe { store(count, lab.displayed.len(), "the pointer to the count") }))
}

/// The displayed value with this index, from 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_displayed(
    lab: *const LabHandle,
    index: usize,
    displayed: *mut DisplayedDescription,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        with_lab(lab, |lab| {
            check_pointer(displayed, "the pointer to the displayed value")?;
            write_struct(displayed, &item(&lab.displayed, index, "displayed value")?.describe())
        })
    })
}

/// Copies the displayed values as numbers, in the order of labspec_lab_displayed(); NaN for values that are not numbers. `length`
/// receives their number in any case.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_numbers(
    lab: *const LabHandle,
    buffer: *mut f64,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        with_lab(lab, |lab| Buffer::new(buffer, capacity, length)?.write(lab.player.numbers()))
    })
}

/// Copies a displayed value as text: a readout as the page prints it, with its decimals, and a trace with all digits that
/// distinguish the number. `length` receives its length without the NUL, for which the buffer needs room as well.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_text(
    lab: *const LabHandle,
    index: usize,
    buffer: *mut c_char,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        with_lab(lab, |lab| {
            let place = item(&lab.displayed, index, "displayed value")?.place;
            let cell = item(lab.player.values(), index, "displayed value")?;
            let printed = match (place, cell) {
                (DisplayedIn::Plot(_), Cell::Number(x)) if x.is_finite() => x.to_string(),
                (DisplayedIn::Plot(_), cell) => cell.rounded(0),
                (DisplayedIn::Readout(digits), cell) => cell.rounded(digits),
            };
            Buffer::new(buffer, capacity, length)?.write_text(&printed)
        })
    })
}
