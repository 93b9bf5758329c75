//! Errors of scene files, each with its place.

use crate::memory::Shortage;
use std::fmt;
use std::path::PathBuf;

/// A place in a file. Line and column count from 1; 0 where the format has none (binary files).
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
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
    /// It takes more memory than there is: exit code 75.
    #[error("{location}: {short}")]
    Memory { location: Location, short: Shortage },
    /// Several of these, in the order of their places; one a line.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Several(Vec<SceneError>),
}

/// More faults than this are of one kind, and nobody reads on.
const SEVERAL_MAX: usize = 20;

impl SceneError {
    pub fn bad(location: Location, message: impl Into<String>) -> Self {
        Self::Bad { location, message: message.into() }
    }

    /// At least one error as one, in the order of their places, each told once.
    pub fn all(mut errors: Vec<Self>) -> Self {
        debug_assert!(!errors.is_empty(), "no error");
        errors.sort_by(|a, b| a.location().cmp(&b.location()));
        errors.dedup_by_key(|error| error.to_string());
        if errors.len() == 1 {
            return errors.remove(0);
        }
        if let Some(next) = errors.get(SEVERAL_MAX).and_then(Self::location).cloned() {
            let rest = errors.len() - SEVERAL_MAX;
            errors.truncate(SEVERAL_MAX);
            errors.push(Self::bad(next, format!("here and below are {rest} more faults")));
        }
        Self::Several(errors)
    }

    fn location(&self) -> Option<&Location> {
        match self {
            Self::Bad { location, .. } | Self::Io { location, .. } | Self::Memory { location, .. } => Some(location),
            Self::Several(errors) => errors.first().and_then(Self::location),
        }
    }

    /// Whether all that is wrong is a file that cannot be read.
    pub fn is_io(&self) -> bool {
        match self {
            Self::Bad { .. } | Self::Memory { .. } => false,
            Self::Io { .. } => true,
            Self::Several(errors) => errors.iter().all(Self::is_io),
        }
    }

    /// Whether all that is wrong is a file that is not there, or not for this user.
    pub fn is_absent(&self) -> bool {
        use std::io::ErrorKind::{NotADirectory, NotFound, PermissionDenied};
        match self {
            Self::Bad { .. } | Self::Memory { .. } => false,
            Self::Io { source, .. } => matches!(source.kind(), NotFound | NotADirectory | PermissionDenied),
            Self::Several(errors) => errors.iter().all(Self::is_absent),
        }
    }

    /// Whether all that is wrong is too little memory.
    pub fn is_memory(&self) -> bool {
        match self {
            Self::Bad { .. } | Self::Io { .. } => false,
            Self::Memory { .. } => true,
            Self::Several(errors) => errors.iter().all(Self::is_memory),
        }
    }
}
