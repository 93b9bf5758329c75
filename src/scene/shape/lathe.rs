//! Surfaces of revolution around the y axis.

use super::grid::{Builder, Vertex, angle_of_turn, circle};
use crate::scene::Mesh;
use glam::{DVec2, DVec3};

/// How a profile's points are joined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProfileKind {
    /// A centripetal Catmull-Rom curve through the points; `steps` rows between two of them (1 to 64).
    #[default]
    Smooth,
    /// Straight pieces. Where two meet at more than `crease` the corner is sharp, elsewhere normals are interpolated.
    Polyline,
}

/// What turns around the axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// (radius >= 0, height), up along the outer wall: the outside lies to the right of the way. To close a vessel, go on
    /// over the rim and down the inner wall.
    pub points: Vec<[f64; 2]>,
    pub kind: ProfileKind,
    /// `Smooth`: rows between two points, 1 to 64.
    pub steps: u32,
    /// `Polyline`: the turn above which a corner is sharp, radians.
    pub crease: f64,
}

/// One ring: where it lies and which way its surface faces in the plane (radius, height).
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub at: DVec2,
    pub normal: DVec2,
    /// Texture coordinate.
    pub v: f64,
}

/// Most points a profile may have.
pub const PROFILE_POINTS_MAX: usize = 4096;

/// A surface of revolution: `profile` around the y axis in `segments` steps (`SEGMENTS_MIN` to `SEGMENTS_MAX`).
/// u runs around the axis, to the right seen from outside, from +x; v runs along the profile by its length.
/// The error says what is wrong with the profile.
pub fn lathe(profile: &Profile, segments: u32) -> Result<Mesh, String> {
    check(profile)?;
    let points: Vec<DVec2> = profile.points.iter().map(|p| DVec2::from_array(*p)).collect();
    let rows = match profile.kind {
        ProfileKind::Smooth => smooth_rows(&points, profile.steps),
        ProfileKind::Polyline => polyline_rows(&points, profile.crease),
    };
    if (rows.len() as u64) * u64::from(segments + 1) > u64::from(u32::MAX) / 8 {
        return Err(format!("{} rows of {segments} segments are too many", rows.len()));
    }
    Ok(revolve("lathe", &rows, segments))
}

fn check(profile: &Profile) -> Result<(), String> {
    let points = &profile.points;
    if points.len() < 2 || points.len() > PROFILE_POINTS_MAX {
        return Err(format!("a profile of {} points; allowed are 2 to {PROFILE_POINTS_MAX}", points.len()));
    }
    if let Some(i) = points.iter().position(|p| !(p[0] >= 0.0 && p[0] <= 1e30 && p[1].abs() <= 1e30)) {
        let [r, y] = points[i];
        return Err(format!("profile point {i} is ({r}, {y}); radii are 0 or more and both numbers are finite"));
    }
    if let Some(i) = points.windows(2).position(|p| p[0] == p[1]) {
        return Err(format!("profile points {i} and {} are the same", i + 1));
    }
    if points.iter().all(|p| p[0] == 0.0) {
        return Err("all radii of the profile are 0".to_owned());
    }
    if profile.kind == ProfileKind::Smooth && !(1..=64).contains(&profile.steps) {
        return Err(format!("{} steps between profile points; allowed are 1 to 64", profile.steps));
    }
    Ok(())
}

/// The right-hand side of a way in the (radius, height) plane.
fn right_of(tangent: DVec2) -> DVec2 {
    let length = libm::hypot(tangent.x, tangent.y);
    DVec2::new(tangent.y, -tangent.x) / length
}

/// Straight pieces; every crease is two rows at one place.
pub(super) fn polyline_rows(points: &[DVec2], crease: f64) -> Vec<Row> {
    let faces: Vec<DVec2> = points.windows(2).map(|p| right_of(p[1] - p[0])).collect();
    let lengths = running_length(points);
    let total = lengths[lengths.len() - 1];
    let cos_crease = libm::cos(crease.clamp(0.0, std::f64::consts::PI));
    let mut rows = Vec::new();
    for (i, &at) in points.iter().enumerate() {
        let before = faces[i.max(1) - 1];
        let after = faces[i.min(faces.len() - 1)];
        let v = lengths[i] / total;
        let sum = before + after;
        if before.dot(after) >= cos_crease && sum.length() > 1e-6 {
            rows.push(Row { at, normal: sum / sum.length(), v });
        } else {
            rows.push(Row { at, normal: before, v });
            rows.push(Row { at, normal: after, v });
        }
    }
    rows
}

fn running_length(points: &[DVec2]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut lengths = vec![0.0];
    for p in points.windows(2) {
        sum += libm::hypot(p[1].x - p[0].x, p[1].y - p[0].y);
        lengths.push(sum);
    }
    lengths
}

/// A centripetal Catmull-Rom curve (Catmull and Rom 1974; Yuksel, Schaefer and Keyser 2011: no cusps within a piece), as
/// cubic Hermite pieces. A profile whose ends meet is closed.
fn smooth_rows(points: &[DVec2], steps: u32) -> Vec<Row> {
    let tangents = catmull_rom_tangents(points);
    let mut curve = Vec::new();
    for (i, p) in points.windows(2).enumerate() {
        let chord = knot(p[1] - p[0]);
        let first = u32::from(i > 0);
        for step in first..=steps {
            let t = f64::from(step) / f64::from(steps);
            let (at, mut tangent) = hermite(p[0], tangents[i] * chord, p[1], tangents[i + 1] * chord, t);
            // Overshoot past the axis would turn the surface inside out.
            let at = DVec2::new(at.x.max(0.0), at.y);
            if libm::hypot(tangent.x, tangent.y) < 1e-12 * chord * chord {
                tangent = p[1] - p[0];
            }
            curve.push((at, right_of(tangent)));
        }
    }
    let at: Vec<DVec2> = curve.iter().map(|c| c.0).collect();
    let lengths = running_length(&at);
    let total = lengths[lengths.len() - 1];
    curve.iter().zip(&lengths).map(|(&(at, normal), length)| Row { at, normal, v: length / total }).collect()
}

/// The centripetal knot step, the square root of the chord.
fn knot(chord: DVec2) -> f64 {
    libm::sqrt(libm::hypot(chord.x, chord.y))
}

/// Derivatives with respect to the knot parameter.
fn catmull_rom_tangents(points: &[DVec2]) -> Vec<DVec2> {
    let last = points.len() - 1;
    let closed = last > 2 && points[0] == points[last];
    let slope = |a: usize, b: usize| (points[b] - points[a]) / knot(points[b] - points[a]);
    (0..=last)
        .map(|i| {
            let (before, after) = match i {
                _ if closed && (i == 0 || i == last) => ((last - 1, last), (0, 1)),
                0 => return end_tangent(points, slope(0, 1), 0),
                _ if i == last => return end_tangent(points, slope(last - 1, last), last),
                _ => ((i - 1, i), (i, i + 1)),
            };
            let (h0, h1) = (knot(points[before.1] - points[before.0]), knot(points[after.1] - points[after.0]));
            // The parabola through three points: the neighbours' slopes, each weighted by the other's step.
            (slope(before.0, before.1) * h1 + slope(after.0, after.1) * h0) / (h0 + h1)
        })
        .collect()
}

/// An end on the axis is smooth across it (a pole); any other end keeps the direction of its piece.
fn end_tangent(points: &[DVec2], slope: DVec2, i: usize) -> DVec2 {
    if points[i].x > 0.0 || slope.x == 0.0 {
        return slope;
    }
    DVec2::new(libm::copysign(libm::hypot(slope.x, slope.y), slope.x), 0.0)
}

/// Point and derivative of a cubic Hermite piece.
fn hermite(p0: DVec2, m0: DVec2, p1: DVec2, m1: DVec2, t: f64) -> (DVec2, DVec2) {
    let (t2, s) = (t * t, 1.0 - t);
    // At t = 0 and t = 1 exactly the end points, so that neighbouring pieces meet.
    let at = p0 * ((1.0 + 2.0 * t) * s * s) + m0 * (t * s * s) + p1 * (t2 * (3.0 - 2.0 * t)) - m1 * (t2 * s);
    let d = (p1 - p0) * (6.0 * t * s) + m0 * (s * (1.0 - 3.0 * t)) + m1 * (t * (3.0 * t - 2.0));
    (at, d)
}

/// Turns `rows` around the y axis. Where a row is a point on the axis each segment gets a normal of its own, so that a
/// cone's tip is shaded like its side.
pub(super) fn revolve(name: &str, rows: &[Row], segments: u32) -> Mesh {
    debug_assert!((super::SEGMENTS_MIN..=super::SEGMENTS_MAX).contains(&segments), "segments = {segments}");
    let mut builder = Builder::new(name);
    add_revolved(&mut builder, rows, segments);
    builder.finish()
}

pub(super) fn add_revolved(builder: &mut Builder, rows: &[Row], segments: u32) {
    let circle = circle(segments);
    let n = f64::from(segments);
    builder.add_grid(segments, rows.len() as u32 - 1, |i, j| {
        let row = rows[j as usize];
        let (mut turn, mut direction) = (f64::from(i) / n, circle[i as usize]);
        if row.at.x == 0.0 {
            // The fan's triangles use vertex i + 1 of a row above them and vertex i of a row below (`Builder::add_grid`).
            let above = j > 0 && rows[j as usize - 1].at.x > 0.0;
            turn = (f64::from(i) + if above { -0.5 } else { 0.5 }) / n;
            direction = angle_of_turn(turn);
        }
        // +x to -z: counter-clockwise seen from above.
        let around = |r: f64, y: f64| DVec3::new(r * direction.x, y, -r * direction.y);
        Vertex {
            position: around(row.at.x, row.at.y),
            normal: around(row.normal.x, row.normal.y),
            uv: DVec2::new(turn, row.v),
        }
    });
}
