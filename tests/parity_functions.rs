//! Every twin against its double, bit for bit: 2^17 sets of arguments each, edges among them.

#[path = "common/device.rs"]
mod device;

use gonio::verify::twins::{FAMILIES, compare};

/// Sets of arguments a twin; `gonio verify` goes deeper.
const COUNT: usize = 1 << 17;

#[test]
fn every_function_gives_the_same_bits_on_the_device() {
    let Some(mut context) = device::context() else { return };
    let mut failures = Vec::new();
    for family in FAMILIES {
        for (number, twin) in family.twins.iter().enumerate() {
            let (differ, first) = compare(&mut context, family, number, COUNT, 1).unwrap();
            if let Some(first) = first {
                failures.push(format!("{} of {}: {differ} of {COUNT} differ, first {first}", twin.name, family.kernel));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
