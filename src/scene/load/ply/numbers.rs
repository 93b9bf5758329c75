//! The numbers after a PLY header, one element at a time.

use super::Place;
use super::header::{Element, Encoding, Header, Scalar};

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
    bytes: &'a [u8],
    encoding: Encoding,
    at: usize,
    line: u32,
}

impl<'a> Reader<'a> {
    pub fn new(bytes: &'a [u8], header: &Header) -> Self {
        Self { bytes, encoding: header.encoding, at: header.end, line: header.lines }
    }

    pub fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Where the element last read lies.
    pub fn place(&self) -> Place {
        match self.encoding {
            Encoding::Ascii => Place::Line(self.line),
            _ => Place::Byte(self.at),
        }
    }

    /// Reads the next element into `values`.
    pub fn read(&mut self, element: &Element, values: &mut Values) -> Result<(), String> {
        values.scalars.clear();
        values.starts.clear();
        values.items.clear();
        match self.encoding {
            Encoding::Ascii => self.read_line(element, values)?,
            _ => self.read_bytes(element, values)?,
        }
        values.starts.push(values.items.len());
        Ok(())
    }

    /// An element is a line; empty lines are skipped.
    fn read_line(&mut self, element: &Element, values: &mut Values) -> Result<(), String> {
        let mut words = loop {
            let rest = &self.bytes[self.at..];
            if rest.is_empty() {
                return Err("the file ends".to_owned());
            }
            let length = rest.iter().position(|b| *b == b'\n' || *b == b'\r').unwrap_or(rest.len());
            let end = if rest[length..].starts_with(b"\r\n") { length + 2 } else { length + 1 };
            self.at += end.min(rest.len());
            self.line += 1;
            let line = std::str::from_utf8(&rest[..length]).map_err(|_| "the line is not text".to_owned())?;
            if !line.trim_ascii().is_empty() {
                break line.split_ascii_whitespace();
            }
        };
        for property in &element.properties {
            values.starts.push(values.items.len());
            let mut next = |scalar| match words.next() {
                Some(word) => parse(word, scalar),
                None => Err(format!("the line ends before property `{}`", property.name)),
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
            Some(word) => Err(format!("`{}` follows the last property", word.escape_debug())),
            None => Ok(()),
        }
    }

    fn read_bytes(&mut self, element: &Element, values: &mut Values) -> Result<(), String> {
        for property in &element.properties {
            values.starts.push(values.items.len());
            let Some(length) = property.length else {
                let value = self.take(property.item)?;
                values.scalars.push(value);
                continue;
            };
            let length = list_length(self.take(length)?, &property.name)?;
            if length.saturating_mul(property.item.size()) > self.remaining() {
                return Err(format!("a list of {length} items runs over the end of the file"));
            }
            values.scalars.push(length as f64);
            for _ in 0..length {
                let value = self.take(property.item)?;
                values.items.push(value);
            }
        }
        Ok(())
    }

    fn take(&mut self, scalar: Scalar) -> Result<f64, String> {
        let size = scalar.size();
        let Some(bytes) = self.bytes.get(self.at..self.at + size) else {
            return Err("the file ends".to_owned());
        };
        self.at += size;
        let mut word = [0u8; 8];
        word[..size].copy_from_slice(bytes);
        if self.encoding == Encoding::BigEndian {
            word[..size].reverse();
        }
        let low = u64::from_le_bytes(word);
        Ok(match scalar {
            Scalar::I8 => f64::from(low as i8),
            Scalar::U8 => f64::from(low as u8),
            Scalar::I16 => f64::from(low as i16),
            Scalar::U16 => f64::from(low as u16),
            Scalar::I32 => f64::from(low as i32),
            Scalar::U32 => f64::from(low as u32),
            Scalar::F32 => f64::from(f32::from_bits(low as u32)),
            Scalar::F64 => f64::from_bits(low),
        })
    }
}

fn list_length(value: f64, name: &str) -> Result<usize, String> {
    if (0.0..=4_294_967_295.0).contains(&value) && value == libm::floor(value) {
        return Ok(value as usize);
    }
    Err(format!("list `{name}` has {value} items"))
}

fn parse(word: &str, scalar: Scalar) -> Result<f64, String> {
    let wrong = || format!("`{}` is not a number", word.escape_debug());
    // Through f32 for a float property: one rounding, as its writer did.
    let value = match scalar {
        Scalar::F32 => f64::from(word.parse::<f32>().map_err(|_| wrong())?),
        _ => word.parse::<f64>().map_err(|_| wrong())?,
    };
    let whole = scalar.is_float() || value == libm::trunc(value);
    if whole { Ok(value) } else { Err(format!("`{word}` is not an integer")) }
}
