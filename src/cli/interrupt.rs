//! Ctrl-C and SIGTERM: the first ends the render on a whole pass, the second quits at once.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Listens for signals from its creation on.
pub struct Interrupt {
    signal: Arc<AtomicUsize>,
}

impl Interrupt {
    pub fn listen() -> io::Result<Self> {
        let armed = Arc::new(AtomicBool::new(false));
        let number = Arc::new(AtomicUsize::new(0));
        for signal in [SIGINT, SIGTERM] {
            // In this order: the first signal finds `armed` unset and sets it, the second one quits.
            flag::register_conditional_shutdown(signal, 128 + signal, armed.clone())?;
            flag::register(signal, armed.clone())?;
            flag::register_usize(signal, number.clone(), signal as usize)?;
        }
        Ok(Self { signal: number })
    }

    /// Exit code of the signal that has come: 130 for Ctrl-C, 143 for SIGTERM.
    pub fn exit_code(&self) -> Option<u8> {
        match self.signal.load(Ordering::SeqCst) {
            0 => None,
            signal => Some(128 + signal as u8),
        }
    }
}
