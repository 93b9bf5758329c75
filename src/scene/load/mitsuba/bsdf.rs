//! `<bsdf>`: materials.

use super::Loader;
use super::document::{Node, Result, hint};
use super::object::Object;
use super::spectrum::{METALS, Role};
use super::texture::Varying;
use crate::scene::{
    Channel, Distribution, Fresnel, Material, MaterialId, Model, Parameter, Principled, Rgb, TextureBinding, TextureId,
};

/// Materials within materials.
pub const NESTING_MAX: u32 = 16;
/// The smallest roughness: below it, Mitsuba too takes this one.
const ALPHA_MIN: f64 = 1e-4;

impl Loader<'_> {
    /// The material of a `<bsdf>`; one that is referred to again is made once.
    pub fn material(&mut self, node: Node) -> Result<MaterialId> {
        self.nested_material(node, false, 0)
    }

    pub fn add_material(&mut self, material: Material) -> MaterialId {
        self.scene.materials.push(material);
        MaterialId(self.scene.materials.len() as u32 - 1)
    }

    /// What a shape without a BSDF shows.
    pub fn default_material(&mut self, reflectance: f32) -> MaterialId {
        let material = Material { color: Rgb::splat(reflectance), two_sided: false, ..Material::grey("default") };
        match self.scene.materials.iter().position(|other| *other == material) {
            Some(known) => MaterialId(known as u32),
            None => self.add_material(material),
        }
    }

    fn nested_material(&mut self, node: Node, two_sided: bool, nesting: u32) -> Result<MaterialId> {
        let key = (node, two_sided, self.showing);
        if let Some(id) = self.materials.get(&key) {
            return Ok(*id);
        }
        let material = self.build(node, two_sided, nesting)?;
        let id = self.add_material(material);
        self.materials.insert(key, id);
        Ok(id)
    }

    /// `two_sided`: a `twosided` is around it.
    fn build(&mut self, node: Node, two_sided: bool, nesting: u32) -> Result<Material> {
        if nesting > NESTING_MAX {
            return Err(self
                .document
                .bad(node, format!("more than {NESTING_MAX} materials within each other; does one hold itself?")));
        }
        let object = Object::open(self.document, node)?;
        let name = self.document.attribute(node, "id").unwrap_or(object.plugin.name).to_owned();
        let mut material = Material { color: Rgb::ONE, two_sided, ..Material::grey(name) };
        let first = |count: usize| {
            let nested = object.nested("bsdf");
            match nested.len() == count {
                true => Ok(nested.iter().map(|child| child.node).collect::<Vec<Node>>()),
                false => {
                    let message =
                        format!("the bsdf {:?} holds {count} bsdf, found {}", object.plugin.name, nested.len());
                    Err(self.document.bad(node, message))
                }
            }
        };
        match object.plugin.name {
            "diffuse" => self.color(&object, &mut material, "reflectance", 0.5)?,
            "dielectric" => {
                material.model = Model::Dielectric { eta: relative_index(&object, "bk7")?, absorption: Rgb::ZERO };
                self.glass(&object, &mut material)?;
            }
            "thindielectric" => {
                material.model = Model::ThinDielectric { eta: relative_index(&object, "bk7")? };
                self.glass(&object, &mut material)?;
            }
            "roughdielectric" => {
                let (alpha_u, alpha_v) = self.alpha(&object, &mut material)?;
                material.model = Model::RoughDielectric {
                    distribution: distribution(&object)?,
                    alpha_u,
                    alpha_v,
                    eta: relative_index(&object, "bk7")?,
                    absorption: Rgb::ZERO,
                };
                self.glass(&object, &mut material)?;
            }
            "conductor" => {
                material.model = Model::Conductor { fresnel: metal(&object)? };
                self.specular(&object, &mut material)?;
            }
            "roughconductor" => {
                let (alpha_u, alpha_v) = self.alpha(&object, &mut material)?;
                material.model = Model::RoughConductor {
                    distribution: distribution(&object)?,
                    alpha_u,
                    alpha_v,
                    fresnel: metal(&object)?,
                    compensate: false,
                };
                self.specular(&object, &mut material)?;
            }
            "plastic" => {
                self.color(&object, &mut material, "diffuse_reflectance", 0.5)?;
                self.specular(&object, &mut material)?;
                let nonlinear = object.boolean("nonlinear")?.unwrap_or(false);
                material.model = Model::Plastic { eta: relative_index(&object, "polypropylene")?, nonlinear };
            }
            "roughplastic" => {
                self.color(&object, &mut material, "diffuse_reflectance", 0.5)?;
                self.specular(&object, &mut material)?;
                let alpha = self.scalar(&object, &mut material, "alpha", 0.1, Parameter::Roughness)?;
                material.model = Model::RoughPlastic {
                    distribution: distribution(&object)?,
                    alpha,
                    eta: relative_index(&object, "polypropylene")?,
                    nonlinear: object.boolean("nonlinear")?.unwrap_or(false),
                };
            }
            "principled" => self.principled(&object, &mut material)?,
            "null" => material.model = Model::Null,
            "twosided" if object.nested("bsdf").len() == 2 => {
                let children = first(2)?;
                let front = self.nested_material(children[0], true, nesting + 1)?;
                material.model = Model::Sides { front, back: self.nested_material(children[1], true, nesting + 1)? };
            }
            "twosided" => {
                return self
                    .build(first(1)?[0], true, nesting + 1)
                    .map(|inner| Material { name: material.name, ..inner });
            }
            "mask" => {
                let mut inner = self.build(first(1)?[0], two_sided, nesting + 1)?;
                inner.opacity *= self.scalar(&object, &mut inner, "opacity", 0.5, Parameter::Opacity)?;
                return Ok(inner);
            }
            "blendbsdf" => {
                let children = first(2)?;
                let weight = self.scalar(&object, &mut material, "weight", 0.5, Parameter::Weight)?;
                object.required("weight", object.property("weight"))?;
                let a = self.nested_material(children[0], two_sided, nesting + 1)?;
                let b = self.nested_material(children[1], two_sided, nesting + 1)?;
                material.model = Model::Blend { weight, a, b };
            }
            // normalmap, bumpmap
            kind => {
                let mut inner = self.build(first(1)?[0], two_sided, nesting + 1)?;
                let (parameter, source) = match kind {
                    "normalmap" => (Parameter::Normal, object.property("normalmap")),
                    _ => (Parameter::Bump, object.only("texture")?.map(|child| child.node)),
                };
                let Some(source) = source.filter(|source| self.document.tag(*source) == "texture") else {
                    return Err(self.document.bad(node, format!("the bsdf {kind:?} needs a texture")));
                };
                let scale =
                    if kind == "bumpmap" { object.float_in("scale", -1e6, 1e6)?.unwrap_or(1.0) as f32 } else { 1.0 };
                let bind = |texture| TextureBinding { parameter, texture, channel: Channel::Rgb, scale };
                inner.textures.extend(self.texture(source)?.map(bind));
                return Ok(inner);
            }
        }
        // What lets light through has no back that could be black.
        material.two_sided |= transmits(&material.model);
        Ok(material)
    }

    fn principled(&mut self, object: &Object, material: &mut Material) -> Result<()> {
        self.color(object, material, "base_color", 0.5)?;
        object.exclusive("eta", "specular")?;
        let specular = object.float_in("specular", 0.0, 1.0)?.unwrap_or(0.5);
        let eta = match object.has("eta") {
            true => object.index("eta", "bk7")? as f32,
            // Mitsuba's and Burley's "specular": the reflectance at normal incidence is 0.08 of it.
            false => (2.0 / (1.0 - libm::sqrt(0.08 * specular)) - 1.0) as f32,
        };
        material.model = Model::Principled(Principled {
            roughness: self.scalar(object, material, "roughness", 0.5, Parameter::Roughness)?,
            anisotropic: self.scalar(object, material, "anisotropic", 0.0, Parameter::Anisotropic)?,
            metallic: self.scalar(object, material, "metallic", 0.0, Parameter::Metallic)?,
            spec_trans: self.scalar(object, material, "spec_trans", 0.0, Parameter::SpecTrans)?,
            eta,
            spec_tint: self.scalar(object, material, "spec_tint", 0.0, Parameter::SpecTint)?,
            sheen: self.scalar(object, material, "sheen", 0.0, Parameter::Sheen)?,
            sheen_tint: self.scalar(object, material, "sheen_tint", 0.0, Parameter::SheenTint)?,
            flatness: self.scalar(object, material, "flatness", 0.0, Parameter::Flatness)?,
            clearcoat: self.scalar(object, material, "clearcoat", 0.0, Parameter::Clearcoat)?,
            clearcoat_gloss: self.scalar(object, material, "clearcoat_gloss", 0.0, Parameter::ClearcoatGloss)?,
        });
        Ok(())
    }

    /// The base colour: a constant or a texture.
    fn color(&mut self, object: &Object, material: &mut Material, name: &str, default: f32) -> Result<()> {
        let Some(node) = object.property(name) else {
            material.color = Rgb::splat(default);
            return Ok(());
        };
        if self.document.tag(node) == "texture"
            && self.showing.is_none()
            && let Some(Varying::Attribute { scale, .. }) =
                self.textures.read(self.document, node, false, &mut self.scene)?
        {
            // As vertex colours, which multiply the colour of every material.
            material.color = Rgb::splat(scale);
            return Ok(());
        }
        material.color = self.factor(object, material, name, default, Parameter::Color)?;
        Ok(())
    }

    /// A colour, or white with a texture that multiplies `parameter`.
    fn factor(
        &mut self,
        object: &Object,
        material: &mut Material,
        name: &str,
        default: f32,
        parameter: Parameter,
    ) -> Result<Rgb> {
        let Some(node) = object.property(name) else { return Ok(Rgb::splat(default)) };
        if self.document.tag(node) != "texture" {
            return super::color::color(self.document, node, Role::Reflectance);
        }
        let Some(texture) = self.texture(node)? else { return Ok(Rgb::splat(default)) };
        material.textures.push(TextureBinding { parameter, texture, channel: Channel::Rgb, scale: 1.0 });
        Ok(Rgb::ONE)
    }

    /// A texture of colours, or of the normals or heights of a map; none, with a warning, if its file is not there: then the
    /// property is as if it had not been written.
    pub fn texture(&mut self, node: Node) -> Result<Option<TextureId>> {
        self.texture_of(node, false)
    }

    fn texture_of(&mut self, node: Node, number: bool) -> Result<Option<TextureId>> {
        match self.textures.read(self.document, node, number, &mut self.scene)? {
            None => Ok(None),
            Some(Varying::Texture(texture)) => Ok(Some(texture)),
            Some(Varying::Attribute { name, scale }) => self.attribute_texture(node, &name, scale).map(Some),
        }
    }

    /// A number within 0 and 1 or a texture, whose constant is 1.
    fn scalar(
        &mut self,
        object: &Object,
        material: &mut Material,
        name: &str,
        default: f64,
        parameter: Parameter,
    ) -> Result<f32> {
        let Some(node) = object.property(name) else { return Ok(default as f32) };
        if self.document.tag(node) == "texture" {
            let Some(texture) = self.texture_of(node, true)? else { return Ok(default as f32) };
            let texture = self.textures.grey(texture, &mut self.scene);
            material.textures.push(TextureBinding { parameter, texture, channel: Channel::R, scale: 1.0 });
            return Ok(1.0);
        }
        let low = if matches!(parameter, Parameter::Roughness | Parameter::RoughnessU | Parameter::RoughnessV) {
            ALPHA_MIN
        } else {
            0.0
        };
        Ok(object.float_in(name, 0.0, 1.0)?.unwrap_or(default).max(low) as f32)
    }

    /// `alpha`, or `alpha_u` and `alpha_v`.
    fn alpha(&mut self, object: &Object, material: &mut Material) -> Result<(f32, f32)> {
        object.exclusive("alpha", "alpha_u")?;
        object.exclusive("alpha", "alpha_v")?;
        if !object.has("alpha_u") && !object.has("alpha_v") {
            let alpha = self.scalar(object, material, "alpha", 0.1, Parameter::Roughness)?;
            return Ok((alpha, alpha));
        }
        if let Some(missing) = ["alpha_u", "alpha_v"].into_iter().find(|name| !object.has(name)) {
            return object.required(missing, None);
        }
        let u = self.scalar(object, material, "alpha_u", 0.1, Parameter::RoughnessU)?;
        Ok((u, self.scalar(object, material, "alpha_v", 0.1, Parameter::RoughnessV)?))
    }

    fn specular(&mut self, object: &Object, material: &mut Material) -> Result<()> {
        let parameter = Parameter::SpecularColor;
        material.specular_color = self.factor(object, material, "specular_reflectance", 1.0, parameter)?;
        Ok(())
    }

    /// The factors on what an interface of glass reflects and lets through.
    fn glass(&mut self, object: &Object, material: &mut Material) -> Result<()> {
        material.color = self.factor(object, material, "specular_reflectance", 1.0, Parameter::Color)?;
        let parameter = Parameter::SpecularColor;
        material.specular_color = self.factor(object, material, "specular_transmittance", 1.0, parameter)?;
        Ok(())
    }
}

fn transmits(model: &Model) -> bool {
    match model {
        Model::Dielectric { .. } | Model::RoughDielectric { .. } | Model::ThinDielectric { .. } | Model::Null => true,
        Model::Principled(principled) => principled.spec_trans > 0.0,
        _ => false,
    }
}

/// The index inside over that outside.
fn relative_index(object: &Object, inside: &str) -> Result<f32> {
    Ok((object.index("int_ior", inside)? / object.index("ext_ior", "air")?) as f32)
}

fn distribution(object: &Object) -> Result<Distribution> {
    let names = [("beckmann", Distribution::Beckmann), ("ggx", Distribution::TrowbridgeReitz)];
    Ok(object.choice("distribution", &names)?.unwrap_or_default())
}

/// `material`, or `eta` and `k` (0 and 1 without either: a perfect mirror).
fn metal(object: &Object) -> Result<Fresnel> {
    object.exclusive("material", "eta")?;
    object.exclusive("material", "k")?;
    if let Some(name) = object.text("material")? {
        let of = |name: &str| METALS.iter().find(|(known, ..)| *known == name);
        let Some((_, eta, k)) = of(name).or_else(|| of(name.strip_suffix("_palik")?)) else {
            let names = METALS.iter().map(|(name, ..)| *name);
            let hint = hint(name, names.clone());
            let names = names.collect::<Vec<_>>().join(", ");
            return Err(object.bad("material", format!("\"material\" must be one of {names}, found {name:?}{hint}")));
        };
        return Ok(Fresnel::Conductor { eta: Rgb::from_array(*eta), k: Rgb::from_array(*k) });
    }
    let eta = object.color("eta", Role::Index)?.unwrap_or(Rgb::ZERO);
    Ok(Fresnel::Conductor { eta, k: object.color("k", Role::Index)?.unwrap_or(Rgb::ONE) })
}
