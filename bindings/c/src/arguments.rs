//! Arguments from C: texts, lists, buffers and structs are checked as far as a pointer can be checked.

use crate::status::{Failure, Outcome, Status};
use std::ffi::{CStr, CString, c_char};

/// The largest `struct_size` that is taken for a size and not for memory without a value.
const MAX_STRUCT: usize = 4096;

/// Checks that a pointer is not NULL and aligned.
pub(crate) fn check_pointer<T>(pointer: *const T, what: &str) -> Outcome {
    if pointer.is_null() {
        return Err(Failure::new(Status::LabspecErrorNull, "null", format!("{what} is NULL")));
    }
    if !pointer.is_aligned() {
        let message = format!("{what} is not aligned to {} bytes", align_of::<T>());
        return Err(Failure::new(Status::LabspecErrorAlignment, "alignment", message));
    }
    Ok(())
}

/// A text.
///
/// # Safety
/// `text` is NULL, or ends in a NUL and stays as it is during the call.
pub(crate) unsafe fn text<'a>(text: *const c_char, what: &str) -> Outcome<&'a str> {
    check_pointer(text, what)?;
    // SAFETY: the caller passes a text with its NUL.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|e| {
        let message = format!("{what} is not UTF-8 at byte {}", e.valid_up_to());
        Failure::new(Status::LabspecErrorText, "not-utf8", message)
    })
}

/// A list; it may be NULL if it is empty.
///
/// # Safety
/// `list` is NULL, or has `count` elements that stay as they are during the call.
pub(crate) unsafe fn list<'a, T>(list: *const T, count: usize, what: &str) -> Outcome<&'a [T]> {
    if count == 0 {
        return Ok(&[]);
    }
    check_pointer(list, what)?;
    check_count::<T>(count, what)?;
    // SAFETY: the pointer is aligned and not NULL, the list fits into memory, and the caller passes its count.
    Ok(unsafe { std::slice::from_raw_parts(list, count) })
}

/// A list longer than the address space is a wrong count.
fn check_count<T>(count: usize, what: &str) -> Outcome {
    match count.checked_mul(size_of::<T>()) {
        Some(bytes) if bytes <= isize::MAX as usize => Ok(()),
        _ => Err(Failure::new(
            Status::LabspecErrorLength,
            "wrong-length",
            format!("{what} cannot have {count} elements"),
        )),
    }
}

/// Stores a result.
///
/// # Safety
/// `out` is NULL, or can be written.
pub(crate) unsafe fn store<T>(out: *mut T, value: T, what: &str) -> Outcome {
    check_pointer(out, what)?;
    // SAFETY: the pointer is aligned and not NULL.
    unsafe { out.write(value) };
    Ok(())
}

/// A buffer of the caller, which receives a list whose length is not known before.
pub(crate) struct Buffer<T> {
    buffer: *mut T,
    capacity: usize,
    length: *mut usize,
}

impl<T: Copy> Buffer<T> {
    /// Without a buffer (NULL, and the capacity 0) only the length is asked for. `length` may be NULL if there is a buffer.
    ///
    /// # Safety
    /// Each pointer is NULL or can be written, the buffer for `capacity` elements.
    pub(crate) unsafe fn new(buffer: *mut T, capacity: usize, length: *mut usize) -> Outcome<Buffer<T>> {
        if capacity > 0 {
            check_pointer(buffer, "the buffer")?;
        }
        if buffer.is_null() || !length.is_null() {
            check_pointer(length, "the pointer to the length")?;
        }
        Ok(Buffer { buffer, capacity, length })
    }

    /// Writes `needed` elements by `fill`; returns the length in any case, which is `length`.
    fn write_with(self, length: usize, needed: usize, fill: impl FnOnce(*mut T)) -> Outcome {
        if !self.length.is_null() {
            // SAFETY: checked when this was made.
            unsafe { self.length.write(length) };
        }
        if self.buffer.is_null() {
            return Ok(());
        }
        if self.capacity < needed {
            let message = format!("the buffer has {} elements, and {needed} are needed", self.capacity);
            return Err(Failure::new(Status::LabspecErrorBuffer, "buffer", message));
        }
        fill(self.buffer);
        Ok(())
    }

    /// Copies a list.
    pub(crate) fn write(self, list: &[T]) -> Outcome {
        self.write_each(list.len(), |i| list.get(i).copied())
    }

    /// Writes `count` elements, which `element` returns.
    pub(crate) fn write_each(self, count: usize, element: impl Fn(usize) -> Option<T>) -> Outcome {
        self.write_with(count, count, |buffer| {
            for (i, x) in (0..count).map_while(|i| element(i).map(|x| (i, x))) {
                // SAFETY: the buffer has room for `count` elements.
                unsafe { buffer.add(i).write(x) };
            }
        })
    }

    /// Whether `count` elements can be written; otherwise the length is returned to the caller with the error.
    pub(crate) fn reserve(self, count: usize) -> Outcome<Buffer<T>> {
        let Buffer { buffer, capacity, length } = self;
        self.write_with(count, count, |_| ())?;
        Ok(Buffer { buffer, capacity, length })
    }

    /// Whether only the length is asked for.
    pub(crate) fn is_absent(&self) -> bool {
        self.buffer.is_null()
    }
}

impl Buffer<c_char> {
    /// Copies a text with its NUL. The length does not count the NUL.
    pub(crate) fn write_text(self, text: &str) -> Outcome {
        let text = c_string(text);
        let bytes = text.as_bytes_with_nul();
        self.write_with(bytes.len() - 1, bytes.len(), |buffer| {
            // SAFETY: the buffer has room for all bytes; it belongs to the caller, the text does not.
            unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr().cast(), buffer, bytes.len()) };
        })
    }
}

/// A struct of the header whose first field is its size in bytes. New fields are added at its end.
///
/// # Safety
/// The type is `repr(C)`, and its first field is a `usize`, the size.
pub(crate) unsafe trait VersionedStruct: Copy {
    /// Where its last field ended in the first version of the library: a smaller struct is an error.
    const FIRST_SIZE: usize;
    /// Its name in C.
    const NAME: &'static str;
}

/// A struct of which every field is a number or a pointer, so that zeros are valid: the caller passes it.
///
/// # Safety
/// All bytes may be zero.
pub(crate) unsafe trait InputStruct: VersionedStruct {}

/// The size that the caller states.
unsafe fn struct_size<T: VersionedStruct>(pointer: *const T) -> Outcome<usize> {
    check_pointer(pointer, T::NAME)?;
    // SAFETY: the pointer is aligned and not NULL, and the first field is the size.
    let size = unsafe { pointer.cast::<usize>().read() };
    if (T::FIRST_SIZE..=MAX_STRUCT).contains(&size) {
        return Ok(size);
    }
    let message = format!(
        "`struct_size` of {} is {size}: set it to sizeof({}), which is at least {}",
        T::NAME,
        T::NAME,
        T::FIRST_SIZE
    );
    Err(Failure::new(Status::LabspecErrorStructSize, "struct-size", message))
}

/// Copies a struct of the caller. Fields that its version does not have are zero; fields that are newer than the library are
/// ignored.
///
/// # Safety
/// `pointer` is NULL, or a struct of the size that it states.
pub(crate) unsafe fn read_struct<T: InputStruct>(pointer: *const T) -> Outcome<T> {
    // SAFETY: as above.
    let size = unsafe { struct_size(pointer) }?.min(size_of::<T>());
    let mut copy = std::mem::MaybeUninit::<T>::zeroed();
    // SAFETY: both have at least `size` bytes, and zeros are a valid value.
    unsafe {
        std::ptr::copy_nonoverlapping(pointer.cast::<u8>(), copy.as_mut_ptr().cast::<u8>(), size);
        Ok(copy.assume_init())
    }
}

/// Fills a struct of the caller, as far as it reaches. Its `struct_size` stays.
///
/// # Safety
/// `pointer` is NULL, or a struct of the size that it states.
pub(crate) unsafe fn write_struct<T: VersionedStruct>(pointer: *mut T, value: &T) -> Outcome {
    // SAFETY: as above.
    let size = unsafe { struct_size(pointer) }?.min(size_of::<T>());
    let first = size_of::<usize>();
    let from = std::ptr::from_ref(value).cast::<u8>();
    // SAFETY: both have at least `size` bytes; the struct belongs to the caller, the value does not.
    unsafe { std::ptr::copy_nonoverlapping(from.add(first), pointer.cast::<u8>().add(first), size - first) };
    Ok(())
}

/// A text for C: a NUL inside becomes the replacement character.
pub(crate) fn c_string(text: &str) -> CString {
    CString::new(text).or_else(|_| CString::new(text.replace('\0', "\u{fffd}"))).unwrap_or_default()
}

/// A text for C that may be missing: then NULL.
pub(crate) fn pointer_to(text: Option<&CStr>) -> *const c_char {
    text.map_or(std::ptr::null(), CStr::as_ptr)
}
