//! Pictures: display, files of every format, output files, comparison.

#[path = "../common/assets.rs"]
mod assets;
mod comparing;
mod display;
mod formats;
mod linear;
mod output;

use gonio::film::write::{Aov, Format, Picture};
use gonio::film::{Film, FilmSpec, Rect, sum_record};
use gonio::layout::AovPixel;
use gonio::scene::ToneMap;

/// A film of one sample whose pixels are `pixels`, multiples of 2^-22, in a frame around it.
fn film_of(width: u32, pixels: &[[f32; 4]], change: impl Fn(&mut FilmSpec)) -> Film {
    let height = pixels.len() as u32 / width;
    let mut spec = FilmSpec {
        width: width + 3,
        height: height + 5,
        crop: Rect { x: 2, y: 1, width, height },
        unit_exponent: 0,
        seed: 42,
        scene_digest: [3; 32],
        scene_name: "spheres.toml".into(),
        integrator: "local".into(),
        version: "0.1.0".into(),
        transparent: false,
        aovs: false,
        tonemap: ToneMap::Clamp,
        exposure: 0.0,
        gamma: None,
    };
    change(&mut spec);
    let mut film = Film::new(spec);
    let fixed = |v: f32| (f64::from(v) * f64::from(1 << 22)) as i64;
    let sums: Vec<_> = pixels.iter().map(|pixel| sum_record(pixel.map(fixed))).collect();
    film.add_sums(film.crop(), &sums);
    if film.spec().aovs {
        let aov = |i: usize| AovPixel {
            normal: sum_record([0, 0, 1 << 22, 0]),
            albedo: sum_record([1 << 21, 1 << 20, 0, 0]),
            depth: i as f32,
            object: i as u32,
            material: 7,
            _pad0: 0,
        };
        let aovs: Vec<_> = (0..pixels.len()).map(aov).collect();
        film.add_aovs(film.crop(), &aovs, true);
    }
    film.record(0..1, 0, 0);
    film
}

/// Pixels of many magnitudes, none of them negative.
fn ramp(width: u32, height: u32) -> Vec<[f32; 4]> {
    let value = |i: u32| (i * i % 4093) as f32 / 1024.0;
    (0..width * height).map(|i| [value(i), value(3 * i + 1), value(7 * i + 2), 1.0]).collect()
}

fn encode(film: &Film, format: Format, sixteen_bit: bool) -> Vec<u8> {
    let aovs = Aov::ALL.map(|(_, aov)| aov);
    let mut bytes = Vec::new();
    Picture { format, sixteen_bit, backdrop: None, aovs: &aovs }.write_to(film, &mut bytes).unwrap();
    bytes
}
