//! What images may hold, by what they are bound to: as constants, light is not negative and a reflectance lies within 0 and 1.

use crate::scene::{Background, Model, Parameter, Pattern, Rgb, Scene, Texture, TextureData, TextureId};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

/// The values that a use of a texture allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Range {
    /// 0 to 1.
    Reflectance,
    /// 0 and more.
    Light,
    /// Any number; materials limit what they take themselves.
    Finite,
}

/// What stands for infinity: the largest half, so that a sum of a few is finite.
const LARGEST: f32 = 65_504.0;

/// How many texels of a texture were out of range, by why.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Faults {
    texels: usize,
    below: usize,
    above: usize,
    infinite: usize,
    no_number: usize,
}

/// Replaces what textures hold beyond the range of their use by the nearest value that is allowed, and what is no number by 0;
/// one warning for each such image and use. A texture of several uses becomes several where they differ.
pub fn keep_ranges(scene: &mut Scene) {
    let mut uses: BTreeMap<u32, BTreeSet<Range>> = BTreeMap::new();
    each_use(scene, |id, range| {
        uses.entry(id.0).or_default().insert(range);
    });
    let mut kept = Kept::default();
    let mut places: HashMap<(u32, Range), TextureId> = HashMap::new();
    for (&index, ranges) in &uses {
        let texture = scene.textures[index as usize].clone();
        let mut limited = Vec::new();
        for &range in ranges {
            limited.extend(kept.limited(&texture, range, &mut scene.warnings).map(|data| (range, data)));
        }
        // Where nobody wants the texture as it is, the first takes its place.
        let mut free = limited.len() == ranges.len();
        for (range, data) in limited {
            let texture = Texture { data, ..texture.clone() };
            let at = match std::mem::take(&mut free) {
                true => {
                    scene.textures[index as usize] = texture;
                    index
                }
                false => {
                    scene.textures.push(texture);
                    scene.textures.len() as u32 - 1
                }
            };
            places.insert((index, range), TextureId(at));
        }
    }
    if !places.is_empty() {
        each_use(scene, |id, range| *id = places.get(&(id.0, range)).copied().unwrap_or(*id));
    }
}

/// Shows every binding of a texture to `see`.
fn each_use(scene: &mut Scene, mut see: impl FnMut(&mut TextureId, Range)) {
    for material in &mut scene.materials {
        let glows = matches!(material.model, Model::Emissive);
        for binding in &mut material.textures {
            see(&mut binding.texture, range_of(binding.parameter, glows));
        }
    }
    if let Background::Image(environment) = &mut scene.background {
        see(&mut environment.texture, Range::Light);
    }
    let slides = scene.lights.iter_mut().filter_map(|light| light.slide.as_mut());
    slides.filter_map(|slide| slide.texture.as_mut()).for_each(|texture| see(texture, Range::Light));
}

/// `glows`: the material shows its colour as light.
fn range_of(parameter: Parameter, glows: bool) -> Range {
    match parameter {
        Parameter::Color if glows => Range::Light,
        Parameter::Emission => Range::Light,
        Parameter::Color | Parameter::SpecularColor => Range::Reflectance,
        _ => Range::Finite,
    }
}

type Texels = Arc<Vec<[f32; 4]>>;

/// Texels that were out of range.
#[derive(Clone)]
struct Limited {
    /// As they were: while they are kept, no others have their address.
    _source: Texels,
    texels: Texels,
    faults: Faults,
}

/// What was limited already, by the address of the texels: textures that differ in how they lie share them.
#[derive(Default)]
struct Kept {
    texels: HashMap<(usize, Range), Limited>,
    told: BTreeSet<String>,
}

impl Kept {
    /// The data of `texture` within `range`; none if it is.
    fn limited(&mut self, texture: &Texture, range: Range, warnings: &mut Vec<String>) -> Option<TextureData> {
        let (data, faults, count) = match &texture.data {
            // Bytes have no way to be out of range.
            TextureData::Srgb8(_) | TextureData::Linear8(_) => return None,
            TextureData::Float(_) if texture.extrapolated => return None,
            TextureData::Float(texels) => {
                let key = (Arc::as_ptr(texels) as usize, range);
                let limited = match self.texels.get(&key) {
                    Some(known) => known.clone(),
                    None => {
                        let faults = count_faults(texels, range);
                        if faults.texels == 0 {
                            return None;
                        }
                        let limited = texels.iter().map(|texel| limit_texel(*texel, range)).collect();
                        let limited = Limited { _source: texels.clone(), texels: Arc::new(limited), faults };
                        self.texels.entry(key).or_insert(limited).clone()
                    }
                };
                (TextureData::Float(limited.texels), limited.faults, texels.len())
            }
            TextureData::Pattern(pattern) => {
                let texels = pattern.colors.map(|color| color.extend(1.0).to_array());
                let colors = texels.map(|texel| Rgb::from_slice(&limit_texel(texel, range)));
                (TextureData::Pattern(Pattern { colors, ..*pattern }), count_faults(&texels, range), texels.len())
            }
        };
        if faults.texels == 0 {
            return None;
        }
        let warning = faults.message(&texture.name, count, range);
        if self.told.insert(warning.clone()) {
            warnings.push(warning);
        }
        Some(data)
    }
}

impl Faults {
    fn message(&self, name: &str, count: usize, range: Range) -> String {
        let kinds = [
            (self.below, "below 0"),
            (self.above, "above 1"),
            (self.infinite, "infinite"),
            (self.no_number, "not a number"),
        ];
        let kinds: Vec<String> = kinds.iter().filter(|(n, _)| *n > 0).map(|(n, kind)| format!("{n} {kind}")).collect();
        let limits = match range {
            Range::Reflectance => "a reflectance is 0 to 1",
            Range::Light => "light is 0 or more",
            Range::Finite => "numbers are finite",
        };
        let noun = if count == 1 { "texel" } else { "texels" };
        format!("{name}: {} of {count} {noun} clamped: {limits} ({})", self.texels, kinds.join(", "))
    }
}

fn count_faults(texels: &[[f32; 4]], range: Range) -> Faults {
    let mut faults = Faults::default();
    for texel in texels {
        let limited = limit_texel(*texel, range);
        // What is no number differs from itself.
        if limited == *texel {
            continue;
        }
        faults.texels += 1;
        let any = |is: &dyn Fn(f32) -> bool| usize::from(texel.iter().any(|v| is(*v)));
        let [r, g, b, _] = *texel;
        let color = |is: &dyn Fn(f32) -> bool| usize::from([r, g, b].iter().any(|v| is(*v)));
        faults.no_number += any(&|v| v.is_nan());
        faults.infinite += any(&|v| v.is_infinite());
        if range != Range::Finite {
            faults.below += color(&|v| v < 0.0 && v.is_finite());
        }
        if range == Range::Reflectance {
            faults.above += color(&|v| v > 1.0 && v.is_finite());
        }
    }
    faults
}

/// Alpha is no light and no reflectance, but finite.
fn limit_texel([r, g, b, a]: [f32; 4], range: Range) -> [f32; 4] {
    let [r, g, b] = [r, g, b].map(|v| limit(v, range));
    [r, g, b, limit(a, Range::Finite)]
}

fn limit(v: f32, range: Range) -> f32 {
    if v.is_nan() {
        return 0.0;
    }
    let v = if v.is_infinite() { LARGEST.copysign(v) } else { v };
    match range {
        Range::Reflectance => v.clamp(0.0, 1.0),
        // Not -0, which is another bit pattern.
        Range::Light if v < 0.0 => 0.0,
        Range::Light | Range::Finite => v,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::load::staging::bare_scene;
    use crate::scene::{Channel, Environment, Material, PatternKind, TextureBinding, Transform};
    use std::path::Path;

    fn float(name: &str, values: &[f32]) -> Texture {
        let texels = values.iter().map(|v| [*v, *v, *v, 1.0]).collect();
        Texture::new(name, values.len() as u32, 1, TextureData::Float(Arc::new(texels)))
    }

    fn reds(texture: &Texture) -> Vec<f32> {
        match &texture.data {
            TextureData::Float(texels) => texels.iter().map(|texel| texel[0]).collect(),
            _ => Vec::new(),
        }
    }

    fn material(model: Model, parameter: Parameter, texture: u32) -> Material {
        let binding = TextureBinding { parameter, texture: TextureId(texture), channel: Channel::Rgb, scale: 1.0 };
        Material { model, textures: vec![binding], ..Material::grey("m") }
    }

    #[test]
    fn each_use_has_its_range_and_one_warning() {
        let mut scene = bare_scene(Path::new("a.toml"));
        let values = [-1.0, 2.0, 0.5, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
        scene.textures = vec![float("a.exr", &values)];
        scene.materials = vec![
            material(Model::Lambert, Parameter::Color, 0),
            material(Model::Mirror, Parameter::SpecularColor, 0),
            material(Model::Emissive, Parameter::Color, 0),
            material(Model::Lambert, Parameter::Emission, 0),
            material(Model::Lambert, Parameter::Bump, 0),
        ];
        let environment = Environment { texture: TextureId(0), scale: Rgb::ONE, to_world: Transform::default() };
        scene.background = Background::Image(environment);
        keep_ranges(&mut scene);
        let of = |index: usize| reds(&scene.textures[scene.materials[index].textures[0].texture.0 as usize]);
        assert_eq!(of(0), [0.0, 1.0, 0.5, 0.0, 1.0, 0.0]);
        assert_eq!(of(1), of(0));
        assert_eq!(of(2), [0.0, 2.0, 0.5, 0.0, 65_504.0, 0.0]);
        assert_eq!(of(3), of(2));
        assert_eq!(of(4), [-1.0, 2.0, 0.5, 0.0, 65_504.0, -65_504.0]);
        let Background::Image(environment) = scene.background else { panic!("an image") };
        assert_eq!(reds(&scene.textures[environment.texture.0 as usize]), of(2));
        assert_eq!(scene.textures.len(), 3, "one for each range, none for nobody");
        assert_eq!(
            scene.warnings,
            [
                "a.exr: 5 of 6 texels clamped: a reflectance is 0 to 1 (1 below 0, 1 above 1, 2 infinite, 1 not a number)",
                "a.exr: 4 of 6 texels clamped: light is 0 or more (1 below 0, 2 infinite, 1 not a number)",
                "a.exr: 3 of 6 texels clamped: numbers are finite (2 infinite, 1 not a number)",
            ]
        );
    }

    #[test]
    fn textures_that_lie_otherwise_share_what_is_limited_and_others_stay() {
        let mut scene = bare_scene(Path::new("a.toml"));
        let (good, bad) = (float("good.exr", &[0.0, 1.0]), float("bad.exr", &[3.0]));
        scene.textures = vec![good, bad.clone(), Texture { bilinear: false, ..bad }];
        scene.materials = (0..3).map(|i| material(Model::Lambert, Parameter::Color, i)).collect();
        let before = scene.textures.clone();
        keep_ranges(&mut scene);
        assert_eq!(scene.textures[0], before[0]);
        let (TextureData::Float(a), TextureData::Float(b)) = (&scene.textures[1].data, &scene.textures[2].data) else {
            panic!("floats")
        };
        assert!(Arc::ptr_eq(a, b) && a[0][0] == 1.0);
        assert_eq!(scene.warnings, ["bad.exr: 1 of 1 texel clamped: a reflectance is 0 to 1 (1 above 1)"]);
    }

    #[test]
    fn a_use_that_needs_no_change_keeps_the_texture_that_another_changes() {
        let mut scene = bare_scene(Path::new("a.toml"));
        scene.textures = vec![float("a.exr", &[3.0])];
        scene.materials =
            vec![material(Model::Lambert, Parameter::Emission, 0), material(Model::Lambert, Parameter::Color, 0)];
        keep_ranges(&mut scene);
        let of = |index: usize| reds(&scene.textures[scene.materials[index].textures[0].texture.0 as usize]);
        assert_eq!((of(0), of(1)), (vec![3.0], vec![1.0]));
    }

    #[test]
    fn colours_of_patterns_have_ranges_too() {
        let mut scene = bare_scene(Path::new("a.toml"));
        let colors = [Rgb::splat(4.0), Rgb::splat(0.25)];
        scene.textures = vec![Texture::pattern("pattern", Pattern { kind: PatternKind::Checker, colors })];
        scene.materials = vec![material(Model::Lambert, Parameter::Color, 0)];
        keep_ranges(&mut scene);
        let TextureData::Pattern(pattern) = &scene.textures[0].data else { panic!("a pattern") };
        assert_eq!(pattern.colors, [Rgb::ONE, Rgb::splat(0.25)]);
        assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
    }
}
