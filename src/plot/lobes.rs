//! How materials reflect over angle: lobes, flat and in perspective, and directional albedo.

use super::curves::direction;
use super::figure::{
    Arrow, Axis, Body, Color, Curve, Facet, Figure, Frame, Mark, PALETTE, STEPS, Side, nice_step, palette,
};
use super::shelf::{Shelf, shelf_of};
use crate::bake::BakeError;
use crate::scene::{Material, Model};
use glam::DVec3;

/// Grazing directions end this far from the horizon, degrees: models are zero at it.
const GRAZING: f64 = 0.1;

/// The value of material `index` for light from `theta` degrees on the left, at `angle` degrees to the right: the BRDF, or
/// the BTDF beyond the horizon, per steradian.
pub fn scattering(shelf: &Shelf, index: usize, theta: f64, angle: f64) -> f64 {
    let wi = direction(-theta);
    shelf.eval(index, direction(angle), wi) / f64::from(wi.z)
}

fn lobe(shelf: &Shelf, place: usize, index: usize, theta: f64, reach: f64) -> Curve {
    let value = |angle: f64| scattering(shelf, index, theta, angle);
    Curve::sampled(shelf.names()[index].clone(), place, [-reach, reach], value)
}

/// Whether light from `theta` comes out on the other side of any of the materials.
fn transmits(shelf: &Shelf, materials: &[usize], theta: f64) -> bool {
    let angles = || (91..270).map(f64::from);
    materials.iter().any(|index| angles().any(|angle| scattering(shelf, *index, theta, angle) > 0.0))
}

/// Lobes of `materials` in a polar picture, for light from `theta` degrees.
pub fn polar_figure(shelf: &Shelf, materials: &[usize], theta: f64) -> Figure {
    let (side, reach) =
        if transmits(shelf, materials, theta) { (Side::Full, 180.0) } else { (Side::Upper, 90.0 - GRAZING) };
    let curves: Vec<Curve> =
        materials.iter().enumerate().map(|(place, index)| lobe(shelf, place, *index, theta, reach)).collect();
    let highest = curves.iter().map(Curve::highest).fold(0.0, f64::max);
    let max = if highest > 0.0 { highest } else { 1.0 };
    let step = nice_step(max / 5.0);
    let arrows = vec![
        Arrow { name: "L".into(), angle: -theta, inward: true },
        Arrow { name: "R".into(), angle: theta, inward: false },
    ];
    let frame = Frame::Polar { side, unit: "ρ [1/sr]".into(), max: (max / step - 1e-9).ceil() * step, arrows };
    Figure { title: "Lobes".into(), note: note(theta), frame, curves }
}

fn note(theta: f64) -> String {
    format!("reflected radiance over irradiance (luminance), in the plane of incidence, light from θ = {theta}°")
}

/// The same against the angle of view.
pub fn cartesian_figure(shelf: &Shelf, materials: &[usize], theta: f64) -> Figure {
    let reach = if transmits(shelf, materials, theta) { 180.0 } else { 90.0 };
    let curves: Vec<Curve> =
        materials.iter().enumerate().map(|(place, index)| lobe(shelf, place, *index, theta, reach - GRAZING)).collect();
    let x = Axis { step: 30.0, ..Axis::degrees("angle of view [°], light from the left", -reach, reach) };
    let mut figure = Figure::cartesian("Lobes", note(theta), x, "ρ [1/sr]", curves);
    if let Frame::Cartesian { marks, .. } = &mut figure.frame {
        marks.push(Mark { name: "R".into(), x: theta });
    }
    figure
}

/// Directional albedo against the angle of view (row 18), with a line at 1, which no material may exceed.
pub fn albedo_figure(shelf: &Shelf, materials: &[usize]) -> Figure {
    /// Angles are 2 degrees apart; each is the mean of as many samples as make the curves smooth.
    const ANGLES: usize = 44;
    const SAMPLES: u32 = 1 << 12;
    let points = |index: usize| {
        let angle = |i: usize| if i == ANGLES { 87.5 } else { 2.0 * i as f64 };
        (0..=ANGLES).map(|i| [angle(i), shelf.albedo(index, direction(angle(i)), SAMPLES)]).collect()
    };
    let curve = |(place, index): (usize, &usize)| Curve {
        name: shelf.names()[*index].clone(),
        color: palette(place),
        dashed: false,
        points: points(*index),
    };
    let mut curves: Vec<Curve> = materials.iter().enumerate().map(curve).collect();
    let highest = curves.iter().map(Curve::highest).fold(1.0, f64::max);
    let limit = vec![[0.0, 1.0], [90.0, 1.0]];
    curves.push(Curve { name: "all of the light".into(), color: [150, 150, 150], dashed: true, points: limit });
    let frame = Frame::Cartesian {
        x: Axis::degrees("angle of view [°]", 0.0, 90.0),
        // A model that gives more than it gets would leave a picture that ends at 1.
        y: Axis::up_to("albedo", highest.min(4.0) * 1.05),
        marks: Vec::new(),
    };
    let note = "the part of light from everywhere that is reflected towards the viewer (luminance)";
    Figure { title: "Directional albedo".into(), note: note.into(), frame, curves }
}

/// Roughness of a material by its model's own name for it, in both directions; None where it has none.
fn roughened(material: &Material, roughness: f32) -> Option<Material> {
    let mut rough = material.clone();
    match &mut rough.model {
        Model::CookTorrance { lobes, .. } => {
            lobes.iter_mut().for_each(|lobe| (lobe.alpha_u, lobe.alpha_v) = (roughness, roughness));
        }
        Model::Ward { alpha_u, alpha_v, .. }
        | Model::RoughConductor { alpha_u, alpha_v, .. }
        | Model::RoughDielectric { alpha_u, alpha_v, .. } => (*alpha_u, *alpha_v) = (roughness, roughness),
        Model::Kelemen { alpha, .. } | Model::RoughPlastic { alpha, .. } => *alpha = roughness,
        // Burley's roughness is the root of alpha.
        Model::Principled(principled) => principled.roughness = libm::sqrtf(roughness),
        _ => return None,
    }
    Some(rough)
}

/// Directional albedo against roughness alpha or m, for views at each of `angles` degrees (row 18); of each material that has a
/// roughness, from .05 to 1.
pub fn albedo_by_roughness_figure(materials: &[Material], angles: &[f64]) -> Result<Figure, BakeError> {
    const STEPS: u16 = 19;
    const SAMPLES: u32 = 1 << 12;
    let roughness = |step: u16| 0.05 + 0.95 * f64::from(step) / f64::from(STEPS);
    let mut curves: Vec<Curve> = Vec::new();
    for material in materials {
        let rough: Option<Vec<Material>> = (0..=STEPS).map(|i| roughened(material, roughness(i) as f32)).collect();
        let Some(rough) = rough else { continue };
        let shelf = shelf_of(rough)?;
        for angle in angles {
            let albedo = |i: u16| [roughness(i), shelf.albedo(usize::from(i), direction(*angle), SAMPLES)];
            let (place, name) = (curves.len(), format!("{}, θ = {angle}°", material.name));
            let points = (0..=STEPS).map(albedo).collect();
            curves.push(Curve { name, color: palette(place), dashed: place >= PALETTE.len(), points });
        }
    }
    let highest = curves.iter().map(Curve::highest).fold(1.0, f64::max);
    let limit = vec![[0.0, 1.0], [1.0, 1.0]];
    curves.push(Curve { name: "all of the light".into(), color: [150, 150, 150], dashed: true, points: limit });
    let frame = Frame::Cartesian {
        x: Axis { label: "roughness α".into(), low: 0.0, high: 1.0, step: 0.2 },
        y: Axis::up_to("albedo", highest.min(4.0) * 1.05),
        marks: Vec::new(),
    };
    let note = "the part of light from everywhere that is reflected towards a viewer at θ (luminance)";
    Ok(Figure { title: "Directional albedo".into(), note: note.into(), frame, curves })
}

/// Rows and columns of a body's grid.
const ROWS: usize = 45;
const COLUMNS: usize = 120;

/// Lobes in perspective, side by side, each scaled to its own largest value: light comes from `theta` degrees on the left.
pub fn bodies_figure(shelf: &Shelf, materials: &[usize], theta: f64) -> Figure {
    let body = |(place, index): (usize, &usize)| {
        let (facets, largest) = solid(shelf, *index, theta, palette(place));
        let name = format!("{} (to {} /sr)", shelf.names()[*index], super::figure::number(largest));
        Body { name, facets }
    };
    let frame = Frame::Bodies(materials.iter().enumerate().map(body).collect());
    let note = format!("ρ over all directions of view (luminance), light from θ = {theta}° on the left");
    Figure { title: "Lobes".into(), note, frame, curves: Vec::new() }
}

/// Seen from 25 degrees above, slightly from the right of the plane of incidence: right, up and towards the viewer.
fn project(p: DVec3) -> [f64; 3] {
    let (turn, tilt) = (-35f64.to_radians(), 25f64.to_radians());
    let (x, y) = (p.x * libm::cos(turn) - p.y * libm::sin(turn), p.x * libm::sin(turn) + p.y * libm::cos(turn));
    // y leads away from the viewer.
    let (up, near) = (p.z * libm::cos(tilt) + y * libm::sin(tilt), p.z * libm::sin(tilt) - y * libm::cos(tilt));
    [0.5 + 0.46 * x, 0.4 + 0.46 * up, near]
}

/// The facets of one body, farthest first, and its largest value. What is transmitted hangs below the surface, pale as if
/// seen through it.
fn solid(shelf: &Shelf, index: usize, theta: f64, color: Color) -> (Vec<Facet>, f64) {
    let wi = direction(-theta);
    let value = |w: DVec3| shelf.eval(index, w.as_vec3(), wi) / f64::from(wi.z);
    let [above, below] = [1.0, -1.0].map(|side| shell(side, &value));
    let largest = above.iter().chain(&below).flatten().map(|p| p.length()).fold(0.0, f64::max);
    // Within the disc, so that the light is seen to come in.
    let scale = if largest > 0.0 { 0.8 / largest } else { 0.0 };
    let mut facets = vec![disc()];
    if below.iter().flatten().any(|p| *p != DVec3::ZERO) {
        facets.extend(farthest_first(shaded(&below, scale, color.map(|c| c / 2 + 118))));
    }
    let mut upper = shaded(&above, scale, color);
    upper.extend(arrow(theta));
    facets.extend(farthest_first(upper));
    (facets, largest)
}

/// Directions of the upper (`side` 1) or lower (-1) hemisphere, each as long as its value.
fn shell(side: f64, value: &dyn Fn(DVec3) -> f64) -> Vec<Vec<DVec3>> {
    let way = |row: usize, column: usize| {
        let (a, b) =
            (row as f64 / ROWS as f64 * 89.9f64.to_radians(), column as f64 / COLUMNS as f64 * std::f64::consts::TAU);
        DVec3::new(libm::sin(a) * libm::cos(b), libm::sin(a) * libm::sin(b), side * libm::cos(a))
    };
    (0..=ROWS).map(|row| (0..=COLUMNS).map(|column| way(row, column)).map(|w| w * value(w)).collect()).collect()
}

/// The facets between a grid's points, with their depths.
fn shaded(grid: &[Vec<DVec3>], scale: f64, color: Color) -> Vec<(f64, Facet)> {
    let mut facets = Vec::new();
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let corners = [[row, column], [row + 1, column], [row + 1, column + 1], [row, column + 1]]
                .map(|[i, j]| grid[i][j] * scale);
            let normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalize_or_zero();
            // Lit from the viewer's upper left.
            let outward = if normal.dot(corners[2] + corners[0]) < 0.0 { -normal } else { normal };
            let light = 0.68 + 0.32 * outward.dot(DVec3::new(-0.5, -0.6, 0.62));
            let places = corners.map(project);
            let depth = places.iter().map(|p| p[2]).sum::<f64>();
            let facet = Facet {
                corners: places.map(|[x, y, _]| [x, y]).to_vec(),
                color: color.map(|c| (f64::from(c) * light + 255.0 * 0.12 * light).min(255.0) as u8),
            };
            facets.push((depth, facet));
        }
    }
    facets
}

fn farthest_first(mut facets: Vec<(f64, Facet)>) -> impl Iterator<Item = Facet> {
    facets.sort_by(|a, b| a.0.total_cmp(&b.0));
    facets.into_iter().map(|(_, facet)| facet)
}

/// The surface.
fn disc() -> Facet {
    let rim = (0..STEPS).map(|i| i as f64 / STEPS as f64 * std::f64::consts::TAU);
    let corners = rim.map(|a| project(DVec3::new(libm::cos(a), libm::sin(a), 0.0))).map(|[x, y, _]| [x, y]).collect();
    Facet { corners, color: [236, 236, 236] }
}

/// The light's ray, from the left to the middle, in short pieces that hide and are hidden.
fn arrow(theta: f64) -> Vec<(f64, Facet)> {
    const PIECES: usize = 40;
    let way = direction(-theta).as_dvec3();
    let wide = DVec3::new(way.z, 0.0, -way.x) * 0.008;
    let piece = |i: usize| {
        let [near, far] = [i, i + 1].map(|i| 0.12 + 1.13 * i as f64 / PIECES as f64);
        // A head at its end.
        let half = |t: f64| if t < 0.2 { wide * (0.5 + 4.0 * (t - 0.12) / 0.08) } else { wide };
        let corners = [way * near + half(near), way * far + half(far), way * far - half(far), way * near - half(near)];
        let places = corners.map(project);
        let depth = places.iter().map(|p| p[2]).sum::<f64>();
        (depth, Facet { corners: places.map(|[x, y, _]| [x, y]).to_vec(), color: [40, 40, 40] })
    };
    (0..PIECES).map(piece).collect()
}

/// Where the lobe of light from `theta` is brightest: degrees from the normal, to the right.
pub fn peak(shelf: &Shelf, index: usize, theta: f64) -> f64 {
    let best = |best: (f64, f64), angle: f64| {
        let value = scattering(shelf, index, theta, angle);
        if value > best.1 { (angle, value) } else { best }
    };
    (0..8990).map(|i| f64::from(i) / 100.0).fold((0.0, 0.0), best).0
}
