//! Whole samples: everything from the camera ray to the film.

use super::report::{ImageReport, RunsOn};
use super::run::{Plan, take_turns};
use super::stats::Runs;
use super::tracer::Timing;
use crate::film::{Film, Rect};
use crate::render::session::Session;
use crate::render::{Counters, RenderError};
use crate::watch::Watch;
use std::sync::Arc;
use std::time::Instant;

/// Measures one sample a pixel of `film`'s frame in all sessions and compares the films with the first one's.
/// `integrator`: which one the scene was baked for.
pub fn measure(
    integrator: &str,
    film: &Film,
    sessions: &[(String, Session)],
    plan: Plan,
) -> Result<ImageReport, RenderError> {
    let mut shares = vec![Vec::new(); sessions.len()];
    let times = take_turns(plan, sessions.len(), |at| {
        let session = &sessions[at].1;
        session.restart(film.clone());
        let (timing, kernels) = render(session)?;
        shares[at].extend(timing.device.map(|_| kernels / timing.wall));
        Ok(timing)
    })?;
    let films: Vec<Arc<Film>> = sessions.iter().map(|(_, session)| session.snapshot()).collect();
    let mut results = Vec::new();
    for ((((on, _), (wall_s, device_s)), other), share) in sessions.iter().zip(times).zip(&films).zip(shares) {
        let differs = |(a, b): (&[i64; 4], &[i64; 4])| a != b;
        let differ = films[0].sums().iter().zip(other.sums()).filter(|&pair| differs(pair)).count() as u64;
        let first = films[0].sums().iter().zip(other.sums()).position(differs);
        let width = film.crop().width as usize;
        let first = first.map(|at| format!("pixel {},{}", at % width, at / width));
        let kernel_share = (!share.is_empty()).then(|| Runs(share.into_iter().skip(plan.warmup).collect()));
        results.push(RunsOn { on: on.clone(), wall_s, device_s, differ, first, dispatch: None, kernel_share });
    }
    let film_hash = films.first().map_or_else(String::new, |film| film.hash().to_string());
    Ok(ImageReport { integrator: integrator.to_owned(), samples: film.crop().area() as u64, film_hash, results })
}

/// The time, and how many seconds of it were in kernels that trace or shade.
fn render(session: &Session) -> Result<(Timing, f64), RenderError> {
    let start = Instant::now();
    let shares = session.render(0..1, &Watch::default())?;
    let mut counters = Counters::default();
    shares.iter().for_each(|share| counters += share.counters);
    let Counters { extend_s, shade_s, shadow_s, other_s, .. } = counters;
    let kernels = extend_s + shade_s + shadow_s;
    let device = kernels + other_s;
    Ok((Timing { wall: start.elapsed().as_secs_f64(), device: (device > 0.0).then_some(device) }, kernels))
}

/// The frame nearest to `width` x `height` in shape that has about `rays` pixels.
pub fn frame_of(width: u32, height: u32, rays: u32) -> Rect {
    let aspect = f64::from(width) / f64::from(height);
    let side = |length: f64| (length.round() as u32).clamp(1, 65_535);
    let columns = side(libm::sqrt(f64::from(rays) * aspect));
    Rect::whole(columns, side(f64::from(rays) / f64::from(columns)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frame_has_the_scene_s_shape_and_about_as_many_pixels_as_rays() {
        assert_eq!(frame_of(640, 640, 1 << 20), Rect::whole(1024, 1024));
        let frame = frame_of(1280, 720, 1_000_000);
        assert_eq!((frame.width, frame.height), (1333, 750));
        assert_eq!(frame_of(65_535, 1, 4), Rect::whole(512, 1));
    }
}
