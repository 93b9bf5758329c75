#!/usr/bin/env bash
# image (crate 0.25.10): imageops::resize cuts every float picture to the range of 0 to 1.
#
# Expected: `Rgb32F` holds light of any brightness; the crate reads and writes it as Radiance HDR and OpenEXR. A picture of
#   one colour keeps that colour at any size. Source: docs.rs, image, `imageops::resize`, which assumes scene-linear light and
#   names no range.
# Seen: with each filter, `Nearest` too, a picture of (5, -2, 0.5) becomes (1, 0, 0.5).
# Hurts: an environment map that is made smaller loses its sun and all lamps, and the scene goes dark with a wrong colour; a
#   thumbnail of a render clips before tone mapping.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cargo init --quiet --name probe
cat >>Cargo.toml <<'TOML'
image = { version = "=0.25.10", default-features = false }
TOML
cat >src/main.rs <<'RUST'
use image::imageops::{FilterType, resize};
use image::{ImageBuffer, Rgb};

fn main() {
    let picture = ImageBuffer::from_pixel(8, 8, Rgb([5.0f32, -2.0, 0.5]));
    let filters = [FilterType::Triangle, FilterType::CatmullRom, FilterType::Gaussian, FilterType::Lanczos3, FilterType::Nearest];
    let near = |a: &Rgb<f32>, b: [f32; 3]| a.0.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4);
    let mut same = true;
    for filter in filters {
        let small = resize(&picture, 4, 4, filter);
        println!("{filter:?}: {:?}", small.get_pixel(1, 1).0);
        same &= near(small.get_pixel(1, 1), [1.0, 0.0, 0.5]);
    }
    println!("{}", if same { "as described" } else { "CHANGED: float pictures keep their range" });
    std::process::exit(i32::from(!same));
}
RUST
cargo run --quiet --release
