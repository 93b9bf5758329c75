#!/usr/bin/env bash
# glam (crate 0.34.3): the same dot product of two Vec4 has other bits with SSE2 than with scalar code.
#
# Expected: either one order of additions everywhere, or a word that results depend on the processor. Source: docs.rs, glam:
#   SIMD types are used for the storage of `Vec4` on supported platforms, and `scalar-math` disables them; neither speaks of
#   results. IEEE 754-2019, 11: results are reproducible only where the order of operations is fixed.
# Seen: of 100,000 random pairs two in five differ in the last bit between a build with and one without `scalar-math`, on one
#   processor. SSE2 adds (x + z) + (y + w), scalar code ((x + y) + z) + w. Vec3A and Vec3 agree; normalize of Vec3A and Vec3
#   does not.
# Hurts: golden pictures, hashes of saved games and lockstep simulations made on x86-64 fail on a processor for which glam has
#   no SIMD code, and changing Vec3 for Vec3A moves the picture.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cargo init --quiet --name probe
cat >>Cargo.toml <<'TOML'
glam = "=0.34.3"

[features]
scalar = ["glam/scalar-math"]
TOML
cat >src/main.rs <<'RUST'
use glam::{Vec3, Vec3A, Vec4};

fn main() {
    let mut state = 1u32;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state as f32 / u32::MAX as f32 * 2.0 - 1.0
    };
    let (mut dots, mut lengths) = (0, 0);
    let count = 100_000;
    for _ in 0..count {
        let [a, b] = [0; 2].map(|_| Vec4::new(random(), random(), random(), random()));
        dots += i32::from(a.dot(b) != a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w);
        let v = Vec3::new(a.x, a.y, a.z);
        lengths += i32::from(Vec3::from(Vec3A::from(v).normalize()) != v.normalize());
    }
    println!("{dots} dot products and {lengths} normals of {count} differ from plain code");
}
RUST
simd=$(cargo run --quiet --release)
scalar=$(cargo run --quiet --release --features scalar)
printf 'SIMD:   %s\nscalar: %s\n' "$simd" "$scalar"
read -r simd_dots _ _ _ simd_normals _ <<<"$simd"
read -r scalar_dots _ _ _ scalar_normals _ <<<"$scalar"
if ((simd_dots > 30000 && simd_normals > 30000 && scalar_dots == 0 && scalar_normals == 0)); then
    echo "as described"
else
    echo "CHANGED: SIMD and scalar code agree, or differ otherwise"
    exit 1
fi
