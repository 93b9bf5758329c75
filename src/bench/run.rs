//! Warm-up and timed runs, backends taking turns.

use super::rays::{RayKind, RaySet};
use super::report::{RayReport, RunsOn};
use super::stats::Runs;
use super::tracer::{Timing, Tracer};
use crate::layout::Hit;
use crate::render::RenderError;

/// How often everything is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    pub runs: usize,
    /// Before those, not counted.
    pub warmup: usize,
}

/// Runs `count` contenders in turns, so that a machine that grows slower is unfair to none. `run(k)` runs number k once.
pub fn take_turns(
    plan: Plan,
    count: usize,
    mut run: impl FnMut(usize) -> Result<Timing, RenderError>,
) -> Result<Vec<(Runs, Option<Runs>)>, RenderError> {
    let mut results: Vec<_> = (0..count).map(|_| (Runs::default(), Some(Runs::default()))).collect();
    for turn in 0..plan.warmup + plan.runs {
        for (at, (wall, device)) in results.iter_mut().enumerate() {
            let timing = run(at)?;
            if turn < plan.warmup {
                continue;
            }
            wall.0.push(timing.wall);
            match (timing.device, device.as_mut()) {
                (Some(seconds), Some(runs)) => runs.0.push(seconds),
                _ => *device = None,
            }
        }
    }
    Ok(results)
}

/// Measures one set of rays on all backends and compares what they found with `set.hits`.
pub fn measure(set: &RaySet, tracers: &mut [(String, Tracer)], plan: Plan) -> Result<RayReport, RenderError> {
    for (_, tracer) in tracers.iter_mut() {
        tracer.load(set)?;
    }
    let times = take_turns(plan, tracers.len(), |at| tracers[at].1.run(set))?;
    let mut results = Vec::new();
    for ((on, tracer), (wall_s, device_s)) in tracers.iter_mut().zip(times) {
        let (differ, first) = compare(set, &tracer.hits()?);
        let dispatch = tracer.dispatch_rays();
        results.push(RunsOn { on: on.clone(), wall_s, device_s, differ, first, dispatch, kernel_share: None });
    }
    Ok(RayReport { kind: set.kind, rays: set.rays.len() as u64, hits: set.hit_count() as u64, results })
}

/// How many hits differ in any bit, and the first in words.
fn compare(set: &RaySet, found: &[Hit]) -> (u64, Option<String>) {
    debug_assert_eq!(set.hits.len(), found.len());
    let differs = |(a, b): (&Hit, &Hit)| bytemuck::bytes_of(a) != bytemuck::bytes_of(b);
    let count = set.hits.iter().zip(found).filter(|&pair| differs(pair)).count() as u64;
    let first = set.hits.iter().zip(found).position(differs);
    (
        count,
        first.map(|at| {
            format!("ray {at} {:?}: {} and {}", set.rays[at], told(set.kind, &set.hits[at]), told(set.kind, &found[at]))
        }),
    )
}

fn told(kind: RayKind, hit: &Hit) -> String {
    match (hit.instance == crate::layout::INVALID, kind.is_any()) {
        (true, _) => "a miss".to_owned(),
        (false, true) => "a hit".to_owned(),
        (false, false) => format!("{hit:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::{INVALID, Ray};

    #[test]
    fn contenders_take_turns_and_warm_up_is_not_counted() {
        let mut order = Vec::new();
        let results = take_turns(Plan { runs: 2, warmup: 1 }, 2, |at| {
            order.push(at);
            Ok(Timing { wall: order.len() as f64, device: (at == 1).then_some(0.5) })
        });
        let results = results.expect("no errors");
        assert_eq!(order, [0, 1, 0, 1, 0, 1]);
        assert_eq!(results[0], (Runs(vec![3.0, 5.0]), None));
        assert_eq!(results[1], (Runs(vec![4.0, 6.0]), Some(Runs(vec![0.5, 0.5]))));
    }

    #[test]
    fn a_hit_that_differs_in_one_bit_is_told() {
        let hit = Hit { t: 1.0, instance: 3, ..Hit::default() };
        let set = RaySet { kind: RayKind::Primary, rays: vec![Ray::default(); 3], hits: vec![hit; 3] };
        assert_eq!(compare(&set, &[hit; 3]), (0, None));
        let off = Hit { t: 1.0f32.next_up(), ..hit };
        let miss = Hit { instance: INVALID, ..hit };
        let (count, first) = compare(&set, &[hit, off, miss]);
        assert_eq!(count, 2);
        assert!(first.expect("a difference").starts_with("ray 1 "));
    }
}
