//! `[render]`, `[film]`, `[camera]` and `[background]`: read on top of what a scene already has.

use super::document::Value;
use super::format::{BACKGROUND, CAMERA, FILM, FILTER, FILTER_NAMES, RENDER};
use super::keys::Range;
use super::place::read_rotation;
use super::reader::{Reader, Result, in_range};
use super::texture::Textures;
use crate::scene::Shadows;
use crate::scene::load::surroundings;
use crate::scene::{
    Background, Camera, Environment, Film, Filter, Integrator, IntensityUnit, Lens, Projection, RenderSettings,
    Sampler, Shading, ToneMap,
};
use glam::{Vec2, Vec3};

/// What `[render]` says beside `RenderSettings`.
#[derive(Clone, Copy, Debug)]
pub struct LightSettings {
    pub unit: IntensityUnit,
    pub ambient: Vec3,
}

/// Words of `shading`.
pub const SHADINGS: [(&str, Shading); 3] =
    [("flat", Shading::Flat), ("gouraud", Shading::Gouraud), ("phong", Shading::Phong)];

/// Words of `integrator`.
pub const INTEGRATORS: [(&str, Integrator); 4] = [
    ("local", Integrator::Local),
    ("whitted", Integrator::Whitted),
    ("direct", Integrator::Direct),
    ("path", Integrator::Path),
];
/// Words of `sampler`.
pub const SAMPLERS: [(&str, Sampler); 3] =
    [("sobol", Sampler::Sobol), ("stratified", Sampler::Stratified), ("independent", Sampler::Independent)];
/// Words of `intensity`.
pub const UNITS: [(&str, IntensityUnit); 2] =
    [("lecture", IntensityUnit::Lecture), ("radiometric", IntensityUnit::Radiometric)];
/// Words of `tonemap`.
pub const TONEMAPS: [(&str, ToneMap); 5] = [
    ("clamp", ToneMap::Clamp),
    ("normalise", ToneMap::Normalise),
    ("reinhard", ToneMap::Reinhard),
    ("aces", ToneMap::Aces),
    ("agx", ToneMap::Agx),
];

/// Overwrites what `[render]` writes.
pub fn read_render(root: &Reader, settings: &mut RenderSettings, light: &mut LightSettings) -> Result<()> {
    let Some(table) = root.table("render", &RENDER)? else { return Ok(()) };
    set(&mut settings.integrator, table.choice("integrator", &INTEGRATORS)?);
    set(&mut settings.samples, table.integer("samples")?);
    set(&mut settings.seed, table.integer("seed")?);
    set(&mut settings.sampler, table.choice("sampler", &SAMPLERS)?);
    set(&mut settings.max_depth, table.integer("max_depth")?);
    set(&mut settings.min_weight, table.float("min_weight")?);
    set(&mut settings.rr_depth, table.integer("rr_depth")?);
    if let Some(clamp) = table.float("clamp")? {
        settings.clamp = (clamp > 0.0).then_some(clamp);
    }
    if let Some(node) = table.node("shadows") {
        settings.shadows = match &node.value {
            Value::Boolean(true) => Shadows::Opaque,
            Value::Boolean(false) => Shadows::Off,
            Value::String(text) if text == "filtered" => Shadows::Filtered,
            _ => return Err(table.mismatch("shadows", node)),
        };
    }
    set(&mut settings.shading, table.choice("shading", &SHADINGS)?);
    set(&mut light.unit, table.choice("intensity", &UNITS)?);
    set(&mut light.ambient, table.color("ambient")?);
    Ok(())
}

/// Of displays.
const GAMMA: Range = Range::new(0.1, 10.0);

/// Overwrites what `[film]` writes.
pub fn read_film(root: &Reader, film: &mut Film) -> Result<()> {
    let Some(table) = root.table("film", &FILM)? else { return Ok(()) };
    if let Some(size) = table.numbers::<2>("size", Range::new(1.0, 65_535.0))? {
        if size.iter().any(|number| number.fract() != 0.0) {
            return Err(table.bad("size", "\"size\" must be two integers [width, height]"));
        }
        (film.width, film.height) = (size[0] as u32, size[1] as u32);
    }
    set(&mut film.filter, read_filter(&table)?);
    if let Some(node) = table.node("unit") {
        let exponent = in_range(node, Range::POSITIVE).and_then(power_of_two);
        film.unit_exponent = exponent.filter(|e| (-40..=40).contains(e)).ok_or_else(|| table.mismatch("unit", node))?;
    }
    set(&mut film.tonemap, table.choice("tonemap", &TONEMAPS)?);
    set(&mut film.exposure, table.float("exposure")?);
    if let Some(node) = table.node("gamma") {
        let srgb = matches!(&node.value, Value::String(text) if text == "srgb").then_some(None);
        let power = || in_range(node, GAMMA).map(|gamma| Some(gamma as f32));
        film.gamma = srgb.or_else(power).ok_or_else(|| table.mismatch("gamma", node))?;
    }
    Ok(())
}

/// e of `number` = 2^e.
fn power_of_two(number: f64) -> Option<i32> {
    let (fraction, exponent) = libm::frexp(number);
    (fraction == 0.5).then_some(exponent - 1)
}

fn read_filter(film: &Reader) -> Result<Option<Filter>> {
    let Some(node) = film.node("filter") else { return Ok(None) };
    let shapes = FILTER_NAMES.map(|name| (name, name));
    let (shape, table) = match &node.value {
        Value::String(text) if shapes.iter().any(|(name, _)| name == text) => (text.as_str(), None),
        Value::Table(_) => {
            let table = Reader::open(film.document, node, &FILTER)?;
            (table.required("type", table.choice("type", &shapes)?)?, Some(table))
        }
        _ => return Err(film.mismatch("filter", node)),
    };
    let number = |key: &str, default: f32| -> Result<f32> {
        Ok(table.map(|table| table.float(key)).transpose()?.flatten().unwrap_or(default))
    };
    let third = 1.0 / 3.0;
    Ok(Some(match shape {
        "tent" => Filter::Tent { radius: number("radius", 1.0)? },
        "gaussian" => Filter::Gaussian { radius: number("radius", 1.5)?, sigma: number("sigma", 0.5)? },
        "mitchell" => {
            Filter::Mitchell { radius: number("radius", 2.0)?, b: number("b", third)?, c: number("c", third)? }
        }
        "catmull-rom" => Filter::Mitchell { radius: number("radius", 2.0)?, b: 0.0, c: 0.5 },
        "blackman-harris" => Filter::BlackmanHarris { radius: number("radius", 2.0)? },
        "lanczos" => Filter::Lanczos { radius: number("radius", 3.0)? },
        _ => Filter::Box { radius: number("radius", 0.5)? },
    }))
}

/// The camera that `[camera]` writes, what it leaves out taken from `base`; without `base`, `eye` is required.
pub fn read_camera(root: &Reader, film: &Film, base: Option<Camera>) -> Result<Option<Camera>> {
    let Some(table) = root.table("camera", &CAMERA)? else { return Ok(base) };
    let eye = match base {
        Some(base) => table.vector("eye")?.unwrap_or(base.eye),
        None => table.required("eye", table.vector("eye")?)?,
    };
    let target = table.vector("target")?.unwrap_or(base.map_or(Vec3::ZERO, |base| base.target));
    let camera = Camera {
        eye,
        target,
        up: table.vector("up")?.unwrap_or(base.map_or(Vec3::Y, |base| base.up)),
        projection: read_projection(&table, film, base.map(|base| base.projection))?,
        lens: None,
        shift: base.map_or(Vec2::ZERO, |base| base.shift),
        mirrored: base.is_some_and(|base| base.mirrored),
    };
    check_view(&table, &camera)?;
    let sharp = base.and_then(|base| base.lens);
    Ok(Some(Camera { lens: read_lens(&table, camera.eye.as_dvec3().distance(target.as_dvec3()), sharp)?, ..camera }))
}

/// The lens, in focus at the target, which is `distance` away, unless it says otherwise.
fn read_lens(table: &Reader, distance: f64, base: Option<Lens>) -> Result<Option<Lens>> {
    let radius = table.float("lens_radius")?.or(base.map(|base| base.radius)).filter(|radius| *radius > 0.0);
    let focus_distance = table.float("focus_distance")?.or(base.map(|base| base.focus_distance));
    match radius {
        Some(radius) => Ok(Some(Lens { radius, focus_distance: focus_distance.unwrap_or(distance as f32) })),
        None if table.has("focus_distance") => {
            Err(table.bad("focus_distance", "\"focus_distance\" has no meaning without a \"lens_radius\" above 0"))
        }
        None => Ok(None),
    }
}

fn read_projection(table: &Reader, film: &Film, base: Option<Projection>) -> Result<Projection> {
    let kinds = [("perspective", "perspective"), ("orthographic", "orthographic")];
    let of_base = match base {
        Some(Projection::Orthographic { .. }) => "orthographic",
        _ => "perspective",
    };
    table.exclusive("fov", "fov_x")?;
    let kind = table.choice("projection", &kinds)?.unwrap_or(of_base);
    if kind == "orthographic" {
        if let Some(key) = ["fov", "fov_x"].into_iter().find(|key| table.has(key)) {
            return Err(table.bad(key, format!("{key:?} has no meaning for an orthographic camera; it has \"height\"")));
        }
        let height = match (table.float("height")?, base) {
            (None, Some(Projection::Orthographic { height })) => height,
            (height, _) => table.required("height", height)?,
        };
        return Ok(Projection::Orthographic { height });
    }
    if table.has("height") {
        return Err(table.bad("height", "\"height\" has no meaning for a perspective camera; it has \"fov\""));
    }
    let fov_y = match (table.number("fov")?, table.number("fov_x")?, base) {
        (Some(degrees), _, _) => degrees.to_radians() as f32,
        (None, Some(degrees), _) => {
            let half = libm::tan(degrees.to_radians() / 2.0) * f64::from(film.height) / f64::from(film.width);
            (2.0 * libm::atan(half)) as f32
        }
        (None, None, Some(Projection::Perspective { fov_y })) => fov_y,
        _ => 45.0_f64.to_radians() as f32,
    };
    Ok(Projection::Perspective { fov_y })
}

/// Refuses a camera that has no view direction or no up.
fn check_view(table: &Reader, camera: &Camera) -> Result<()> {
    let forward = camera.target.as_dvec3() - camera.eye.as_dvec3();
    let (up, far) = (camera.up.as_dvec3(), forward.length());
    if far < 1.0e-9 {
        return Err(table.bad("target", "\"target\" and \"eye\" are the same point"));
    }
    if up.length() < 1.0e-9 {
        return Err(table.bad("up", "\"up\" is a direction and must not have length 0"));
    }
    // The sine of their angle; below this single precision has no right-hand side left.
    if up.cross(forward).length() < 1.0e-5 * up.length() * far {
        let [x, y, z] = camera.up.to_array();
        return Err(
            table.bad("up", format!("\"up\" = [{x}, {y}, {z}] is parallel to the view; choose another direction"))
        );
    }
    Ok(())
}

/// What `[background]` writes; what a gradient leaves out is black.
pub fn read_background(root: &Reader, textures: &mut Textures) -> Result<Background> {
    let Some(table) = root.table("background", &BACKGROUND)? else { return Ok(Background::BLACK) };
    for key in ["color", "bottom", "top", "image"] {
        table.exclusive("environment", key)?;
    }
    if let Some(ours) = table.choice("environment", &surroundings::NAMES)? {
        let scale = table.color("scale")?.unwrap_or(Vec3::ONE);
        return Ok(ours.background(&mut textures.list, scale, read_rotation(&table)?.unwrap_or_default()));
    }
    for (key, other) in
        [("color", "bottom"), ("color", "top"), ("image", "color"), ("image", "bottom"), ("image", "top")]
    {
        table.exclusive(key, other)?;
    }
    let Some(texture) = textures.read_environment(&table)? else {
        if let Some(key) = ["scale", "rotate"].into_iter().find(|key| table.has(key)) {
            return Err(
                table.bad(key, format!("{key:?} of the background needs \"image\" or \"environment\" beside it"))
            );
        }
        let color = table.color("color")?.unwrap_or(Vec3::ZERO);
        let (bottom, top) = (table.color("bottom")?.unwrap_or(color), table.color("top")?.unwrap_or(color));
        return Ok(Background::Gradient { bottom, top });
    };
    let scale = table.color("scale")?.unwrap_or(Vec3::ONE);
    Ok(Background::Image(Environment { texture, scale, to_world: read_rotation(&table)?.unwrap_or_default() }))
}

/// Overwrites `target` if there is a value.
fn set<T>(target: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *target = value;
    }
}
