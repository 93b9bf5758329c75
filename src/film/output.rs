//! Output files that are whole or not there.

use super::FilmError;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// An unfinished file that nobody holds and that is older than this was left behind. Between making a file and locking it
/// there are microseconds, between its last byte and its name no more.
const ABANDONED: Duration = Duration::from_secs(60);

/// A file to be: opened before the work starts, so that a bad path fails at once; written under a temporary name in the
/// same folder; given its name by `commit`, and removed if that is never reached. Whatever had the name before stays
/// until then. What is no regular file (`/dev/null`, a pipe) is written to directly, and `-` is standard output.
#[derive(Debug)]
pub struct OutputFile {
    path: PathBuf,
    sink: Sink,
}

#[derive(Debug)]
enum Sink {
    Stdout(io::Stdout),
    Direct(BufWriter<File>),
    Temporary { out: BufWriter<File>, temporary: Remove, target: PathBuf },
}

/// Removes the file when dropped, unless its path was taken.
#[derive(Debug)]
struct Remove(Option<PathBuf>);

impl Drop for Remove {
    fn drop(&mut self) {
        if let Some(path) = self.0.take() {
            // Nothing can be done about a failure here; the error that led here is the one to report.
            let _ = fs::remove_file(path);
        }
    }
}

impl OutputFile {
    /// Opens `path` for writing; `-` is standard output.
    pub fn open(path: &Path) -> Result<Self, FilmError> {
        Self::open_sink(path).map(|sink| Self { path: path.into(), sink }).map_err(|e| FilmError::write(path, e))
    }

    fn open_sink(path: &Path) -> io::Result<Sink> {
        if path == Path::new("-") {
            return Ok(Sink::Stdout(io::stdout()));
        }
        if path.as_os_str().as_encoded_bytes().ends_with(b"/") {
            return Err(io::Error::other("the name is a folder's"));
        }
        let existing = match fs::metadata(path) {
            Ok(existing) => Some(existing),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(error),
        };
        if let Some(existing) = &existing {
            if existing.is_dir() {
                return Err(io::Error::other("it is a folder"));
            }
            if !existing.is_file() {
                return Ok(Sink::Direct(BufWriter::new(OpenOptions::new().write(true).open(path)?)));
            }
            // Renaming would replace a file that must not be written to.
            if existing.permissions().readonly() {
                return Err(io::Error::new(io::ErrorKind::PermissionDenied, "it is read-only"));
            }
            OpenOptions::new().write(true).open(path)?;
        }
        let target = follow_links(path)?;
        let (file, temporary) = create_temporary(&target)?;
        if let Some(existing) = existing {
            file.set_permissions(existing.permissions())?;
        }
        Ok(Sink::Temporary { out: BufWriter::new(file), temporary, target })
    }

    /// The path as it was given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The unfinished file, which whoever ends the program without unwinding has to remove.
    pub fn temporary(&self) -> Option<&Path> {
        match &self.sink {
            Sink::Temporary { temporary, .. } => temporary.0.as_deref(),
            Sink::Stdout(_) | Sink::Direct(_) => None,
        }
    }

    /// Whether it is standard output, which then carries nothing else.
    pub fn is_stdout(&self) -> bool {
        matches!(self.sink, Sink::Stdout(_))
    }

    /// Everything is written: gives the file its name.
    pub fn commit(self) -> Result<(), FilmError> {
        let Self { path, sink } = self;
        let finish = || -> io::Result<()> {
            match sink {
                Sink::Stdout(mut out) => out.flush(),
                Sink::Direct(mut out) => out.flush(),
                Sink::Temporary { out, mut temporary, target } => {
                    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
                    // Some file systems report a full disk only here.
                    file.sync_all()?;
                    drop(file);
                    // A second guard, for what appeared since: renaming as root would replace even `/dev/null`.
                    if fs::symlink_metadata(&target).is_ok_and(|there| !there.is_file()) {
                        return Err(io::Error::other("something that is no regular file has its name now"));
                    }
                    if let Some(from) = &temporary.0 {
                        fs::rename(from, target)?;
                    }
                    temporary.0 = None;
                    Ok(())
                }
            }
        };
        finish().map_err(|e| FilmError::write(&path, e))
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.sink {
            Sink::Stdout(out) => out.write(bytes),
            Sink::Direct(out) | Sink::Temporary { out, .. } => out.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::Stdout(out) => out.flush(),
            Sink::Direct(out) | Sink::Temporary { out, .. } => out.flush(),
        }
    }
}

/// The file behind symbolic links, there or not: renaming onto a link would replace the link.
fn follow_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_path_buf();
    // The kernel's own limit; a loop was already refused by `metadata`.
    for _ in 0..40 {
        match fs::symlink_metadata(&path) {
            Ok(found) if found.is_symlink() => path = folder_of(&path).join(fs::read_link(&path)?),
            _ => break,
        }
    }
    Ok(path)
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Creates a hidden file of a new name beside `target`, and holds it by a lock, which goes with the process. Removes what
/// was left behind there.
fn create_temporary(target: &Path) -> io::Result<(File, Remove)> {
    let Some(name) = target.file_name() else {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it has no file name"));
    };
    let folder = folder_of(target);
    sweep(folder);
    // Processes of one number follow each other, in containers always: the time tells their files apart.
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos());
    for attempt in 0..1000 {
        let mut hidden = std::ffi::OsString::from(".");
        // File names are at most 255 bytes on most systems: a long one is cut, the rest keeps it unique.
        hidden.push(name.to_string_lossy().chars().take(40).collect::<String>());
        hidden.push(format!(".{}-{}.part", std::process::id(), now + attempt));
        let path = folder.join(hidden);
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => {
                // Where there are no locks (some network file systems), there is no sweeping either.
                let _ = file.try_lock();
                return Ok((file, Remove(Some(path))));
            }
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Err(io::Error::new(error.kind(), format!("no folder {}", folder.display())));
            }
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::other("too many unfinished files beside it"))
}

/// Removes the unfinished files of processes that were killed. What cannot be looked at stays.
fn sweep(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if is_unfinished(&entry.file_name().to_string_lossy()) && is_abandoned(&entry.path()) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether `create_temporary` gives such names.
fn is_unfinished(name: &str) -> bool {
    let tail =
        name.strip_prefix('.').and_then(|name| name.strip_suffix(".part")).and_then(|name| name.rsplit_once('.'));
    let numbers = tail.and_then(|(_, tail)| tail.split_once('-'));
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    numbers.is_some_and(|(process, time)| is_number(process) && is_number(time))
}

fn is_abandoned(path: &Path) -> bool {
    let look = || -> io::Result<bool> {
        let found = fs::symlink_metadata(path)?;
        // A clock set back makes a file look new; it is swept later.
        if !found.is_file() || found.modified()?.elapsed().unwrap_or_default() < ABANDONED {
            return Ok(false);
        }
        Ok(File::open(path)?.try_lock().is_ok())
    };
    look().unwrap_or(false)
}
