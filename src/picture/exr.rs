//! OpenEXR through the `exr` crate: its windows, channels and chromaticities.
//!
//! Source: OpenEXR, "Technical Introduction to OpenEXR" (windows, channel names) and "Standard attributes".

use super::channels::{Choice, GREY, Kind, choose};
use super::chromaticity::{self, Chromaticities, REC709};
use super::{Picture, Purpose, SizeCheck};
use exr::block::UncompressedBlock;
use exr::block::lines::LineRef;
use exr::block::reader::ChunksReader;
use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{Error, SampleType, Vec2, f16};
use std::io::Cursor;

/// How a file begins.
pub const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Pixels from `min` up to, without, `max`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Window {
    min: [i64; 2],
    max: [i64; 2],
}

impl Window {
    fn new(position: Vec2<i32>, size: Vec2<usize>) -> Self {
        let min = [i64::from(position.0), i64::from(position.1)];
        Self { min, max: [min[0].saturating_add(size.0 as i64), min[1].saturating_add(size.1 as i64)] }
    }

    fn intersection(self, other: Self) -> Self {
        let min = [0, 1].map(|i| self.min[i].max(other.min[i]));
        Self { min, max: [0, 1].map(|i| self.max[i].min(other.max[i]).max(min[i])) }
    }

    fn size(self) -> [u64; 2] {
        [0, 1].map(|i| (self.max[i] - self.min[i]) as u64)
    }
}

/// Reads the picture in `bytes`. `check` is asked about the data window and about what is shown, before memory is taken. The
/// largest level of mip-mapped files is read, and of several parts and layers the one that `channels` prefers.
pub fn read<E: From<String>>(bytes: &[u8], purpose: Purpose, check: SizeCheck<E>) -> Result<Picture, E> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|e| explain(&e, bytes))?;
    let choice = choose(&meta.headers, purpose)?;
    let header = &meta.headers[choice.part];
    let stored = Window::new(header.own_attributes.layer_position, header.layer_size);
    let display = header.shared_attributes.display_window;
    let display = Window::new(display.position, display.size);
    let shown = match purpose {
        Purpose::Colors | Purpose::Data => display,
        Purpose::Compared => display.intersection(stored),
        Purpose::Mitsuba => stored,
    };
    let [width, height] = shown.size();
    if width == 0 || height == 0 {
        let message = "the data window of this EXR lies outside its display window: there is nothing to see";
        return Err(message.to_owned().into());
    }
    let [stored_width, stored_height] = stored.size();
    check(stored_width, stored_height)?;
    check(width, height)?;
    // Every chunk has at least an entry in the offset table and a header of its own.
    if meta.headers.iter().any(|header| header.chunk_count.saturating_mul(16) > bytes.len()) {
        return Err("truncated EXR: fewer bytes than its chunks need".to_owned().into());
    }
    let mut canvas = Canvas { shown, stored, pixels: vec![[0.0; 4]; (width * height) as usize] };
    canvas.fill(bytes, &choice).map_err(|e| explain(&e, bytes))?;
    if !choice.lanes.contains(&Some(3)) {
        canvas.make_opaque();
    }
    let mut pixels = canvas.pixels;
    if let Some(matrix) = conversion(header, choice.kind, purpose) {
        chromaticity::convert(&mut pixels, matrix);
    }
    Ok(Picture { width: width as u32, height: height as u32, pixels })
}

/// What turns the stored colours into Rec. 709; none where they are.
fn conversion(header: &Header, kind: Kind, purpose: Purpose) -> Option<glam::DMat3> {
    if purpose == Purpose::Data || kind == Kind::Grey {
        return None;
    }
    if kind == Kind::Xyz {
        return Some(chromaticity::xyz_to_rec709());
    }
    let written = header.shared_attributes.chromaticities?;
    let pair = |v: Vec2<f32>| [f64::from(v.0), f64::from(v.1)];
    let of_file = Chromaticities {
        red: pair(written.red),
        green: pair(written.green),
        blue: pair(written.blue),
        white: pair(written.white),
    };
    if of_file.is_nearly(&REC709) {
        return None;
    }
    // Some programs write zeros where they know none.
    chromaticity::to_rec709(&of_file, purpose != Purpose::Mitsuba)
}

/// The picture under way.
struct Canvas {
    shown: Window,
    stored: Window,
    pixels: Vec<[f32; 4]>,
}

impl Canvas {
    /// Decodes the chosen channels.
    fn fill(&mut self, bytes: &[u8], choice: &Choice) -> exr::error::UnitResult {
        let reader = exr::block::read(Cursor::new(bytes), false)?;
        let largest = |block: &exr::block::BlockIndex| block.layer == choice.part && block.level == Vec2(0, 0);
        let chunks = reader.filter_chunks(false, |_, _, block| largest(&block))?;
        chunks.decompress_parallel(false, |meta, block| self.place_block(meta, &block, choice))
    }

    fn place_block(&mut self, meta: &MetaData, block: &UncompressedBlock, choice: &Choice) -> exr::error::UnitResult {
        let channels = &meta.headers[choice.part].channels;
        for line in block.lines(channels) {
            let Some(lane) = choice.lanes[line.location.channel] else { continue };
            match channels.list[line.location.channel].sample_type {
                SampleType::F16 => self.place_line(&line, lane, line.read_samples::<f16>().map(|v| Ok(v?.to_f32())))?,
                SampleType::F32 => self.place_line(&line, lane, line.read_samples::<f32>())?,
                SampleType::U32 => self.place_line(&line, lane, line.read_samples::<u32>().map(|v| Ok(v? as f32)))?,
            }
        }
        Ok(())
    }

    fn place_line(
        &mut self,
        line: &LineRef,
        lane: usize,
        samples: impl Iterator<Item = exr::error::Result<f32>>,
    ) -> exr::error::UnitResult {
        let Vec2(x, y) = line.location.position;
        let (x, y) = (self.stored.min[0] + x as i64, self.stored.min[1] + y as i64);
        if y < self.shown.min[1] || y >= self.shown.max[1] {
            return Ok(());
        }
        let row = (y - self.shown.min[1]) * (self.shown.max[0] - self.shown.min[0]);
        for (x, sample) in (x..self.shown.max[0]).zip(samples) {
            if x < self.shown.min[0] {
                continue;
            }
            let pixel = &mut self.pixels[(row + x - self.shown.min[0]) as usize];
            let value = sample?;
            match lane {
                GREY => pixel[..3].fill(value),
                lane => pixel[lane] = value,
            }
        }
        Ok(())
    }

    /// Alpha 1 where there is data: the file has none.
    fn make_opaque(&mut self) {
        let there = self.shown.intersection(self.stored);
        let width = self.shown.max[0] - self.shown.min[0];
        for y in there.min[1]..there.max[1] {
            let row = (y - self.shown.min[1]) * width - self.shown.min[0];
            for pixel in &mut self.pixels[(row + there.min[0]) as usize..(row + there.max[0]) as usize] {
                pixel[3] = 1.0;
            }
        }
    }
}

/// What an error of the crate means for who has the file.
fn explain(error: &Error, bytes: &[u8]) -> String {
    if matches!(error, Error::NotSupported(what) if what.contains("subsampling")) {
        return "subsampled EXR channels (luminance and chroma) are not supported; write it as RGB".to_owned();
    }
    match compression(bytes) {
        Some(code) if code > 9 => {
            let name = match code {
                10 | 11 => "HTJ2K",
                12 => "LJ2K",
                13 => "ZSTD",
                _ => "unknown here",
            };
            format!(
                "the EXR's compression ({name}, number {code}) is not supported; write it with none, RLE, ZIP, PIZ, PXR24, \
                 B44 or DWA"
            )
        }
        _ => format!("cannot decode the picture: {error}"),
    }
}

/// The number that the first part's attribute "compression" holds.
fn compression(bytes: &[u8]) -> Option<u8> {
    const ATTRIBUTE: &[u8] = b"compression\0compression\0\x01\0\0\0";
    let at = bytes.windows(ATTRIBUTE.len()).position(|window| window == ATTRIBUTE)?;
    bytes.get(at + ATTRIBUTE.len()).copied()
}
