//! What all text formats share: reading a file and finding a place in it.

use crate::scene::{Location, SceneError};
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

/// The bytes of `path`, or an error that names it.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, SceneError> {
    std::fs::read(path).map_err(|source| SceneError::Io { location: Location::file(path), source })
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
