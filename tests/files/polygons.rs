//! Polygons of any size and shape. The right value is the shoelace formula's: triangles that are none of them turned over
//! and that have the polygon's area cover it once.

use super::support::{corners, load_one};
use glam::{Vec2, Vec3};
use std::time::Instant;

fn shoelace(points: &[[f64; 2]]) -> f64 {
    let next = |i: usize| points[(i + 1) % points.len()];
    points.iter().enumerate().map(|(i, a)| (a[0] * next(i)[1] - a[1] * next(i)[0]) * 0.5).sum()
}

fn obj(points: &[[f64; 2]]) -> String {
    let vertices: String = points.iter().map(|[x, y]| format!("v {x:?} {y:?} 0\n")).collect();
    format!("{vertices}f {}\n", (1..=points.len()).map(|i| format!("{i} ")).collect::<String>())
}

/// Checks that the triangles of a polygon cover it; gives the seconds it took to load.
#[track_caller]
fn covers(points: &[[f64; 2]], bridged: usize) -> f64 {
    let text = obj(points);
    let start = Instant::now();
    let scene = load_one("a.obj", &text);
    let seconds = start.elapsed().as_secs_f64();
    let mesh = &scene.meshes[0];
    let places = corners(mesh);
    let areas: Vec<f64> = places
        .chunks(3)
        .map(|c| {
            let [a, b, c] = [c[0], c[1], c[2]].map(Vec3::as_dvec3);
            (b - a).cross(c - a).z * 0.5
        })
        .collect();
    let largest = areas.iter().fold(0.0f64, |m, a| m.max(*a));
    assert!(areas.iter().all(|area| *area > -1e-6 * largest), "none is turned over");
    let (found, expected) = (areas.iter().sum::<f64>(), shoelace(points));
    assert!((found - expected).abs() < 1e-5 * expected, "{found}, expected {expected}");
    assert!(areas.len() <= points.len() - 2, "{} triangles of {} corners", areas.len(), points.len());
    assert!(areas.len() + bridged >= points.len() - 2, "every corner is one of a triangle: {}", areas.len());
    seconds
}

/// A battlement of `teeth` teeth.
fn comb(teeth: usize) -> Vec<[f64; 2]> {
    let width = 1.6 / (2.0 * teeth as f64 - 1.0);
    let mut points = vec![[-0.8, -0.6], [0.8, -0.6]];
    for i in 0..teeth {
        let x = 0.8 - 2.0 * width * i as f64;
        points.extend([[x, 0.6], [x - width, 0.6]]);
        if i + 1 < teeth {
            points.extend([[x - width, -0.4], [x - 2.0 * width, -0.4]]);
        }
    }
    points
}

fn round(count: usize, radius: impl Fn(usize) -> f64) -> Vec<[f64; 2]> {
    let at = |i: usize| (std::f64::consts::TAU * i as f64 / count as f64).sin_cos();
    (0..count).map(|i| [radius(i) * at(i).1, radius(i) * at(i).0]).collect()
}

#[test]
fn combs_stars_and_disks_of_any_number_of_corners_are_covered() {
    for teeth in [2, 15, 20, 40, 500] {
        covers(&comb(teeth), 0);
    }
    for count in [5, 64, 65, 1000] {
        covers(&round(count, |_| 1.0), 0);
        covers(&round(2 * count, |i| if i % 2 == 0 { 1.0 } else { 0.3 }), 0);
    }
}

#[test]
fn polygons_of_a_hundred_thousand_corners_take_no_minute() {
    let disk = covers(&round(100_000, |_| 1.0), 0);
    let star = covers(&round(100_000, |i| if i % 2 == 0 { 1.0 } else { 0.9 }), 0);
    println!("disk {disk} s, star {star} s");
    assert!(disk + star < 60.0, "{disk} s, {star} s");
}

#[test]
fn holes_joined_to_the_outline_stay_open() {
    // A square with a square hole; the bridge is walked there and back, over the same vertices and over equal ones.
    let points = [[0., 0.], [4., 0.], [4., 4.], [0., 4.], [0., 0.], [1., 1.], [1., 3.], [3., 3.], [3., 1.], [1., 1.]];
    covers(&points, 0);
    let shared = load_one(
        "a.obj",
        "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\nf 1 2 3 4 1 5 6 7 8 5\n",
    );
    let mesh = &shared.meshes[0];
    let places = corners(mesh);
    let middle = |c: &[Vec3]| ((c[0] + c[1] + c[2]) / 3.0).truncate();
    assert!(places.chunks(3).all(|c| (middle(c) - Vec2::splat(2.0)).abs().max_element() > 1.0), "{places:?}");
    let area: f32 = places.chunks(3).map(|c| (c[1] - c[0]).cross(c[2] - c[0]).z * 0.5).sum();
    assert_eq!((mesh.triangles.len(), area), (8, 12.0));
    // Two holes, one behind the other.
    let two = [
        [0., 0.],
        [9., 0.],
        [9., 4.],
        [0., 4.],
        [0., 0.],
        [1., 1.],
        [1., 3.],
        [3., 3.],
        [3., 1.],
        [5., 1.],
        [5., 3.],
        [7., 3.],
        [7., 1.],
        [5., 1.],
        [3., 1.],
        [1., 1.],
    ];
    covers(&two, 0);
}

#[test]
fn corners_on_a_straight_line_are_kept() {
    // The middles of three sides of a square with a notch: neighbours have those vertices, too.
    let points = [[0., 0.], [1., 0.], [2., 0.], [4., 0.], [4., 2.], [4., 4.], [2., 3.], [0., 4.], [0., 3.], [0., 1.5]];
    covers(&points, 0);
    let scene = load_one("a.obj", obj(&points));
    let used: std::collections::BTreeSet<u32> = scene.meshes[0].triangles.iter().flatten().copied().collect();
    assert_eq!(used.len(), points.len());
    // Nothing but a straight line has no area, but stays triangles.
    assert_eq!(load_one("a.obj", obj(&[[0., 0.], [1., 0.], [2., 0.], [3., 0.]])).meshes[0].triangles.len(), 2);
}

#[test]
fn polygons_that_stand_in_space_any_way_are_cut_in_their_own_plane() {
    let points = comb(6);
    let expected = shoelace(&points);
    for [x, y] in [[Vec3::X, Vec3::Y], [Vec3::Y, Vec3::X], [Vec3::Z, Vec3::Y], [Vec3::new(0.6, 0.0, 0.8), Vec3::NEG_Y]]
    {
        let place = |p: &[f64; 2]| x * p[0] as f32 + y * p[1] as f32 + Vec3::splat(5.0);
        let vertices: String = points.iter().map(place).map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)).collect();
        let face: String = (1..=points.len()).map(|i| format!("{i} ")).collect();
        let places = corners(&load_one("a.obj", format!("{vertices}f {face}\n")).meshes[0]);
        let normal = x.cross(y);
        let area = |c: &[Vec3]| f64::from((c[1] - c[0]).cross(c[2] - c[0]).dot(normal) * 0.5);
        assert!(places.chunks(3).all(|c| area(c) > 0.0));
        assert!((places.chunks(3).map(area).sum::<f64>() - expected).abs() < 1e-5);
    }
}

#[test]
fn a_face_that_crosses_itself_is_no_error() {
    assert_eq!(load_one("a.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n").meshes[0].triangles.len(), 2);
    let star = round(5, |_| 1.0);
    let crossed: Vec<[f64; 2]> = [0, 2, 4, 1, 3].map(|i| star[i]).to_vec();
    assert!(!load_one("a.obj", obj(&crossed)).meshes[0].triangles.is_empty());
}
