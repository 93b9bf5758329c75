//! Several renderers at one picture: the same sums as any of them alone, whoever is slow or fails.

#[path = "common/device.rs"]
mod device;
#[path = "common/scenes.rs"]
mod scenes;

use gonio::bake::{SceneData, bake};
use gonio::film::{Film, Rect};
use gonio::render::cpu::CpuRenderer;
use gonio::render::session::{Member, Session, Share};
use gonio::render::vulkan::{VulkanOptions, VulkanRenderer};
use gonio::render::{Bounce, Job, Pass, RenderError, Renderer};
use gonio::scene::Scene;
use gonio::watch::Watch;
use scenes::{Take, assert_same};
use std::ops::Range;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

const TAKE: Take = Take { width: 24, height: 16, samples: 40, seed: 3 };

fn scene() -> (Scene, SceneData) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lecture/23-glass.toml");
    scenes::prepare(&path, TAKE)
}

/// The CPU backend, with a flaw.
struct Flawed<'a> {
    inner: CpuRenderer<'a>,
    /// Sleeps before each range, and looks meanwhile whether to give up.
    slow: Duration,
    /// Waits until this is not 0, likewise.
    after: Option<&'a AtomicU32>,
    /// Fails at this range, having computed it; from 0.
    fails_at: Option<u32>,
    ranges: u32,
}

impl Renderer for Flawed<'_> {
    fn name(&self) -> String {
        format!("flawed {}", self.inner.name())
    }

    fn render(&mut self, job: &Job, watch: &Watch, pass: &mut Pass) -> Result<(), RenderError> {
        let start = Instant::now();
        let waits = || self.after.is_some_and(|finished| finished.load(Ordering::Relaxed) == 0);
        while start.elapsed() < self.slow || waits() {
            if watch.is_cancelled() {
                return Err(RenderError::Aborted);
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        self.ranges += 1;
        if self.fails_at == Some(self.ranges - 1) {
            self.inner.render(job, watch, pass)?;
            return Err(RenderError::Lost("the device is lost".to_owned()));
        }
        self.inner.render(job, watch, pass)
    }

    fn inspect(&mut self, x: u32, y: u32, sample: u32) -> Result<Vec<Bounce>, RenderError> {
        self.inner.inspect(x, y, sample)
    }
}

/// The Vulkan backend, its ranges counted.
struct Counted<'a> {
    inner: VulkanRenderer,
    finished: &'a AtomicU32,
}

impl Renderer for Counted<'_> {
    fn name(&self) -> String {
        self.inner.name()
    }

    fn render(&mut self, job: &Job, watch: &Watch, pass: &mut Pass) -> Result<(), RenderError> {
        self.inner.render(job, watch, pass)?;
        self.finished.fetch_add(1, Ordering::Relaxed);
        Ok(())
    }

    fn inspect(&mut self, x: u32, y: u32, sample: u32) -> Result<Vec<Bounce>, RenderError> {
        self.inner.inspect(x, y, sample)
    }
}

fn flawed(data: &SceneData, slow: Duration, fails_at: Option<u32>) -> Member<'_> {
    let open = move || -> Result<Box<dyn Renderer + '_>, RenderError> {
        Ok(Box::new(Flawed { inner: CpuRenderer::new(data, Some(1))?, slow, after: None, fails_at, ranges: 0 }))
    };
    Member::new("flawed", Box::new(open))
}

fn sound(data: &SceneData) -> Member<'_> {
    flawed(data, Duration::ZERO, None)
}

/// Renders with nobody watching; the progress must end at what the film holds.
fn run(members: Vec<Member>, samples: Range<u32>, film: &mut Film) -> Result<Vec<Share>, RenderError> {
    let session = Session::new(film.clone(), members);
    let watch = Watch::default();
    let shares = session.render(samples, &watch)?;
    *film = session.into_film();
    let total: u64 = shares.iter().map(|share| share.samples).sum();
    assert_eq!(total, film.samples().total(), "the shares add up");
    assert_eq!(watch.done(), film.crop().area() as u64 * total, "so does the progress");
    Ok(shares)
}

#[test]
fn two_renderers_make_the_film_of_one() {
    let (scene, data) = scene();
    let mut film = scenes::film(&scene, &data);
    let shares = run(vec![sound(&data), sound(&data)], 0..TAKE.samples, &mut film).unwrap();
    assert_same(&scenes::render_cpu(&scene, &data), &film, "two renderers");
    assert!(shares.iter().all(|share| share.error.is_none() && share.ranges > 0), "{shares:?}");
    assert_eq!(film.samples().as_slice(), std::slice::from_ref(&(0..TAKE.samples)));
}

#[test]
fn the_device_and_the_cpu_together_make_the_film_of_one() {
    let (mut scene, _) = scene();
    scene.settings.aovs = true;
    let data = bake(&scene).unwrap();
    if let Err(error) = VulkanRenderer::new(&data, VulkanOptions::default()) {
        return device::skip(&error.to_string(), device::is_required());
    }
    // The CPU waits for a device to finish something: a driver may take its time to compile.
    let finished = AtomicU32::new(0);
    let vulkan = |chunk| -> Member<'_> {
        let (data, finished) = (&data, &finished);
        let open = move || -> Result<Box<dyn Renderer + '_>, RenderError> {
            let options = VulkanOptions { chunk, validate: true, ..VulkanOptions::default() };
            Ok(Box::new(Counted { inner: VulkanRenderer::new(data, options)?, finished }))
        };
        Member::new("vulkan", Box::new(open))
    };
    let slow = || -> Result<Box<dyn Renderer + '_>, RenderError> {
        let inner = CpuRenderer::new(&data, Some(1))?;
        let slow = Duration::from_millis(50);
        Ok(Box::new(Flawed { inner, slow, after: Some(&finished), fails_at: None, ranges: 0 }))
    };
    let slow = Member::new("slow", Box::new(slow));
    let mut film = scenes::film(&scene, &data);
    let shares = run(vec![vulkan(None), slow, vulkan(Some(64))], 0..TAKE.samples, &mut film).unwrap();
    let alone = scenes::render_cpu(&scene, &data);
    assert_same(&alone, &film, "two devices and the CPU");
    assert_eq!(alone.aovs(), film.aovs(), "auxiliary values, those of sample 0 among them");
    assert!(shares[0].samples + shares[2].samples > 0, "{shares:?}");
}

#[test]
fn a_crop_and_a_part_of_the_samples_are_those_of_one_renderer() {
    let (scene, data) = scene();
    let whole = scenes::film(&scene, &data);
    let mut spec = whole.spec().clone();
    spec.crop = Rect { x: 5, y: 3, width: 11, height: 7 };
    let mut film = Film::new(spec.clone());
    run(vec![sound(&data), sound(&data), sound(&data)], 7..31, &mut film).unwrap();
    let mut alone = Film::new(spec);
    scenes::accumulate(&mut CpuRenderer::new(&data, None).unwrap(), &mut alone, 7..31);
    assert_same(&alone, &film, "a crop");
    assert_eq!(film.samples().as_slice(), std::slice::from_ref(&(7..31)));
}

#[test]
fn what_a_lost_device_has_not_finished_goes_to_the_others() {
    let (scene, data) = scene();
    for fails_at in [0, 1, 2] {
        let mut film = scenes::film(&scene, &data);
        let members = vec![
            flawed(&data, Duration::from_millis(5), Some(fails_at)),
            flawed(&data, Duration::from_millis(15), None),
        ];
        let shares = run(members, 0..TAKE.samples, &mut film).unwrap();
        assert_same(&scenes::render_cpu(&scene, &data), &film, "after a loss");
        assert!(matches!(&shares[0].error, Some(RenderError::Lost(text)) if text.contains("lost")), "{shares:?}");
        assert!(shares[1].error.is_none() && shares[1].samples > 0, "{shares:?}");
    }
}

#[test]
fn a_device_that_cannot_be_opened_leaves_the_picture_to_the_others() {
    let (scene, data) = scene();
    let broken = Member::new("broken", Box::new(|| Err(RenderError::OutOfMemory("out of device memory".to_owned()))));
    let mut film = scenes::film(&scene, &data);
    let shares = run(vec![broken, sound(&data)], 0..TAKE.samples, &mut film).unwrap();
    assert_same(&scenes::render_cpu(&scene, &data), &film, "without the broken one");
    assert_eq!((shares[0].samples, shares[0].name.as_str()), (0, "broken"));
}

#[test]
fn where_all_fail_the_error_is_that_of_a_device() {
    let (scene, data) = scene();
    let mut film = scenes::film(&scene, &data);
    let members = vec![flawed(&data, Duration::ZERO, Some(0)), flawed(&data, Duration::ZERO, Some(1))];
    let error = run(members, 0..TAKE.samples, &mut film).unwrap_err();
    assert_eq!(error.to_string(), "the device is lost");
}

#[test]
fn a_device_that_is_far_too_slow_does_not_make_the_picture_late() {
    let (scene, data) = scene();
    let mut film = scenes::film(&scene, &data);
    let start = Instant::now();
    let shares = run(vec![flawed(&data, Duration::from_secs(600), None), sound(&data)], 0..TAKE.samples, &mut film);
    assert!(start.elapsed() < Duration::from_secs(300), "{:?}", start.elapsed());
    let shares = shares.unwrap();
    assert_same(&scenes::render_cpu(&scene, &data), &film, "beside a slow one");
    assert_eq!((shares[0].samples, shares[1].samples), (0, u64::from(TAKE.samples)));
    assert!(shares[0].error.is_none(), "being slow is no error: {shares:?}");
}

#[test]
fn being_stopped_leaves_whole_ranges_without_a_gap() {
    let (scene, data) = scene();
    let asked = AtomicU32::new(0);
    let ask = || asked.fetch_add(1, Ordering::Relaxed) > 12;
    let members = vec![flawed(&data, Duration::from_millis(2), None), flawed(&data, Duration::from_millis(7), None)];
    let session = Session::new(scenes::film(&scene, &data), members);
    let shares = session.render(0..1 << 24, &Watch::default().asking(&ask)).unwrap();
    let film = session.into_film();
    let end = film.samples().total() as u32;
    assert!(end > 1, "{shares:?}");
    assert_eq!(film.samples().as_slice(), std::slice::from_ref(&(0..end)));
    let alone = scenes::render(&mut CpuRenderer::new(&data, None).unwrap(), &scene, &data, 0..end);
    assert_same(&alone, &film, "what was finished");
}

#[test]
fn being_stopped_gives_up_a_range_that_takes_long() {
    let (scene, data) = scene();
    let session = Session::new(scenes::film(&scene, &data), vec![flawed(&data, Duration::from_secs(20), None)]);
    let (start, watch) = (Instant::now(), Watch::default());
    watch.cancel();
    let shares = session.render(0..4, &watch).unwrap();
    // It has a second to end.
    assert!((1.0..5.0).contains(&start.elapsed().as_secs_f64()), "{:?}", start.elapsed());
    assert_eq!((shares[0].samples, session.into_film().samples().total()), (0, 0));
}

#[test]
fn a_time_limit_of_nothing_still_gives_one_range_each_at_most() {
    let (scene, data) = scene();
    let session = Session::new(scenes::film(&scene, &data), vec![sound(&data), sound(&data)]);
    session.render(0..1 << 24, &Watch::default().limited(Duration::ZERO)).unwrap();
    let film = session.into_film();
    assert!((1..=2).contains(&film.samples().total()), "{}", film.samples());
}

#[test]
fn ranges_grow_until_each_takes_its_time() {
    let (scene, data) = scene();
    /// Notes the lengths of its ranges.
    struct Noting<'a>(CpuRenderer<'a>, &'a Mutex<Vec<u32>>);
    impl Renderer for Noting<'_> {
        fn name(&self) -> String {
            self.0.name()
        }
        fn render(&mut self, job: &Job, watch: &Watch, pass: &mut Pass) -> Result<(), RenderError> {
            self.1.lock().unwrap().push(job.samples.end - job.samples.start);
            self.0.render(job, watch, pass)
        }
        fn inspect(&mut self, x: u32, y: u32, sample: u32) -> Result<Vec<Bounce>, RenderError> {
            self.0.inspect(x, y, sample)
        }
    }
    let lengths = Mutex::new(Vec::new());
    let open = || -> Result<Box<dyn Renderer + '_>, RenderError> {
        Ok(Box::new(Noting(CpuRenderer::new(&data, Some(1))?, &lengths)))
    };
    let mut film = scenes::film(&scene, &data);
    run(vec![Member::new("noting", Box::new(open))], 0..TAKE.samples, &mut film).unwrap();
    let lengths = lengths.into_inner().unwrap();
    assert_eq!(lengths[0], 1);
    assert!(lengths.windows(2).all(|pair| pair[1] <= 4 * pair[0]), "{lengths:?}");
    assert!(lengths.iter().any(|&length| length > 1), "{lengths:?}");
}

#[test]
fn the_reserve_goes_on_from_the_film_of_those_that_have_failed() {
    let (scene, data) = scene();
    for fails_at in [0, 2] {
        let member = flawed(&data, Duration::from_millis(1), Some(fails_at));
        let session = Session::new(scenes::film(&scene, &data), vec![member]).with_reserve(Some(sound(&data)));
        let watch = Watch::default();
        let shares = session.render(0..TAKE.samples, &watch).unwrap();
        assert!(matches!(&shares[..], [lost, last] if lost.error.is_some() && last.samples > 0), "{shares:?}");
        assert_eq!(
            shares[0].samples + shares[1].samples,
            u64::from(TAKE.samples),
            "nothing is rendered twice: {shares:?}"
        );
        assert_eq!(shares[0].ranges, fails_at, "{shares:?}");
        assert_same(&scenes::render_cpu(&scene, &data), &session.into_film(), "with the reserve");
    }
    let lost = || flawed(&data, Duration::ZERO, Some(0));
    let session = Session::new(scenes::film(&scene, &data), vec![lost()]).with_reserve(Some(lost()));
    assert!(session.render(0..4, &Watch::default()).is_err(), "both have failed");
}

#[test]
fn a_session_renders_only_what_its_film_lacks_and_begins_anew_on_the_same_devices() {
    let (scene, data) = scene();
    let session = Session::new(scenes::film(&scene, &data), vec![sound(&data)]);
    session.render(10..20, &Watch::default()).unwrap();
    let watch = Watch::default();
    session.render(0..TAKE.samples, &watch).unwrap();
    let whole = scenes::render_cpu(&scene, &data);
    assert_eq!(watch.done(), (whole.crop().area() as u64) * u64::from(TAKE.samples - 10));
    let first = session.restart(scenes::film(&scene, &data));
    assert_same(&whole, &first, "in two calls");
    session.render(0..TAKE.samples, &Watch::default()).unwrap();
    assert_same(&whole, &session.into_film(), "once more");
}

#[test]
fn a_snapshot_is_the_film_of_a_render_that_ended_there() {
    let (scene, data) = scene();
    let members = vec![flawed(&data, Duration::from_millis(3), None), flawed(&data, Duration::from_millis(4), None)];
    let session = Session::new(scenes::film(&scene, &data), members);
    let watch = Watch::default();
    // Kept until the end, so that every change must have left them alone.
    let snapshots = std::thread::scope(|scope| {
        let rendering = scope.spawn(|| session.render(0..TAKE.samples, &watch).unwrap());
        let mut snapshots = vec![session.snapshot()];
        while !rendering.is_finished() {
            let snapshot = session.snapshot();
            if snapshots.last().is_some_and(|last| last.samples() != snapshot.samples()) {
                snapshots.push(snapshot);
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        snapshots
    });
    assert!(snapshots.len() > 3, "{} snapshots prove little", snapshots.len());
    for snapshot in snapshots {
        let mut alone = scenes::film(&scene, &data);
        for range in snapshot.samples().as_slice() {
            scenes::accumulate(&mut CpuRenderer::new(&data, None).unwrap(), &mut alone, range.clone());
        }
        assert_same(&alone, &snapshot, &format!("samples {}", snapshot.samples()));
    }
}
