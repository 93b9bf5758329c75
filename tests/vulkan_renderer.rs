//! The Vulkan backend against the CPU backend beyond whole pictures (`parity_scenes.rs`): auxiliary values, ray counts,
//! crops, chunks, bounces, interruption.

#[path = "common/device.rs"]
mod device;

use device::Validated;
use gonio::bake::{SceneData, bake};
use gonio::film::{Film, FilmSpec, Rect};
use gonio::layout::INVALID;
use gonio::render::cpu::CpuRenderer;
use gonio::render::vulkan::{FetchChoice, VulkanOptions, VulkanRenderer};
use gonio::render::{Bounce, Counters, Job, Pass, RenderError, Renderer};
use gonio::scene::{Scene, load};
use gonio::watch::Watch;

/// Every way a path can go: mirror, glass, pane, two lights with shadows, a mesh, a sphere, the background.
const SCENE: &str = r#"
[render]
integrator = "whitted"
samples = 2
max_depth = 6
ambient = [0.1, 0.1, 0.12]

[film]
size = [37, 23]
filter = "mitchell"

[camera]
eye = [0, 1.5, 6]
target = [0, 0.7, 0]
fov = 40

[background]
bottom = [0.3, 0.3, 0.3]
top = [0.5, 0.6, 0.8]

[[material]]
name = "floor"
model = "phong"
k_r = 0.3
k_s = 0.2
exponent = 30

[[material]]
name = "glass"
model = "dielectric"
eta = 1.5

[[material]]
name = "silver"
model = "mirror"
metal = "Ag"

[[material]]
name = "pane"
color = [0.05, 0.45, 0.6]
k_t = 0.6

[[object]]
shape = "quad"
size = [8, 8]
material = "floor"

[[object]]
shape = "teapot"
segments = 4
scale = 0.4
translate = [-1.4, 0, 0]
material = "silver"

[[object]]
shape = "sphere"
radius = 0.7
translate = [0.4, 0.7, 0.8]
material = "glass"

[[object]]
shape = "box"
size = [1, 1.6, 0.1]
translate = [1.6, 0.8, 0]
material = "pane"

[[light]]
type = "point"
position = [-3, 5, 4]
intensity = [60, 60, 55]

[[light]]
type = "point"
position = [4, 3, 3]
intensity = [20, 22, 28]
"#;

fn baked(text: &str, aovs: bool) -> (Scene, SceneData) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    let mut scene = load::load(&path, &[]).unwrap();
    scene.settings.aovs = aovs;
    let data = bake(&scene).unwrap();
    (scene, data)
}

fn film(scene: &Scene, data: &SceneData, crop: Rect) -> Film {
    Film::new(FilmSpec {
        width: scene.film.width,
        height: scene.film.height,
        crop,
        unit_exponent: scene.film.unit_exponent,
        seed: scene.settings.seed,
        scene_digest: data.digest(),
        scene_name: "scene.toml".to_owned(),
        integrator: "whitted".to_owned(),
        version: "test".to_owned(),
        transparent: false,
        aovs: data.features.has_aovs,
        tonemap: scene.film.tonemap,
        exposure: 0.0,
        gamma: None,
    })
}

/// A renderer on the test's device; `None` where there is none (`device::skip` has spoken).
fn renderer(data: &SceneData, options: VulkanOptions) -> Option<Validated<VulkanRenderer>> {
    match VulkanRenderer::new(data, VulkanOptions { validate: true, ..options }) {
        Ok(renderer) => {
            let messages = renderer.messages();
            Some(Validated::new(renderer, messages))
        }
        Err(RenderError::NoDevice(reason)) => {
            device::skip(&reason, device::is_required());
            None
        }
        Err(error) => panic!("{error}"),
    }
}

fn run(renderer: &mut dyn Renderer, jobs: &[Job], film: &mut Film) -> Counters {
    let (mut total, mut pass) = (Counters::default(), Pass::default());
    for job in jobs {
        let watch = Watch::default();
        renderer.render(job, &watch, &mut pass).unwrap();
        pass.add_to(job, film);
        total += pass.counters;
        let expected = job.crop.area() as u64 * job.samples.len() as u64;
        assert_eq!(watch.done(), expected, "samples reported for {job:?}");
    }
    total
}

/// Renders `jobs` (of one crop) on both backends and compares films, auxiliary values and ray counts.
fn compare(data: &SceneData, scene: &Scene, options: VulkanOptions, jobs: &[Job]) {
    let Some(mut vulkan) = renderer(data, options.clone()) else { return };
    let crop = jobs[0].crop;
    let (mut ours, mut reference) = (film(scene, data, crop), film(scene, data, crop));
    let counted = run(&mut *vulkan, jobs, &mut ours);
    let mut cpu = CpuRenderer::new(data, None).unwrap();
    let expected = run(&mut cpu, jobs, &mut reference);
    let differing = ours.sums().iter().zip(reference.sums()).position(|(a, b)| a != b);
    assert_eq!(differing.map(|at| (at, ours.sums()[at], reference.sums()[at])), None, "{options:?}");
    assert_eq!(ours.aovs(), reference.aovs(), "{options:?}");
    assert_eq!(ours.hash(), reference.hash(), "{options:?}");
    assert_eq!((counted.closest_rays, counted.shadow_rays), (expected.closest_rays, expected.shadow_rays));
    assert!(reference.sums().iter().any(|sums| sums[0] > 0), "a black picture proves nothing");
}

fn whole(samples: std::ops::Range<u32>) -> Job {
    Job { crop: Rect::whole(37, 23), samples }
}

#[test]
fn both_ways_of_fetching_give_the_cpu_backends_film() {
    let (scene, data) = baked(SCENE, true);
    for fetch in [FetchChoice::Texel, FetchChoice::Storage] {
        compare(&data, &scene, VulkanOptions { fetch, ..VulkanOptions::default() }, &[whole(0..2)]);
    }
}

#[test]
fn neither_chunks_nor_batches_nor_jobs_change_the_film() {
    let (scene, data) = baked(SCENE, true);
    let part = |x, y, width, height| Job { crop: Rect { x, y, width, height }, samples: 0..3 };
    let quarters = [part(0, 0, 20, 11), part(20, 0, 17, 11), part(0, 11, 20, 12), part(20, 11, 17, 12)];
    for (chunk, quarters) in [(64, &quarters[..1]), (301, &quarters[1..])] {
        let options = VulkanOptions { chunk: Some(chunk), ..VulkanOptions::default() };
        compare(&data, &scene, options.clone(), &[whole(0..1), whole(1..3)]);
        for quarter in quarters {
            compare(&data, &scene, options.clone(), std::slice::from_ref(quarter));
        }
    }
}

#[test]
fn the_local_integrator_gives_the_cpu_backends_film() {
    let (scene, data) = baked(&SCENE.replace("\"whitted\"", "\"local\""), true);
    compare(&data, &scene, VulkanOptions::default(), &[whole(5..7)]);
}

#[test]
fn an_empty_scene_is_its_background_also_in_bands() {
    let (scene, data) = baked(SCENE, true);
    let data = data.altered(|data| {
        (data.shapes, data.instances) = Default::default();
        (data.header.top_root, data.header.instance_count) = (INVALID, 0);
    });
    compare(&data, &scene, VulkanOptions::default(), &[whole(0..2)]);
    // A film cut into bands of four rows or fewer.
    let page_limit = Some(1 << 13);
    compare(&data, &scene, VulkanOptions { page_limit, ..VulkanOptions::default() }, &[whole(0..2)]);
}

#[test]
fn every_bounce_is_inspected_as_on_the_cpu() {
    let (_, data) = baked(SCENE, true);
    let Some(mut vulkan) = renderer(&data, VulkanOptions::default()) else { return };
    let mut cpu = CpuRenderer::new(&data, None).unwrap();
    let mut deepest = 0;
    for (x, y, sample) in [(0, 0, 0), (18, 14, 1), (21, 13, 0), (10, 12, 0), (36, 22, 7)] {
        let ours: Vec<Bounce> = vulkan.inspect(x, y, sample).unwrap();
        assert_eq!(ours, cpu.inspect(x, y, sample).unwrap(), "pixel {x},{y} sample {sample}");
        deepest = deepest.max(ours.len());
    }
    assert!(deepest > 5, "no pixel saw a tree of rays: {deepest}");
}

#[test]
fn an_aborted_job_says_so() {
    let (_, data) = baked(SCENE, false);
    let Some(mut vulkan) = renderer(&data, VulkanOptions::default()) else { return };
    let watch = Watch::default();
    watch.cancel();
    let result = vulkan.render(&whole(0..1), &watch, &mut Pass::default());
    assert!(matches!(result, Err(RenderError::Aborted)), "{result:?}");
}

#[test]
fn a_device_that_is_not_there_is_no_device() {
    let (_, data) = baked(SCENE, false);
    let options = VulkanOptions { device: Some("no such card".to_owned()), ..VulkanOptions::default() };
    let Err(error) = VulkanRenderer::new(&data, options) else { panic!("found no such card") };
    assert!(matches!(error, RenderError::NoDevice(_)), "{error:?}");
}
