//! Several renderers at one picture: the same sums as any of them alone, whoever is slow or fails.

#[path = "common/device.rs"]
mod device;
#[path = "common/scenes.rs"]
mod scenes;

use gonio::bake::SceneData;
use gonio::film::{Film, Rect};
use gonio::render::cpu::CpuRenderer;
use gonio::render::team::{Member, Order, Share, render};
use gonio::render::vulkan::{VulkanOptions, VulkanRenderer};
use gonio::render::{Bounce, Counters, Job, RenderError, Renderer, Watch};
use gonio::scene::Scene;
use scenes::{Take, assert_same};
use std::ops::Range;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicI64, AtomicU32, Ordering};
use std::time::{Duration, Instant};

const TAKE: Take = Take { width: 24, height: 16, samples: 40, seed: 3 };

fn scene() -> (Scene, SceneData) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lecture/23-glass.toml");
    scenes::prepare(&path, TAKE)
}

/// The CPU backend, with a flaw.
struct Flawed<'a> {
    inner: CpuRenderer<'a>,
    /// Sleeps before each range, and looks at `abort` meanwhile.
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

    fn accumulate(&mut self, job: &Job, film: &mut Film, watch: &Watch) -> Result<Counters, RenderError> {
        let start = Instant::now();
        let waits = || self.after.is_some_and(|finished| finished.load(Ordering::Relaxed) == 0);
        while start.elapsed() < self.slow || waits() {
            if watch.abort.load(Ordering::Relaxed) {
                return Err(RenderError::Aborted);
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        self.ranges += 1;
        if self.fails_at == Some(self.ranges - 1) {
            self.inner.accumulate(job, &mut film.clone(), watch)?;
            return Err(RenderError::Device("the device is lost".to_owned()));
        }
        self.inner.accumulate(job, film, watch)
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

    fn accumulate(&mut self, job: &Job, film: &mut Film, watch: &Watch) -> Result<Counters, RenderError> {
        let counters = self.inner.accumulate(job, film, watch)?;
        self.finished.fetch_add(1, Ordering::Relaxed);
        Ok(counters)
    }

    fn inspect(&mut self, x: u32, y: u32, sample: u32) -> Result<Vec<Bounce>, RenderError> {
        self.inner.inspect(x, y, sample)
    }
}

fn flawed(data: &SceneData, slow: Duration, fails_at: Option<u32>) -> Member<'_> {
    let open = move || -> Result<Box<dyn Renderer + '_>, RenderError> {
        Ok(Box::new(Flawed { inner: CpuRenderer::new(data, Some(1))?, slow, after: None, fails_at, ranges: 0 }))
    };
    Member { name: "flawed".to_owned(), open: Box::new(open) }
}

fn sound(data: &SceneData) -> Member<'_> {
    flawed(data, Duration::ZERO, None)
}

/// Renders with nobody watching; the progress must end at what the film holds.
fn run(members: Vec<Member>, samples: Range<u32>, film: &mut Film) -> Result<Vec<Share>, RenderError> {
    let progress = AtomicI64::new(0);
    let advance = |done| {
        progress.fetch_add(done, Ordering::Relaxed);
    };
    let order = Order { crop: film.crop(), samples, time: None, stop: &|| false, advance: &advance };
    let shares = render(members, &order, film)?;
    let total: u64 = shares.iter().map(|share| share.samples).sum();
    assert_eq!(total, film.samples().total(), "the shares add up");
    assert_eq!(progress.into_inner(), (film.crop().area() as u64 * total) as i64, "so does the progress");
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
    let (scene, mut data) = scene();
    data.header.aovs = 1;
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
        Member { name: "vulkan".to_owned(), open: Box::new(open) }
    };
    let slow = || -> Result<Box<dyn Renderer + '_>, RenderError> {
        let inner = CpuRenderer::new(&data, Some(1))?;
        let slow = Duration::from_millis(50);
        Ok(Box::new(Flawed { inner, slow, after: Some(&finished), fails_at: None, ranges: 0 }))
    };
    let slow = Member { name: "slow".to_owned(), open: Box::new(slow) };
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
    let watch = Watch { abort: &AtomicBool::new(false), advance: &|_| {} };
    let job = Job { crop: alone.crop(), samples: 7..31 };
    CpuRenderer::new(&data, None).unwrap().accumulate(&job, &mut alone, &watch).unwrap();
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
        assert!(matches!(&shares[0].error, Some(RenderError::Device(text)) if text.contains("lost")), "{shares:?}");
        assert!(shares[1].error.is_none() && shares[1].samples > 0, "{shares:?}");
    }
}

#[test]
fn a_device_that_cannot_be_opened_leaves_the_picture_to_the_others() {
    let (scene, data) = scene();
    let broken = Member {
        name: "broken".to_owned(),
        open: Box::new(|| Err(RenderError::Device("out of device memory".to_owned()))),
    };
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
    let mut film = scenes::film(&scene, &data);
    let asked = AtomicU32::new(0);
    let stop = || asked.fetch_add(1, Ordering::Relaxed) > 12;
    let members = vec![flawed(&data, Duration::from_millis(2), None), flawed(&data, Duration::from_millis(7), None)];
    let order = Order { crop: film.crop(), samples: 0..1 << 24, time: None, stop: &stop, advance: &|_| {} };
    let shares = render(members, &order, &mut film).unwrap();
    let end = film.samples().total() as u32;
    assert!(end > 1, "{shares:?}");
    assert_eq!(film.samples().as_slice(), std::slice::from_ref(&(0..end)));
    let alone = scenes::render(&mut CpuRenderer::new(&data, None).unwrap(), &scene, &data, 0..end);
    assert_same(&alone, &film, "what was finished");
}

#[test]
fn a_time_limit_of_nothing_still_gives_one_range_each_at_most() {
    let (scene, data) = scene();
    let mut film = scenes::film(&scene, &data);
    let order =
        Order { crop: film.crop(), samples: 0..1 << 24, time: Some(Duration::ZERO), stop: &|| false, advance: &|_| {} };
    render(vec![sound(&data), sound(&data)], &order, &mut film).unwrap();
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
        fn accumulate(&mut self, job: &Job, film: &mut Film, watch: &Watch) -> Result<Counters, RenderError> {
            self.1.lock().unwrap().push(job.samples.end - job.samples.start);
            self.0.accumulate(job, film, watch)
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
    run(vec![Member { name: String::new(), open: Box::new(open) }], 0..TAKE.samples, &mut film).unwrap();
    let lengths = lengths.into_inner().unwrap();
    assert_eq!(lengths[0], 1);
    assert!(lengths.windows(2).all(|pair| pair[1] <= 4 * pair[0]), "{lengths:?}");
    assert!(lengths.iter().any(|&length| length > 1), "{lengths:?}");
}
