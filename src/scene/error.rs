//! Errors of scene files, each with its place.

use std::fmt;
use std::path::PathBuf;

/// A place in a file. Line and column count from 1; 0 where the format has none (binary files).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    pub file: PathBuf,
    pub line: u32,
    pub column: u32,
}

impl Location {
    pub fn file(file: impl Into<PathBuf>) -> Self {
        Self { file: file.into(), line: 0, column: 0 }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        match (self.line, self.column) {
            (0, _) => Ok(()),
            (line, 0) => write!(f, ":{line}"),
            (line, column) => write!(f, ":{line}:{column}"),
        }
    }
}

/// Why a scene could not be loaded.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The content is wrong: exit code 65. Displays as `file:line:column: message`.
    #[error("{location}: {message}")]
    Bad { location: Location, message: String },
    /// The file cannot be read: exit code 74.
    #[error("{location}: {source}")]
    Io { location: Location, source: std::io::Error },
}

impl SceneError {
    pub fn bad(location: Location, message: impl Into<String>) -> Self {
        Self::Bad { location, message: message.into() }
    }
}
