//! Every twin as a pair: the Rust function, and its number in a parity kernel. `compare` runs both.

pub mod film;
pub mod math;
pub mod models;
pub mod path;
pub mod shading;
pub mod texture;
pub mod trace;
pub mod warp;

use super::inputs::{ARGUMENTS, Domain, arguments};
use crate::render::RenderError;
use crate::render::vulkan::{BufferSpec, Context};
use crate::shaders::{Fetch, kernel};
use glam::{Vec2, Vec3, Vec4};
use serde::{Deserialize, Serialize};

/// Words of results one evaluation gives.
pub const RESULTS: usize = 8;

/// One twin: its name in both languages, what its arguments may be, and the Rust side.
pub struct Twin {
    pub name: &'static str,
    pub domains: &'static [Domain],
    pub run: fn(&In, &mut Out),
}

/// The twins of one kernel in `shaders/kernels/parity/`; a twin's index is its number there.
pub struct Family {
    pub kernel: &'static str,
    pub twins: &'static [Twin],
}

/// All of them, those that every picture needs first.
pub static FAMILIES: &[Family] = &[
    math::FAMILY,
    film::FAMILY,
    shading::FAMILY,
    warp::FAMILY,
    trace::FAMILY,
    models::FAMILY,
    path::FAMILY,
    texture::FAMILY,
];

/// What every picture needs. Drivers compile the kernels of the others for longer than many pictures take.
pub fn basic_families() -> &'static [Family] {
    &FAMILIES[..5]
}

/// The arguments of one evaluation, read as the harness in GLSL reads them.
pub struct In<'a>(&'a [u32]);

impl In<'_> {
    pub fn u(&self, k: usize) -> u32 {
        self.0[k]
    }

    pub fn f(&self, k: usize) -> f32 {
        f32::from_bits(self.0[k])
    }

    pub fn v2(&self, k: usize) -> Vec2 {
        Vec2::new(self.f(k), self.f(k + 1))
    }

    pub fn v3(&self, k: usize) -> Vec3 {
        Vec3::new(self.f(k), self.f(k + 1), self.f(k + 2))
    }

    pub fn v4(&self, k: usize) -> Vec4 {
        self.v3(k).extend(self.f(k + 3))
    }
}

/// The results of one evaluation.
#[derive(Default)]
pub struct Out {
    words: [u32; RESULTS],
    /// Which of them are floats.
    floats: [bool; RESULTS],
    count: usize,
}

impl Out {
    pub fn u(&mut self, value: u32) -> &mut Self {
        self.words[self.count] = value;
        self.count += 1;
        self
    }

    pub fn f(&mut self, value: f32) -> &mut Self {
        self.floats[self.count] = true;
        self.u(value.to_bits())
    }

    pub fn v2(&mut self, value: Vec2) -> &mut Self {
        self.f(value.x).f(value.y)
    }

    pub fn v3(&mut self, value: Vec3) -> &mut Self {
        self.f(value.x).f(value.y).f(value.z)
    }

    pub fn v4(&mut self, value: Vec4) -> &mut Self {
        self.f(value.x).f(value.y).f(value.z).f(value.w)
    }
}

/// Where two sides disagreed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mismatch {
    /// The function, or those that one evaluation runs.
    pub twin: String,
    pub arguments: Vec<u32>,
    pub cpu: Vec<u32>,
    pub device: Vec<u32>,
}

impl std::fmt::Display for Mismatch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let floats = |words: &[u32]| {
            words.iter().map(|w| format!("{:?} ({w:#010x})", f32::from_bits(*w))).collect::<Vec<_>>().join(", ")
        };
        write!(
            f,
            "{}({}): cpu {}, device {}",
            self.twin,
            floats(&self.arguments),
            floats(&self.cpu),
            floats(&self.device)
        )
    }
}

impl Out {
    /// Whether a device's results are these, as far as anything may depend on them (ARCHITECTURE.md, "Strict arithmetic"):
    /// integers by their bits; of floats every zero is the same, of either sign or a subnormal that devices may flush, and
    /// so is every NaN, since no strict function makes one from arguments in its domain.
    fn agrees(&self, device: &[u32]) -> bool {
        let mine = self.words.iter().zip(self.floats).take(self.count);
        mine.zip(device)
            .all(|((&a, is_float), &b)| a == b || is_float && same_float(f32::from_bits(a), f32::from_bits(b)))
    }
}

fn same_float(a: f32, b: f32) -> bool {
    let is_zero = |x: f32| x.abs() < f32::MIN_POSITIVE;
    a == b || is_zero(a) && is_zero(b) || a.is_nan() && b.is_nan()
}

/// Results of one twin in Rust, `RESULTS` words for each set of `ARGUMENTS` words.
pub fn evaluate(family: &Family, number: usize, inputs: &[u32]) -> Vec<u32> {
    let run = |set: &[u32]| {
        let mut out = Out::default();
        (family.twins[number].run)(&In(set), &mut out);
        out.words
    };
    inputs.chunks(ARGUMENTS).flat_map(run).collect()
}

/// The same on a device.
pub fn evaluate_on(
    context: &mut Context,
    family: &Family,
    number: usize,
    inputs: &[u32],
) -> Result<Vec<u32>, RenderError> {
    let count = inputs.len() / ARGUMENTS;
    let words = kernel(family.kernel, Fetch::Storage).expect("every family names an embedded kernel");
    let buffers = [BufferSpec::Input(bytemuck::cast_slice(inputs)), BufferSpec::Output((count * RESULTS * 4) as u64)];
    let choice = [number as u32, count as u32];
    let groups = count.div_ceil(64) as u32;
    let outputs = context.run_kernel(family.kernel, words, &buffers, bytemuck::cast_slice(&choice), groups)?;
    Ok(outputs[0].chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
}

/// Sets of arguments that are evaluated at once: 24 MiB on the device.
const BATCH: usize = 1 << 18;

/// Evaluates one twin on `count` sets of arguments on both sides: how many differ, and the first that does. Every
/// `BATCH` sets begin with another seed, the first with `seed`.
pub fn compare(
    context: &mut Context,
    family: &Family,
    number: usize,
    count: usize,
    seed: u32,
) -> Result<(usize, Option<Mismatch>), RenderError> {
    let (mut differ, mut first) = (0, None);
    for (batch, start) in (0..count).step_by(BATCH).enumerate() {
        // Far from the seeds that others take.
        let seed = seed.wrapping_add((batch as u32).wrapping_mul(0x0100_0000));
        let inputs = arguments(family.twins[number].domains, BATCH.min(count - start), seed);
        let (more, found) = compare_inputs(context, family, number, &inputs)?;
        (differ, first) = (differ + more, first.or(found));
    }
    Ok((differ, first))
}

/// The same on given arguments.
fn compare_inputs(
    context: &mut Context,
    family: &Family,
    number: usize,
    inputs: &[u32],
) -> Result<(usize, Option<Mismatch>), RenderError> {
    let twin = &family.twins[number];
    let device = evaluate_on(context, family, number, inputs)?;
    let mut differ = 0;
    let mut first = None;
    for (set, device) in inputs.chunks(ARGUMENTS).zip(device.chunks(RESULTS)) {
        let mut out = Out::default();
        (twin.run)(&In(set), &mut out);
        if !out.agrees(device) {
            differ += 1;
            first.get_or_insert_with(|| Mismatch {
                twin: twin.name.to_owned(),
                arguments: set[..twin.domains.iter().map(|d| d.words()).sum()].to_vec(),
                cpu: out.words[..out.count].to_vec(),
                device: device[..out.count].to_vec(),
            });
        }
    }
    Ok((differ, first))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_agree_whatever_their_sign_and_what_a_device_may_flush_is_one() {
        let agrees = |mine: f32, device: f32| {
            let mut out = Out::default();
            out.f(mine);
            out.agrees(&[device.to_bits()])
        };
        let (least, greatest) = (f32::from_bits(1), f32::from_bits(0x007f_ffff));
        for (a, b) in [(0.0, -0.0), (least, 0.0), (-greatest, 0.0), (-least, greatest), (f32::NAN, -f32::NAN)] {
            assert!(agrees(a, b) && agrees(b, a), "{a} and {b}");
        }
        for (a, b) in [(f32::MIN_POSITIVE, 0.0), (1.0, 1.0 + f32::EPSILON), (1.0, -1.0), (f32::NAN, 0.0)] {
            assert!(!agrees(a, b) && !agrees(b, a), "{a} and {b}");
        }
    }

    #[test]
    fn integers_agree_by_their_bits() {
        let mut out = Out::default();
        out.u(0).u(1);
        assert!(out.agrees(&[0, 1]));
        // As floats these would be zeros.
        assert!(!out.agrees(&[0x8000_0000, 1]) && !out.agrees(&[0, 0]));
    }
}
