//! The bytes behind a glTF: the two forms of the file, its buffers, and what URIs stand for.

use super::Failure;
use crate::scene::load::text::read_bytes;
use base64::Engine;
use base64::engine::general_purpose::{STANDARD, STANDARD_NO_PAD};
use gltf::json::{Index, Root, buffer};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The JSON text and the binary chunk, if there is one, of a .gltf or .glb file.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Failure> {
    const JSON: u32 = 0x4e4f_534a;
    const BIN: u32 = 0x004e_4942;
    if !bytes.starts_with(b"glTF") {
        // A byte order mark is allowed to be ignored (RFC 8259, section 8.1).
        return Ok((bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), None));
    }
    let word = |at: usize| -> Option<u32> {
        let bytes = bytes.get(at..at.checked_add(4)?)?;
        Some(u32::from_le_bytes(bytes.try_into().ok()?))
    };
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return Err(Failure::new("GLB header", "the file ends within it"));
    };
    if version != 2 {
        return Err(Failure::new("GLB header", format!("version {version}; only 2 is known")));
    }
    if length as usize > bytes.len() {
        return Err(Failure::new("GLB header", format!("claims {length} bytes; the file has {}", bytes.len())));
    }
    let (mut at, mut json, mut binary) = (12, None, None);
    while at < length as usize {
        let place = format!("GLB chunk at byte {at}");
        let (Some(size), Some(kind)) = (word(at), word(at + 4)) else {
            return Err(Failure::new(place, "the file ends within its header"));
        };
        let Some(data) = bytes.get(at + 8..).and_then(|rest| rest.get(..size as usize)) else {
            return Err(Failure::new(place, format!("claims {size} bytes; {} follow", bytes.len() - at - 8)));
        };
        match kind {
            JSON if json.is_none() => json = Some(data),
            BIN if binary.is_none() => binary = Some(data),
            // Other chunks belong to extensions and are to be skipped (glTF 2.0, section 4.4.3).
            _ => {}
        }
        at += 8 + size as usize;
    }
    let json = json.ok_or_else(|| Failure::new("GLB", "there is no JSON chunk"))?;
    Ok((json, binary))
}

/// All buffers, each exactly as long as it says.
pub(super) struct Buffers<'a> {
    data: Vec<Cow<'a, [u8]>>,
}

impl<'a> Buffers<'a> {
    pub fn read(root: &Root, binary: Option<&'a [u8]>, folder: &Path) -> Result<Self, Failure> {
        let read = |(i, buffer): (usize, &gltf::json::Buffer)| {
            let place = format!("buffers[{i}]");
            let mut data = match (&buffer.uri, binary) {
                (Some(uri), _) => Cow::Owned(read_uri(uri, folder, &place)?),
                (None, Some(binary)) if i == 0 => Cow::Borrowed(binary),
                (None, _) => {
                    return Err(Failure::new(place, "has no uri, and there is no binary chunk for it"));
                }
            };
            let length = buffer.byte_length.0;
            if (data.len() as u64) < length {
                let message = format!("claims {length} bytes; there are {}", data.len());
                return Err(Failure::new(place, message));
            }
            match &mut data {
                Cow::Owned(data) => data.truncate(length as usize),
                Cow::Borrowed(data) => *data = &data[..length as usize],
            }
            Ok(data)
        };
        let (mut data, mut failures) = (Vec::new(), Vec::new());
        for buffer in root.buffers.iter().enumerate() {
            match read(buffer) {
                Ok(bytes) => data.push(bytes),
                Err(failure) => failures.push(failure),
            }
        }
        if failures.is_empty() { Ok(Self { data }) } else { Err(Failure::Several(failures)) }
    }

    /// The bytes of a buffer view, and its stride if it has one. `place` refers to it.
    pub fn view(
        &self,
        root: &Root,
        index: Index<buffer::View>,
        place: &str,
    ) -> Result<(&[u8], Option<usize>), Failure> {
        let Some(view) = root.buffer_views.get(index.value()) else {
            let message = format!("refers to bufferView {index}; there are {}", root.buffer_views.len());
            return Err(Failure::new(place, message));
        };
        let place = format!("bufferViews[{index}]");
        let Some(data) = self.data.get(view.buffer.value()) else {
            let message = format!("refers to buffer {}; there are {}", view.buffer, self.data.len());
            return Err(Failure::new(place, message));
        };
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let slice = start
            .checked_add(view.byte_length.0)
            .and_then(|end| data.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?));
        let Some(slice) = slice else {
            let message = format!(
                "{} bytes from {start} run over the end of buffer {}, which has {}",
                view.byte_length.0,
                view.buffer,
                data.len()
            );
            return Err(Failure::new(place, message));
        };
        Ok((slice, view.byte_stride.map(|stride| stride.0)))
    }
}

/// What `uri` stands for: data written in it, or a file relative to `folder`.
pub(super) fn read_uri(uri: &str, folder: &Path, place: &str) -> Result<Vec<u8>, Failure> {
    if let Some(rest) = uri.strip_prefix("data:") {
        return decode_data(rest).map_err(|message| Failure::new(place, message));
    }
    let path = file_of(uri, folder).map_err(|message| Failure::new(place, message))?;
    read_bytes(&path).map_err(|error| Failure::File { place: place.to_owned(), error })
}

/// The file that a relative URI names.
pub(super) fn file_of(uri: &str, folder: &Path) -> Result<PathBuf, String> {
    let scheme = uri.split_once(':').map(|(scheme, _)| scheme);
    // One letter is a drive, not a scheme.
    if let Some(scheme) =
        scheme.filter(|s| s.len() > 1 && s.bytes().all(|b| b.is_ascii_alphanumeric() || b"+-.".contains(&b)))
    {
        return Err(format!("cannot read URIs of scheme `{scheme}`; allowed are data: and relative files"));
    }
    Ok(folder.join(percent_decode(uri)?))
}

fn decode_data(rest: &str) -> Result<Vec<u8>, String> {
    let Some((kind, data)) = rest.split_once(',') else {
        return Err("the data URI has no comma".to_owned());
    };
    if !kind.ends_with(";base64") {
        return percent_decode(data).map(String::into_bytes);
    }
    let engine = if data.ends_with('=') { &STANDARD } else { &STANDARD_NO_PAD };
    engine.decode(data).map_err(|e| format!("the data URI is not base64: {e}"))
}

/// RFC 3986, section 2.1.
fn percent_decode(text: &str) -> Result<String, String> {
    let bytes = text.as_bytes();
    let (mut out, mut i) = (Vec::with_capacity(bytes.len()), 0);
    while i < bytes.len() {
        let digit = |at: usize| bytes.get(at).and_then(|b| char::from(*b).to_digit(16));
        match (bytes[i], digit(i + 1), digit(i + 2)) {
            (b'%', Some(high), Some(low)) => {
                out.push((high * 16 + low) as u8);
                i += 3;
            }
            // A lone percent sign is wrong but means itself.
            (byte, ..) => {
                out.push(byte);
                i += 1;
            }
        }
    }
    String::from_utf8(out).map_err(|_| "the URI is not UTF-8".to_owned())
}
