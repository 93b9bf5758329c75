//! Ctrl-C and SIGTERM: while there is nothing to save the first ends the program, later it ends the render on whole passes;
//! the second quits at once.

use crate::film::OutputFile;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::{flag, low_level};
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::{self, Thread};
use std::time::{Duration, Instant};

/// How soon a signal is noticed that ends the program.
const LOOK_AGAIN: Duration = Duration::from_millis(20);

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

    /// Does work: `patience` after a signal the program ends, without the unfinished `files`, unless there is something `worth`
    /// saving. Then the work is to end itself.
    pub fn expendable<T>(
        &self,
        files: &[&OutputFile],
        patience: Duration,
        worth: impl Fn() -> bool + Sync,
        work: impl FnOnce() -> T,
    ) -> T {
        let temporaries: Vec<&Path> = files.iter().filter_map(|file| file.temporary()).collect();
        let end_in_vain = || {
            if let Some(code) = self.exit_code().filter(|_| !worth()) {
                // Nobody could act on a failure here.
                temporaries.iter().for_each(|path| drop(std::fs::remove_file(path)));
                low_level::exit(code.into());
            }
        };
        let done = AtomicBool::new(false);
        let result = thread::scope(|scope| {
            let watcher = scope.spawn(|| {
                let mut came = None;
                while !done.load(Ordering::SeqCst) {
                    if self.exit_code().is_some() && came.get_or_insert_with(Instant::now).elapsed() >= patience {
                        end_in_vain();
                    }
                    thread::park_timeout(LOOK_AGAIN);
                }
            });
            let _leave = Leave { done: &done, watcher: watcher.thread() };
            work()
        });
        // Giving back the memory of a device and a film takes a second where they are large.
        end_in_vain();
        result
    }
}

/// Sends the watcher home, also when the work panics.
struct Leave<'a> {
    done: &'a AtomicBool,
    watcher: &'a Thread,
}

impl Drop for Leave<'_> {
    fn drop(&mut self) {
        self.done.store(true, Ordering::SeqCst);
        self.watcher.unpark();
    }
}
