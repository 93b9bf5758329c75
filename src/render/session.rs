//! A picture in the making: its film so far, and the devices that add to it.
//!
//! Everything that renders goes through here. A device computes the samples of a range apart (`Pass`), and the film takes all
//! of them or none, so it always holds whole samples of all its pixels, and may be looked at while devices work.

use super::scheduler::{Guard, Scheduler, Task};
use super::{Bounce, Counters, Job, Pass, RenderError, Renderer};
use crate::film::Film;
use crate::watch::Watch;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Opens a renderer, on the thread that will use it first.
pub type Open<'a> = Box<dyn FnOnce() -> Result<Box<dyn Renderer + 'a>, RenderError> + Send + 'a>;

/// A device that takes part.
pub struct Member<'a> {
    /// What messages call it until it is open.
    name: String,
    state: MemberState<'a>,
    /// What its last range computed: memory for the next one.
    pass: Pass,
}

enum MemberState<'a> {
    Closed(Open<'a>),
    Ready(Box<dyn Renderer + 'a>),
    /// It could not be opened, or has failed.
    Gone,
}

impl<'a> Member<'a> {
    /// One that is opened when it is needed.
    pub fn new(name: impl Into<String>, open: Open<'a>) -> Self {
        Self { name: name.into(), state: MemberState::Closed(open), pass: Pass::default() }
    }

    /// One that is open.
    pub fn of(renderer: impl Renderer + 'a) -> Self {
        Self { name: renderer.name(), state: MemberState::Ready(Box::new(renderer)), pass: Pass::default() }
    }

    /// Its name, itself and its memory, opened if it is not yet.
    fn open(&mut self) -> Result<(&str, &mut (dyn Renderer + 'a), &mut Pass), RenderError> {
        if let MemberState::Closed(_) = self.state
            && let MemberState::Closed(open) = std::mem::replace(&mut self.state, MemberState::Gone)
        {
            let renderer = open()?;
            self.name = renderer.name();
            log::info!("rendering on {}", self.name);
            self.state = MemberState::Ready(renderer);
        }
        match &mut self.state {
            MemberState::Ready(renderer) => Ok((&self.name, renderer.as_mut(), &mut self.pass)),
            _ => Err(RenderError::Failed(format!("{} has failed before", self.name))),
        }
    }
}

/// What one device did in a call of `Session::render`.
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

/// The film of a scene, and the devices that render it.
pub struct Session<'a> {
    film: Mutex<Arc<Film>>,
    members: Vec<Mutex<Member<'a>>>,
    /// Takes over where all members have failed.
    reserve: Option<Mutex<Member<'a>>>,
}

impl<'a> Session<'a> {
    /// `members`: one at least, of the film's scene. Those that are closed open when they are first needed.
    pub fn new(film: Film, members: Vec<Member<'a>>) -> Self {
        debug_assert!(!members.is_empty());
        Self { film: Mutex::new(Arc::new(film)), members: members.into_iter().map(Mutex::new).collect(), reserve: None }
    }

    /// With a device that goes on from the film there is once all members have failed.
    #[must_use]
    pub fn with_reserve(self, reserve: Option<Member<'a>>) -> Self {
        Self { reserve: reserve.map(Mutex::new), ..self }
    }

    /// Opens all devices that are not open yet; the first error.
    pub fn open(&self) -> Result<(), RenderError> {
        self.members.iter().try_for_each(|member| lock(member).open().map(drop))
    }

    /// The film so far: whole samples of all its pixels. No device waits for it, and it never changes; while one is kept, the
    /// next range makes a film beside it.
    pub fn snapshot(&self) -> Arc<Film> {
        lock(&self.film).clone()
    }

    /// The film in the end.
    pub fn into_film(self) -> Film {
        let film = self.film.into_inner().unwrap_or_else(PoisonError::into_inner);
        Arc::try_unwrap(film).unwrap_or_else(|shared| (*shared).clone())
    }

    /// Begins another film of the same scene on the same devices; the result is the one before.
    pub fn restart(&self, film: Film) -> Arc<Film> {
        std::mem::replace(&mut *lock(&self.film), Arc::new(film))
    }

    /// What devices are called: those that are not open yet by what was asked for.
    pub fn names(&self) -> Vec<String> {
        self.members.iter().map(|member| lock(member).name.clone()).collect()
    }

    /// Every step of one sample of one pixel on the first device, ordered by (depth, path id).
    pub fn inspect(&self, x: u32, y: u32, sample: u32) -> Result<Vec<Bounce>, RenderError> {
        lock(&self.members[0]).open()?.1.inspect(x, y, sample)
    }

    /// Renders those of `samples` that the film does not hold yet, on all devices; what each of them did. Steps of `watch` are
    /// pixels times samples. At the end of its time devices end what they have begun, and one range at least is done.
    /// Cancelled, they have a second to do so, and what takes longer is given up. An error if every device fails; the film then holds what was finished.
    pub fn render(&self, samples: Range<u32>, watch: &Watch) -> Result<Vec<Share>, RenderError> {
        let members: Vec<&Mutex<Member>> = self.members.iter().collect();
        let mut shares = self.work(&members, samples.clone(), watch);
        if let Some(error) = overall_error(&shares) {
            let Some(reserve) = self.reserve.as_ref().filter(|_| !watch.is_cancelled()) else { return Err(error) };
            let name = lock(reserve).name.clone();
            log::warn!("{error}: going on with {name}");
            let last = self.work(&[reserve], samples, watch);
            if let Some(error) = overall_error(&last) {
                return Err(error);
            }
            shares.extend(last);
        }
        Ok(shares)
    }

    /// Lets each member work on a thread of its own until the samples end, or they do.
    fn work(&self, members: &[&Mutex<Member<'a>>], samples: Range<u32>, watch: &Watch) -> Vec<Share> {
        let missing = lock(&self.film).samples().missing(samples);
        let scheduler = Scheduler::new(missing, members.len(), watch);
        let one = |(index, member): (usize, &&Mutex<Member<'a>>)| {
            let _guard = Guard(&scheduler);
            let mut member = lock(member);
            let share = Share { name: member.name.clone(), ..Share::default() };
            let mut worker = Worker { scheduler: &scheduler, index, film: &self.film, share, watch };
            let ended = worker.work(&mut member);
            if let Err(error) = ended {
                scheduler.lose(index, &worker.share.name, &error);
                member.state = MemberState::Gone;
                worker.share.error = Some(error);
            }
            worker.share
        };
        match members {
            // No thread but the caller's is needed.
            [member] => vec![one((0, member))],
            _ => std::thread::scope(|scope| {
                let one = &one;
                let threads: Vec<_> = members.iter().enumerate().map(|each| scope.spawn(move || one(each))).collect();
                let resume = |panic| std::panic::resume_unwind(panic);
                threads.into_iter().map(|thread| thread.join().unwrap_or_else(resume)).collect()
            }),
        }
    }
}

/// The last member's error, if all have failed.
fn overall_error(shares: &[Share]) -> Option<RenderError> {
    let is_over = shares.iter().all(|share| share.error.is_some());
    shares.last().filter(|_| is_over).and_then(|share| share.error.clone())
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// One member at work.
struct Worker<'a> {
    scheduler: &'a Scheduler<'a>,
    index: usize,
    film: &'a Mutex<Arc<Film>>,
    share: Share,
    watch: &'a Watch<'a>,
}

impl Worker<'_> {
    fn work(&mut self, member: &mut Member) -> Result<(), RenderError> {
        let (name, renderer, pass) = member.open()?;
        self.share.name = name.to_owned();
        while let Some(task) = self.scheduler.next(self.index) {
            let start = Instant::now();
            let result = if task.again { self.again(renderer, pass, &task) } else { self.first(renderer, pass, &task) };
            self.share.busy_s += start.elapsed().as_secs_f64();
            match result {
                Ok(true) => {
                    self.share.counters += pass.counters;
                    self.share.samples += u64::from(task.samples.end - task.samples.start);
                    self.share.ranges += 1;
                }
                Ok(false) | Err(RenderError::Aborted) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// The whole crop's samples of the task.
    fn job(&self, task: &Task) -> Job {
        Job { crop: lock(self.film).crop(), samples: task.samples.clone() }
    }

    /// Renders a range and adds it to the film.
    fn first(&self, renderer: &mut dyn Renderer, pass: &mut Pass, task: &Task) -> Result<bool, RenderError> {
        let job = self.job(task);
        let told = |steps| self.watch.advance(steps);
        let asked = || task.is_overtaken() || self.scheduler.is_overdue();
        let watch = Watch::default().asking(&asked).telling(&told);
        let start = Instant::now();
        let result = renderer.render(&job, &watch, pass);
        match result {
            Ok(()) => pass.add_to_shared(&job, &mut lock(self.film)),
            Err(_) => self.watch.advance(-(watch.done() as i64)),
        }
        let seconds = result.is_ok().then(|| start.elapsed().as_secs_f64());
        self.scheduler.finish(self.index, &task.samples, seconds);
        result.map(|()| true)
    }

    /// Renders a range again that another is slow with. Nothing counts if that one was quicker after all.
    fn again(&self, renderer: &mut dyn Renderer, pass: &mut Pass, task: &Task) -> Result<bool, RenderError> {
        let job = self.job(task);
        let asked = || task.is_overtaken() || self.scheduler.is_overdue();
        let watch = Watch::default().asking(&asked);
        let result = renderer.render(&job, &watch, pass);
        if !self.scheduler.settle(&task.samples, result.is_ok()) {
            return result.map(|()| false);
        }
        pass.add_to_shared(&job, &mut lock(self.film));
        self.watch.advance(watch.done() as i64);
        result.map(|()| true)
    }
}
