//! A file read piece by piece: a mesh of any size is read without its file lying in memory beside it.

use super::text::open_file;
use crate::scene::{Location, SceneError};
use std::io::{self, ErrorKind, Read};
use std::ops::Range;
use std::path::Path;

/// What is asked of the system at once, in bytes.
const CHUNK: usize = 1 << 18;
/// Bytes of a line at most: a polygon of twenty million corners. What goes on for longer is no text.
const LINE_MAX: usize = 1 << 28;

/// A cursor over a file, or over bytes in memory.
pub struct Stream<'a> {
    source: Box<dyn Read + 'a>,
    buffer: Vec<u8>,
    /// What of the buffer was read and is not taken yet.
    unread: Range<usize>,
    /// Where in the buffer the line lies that `next_line` found.
    line: Range<usize>,
    /// Bytes taken so far.
    taken: u64,
    length: Option<u64>,
    ended: bool,
}

impl<'a> Stream<'a> {
    pub fn open(path: &Path) -> Result<Self, SceneError> {
        let (file, size) = open_file(path).map_err(|error| failed(path, error))?;
        Ok(Self::new(Box::new(file), Some(size)))
    }

    pub fn of(bytes: &'a [u8]) -> Self {
        Self::new(Box::new(bytes), Some(bytes.len() as u64))
    }

    fn new(source: Box<dyn Read + 'a>, length: Option<u64>) -> Self {
        Self { source, buffer: vec![0; CHUNK], unread: 0..0, line: 0..0, taken: 0, length, ended: false }
    }

    /// Bytes taken so far.
    pub fn at(&self) -> u64 {
        self.taken
    }

    /// Bytes that follow; None where the file does not say, as pipes do not.
    pub fn remaining(&self) -> Option<u64> {
        self.length.map(|length| length.saturating_sub(self.taken))
    }

    /// The next `count` bytes, which stay to be taken; fewer at the end of the file.
    #[inline]
    pub fn peek(&mut self, count: usize) -> io::Result<&[u8]> {
        while self.unread.len() < count && !self.ended {
            self.fill(count)?;
        }
        let end = self.unread.end.min(self.unread.start + count);
        Ok(&self.buffer[self.unread.start..end])
    }

    /// Takes `count` bytes that `peek` showed.
    #[inline]
    pub fn skip(&mut self, count: usize) {
        debug_assert!(count <= self.unread.len());
        self.unread.start += count;
        self.taken += count as u64;
    }

    /// Moves on to the next line, which ends with \n, \r\n, a lone \r or the file; false where there is none.
    pub fn next_line(&mut self) -> io::Result<bool> {
        let mut seen = 0;
        loop {
            let rest = &self.buffer[self.unread.start + seen..self.unread.end];
            let Some(at) = memchr::memchr2(b'\n', b'\r', rest) else {
                seen = self.unread.len();
                if self.ended {
                    self.line = self.unread.clone();
                    self.skip(seen);
                    return Ok(seen > 0);
                }
                if seen > LINE_MAX {
                    let message = format!("a line of more than {LINE_MAX} bytes");
                    return Err(io::Error::new(ErrorKind::InvalidData, message));
                }
                self.fill(seen + 1)?;
                continue;
            };
            let length = seen + at;
            // What follows a \r may not have been read yet.
            if rest[at] == b'\r' && self.unread.len() == length + 1 && !self.ended {
                self.fill(length + 2)?;
                continue;
            }
            let start = self.unread.start;
            let pair = self.buffer[start + length..self.unread.end].starts_with(b"\r\n");
            self.line = start..start + length;
            self.skip(length + if pair { 2 } else { 1 });
            return Ok(true);
        }
    }

    /// The line that `next_line` found, without its end.
    #[inline]
    pub fn line(&self) -> &[u8] {
        &self.buffer[self.line.clone()]
    }

    /// Reads more, with room for `count` bytes.
    fn fill(&mut self, count: usize) -> io::Result<()> {
        self.buffer.copy_within(self.unread.clone(), 0);
        self.unread = 0..self.unread.len();
        if self.buffer.len() < count.max(self.unread.end + 1) {
            let wanted = count.max(2 * self.buffer.len());
            self.buffer.resize(wanted, 0);
        }
        let read = loop {
            match self.source.read(&mut self.buffer[self.unread.end..]) {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                outcome => break outcome?,
            }
        };
        self.ended = read == 0;
        self.unread.end += read;
        Ok(())
    }
}

/// `error` while `file` was read: what is wrong with its content, or that it cannot be read.
pub fn failed(file: &Path, source: io::Error) -> SceneError {
    let location = Location::file(file);
    match source.kind() {
        ErrorKind::InvalidData => SceneError::bad(location, source.to_string()),
        _ => SceneError::Io { location, source },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives one byte at a time, so that every place is once the end of what was read.
    struct Drip<'a>(&'a [u8]);

    impl Read for Drip<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let count = self.0.len().min(buffer.len()).min(1);
            buffer[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    #[test]
    fn lines_of_every_system_are_found_wherever_a_read_ends() {
        let text = b"a\nb\r\nc\rd\n\r\r\ne";
        for mut stream in [Stream::of(text), Stream::new(Box::new(Drip(text)), None)] {
            let mut lines = Vec::new();
            while stream.next_line().unwrap() {
                lines.push(String::from_utf8(stream.line().to_vec()).unwrap());
            }
            assert_eq!(lines, ["a", "b", "c", "d", "", "", "e"]);
            assert_eq!(stream.at(), text.len() as u64);
        }
    }

    #[test]
    fn pieces_larger_than_a_chunk_are_whole_and_the_end_is_short() {
        let bytes: Vec<u8> = (0..3 * CHUNK).map(|i| (i % 251) as u8).collect();
        let mut stream = Stream::of(&bytes);
        assert_eq!(stream.peek(2 * CHUNK + 1).unwrap(), &bytes[..2 * CHUNK + 1]);
        stream.skip(2 * CHUNK + 1);
        assert_eq!((stream.at(), stream.remaining()), (2 * CHUNK as u64 + 1, Some(CHUNK as u64 - 1)));
        assert_eq!(stream.peek(CHUNK).unwrap(), &bytes[2 * CHUNK + 1..]);
    }

    #[test]
    fn an_endless_line_is_refused() {
        let mut stream = Stream::new(Box::new(io::repeat(0)), None);
        let error = failed(Path::new("a.obj"), stream.next_line().unwrap_err());
        assert_eq!(error.to_string(), format!("a.obj: a line of more than {LINE_MAX} bytes"));
    }
}
