//! Keeping dispatches short: no watchdog fires, and an interrupt is soon noticed.

use super::context::Submission;

/// A dispatch longer than this makes the chunk smaller (DESIGN: none takes more than 100 ms).
const DISPATCH_LONG: f64 = 0.08;
/// What a shrunken chunk aims at, and below what a full chunk may grow.
const DISPATCH_GOAL: f64 = 0.04;
const DISPATCH_SHORT: f64 = 0.02;
/// A submission of several rounds should not be longer than this.
const SUBMISSION_GOAL: f64 = 0.25;
/// Rounds recorded at a time.
const MAX_ROUNDS: u32 = 64;
/// Rays of the very first chunk on a device whose speed is unknown.
const FIRST_CHUNK: u32 = 1 << 14;

/// Stages of a round in the order of their timestamps.
pub const STAGES: usize = 4;

/// Seconds by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageTimes {
    pub schedule: f64,
    pub extend: f64,
    pub shadow: f64,
    pub shade: f64,
}

/// Decides rays per chunk and rounds per submission from what the last ones took. Results do not depend on it.
#[derive(Clone, Debug)]
pub struct Pace {
    chunk_limit: u32,
    chunk_most: u32,
    round_seconds: f64,
    /// Rounds the last batch needed, with the one that finds nothing to do.
    rounds_expected: u32,
}

impl Pace {
    pub fn new(chunk_most: u32) -> Pace {
        Pace { chunk_limit: chunk_most.min(FIRST_CHUNK), chunk_most, round_seconds: 0.0, rounds_expected: 2 }
    }

    /// Rays the next chunks may hold.
    pub fn chunk_limit(&self) -> u32 {
        self.chunk_limit
    }

    /// Rounds to record next, when this batch has already run `done` of them.
    pub fn rounds(&self, done: u32) -> u32 {
        let wanted = match self.rounds_expected.saturating_sub(done) {
            0 => 4,
            more => more,
        };
        let affordable = (SUBMISSION_GOAL / self.round_seconds.max(1e-6)) as u32;
        wanted.min(affordable).clamp(1, MAX_ROUNDS)
    }

    /// A batch ended after `rounds` rounds that had work.
    pub fn batch_ended(&mut self, rounds: u32) {
        self.rounds_expected = rounds + 1;
    }

    /// Learns from a submission of `worked` rounds with work. `full` says that a chunk of `chunk_limit` rays was among
    /// them. `rounds` are the times by round where the device has a clock.
    pub fn learn(&mut self, submission: &Submission, rounds: &[StageTimes], worked: u32, full: bool) {
        let wall = submission.wall.as_secs_f64();
        if worked > 0 {
            self.round_seconds = wall / f64::from(worked);
        }
        let longest = rounds.iter().flat_map(|round| [round.extend, round.shadow, round.shade]).reduce(f64::max);
        let longest = longest.unwrap_or(self.round_seconds); // without a clock: the whole round, to be safe
        if longest > DISPATCH_LONG {
            let smaller = f64::from(self.chunk_limit) * (DISPATCH_GOAL / longest).max(0.125);
            self.chunk_limit = (smaller as u32).clamp(1, self.chunk_most);
        } else if longest < DISPATCH_SHORT && full {
            self.chunk_limit = self.chunk_limit.saturating_mul(2).min(self.chunk_most);
        }
    }
}

/// Splits a submission's timestamps: `lead` seconds before the first round, then the rounds.
/// Timestamps: start, first round's begin, then `STAGES` per round.
pub fn split(times: &[f64]) -> (f64, Vec<StageTimes>) {
    let [start, begin, rest @ ..] = times else {
        return (0.0, Vec::new());
    };
    let mut last = *begin;
    let mut rounds = Vec::with_capacity(rest.len() / STAGES);
    for round in rest.chunks_exact(STAGES) {
        rounds.push(StageTimes {
            schedule: (round[0] - last).max(0.0),
            extend: (round[1] - round[0]).max(0.0),
            shadow: (round[2] - round[1]).max(0.0),
            shade: (round[3] - round[2]).max(0.0),
        });
        last = round[3];
    }
    ((begin - start).max(0.0), rounds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn took(seconds: f64) -> (Submission, [StageTimes; 1]) {
        let submission = Submission { wall: Duration::from_secs_f64(seconds), times: Vec::new() };
        (submission, [StageTimes { extend: seconds, ..StageTimes::default() }])
    }

    #[test]
    fn a_long_dispatch_makes_chunks_smaller_and_short_full_ones_make_them_grow_to_the_most() {
        let mut pace = Pace::new(100_000);
        let (slow, rounds) = took(0.16);
        pace.learn(&slow, &rounds, 1, true);
        assert_eq!(pace.chunk_limit(), FIRST_CHUNK / 4);
        let (quick, rounds) = took(0.001);
        pace.learn(&quick, &rounds, 1, false);
        assert_eq!(pace.chunk_limit(), FIRST_CHUNK / 4, "a chunk that was not full says nothing");
        for _ in 0..10 {
            pace.learn(&quick, &rounds, 1, true);
        }
        assert_eq!(pace.chunk_limit(), 100_000);
    }

    #[test]
    fn rounds_follow_the_last_batch_within_the_time_of_a_submission() {
        let mut pace = Pace::new(1000);
        pace.batch_ended(9);
        assert_eq!((pace.rounds(0), pace.rounds(10)), (10, 4));
        let (slow, rounds) = took(0.125);
        pace.learn(&slow, &rounds, 1, false);
        assert_eq!(pace.rounds(0), 2);
    }

    #[test]
    fn timestamps_split_by_round_and_stage() {
        let (lead, rounds) = split(&[0.0, 1.0, 1.5, 3.5, 4.0, 7.0, 7.5, 8.0, 8.0, 9.0]);
        assert_eq!(lead, 1.0);
        assert_eq!(rounds[0], StageTimes { schedule: 0.5, extend: 2.0, shadow: 0.5, shade: 3.0 });
        assert_eq!(rounds[1], StageTimes { schedule: 0.5, extend: 0.5, shadow: 0.0, shade: 1.0 });
        assert_eq!(split(&[]), (0.0, Vec::new()));
    }
}
