//! A lab that is open: it is changed, played, read and saved.

use crate::arguments::{Buffer, check_pointer, list, store, text};
use crate::controls::ControlTexts;
use crate::displayed::DisplayedTexts;
use crate::fields;
use crate::handles::{self, Handle, NewHandle};
use crate::model::{ModelHandle, shared};
use crate::models::{GivenModels, ModelSource};
use crate::report::{CheckReport, FindingReport};
use crate::status::{Failure, Outcome, Status, call};
use facade::Player;
use facade::player::Saved;
use std::ffi::c_char;
use std::sync::Mutex;

/// A lab that is open: what a student can do to it on a page, and what the page shows.
pub struct LabHandle {
    _opaque: [u8; 0],
}

impl Handle for LabHandle {
    type Object = Mutex<OpenLab>;
    const NAME: &'static str = "labspec_lab";
}

/// A state of a lab.
pub struct LabState {
    _opaque: [u8; 0],
}

impl Handle for LabState {
    type Object = Mutex<Saved>;
    const NAME: &'static str = "labspec_lab_state";
}

/// A lab with its texts for C.
pub(crate) struct OpenLab {
    pub(crate) player: Player,
    pub(crate) controls: Vec<ControlTexts>,
    pub(crate) displayed: Vec<DisplayedTexts>,
}

impl OpenLab {
    fn new(player: Player) -> Mutex<OpenLab> {
        let controls = player.controls().iter().map(ControlTexts::new).collect();
        let displayed = player.displayed().iter().map(DisplayedTexts::new).collect();
        Mutex::new(OpenLab { player, controls, displayed })
    }
}

/// Calls a function with a lab.
pub(crate) fn with_lab(lab: *const LabHandle, what: impl FnOnce(&mut OpenLab) -> Outcome) -> Outcome {
    let lab = handles::find(lab)?;
    what(&mut *handles::lock(&lab)?)
}

/// The maximum number of steps of one call.
const MAX_STEPS: usize = 100_000_000;

/// Opens a lab from its JSON. `models` has the model that it names; NULL for a lab with an inline model. A lab whose code has
/// mistakes opens, as on a page: labspec_lab_findings() lists them. Mistakes in its JSON or its model are
/// LABSPEC_ERROR_FINDINGS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_open(
    json: *const c_char,
    models: *const ModelSource,
    lab: *mut *mut LabHandle,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let out = NewHandle::new(lab)?;
        let json = text(json, "the JSON")?;
        out.set(OpenLab::new(Player::of_lab(json, GivenModels::read(models)?.open()?)?))
    })
}

/// Opens a lab of a lesson by its address: "#2" is the second lab, "#quiz-id.1" that of a question. The extension of `path`
/// determines the format, Markdown or JSON; the file is not opened.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_open_lesson(
    path: *const c_char,
    lesson: *const c_char,
    address: *const c_char,
    models: *const ModelSource,
    lab: *mut *mut LabHandle,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let out = NewHandle::new(lab)?;
        let (path, lesson) = (text(path, "the path")?, text(lesson, "the lesson")?);
        let address = text(address, "the address")?;
        let models = GivenModels::read(models)?.open()?;
        out.set(OpenLab::new(Player::of_lesson(path, lesson, address, models)?))
    })
}

/// Frees a lab. Texts of its controls and displayed values are no longer valid; its states, reports and models stay. Does
/// nothing for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_free(lab: *mut LabHandle) -> Status {
    call(|| handles::free(lab))
}

/// Performs at most `steps` steps (100,000,000 in one call), whether or not the lab has reached its `stopAt`. After an error of
/// its programs the lab is frozen until it is reset; steps before it stay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_step(lab: *mut LabHandle, steps: usize) -> Status {
    call(|| {
        with_lab(lab, |lab| {
            check_steps(steps)?;
            (0..steps).try_for_each(|_| lab.player.step().map_err(Failure::from))
        })
    })
}

fn check_steps(steps: usize) -> Outcome {
    if steps > MAX_STEPS {
        let message = format!("{steps} steps are too many for one call; the limit is {MAX_STEPS}");
        return Err(Failure::argument(message));
    }
    Ok(())
}

/// Plays until a time, s, or until the lab stops by itself. `steps` receives the number of steps, or is NULL. A time in the past
/// is no step. If the lab freezes, the steps before it stay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_play_to(lab: *mut LabHandle, time: f64, steps: *mut usize) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        with_lab(lab, |lab| {
            if !steps.is_null() {
                check_pointer(steps, "the pointer to the number of steps")?;
            }
            let done = lab.player.play_to(time)?;
            if steps.is_null() { Ok(()) } else { store(steps, done, "the pointer to the number of steps") }
        })
    })
}

/// Resets the lab like the button of the page: controls and model keep their values. A frozen lab plays again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_reset(lab: *mut LabHandle) -> Status {
    call(|| {
        with_lab(lab, |lab| {
            lab.player.reset();
            Ok(())
        })
    })
}

/// The simulated time, s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_time(lab: *const LabHandle, time: *mut f64) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| with_lab(lab, |lab| unsafe { store(time, lab.player.time(), "the pointer to the time") }))
}

/// The length of a step, s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_timestep(lab: *const LabHandle, timestep: *mut f64) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| {
        with_lab(lab, |lab| unsafe { store(timestep, lab.player.timestep(), "the pointer to the timestep") })
    })
}

/// 1 if the lab does not continue without a reset: it reached its `stopAt`, or it is frozen. Otherwise 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_is_over(lab: *const LabHandle, is_over: *mut i32) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| {
        with_lab(lab, |lab| unsafe {
            store(is_over, i32::from(lab.player.is_over()), "the pointer to the result")
        })
    })
}

/// Sets the force and the torque at the centre of mass of a body: six numbers in world axes, N and N m. They act until they are
/// set again or the lab is reset.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_apply_force(
    lab: *mut LabHandle,
    body: usize,
    force: *const f64,
    count: usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let force = list(force, count, "the force");
        with_lab(lab, |lab| {
            let force = force?.try_into().map_err(|_| {
                let message = format!("a force with its torque has six numbers, not {count}");
                Failure::new(Status::LabspecErrorLength, "wrong-length", message)
            })?;
            Ok(lab.player.apply_force(body, force)?)
        })
    })
}

/// Performs `steps` steps, and copies a row for the start and for every step: the time, then the displayed values as numbers. The
/// recording ends early if the lab is over. `length` receives the number of elements that were written. If the buffer is too
/// small for all rows, `length` receives their number of elements, and no step is made.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_record(
    lab: *mut LabHandle,
    steps: usize,
    buffer: *mut f64,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let buffer = Buffer::new(buffer, capacity, length);
        with_lab(lab, |lab| {
            check_steps(steps)?;
            let width = lab.displayed.len() + 1;
            let size = (steps + 1).checked_mul(width);
            let size = size.ok_or_else(|| Failure::argument("these steps are too many to record"))?;
            let buffer = buffer?.reserve(size)?;
            if buffer.is_absent() {
                return Ok(());
            }
            let mut rows = Vec::new();
            for step in 0..=steps {
                if step > 0 {
                    if lab.player.is_over() {
                        break;
                    }
                    lab.player.step()?;
                }
                rows.push(lab.player.time());
                rows.extend_from_slice(lab.player.numbers());
            }
            buffer.write(&rows)
        })
    })
}

/// Copies a field of the data ("qpos") or of the model as the lab changed it ("body_mass", "opt.gravity"), like
/// labspec_model_read(). All fields of the data are those of the current state, as after mj_forward.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_read(
    lab: *const LabHandle,
    field: *const c_char,
    buffer: *mut f64,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let name = text(field, "the name of the field");
        with_lab(lab, |lab| {
            let (field, buffer) = (fields::by_name(name?)?, Buffer::new(buffer, capacity, length)?);
            let (model, scene) = lab.player.model_and_scene()?;
            fields::copy(labspec_core::view(model, scene, field)?, buffer)
        })
    })
}

/// A copy of the model with the changes of controls and programs, as a new handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_model(lab: *const LabHandle, model: *mut *mut ModelHandle) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let out = NewHandle::new(model)?;
        with_lab(lab, |lab| out.set(shared(lab.player.model().clone())))
    })
}

/// The findings of opening the lab and of its run so far, as a new report.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_findings(
    lab: *const LabHandle,
    report: *mut *mut CheckReport,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let out = NewHandle::new(report)?;
        with_lab(lab, |lab| out.set(FindingReport::of_findings(&lab.player.findings())))
    })
}

/// The state of the lab, with its model and the values of its controls, as a new handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_save(lab: *const LabHandle, state: *mut *mut LabState) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let out = NewHandle::new(state)?;
        with_lab(lab, |lab| out.set(Mutex::new(lab.player.save())))
    })
}

/// Restores a state of this lab. It then continues with equal results, bit for bit. A state can be restored any number of times.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_restore(lab: *mut LabHandle, state: *const LabState) -> Status {
    call(|| {
        with_lab(lab, |lab| {
            let state = handles::find(state)?;
            let state = handles::lock(&state)?;
            lab.player
                .restore(&state)
                .map_err(|e| Failure::new(Status::LabspecErrorState, "foreign-state", e.to_string()))
        })
    })
}

/// Frees a state. Does nothing for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_lab_state_free(state: *mut LabState) -> Status {
    call(|| handles::free(state))
}
