//! One picture on several renderers at once, each on a thread of its own.
//!
//! Samples are handed out in ranges, in ascending order, to whoever is free; a range is as long as its renderer should take
//! half a second for, or a few seconds while that is only a few samples. Each adds to a film of its own, and integer sums
//! do not care who adds what: the picture is the one that any of them would have made alone. What a renderer that fails has
//! not finished goes to the others. When nothing is left to hand out, whoever is free does the range again of which the end
//! is farthest away, if it can be sooner; the first to finish counts, so a slow device never makes a picture late.

use super::{Counters, Job, RenderError, Renderer, Watch};
use crate::film::{Film, Rect};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Seconds that a range should take: long enough to fill a device, short enough to stop at.
const RANGE_SECONDS: f64 = 0.5;
/// It may take longer, up to so many seconds, to hold so many samples: those of a pixel go well together (`vulkan/plan`).
const LONG_RANGE_SECONDS: f64 = 4.0;
const LONG_RANGE_SAMPLES: f64 = 16.0;
/// A range is at most this many times as long as the one before.
const GROWTH: u32 = 4;
/// How often one that waits looks again whether it is to stop, or could help.
const LOOK_AGAIN: Duration = Duration::from_millis(20);

/// Opens a renderer on the thread that will use it.
pub type Open<'a> = Box<dyn FnOnce() -> Result<Box<dyn Renderer + 'a>, RenderError> + Send + 'a>;

/// One of the team, not yet open.
pub struct Member<'a> {
    /// What messages call it until it is open.
    pub name: String,
    pub open: Open<'a>,
}

/// What is to be rendered.
pub struct Order<'a> {
    pub crop: Rect,
    pub samples: Range<u32>,
    /// No range begins after this time, but the first does.
    pub time: Option<Duration>,
    /// Asked before each range but the first: whether to end with those under way.
    pub stop: &'a (dyn Fn() -> bool + Sync),
    /// Samples finished since the last call (pixels times samples); negative where work was in vain.
    pub advance: &'a (dyn Fn(i64) + Sync),
}

/// What one of the team did.
#[derive(Debug, Default)]
pub struct Share {
    pub name: String,
    /// Samples a pixel that count, and in how many ranges.
    pub samples: u64,
    pub ranges: u32,
    /// Seconds at work, work in vain included.
    pub busy_s: f64,
    pub counters: Counters,
    /// Why it stopped early.
    pub error: Option<RenderError>,
}

/// Renders `order` on all `members` into `film`, whose crop is the order's. The film then holds every range that was begun.
/// An error if every member fails.
pub fn render(members: Vec<Member>, order: &Order, film: &mut Film) -> Result<Vec<Share>, RenderError> {
    debug_assert_eq!(film.crop(), order.crop);
    let desk = Desk::new(order, members.len());
    let empty = Film::new(film.spec().clone());
    let mut films: Vec<Film> = (1..members.len()).map(|_| empty.clone()).collect();
    let mut shares: Vec<Share> =
        members.iter().map(|member| Share { name: member.name.clone(), ..Share::default() }).collect();
    std::thread::scope(|scope| {
        let places = std::iter::once(&mut *film).chain(&mut films).zip(&mut shares).zip(members).enumerate();
        for (index, ((film, share), member)) in places {
            let (desk, empty) = (&desk, &empty);
            scope.spawn(move || {
                let _leaving = Leaving(desk);
                let mut worker = Worker { desk, index, film, empty, share };
                let ended = worker.work(member.open);
                share.error = ended.err();
                if let Some(error) = &share.error {
                    desk.lose(index, &share.name, error);
                }
            });
        }
    });
    let is_over = shares.iter().all(|share| share.error.is_some());
    if let Some(error) = shares.iter_mut().rev().find_map(|share| share.error.take_if(|_| is_over)) {
        return Err(error);
    }
    for part in &films {
        film.merge(part).expect("ranges are handed out once, for one picture");
    }
    Ok(shares)
}

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
struct Task {
    samples: Range<u32>,
    abort: Arc<[AtomicBool; 2]>,
    /// Someone slower is at it already.
    again: bool,
}

/// What is known of one member.
#[derive(Clone, Copy, Default)]
struct Pace {
    /// Samples a pixel in a second; 0 before the first range, and of one that has failed.
    rate: f64,
    /// Length of its last range.
    last: u32,
}

/// Where workers get their ranges.
struct Desk<'a> {
    order: &'a Order<'a>,
    start: Instant,
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    /// First sample that was never handed out.
    next: u32,
    /// Given back by renderers that failed.
    returned: Vec<Range<u32>>,
    running: Vec<Run>,
    paces: Vec<Pace>,
    /// Whether any range is done.
    begun: bool,
    /// Members that have not failed.
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
                self.returned.push(run.samples);
            }
        }
    }

    /// The next range for member `me`, of no more than its share of what is left. `left`: seconds that it may take at most.
    fn take(&mut self, me: usize, end: u32, left: f64) -> Option<Range<u32>> {
        let Pace { rate, last } = self.paces[me];
        let waiting = (end - self.next) + self.returned.iter().map(|range| range.end - range.start).sum::<u32>();
        let together: f64 = self.paces.iter().map(|pace| pace.rate).sum();
        let within = |seconds: f64| rate * seconds.min(left);
        let wanted = within(RANGE_SECONDS).max(within(LONG_RANGE_SECONDS).min(LONG_RANGE_SAMPLES));
        let wanted = wanted.min(f64::from(last) * f64::from(GROWTH));
        let fair = f64::from(waiting) * rate / together.max(rate).max(f64::MIN_POSITIVE);
        let length = wanted.min(libm::ceil(fair)).max(1.0) as u32;
        let mut range = match self.returned.pop() {
            Some(range) => range,
            None => std::mem::replace(&mut self.next, end)..end,
        };
        if range.is_empty() {
            return None;
        }
        let rest = range.start.saturating_add(length).min(range.end)..range.end;
        range.end = rest.start;
        if rest.end == end {
            self.next = rest.start;
        } else if !rest.is_empty() {
            self.returned.push(rest);
        }
        Some(range)
    }

    fn begin(&mut self, me: usize, samples: Range<u32>) -> Task {
        let length = f64::from(samples.end - samples.start);
        let rate = self.paces[me].rate;
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

    /// The range of which the end is farthest away, if member `me` can be done with it sooner.
    fn help(&mut self, me: usize) -> Option<Task> {
        let rate = self.paces[me].rate;
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

impl<'a> Desk<'a> {
    fn new(order: &'a Order<'a>, members: usize) -> Self {
        let state = State {
            next: order.samples.start,
            returned: Vec::new(),
            running: Vec::new(),
            paces: vec![Pace::default(); members],
            begun: false,
            well: members,
            broken: false,
        };
        Self { order, start: Instant::now(), state: Mutex::new(state), changed: Condvar::new() }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'b>(&self, state: MutexGuard<'b, State>) -> MutexGuard<'b, State> {
        self.changed.wait_timeout(state, LOOK_AGAIN).unwrap_or_else(PoisonError::into_inner).0
    }

    /// What member `me` does next; `None` when there is nothing more to do. Waits while others may yet fail or need help.
    fn next(&self, me: usize) -> Option<Task> {
        let mut state = self.lock();
        loop {
            let left = self.order.time.map(|limit| limit.saturating_sub(self.start.elapsed()).as_secs_f64());
            let is_over = left == Some(0.0) || (self.order.stop)();
            if state.broken || is_over && (state.begun || !state.running.is_empty()) {
                return None;
            }
            if let Some(samples) = state.take(me, self.order.samples.end, left.unwrap_or(f64::INFINITY)) {
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

    /// Member `me` is through with a range that it was given first. `seconds`: it took, if it is in its film.
    fn finish(&self, me: usize, samples: &Range<u32>, seconds: Option<f64>) {
        let mut state = self.lock();
        let run = state.run(samples.start);
        run.working[0] = false;
        if let Some(seconds) = seconds {
            run.done = true;
            run.abort[1].store(true, Ordering::Relaxed);
            let length = samples.end - samples.start;
            state.paces[me] = Pace { rate: f64::from(length) / seconds.max(1e-4), last: length };
            state.begun = true;
        }
        state.tidy(samples.start);
        self.changed.notify_all();
    }

    /// A range was done again (`well`), or not: whether the result counts. Makes the first give up, and waits for that.
    fn settle(&self, samples: &Range<u32>, well: bool) -> bool {
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

    /// Member `me` has failed. Says so, unless it was the last: that is an error of the whole.
    fn lose(&self, me: usize, name: &str, error: &RenderError) {
        let mut state = self.lock();
        state.paces[me].rate = 0.0;
        state.well -= 1;
        if state.well > 0 {
            log::warn!("{name}: {error}; the other devices take over");
        }
    }
}

/// Lets the others end where a worker panics: they would wait for what it was given.
struct Leaving<'a>(&'a Desk<'a>);

impl Drop for Leaving<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.lock().broken = true;
            self.0.changed.notify_all();
        }
    }
}

/// One member at work.
struct Worker<'a> {
    desk: &'a Desk<'a>,
    index: usize,
    film: &'a mut Film,
    empty: &'a Film,
    share: &'a mut Share,
}

impl Worker<'_> {
    fn work(&mut self, open: Open) -> Result<(), RenderError> {
        let mut renderer = open()?;
        self.share.name = renderer.name();
        log::info!("rendering on {}", self.share.name);
        while let Some(task) = self.desk.next(self.index) {
            let start = Instant::now();
            let result =
                if task.again { self.again(renderer.as_mut(), &task) } else { self.first(renderer.as_mut(), &task) };
            self.share.busy_s += start.elapsed().as_secs_f64();
            match result {
                Ok(Some(counters)) => {
                    self.share.counters += counters;
                    self.share.samples += u64::from(task.samples.end - task.samples.start);
                    self.share.ranges += 1;
                }
                Ok(None) | Err(RenderError::Aborted) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Adds a range to this member's film.
    fn first(&mut self, renderer: &mut dyn Renderer, task: &Task) -> Result<Option<Counters>, RenderError> {
        let order = self.desk.order;
        let reported = AtomicU64::new(0);
        let advance = |done| {
            reported.fetch_add(done, Ordering::Relaxed);
            (order.advance)(done as i64);
        };
        let job = Job { crop: order.crop, samples: task.samples.clone() };
        let start = Instant::now();
        let result = renderer.accumulate(&job, self.film, &Watch { abort: &task.abort[0], advance: &advance });
        if result.is_err() {
            (order.advance)(-(reported.into_inner() as i64));
        }
        let seconds = result.is_ok().then(|| start.elapsed().as_secs_f64());
        self.desk.finish(self.index, &task.samples, seconds);
        result.map(Some)
    }

    /// Does a range again that another is slow with. Nothing counts if that one was quicker after all.
    fn again(&mut self, renderer: &mut dyn Renderer, task: &Task) -> Result<Option<Counters>, RenderError> {
        let order = self.desk.order;
        let mut apart = self.empty.clone();
        let job = Job { crop: order.crop, samples: task.samples.clone() };
        let result = renderer.accumulate(&job, &mut apart, &Watch { abort: &task.abort[1], advance: &|_| {} });
        if !self.desk.settle(&task.samples, result.is_ok()) {
            return result.map(|_| None);
        }
        self.film.merge(&apart).expect("whoever had the range first has given up");
        let samples = u64::from(task.samples.end - task.samples.start);
        (order.advance)((order.crop.area() as u64 * samples) as i64);
        result.map(Some)
    }
}
