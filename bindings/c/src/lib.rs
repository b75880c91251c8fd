//! labspec for C: labs, models and checks of lessons.
//!
//! A thin layer over `labspec::Player`, `labspec::Checker` and the engine. Each entry point runs inside [`status::call`]: it
//! returns a status, never panics, and leaves a message for `labspec_last_error`. Handles are looked up in a registry
//! ([`handles`]), so that one that was freed or has another type is an error. The header `include/labspec.h` is generated from
//! these files by a test.
//!
//! The contract of the header, on which every `unsafe` block relies: a pointer is NULL, or what the function says: a text that
//! ends in a NUL, a list or a buffer of the stated length, a struct of the size that it states, a variable for the result.
#![expect(
    clippy::missing_safety_doc,
    reason = "the contract of all functions is above, and in the preamble of the header"
)]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::panic, reason = "tests may fail"))]

// In the order of the header.
pub mod status;

pub mod models;

pub mod lab;

pub mod controls;

pub mod displayed;

pub mod model;

pub mod data;

pub mod geometry;

pub mod fields;

pub mod report;

mod arguments;
mod handles;

use std::ffi::c_char;

/// The version of the functions and structs of this header. Functions, statuses, and fields at the end of structs are added
/// without a new version.
pub const ABI_VERSION: u32 = 1;

/// The version of the functions and structs of the library that is loaded: compare it with LABSPEC_ABI_VERSION.
#[unsafe(no_mangle)]
pub extern "C" fn labspec_abi_version() -> u32 {
    ABI_VERSION
}

/// The version of the library as a text. Never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn labspec_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}
