//! Which files a scene may read. With a root those of one folder alone, whatever the scene calls them: absolute paths, `..`,
//! links and URIs lead nowhere else. Without one all files, and it is told which of them lie far from the scene.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fs::{File, FileType};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The folder that everything has to lie in, once it is set.
static ROOT: OnceLock<Root> = OnceLock::new();

struct Root {
    /// Held open: the folder stays the same one, whatever becomes of its name.
    folder: File,
    /// Its name as it was given, made absolute, and without links.
    names: [PathBuf; 2],
}

/// Confines everything that is loaded from now on to `folder`; the first call counts. Needs Linux 5.6.
pub fn set_root(folder: &Path) -> io::Result<()> {
    let names = [std::path::absolute(folder)?, folder.canonicalize()?];
    let root = Root { folder: File::open(folder)?, names };
    // Fails here, and not with the first scene, where the system cannot do it.
    root.open(folder, Wanted::Kind)?;
    let _ = ROOT.set(root);
    Ok(())
}

/// Opens a file to be read.
pub fn open(path: &Path) -> io::Result<File> {
    match ROOT.get() {
        Some(root) => root.open(path, Wanted::Bytes),
        None => {
            note(path);
            File::open(path)
        }
    }
}

/// What is there, links followed. The file is not opened.
pub fn kind(path: &Path) -> io::Result<FileType> {
    let found = match ROOT.get() {
        Some(root) => root.open(path, Wanted::Kind)?.metadata(),
        None => std::fs::metadata(path),
    };
    Ok(found?.file_type())
}

/// Whether a regular file is there that may be read.
pub fn is_file(path: &Path) -> bool {
    kind(path).is_ok_and(|kind| kind.is_file())
}

/// Whether a folder is there that may be read.
pub fn is_dir(path: &Path) -> bool {
    kind(path).is_ok_and(|kind| kind.is_dir())
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Bytes,
    /// What it is: nothing is opened that would notice.
    Kind,
}

impl Root {
    fn open(&self, path: &Path, wanted: Wanted) -> io::Result<File> {
        let whole = std::path::absolute(path)?;
        let inside = self.names.iter().find_map(|name| whole.strip_prefix(name).ok());
        let inside = inside.map(|path| if path == Path::new("") { Path::new(".") } else { path });
        inside.map_or(Err(self.outside()), |path| self.open_beneath(path, wanted))
    }

    /// Opens `path` of the root; the system itself sees to it that no step leads out, also while links and folders change.
    #[cfg(target_os = "linux")]
    fn open_beneath(&self, path: &Path, wanted: Wanted) -> io::Result<File> {
        use rustix::fs::{Mode, OFlags, ResolveFlags, openat2};
        use rustix::io::Errno;
        let flags = match wanted {
            // A pipe is not waited for: whoever asked the kind knows that it is none, or it has become one since.
            Wanted::Bytes => OFlags::RDONLY | OFlags::NONBLOCK | OFlags::NOCTTY,
            Wanted::Kind => OFlags::PATH,
        };
        let resolve = ResolveFlags::BENEATH | ResolveFlags::NO_MAGICLINKS;
        // Something may be renamed on the way: the system then wants to be asked again.
        const TRIES: usize = 100;
        for _ in 0..TRIES {
            match openat2(&self.folder, path, flags | OFlags::CLOEXEC, Mode::empty(), resolve) {
                Ok(file) => return Ok(file.into()),
                Err(Errno::AGAIN) => {}
                Err(Errno::XDEV) => return Err(self.outside()),
                Err(Errno::NOSYS) => return Err(unsupported()),
                Err(error) => return Err(error.into()),
            }
        }
        Err(Errno::AGAIN.into())
    }

    #[cfg(not(target_os = "linux"))]
    fn open_beneath(&self, _: &Path, _: Wanted) -> io::Result<File> {
        Err(unsupported())
    }

    fn outside(&self) -> io::Error {
        let message = format!("it leads out of {} (--root)", self.names[0].display());
        io::Error::new(ErrorKind::PermissionDenied, message)
    }
}

fn unsupported() -> io::Error {
    io::Error::new(ErrorKind::Unsupported, "this system cannot confine files to a folder; Linux 5.6 and later can")
}

/// The surroundings of the scene that this thread loads, and the files that were read outside them.
struct Home {
    folder: PathBuf,
    strayed: BTreeSet<PathBuf>,
}

thread_local! {
    static HOME: RefCell<Option<Home>> = const { RefCell::new(None) };
}

/// The scene in `path` is loaded next, on this thread. Its surroundings are its folder and the one above, where scenes have
/// what they share.
pub fn begin(path: &Path) {
    // Standard input is as good as a file of the current folder.
    let path = if path == Path::new("-") { Path::new("./-") } else { path };
    let folder = path.parent().map(|folder| if folder == Path::new("") { Path::new(".") } else { folder });
    let folder = folder.and_then(|folder| folder.canonicalize().ok());
    let home = folder.map(|folder| folder.parent().map(Path::to_owned).unwrap_or(folder));
    HOME.set(home.map(|folder| Home { folder, strayed: BTreeSet::new() }));
}

/// A warning for each file outside the scene's surroundings that was read since the last call.
pub fn strayed() -> Vec<String> {
    HOME.with_borrow_mut(|home| {
        let files = home.as_mut().map(|home| std::mem::take(&mut home.strayed)).unwrap_or_default();
        let warning = |file: PathBuf| {
            format!("{}: read from outside the folder above the scene's (--root refuses that)", file.display())
        };
        files.into_iter().map(warning).collect()
    })
}

fn note(path: &Path) {
    HOME.with_borrow_mut(|home| {
        if let Some(home) = home
            && let Ok(real) = path.canonicalize()
            && !real.starts_with(&home.folder)
        {
            home.strayed.insert(real);
        }
    });
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    /// `inside/` with a file and links, beside `secret`.
    fn folders() -> (tempfile::TempDir, Root) {
        let folder = tempfile::tempdir().unwrap();
        let inside = folder.path().join("inside");
        std::fs::create_dir_all(inside.join("sub")).unwrap();
        std::fs::write(inside.join("file"), "x").unwrap();
        std::fs::write(folder.path().join("secret"), "x").unwrap();
        symlink("../file", inside.join("sub/back")).unwrap();
        symlink("../secret", inside.join("out")).unwrap();
        // The system's own link to everything, to a file of ours.
        let secret = folder.path().join("secret").canonicalize().unwrap();
        symlink(format!("/proc/self/root{}", secret.display()), inside.join("magic")).unwrap();
        symlink(folder.path(), inside.join("up")).unwrap();
        let names = [inside.clone(), inside.canonicalize().unwrap()];
        (folder, Root { folder: File::open(&inside).unwrap(), names })
    }

    #[test]
    fn what_lies_in_the_root_is_opened_by_any_of_its_names() {
        let (folder, root) = folders();
        let inside = folder.path().join("inside");
        for name in ["file", "./file", "sub/../file", "sub/back"] {
            for wanted in [Wanted::Bytes, Wanted::Kind] {
                assert!(root.open(&inside.join(name), wanted).is_ok(), "{name}");
            }
        }
        assert!(root.open(&inside, Wanted::Kind).is_ok());
        let absent = root.open(&inside.join("absent"), Wanted::Bytes).unwrap_err();
        assert_eq!(absent.kind(), ErrorKind::NotFound);
    }

    #[test]
    fn what_lies_outside_is_refused_whether_it_is_there_or_not() {
        let (folder, root) = folders();
        let inside = folder.path().join("inside");
        for name in ["out", "../secret", "../absent", "sub/../../secret", "up/secret", "magic", "/absent"] {
            for wanted in [Wanted::Bytes, Wanted::Kind] {
                let error = root.open(&inside.join(name), wanted).unwrap_err();
                assert_eq!(error.to_string(), root.outside().to_string(), "{name}");
            }
        }
    }

    #[test]
    fn a_link_that_changes_all_the_time_never_leads_out() {
        let (folder, root) = folders();
        let link = folder.path().join("inside/link");
        let swap = |target: &str| {
            let new = folder.path().join("inside/new");
            symlink(target, &new).unwrap();
            std::fs::rename(new, &link).unwrap();
        };
        swap("file");
        std::fs::write(folder.path().join("secret"), "secret").unwrap();
        let done = std::sync::atomic::AtomicBool::new(false);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                while !done.load(std::sync::atomic::Ordering::Relaxed) {
                    swap("../secret");
                    swap("file");
                }
            });
            for _ in 0..20_000 {
                if let Ok(file) = root.open(&link, Wanted::Bytes) {
                    assert_eq!(file.metadata().unwrap().len(), 1);
                }
            }
            done.store(true, std::sync::atomic::Ordering::Relaxed);
        });
    }
}
