//! What a page calls: it reserves memory for a packed module, writes it there, and reads the module where [`unpacked`] says.

use crate::{Head, unpack};
use core::arch::wasm32;

const PAGE: usize = 1 << 16;
const MEMORY: u32 = 0;

#[panic_handler]
fn stop(_: &core::panic::PanicInfo<'_>) -> ! {
    wasm32::unreachable()
}

/// Memory for `length` bytes that nothing else uses; traps where the page gives none.
#[unsafe(no_mangle)]
pub extern "C" fn reserved(length: usize) -> *mut u8 {
    let before = wasm32::memory_grow::<MEMORY>(length.div_ceil(PAGE));
    if before == usize::MAX {
        wasm32::unreachable();
    }
    (before * PAGE) as *mut u8
}

/// The size of the module that is packed in `length` bytes at an address of [`reserved`]; 0 if they are damaged.
///
/// # Safety
///
/// The bytes are those of one call of `reserved`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn size(packed: *const u8, length: usize) -> usize {
    // SAFETY: the page writes to this memory before the call, and nothing else does.
    let packed = unsafe { core::slice::from_raw_parts(packed, length) };
    Head::read(packed).map_or(0, |head| head.size)
}

/// The address of the module that is packed in `length` bytes at an address of [`reserved`]; 0 if they are damaged.
///
/// # Safety
///
/// The bytes are those of one call of `reserved`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unpacked(packed: *const u8, length: usize) -> *const u8 {
    // SAFETY: the page writes to this memory before the call, and nothing else does.
    let packed = unsafe { core::slice::from_raw_parts(packed, length) };
    let Ok(head) = Head::read(packed) else { return core::ptr::null() };
    let out = reserved(head.size);
    // SAFETY: the memory is new, of this size, and zero.
    let bytes = unsafe { core::slice::from_raw_parts_mut(out, head.size) };
    match unpack(packed, &head, bytes) {
        Ok(()) => out,
        Err(_) => core::ptr::null(),
    }
}
