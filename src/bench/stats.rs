//! What repeated measurements say.

use serde::{Deserialize, Serialize};

/// A run this many standard deviations off, estimated by the median absolute deviation, is an outlier.
const OUTLIER_DEVIATIONS: f64 = 10.0;
/// The standard deviation of normally distributed numbers over their median absolute deviation.
const DEVIATION_OVER_MAD: f64 = 1.4826;

/// Seconds of each timed run, in the order in which they ran.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Runs(pub Vec<f64>);

impl Runs {
    fn sorted(&self) -> Vec<f64> {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        sorted
    }

    /// The middle one, or the mean of the two in the middle; 0 of none.
    pub fn median(&self) -> f64 {
        median(&self.sorted())
    }

    /// Shortest and longest; 0 of none.
    pub fn range(&self) -> (f64, f64) {
        let sorted = self.sorted();
        (sorted.first().copied().unwrap_or(0.0), sorted.last().copied().unwrap_or(0.0))
    }

    /// Numbers of the runs that took suspiciously long or short, from 0.
    /// Source: Iglewicz and Hoaglin 1993, "How to Detect and Handle Outliers": the modified z-score; the threshold is higher
    /// than theirs (3.5), since times have long tails.
    pub fn outliers(&self) -> Vec<usize> {
        let middle = self.median();
        let mut deviations: Vec<f64> = self.0.iter().map(|run| (run - middle).abs()).collect();
        deviations.sort_by(f64::total_cmp);
        // Where most runs agree to the tick of the clock, a part in 10^4 is still no outlier.
        let deviation = (median(&deviations) * DEVIATION_OVER_MAD).max(middle * 1e-5);
        let is_off = |run: &f64| (run - middle).abs() > OUTLIER_DEVIATIONS * deviation;
        (0..self.0.len()).filter(|&at| is_off(&self.0[at])).collect()
    }
}

fn median(sorted: &[f64]) -> f64 {
    match sorted.len() {
        0 => 0.0,
        n if n % 2 == 1 => sorted[n / 2],
        n => (sorted[n / 2 - 1] + sorted[n / 2]) * 0.5,
    }
}

/// What runs make of an amount of work: amount per second at the median, and at the slowest and the fastest run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    pub median: f64,
    pub low: f64,
    pub high: f64,
}

impl Rate {
    pub fn of(amount: f64, runs: &Runs) -> Self {
        // A clock too coarse for the work says "no time".
        let per = |seconds: f64| amount / seconds.max(1e-12);
        let (shortest, longest) = runs.range();
        Self { median: per(runs.median()), low: per(longest), high: per(shortest) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_an_even_number_of_runs_is_the_mean_of_the_middle_two() {
        assert_eq!(Runs(vec![4.0, 1.0, 3.0, 2.0]).median(), 2.5);
        assert_eq!(Runs(vec![9.0, 1.0, 3.0]).median(), 3.0);
        assert_eq!(Runs(vec![]).median(), 0.0);
    }

    #[test]
    fn rates_are_inverse_to_times() {
        let rate = Rate::of(8.0, &Runs(vec![4.0, 2.0, 1.0]));
        assert_eq!(rate, Rate { median: 4.0, low: 2.0, high: 8.0 });
    }

    #[test]
    fn a_run_that_took_twice_as_long_is_an_outlier_and_ordinary_spread_is_not() {
        assert_eq!(Runs(vec![1.0, 1.01, 0.99, 2.0, 1.02]).outliers(), [3]);
        assert_eq!(Runs(vec![1.0, 1.05, 0.97, 1.1, 1.02]).outliers(), [0; 0]);
    }

    #[test]
    fn runs_that_mostly_agree_to_the_tick_have_no_outliers_by_a_tick() {
        assert_eq!(Runs(vec![1.0, 1.0, 1.0, 1.00001, 1.0]).outliers(), [0; 0]);
        assert_eq!(Runs(vec![1.0, 1.0, 1.0, 1.5, 1.0]).outliers(), [3]);
    }
}
