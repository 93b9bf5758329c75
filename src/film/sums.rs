//! The film itself: signed fixed-point sums per pixel. Integer sums do not care about order, threads, devices or
//! restarts, which is what makes a picture the same bits however it was computed.

use super::display::Display;
use super::{MAX_SAMPLES, MergeError, Rect, SampleRanges};
use crate::layout::{AovPixel, FilmSum, INVALID, T_INFINITE};
use crate::scene::{Integrator, Scene, ToneMap};
use rayon::prelude::*;
use std::ops::Range;
use std::path::Path;

/// C + k of the fixed-point film: no sample's sum exceeds 2^38 (2^16 film units in steps of 2^-22), so
/// `MAX_SAMPLES` of them stay within 2^62.
pub const SUM_BITS: u32 = 38;

/// What a film is of. Two films merge only if all of it agrees but the names and the defaults of display.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmSpec {
    /// Full frame in pixels, 1 to 65,535 each.
    pub width: u32,
    pub height: u32,
    /// The part this film holds; not empty, inside the frame.
    pub crop: Rect,
    /// e of `unit = 2^e`, -100 to 100.
    pub unit_exponent: i32,
    pub seed: u32,
    /// BLAKE3 of everything in the scene that reaches a sample; the caller's, the film only compares it.
    pub scene_digest: [u8; 32],
    /// The scene file's name without its folder (so that the same picture is the same file everywhere); shown, not compared.
    pub scene_name: String,
    /// As scene files write it: "local", "whitted".
    pub integrator: String,
    /// Version of the program that made it; shown, not compared.
    pub version: String,
    /// Whether the background was left out of r, g, b, so that alpha (coverage) means something in the picture.
    pub transparent: bool,
    /// Whether auxiliary values are kept.
    pub aovs: bool,
    /// How the picture is displayed unless the command line says otherwise; not compared.
    pub tonemap: ToneMap,
    /// In stops; not compared.
    pub exposure: f32,
    /// Of the display; none: sRGB; not compared.
    pub gamma: Option<f32>,
}

impl FilmSpec {
    /// The whole frame of a scene as it is baked: `transparent` without its background, with auxiliary values if `aovs`.
    pub fn of(scene: &Scene, scene_digest: [u8; 32], transparent: bool, aovs: bool) -> Self {
        let integrator = match scene.settings.integrator {
            Integrator::Local => "local",
            Integrator::Whitted => "whitted",
            Integrator::Direct => "direct",
            Integrator::Path => "path",
        };
        let name = Path::new(&scene.name).file_name();
        Self {
            width: scene.film.width,
            height: scene.film.height,
            crop: Rect::whole(scene.film.width, scene.film.height),
            unit_exponent: scene.film.unit_exponent,
            seed: scene.settings.seed,
            scene_digest,
            scene_name: name.map_or_else(|| scene.name.clone(), |name| name.to_string_lossy().into_owned()),
            integrator: integrator.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            transparent,
            aovs,
            tonemap: scene.film.tonemap,
            exposure: scene.film.exposure,
            gamma: scene.film.gamma,
        }
    }

    /// How the picture is displayed.
    pub fn display(&self) -> Display {
        Display { tonemap: self.tonemap, exposure: self.exposure, gamma: self.gamma, transparent: self.transparent }
    }
}

/// Auxiliary values of one pixel, as `layout::AovPixel` with its unused lanes left out. Sums have scale 2^22.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AovSums {
    pub normal: [i64; 3],
    pub albedo: [i64; 3],
    /// Of sample 0: distance (`T_INFINITE` on a miss), object, material (`INVALID` on a miss).
    pub depth: f32,
    pub object: u32,
    pub material: u32,
}

impl Default for AovSums {
    fn default() -> Self {
        Self { normal: [0; 3], albedo: [0; 3], depth: T_INFINITE, object: INVALID, material: INVALID }
    }
}

/// Signed fixed-point sums per pixel of a crop, and which samples they are the sums of.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    pub(super) spec: FilmSpec,
    /// r, g, b in steps of 2^(e - 22) and alpha in steps of 2^-22, rows of the crop from the top.
    pub(super) sums: Vec<[i64; 4]>,
    /// As `sums`, if kept.
    pub(super) aovs: Option<Vec<AovSums>>,
    pub(super) samples: SampleRanges,
    pub(super) nan_count: u64,
    pub(super) clamped_count: u64,
    pub(super) limited_count: u64,
}

/// The four sums of a record: lanes are two's complement in two words.
pub fn sum_lanes(sum: &FilmSum) -> [i64; 4] {
    std::array::from_fn(|i| (u64::from(sum.high[i]) << 32 | u64::from(sum.low[i])) as i64)
}

/// The record of four sums; inverse of `sum_lanes`.
pub fn sum_record(lanes: [i64; 4]) -> FilmSum {
    FilmSum { low: lanes.map(|v| v as u32), high: lanes.map(|v| (v as u64 >> 32) as u32) }
}

/// Adds what cannot overflow: see `SUM_BITS`.
fn add_to(sum: &mut i64, value: i64) {
    debug_assert!(sum.checked_add(value).is_some(), "film sum overflows: {sum} + {value}");
    *sum = sum.wrapping_add(value);
}

/// The rows of `rect` in a plane of the crop.
fn rows<T: Send>(plane: &mut [T], crop: Rect, rect: Rect) -> impl IndexedParallelIterator<Item = &mut [T]> {
    debug_assert!(crop.contains(&rect), "{rect} is outside the crop {crop}");
    let (left, top) = ((rect.x - crop.x) as usize, (rect.y - crop.y) as usize);
    let rows = plane.par_chunks_exact_mut(crop.width as usize).skip(top).take(rect.height as usize);
    rows.map(move |row| &mut row[left..left + rect.width as usize])
}

impl Film {
    /// An empty film: no samples.
    pub fn new(spec: FilmSpec) -> Self {
        debug_assert!((1..=65_535).contains(&spec.width) && (1..=65_535).contains(&spec.height), "{spec:?}");
        debug_assert!(spec.crop.area() > 0 && Rect::whole(spec.width, spec.height).contains(&spec.crop), "{spec:?}");
        debug_assert!((-100..=100).contains(&spec.unit_exponent) && spec.exposure.is_finite(), "{spec:?}");
        let area = spec.crop.area();
        let aovs = spec.aovs.then(|| vec![AovSums::default(); area]);
        let samples = SampleRanges::default();
        Self { spec, sums: vec![[0; 4]; area], aovs, samples, nan_count: 0, clamped_count: 0, limited_count: 0 }
    }

    pub fn spec(&self) -> &FilmSpec {
        &self.spec
    }

    /// How it is to be displayed from now on. `exposure` in stops, finite; `gamma` above 0, sRGB without.
    pub fn set_display(&mut self, tonemap: ToneMap, exposure: f32, gamma: Option<f32>) {
        debug_assert!(exposure.is_finite() && gamma.is_none_or(|gamma| gamma > 0.0), "{exposure} {gamma:?}");
        (self.spec.tonemap, self.spec.exposure, self.spec.gamma) = (tonemap, exposure, gamma);
    }

    /// The part of the frame it holds.
    pub fn crop(&self) -> Rect {
        self.spec.crop
    }

    /// r, g, b of each pixel in steps of 2^(e - 22) and alpha in steps of 2^-22, rows of the crop from the top.
    pub fn sums(&self) -> &[[i64; 4]] {
        &self.sums
    }

    /// Auxiliary sums, if kept, as `sums`.
    pub fn aovs(&self) -> Option<&[AovSums]> {
        self.aovs.as_deref()
    }

    pub fn samples(&self) -> &SampleRanges {
        &self.samples
    }

    /// Contributions that were not a number and were added as 0.
    pub fn nan_count(&self) -> u64 {
        self.nan_count
    }

    /// Samples whose sum was clamped to 2^16 film units.
    pub fn clamped_count(&self) -> u64 {
        self.clamped_count
    }

    /// Contributions that the scene's `clamp` made dimmer: the picture is darker than the scene.
    pub fn limited_count(&self) -> u64 {
        self.limited_count
    }

    /// Adds sums to the pixels of `rect` (full-frame coordinates, inside the crop), rows from the top. Which samples
    /// they are the sums of is said once for the whole crop, by `record`.
    pub fn add_sums(&mut self, rect: Rect, sums: &[FilmSum]) {
        debug_assert_eq!(rect.area(), sums.len(), "{rect}");
        let rows = rows(&mut self.sums, self.spec.crop, rect);
        rows.zip(sums.par_chunks_exact(rect.width as usize)).for_each(|(row, sums)| {
            for (pixel, sum) in row.iter_mut().zip(sums) {
                for (lane, value) in pixel.iter_mut().zip(sum_lanes(sum)) {
                    add_to(lane, value);
                }
            }
        });
    }

    /// A film with `sums` of the whole crop added, this one left as it is: in one pass, where a copy would take one of its own.
    #[must_use]
    pub fn with_sums(&self, sums: &[FilmSum]) -> Self {
        debug_assert_eq!(self.sums.len(), sums.len());
        let added = |(pixel, sum): (&[i64; 4], &FilmSum)| {
            let mut pixel = *pixel;
            pixel.iter_mut().zip(sum_lanes(sum)).for_each(|(lane, value)| add_to(lane, value));
            pixel
        };
        Self {
            spec: self.spec.clone(),
            sums: self.sums.par_iter().zip(sums).map(added).collect(),
            aovs: self.aovs.clone(),
            samples: self.samples.clone(),
            ..*self
        }
    }

    /// Adds auxiliary values to the pixels of `rect`, like `add_sums`; nothing if the film keeps none. Depth, object
    /// and material are taken only if the values are of samples that include sample 0.
    pub fn add_aovs(&mut self, rect: Rect, pixels: &[AovPixel], has_first_sample: bool) {
        let Some(aovs) = &mut self.aovs else { return };
        debug_assert_eq!(rect.area(), pixels.len(), "{rect}");
        let rows = rows(aovs, self.spec.crop, rect);
        rows.zip(pixels.par_chunks_exact(rect.width as usize)).for_each(|(row, pixels)| {
            for (to, from) in row.iter_mut().zip(pixels) {
                let (normal, albedo) = (sum_lanes(&from.normal), sum_lanes(&from.albedo));
                for i in 0..3 {
                    to.normal[i] = to.normal[i].saturating_add(normal[i]);
                    to.albedo[i] = to.albedo[i].saturating_add(albedo[i]);
                }
                if has_first_sample {
                    (to.depth, to.object, to.material) = (from.depth, from.object, from.material);
                }
            }
        });
    }

    /// Says that every pixel of the crop now holds `samples` (indices below 2^24, none of them recorded before),
    /// and counts what happened in them.
    pub fn record(&mut self, samples: Range<u32>, nan_count: u64, clamped_count: u64) {
        debug_assert!(samples.end <= MAX_SAMPLES, "{samples:?}");
        let inserted = self.samples.insert(samples);
        debug_assert!(inserted.is_ok(), "{inserted:?}");
        self.count(nan_count, clamped_count);
    }

    /// Counts without samples: for a job that covers a part of the crop.
    pub fn count(&mut self, nan_count: u64, clamped_count: u64) {
        self.nan_count = self.nan_count.saturating_add(nan_count);
        self.clamped_count = self.clamped_count.saturating_add(clamped_count);
    }

    /// Counts contributions that the scene's `clamp` has limited; no part of the hash, which the sums they made are.
    pub fn count_limited(&mut self, limited_count: u64) {
        self.limited_count = self.limited_count.saturating_add(limited_count);
    }

    /// Adds another film of the same picture with other samples. On an error this film is as it was.
    /// Names, version and display defaults stay this film's.
    pub fn merge(&mut self, other: &Film) -> Result<(), MergeError> {
        self.check_same_picture(other)?;
        self.samples.check(&other.samples)?;
        for (to, from) in self.sums.iter_mut().zip(&other.sums) {
            for (lane, &value) in to.iter_mut().zip(from) {
                add_to(lane, value);
            }
        }
        if let (Some(to), Some(from)) = (&mut self.aovs, &other.aovs) {
            for (to, from) in to.iter_mut().zip(from) {
                for i in 0..3 {
                    to.normal[i] = to.normal[i].saturating_add(from.normal[i]);
                    to.albedo[i] = to.albedo[i].saturating_add(from.albedo[i]);
                }
                if other.samples.contains(0) {
                    (to.depth, to.object, to.material) = (from.depth, from.object, from.material);
                }
            }
        }
        for range in other.samples.as_slice() {
            self.samples.insert(range.clone())?;
        }
        self.count(other.nan_count, other.clamped_count);
        self.count_limited(other.limited_count);
        Ok(())
    }

    fn check_same_picture(&self, other: &Film) -> Result<(), MergeError> {
        fn same<T: PartialEq>(
            what: &'static str,
            (left, right): (&T, &T),
            show: impl Fn(&T) -> String,
        ) -> Result<(), MergeError> {
            let differs = || MergeError::Differs { what, left: show(left), right: show(right) };
            if left == right { Ok(()) } else { Err(differs()) }
        }
        let (a, b) = (&self.spec, &other.spec);
        same("frame", (&(a.width, a.height), &(b.width, b.height)), |(w, h)| format!("{w}x{h}"))?;
        same("crop", (&a.crop, &b.crop), Rect::to_string)?;
        same("seed", (&a.seed, &b.seed), u32::to_string)?;
        same("integrator", (&a.integrator, &b.integrator), String::clone)?;
        same("unit", (&a.unit_exponent, &b.unit_exponent), |e| format!("2^{e}"))?;
        same("transparency", (&a.transparent, &b.transparent), bool::to_string)?;
        let kept = |kept: &bool| if *kept { "kept" } else { "not kept" }.to_string();
        same("auxiliary values", (&a.aovs, &b.aovs), kept)?;
        // Last, since the digest covers much of the above, and those words say more.
        let scene = |film: &FilmSpec| format!("{} ({})", film.scene_name, blake3::Hash::from(film.scene_digest));
        if a.scene_digest != b.scene_digest {
            return Err(MergeError::Differs { what: "scene", left: scene(a), right: scene(b) });
        }
        Ok(())
    }

    /// The film hash: two films agree in it if and only if (but for chance) they hold the same sums of the same
    /// samples of the same crop.
    ///
    /// BLAKE3 of, all little-endian: the 12 bytes `gonio film 1`; frame width and height; crop x, y, width, height
    /// (u32 each); unit exponent (i32); number of sample ranges (u32), then start and end of each (u32), sorted,
    /// disjoint, touching ones joined; NaN count and clamped count (u64); then r, g, b, alpha (i64 each) of every
    /// pixel, rows of the crop from the top. Auxiliary values, names and display are not part of it.
    pub fn hash(&self) -> blake3::Hash {
        let spec = &self.spec;
        let mut hasher = blake3::Hasher::new();
        hasher.update(b"gonio film 1");
        for value in [spec.width, spec.height, spec.crop.x, spec.crop.y, spec.crop.width, spec.crop.height] {
            hasher.update(&value.to_le_bytes());
        }
        hasher.update(&spec.unit_exponent.to_le_bytes());
        hasher.update(&(self.samples.as_slice().len() as u32).to_le_bytes());
        for range in self.samples.as_slice() {
            hasher.update(&range.start.to_le_bytes()).update(&range.end.to_le_bytes());
        }
        hasher.update(&self.nan_count.to_le_bytes()).update(&self.clamped_count.to_le_bytes());
        let mut bytes = Vec::new();
        for row in self.sums.chunks(spec.crop.width as usize) {
            bytes.clear();
            bytes.extend(row.iter().flatten().flat_map(|lane| lane.to_le_bytes()));
            hasher.update(&bytes);
        }
        hasher.finalize()
    }
}
