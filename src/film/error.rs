//! What can go wrong with films and images, each with the exit code it leads to.

use crate::memory::{self, Shortage};
use std::io;
use std::path::Path;

/// Errors of reading, writing and merging.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// The command line asks for what does not exist.
    #[error("{0}")]
    Usage(String),
    /// The file's content is wrong, or does not go with another's.
    #[error("{file}: {message}")]
    Bad { file: String, message: String },
    /// The file cannot be read or written.
    #[error("cannot {action} {file}: {source}")]
    Io {
        /// "read" or "write".
        action: &'static str,
        file: String,
        source: io::Error,
    },
    /// It takes more memory than there is.
    #[error("{file}: {short}")]
    Memory { file: String, short: Shortage },
}

impl FilmError {
    /// Exit code of the program: 2 usage, 65 bad content, 74 cannot read or write, 75 out of memory.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Bad { .. } => 65,
            Self::Io { .. } => 74,
            Self::Memory { .. } => 75,
        }
    }

    pub(crate) fn bad(file: &Path, message: impl Into<String>) -> Self {
        Self::Bad { file: input_name(file), message: message.into() }
    }

    /// An error unless there is memory for `bytes` bytes of `what` that the file holds.
    pub(crate) fn claim(file: &Path, what: &str, bytes: u64) -> Result<(), Self> {
        memory::check(what, bytes).map_err(|short| Self::short(file, short))
    }

    pub(crate) fn short(file: &Path, short: Shortage) -> Self {
        Self::Memory { file: input_name(file), short }
    }

    pub(crate) fn read(file: &Path, source: io::Error) -> Self {
        Self::Io { action: "read", file: input_name(file), source }
    }

    pub(crate) fn write(file: &Path, source: io::Error) -> Self {
        Self::Io { action: "write", file: output_name(file), source }
    }
}

/// `-` is a stream in messages, not a file.
fn input_name(file: &Path) -> String {
    if file == Path::new("-") { "standard input".into() } else { file.display().to_string() }
}

fn output_name(file: &Path) -> String {
    if file == Path::new("-") { "standard output".into() } else { file.display().to_string() }
}

/// Why two films cannot become one. Nothing was added when this is returned.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MergeError {
    #[error("the films differ in {what}: {left} and {right}")]
    Differs { what: &'static str, left: String, right: String },
    #[error("both films hold the samples {start}..{end} (they hold {left} and {right})")]
    Overlap { start: u32, end: u32, left: String, right: String },
    #[error("the films would hold {total} samples a pixel together; at most {max} are allowed", max = super::MAX_SAMPLES)]
    TooMany { total: u64 },
}
