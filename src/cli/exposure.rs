//! A light meter: a small picture of the scene, by the integrator in use, tells how the film is to be exposed.
//!
//! The CPU backend takes it with a sample count and seed of its own, so every device and every part of a picture (`--samples`,
//! `--crop`, `--seed`) gets the same exposure.

use super::setup::{BackendFlags, BackendName, bake_quietly, film_of};
use super::team;
use crate::bake::Baker;
use crate::film::{Image, Rect};
use crate::scene::{Film, RenderSettings, Scene, ToneMap};
use crate::watch::Watch;

/// Pixels along the longer side of the small picture.
const SIDE: u32 = 128;
const SAMPLES: u32 = 8;
/// Mean luminance of what is shown, as light of the display before its curve.
const MEAN: f64 = 0.3;
/// What of the surfaces is shown darker than `BRIGHT`.
const MOST: f64 = 0.97;
const BRIGHT: f64 = 0.8;
/// One contribution of scattered light may be so many times as bright as what is shown white: enough for every lamp that a
/// mirror shows, too little for a speck among a few dozen samples.
const SPECK: f64 = 2.0;

/// Sets the exposure of a scene whose film is to be metered, and limits specks, which nobody wants in a picture that came of
/// itself. `baker`: bakes the scene itself afterwards.
pub fn expose(
    scene: &mut Scene,
    baker: &mut Baker,
    threads: Option<usize>,
    asked: &(dyn Fn() -> bool + Sync),
) -> anyhow::Result<()> {
    let (film, settings) = (scene.film, scene.settings);
    let reduced = |side: u32| (side * SIDE).div_ceil(film.width.max(film.height)).max(1);
    scene.film = Film { width: reduced(film.width), height: reduced(film.height), crop: None, ..film };
    scene.settings = RenderSettings { samples: SAMPLES, seed: 0, transparent: true, aovs: false, ..settings };
    let taken = small_picture(scene, baker, threads, asked);
    (scene.film, scene.settings) = (film, settings);
    let gain = gain_of(&taken?);
    scene.film.exposure = stops(gain, film.tonemap);
    scene.settings.clamp = settings.clamp.or(Some((SPECK / gain) as f32));
    scene.metered = false;
    log::info!("{}: metered, exposure {:+.2}", scene.name, scene.film.exposure);
    Ok(())
}

fn small_picture(
    scene: &Scene,
    baker: &mut Baker,
    threads: Option<usize>,
    asked: &(dyn Fn() -> bool + Sync),
) -> anyhow::Result<Image> {
    let data = bake_quietly(scene, baker, asked)?;
    let frame = Rect::whole(scene.film.width, scene.film.height);
    let flags = BackendFlags { backend: BackendName::Cpu, threads, ..BackendFlags::default() };
    let session = team::session(&flags, &data, film_of(scene, &data, frame))?;
    session.render(0..SAMPLES, &Watch::default().asking(asked))?;
    Ok(session.into_film().resolve())
}

/// The factor on light that shows surfaces well: on the whole neither dark nor white, and hardly any of them clipped. 1 where
/// there is no light. `image`: premultiplied, without the background.
fn gain_of(image: &Image) -> f64 {
    let covered = image.pixels.iter().filter(|pixel| pixel[3] > 0.5);
    let light: Vec<[f64; 3]> = covered.map(|&[r, g, b, a]| [r, g, b].map(|v| f64::from(v / a).max(0.0))).collect();
    let mean = light.iter().map(|[r, g, b]| 0.2126 * r + 0.7152 * g + 0.0722 * b).sum::<f64>() / light.len() as f64;
    let mut brightest: Vec<f64> = light.iter().map(|rgb| rgb.iter().copied().fold(0.0, f64::max)).collect();
    brightest.sort_by(f64::total_cmp);
    let bright = brightest.get((brightest.len() as f64 * MOST) as usize).copied().unwrap_or(0.0);
    if !(mean > 0.0 && mean.is_finite() && bright.is_finite()) {
        return 1.0;
    }
    (MEAN / mean).min(BRIGHT / bright.max(f64::MIN_POSITIVE)).clamp(1e-18, 1e18)
}

/// The exposure for a gain. Curves that bend down what is bright want more light for the same grey.
fn stops(gain: f64, tonemap: ToneMap) -> f32 {
    let bent = match tonemap {
        ToneMap::Aces => 1.0 / 0.6,
        ToneMap::Reinhard => 2.0,
        ToneMap::Clamp | ToneMap::Normalise | ToneMap::Agx => 1.0,
    };
    // A hundredth of a stop is seen by nobody, and read by many.
    (libm::round(libm::log2(gain * bent) * 100.0) / 100.0) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(values: &[f32]) -> Image {
        Image { width: values.len() as u32, height: 1, pixels: values.iter().map(|v| [*v, *v, *v, 1.0]).collect() }
    }

    #[test]
    fn twice_the_light_takes_a_stop_less_and_no_light_none() {
        let dim: Vec<f32> = (0..100).map(|i| 0.001 + 0.0001 * i as f32).collect();
        let bright: Vec<f32> = dim.iter().map(|v| v * 1024.0).collect();
        let [dim, bright] = [dim, bright].map(|values| stops(gain_of(&image(&values)), ToneMap::Clamp));
        assert!((dim - bright - 10.0).abs() < 0.02, "{dim} {bright}");
        assert_eq!((gain_of(&image(&[0.0; 4])), gain_of(&image(&[]))), (1.0, 1.0));
    }

    #[test]
    fn neither_the_background_nor_a_few_bright_specks_count() {
        let mut values = vec![0.3f32; 200];
        let plain = stops(gain_of(&image(&values)), ToneMap::Clamp);
        values[0] = 3.0;
        let specks = stops(gain_of(&image(&values)), ToneMap::Clamp);
        assert!((plain - specks).abs() < 0.1, "{plain} {specks}");
        let mut behind = image(&values);
        behind.pixels.extend([[90.0, 90.0, 90.0, 0.0]; 50]);
        assert_eq!(stops(gain_of(&behind), ToneMap::Clamp), specks);
        let white = stops(gain_of(&image(&[0.9; 100])), ToneMap::Clamp);
        assert!(white < 0.0, "a white wall is not shown as white as can be: {white}");
    }
}
