//! Looks at a picture while it is rendered: a snapshot each so many seconds, and what that costs.
//!
//!     cargo run --release --example snapshots -- scenes/cornell.toml 4096x4096 4 1
//!
//! Arguments: scene, size, samples a pixel, seconds from snapshot to snapshot (0: none is taken). Each snapshot is kept until
//! the next, as a preview would, so every range of samples that is finished meanwhile makes a film beside it.

use gonio::bake::bake;
use gonio::film::{Film, FilmSpec};
use gonio::render::cpu::CpuRenderer;
use gonio::render::session::{Member, Session};
use gonio::scene::load;
use gonio::watch::Watch;
use std::path::Path;
use std::time::{Duration, Instant};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, size, samples, seconds] = &arguments[..] else {
        return Err("usage: snapshots SCENE WIDTHxHEIGHT SAMPLES SECONDS".into());
    };
    let (width, height) = size.split_once('x').ok_or("the size is WIDTHxHEIGHT")?;
    let mut scene = load::load(Path::new(scene), &[])?;
    (scene.film.width, scene.film.height) = (width.parse()?, height.parse()?);
    scene.settings.samples = samples.parse()?;
    let pause = Duration::try_from_secs_f64(seconds.parse()?)?;

    let data = bake(&scene)?;
    let film = Film::new(FilmSpec::of(&scene, data.digest(), false, false));
    let session = Session::new(film, vec![Member::of(CpuRenderer::new(&data, None)?)]);
    let watch = Watch::default();
    let start = Instant::now();
    std::thread::scope(|scope| {
        let rendering = scope.spawn(|| session.render(0..scene.settings.samples, &watch));
        let mut taken = Vec::new();
        while !pause.is_zero() && !rendering.is_finished() {
            std::thread::sleep(pause);
            // One at a time is kept.
            taken.pop();
            taken.push(session.snapshot());
            println!(
                "{:.1} s: samples {}, {:.0} a second",
                start.elapsed().as_secs_f64(),
                taken[0].samples(),
                watch.rate()
            );
        }
        rendering.join().expect("no panic")
    })?;
    println!("{:.2} s, film {}", start.elapsed().as_secs_f64(), session.into_film().hash());
    Ok(())
}
