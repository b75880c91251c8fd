//! Handles: numbers in the form of pointers, which the library looks up and never dereferences. No number is given out twice, so
//! that a freed handle is recognized, and so is one of another type.

use crate::arguments::check_pointer;
use crate::status::{Failure, Outcome, Status};
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::{
    Arc, Mutex, MutexGuard, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard, TryLockError,
};

/// The type of a handle in C.
pub(crate) trait Handle {
    /// The object that it denotes.
    type Object: Any + Send + Sync;
    /// Its name in messages.
    const NAME: &'static str;
}

struct Registry {
    last: usize,
    objects: BTreeMap<usize, Arc<dyn Any + Send + Sync>>,
}

static REGISTRY: RwLock<Registry> = RwLock::new(Registry { last: 0, objects: BTreeMap::new() });

/// The distance of two handles: they look like pointers to aligned objects.
const STRIDE: usize = 16;

/// The object of a handle.
pub(crate) fn find<H: Handle>(handle: *const H) -> Outcome<Arc<H::Object>> {
    if handle.is_null() {
        return Err(null(H::NAME));
    }
    let registry = REGISTRY.read().unwrap_or_else(PoisonError::into_inner);
    let object = registry.objects.get(&handle.addr()).cloned();
    drop(registry);
    object.and_then(|object| object.downcast().ok()).ok_or_else(|| no_handle(H::NAME))
}

/// Frees a handle. Its object is dropped when no call and no other object uses it any more. Does nothing for NULL.
pub(crate) fn free<H: Handle>(handle: *mut H) -> Outcome {
    if handle.is_null() {
        return Ok(());
    }
    let mut registry = REGISTRY.write().unwrap_or_else(PoisonError::into_inner);
    let object = match registry.objects.get(&handle.addr()) {
        Some(object) if object.is::<H::Object>() => registry.objects.remove(&handle.addr()),
        _ => None,
    };
    drop(registry);
    object.map(drop).ok_or_else(|| no_handle(H::NAME))
}

/// Where a call stores a new handle. It is NULL until the call succeeds.
pub(crate) struct NewHandle<H> {
    out: *mut *mut H,
}

impl<H: Handle> NewHandle<H> {
    /// # Safety
    /// `out` is NULL, or can be written.
    pub(crate) unsafe fn new(out: *mut *mut H) -> Outcome<NewHandle<H>> {
        check_pointer(out, "the pointer to the new handle")?;
        // SAFETY: the pointer is aligned and not NULL.
        unsafe { out.write(std::ptr::null_mut()) };
        Ok(NewHandle { out })
    }

    /// Gives the object a handle.
    pub(crate) fn set(self, object: H::Object) -> Outcome {
        let mut registry = REGISTRY.write().unwrap_or_else(PoisonError::into_inner);
        let next = registry.last.checked_add(STRIDE);
        let next = next.ok_or_else(|| Failure::argument("there are no more handles"))?;
        registry.last = next;
        registry.objects.insert(next, Arc::new(object));
        // SAFETY: checked when this was made.
        unsafe { self.out.write(std::ptr::without_provenance_mut(next)) };
        Ok(())
    }
}

/// An object for the time of a call that may change it.
pub(crate) fn lock<T>(object: &Mutex<T>) -> Outcome<MutexGuard<'_, T>> {
    object.try_lock().map_err(|e| locked(&e))
}

/// An object that several calls may read.
pub(crate) fn read<T>(object: &RwLock<T>) -> Outcome<RwLockReadGuard<'_, T>> {
    object.try_read().map_err(|e| locked(&e))
}

/// An object that several calls may read, for a call that changes it.
pub(crate) fn write<T>(object: &RwLock<T>) -> Outcome<RwLockWriteGuard<'_, T>> {
    object.try_write().map_err(|e| locked(&e))
}

fn locked<G>(e: &TryLockError<G>) -> Failure {
    match e {
        TryLockError::WouldBlock => {
            Failure::new(Status::LabspecErrorBusy, "busy", "another thread is using this object")
        }
        TryLockError::Poisoned(_) => {
            let message = "an earlier call failed inside the library: this object can only be freed";
            Failure::new(Status::LabspecErrorInternal, "internal", message)
        }
    }
}

fn null(what: &str) -> Failure {
    Failure::new(Status::LabspecErrorNull, "null", format!("the {what} is NULL"))
}

fn no_handle(what: &str) -> Failure {
    let message = format!("this is not the handle of a {what}: it was freed, or has another type");
    Failure::new(Status::LabspecErrorHandle, "unknown-handle", message)
}
