//! `[[light]]`.

use super::document::Value;
use super::format::LIGHT;
use super::keys::Range;
use super::names::Names;
use super::reader::{Reader, Result, numbers, unit};
use super::settings::LightSettings;
use crate::scene::{Attenuation, Flaps, IntensityUnit, Light, LightKind, Rgb};
use glam::Vec3;

/// All lights of the document.
pub fn read_lights(root: &Reader, settings: &LightSettings, warnings: &mut Vec<String>) -> Result<Vec<Light>> {
    let mut names = Names::new("light");
    let tables = root.tables("light", &LIGHT)?;
    let read = |(index, table): (usize, &Reader)| {
        table.attempt(|| {
            let mut light = read_light(table, settings, warnings)?;
            light.name = match table.text("name")? {
                Some(name) => names.declare(table, name)?,
                None => format!("{}.{index}", light.name),
            };
            Ok(light)
        })
    };
    Ok(tables.iter().enumerate().filter_map(read).collect())
}

/// One light, named by its type for now.
fn read_light(table: &Reader, settings: &LightSettings, warnings: &mut Vec<String>) -> Result<Light> {
    let kinds = [("point", "point"), ("directional", "directional"), ("spot", "spot")];
    let name = table.required("type", table.choice("type", &kinds)?)?;
    table.warn_unused("type", name, warnings);
    let position = || table.required("position", table.vector("position")?);
    let kind = match name {
        "directional" => {
            let direction = table.required("direction", table.direction("direction")?)?;
            LightKind::Directional { direction }
        }
        "spot" => read_spot(table, position()?)?,
        _ => LightKind::Point { position: position()? },
    };
    Ok(Light {
        name: name.to_owned(),
        kind,
        intensity: table.color("intensity")?.unwrap_or(Rgb::ONE) * table.color("color")?.unwrap_or(Rgb::ONE),
        unit: settings.unit,
        attenuation: read_attenuation(table, settings.unit)?,
        flaps: read_flaps(table)?,
        casts_shadow: table.boolean("casts_shadow")?.unwrap_or(true),
        slide: None,
    })
}

fn read_spot(table: &Reader, position: Vec3) -> Result<LightKind> {
    table.exclusive("direction", "target")?;
    let direction = match table.vector("target")? {
        Some(target) => {
            let way = target.as_dvec3() - position.as_dvec3();
            unit(way.to_array()).ok_or_else(|| table.bad("target", "\"target\" and \"position\" are the same point"))?
        }
        None => table.direction("direction")?.unwrap_or(Vec3::NEG_Y),
    };
    let outer = table.number("outer_angle")?.unwrap_or(30.0);
    let inner = table.number("inner_angle")?.unwrap_or(outer);
    if inner > outer {
        let message = format!("\"inner_angle\" = {inner} is larger than \"outer_angle\" = {outer}");
        return Err(table.bad("inner_angle", message));
    }
    let exponent = table.float("exponent")?.unwrap_or(0.0);
    let [inner, outer] = [inner, outer].map(|degrees| degrees.to_radians() as f32);
    Ok(LightKind::Spot { position, direction, inner, outer, exponent })
}

fn read_flaps(table: &Reader) -> Result<Flaps> {
    let mut flaps = Flaps::NONE;
    for (axis, key) in ["flaps_x", "flaps_y", "flaps_z"].into_iter().enumerate() {
        let Some([low, high]) = table.numbers::<2>(key, Range::ANY)? else { continue };
        if low > high {
            return Err(table.bad(key, format!("{key:?} = [{low}, {high}] has its smaller number last")));
        }
        (flaps.min[axis], flaps.max[axis]) = (low as f32, high as f32);
    }
    Ok(flaps)
}

fn read_attenuation(table: &Reader, unit: IntensityUnit) -> Result<Attenuation> {
    let Some(node) = table.node("attenuation") else {
        // Textbook pictures have none unless they are about it.
        return Ok(match unit {
            IntensityUnit::Lecture => Attenuation::None,
            IntensityUnit::Radiometric => Attenuation::InverseSquare,
        });
    };
    match &node.value {
        Value::String(text) if text == "inverse-square" => Ok(Attenuation::InverseSquare),
        Value::String(text) if text == "none" => Ok(Attenuation::None),
        Value::Array(_) => match numbers::<3>(node, Range::NOT_NEGATIVE) {
            Some([0.0, 0.0, 0.0]) => {
                Err(table.bad("attenuation", "\"attenuation\" has three zeros: it divides by nothing"))
            }
            Some(c) => {
                let [c1, c2, c3] = c.map(|number| number as f32);
                Ok(Attenuation::Polynomial { c1, c2, c3 })
            }
            None => Err(table.mismatch("attenuation", node)),
        },
        _ => Err(table.mismatch("attenuation", node)),
    }
}
