//! Whether standard output was closed when the program began. Rust opens `/dev/null` in its place before `main`, so that
//! whatever is printed would be lost without an error.

use std::io;

/// An error if standard output was closed.
pub fn check() -> io::Result<()> {
    match is_closed() {
        true => Err(io::Error::other("it is closed")),
        false => Ok(()),
    }
}

#[cfg(target_os = "linux")]
fn is_closed() -> bool {
    linux::CLOSED.load(std::sync::atomic::Ordering::Relaxed)
}

#[cfg(not(target_os = "linux"))]
fn is_closed() -> bool {
    false
}

#[cfg(target_os = "linux")]
mod linux {
    use std::sync::atomic::{AtomicBool, Ordering};

    pub static CLOSED: AtomicBool = AtomicBool::new(false);

    // SAFETY: what stands in this section is called once, before `main`, as a C function without arguments that are needed.
    #[unsafe(link_section = ".init_array")]
    #[used]
    static LOOK: extern "C" fn() = look;

    /// Asks for the flags of file descriptor 1, which only one that is open has. Nothing here needs Rust's runtime.
    extern "C" fn look() {
        let is_open = rustix::io::fcntl_getfd(rustix::stdio::stdout()).is_ok();
        CLOSED.store(!is_open, Ordering::Relaxed);
    }
}
