//! The `.gfilm` file: a film as it is, to be merged later.
//!
//! Little-endian, in this order:
//!
//! | bytes | what |
//! |---|---|
//! | 8 | magic `GFILM\r\n\x1a` (a transfer in text mode breaks it) |
//! | 4 | format version, 1 |
//! | 4 | length H of the header, at most 1 MiB |
//! | H | header: JSON, UTF-8, the fields of `Header` |
//! | 32 n | for each of the n pixels of the crop, rows from the top: sums of r, g, b (i64, steps of 2^(e - 22)) and alpha (i64, steps of 2^-22) |
//! | 60 n | if `aovs`: for each pixel sums of normal x, y, z and albedo r, g, b (i64, steps of 2^-22), depth (f32), object, material (u32) |
//! | 32 | BLAKE3 of everything before |
//!
//! Nothing follows. A reader of version 1 refuses any other.

use super::sums::{AovSums, Film, FilmSpec, SUM_BITS};
use super::tone::{tonemap_from_name, tonemap_name};
use super::{FilmError, MAX_SAMPLES, Rect, SampleRanges};
use serde::{Deserialize, Serialize};
use std::io::{self, Read, Write};
use std::path::Path;

pub const MAGIC: [u8; 8] = *b"GFILM\r\n\x1a";
pub const VERSION: u32 = 1;
const MAX_HEADER: u32 = 1 << 20;
const SUM_BYTES: usize = 32;
const AOV_BYTES: usize = 60;
/// Pixels read at a time: memory grows with what the file holds, not with what its header claims.
const CHUNK_PIXELS: usize = 1 << 14;

/// The JSON header.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    /// Version of gonio that wrote it.
    gonio: String,
    scene: String,
    /// 64 hexadecimal digits.
    scene_digest: String,
    integrator: String,
    seed: u32,
    width: u32,
    height: u32,
    crop: Rect,
    /// e of `unit = 2^e`.
    unit_exponent: i32,
    /// [start, end) pairs.
    samples: Vec<[u32; 2]>,
    nan_count: u64,
    clamped_count: u64,
    /// 0 where it is missing.
    #[serde(default, skip_serializing_if = "is_zero")]
    limited_count: u64,
    transparent: bool,
    aovs: bool,
    tonemap: String,
    exposure: f32,
    /// sRGB where it is missing, as in films of version 0.1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    gamma: Option<f32>,
}

fn is_zero(count: &u64) -> bool {
    *count == 0
}

impl Header {
    fn of(film: &Film) -> Self {
        let spec = &film.spec;
        Self {
            gonio: spec.version.clone(),
            scene: spec.scene_name.clone(),
            scene_digest: blake3::Hash::from(spec.scene_digest).to_string(),
            integrator: spec.integrator.clone(),
            seed: spec.seed,
            width: spec.width,
            height: spec.height,
            crop: spec.crop,
            unit_exponent: spec.unit_exponent,
            samples: film.samples.as_slice().iter().map(|r| [r.start, r.end]).collect(),
            nan_count: film.nan_count,
            clamped_count: film.clamped_count,
            limited_count: film.limited_count,
            transparent: spec.transparent,
            aovs: spec.aovs,
            tonemap: tonemap_name(spec.tonemap).into(),
            exposure: spec.exposure,
            gamma: spec.gamma,
        }
    }

    /// Refuses what no film can be; the planes are still to come.
    fn check(self) -> Result<(FilmSpec, SampleRanges, [u64; 3]), String> {
        let size = 1..=65_535;
        if !size.contains(&self.width) || !size.contains(&self.height) {
            return Err(format!("the frame is {}x{}; allowed is 1 to 65535 each", self.width, self.height));
        }
        if self.crop.area() == 0 || !Rect::whole(self.width, self.height).contains(&self.crop) {
            return Err(format!("the crop {} is not inside the frame {}x{}", self.crop, self.width, self.height));
        }
        if !(-100..=100).contains(&self.unit_exponent) {
            return Err(format!("unit_exponent is {}; allowed is -100 to 100", self.unit_exponent));
        }
        if !self.exposure.is_finite() {
            return Err("exposure is not a finite number".into());
        }
        if let Some(gamma) = self.gamma.filter(|gamma| !(0.1..=10.0).contains(gamma)) {
            return Err(format!("gamma is {gamma}; allowed is 0.1 to 10"));
        }
        if let Some([start, end]) = self.samples.iter().find(|[start, end]| start >= end || *end > MAX_SAMPLES) {
            return Err(format!("sample range {start}..{end} is not inside 0..{MAX_SAMPLES}"));
        }
        let ranges = SampleRanges::new(self.samples.iter().map(|[start, end]| *start..*end));
        let ranges = ranges.map_err(|_| "sample ranges overlap".to_string())?;
        let digest = blake3::Hash::from_hex(&self.scene_digest);
        let digest =
            digest.map_err(|_| format!("scene_digest is {:?}, not 64 hexadecimal digits", self.scene_digest))?;
        let tonemap = tonemap_from_name(&self.tonemap).map_err(|e| format!("tonemap is {:?}; {e}", self.tonemap))?;
        let spec = FilmSpec {
            width: self.width,
            height: self.height,
            crop: self.crop,
            unit_exponent: self.unit_exponent,
            seed: self.seed,
            scene_digest: digest.into(),
            scene_name: self.scene,
            integrator: self.integrator,
            version: self.gonio,
            transparent: self.transparent,
            aovs: self.aovs,
            tonemap,
            exposure: self.exposure,
            gamma: self.gamma,
        };
        Ok((spec, ranges, [self.nan_count, self.clamped_count, self.limited_count]))
    }
}

/// Writes everything through a hasher.
struct Hashing<'a> {
    out: &'a mut dyn Write,
    hasher: blake3::Hasher,
}

impl Hashing<'_> {
    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hasher.update(bytes);
        self.out.write_all(bytes)
    }
}

/// Writes the film.
pub fn write(film: &Film, out: &mut dyn Write) -> io::Result<()> {
    let mut out = Hashing { out, hasher: blake3::Hasher::new() };
    let header = serde_json::to_vec(&Header::of(film)).map_err(io::Error::other)?;
    out.put(&MAGIC)?;
    out.put(&VERSION.to_le_bytes())?;
    out.put(&(header.len() as u32).to_le_bytes())?;
    out.put(&header)?;
    let mut bytes = Vec::new();
    for pixels in film.sums.chunks(CHUNK_PIXELS) {
        bytes.clear();
        bytes.extend(pixels.iter().flatten().flat_map(|lane| lane.to_le_bytes()));
        out.put(&bytes)?;
    }
    for pixels in film.aovs.iter().flat_map(|aovs| aovs.chunks(CHUNK_PIXELS)) {
        bytes.clear();
        for aov in pixels {
            bytes.extend(aov.normal.iter().chain(&aov.albedo).flat_map(|lane| lane.to_le_bytes()));
            bytes.extend(aov.depth.to_bits().to_le_bytes());
            bytes.extend(aov.object.to_le_bytes());
            bytes.extend(aov.material.to_le_bytes());
        }
        out.put(&bytes)?;
    }
    let checksum = out.hasher.finalize();
    out.out.write_all(checksum.as_bytes())
}

/// A stream of a known name, hashed as it is read.
struct Input<'a> {
    file: &'a Path,
    source: &'a mut dyn Read,
    hasher: blake3::Hasher,
    /// Bytes read so far.
    position: u64,
}

impl Input<'_> {
    fn bad(&self, message: impl Into<String>) -> FilmError {
        FilmError::bad(self.file, message)
    }

    /// Fills `bytes` or says what is missing.
    fn take(&mut self, bytes: &mut [u8], what: &str) -> Result<(), FilmError> {
        let mut filled = 0;
        while filled < bytes.len() {
            match self.source.read(&mut bytes[filled..]) {
                Ok(0) => {
                    let end = self.position + filled as u64;
                    return Err(self.bad(format!("truncated film: it ends after {end} bytes, inside the {what}")));
                }
                Ok(n) => filled += n,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(FilmError::read(self.file, error)),
            }
        }
        self.position += filled as u64;
        self.hasher.update(bytes);
        Ok(())
    }

    fn word(&mut self, what: &str) -> Result<u32, FilmError> {
        let mut bytes = [0; 4];
        self.take(&mut bytes, what)?;
        Ok(u32::from_le_bytes(bytes))
    }

    /// Reads `count` records of `size` bytes.
    fn records<T>(
        &mut self,
        count: usize,
        size: usize,
        what: &str,
        record: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, FilmError> {
        let mut records = Vec::new();
        let mut bytes = vec![0; CHUNK_PIXELS.min(count) * size];
        while records.len() < count {
            let chunk = &mut bytes[..CHUNK_PIXELS.min(count - records.len()) * size];
            self.take(chunk, what)?;
            // What a header claims is not believed; what is there is claimed as it comes, since the array doubles.
            if records.len() == records.capacity() {
                FilmError::claim(self.file, "the film", (2 * records.len() * size_of::<T>()) as u64)?;
            }
            records.extend(chunk.chunks_exact(size).map(&record));
        }
        Ok(records)
    }
}

/// The i64 number `i` of a record.
fn lane(bytes: &[u8], i: usize) -> i64 {
    i64::from_le_bytes(std::array::from_fn(|k| bytes[8 * i + k]))
}

/// The 32-bit word at byte `at`.
fn word_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(std::array::from_fn(|k| bytes[at + k]))
}

fn aov_record(bytes: &[u8]) -> AovSums {
    AovSums {
        normal: std::array::from_fn(|i| lane(bytes, i)),
        albedo: std::array::from_fn(|i| lane(bytes, 3 + i)),
        depth: f32::from_bits(word_at(bytes, 48)),
        object: word_at(bytes, 52),
        material: word_at(bytes, 56),
    }
}

/// Reads a film to the end of `source`; `file` is its name in messages, `-` for standard input.
pub fn read(file: &Path, source: &mut dyn Read) -> Result<Film, FilmError> {
    let mut input = Input { file, source, hasher: blake3::Hasher::new(), position: 0 };
    let mut magic = [0; 8];
    input.take(&mut magic, "magic")?;
    if magic != MAGIC {
        return Err(input.bad("not a gonio film (wrong magic)"));
    }
    let version = input.word("version")?;
    if version > VERSION {
        return Err(input.bad(format!("film format {version} is newer than this program's, {VERSION}")));
    }
    if version != VERSION {
        return Err(input.bad(format!("film format {version} does not exist; this program reads {VERSION}")));
    }
    let length = input.word("header length")?;
    if length > MAX_HEADER {
        return Err(input.bad(format!("the header claims {length} bytes; at most {MAX_HEADER} are allowed")));
    }
    let mut header = vec![0; length as usize];
    input.take(&mut header, "header")?;
    let header: Header = serde_json::from_slice(&header).map_err(|e| input.bad(format!("film header: {e}")))?;
    let (spec, samples, [nan_count, clamped_count, limited_count]) =
        header.check().map_err(|e| input.bad(format!("film header: {e}")))?;

    let area = spec.crop.area();
    let sums = input.records(area, SUM_BYTES, "sums", |bytes| std::array::from_fn(|i| lane(bytes, i)))?;
    let aovs = match spec.aovs {
        true => Some(input.records(area, AOV_BYTES, "auxiliary values", aov_record)?),
        false => None,
    };
    let expected = input.hasher.finalize();
    let mut checksum = [0; 32];
    input.take(&mut checksum, "checksum")?;
    if expected != checksum {
        return Err(input.bad("damaged film: the checksum does not match the content"));
    }
    let mut rest = [0; 1];
    if input.take(&mut rest, "rest").is_ok() {
        return Err(input.bad("bytes follow the end of the film"));
    }
    let film = Film { spec, sums, aovs, samples, nan_count, clamped_count, limited_count };
    film.check_bounds().map_err(|e| input.bad(e))?;
    Ok(film)
}

impl Film {
    /// Whether every sum is one that this many samples can have: what keeps later merges from overflowing.
    fn check_bounds(&self) -> Result<(), String> {
        let bound = self.samples.total() << SUM_BITS;
        let within = |sums: &[i64], bound: u64| sums.iter().all(|sum| sum.unsigned_abs() <= bound);
        let width = self.spec.crop.width as usize;
        let place = |i: usize| (i % width, i / width);
        if let Some(i) = self.sums.iter().position(|sums| !within(sums, bound)) {
            return Err(format!(
                "sums of pixel {:?} of the crop exceed what {} samples can add up to",
                place(i),
                self.samples.total()
            ));
        }
        // A contribution is clamped at twice what a sample may hold, and auxiliary values are not clamped again.
        let aovs = self.aovs.iter().flatten();
        if let Some(i) =
            aovs.into_iter().position(|aov| !within(&aov.normal, 2 * bound) || !within(&aov.albedo, 2 * bound))
        {
            return Err(format!("auxiliary sums of pixel {:?} of the crop are out of range", place(i)));
        }
        Ok(())
    }
}
