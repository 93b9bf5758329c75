//! What a stage makes, as TOML: film, camera, light and ground, around a model that stays in its own file.

use super::settings::{INTEGRATORS, SAMPLERS, SHADINGS, TONEMAPS, UNITS};
use crate::scene::load::surroundings::{Surroundings, turn_of};
use crate::scene::{
    Attenuation, Background, Filter, Geometry, Light, LightKind, MaterialId, Projection, Scene, Shadows,
};
use glam::Vec3;
use std::fmt::Write;

/// What is to be written beside the stage.
#[derive(Clone, Copy, Debug, Default)]
pub struct Additions<'a> {
    /// Name of the model's file.
    pub file: &'a str,
    /// The file's z points up.
    pub z_up: bool,
    /// Tables `[[light]]`, each the lines between its brackets.
    pub lights: &'a [String],
    /// Names and tables `[[material]]`; `*` stands for all of the file's.
    pub materials: &'a [(String, String)],
    /// `[background]` is left to others.
    pub without_background: bool,
}

/// The staged `scene` as a scene file that shows the same picture. Objects but the ground are those of the file.
pub fn staged_text(scene: &Scene, additions: &Additions) -> String {
    let mut out = String::new();
    write_render(scene, &mut out);
    write_film(scene, &mut out);
    write_camera(scene, &mut out);
    if !additions.without_background {
        write_background(scene, &mut out);
    }
    scene.lights.iter().enumerate().for_each(|(index, light)| write_light(index, light, &mut out));
    for table in additions.lights {
        add(&mut out, format_args!("\n[[light]]\n{table}"));
    }
    let ground = scene.objects.last().filter(|object| object.name == "ground");
    if let Some(material) = ground.and_then(|ground| ground.material) {
        write_ground_material(scene, material, &mut out);
    }
    for (name, table) in additions.materials {
        let name = if name == "*" { "all" } else { name };
        add(&mut out, format_args!("\n[[material]]\nname = {}\n{table}", quoted(name)));
    }
    add(&mut out, format_args!("\n[[object]]\nname = \"model\"\nshape = \"mesh\"\nfile = {}", quoted(additions.file)));
    if additions.materials.iter().any(|(name, _)| name == "*") {
        add(&mut out, format_args!("material = \"all\""));
    }
    if additions.z_up {
        add(&mut out, format_args!("matrix = [[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]"));
    }
    if let Some(ground) = ground {
        let (linear, place) = (ground.transform.0.matrix3, ground.transform.0.translation);
        add(&mut out, format_args!("\n[[object]]\nname = \"ground\"\nshape = \"disk\"\nmaterial = \"ground\""));
        if let Geometry::Mesh(mesh) = ground.geometry {
            // Its rim and its middle are all there is.
            add(&mut out, format_args!("segments = {}", scene.meshes[mesh.0 as usize].triangles.len()));
        }
        let scale = [linear.x_axis.x, linear.y_axis.y, linear.z_axis.z];
        add(&mut out, format_args!("scale = {scale:?}\ntranslate = {:?}", place.to_array()));
    }
    out
}

fn add(out: &mut String, line: std::fmt::Arguments) {
    // Nothing can go wrong in writing to a string.
    let _ = writeln!(out, "{line}");
}

/// A basic string of TOML.
pub fn quoted(text: &str) -> String {
    let escaped = text.chars().flat_map(|c| match c {
        '"' | '\\' => vec!['\\', c],
        c if c.is_control() => format!("\\u{:04x}", u32::from(c)).chars().collect(),
        c => vec![c],
    });
    format!("\"{}\"", escaped.collect::<String>())
}

fn word<T: PartialEq + Copy>(names: &[(&'static str, T)], value: T) -> &'static str {
    names.iter().find(|(_, known)| *known == value).map_or("", |(name, _)| name)
}

/// A vector or a colour.
fn numbers(v: Vec3) -> String {
    format!("{:?}", v.to_array())
}

fn write_render(scene: &Scene, out: &mut String) {
    let settings = &scene.settings;
    let shadows = match settings.shadows {
        Shadows::Off => "false",
        Shadows::Opaque => "true",
        Shadows::Filtered => "\"filtered\"",
    };
    add(out, format_args!("[render]\nintegrator = {:?}", word(&INTEGRATORS, settings.integrator)));
    add(out, format_args!("samples = {}\nseed = {}", settings.samples, settings.seed));
    add(out, format_args!("sampler = {:?}", word(&SAMPLERS, settings.sampler)));
    add(out, format_args!("max_depth = {}\nmin_weight = {:?}", settings.max_depth, settings.min_weight));
    add(out, format_args!("rr_depth = {}", settings.rr_depth));
    if let Some(clamp) = settings.clamp {
        add(out, format_args!("clamp = {clamp:?}"));
    }
    add(out, format_args!("shadows = {shadows}\nshading = {:?}", word(&SHADINGS, settings.shading)));
    if let Some(light) = scene.lights.first() {
        add(out, format_args!("intensity = {:?}", word(&UNITS, light.unit)));
    }
    if scene.ambient != Vec3::ZERO {
        add(out, format_args!("ambient = {}", numbers(scene.ambient)));
    }
}

fn write_film(scene: &Scene, out: &mut String) {
    let film = &scene.film;
    add(out, format_args!("\n[film]\nsize = [{}, {}]", film.width, film.height));
    let filter = match film.filter {
        Filter::Box { radius } => format!("type = \"box\", radius = {radius:?}"),
        Filter::Tent { radius } => format!("type = \"tent\", radius = {radius:?}"),
        Filter::Gaussian { radius, sigma } => format!("type = \"gaussian\", radius = {radius:?}, sigma = {sigma:?}"),
        Filter::Mitchell { radius, b, c } => {
            format!("type = \"mitchell\", radius = {radius:?}, b = {b:?}, c = {c:?}")
        }
        Filter::BlackmanHarris { radius } => format!("type = \"blackman-harris\", radius = {radius:?}"),
        Filter::Lanczos { radius } => format!("type = \"lanczos\", radius = {radius:?}"),
    };
    add(out, format_args!("filter = {{ {filter} }}"));
    if film.unit_exponent != 0 {
        add(out, format_args!("unit = {:?}", libm::exp2(f64::from(film.unit_exponent))));
    }
    add(out, format_args!("tonemap = {:?}\nexposure = {:?}", word(&TONEMAPS, film.tonemap), film.exposure));
    if let Some(gamma) = film.gamma {
        add(out, format_args!("gamma = {gamma:?}"));
    }
}

fn write_camera(scene: &Scene, out: &mut String) {
    let camera = &scene.camera;
    add(out, format_args!("\n[camera]\neye = {}\ntarget = {}", numbers(camera.eye), numbers(camera.target)));
    add(out, format_args!("up = {}", numbers(camera.up)));
    match camera.projection {
        Projection::Perspective { fov_y } => add(out, format_args!("fov = {:?}", degrees(fov_y))),
        Projection::Orthographic { height } => {
            add(out, format_args!("projection = \"orthographic\"\nheight = {height:?}"));
        }
    }
    if let Some(lens) = camera.lens {
        let (radius, distance) = (lens.radius, lens.focus_distance);
        add(out, format_args!("lens_radius = {radius:?}\nfocus_distance = {distance:?}"));
    }
}

/// In double precision, so that they are read as the same radians.
fn degrees(radians: f32) -> f64 {
    f64::from(radians).to_degrees()
}

fn write_background(scene: &Scene, out: &mut String) {
    match &scene.background {
        Background::Gradient { bottom, top } if bottom == top && *top == Vec3::ZERO => {}
        Background::Gradient { bottom, top } => {
            add(out, format_args!("\n[background]\nbottom = {}\ntop = {}", numbers(*bottom), numbers(*top)));
        }
        Background::Image(environment) => {
            let name = &scene.textures[environment.texture.0 as usize].name;
            let key = if Surroundings::from_name(name).is_some() { "environment" } else { "image" };
            add(out, format_args!("\n[background]\n{key} = {}\nscale = {}", quoted(name), numbers(environment.scale)));
            add(out, format_args!("rotate = [0, 1, 0, {:?}]", turn_of(environment)));
        }
    }
}

fn write_light(index: usize, light: &Light, out: &mut String) {
    let name = if light.name.is_empty() { format!("light.{index}") } else { format!("{}.{index}", light.name) };
    let kind = match light.kind {
        LightKind::Point { .. } => "point",
        LightKind::Directional { .. } => "directional",
        LightKind::Spot { .. } => "spot",
    };
    add(out, format_args!("\n[[light]]\nname = {}\ntype = {kind:?}", quoted(&name)));
    match light.kind {
        LightKind::Point { position } => add(out, format_args!("position = {}", numbers(position))),
        LightKind::Directional { direction } => add(out, format_args!("direction = {}", numbers(direction))),
        LightKind::Spot { position, direction, inner, outer, exponent } => {
            add(out, format_args!("position = {}\ndirection = {}", numbers(position), numbers(direction)));
            add(out, format_args!("inner_angle = {:?}\nouter_angle = {:?}", degrees(inner), degrees(outer)));
            if exponent != 0.0 {
                add(out, format_args!("exponent = {exponent:?}"));
            }
        }
    }
    add(out, format_args!("intensity = {}", numbers(light.intensity)));
    match light.attenuation {
        Attenuation::InverseSquare => {}
        Attenuation::None if matches!(light.kind, LightKind::Directional { .. }) => {}
        Attenuation::None => add(out, format_args!("attenuation = \"none\"")),
        Attenuation::Polynomial { c1, c2, c3 } => add(out, format_args!("attenuation = [{c1:?}, {c2:?}, {c3:?}]")),
    }
    if !light.casts_shadow {
        add(out, format_args!("casts_shadow = false"));
    }
}

fn write_ground_material(scene: &Scene, id: MaterialId, out: &mut String) {
    let color = scene.materials[id.0 as usize].color;
    add(out, format_args!("\n[[material]]\nname = \"ground\"\ncolor = {}", numbers(color)));
}
