//! Statuses, and the last error of each thread. Every entry point runs inside [`call`], which turns failures and panics into a
//! status and a message.

use crate::arguments::c_string;
use crate::handles::NewHandle;
use crate::report::{CheckReport, FindingReport};
use facade::finding::Finding;
use labspec_core as core;
use std::any::Any;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The result of a call. After any other status than LABSPEC_OK, labspec_last_error() describes the reason, and nothing was
/// changed unless the function says so. Later versions may add statuses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Status {
    /// The call succeeded.
    LabspecOk = 0,
    /// A required pointer is NULL.
    LabspecErrorNull = 1,
    /// A handle was freed, has another type, or never came from this library.
    LabspecErrorHandle = 2,
    /// Another thread is using the handle.
    LabspecErrorBusy = 3,
    /// `struct_size` is smaller than the first version of the struct, or larger than 4096 bytes.
    LabspecErrorStructSize = 4,
    /// A pointer is not aligned for its type.
    LabspecErrorAlignment = 5,
    /// A text is not UTF-8.
    LabspecErrorText = 6,
    /// A buffer is too small. The needed length was returned, and the buffer was not written.
    LabspecErrorBuffer = 7,
    /// There is no item with this index.
    LabspecErrorIndex = 8,
    /// There is no field or object with this name.
    LabspecErrorName = 9,
    /// An argument is not valid, or the lab does not accept it.
    LabspecErrorArgument = 10,
    /// A list has the wrong length.
    LabspecErrorLength = 11,
    /// The field cannot be written: the engine computes it, or uses it as an index.
    LabspecErrorReadOnly = 12,
    /// A text has mistakes, or a program failed: labspec_last_error_report() lists them.
    LabspecErrorFindings = 13,
    /// The bytes are not a saved state or model, or the state belongs to another model or lab.
    LabspecErrorState = 14,
    /// A file or folder cannot be read.
    LabspecErrorFile = 15,
    /// The library failed. This is a bug; the handle of the call can only be freed.
    LabspecErrorInternal = 16,
}

/// Why a call failed.
#[derive(Debug)]
pub(crate) struct Failure {
    status: Status,
    /// The code of the first finding, or a word for the kind of the error.
    code: &'static str,
    message: String,
    findings: Vec<Finding>,
}

pub(crate) type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    pub(crate) fn new(status: Status, code: &'static str, message: impl Into<String>) -> Failure {
        Failure { status, code, message: message.into(), findings: Vec::new() }
    }

    pub(crate) fn argument(message: impl Into<String>) -> Failure {
        Failure::new(Status::LabspecErrorArgument, "call", message)
    }

    pub(crate) fn index(what: &str, index: usize, count: usize) -> Failure {
        let message = format!("the {what} {index} does not exist: there are {count}, counted from 0");
        Failure::new(Status::LabspecErrorIndex, "unknown-id", message)
    }

    pub(crate) fn file(path: &str, error: &std::io::Error) -> Failure {
        Failure::new(Status::LabspecErrorFile, "file", format!("cannot read {path}: {error}"))
    }

    pub(crate) fn from_findings(findings: Vec<Finding>, message: String) -> Failure {
        let code = findings.first().map_or("findings", |f| f.code);
        Failure { status: Status::LabspecErrorFindings, code, message, findings }
    }

    fn from_panic(panic: &(dyn Any + Send)) -> Failure {
        let text = panic.downcast_ref::<&str>().copied();
        let text =
            text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message");
        Failure::new(
            Status::LabspecErrorInternal,
            "internal",
            format!("the library failed, which is a bug: {text}"),
        )
    }
}

impl From<facade::Error> for Failure {
    fn from(e: facade::Error) -> Failure {
        let message = e.to_string();
        match e {
            facade::Error::Findings(findings) => Failure::from_findings(findings, message),
            facade::Error::Call(_) => Failure::argument(message),
        }
    }
}

impl From<core::Error> for Failure {
    fn from(e: core::Error) -> Failure {
        let message = e.to_string();
        if !e.diagnostics().is_empty() {
            return Failure::from_findings(e.diagnostics().to_vec(), message);
        }
        let (status, code) = match e {
            core::Error::File(_) => (Status::LabspecErrorFile, "file"),
            core::Error::ForeignData => (Status::LabspecErrorState, "foreign-data"),
            core::Error::NoName { .. } => (Status::LabspecErrorName, "unknown-name"),
            core::Error::NoId { .. } => (Status::LabspecErrorIndex, "unknown-id"),
            core::Error::NoField(_) => (Status::LabspecErrorName, "unknown-field"),
            core::Error::NotWritable(_) => (Status::LabspecErrorReadOnly, "read-only"),
            core::Error::Length { .. } => (Status::LabspecErrorLength, "wrong-length"),
            core::Error::Value { .. } => (Status::LabspecErrorArgument, "wrong-value"),
            core::Error::NotAModel => (Status::LabspecErrorState, "not-a-model"),
            core::Error::Restore(_) => (Status::LabspecErrorState, "not-a-state"),
            _ => (Status::LabspecErrorArgument, "call"),
        };
        Failure::new(status, code, message)
    }
}

/// The last error of a thread, as C reads it.
struct LastError {
    status: Status,
    code: CString,
    message: CString,
    findings: Vec<Finding>,
}

thread_local! {
    static LAST: RefCell<Option<LastError>> = const { RefCell::new(None) };
}

/// Runs a call; the error of the thread is then that of this call.
pub(crate) fn call(what: impl FnOnce() -> Outcome) -> Status {
    let status = call_keeping_error(what);
    if status == Status::LabspecOk {
        store(None);
    }
    status
}

/// Runs a call that reads the last error, which stays unless the call fails.
fn call_keeping_error(what: impl FnOnce() -> Outcome) -> Status {
    // An object whose call panicked stays locked (poisoned), so that its state is never seen again.
    let done = catch_unwind(AssertUnwindSafe(what));
    match done.unwrap_or_else(|panic| Err(Failure::from_panic(&*panic))) {
        Ok(()) => Status::LabspecOk,
        Err(failure) => {
            let status = failure.status;
            store(Some(failure));
            status
        }
    }
}

fn store(failure: Option<Failure>) {
    let last = failure.map(|f| LastError {
        status: f.status,
        code: c_string(f.code),
        message: c_string(&f.message),
        findings: f.findings,
    });
    // There is none while a thread ends.
    let _ = LAST.try_with(|cell| {
        if let Ok(mut cell) = cell.try_borrow_mut() {
            *cell = last;
        }
    });
}

/// A part of the last error; `None` if the last call of the thread succeeded.
fn read_last<T>(part: impl FnOnce(&LastError) -> T) -> Option<T> {
    LAST.try_with(|cell| cell.try_borrow().ok().and_then(|last| last.as_ref().map(part))).ok().flatten()
}

/// The message of the last call of this thread that failed; empty if the last call succeeded. Never NULL. Valid until the next
/// call of this thread, except for the functions labspec_last_error...().
#[unsafe(no_mangle)]
pub extern "C" fn labspec_last_error() -> *const c_char {
    read_last(|last| last.message.as_ptr()).unwrap_or(c"".as_ptr())
}

/// The length of labspec_last_error() in bytes, without the final NUL.
#[unsafe(no_mangle)]
pub extern "C" fn labspec_last_error_length() -> usize {
    read_last(|last| last.message.as_bytes().len()).unwrap_or(0)
}

/// The status of the last call of this thread.
#[unsafe(no_mangle)]
pub extern "C" fn labspec_last_error_status() -> Status {
    read_last(|last| last.status).unwrap_or(Status::LabspecOk)
}

/// The code of the last error: that of its first finding ("unknown-object"), or a word such as "wrong-length". Empty if the last
/// call succeeded. Never NULL. Valid as long as labspec_last_error().
#[unsafe(no_mangle)]
pub extern "C" fn labspec_last_error_code() -> *const c_char {
    read_last(|last| last.code.as_ptr()).unwrap_or(c"".as_ptr())
}

/// The findings of the last error as a new report, which may be empty. The error stays as it is if this call succeeds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_last_error_report(report: *mut *mut CheckReport) -> Status {
    call_keeping_error(|| {
        // SAFETY: the caller passes valid pointers.
        let out = unsafe { NewHandle::new(report) }?;
        let findings = read_last(|last| last.findings.clone()).unwrap_or_default();
        out.set(FindingReport::of_findings(&findings))
    })
}

/// The name of a status, such as "LABSPEC_ERROR_NULL"; "unknown status" for other numbers. Never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn labspec_status_name(status: i32) -> *const c_char {
    let name: &CStr = match status {
        0 => c"LABSPEC_OK",
        1 => c"LABSPEC_ERROR_NULL",
        2 => c"LABSPEC_ERROR_HANDLE",
        3 => c"LABSPEC_ERROR_BUSY",
        4 => c"LABSPEC_ERROR_STRUCT_SIZE",
        5 => c"LABSPEC_ERROR_ALIGNMENT",
        6 => c"LABSPEC_ERROR_TEXT",
        7 => c"LABSPEC_ERROR_BUFFER",
        8 => c"LABSPEC_ERROR_INDEX",
        9 => c"LABSPEC_ERROR_NAME",
        10 => c"LABSPEC_ERROR_ARGUMENT",
        11 => c"LABSPEC_ERROR_LENGTH",
        12 => c"LABSPEC_ERROR_READ_ONLY",
        13 => c"LABSPEC_ERROR_FINDINGS",
        14 => c"LABSPEC_ERROR_STATE",
        15 => c"LABSPEC_ERROR_FILE",
        16 => c"LABSPEC_ERROR_INTERNAL",
        _ => c"unknown status",
    };
    name.as_ptr()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_status_with_its_message() {
        assert_eq!(call(|| panic!("index {} is wrong", 3)), Status::LabspecErrorInternal);
        // SAFETY: the pointer is that of a text of this thread.
        let message = unsafe { CStr::from_ptr(labspec_last_error()) };
        assert_eq!(message, c"the library failed, which is a bug: index 3 is wrong");
        assert_eq!(labspec_last_error_length(), message.count_bytes());
        assert_eq!(call(|| Ok(())), Status::LabspecOk);
        assert_eq!(labspec_last_error_length(), 0);
    }

    #[test]
    fn each_thread_has_its_last_error() {
        call(|| Err(Failure::argument("here")));
        let other = std::thread::spawn(|| labspec_last_error_length()).join().unwrap();
        assert_eq!((labspec_last_error_length(), other), (4, 0));
    }
}
