//! The header of a PLY file: what elements there are, and of what.

use super::{Failure, Place};
use crate::scene::load::stream::Stream;

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

    /// Bytes of one of these in a binary file; None if it has lists.
    pub fn fixed_size(&self) -> Option<usize> {
        let size = |p: &Property| p.length.is_none().then_some(p.item.size());
        self.properties.iter().map(size).sum()
    }

    pub fn find_list(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|p| p.length.is_some() && names.contains(&p.name.as_str()))
    }
}

#[derive(Clone, Debug)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// Pictures, by `comment TextureFile`.
    pub textures: Vec<String>,
    /// Lines of the header.
    pub lines: u32,
}

impl Header {
    /// Whether faces or strips come before the vertices that they are made of.
    pub fn faces_come_first(&self) -> bool {
        let place = |names: &[&str]| self.elements.iter().position(|element| names.contains(&element.name.as_str()));
        matches!((place(&["face", "tristrips"]), place(&["vertex"])), (Some(face), Some(vertex)) if face < vertex)
    }

    /// Whether corners of faces have texture coordinates.
    pub fn has_wedges(&self) -> bool {
        self.elements.iter().any(|element| element.name == "face" && element.find_list(&["texcoord"]).is_some())
    }
}

/// Most header lines read before the file is taken for something else.
const LINES_MAX: u32 = 10_000;

/// Reads the header, after which the numbers follow in `stream`.
pub(super) fn parse(stream: &mut Stream) -> Result<Header, Failure> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut textures = Vec::new();
    let mut line_number = 0;
    loop {
        if !stream.next_line()? {
            return Err(Failure::at(Place::Line(line_number + 1), "the header has no end_header"));
        }
        line_number += 1;
        let fail = |message: String| Err(Failure::at(Place::Line(line_number), message));
        if line_number > LINES_MAX {
            return fail(format!("a header of more than {LINES_MAX} lines"));
        }
        let line = stream.line();
        // Comments are in whatever encoding their writer's system had.
        if line_number > 1 && (line.starts_with(b"comment") || line.starts_with(b"obj_info")) {
            let text = String::from_utf8_lossy(line);
            if let Some(name) = text.strip_prefix("comment").and_then(|rest| rest.trim().strip_prefix("TextureFile")) {
                textures.push(name.trim().to_owned());
            }
            continue;
        }
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
        match words.as_slice() {
            [] => {}
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
        return Err(Failure::at(Place::Line(line_number), "the header has no format line"));
    };
    Ok(Header { encoding, elements, textures, lines: line_number })
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
