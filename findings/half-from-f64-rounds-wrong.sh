#!/usr/bin/env bash
# half (crate 2.7.1): f16::from_f64 and bf16::from_f64 round down what lies above the middle of two halves.
#
# Expected: the documentation of `f16::from_f64` says that values are rounded to the nearest representable one. A value a
#   little above the middle between 1 and 1 + 2^-10 is therefore 1 + 2^-10. Source: docs.rs, half, `f16::from_f64`; IEEE
#   754-2019, 4.3.1.
# Seen: 1 + 2^-11 + 2^-40 becomes 1, and 1 + 2^-8 + 2^-40 becomes 1 as bf16: the low digits are dropped first, so the value
#   looks like a tie and goes to even. 2^-25 + 2^-60, above half of the smallest subnormal, becomes 0. Slices and constants
#   behave alike.
# Hurts: whoever computes in f64 and stores halves gets pictures that differ in the last bit from a correct conversion, on a
#   device or in numpy, in one of 2,000 to 16,000 random values, depending on whether the processor converts.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cargo init --quiet --name probe
cat >>Cargo.toml <<'TOML'
half = "=2.7.1"
TOML
cat >src/main.rs <<'RUST'
use half::{bf16, f16};

fn main() {
    let above = |e: i32| 1.0 + 2f64.powi(e) + 2f64.powi(-40);
    let seen = [
        f16::from_f64(above(-11)).to_f64(),
        f16::from_f64_const(above(-11)).to_f64(),
        bf16::from_f64(above(-8)).to_f64(),
        f16::from_f64(2f64.powi(-25) + 2f64.powi(-60)).to_f64(),
    ];
    let right = [1.0 + 2f64.powi(-10), 1.0 + 2f64.powi(-10), 1.0 + 2f64.powi(-7), 2f64.powi(-24)];
    println!("from_f64 {seen:?}\nnearest  {right:?}");
    let same = seen == [1.0, 1.0, 1.0, 0.0];
    println!("{}", if same { "as described" } else { "CHANGED: the conversion rounds otherwise" });
    std::process::exit(i32::from(!same));
}
RUST
cargo run --quiet --release
