//! OBJ and MTL are lines of words: this gives the words, with their places.

use crate::scene::load::toml::LARGEST;
use crate::scene::{Location, SceneError};
use std::borrow::Cow;
use std::path::Path;

/// One statement: a keyword and what follows it. Comments are gone, continued lines joined.
#[derive(Debug)]
pub struct Statement<'a> {
    file: &'a Path,
    line: u32,
    text: Cow<'a, str>,
}

/// All statements of a file, in order.
pub fn statements<'a>(file: &'a Path, text: &'a str) -> impl Iterator<Item = Statement<'a>> {
    let mut lines = text.trim_start_matches('\u{feff}').lines().zip(1..);
    std::iter::from_fn(move || {
        let (first, line) = lines.next()?;
        let mut text = Cow::Borrowed(first);
        // A backslash at the end joins the next line, and so on to the end of the file.
        while let Some(open) = text.trim_end().strip_suffix('\\') {
            let mut joined = open.to_owned();
            joined.push(' ');
            if let Some((next, _)) = lines.next() {
                joined.push_str(next);
            }
            text = Cow::Owned(joined);
        }
        Some(Statement { file, line, text })
    })
    .filter(|statement| !statement.code().is_empty())
}

impl<'a> Statement<'a> {
    /// The statement without its comment. A `#` inside a word is part of it: names may have one.
    fn code(&self) -> &str {
        let comment = self.text.char_indices().find(|(offset, character)| {
            *character == '#' && self.text[..*offset].chars().next_back().is_none_or(char::is_whitespace)
        });
        self.text[..comment.map_or(self.text.len(), |(offset, _)| offset)].trim()
    }

    pub fn keyword(&self) -> &str {
        self.code().split_whitespace().next().unwrap_or("")
    }

    /// Everything after the keyword: a name may hold spaces.
    pub fn rest(&self) -> &str {
        let code = self.code();
        code[self.keyword().len()..].trim()
    }

    pub fn words(&self) -> impl Iterator<Item = &str> {
        self.code().split_ascii_whitespace().skip(1)
    }

    /// Where `word`, a part of this statement, stands.
    pub fn location_of(&self, word: &str) -> Location {
        let location = self.location();
        let Cow::Borrowed(line) = self.text else { return location };
        match (word.as_ptr() as usize).checked_sub(line.as_ptr() as usize).and_then(|offset| line.get(..offset)) {
            Some(before) => Location { column: before.chars().count() as u32 + 1, ..location },
            None => location,
        }
    }

    /// The statement's line; it has no column.
    pub fn location(&self) -> Location {
        Location { file: self.file.to_owned(), line: self.line, column: 0 }
    }

    /// The folder where paths of the file begin.
    pub fn folder(&self) -> &'a Path {
        self.file.parent().unwrap_or(Path::new(""))
    }

    pub fn bad(&self, message: impl Into<String>) -> SceneError {
        SceneError::bad(self.location_of(self.keyword()), message)
    }

    /// `word` as a finite number that fits the house's range.
    pub fn number(&self, word: &str) -> Result<f32, SceneError> {
        match word.parse::<f32>() {
            Ok(number) if f64::from(number.abs()) <= LARGEST => Ok(number),
            Ok(_) => {
                Err(SceneError::bad(self.location_of(word), format!("{word:?} is not a finite number up to 1e12")))
            }
            Err(_) => Err(SceneError::bad(self.location_of(word), format!("expected a number, found {word:?}"))),
        }
    }

    /// The first N words as numbers; fewer are an error, more are left.
    pub fn numbers<const N: usize>(&self) -> Result<[f32; N], SceneError> {
        let mut numbers = [0.0; N];
        let mut words = self.words();
        for (index, number) in numbers.iter_mut().enumerate() {
            let Some(word) = words.next() else {
                let numbers = if N == 1 { "number" } else { "numbers" };
                return Err(self.bad(format!("{:?} needs {N} {numbers}, found {index}", self.keyword())));
            };
            *number = self.number(word)?;
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<(u32, String, Vec<String>)> {
        statements(Path::new("a.obj"), text)
            .map(|s| (s.line, s.keyword().to_owned(), s.words().map(str::to_owned).collect()))
            .collect()
    }

    #[test]
    fn comments_continuations_and_line_ends_of_every_system_are_read() {
        let read = read("# head\r\nv 1 \\\r\n2 3 # tail\r\n\r\n\tusemtl a#1\nf 1 2 3\\");
        let words = |words: &[&str]| words.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>();
        assert_eq!(read[0], (2, "v".to_owned(), words(&["1", "2", "3"])));
        assert_eq!(read[1], (5, "usemtl".to_owned(), words(&["a#1"])));
        assert_eq!(read[2], (6, "f".to_owned(), words(&["1", "2", "3"])));
    }

    #[test]
    fn a_bad_number_is_refused_at_its_column() {
        let text = "  v 1 two 3";
        let statement = statements(Path::new("a.obj"), text).next().unwrap();
        assert_eq!(statement.numbers::<3>().unwrap_err().to_string(), "a.obj:1:7: expected a number, found \"two\"");
        let text = "v 1 nan 3";
        let statement = statements(Path::new("a.obj"), text).next().unwrap();
        assert!(statement.numbers::<3>().is_err());
    }
}
