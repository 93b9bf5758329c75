//! OBJ and MTL are lines of words: this gives the words, with their places.

use crate::scene::load::stream::{Stream, failed};
use crate::scene::load::toml::LARGEST;
use crate::scene::{Location, SceneError};
use std::borrow::Cow;
use std::path::Path;

/// All statements of a file, in order.
pub struct Statements<'a> {
    file: &'a Path,
    stream: Stream<'a>,
    /// Lines read so far.
    lines: u32,
    /// A statement of several lines.
    joined: Vec<u8>,
}

/// One statement: a keyword and what follows it. Continued lines are joined.
#[derive(Clone, Copy, Debug)]
pub struct Statement<'a> {
    file: &'a Path,
    line: u32,
    text: &'a [u8],
    keyword: &'a [u8],
    /// Its words lie where the file has them.
    is_one_line: bool,
}

impl<'a> Statements<'a> {
    pub fn open(file: &'a Path) -> Result<Self, SceneError> {
        Self::of(file, Stream::open(file)?)
    }

    /// The statements of `stream`; `file` is its name in messages.
    pub fn of(file: &'a Path, mut stream: Stream<'a>) -> Result<Self, SceneError> {
        let mark = "\u{feff}".as_bytes();
        if stream.peek(mark.len()).map_err(|error| failed(file, error))? == mark {
            stream.skip(mark.len());
        }
        Ok(Self { file, stream, lines: 0, joined: Vec::new() })
    }

    /// The next statement; None at the end.
    pub fn next(&mut self) -> Result<Option<Statement<'_>>, SceneError> {
        let (line, is_joined) = loop {
            if !self.next_line()? {
                return Ok(None);
            }
            let line = self.lines;
            let is_joined = open_end(self.stream.line()).is_some();
            if is_joined {
                self.join()?;
            }
            let text = if is_joined { &self.joined[..] } else { self.stream.line() };
            if Words(text).next().is_some() {
                break (line, is_joined);
            }
        };
        let text = if is_joined { &self.joined[..] } else { self.stream.line() };
        let keyword = Words(text).next().unwrap_or_default();
        Ok(Some(Statement { file: self.file, line, text, keyword, is_one_line: !is_joined }))
    }

    fn next_line(&mut self) -> Result<bool, SceneError> {
        let found = self.stream.next_line().map_err(|error| failed(self.file, error))?;
        self.lines = self.lines.saturating_add(1);
        Ok(found)
    }

    /// Joins the line with those after it, as long as each ends with a backslash.
    fn join(&mut self) -> Result<(), SceneError> {
        self.joined.clear();
        while let Some(open) = open_end(self.stream.line()) {
            self.joined.extend(open);
            self.joined.push(b' ');
            if !self.next_line()? {
                return Ok(());
            }
        }
        self.joined.extend(self.stream.line());
        Ok(())
    }
}

/// What a line that goes on in the next one says.
fn open_end(line: &[u8]) -> Option<&[u8]> {
    line.trim_ascii_end().strip_suffix(b"\\")
}

/// Words between white space, up to a comment: a `#` inside a word is part of it, as names may have one.
#[derive(Clone, Copy, Debug)]
pub struct Words<'a>(&'a [u8]);

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    #[inline]
    fn next(&mut self) -> Option<&'a [u8]> {
        let start = self.0.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let rest = &self.0[start..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let (word, after) = rest.split_at(length);
        if word[0] == b'#' {
            self.0 = &[];
            return None;
        }
        self.0 = after;
        Some(word)
    }
}

/// Bytes as text: UTF-8, or else Latin-1, which old programs write.
pub fn decode(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()),
    }
}

/// `text` without the quotation marks around it.
pub fn unquoted(text: &str) -> &str {
    text.strip_prefix('"').and_then(|inner| inner.strip_suffix('"')).unwrap_or(text).trim()
}

impl<'a> Statement<'a> {
    /// As written; keywords mean the same in any case.
    #[inline]
    pub fn keyword(&self) -> &'a [u8] {
        self.keyword
    }

    /// Everything after the keyword, up to a comment.
    pub fn rest(&self) -> Cow<'a, str> {
        let start = self.offset_of(self.keyword) + self.keyword.len();
        let rest = &self.text[start..];
        let is_comment = |at: &usize| rest[*at] == b'#' && rest[..*at].last().is_none_or(u8::is_ascii_whitespace);
        let end = memchr::memchr_iter(b'#', rest).find(is_comment).unwrap_or(rest.len());
        decode(rest[..end].trim_ascii())
    }

    /// The name after the keyword: it may hold spaces, or stand in quotation marks.
    pub fn name(&self) -> String {
        unquoted(&self.rest()).to_owned()
    }

    /// The words after the keyword.
    #[inline]
    pub fn words(&self) -> Words<'a> {
        let mut words = Words(self.text);
        words.next();
        words
    }

    fn offset_of(&self, word: &[u8]) -> usize {
        (word.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize).min(self.text.len())
    }

    /// Where `word`, a part of this statement, stands.
    pub fn location_of(&self, word: &[u8]) -> Location {
        let mut location = self.location();
        if self.is_one_line {
            location.column = decode(&self.text[..self.offset_of(word)]).chars().count() as u32 + 1;
        }
        location
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
        SceneError::bad(self.location_of(self.keyword), message)
    }

    /// `word` as a finite number that fits the house's range.
    #[inline]
    pub fn number(&self, word: &[u8]) -> Result<f32, SceneError> {
        match std::str::from_utf8(word).ok().and_then(|text| text.parse::<f32>().ok()) {
            Some(number) if f64::from(number.abs()) <= LARGEST => Ok(number),
            found => Err(self.no_number(word, found)),
        }
    }

    #[cold]
    fn no_number(&self, word: &[u8], found: Option<f32>) -> SceneError {
        let text = decode(word);
        let message = match found {
            None => format!("expected a number, found {text:?}"),
            Some(number) if number.is_nan() => format!("{text:?} is NaN, which is no number"),
            Some(number) if number < 0.0 => format!("{text:?} is too small; numbers are at least -1e12"),
            Some(_) => format!("{text:?} is too large; numbers are at most 1e12"),
        };
        SceneError::bad(self.location_of(word), message)
    }

    /// The first N words as numbers; fewer are an error, more are left.
    #[inline]
    pub fn numbers<const N: usize>(&self) -> Result<[f32; N], SceneError> {
        self.take_numbers(&mut self.words())
    }

    /// The next N of `words` as numbers.
    #[inline]
    pub fn take_numbers<const N: usize>(&self, words: &mut Words) -> Result<[f32; N], SceneError> {
        let mut numbers = [0.0; N];
        for (index, number) in numbers.iter_mut().enumerate() {
            let Some(word) = words.next() else {
                let numbers = if N == 1 { "number" } else { "numbers" };
                return Err(self.bad(format!("{:?} needs {N} {numbers}, found {index}", decode(self.keyword))));
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
        let mut statements = Statements::of(Path::new("a.obj"), Stream::of(text.as_bytes())).unwrap();
        let mut found = Vec::new();
        while let Some(s) = statements.next().unwrap() {
            found.push((s.line, decode(s.keyword()).into_owned(), s.words().map(|w| decode(w).into_owned()).collect()));
        }
        found
    }

    #[test]
    fn comments_continuations_and_line_ends_of_every_system_are_read() {
        let found = read("# head\r\nv 1 \\\r\n2 3 # tail\r\n\r\n\tusemtl a#1\nf 1 2 3\\");
        let words = |words: &[&str]| words.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>();
        assert_eq!(found[0], (2, "v".to_owned(), words(&["1", "2", "3"])));
        assert_eq!(found[1], (5, "usemtl".to_owned(), words(&["a#1"])));
        assert_eq!(found[2], (6, "f".to_owned(), words(&["1", "2", "3"])));
        assert_eq!(read("v 1\rv 2\r\rv 3")[2], (4, "v".to_owned(), words(&["3"])), "old Mac line ends");
    }

    #[test]
    fn names_lose_their_quotation_marks_and_comments() {
        let name = |text: &[u8]| {
            let mut statements = Statements::of(Path::new("a.obj"), Stream::of(text)).unwrap();
            statements.next().unwrap().unwrap().name()
        };
        assert_eq!(name(b"usemtl  my mat#1  # red"), "my mat#1");
        assert_eq!(name(b"usemtl \" my mat\" # red"), "my mat");
        assert_eq!(name(b"usemtl m\xfc"), "m\u{fc}", "Latin-1");
        assert_eq!((name(b"usemtl"), name(b"usemtl # none")), (String::new(), String::new()));
    }

    #[test]
    fn a_bad_number_is_refused_at_its_column() {
        let message = |text: &str| {
            let mut statements = Statements::of(Path::new("a.obj"), Stream::of(text.as_bytes())).unwrap();
            statements.next().unwrap().unwrap().numbers::<3>().unwrap_err().to_string()
        };
        assert_eq!(message("  v 1 two 3"), "a.obj:1:7: expected a number, found \"two\"");
        assert!(message("v 1 nan 3").starts_with("a.obj:1:5: "));
        assert_eq!(message("v 1 \\\n two 3"), "a.obj:1: expected a number, found \"two\"");
    }
}
