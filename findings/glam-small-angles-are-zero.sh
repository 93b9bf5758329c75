#!/usr/bin/env bash
# glam (crate 0.34.3): angle_between returns exactly 0 for directions up to a fiftieth of a degree apart.
#
# Expected: an angle in radians, to about the precision of f32, as the name and the documentation of `Vec3::angle_between`
#   promise; 1e-4 is a thousand times larger than the spacing of f32 near 1. Source: docs.rs, glam; W. Kahan, "How Futile are
#   Mindless Assessments of Roundoff" (2006), section 12, on arc cosines of dot products.
# Seen: for directions 1e-4 and 2e-4 apart it is 0, for 5e-4 to 1e-3 it is 2.3 % too small, and `Vec2::angle_to` behaves
#   alike. The atan2 of the lengths of cross and dot product is right to the last digits.
# Hurts: the sun is 4.7e-3 wide, a pixel of a long lens 1e-4: cone tests, adaptive sampling and interpolation between near
#   directions see no difference, or jump.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cargo init --quiet --name probe
cat >>Cargo.toml <<'TOML'
glam = "=0.34.3"
TOML
cat >src/main.rs <<'RUST'
use glam::{Vec2, Vec3};

fn main() {
    let mut same = true;
    for (angle, lost) in [(1e-4f32, 1.0), (2e-4, 1.0), (1e-3, 0.0234)] {
        let (direction, plane) = (Vec3::new(angle.cos(), angle.sin(), 0.0), Vec2::new(angle.cos(), angle.sin()));
        let seen = [Vec3::X.angle_between(direction), Vec2::X.angle_to(plane)];
        let right = Vec3::X.cross(direction).length().atan2(Vec3::X.dot(direction));
        println!("{angle:e}: angle_between {:e}, angle_to {:e}, by atan2 {right:e}", seen[0], seen[1]);
        same &= seen.iter().all(|s| (1.0 - s / angle - lost).abs() < 1e-3) && (right / angle - 1.0).abs() < 1e-5;
    }
    println!("{}", if same { "as described" } else { "CHANGED: small angles are seen" });
    std::process::exit(i32::from(!same));
}
RUST
cargo run --quiet --release
