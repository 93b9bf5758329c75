//! Who renders which samples, where several renderers make one picture.
//!
//! Samples are handed out in ranges, in ascending order, to whoever is free; a range is as long as its renderer should take
//! half a second for, or a few seconds while that is only a few samples. Integer sums do not care who adds what: the picture
//! is the one that any of them would have made alone. What a renderer that fails has not finished goes to the others. When
//! nothing is left to hand out, whoever is free does the range again of which the end is farthest away, if it can be sooner;
//! the first to finish counts, so a slow device never makes a picture late.

use super::RenderError;
use crate::watch::Watch;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Seconds that a range should take: long enough to fill a device, short enough to stop at.
const RANGE_SECONDS: f64 = 0.5;
/// It may take longer, up to so many seconds, to hold so many samples: those of a pixel go well together (`vulkan/plan`).
const LONG_RANGE_SECONDS: f64 = 4.0;
const LONG_RANGE_SAMPLES: f64 = 16.0;
/// A range is at most this many times as long as the one before.
const GROWTH: u32 = 4;
/// Whoever is cancelled has so long to end what it has begun; what takes longer is given up.
const GRACE: Duration = Duration::from_secs(1);
/// How often one that waits looks again whether it is to stop, or could help.
const LOOK_AGAIN: Duration = Duration::from_millis(20);

/// A range under way. Whoever was given it adds to its film at once; whoever does it again keeps the result apart until the
/// first has given up or finished.
struct Run {
    samples: Range<u32>,
    started: Instant,
    /// Seconds that the first should take; 0 if that is unknown.
    expected: f64,
    /// Set to make the first, and the second, give up.
    abort: Arc<[AtomicBool; 2]>,
    /// Whether the first, and a second, are at it.
    working: [bool; 2],
    done: bool,
}

impl Run {
    /// Seconds until the first is done, as far as can be told: what is late will be late by as much again.
    fn left(&self) -> f64 {
        (self.expected - self.started.elapsed().as_secs_f64()).abs()
    }
}

/// What a worker is to do.
pub struct Task {
    pub samples: Range<u32>,
    /// Someone slower is at it already.
    pub again: bool,
    abort: Arc<[AtomicBool; 2]>,
}

impl Task {
    /// Whether to give up: somebody else was faster.
    pub fn is_overtaken(&self) -> bool {
        self.abort[usize::from(self.again)].load(Ordering::Relaxed)
    }
}

/// What is known of one renderer.
#[derive(Clone, Copy, Default)]
struct Speed {
    /// Samples a pixel in a second; 0 before the first range, and of one that has failed.
    rate: f64,
    /// Length of its last range.
    last: u32,
}

/// Where workers get their ranges.
pub struct Scheduler<'a> {
    watch: &'a Watch<'a>,
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    /// To be handed out, from the last one on; what renderers that failed gave back among it.
    waiting: Vec<Range<u32>>,
    running: Vec<Run>,
    speeds: Vec<Speed>,
    /// Whether any range is done.
    begun: bool,
    /// Renderers that have not failed.
    well: usize,
    /// A worker has panicked.
    broken: bool,
}

impl State {
    fn run(&mut self, first: u32) -> &mut Run {
        let run = self.running.iter_mut().find(|run| run.samples.start == first);
        run.expect("a range is listed while someone is at it")
    }

    /// Forgets the range at `first` if nobody is at it any more; what is not done is handed out again.
    fn tidy(&mut self, first: u32) {
        let is_idle = |run: &Run| run.samples.start == first && run.working == [false; 2];
        if let Some(at) = self.running.iter().position(is_idle) {
            let run = self.running.swap_remove(at);
            if !run.done {
                self.waiting.push(run.samples);
            }
        }
    }

    /// The next range for renderer `me`, of no more than its share of what is left. `left`: seconds that it may take at most.
    fn take(&mut self, me: usize, left: f64) -> Option<Range<u32>> {
        let Speed { rate, last } = self.speeds[me];
        let waiting: u32 = self.waiting.iter().map(|range| range.end - range.start).sum();
        let together: f64 = self.speeds.iter().map(|speed| speed.rate).sum();
        let within = |seconds: f64| rate * seconds.min(left);
        let wanted = within(RANGE_SECONDS).max(within(LONG_RANGE_SECONDS).min(LONG_RANGE_SAMPLES));
        let wanted = wanted.min(f64::from(last) * f64::from(GROWTH));
        let fair = f64::from(waiting) * rate / together.max(rate).max(f64::MIN_POSITIVE);
        let length = wanted.min(libm::ceil(fair)).max(1.0) as u32;
        let mut range = self.waiting.pop()?;
        let rest = range.start.saturating_add(length).min(range.end)..range.end;
        range.end = rest.start;
        if !rest.is_empty() {
            self.waiting.push(rest);
        }
        Some(range)
    }

    fn begin(&mut self, me: usize, samples: Range<u32>) -> Task {
        let length = f64::from(samples.end - samples.start);
        let rate = self.speeds[me].rate;
        let abort = Arc::new([const { AtomicBool::new(false) }; 2]);
        self.running.push(Run {
            samples: samples.clone(),
            started: Instant::now(),
            expected: if rate > 0.0 { length / rate } else { 0.0 },
            abort: abort.clone(),
            working: [true, false],
            done: false,
        });
        Task { samples, abort, again: false }
    }

    /// The range of which the end is farthest away, if renderer `me` can be done with it sooner.
    fn help(&mut self, me: usize) -> Option<Task> {
        let rate = self.speeds[me].rate;
        let alone = self.running.iter_mut().filter(|run| run.working == [true, false] && !run.done);
        let run = alone.max_by(|a, b| a.left().total_cmp(&b.left()))?;
        let length = f64::from(run.samples.end - run.samples.start);
        if length >= run.left() * rate {
            return None;
        }
        run.abort[1].store(false, Ordering::Relaxed);
        run.working[1] = true;
        Some(Task { samples: run.samples.clone(), abort: run.abort.clone(), again: true })
    }
}

impl<'a> Scheduler<'a> {
    /// For `renderers` of them. `samples`: ranges that are not empty and do not overlap, in ascending order.
    pub fn new(samples: Vec<Range<u32>>, renderers: usize, watch: &'a Watch<'a>) -> Self {
        let state = State {
            waiting: samples.into_iter().rev().collect(),
            running: Vec::new(),
            speeds: vec![Speed::default(); renderers],
            begun: false,
            well: renderers,
            broken: false,
        };
        Self { watch, state: Mutex::new(state), changed: Condvar::new() }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'b>(&self, state: MutexGuard<'b, State>) -> MutexGuard<'b, State> {
        self.changed.wait_timeout(state, LOOK_AGAIN).unwrap_or_else(PoisonError::into_inner).0
    }

    /// Whether work was cancelled and has had its time to end.
    pub fn is_overdue(&self) -> bool {
        self.watch.cancelled_for().is_some_and(|since| since >= GRACE)
    }

    /// What renderer `me` does next; `None` when there is nothing more to do. Waits while others may yet fail or need help.
    pub fn next(&self, me: usize) -> Option<Task> {
        let mut state = self.lock();
        loop {
            let left = self.watch.time_left().map(|left| left.as_secs_f64());
            let is_over = left == Some(0.0) || self.watch.is_cancelled();
            if state.broken || self.is_overdue() || is_over && (state.begun || !state.running.is_empty()) {
                return None;
            }
            if let Some(samples) = state.take(me, left.unwrap_or(f64::INFINITY)) {
                return Some(state.begin(me, samples));
            }
            if state.running.is_empty() {
                return None;
            }
            if let Some(task) = state.help(me) {
                return Some(task);
            }
            state = self.wait(state);
        }
    }

    /// Renderer `me` is through with a range that it was given first. `seconds`: it took, if it is in the film.
    pub fn finish(&self, me: usize, samples: &Range<u32>, seconds: Option<f64>) {
        let mut state = self.lock();
        let run = state.run(samples.start);
        run.working[0] = false;
        if let Some(seconds) = seconds {
            run.done = true;
            run.abort[1].store(true, Ordering::Relaxed);
            let length = samples.end - samples.start;
            state.speeds[me] = Speed { rate: f64::from(length) / seconds.max(1e-4), last: length };
            state.begun = true;
        }
        state.tidy(samples.start);
        self.changed.notify_all();
    }

    /// A range was done again (`well`), or not: whether the result counts. Makes the first give up, and waits for that.
    pub fn settle(&self, samples: &Range<u32>, well: bool) -> bool {
        let mut state = self.lock();
        if well {
            state.run(samples.start).abort[0].store(true, Ordering::Relaxed);
            while !state.broken && state.run(samples.start).working[0] {
                state = self.wait(state);
            }
        }
        let is_broken = state.broken;
        let run = state.run(samples.start);
        let counts = well && !run.done && !is_broken;
        run.done |= counts;
        run.working[1] = false;
        state.begun |= counts;
        state.tidy(samples.start);
        self.changed.notify_all();
        counts
    }

    /// Renderer `me` has failed. Says so, unless it was the last: that is an error of the whole.
    pub fn lose(&self, me: usize, name: &str, error: &RenderError) {
        let mut state = self.lock();
        state.speeds[me].rate = 0.0;
        state.well -= 1;
        if state.well > 0 {
            log::warn!("{name}: {error}; the other devices take over");
        }
    }
}

/// Lets the others end where a worker panics: they would wait for what it was given.
pub struct Guard<'a>(pub &'a Scheduler<'a>);

impl Drop for Guard<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.lock().broken = true;
            self.0.changed.notify_all();
        }
    }
}
