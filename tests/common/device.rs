//! The device that tests run on, with the validation layers listening.
#![allow(dead_code, reason = "each test binary uses its own part")]

use gonio::render::RenderError;
use gonio::render::vulkan::{Context, DeviceChoice, Messages};
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// Something made with validation on; when it goes, any message of the layers fails the test.
pub struct Validated<T> {
    inner: Option<T>,
    messages: Arc<Messages>,
}

impl<T> Validated<T> {
    pub fn new(inner: T, messages: Arc<Messages>) -> Self {
        Self { inner: Some(inner), messages }
    }
}

impl<T> Deref for Validated<T> {
    type Target = T;
    fn deref(&self) -> &T {
        self.inner.as_ref().expect("present until dropped")
    }
}

impl<T> DerefMut for Validated<T> {
    fn deref_mut(&mut self) -> &mut T {
        self.inner.as_mut().expect("present until dropped")
    }
}

impl<T> Drop for Validated<T> {
    fn drop(&mut self) {
        drop(self.inner.take()); // destroying may have something to complain about as well
        let messages = self.messages.take();
        if !std::thread::panicking() {
            assert!(messages.is_empty(), "the validation layers said: {messages:#?}");
        }
    }
}

/// The best device of this machine. `None`, with a line that says so, if there is none, unless
/// `GONIO_REQUIRE_DEVICE=1` asks for a failure.
pub fn context() -> Option<Validated<Context>> {
    match Context::new(&DeviceChoice::Auto, true) {
        Ok(context) => {
            let messages = context.messages();
            Some(Validated::new(context, messages))
        }
        Err(RenderError::NoDevice(reason)) => {
            skip(&reason, is_required());
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// True if the environment asks for tests to fail where there is no device.
pub fn is_required() -> bool {
    is_set("GONIO_REQUIRE_DEVICE")
}

/// True if the environment asks for the validation layers; tests listen to them anyway where they are installed.
pub fn is_validation_required() -> bool {
    is_set("GONIO_VALIDATION")
}

fn is_set(name: &str) -> bool {
    std::env::var_os(name).is_some_and(|value| value == "1")
}

/// Says that a test is skipped; fails it if a device is required.
pub fn skip(reason: &str, required: bool) {
    assert!(!required, "GONIO_REQUIRE_DEVICE=1, but: {reason}");
    println!("SKIPPED: no Vulkan device ({reason})");
}
