//! Keeping dispatches short: no watchdog fires, and an interrupt is soon noticed.

/// Seconds a dispatch of a full chunk should take: the design allows 0.1, and some chunks cost more than the average.
const DISPATCH_GOAL: f64 = 0.04;
/// Below this the fixed cost of a dispatch hides the cost of its rays.
const DISPATCH_TELLING: f64 = 0.001;
/// Seconds a submission of several rounds should not exceed.
const SUBMISSION_GOAL: f64 = 0.25;
/// Rounds recorded at a time.
const MAX_ROUNDS: u32 = 64;
/// Rays of the very first chunk on a device whose speed is unknown.
const FIRST_CHUNK: u32 = 1 << 14;
/// Chunks are not made smaller: the fixed costs of a round would be all there is.
const LEAST_CHUNK: u32 = 1 << 10;

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

/// What a submission did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Work {
    /// Rounds up to the one that was done, and the rays in their chunks.
    pub rounds: u32,
    pub rays: u64,
    /// Seconds on the host's clock.
    pub wall: f64,
    /// Seconds on the device's, over all rounds; `None` where it has no clock.
    pub stages: Option<StageTimes>,
}

/// Decides rays per chunk and rounds per submission from what the last ones took. Results do not depend on it.
#[derive(Clone, Debug)]
pub struct Pace {
    chunk_limit: u32,
    chunk_most: u32,
    round_seconds: f64,
    /// Rounds the last batch needed.
    rounds_expected: u32,
    /// Seconds in the slowest stage and rays, old ones fading.
    seconds: f64,
    rays: f64,
}

impl Pace {
    pub fn new(chunk_most: u32) -> Pace {
        Pace {
            chunk_limit: chunk_most.min(FIRST_CHUNK),
            chunk_most,
            round_seconds: 0.0,
            rounds_expected: 2,
            seconds: 0.0,
            rays: 0.0,
        }
    }

    /// Rays the next chunks may hold.
    pub fn chunk_limit(&self) -> u32 {
        self.chunk_limit
    }

    /// Rounds to record next, when `done` of this batch have been recorded: as many as the last batch took, then as many
    /// again as there were.
    pub fn rounds(&self, done: u32) -> u32 {
        let wanted = if done < self.rounds_expected { self.rounds_expected - done } else { done.max(4) };
        let affordable = (SUBMISSION_GOAL / self.round_seconds.max(1e-6)) as u32;
        wanted.min(affordable).clamp(1, MAX_ROUNDS)
    }

    /// A batch ended after `rounds` rounds.
    pub fn batch_ended(&mut self, rounds: u32) {
        self.rounds_expected = rounds;
    }

    /// Learns from a submission. Averages, not the longest dispatch: on a busy machine that measures the others.
    pub fn learn(&mut self, work: &Work) {
        if work.rounds == 0 {
            return;
        }
        let rounds = f64::from(work.rounds);
        self.round_seconds = work.wall / rounds;
        let slowest = work.stages.map_or(work.wall, |stages| stages.extend.max(stages.shadow).max(stages.shade));
        let full = work.rays as f64 >= rounds * f64::from(self.chunk_limit) / 4.0;
        if !full && slowest / rounds < DISPATCH_TELLING {
            return;
        }
        self.seconds = self.seconds / 2.0 + slowest;
        self.rays = self.rays / 2.0 + work.rays as f64;
        let fitting = DISPATCH_GOAL * self.rays / self.seconds.max(1e-9);
        // Growing by steps: what was measured on few rays may not hold for many.
        let most = self.chunk_most.min(self.chunk_limit.saturating_mul(2));
        self.chunk_limit = (fitting as u32).clamp(LEAST_CHUNK.min(most), most);
    }
}

/// Splits a submission's timestamps: seconds before the first round, then those of all rounds by stage.
/// Timestamps: start, first round's begin, then `STAGES` per round.
pub fn split(times: &[f64]) -> Option<(f64, StageTimes)> {
    let [start, begin, rest @ ..] = times else { return None };
    let mut last = *begin;
    let mut sum = StageTimes::default();
    for round in rest.chunks_exact(STAGES) {
        sum.schedule += (round[0] - last).max(0.0);
        sum.extend += (round[1] - round[0]).max(0.0);
        sum.shadow += (round[2] - round[1]).max(0.0);
        sum.shade += (round[3] - round[2]).max(0.0);
        last = round[3];
    }
    Some(((begin - start).max(0.0), sum))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn work(rounds: u32, rays: u64, seconds: f64) -> Work {
        let stages = StageTimes { extend: seconds, shade: seconds / 2.0, ..StageTimes::default() };
        Work { rounds, rays, wall: seconds * 1.5, stages: Some(stages) }
    }

    #[test]
    fn chunks_shrink_to_what_the_device_traces_in_the_goal_and_no_further_than_the_least() {
        let mut pace = Pace::new(100_000);
        pace.learn(&work(2, 2 * 16_384, 0.32)); // 102,400 rays a second
        assert_eq!(pace.chunk_limit(), 4096);
        pace.learn(&work(1, 4096, 100.0));
        assert_eq!(pace.chunk_limit(), LEAST_CHUNK);
    }

    #[test]
    fn chunks_grow_to_the_most_on_a_fast_device() {
        let mut pace = Pace::new(100_000);
        for expected in [32_768, 65_536, 100_000, 100_000] {
            pace.learn(&work(4, 4 * u64::from(pace.chunk_limit()), 0.001));
            assert_eq!(pace.chunk_limit(), expected);
        }
    }

    #[test]
    fn a_few_rays_whose_dispatches_are_all_overhead_say_nothing() {
        let mut pace = Pace::new(100_000);
        pace.learn(&work(10, 50, 0.003));
        assert_eq!(pace.chunk_limit(), FIRST_CHUNK);
        pace.learn(&work(10, 50, 0.3));
        assert_eq!(pace.chunk_limit(), LEAST_CHUNK, "30 ms for 5 rays is not overhead");
    }

    #[test]
    fn rounds_follow_the_last_batch_then_double_within_the_time_of_a_submission() {
        let mut pace = Pace::new(1000);
        pace.batch_ended(9);
        assert_eq!([pace.rounds(0), pace.rounds(8), pace.rounds(10), pace.rounds(20)], [9, 1, 10, 20]);
        pace.learn(&work(1, 1000, 0.125 / 1.5));
        assert_eq!(pace.rounds(0), 2);
    }

    #[test]
    fn timestamps_split_by_round_and_stage() {
        let times = [0.0, 1.0, 1.5, 3.5, 4.0, 7.0, 7.5, 8.0, 8.0, 9.0];
        let sum = StageTimes { schedule: 1.0, extend: 2.5, shadow: 0.5, shade: 4.0 };
        assert_eq!(split(&times), Some((1.0, sum)));
        assert_eq!(split(&[]), None);
    }
}
