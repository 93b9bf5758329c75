//! The numbers after a PLY header, one element at a time.

use super::header::{Element, Encoding, Header, Scalar};
use super::{Failure, Place};
use crate::scene::load::stream::Stream;

/// Values of one element: scalars by property, and the items of its lists.
#[derive(Debug, Default)]
pub(super) struct Values {
    /// One for each property; a list's is its length.
    pub scalars: Vec<f64>,
    /// Where each property's items start in `items`; for scalars the same as the next.
    pub starts: Vec<usize>,
    pub items: Vec<f64>,
}

impl Values {
    /// The items of the list that is property `index`.
    pub fn list(&self, index: usize) -> &[f64] {
        &self.items[self.starts[index]..self.starts[index + 1]]
    }
}

/// A cursor over the numbers.
pub(super) struct Reader<'a> {
    stream: Stream<'a>,
    encoding: Encoding,
    line: u32,
}

/// Items of a list that are looked at together.
const BLOCK: usize = 1 << 12;
/// Bytes within which most elements end.
const WINDOW: usize = 256;

impl<'a> Reader<'a> {
    /// `stream` is behind the header.
    pub fn new(stream: Stream<'a>, header: &Header) -> Self {
        Self { stream, encoding: header.encoding, line: header.lines }
    }

    /// Bytes that follow, where the file knows.
    pub fn remaining(&self) -> Option<u64> {
        self.stream.remaining()
    }

    /// Where the element last read lies.
    pub fn place(&self) -> Place {
        match self.encoding {
            Encoding::Ascii => Place::Line(self.line),
            _ => Place::Byte(self.stream.at()),
        }
    }

    /// Reads the next element into `values`.
    pub fn read(&mut self, element: &Element, values: &mut Values) -> Result<(), Failure> {
        values.scalars.clear();
        values.starts.clear();
        values.items.clear();
        match (self.encoding, element.fixed_size()) {
            (Encoding::Ascii, _) => self.read_line(element, values)?,
            (_, Some(size)) => self.read_record(element, size, values)?,
            _ => self.read_bytes(element, values)?,
        }
        values.starts.push(values.items.len());
        Ok(())
    }

    /// An element is a line; empty lines are skipped.
    fn read_line(&mut self, element: &Element, values: &mut Values) -> Result<(), Failure> {
        loop {
            if !self.stream.next_line()? {
                return Err(Failure::here("the file ends"));
            }
            self.line = self.line.saturating_add(1);
            if !self.stream.line().trim_ascii().is_empty() {
                break;
            }
        }
        let line = std::str::from_utf8(self.stream.line()).map_err(|_| Failure::here("the line is not text"))?;
        let mut words = line.split_ascii_whitespace();
        for property in &element.properties {
            values.starts.push(values.items.len());
            let mut next = |scalar| match words.next() {
                Some(word) => parse(word, scalar),
                None => Err(Failure::here(format!("the line ends before property `{}`", property.name))),
            };
            let Some(length) = property.length else {
                values.scalars.push(next(property.item)?);
                continue;
            };
            let length = list_length(next(length)?, &property.name)?;
            values.scalars.push(length as f64);
            // Each turn uses up a word, so the line bounds the loop.
            for _ in 0..length {
                values.items.push(next(property.item)?);
            }
        }
        match words.next() {
            Some(word) => Err(Failure::here(format!("`{}` follows the last property", word.escape_debug()))),
            None => Ok(()),
        }
    }

    /// An element without lists.
    fn read_record(&mut self, element: &Element, size: usize, values: &mut Values) -> Result<(), Failure> {
        let record = self.stream.peek(size)?;
        if record.len() < size {
            return Err(Failure::here("the file ends"));
        }
        let mut at = 0;
        for property in &element.properties {
            let end = at + property.item.size();
            values.starts.push(0);
            values.scalars.push(decode(&record[at..end], property.item, self.encoding));
            at = end;
        }
        self.stream.skip(size);
        Ok(())
    }

    fn read_bytes(&mut self, element: &Element, values: &mut Values) -> Result<(), Failure> {
        if let Some(size) = read_window(self.stream.peek(WINDOW)?, element, self.encoding, values) {
            self.stream.skip(size);
            return Ok(());
        }
        values.scalars.clear();
        values.starts.clear();
        values.items.clear();
        for property in &element.properties {
            values.starts.push(values.items.len());
            let Some(length) = property.length else {
                self.take(property.item, 1, &mut values.scalars)?;
                continue;
            };
            self.take(length, 1, &mut values.scalars)?;
            let written = values.scalars.last().copied().unwrap_or_default();
            let length = list_length(written, &property.name)?;
            let needed = length.saturating_mul(property.item.size()) as u64;
            if self.stream.remaining().is_some_and(|rest| needed > rest) {
                return Err(Failure::here(format!("a list of {length} items runs over the end of the file")));
            }
            self.take(property.item, length, &mut values.items)?;
        }
        Ok(())
    }

    /// Appends `count` numbers.
    #[inline]
    fn take(&mut self, scalar: Scalar, count: usize, numbers: &mut Vec<f64>) -> Result<(), Failure> {
        let size = scalar.size();
        let mut left = count;
        while left > 0 {
            let now = left.min(BLOCK) * size;
            let bytes = self.stream.peek(now)?;
            if bytes.len() < now {
                return Err(Failure::here("the file ends"));
            }
            numbers.extend(bytes.chunks_exact(size).map(|bytes| decode(bytes, scalar, self.encoding)));
            self.stream.skip(now);
            left -= now / size;
        }
        Ok(())
    }
}

/// Reads an element that lies within `window` as a whole, as most do; gives its size in bytes. None: not so, or not well.
fn read_window(window: &[u8], element: &Element, encoding: Encoding, values: &mut Values) -> Option<usize> {
    let mut rest = window;
    let mut take = |scalar: Scalar| {
        let (bytes, after) = rest.split_at_checked(scalar.size())?;
        rest = after;
        Some(decode(bytes, scalar, encoding))
    };
    for property in &element.properties {
        values.starts.push(values.items.len());
        let value = take(property.length.unwrap_or(property.item))?;
        values.scalars.push(value);
        if property.length.is_some() {
            // One that is longer than the window ends there.
            let length = list_length(value, &property.name).ok()?;
            for _ in 0..length {
                values.items.push(take(property.item)?);
            }
        }
    }
    Some(window.len() - rest.len())
}

/// The number that begins `bytes`.
#[inline]
fn decode(bytes: &[u8], scalar: Scalar, encoding: Encoding) -> f64 {
    macro_rules! number {
        ($kind:ty) => {{
            let mut word = [0; size_of::<$kind>()];
            word.copy_from_slice(&bytes[..size_of::<$kind>()]);
            if encoding == Encoding::BigEndian {
                word.reverse();
            }
            f64::from(<$kind>::from_le_bytes(word))
        }};
    }
    match scalar {
        Scalar::I8 => number!(i8),
        Scalar::U8 => number!(u8),
        Scalar::I16 => number!(i16),
        Scalar::U16 => number!(u16),
        Scalar::I32 => number!(i32),
        Scalar::U32 => number!(u32),
        Scalar::F32 => number!(f32),
        Scalar::F64 => number!(f64),
    }
}

fn list_length(value: f64, name: &str) -> Result<usize, Failure> {
    if (0.0..=4_294_967_295.0).contains(&value) && value == libm::floor(value) {
        return Ok(value as usize);
    }
    Err(Failure::here(format!("list `{name}` has {value} items")))
}

fn parse(word: &str, scalar: Scalar) -> Result<f64, Failure> {
    let wrong = |_| Failure::here(format!("`{}` is not a number", word.escape_debug()));
    // Through f32 for a float property: one rounding, as its writer did.
    let value = match scalar {
        Scalar::F32 => f64::from(word.parse::<f32>().map_err(wrong)?),
        _ => word.parse::<f64>().map_err(wrong)?,
    };
    let whole = scalar.is_float() || value == libm::trunc(value);
    if whole { Ok(value) } else { Err(Failure::here(format!("`{word}` is not an integer"))) }
}
