//! The kernels, embedded by `build.rs`: proved strict and decorated `NoContraction` (ARCHITECTURE.md, "Strict arithmetic").

mod specialise;

pub use specialise::specialise;

use rspirv::spirv::{Capability, ExecutionMode, Op};
use std::sync::OnceLock;

/// How a kernel reads the scene and its queues.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fetch {
    /// Through uniform texel buffers: the fastest path on CPU devices.
    Texel,
    /// Through storage buffers.
    Storage,
}

/// What a kernel may ask of a device's 32-bit float arithmetic, each only where the device offers it
/// (`VkPhysicalDeviceFloatControlsProperties`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FloatControls {
    /// Round to nearest even.
    pub rounding_rte: bool,
    /// Signed zeros, infinities and NaNs survive.
    pub signed_zero_inf_nan_preserve: bool,
    /// Subnormals survive.
    pub denorm_preserve: bool,
}

struct Kernel {
    name: &'static str,
    storage: &'static Words<[u8]>,
    texel: &'static Words<[u8]>,
}

/// Bytes of a SPIR-V file, aligned so that they can be read as words.
#[repr(C, align(4))]
struct Words<T: ?Sized>(T);

// build.rs writes little-endian words; no Vulkan driver runs on anything else.
const _: () = assert!(cfg!(target_endian = "little"));

macro_rules! words {
    ($file:literal) => {
        &Words(*include_bytes!($file))
    };
}

include!(concat!(env!("OUT_DIR"), "/kernels.rs"));

/// The SPIR-V 1.5 of a kernel, entry point `main`: `extend` for `shaders/kernels/extend.comp`, `parity/layout` for
/// `shaders/kernels/parity/layout.comp`; `None` if there is none of that name.
pub fn kernel(name: &str, fetch: Fetch) -> Option<&'static [u32]> {
    let kernel = KERNELS.iter().find(|kernel| kernel.name == name)?;
    let words = match fetch {
        Fetch::Texel => &kernel.texel.0,
        Fetch::Storage => &kernel.storage.0,
    };
    Some(bytemuck::cast_slice(words))
}

/// What a test makes of every kernel before a driver sees it.
#[doc(hidden)]
pub static REWRITE: OnceLock<Rewrite> = OnceLock::new();
type Rewrite = fn(&[u32]) -> Vec<u32>;

/// Names of all kernels, sorted.
pub fn names() -> impl Iterator<Item = &'static str> {
    KERNELS.iter().map(|kernel| kernel.name)
}

/// Words of a SPIR-V header.
const HEADER_WORDS: usize = 5;

/// The module with the controls declared for 32-bit floats at its entry point; SPIR-V 1.4 has them in core.
///
/// `words` is a valid module with one entry point, as [`kernel`] returns; without any control it comes back unchanged.
pub fn with_float_controls(words: &[u32], controls: FloatControls) -> Vec<u32> {
    let wanted = [
        (controls.denorm_preserve, Capability::DenormPreserve, ExecutionMode::DenormPreserve),
        (
            controls.signed_zero_inf_nan_preserve,
            Capability::SignedZeroInfNanPreserve,
            ExecutionMode::SignedZeroInfNanPreserve,
        ),
        (controls.rounding_rte, Capability::RoundingModeRTE, ExecutionMode::RoundingModeRTE),
    ];
    let (entry, after_entry) = entry_point(words);
    let (mut capabilities, mut modes) = (Vec::new(), Vec::new());
    for (_, capability, mode) in wanted.into_iter().filter(|(on, ..)| *on) {
        capabilities.extend([instruction(Op::Capability, 2), capability as u32]);
        modes.extend([instruction(Op::ExecutionMode, 4), entry, mode as u32, 32]);
    }
    let mut result = Vec::with_capacity(words.len() + capabilities.len() + modes.len());
    result.extend_from_slice(&words[..HEADER_WORDS]);
    result.extend(capabilities);
    result.extend_from_slice(&words[HEADER_WORDS..after_entry]);
    result.extend(modes);
    result.extend_from_slice(&words[after_entry..]);
    result
}

/// First word of an instruction of `count` words.
fn instruction(op: Op, count: u32) -> u32 {
    count << 16 | op as u32
}

/// Id of the entry point, and where the next instruction starts.
fn entry_point(words: &[u32]) -> (u32, usize) {
    let mut at = HEADER_WORDS;
    while at < words.len() {
        let next = at + (words[at] >> 16) as usize;
        if words[at] & 0xffff == Op::EntryPoint as u32 {
            return (words[at + 2], next);
        }
        debug_assert!(next > at, "instruction of no length at word {at}");
        at = next;
    }
    panic!("a kernel without an entry point");
}

#[cfg(test)]
mod tests {
    use super::*;
    use rspirv::dr::{Module, Operand, load_words};

    fn module() -> &'static [u32] {
        kernel("parity/layout", Fetch::Storage).expect("the layout kernel is always there")
    }

    /// Capabilities and (entry point, mode, width) the second module has and the first has not.
    fn added(before: &Module, after: &Module) -> (Vec<Operand>, Vec<Vec<Operand>>) {
        let capabilities = after.capabilities.iter().filter(|i| !before.capabilities.contains(i));
        let modes = after.execution_modes.iter().filter(|i| !before.execution_modes.contains(i));
        (capabilities.map(|i| i.operands[0].clone()).collect(), modes.map(|i| i.operands.clone()).collect())
    }

    #[test]
    fn each_float_control_adds_its_capability_and_mode_and_nothing_else() {
        let before = load_words(module()).expect("valid");
        let entry = before.entry_points[0].operands[1].clone();
        for bits in 0..8 {
            let controls = FloatControls {
                rounding_rte: bits & 1 != 0,
                signed_zero_inf_nan_preserve: bits & 2 != 0,
                denorm_preserve: bits & 4 != 0,
            };
            let (mut capabilities, mut modes) = (Vec::new(), Vec::new());
            let mut expect = |on, capability, mode| {
                if on {
                    capabilities.push(Operand::Capability(capability));
                    let mode = Operand::ExecutionMode(mode);
                    modes.push(vec![entry.clone(), mode, Operand::LiteralBit32(32)]);
                }
            };
            use {Capability as C, ExecutionMode as M};
            expect(controls.denorm_preserve, C::DenormPreserve, M::DenormPreserve);
            let preserve = controls.signed_zero_inf_nan_preserve;
            expect(preserve, C::SignedZeroInfNanPreserve, M::SignedZeroInfNanPreserve);
            expect(controls.rounding_rte, C::RoundingModeRTE, M::RoundingModeRTE);

            let words = with_float_controls(module(), controls);
            let after = load_words(&words).expect("still valid");
            assert_eq!(added(&before, &after), (capabilities, modes), "{controls:?}");
            assert_eq!(words.len(), module().len() + bits_set(bits) * (2 + 4));
        }
    }

    fn bits_set(bits: u32) -> usize {
        bits.count_ones() as usize
    }

    #[test]
    fn no_float_control_leaves_the_module_as_it_is() {
        assert_eq!(with_float_controls(module(), FloatControls::default()), module());
    }
}
