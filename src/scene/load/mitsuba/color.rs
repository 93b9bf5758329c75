//! Colours: `<rgb>`, `<spectrum>`, `<float>`, and the indices of refraction with names.

use super::document::{Document, Node, Result, hint};
use super::object::{Object, number, parse, words};
use super::spectrum::{INDICES, Role, Spectrum, equal_energy_white};
use crate::scene::Rgb;

/// Points of a spectrum: 1 nm steps are a few hundred.
const POINTS_MAX: usize = 1 << 16;

/// The colour that a `<rgb>`, `<spectrum>`, `<float>` or `<integer>` writes; not negative.
pub fn color(document: &Document, node: Node, role: Role) -> Result<Rgb> {
    let color = match document.tag(node) {
        "rgb" => rgb(document, node)?,
        "spectrum" if document.attribute(node, "type").is_some() => plugin(document, node, role)?,
        "spectrum" => spectrum(document, node, role)?,
        _ => Rgb::splat(number(document, node)? as f32),
    };
    if color.min_element() < 0.0 {
        return Err(document.bad_value(node, "value", format!("a colour has no negative part, found {color}")));
    }
    if role == Role::Reflectance && color.max_element() > 1.0 {
        return Err(document.bad_value(node, "value", format!("a reflectance is at most 1, found {color}")));
    }
    Ok(color)
}

/// Three numbers, one for all, or `#rrggbb` (sRGB).
fn rgb(document: &Document, node: Node) -> Result<Rgb> {
    let text = super::object::value(document, node)?.trim();
    let bad = |message: String| document.bad_value(node, "value", message);
    if let Some(digits) = text.strip_prefix('#') {
        let code = |at: usize| digits.get(at..at + 2).and_then(|two| u8::from_str_radix(two, 16).ok());
        let (6, Some(r), Some(g), Some(b)) = (digits.len(), code(0), code(2), code(4)) else {
            return Err(bad(format!("expected \"#rrggbb\", found {text:?}")));
        };
        let linear = |code: u8| crate::scene::load::image::srgb_to_linear(f64::from(code) / 255.0) as f32;
        return Ok(Rgb::new(linear(r), linear(g), linear(b)));
    }
    let numbers: Option<Vec<f32>> = words(text).map(|word| parse(word).map(|v| v as f32)).collect();
    match numbers.as_deref() {
        Some([grey]) => Ok(Rgb::splat(*grey)),
        Some([r, g, b]) => Ok(Rgb::new(*r, *g, *b)),
        _ => Err(bad(format!("a colour is 1 or 3 numbers or \"#rrggbb\", found {text:?}"))),
    }
}

/// A constant, a list of `wavelength:value`, or a file of such lines. A constant is the same number everywhere but as light,
/// where it is the colour of a flat spectrum, as in Mitsuba's RGB variants.
fn spectrum(document: &Document, node: Node, role: Role) -> Result<Rgb> {
    document.check_attributes(node, &["name", "value", "filename", "id"])?;
    if document.attribute(node, "filename").is_some() {
        if document.attribute(node, "value").is_some() {
            return Err(document.bad_value(node, "filename", "\"value\" and \"filename\" exclude each other"));
        }
        return spectrum_file(document, node, role);
    }
    let text = document.required(node, "value")?;
    if !text.contains(':') {
        return match parse(text) {
            Some(value) if role == Role::Emission => Ok(equal_energy_white() * value as f32),
            Some(value) => Ok(Rgb::splat(value as f32)),
            None => Err(document.bad_value(
                node,
                "value",
                format!("a spectrum is a number or a list \"400:0.1, 500:0.2\", found {text:?}"),
            )),
        };
    }
    let pair = |word: &str| word.split_once(':').and_then(|(w, v)| Some((parse(w)?, parse(v)?)));
    let mut points = Vec::new();
    for word in words(text) {
        let Some(point) = pair(word) else {
            return Err(document.bad_value(node, "value", format!("expected wavelength:value, found {word:?}")));
        };
        points.push(point);
    }
    finish(document, node, "value", points, role)
}

/// The numbers of a property that is a text.
fn list(object: &Object, name: &str) -> Result<Vec<f64>> {
    let text = object.required(name, object.text(name)?)?;
    let number = |word: &str| {
        parse(word).ok_or_else(|| object.bad(name, format!("{name:?} is a list of numbers, found {word:?}")))
    };
    words(text).map(number).collect()
}

/// Wavelengths from `wavelength_min` to `wavelength_max`, `count` (2 or more) of them, evenly spaced.
fn even_wavelengths(object: &Object, count: usize, defaults: [Option<f64>; 2]) -> Result<Vec<f64>> {
    let end = |name: &str, default: Option<f64>| {
        object.float_in(name, 1.0, 1e6)?.or(default).map_or_else(|| object.required(name, None), Ok)
    };
    let (low, high) = (end("wavelength_min", defaults[0])?, end("wavelength_max", defaults[1])?);
    Ok((0..count).map(|i| low + (high - low) * i as f64 / (count.max(2) - 1) as f64).collect())
}

/// Spectral radiance of a black body in W / (m^2 sr nm): Planck's law. `wavelength`: nm. `temperature`: K.
fn planck(wavelength: f64, temperature: f64) -> f64 {
    // CODATA 2018; exact.
    const C: f64 = 299_792_458.0;
    const H: f64 = 6.626_070_15e-34;
    const K: f64 = 1.380_649e-23;
    let metres = wavelength * 1e-9;
    let growth = libm::expm1(H * C / (metres * K * temperature));
    1e-9 * 2.0 * H * C * C / (metres * metres * metres * metres * metres * growth)
}

fn spectrum_file(document: &Document, node: Node, role: Role) -> Result<Rgb> {
    let path = document.find_file(node, "filename")?;
    let text = crate::scene::load::text::utf8(&path, crate::scene::load::text::read_bytes(&path)?)?;
    let mut points = Vec::new();
    for (index, line) in text.lines().enumerate() {
        if line.trim().is_empty() || line.starts_with('#') {
            continue;
        }
        let numbers: Option<Vec<f64>> = line.split_whitespace().map(parse).collect();
        let Some([wavelength, value]) = numbers.as_deref() else {
            let location = crate::scene::Location { file: path, line: index as u32 + 1, column: 1 };
            return Err(crate::scene::SceneError::bad(
                location,
                format!("expected a wavelength and a value, found {line:?}"),
            ));
        };
        points.push((*wavelength, *value));
    }
    finish(document, node, "filename", points, role)
}

fn finish(document: &Document, node: Node, attribute: &str, points: Vec<(f64, f64)>, role: Role) -> Result<Rgb> {
    let bad = |message: &str| Err(document.bad_value(node, attribute, message));
    if points.len() < 2 || points.len() > POINTS_MAX {
        return bad("a spectrum has 2 to 65536 wavelengths");
    }
    if points.windows(2).any(|pair| pair[1].0 < pair[0].0) {
        return bad("the wavelengths of a spectrum ascend");
    }
    Ok(Spectrum { points }.rgb(role))
}

/// `<spectrum type="...">`.
fn plugin(document: &Document, node: Node, role: Role) -> Result<Rgb> {
    let object = Object::open(document, node)?;
    match object.plugin.name {
        "uniform" => Ok(Rgb::splat(object.float("value")?.unwrap_or(1.0) as f32)),
        "regular" => {
            let values = list(&object, "values")?;
            let wavelengths = even_wavelengths(&object, values.len(), [None; 2])?;
            finish(document, node, "value", wavelengths.into_iter().zip(values).collect(), role)
        }
        "irregular" => {
            let (wavelengths, values) = (list(&object, "wavelengths")?, list(&object, "values")?);
            if wavelengths.len() != values.len() {
                let message = format!("{} wavelengths have {} values", wavelengths.len(), values.len());
                return Err(object.bad("values", message));
            }
            finish(document, node, "value", wavelengths.into_iter().zip(values).collect(), role)
        }
        "blackbody" => {
            let kelvin = object.required("temperature", object.float_in("temperature", 1.0, 1e7)?)?;
            // A nanometre apart: Planck's curve has no edges.
            let wavelengths = even_wavelengths(&object, 471, [Some(360.0), Some(830.0)])?;
            finish(document, node, "value", wavelengths.iter().map(|w| (*w, planck(*w, kelvin))).collect(), role)
        }
        "d65" => {
            let scale = object.float("scale")?.unwrap_or(1.0) as f32;
            let color = object.property("color").map(|node| color(document, node, role)).transpose()?;
            Ok(color.unwrap_or(Rgb::ONE) * scale)
        }
        // srgb
        _ => {
            let color = object.property("color").map(|node| color(document, node, role)).transpose()?;
            object.required("color", color)
        }
    }
}

impl Object<'_> {
    /// The colour of a property that is no texture.
    pub fn color(&self, name: &str, role: Role) -> Result<Option<Rgb>> {
        self.property(name).map(|node| color(self.document, node, role)).transpose()
    }

    /// An index of refraction: a number or a name.
    pub fn index(&self, name: &str, default: &str) -> Result<f64> {
        let Some(node) = self.property(name) else { return Ok(named_index(default).unwrap_or(1.0)) };
        if self.document.tag(node) != "string" {
            let index = self.float_in(name, 0.1, 100.0)?;
            return self.required(name, index);
        }
        let text = super::object::value(self.document, node)?;
        named_index(text).ok_or_else(|| {
            let names = INDICES.iter().map(|(name, _)| *name);
            let hint = hint(text, names.clone());
            let message = format!(
                "{name:?} is a number or one of {}, found {text:?}{hint}",
                names.collect::<Vec<_>>().join(", ")
            );
            self.document.bad_value(node, "value", message)
        })
    }
}

fn named_index(name: &str) -> Option<f64> {
    let name = name.to_lowercase();
    INDICES.iter().find(|(known, _)| *known == name).map(|(_, index)| *index)
}
