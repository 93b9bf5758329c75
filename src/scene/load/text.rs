//! What all formats share: reading a file that a scene names, and finding a place in a text.

use super::confine;
use crate::scene::{Location, SceneError};
use std::fs::{File, FileType};
use std::io::{self, Read};
use std::path::Path;

/// Line and column of a byte offset, both from 1; columns count characters.
pub fn line_and_column(text: &str, offset: usize) -> (u32, u32) {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    let before = &text[..offset];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = before.bytes().filter(|&byte| byte == b'\n').count() + 1;
    let column = before[line_start..].chars().count() + 1;
    (u32::try_from(line).unwrap_or(u32::MAX), u32::try_from(column).unwrap_or(u32::MAX))
}

/// The file `path`, opened, and its size in bytes. Regular files only: devices and pipes have no end, and opening one may wait
/// for ever.
pub fn open_file(path: &Path) -> io::Result<(File, u64)> {
    // Asked before and after: it may have been replaced meanwhile.
    check_kind(confine::kind(path)?)?;
    let file = confine::open(path)?;
    let found = file.metadata()?;
    check_kind(found.file_type())?;
    Ok((file, found.len()))
}

/// The bytes of the file `path` (`open_file`), or an error that names it. Their size is claimed from the budget
/// (`crate::memory`) first, and no more is read.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, SceneError> {
    let failed = |source| SceneError::Io { location: Location::file(path), source };
    let (file, size) = open_file(path).map_err(failed)?;
    crate::memory::check("the file", size)
        .map_err(|short| SceneError::Memory { location: Location::file(path), short })?;
    let mut bytes = Vec::new();
    bytes
        .try_reserve_exact(size as usize)
        .map_err(|error| failed(io::Error::new(io::ErrorKind::OutOfMemory, error)))?;
    // One byte more, for what grows meanwhile.
    file.take(size + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 != size {
        return Err(failed(io::Error::other("the file changed while it was read")));
    }
    Ok(bytes)
}

/// Refuses what is there but no regular file.
fn check_kind(kind: FileType) -> io::Result<()> {
    match () {
        _ if kind.is_file() => Ok(()),
        _ if kind.is_dir() => Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder, not a file")),
        _ => Err(io::Error::other("it is no regular file (a device, a pipe or the like)")),
    }
}

/// `bytes` as UTF-8 without a byte order mark; `file` is their name in messages.
pub fn utf8(file: &Path, bytes: Vec<u8>) -> Result<String, SceneError> {
    let mut text = String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(&error.as_bytes()[..valid]).into_owned();
        let (line, column) = line_and_column(&text, valid);
        SceneError::bad(Location { file: file.to_owned(), line, column }, "the text is not UTF-8")
    })?;
    if text.starts_with('\u{feff}') {
        text.drain(..'\u{feff}'.len_utf8());
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_lines_count_from_one() {
        assert_eq!(line_and_column("ab\nc", 0), (1, 1));
        assert_eq!(line_and_column("ab\nc", 3), (2, 1));
        assert_eq!(line_and_column("é = 1", 3), (1, 3), "two bytes, one column");
        assert_eq!(line_and_column("ab", 99), (1, 3), "beyond the end is the end");
    }

    #[test]
    fn bytes_that_are_not_utf8_are_refused_with_their_place() {
        let error = utf8(Path::new("a.toml"), b"x = 1\ny = \xff".to_vec()).unwrap_err();
        assert_eq!(error.to_string(), "a.toml:2:5: the text is not UTF-8");
    }
}
