//! The header of a PLY file: what elements there are, and of what.

use super::Place;

/// How the numbers after the header are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// In bytes.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// What a colour of this type is divided by.
    pub fn full_scale(self) -> f64 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32_767.0,
            Self::U16 => 65_535.0,
            Self::I32 => 2_147_483_647.0,
            Self::U32 => 4_294_967_295.0,
            Self::F32 | Self::F64 => 1.0,
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Property {
    pub name: String,
    /// The type of a list's length, for a list.
    pub length: Option<Scalar>,
    pub item: Scalar,
}

#[derive(Clone, Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

impl Element {
    /// Bytes one of these takes at least: a digit and a separator for each number, or empty lists.
    pub fn size_min(&self, encoding: Encoding) -> usize {
        let size = |p: &Property| match encoding {
            Encoding::Ascii => 2,
            _ => p.length.unwrap_or(p.item).size(),
        };
        self.properties.iter().map(size).sum()
    }

    /// The place of the scalar property with one of these names.
    pub fn find(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|p| p.length.is_none() && names.contains(&p.name.as_str()))
    }

    pub fn find_list(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|p| p.length.is_some() && names.contains(&p.name.as_str()))
    }
}

#[derive(Clone, Debug)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// Where the numbers start, in bytes.
    pub end: usize,
    /// Lines of the header.
    pub lines: u32,
}

type Failure = (Place, String);

/// Most header lines read before the file is taken for something else.
const LINES_MAX: u32 = 10_000;

pub(super) fn parse(bytes: &[u8]) -> Result<Header, Failure> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let (mut at, mut line_number) = (0, 0);
    loop {
        let Some((line, next)) = next_line(bytes, at) else {
            return Err((Place::Line(line_number + 1), "the header has no end_header".to_owned()));
        };
        at = next;
        line_number += 1;
        let fail = |message: String| Err((Place::Line(line_number), message));
        let Ok(line) = std::str::from_utf8(line) else {
            return fail("the header is not text".to_owned());
        };
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        if line_number == 1 {
            if words != ["ply"] {
                return fail("not a PLY file: the first line is not `ply`".to_owned());
            }
            continue;
        }
        if line_number > LINES_MAX {
            return fail(format!("a header of more than {LINES_MAX} lines"));
        }
        match words.as_slice() {
            [] | ["comment" | "obj_info", ..] => {}
            ["end_header"] => break,
            ["format", name, version] => {
                encoding = Some(match *name {
                    "ascii" => Encoding::Ascii,
                    "binary_little_endian" => Encoding::LittleEndian,
                    "binary_big_endian" => Encoding::BigEndian,
                    _ => {
                        let allowed = "ascii, binary_little_endian, binary_big_endian";
                        return fail(format!("unknown format `{name}`; allowed are {allowed}"));
                    }
                });
                if *version != "1.0" {
                    return fail(format!("version {version}; only 1.0 is known"));
                }
            }
            ["element", name, count] => match count.parse() {
                Ok(count) => elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new() }),
                Err(_) => return fail(format!("`{count}` is not a count of elements")),
            },
            ["property", rest @ ..] => {
                let Some(element) = elements.last_mut() else {
                    return fail("a property before the first element".to_owned());
                };
                match property(rest) {
                    Ok(property) => element.properties.push(property),
                    Err(message) => return fail(message),
                }
            }
            _ => {
                return fail(format!("unknown header line `{}`", line.trim().escape_debug()));
            }
        }
    }
    let Some(encoding) = encoding else {
        return Err((Place::Line(line_number), "the header has no format line".to_owned()));
    };
    Ok(Header { encoding, elements, end: at, lines: line_number })
}

/// The line that starts at `at`, without its end, and where the next one starts. Ends are \n, \r\n or a lone \r.
fn next_line(bytes: &[u8], at: usize) -> Option<(&[u8], usize)> {
    let rest = bytes.get(at..).filter(|rest| !rest.is_empty())?;
    let Some(length) = rest.iter().position(|b| *b == b'\n' || *b == b'\r') else {
        // The last line of the header may be the last of the file.
        return (rest == b"end_header").then_some((rest, bytes.len()));
    };
    let end = if rest[length..].starts_with(b"\r\n") { length + 2 } else { length + 1 };
    Some((&rest[..length], at + end))
}

fn property(words: &[&str]) -> Result<Property, String> {
    let scalar = |name: &str| {
        let allowed = "char, uchar, short, ushort, int, uint, float, double";
        Scalar::named(name).ok_or_else(|| format!("unknown type `{name}`; allowed are {allowed}"))
    };
    match words {
        ["list", length, item, name] => {
            let length = scalar(length)?;
            if length.is_float() {
                return Err("the length of a list has an integer type".to_owned());
            }
            Ok(Property { name: (*name).to_owned(), length: Some(length), item: scalar(item)? })
        }
        [item, name] if *item != "list" => Ok(Property { name: (*name).to_owned(), length: None, item: scalar(item)? }),
        _ => Err("a property is `property TYPE NAME` or `property list TYPE TYPE NAME`".to_owned()),
    }
}
