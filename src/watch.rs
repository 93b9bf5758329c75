//! Who looks on while something long is done: how far it is, how fast it goes, and whether it is to end.

use std::fmt;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// One piece of work as seen from outside. Whoever works calls `advance` and asks `is_cancelled` often; whoever waits reads
/// `done` and `rate`, and may `cancel`, from any thread.
pub struct Watch<'a> {
    started: Instant,
    limit: Option<Duration>,
    done: AtomicU64,
    cancelled: AtomicBool,
    /// When it was first seen to be cancelled.
    noticed: OnceLock<Instant>,
    asked: Option<&'a (dyn Fn() -> bool + Sync)>,
    told: Option<&'a (dyn Fn(i64) + Sync)>,
}

impl Default for Watch<'_> {
    /// Nobody looks on, and nothing ends the work.
    fn default() -> Self {
        Self {
            started: Instant::now(),
            limit: None,
            done: AtomicU64::new(0),
            cancelled: AtomicBool::new(false),
            noticed: OnceLock::new(),
            asked: None,
            told: None,
        }
    }
}

impl<'a> Watch<'a> {
    /// Work is also cancelled while `asked` says so.
    #[must_use]
    pub fn asking(self, asked: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self { asked: Some(asked), ..self }
    }

    /// `told` hears of every step, as `advance` does.
    #[must_use]
    pub fn telling(self, told: &'a (dyn Fn(i64) + Sync)) -> Self {
        Self { told: Some(told), ..self }
    }

    /// The work may take so long, from now on. What heeds a limit says so.
    #[must_use]
    pub fn limited(self, limit: Duration) -> Self {
        Self { started: Instant::now(), limit: Some(limit), ..self }
    }

    /// Asks the work to end.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    pub fn is_cancelled(&self) -> bool {
        self.cancelled_for().is_some()
    }

    /// How long ago work was first seen to be cancelled.
    pub fn cancelled_for(&self) -> Option<Duration> {
        let is_cancelled = self.cancelled.load(Ordering::Relaxed) || self.asked.is_some_and(|asked| asked());
        is_cancelled.then(|| self.noticed.get_or_init(Instant::now).elapsed())
    }

    /// So many more steps are done; negative where some were in vain. What a step is says the work.
    pub fn advance(&self, steps: i64) {
        self.done.fetch_add(steps as u64, Ordering::Relaxed);
        if let Some(told) = self.told {
            told(steps);
        }
    }

    /// Steps done so far.
    pub fn done(&self) -> u64 {
        self.done.load(Ordering::Relaxed)
    }

    /// Steps a second, from the beginning on.
    pub fn rate(&self) -> f64 {
        self.done() as f64 / self.started.elapsed().as_secs_f64().max(1e-9)
    }

    /// What is left of the limit, if there is one; zero once it is over.
    pub fn time_left(&self) -> Option<Duration> {
        self.limit.map(|limit| limit.saturating_sub(self.started.elapsed()))
    }
}

impl fmt::Debug for Watch<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Watch")
            .field("done", &self.done())
            .field("time_left", &self.time_left())
            .field("is_cancelled", &self.is_cancelled())
            .finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicI64;

    #[test]
    fn steps_add_up_and_those_in_vain_are_taken_back() {
        let heard = AtomicI64::new(0);
        let told = |steps| {
            heard.fetch_add(steps, Ordering::Relaxed);
        };
        let watch = Watch::default().telling(&told);
        watch.advance(7);
        watch.advance(-3);
        assert_eq!((watch.done(), heard.load(Ordering::Relaxed)), (4, 4));
        assert!(watch.rate() > 0.0);
    }

    #[test]
    fn work_ends_when_either_side_says_so() {
        let asked = AtomicBool::new(false);
        let ask = || asked.load(Ordering::Relaxed);
        let watch = Watch::default().asking(&ask);
        assert!(!watch.is_cancelled());
        asked.store(true, Ordering::Relaxed);
        assert!(watch.is_cancelled());
        let watch = Watch::default();
        watch.cancel();
        assert!(watch.is_cancelled());
    }

    #[test]
    fn a_limit_runs_out_and_no_limit_does_not() {
        assert_eq!(Watch::default().time_left(), None);
        assert_eq!(Watch::default().limited(Duration::ZERO).time_left(), Some(Duration::ZERO));
        assert!(Watch::default().limited(Duration::from_secs(1000)).time_left() > Some(Duration::from_secs(900)));
    }
}
