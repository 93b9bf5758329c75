//! Scenes for tests: those of the project, and third-party ones where they are at hand.
#![allow(dead_code, reason = "each test binary uses its own part")]

#[path = "assets.rs"]
mod assets;

#[allow(unused_imports, reason = "each test binary uses its own part")]
pub use assets::asset;
use gonio::bake::{SceneData, bake};
use gonio::film::{Film, FilmSpec};
use gonio::render::cpu::CpuRenderer;
use gonio::render::{Counters, Job, Pass, Renderer};
use gonio::scene::{Scene, load};
use gonio::watch::Watch;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What to render of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Take {
    pub width: u32,
    pub height: u32,
    pub samples: u32,
    pub seed: u32,
}

/// Every `.toml` below `scenes/`, sorted.
pub fn all() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut found = Vec::new();
    for folder in [root.clone(), root.join("lecture")] {
        let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        found.extend(entries.map(|entry| entry.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "toml")));
    }
    found.sort();
    assert!(found.len() >= 11, "only {} scenes found", found.len());
    found
}

/// The scene at the size and with the samples of `take`.
pub fn taken(mut scene: Scene, take: Take) -> Scene {
    (scene.film.width, scene.film.height) = (take.width, take.height);
    (scene.settings.samples, scene.settings.seed) = (take.samples, take.seed);
    scene
}

/// Loads and bakes.
pub fn prepare(path: &Path, take: Take) -> (Scene, SceneData) {
    let scene = taken(load::load(path, &[]).unwrap_or_else(|error| panic!("{error}")), take);
    let data = bake(&scene).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    (scene, data)
}

/// An empty film for the whole frame.
pub fn film(scene: &Scene, data: &SceneData) -> Film {
    let (transparent, aovs) = (data.features.hides_background, data.features.has_aovs);
    Film::new(FilmSpec::of(scene, data.digest(), transparent, aovs))
}

/// Renders a range of samples of the whole frame.
pub fn render(renderer: &mut dyn Renderer, scene: &Scene, data: &SceneData, samples: Range<u32>) -> Film {
    let mut film = film(scene, data);
    accumulate(renderer, &mut film, samples);
    film
}

/// Adds samples of all pixels of a film.
pub fn accumulate(renderer: &mut dyn Renderer, film: &mut Film, samples: Range<u32>) -> Counters {
    let (job, mut pass) = (Job { crop: film.crop(), samples }, Pass::default());
    renderer.render(&job, &Watch::default(), &mut pass).unwrap();
    pass.add_to(&job, film);
    pass.counters
}

/// All samples on the CPU backend.
pub fn render_cpu(scene: &Scene, data: &SceneData) -> Film {
    render(&mut CpuRenderer::new(data, None).unwrap(), scene, data, 0..scene.settings.samples)
}

/// Panics with the number of differing pixels and the first of them.
pub fn assert_same(reference: &Film, other: &Film, what: &str) {
    let differ = reference.sums().iter().zip(other.sums()).filter(|(a, b)| a != b).count();
    if differ > 0 {
        let first = reference.sums().iter().zip(other.sums()).position(|(a, b)| a != b).unwrap();
        let (a, b) = (reference.sums()[first], other.sums()[first]);
        panic!("{what}: {differ} of {} pixels differ, first number {first}: {a:?} and {b:?}", reference.sums().len());
    }
    assert_eq!(reference.hash(), other.hash(), "{what}: same sums, but other counts");
}
