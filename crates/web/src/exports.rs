//! The functions that a page calls. A request and its reply are JSON texts in one buffer of the
//! module: the page reserves the buffer, writes the request, calls [`call`], and reads the reply.

#![allow(unsafe_code)]

use std::cell::RefCell;

use crate::request;

thread_local! {
    /// The request before a call, and the reply after it.
    static BUFFER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Reserves a buffer for a request of this length (bytes), and returns its address.
#[unsafe(no_mangle)]
pub extern "C" fn reserve(length: usize) -> *mut u8 {
    BUFFER.with_borrow_mut(|buffer| {
        buffer.clear();
        buffer.resize(length, 0);
        buffer.as_mut_ptr()
    })
}

/// Answers the request in the buffer, and returns the length of the reply (bytes).
#[unsafe(no_mangle)]
pub extern "C" fn call() -> usize {
    let request = BUFFER.take();
    let reply = request::answer(&request).into_bytes();
    BUFFER.replace(reply);
    BUFFER.with_borrow(Vec::len)
}

/// Returns the address of the reply.
#[unsafe(no_mangle)]
pub extern "C" fn reply() -> *const u8 {
    BUFFER.with_borrow(Vec::as_ptr)
}
