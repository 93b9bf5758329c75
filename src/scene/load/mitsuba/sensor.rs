//! `<sensor>` with its `<film>`, `<rfilter>` and `<sampler>`, and `<integrator>`.

use super::document::{Document, Node, Result};
use super::object::Object;
use crate::scene::{Camera, Film, Filter, Lens, Projection, RenderSettings, Sampler, Scene, Window};
use glam::{DVec3, Vec2};

/// Scale factors this close to 1 are rounding.
const SCALE_TOLERANCE: f64 = 1e-3;

/// Reads the camera and what belongs to it.
pub fn read_sensor(document: &Document, node: Node, scene: &mut Scene) -> Result<()> {
    let object = Object::open(document, node)?;
    if let Some(child) = object.only("film")? {
        read_film(&Object::open(document, child.node)?, &mut scene.film)?;
    } else {
        (scene.film.width, scene.film.height) = (768, 576);
        scene.film.filter = gaussian(0.5);
    }
    if let Some(child) = object.only("sampler")? {
        read_sampler(&Object::open(document, child.node)?, &mut scene.settings)?;
    }
    scene.camera = read_camera(&object, &scene.film)?;
    scene.has_camera = true;
    Ok(())
}

/// Camera space is x to the left, y up, z forward.
fn read_camera(object: &Object, film: &Film) -> Result<Camera> {
    let place = object.transform("to_world")?.0;
    let [left, up, forward] = [place.matrix3.x_axis, place.matrix3.y_axis, place.matrix3.z_axis];
    let length = |v: DVec3| libm::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    let right_angled = |a: DVec3, b: DVec3| a.dot(b).abs() <= SCALE_TOLERANCE * length(a) * length(b);
    if !(right_angled(left, up) && right_angled(up, forward) && right_angled(forward, left)) {
        return Err(object.bad("to_world", "a camera whose axes are not at right angles is not supported"));
    }
    let unscaled = |v: DVec3| (length(v) - 1.0).abs() <= SCALE_TOLERANCE;
    let projection = if object.plugin.name == "orthographic" {
        if (length(left) - length(up)).abs() > SCALE_TOLERANCE * length(left) {
            return Err(object.bad("to_world", "an orthographic camera scales x and y by the same factor here"));
        }
        // The picture is 2 wide in camera space.
        let width = 2.0 * length(left);
        Projection::Orthographic { height: (width * f64::from(film.height) / f64::from(film.width)) as f32 }
    } else {
        if !(unscaled(left) && unscaled(up) && unscaled(forward)) {
            return Err(object.bad("to_world", "a perspective camera has no scale factors"));
        }
        Projection::Perspective { fov_y: read_fov(object, f64::from(film.width) / f64::from(film.height))? as f32 }
    };
    let offset = |name: &str| match object.plugin.name {
        "perspective" => Ok(object.float_in(name, -100.0, 100.0)?.unwrap_or(0.0) as f32),
        _ => Ok(0.0),
    };
    // Mitsuba counts from the upper left corner of the film.
    let shift = Vec2::new(offset("principal_point_offset_x")?, -offset("principal_point_offset_y")?);
    let eye = place.translation;
    Ok(Camera {
        eye: eye.as_vec3(),
        target: (eye + forward / length(forward)).as_vec3(),
        up: (up / length(up)).as_vec3(),
        projection,
        lens: read_lens(object)?,
        shift,
        mirrored: place.matrix3.determinant() < 0.0,
    })
}

/// The lens of a `thinlens`. Without a distance it is focused on the far clipping plane, as Mitsuba's is.
fn read_lens(object: &Object) -> Result<Option<Lens>> {
    if object.plugin.name != "thinlens" {
        return Ok(None);
    }
    let radius = object.required("aperture_radius", object.float_in("aperture_radius", 0.0, 1e12)?)? as f32;
    let far = object.float_in("far_clip", 1e-12, 1e12)?.unwrap_or(1e4);
    let focus_distance = object.float_in("focus_distance", 1e-12, 1e12)?.unwrap_or(far) as f32;
    Ok((radius > 0.0).then_some(Lens { radius, focus_distance }))
}

/// The vertical field of view in radians. `aspect`: width over height of the picture.
pub fn read_fov(object: &Object, aspect: f64) -> Result<f64> {
    object.exclusive("fov", "focal_length")?;
    let axes = [("x", "x"), ("y", "y"), ("diagonal", "diagonal"), ("smaller", "smaller"), ("larger", "larger")];
    let axis = object.choice("fov_axis", &axes)?.unwrap_or("x");
    let (tangent, axis) = match object.float_in("fov", 1e-3, 179.999)? {
        Some(degrees) => (libm::tan(degrees.to_radians() / 2.0), axis),
        None => {
            let text = object.text("focal_length")?.unwrap_or("50mm");
            let number = text.trim().strip_suffix("mm").unwrap_or(text).trim().parse::<f64>().ok();
            let Some(millimetres) = number.filter(|v| (1e-3..=1e6).contains(v)) else {
                return Err(
                    object.bad("focal_length", format!("expected millimetres such as \"50mm\", found {text:?}"))
                );
            };
            // Of a 36 x 24 mm picture, across its diagonal.
            (libm::hypot(36.0, 24.0) / (2.0 * millimetres), "diagonal")
        }
    };
    let wide = aspect > 1.0;
    let tangent_y = match axis {
        "y" => tangent,
        "diagonal" => tangent / libm::hypot(1.0, aspect),
        "smaller" if wide => tangent,
        "larger" if !wide => tangent,
        _ => tangent / aspect,
    };
    Ok(2.0 * libm::atan(tangent_y))
}

fn gaussian(sigma: f64) -> Filter {
    Filter::Gaussian { radius: 4.0 * sigma as f32, sigma: sigma as f32 }
}

fn read_film(object: &Object, film: &mut Film) -> Result<()> {
    film.width = object.integer("width", 1, 65_535)?.unwrap_or(768) as u32;
    film.height = object.integer("height", 1, 65_535)?.unwrap_or(576) as u32;
    film.filter = match object.only("rfilter")? {
        Some(child) => read_filter(&Object::open(object.document, child.node)?)?,
        None => gaussian(0.5),
    };
    film.crop = read_crop(object, film)?;
    Ok(())
}

/// The part of the film that is rendered, if it says one. As in Mitsuba, width and height are those of the whole film
/// where they are not written.
fn read_crop(object: &Object, film: &Film) -> Result<Option<Window>> {
    let names = ["crop_offset_x", "crop_offset_y", "crop_width", "crop_height"];
    let [x, y, width, height] = [(0, 0), (0, 0), (1, film.width), (1, film.height)];
    let number = |k: usize, (low, default): (i64, u32)| -> Result<u32> {
        Ok(object.integer(names[k], low, 65_535)?.unwrap_or(i64::from(default)) as u32)
    };
    let crop = Window { x: number(0, x)?, y: number(1, y)?, width: number(2, width)?, height: number(3, height)? };
    if crop.x + crop.width > film.width || crop.y + crop.height > film.height {
        let written = names.into_iter().find(|name| object.has(name)).unwrap_or(names[0]);
        let (w, h) = (film.width, film.height);
        return Err(object.bad(written, format!("the crop {crop:?} is not inside the film of {w} x {h}")));
    }
    Ok(names.iter().any(|name| object.has(name)).then_some(crop))
}

fn read_filter(object: &Object) -> Result<Filter> {
    let number = |name: &str, default: f64| Ok(object.float_in(name, 1e-3, 100.0)?.unwrap_or(default));
    let weight = |name: &str| Ok(object.float_in(name, -100.0, 100.0)?.unwrap_or(1.0 / 3.0) as f32);
    Ok(match object.plugin.name {
        "box" => Filter::Box { radius: number("radius", 0.5)? as f32 },
        "tent" => Filter::Tent { radius: number("radius", 1.0)? as f32 },
        "gaussian" => gaussian(number("stddev", 0.5)?),
        "mitchell" => Filter::Mitchell { radius: 2.0, b: weight("B")?, c: weight("C")? },
        "catmullrom" => Filter::Mitchell { radius: 2.0, b: 0.0, c: 0.5 },
        // lanczos
        _ => Filter::Lanczos { radius: object.integer("lobes", 1, 16)?.unwrap_or(3) as f32 },
    })
}

fn read_sampler(object: &Object, settings: &mut RenderSettings) -> Result<()> {
    settings.samples = object.integer("sample_count", 1, 1 << 24)?.unwrap_or(4) as u32;
    settings.seed = object.integer("seed", 0, i64::from(u32::MAX))?.unwrap_or(0) as u32;
    settings.sampler = match object.plugin.name {
        "independent" => Sampler::Independent,
        "stratified" => Sampler::Stratified,
        // Of the same kind: every sample count is well spread.
        _ => Sampler::Sobol,
    };
    Ok(())
}
