//! Every plug-in that is read, with its properties: what an object may say, and the tables of scenes/README.md.

/// The type of a property: which elements write it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Float,
    Integer,
    Boolean,
    Text,
    /// `<point>` or `<vector>`.
    Vector,
    /// `<rgb>`, `<spectrum>` or `<float>`.
    Color,
    /// A colour or a `<texture>`.
    Texture,
    /// `<float>` or a `<texture>`.
    Scalar,
    /// `<float>`, `<point>` or `<vector>`.
    Numbers,
    /// `<float>` or the name of a material: index of refraction.
    Index,
    Transform,
}

impl Kind {
    /// The elements that may write it, but for `<ref>`.
    pub fn tags(self) -> &'static [&'static str] {
        match self {
            Self::Float => &["float", "integer"],
            Self::Integer => &["integer"],
            Self::Boolean => &["boolean"],
            Self::Text => &["string"],
            Self::Vector => &["point", "vector"],
            Self::Color => &["rgb", "spectrum", "float", "integer"],
            Self::Texture => &["rgb", "spectrum", "float", "integer", "texture"],
            Self::Scalar => &["float", "integer", "texture"],
            Self::Numbers => &["float", "integer", "point", "vector"],
            Self::Index => &["float", "integer", "string"],
            Self::Transform => &["transform"],
        }
    }

    pub fn noun(self) -> &'static str {
        match self {
            Self::Float => "number",
            Self::Integer => "integer",
            Self::Boolean => "boolean",
            Self::Text => "string",
            Self::Vector => "point",
            Self::Color => "colour",
            Self::Texture => "colour or texture",
            Self::Scalar => "number or texture",
            Self::Numbers => "number or three",
            Self::Index => "number or name",
            Self::Transform => "transform",
        }
    }
}

/// One property.
#[derive(Clone, Copy, Debug)]
pub struct Property {
    pub name: &'static str,
    pub kind: Kind,
    /// What it is when not written, as text; empty: it must be written or there is no such value.
    pub default: &'static str,
}

/// Stands in `Property::default` of what is read and has no effect here.
pub const NO_EFFECT: &str = "no effect";

/// One plug-in.
#[derive(Clone, Copy, Debug)]
pub struct Plugin {
    /// The element: `bsdf`, `shape`...
    pub class: &'static str,
    /// Its attribute `type`.
    pub name: &'static str,
    pub properties: &'static [&'static [Property]],
    /// Elements that may stand in it beside properties.
    pub nested: &'static [&'static str],
}

impl Plugin {
    pub fn properties(&self) -> impl Iterator<Item = &'static Property> {
        self.properties.iter().copied().flatten()
    }
}

const fn p(name: &'static str, kind: Kind, default: &'static str) -> Property {
    Property { name, kind, default }
}

const fn ignored(name: &'static str, kind: Kind) -> Property {
    Property { name, kind, default: NO_EFFECT }
}

const fn plugin(
    class: &'static str,
    name: &'static str,
    properties: &'static [&'static [Property]],
    nested: &'static [&'static str],
) -> Plugin {
    Plugin { class, name, properties, nested }
}

use Kind::{Boolean, Color, Float, Index, Integer, Numbers, Scalar, Text, Texture, Transform, Vector};

const TO_WORLD: &[Property] = &[p("to_world", Transform, "identity")];
const SHAPE: &[Property] = &[
    p("to_world", Transform, "identity"),
    p("flip_normals", Boolean, "false"),
    ignored("silhouette_sampling_weight", Float),
];
const MESH: &[Property] = &[p("filename", Text, ""), p("face_normals", Boolean, "false")];
const FLIP_OBJ: &[Property] = &[p("flip_tex_coords", Boolean, "true")];
const FLIP_PLY: &[Property] = &[p("flip_tex_coords", Boolean, "false")];
const SHAPE_PARTS: &[&str] = &["bsdf", "emitter"];

const SENSOR: &[Property] = &[
    p("to_world", Transform, "identity"),
    ignored("near_clip", Float),
    ignored("far_clip", Float),
    ignored("shutter_open", Float),
    ignored("shutter_close", Float),
];
const FOV: &[Property] = &[p("fov", Float, ""), p("fov_axis", Text, "x"), p("focal_length", Text, "50mm")];
const PRINCIPAL_POINT: &[Property] = &[
    p("principal_point_offset_x", Float, "0"),
    p("principal_point_offset_y", Float, "0"),
    ignored("focus_distance", Float),
];
const SENSOR_PARTS: &[&str] = &["film", "sampler"];

const SAMPLER: &[Property] = &[p("sample_count", Integer, "4"), p("seed", Integer, "0")];
const JITTER: &[Property] = &[ignored("jitter", Boolean)];

const PATH: &[Property] =
    &[p("max_depth", Integer, "-1"), p("rr_depth", Integer, "5"), p("hide_emitters", Boolean, "false")];
const PASSES: &[Property] =
    &[ignored("samples_per_pass", Integer), ignored("block_size", Integer), ignored("timeout", Float)];

const MICROFACETS: &[Property] =
    &[p("distribution", Text, "beckmann"), p("alpha", Scalar, "0.1"), ignored("sample_visible", Boolean)];
const ANISOTROPIC: &[Property] = &[p("alpha_u", Scalar, "0.1"), p("alpha_v", Scalar, "0.1")];
const GLASS: &[Property] = &[p("int_ior", Index, "bk7"), p("ext_ior", Index, "air")];
const SPECULAR: &[Property] = &[p("specular_reflectance", Texture, "1")];
const SPECULAR_TRANSMITTANCE: &[Property] = &[p("specular_transmittance", Texture, "1")];
const METAL: &[Property] = &[p("material", Text, "none"), p("eta", Color, ""), p("k", Color, "")];
const COAT: &[Property] = &[
    p("diffuse_reflectance", Texture, "0.5"),
    p("nonlinear", Boolean, "false"),
    p("int_ior", Index, "polypropylene"),
    p("ext_ior", Index, "air"),
];

/// All of them, in the order of the documentation.
pub const PLUGINS: &[Plugin] = &[
    plugin("shape", "obj", &[MESH, FLIP_OBJ, SHAPE], SHAPE_PARTS),
    plugin("shape", "ply", &[MESH, FLIP_PLY, SHAPE], SHAPE_PARTS),
    plugin("shape", "serialized", &[MESH, &[p("shape_index", Integer, "0")], FLIP_PLY, SHAPE], SHAPE_PARTS),
    plugin("shape", "sphere", &[&[p("center", Vector, "0, 0, 0"), p("radius", Float, "1")], SHAPE], SHAPE_PARTS),
    plugin("shape", "rectangle", &[SHAPE], SHAPE_PARTS),
    plugin("shape", "cube", &[SHAPE], SHAPE_PARTS),
    plugin("shape", "disk", &[SHAPE], SHAPE_PARTS),
    plugin(
        "shape",
        "cylinder",
        &[&[p("p0", Vector, "0, 0, 0"), p("p1", Vector, "0, 0, 1"), p("radius", Float, "1")], SHAPE],
        SHAPE_PARTS,
    ),
    plugin("shape", "shapegroup", &[], &["shape"]),
    plugin("shape", "instance", &[TO_WORLD], &["shape"]),
    plugin("shape", "merge", &[], &["shape"]),
    plugin("bsdf", "diffuse", &[&[p("reflectance", Texture, "0.5")]], &[]),
    plugin("bsdf", "dielectric", &[GLASS, SPECULAR, SPECULAR_TRANSMITTANCE], &[]),
    plugin("bsdf", "thindielectric", &[GLASS, SPECULAR, SPECULAR_TRANSMITTANCE], &[]),
    plugin("bsdf", "roughdielectric", &[GLASS, MICROFACETS, ANISOTROPIC, SPECULAR, SPECULAR_TRANSMITTANCE], &[]),
    plugin("bsdf", "conductor", &[METAL, SPECULAR], &[]),
    plugin("bsdf", "roughconductor", &[METAL, MICROFACETS, ANISOTROPIC, SPECULAR], &[]),
    plugin("bsdf", "plastic", &[COAT, SPECULAR], &[]),
    plugin("bsdf", "roughplastic", &[COAT, MICROFACETS, SPECULAR], &[]),
    plugin(
        "bsdf",
        "principled",
        &[&[
            p("base_color", Texture, "0.5"),
            p("roughness", Scalar, "0.5"),
            p("anisotropic", Scalar, "0"),
            p("metallic", Scalar, "0"),
            p("spec_trans", Scalar, "0"),
            p("eta", Index, ""),
            p("specular", Float, "0.5"),
            p("spec_tint", Scalar, "0"),
            p("sheen", Scalar, "0"),
            p("sheen_tint", Scalar, "0"),
            p("flatness", Scalar, "0"),
            p("clearcoat", Scalar, "0"),
            p("clearcoat_gloss", Scalar, "0"),
            ignored("diffuse_reflectance_sampling_rate", Float),
            ignored("main_specular_sampling_rate", Float),
            ignored("clearcoat_sampling_rate", Float),
        ]],
        &[],
    ),
    plugin("bsdf", "mask", &[&[p("opacity", Scalar, "0.5")]], &["bsdf"]),
    plugin("bsdf", "blendbsdf", &[&[p("weight", Scalar, "")]], &["bsdf"]),
    plugin("bsdf", "twosided", &[], &["bsdf"]),
    plugin("bsdf", "null", &[], &[]),
    plugin(
        "bsdf",
        "normalmap",
        &[&[
            p("normalmap", Texture, ""),
            ignored("flip_invalid_normals", Boolean),
            ignored("use_shadowing_function", Boolean),
        ]],
        &["bsdf"],
    ),
    plugin("bsdf", "bumpmap", &[&[p("scale", Float, "1")]], &["bsdf", "texture"]),
    plugin("emitter", "area", &[&[p("radiance", Texture, "1")]], &[]),
    plugin("emitter", "point", &[&[p("position", Vector, "0, 0, 0"), p("intensity", Color, "1")], TO_WORLD], &[]),
    plugin(
        "emitter",
        "spot",
        &[
            &[
                p("intensity", Color, "1"),
                p("cutoff_angle", Float, "20"),
                p("beam_width", Float, "3/4 of cutoff_angle"),
                p("texture", Texture, "none"),
            ],
            TO_WORLD,
        ],
        &[],
    ),
    plugin("emitter", "projector", &[&[p("irradiance", Texture, ""), p("scale", Float, "1")], FOV, TO_WORLD], &[]),
    plugin("emitter", "directional", &[&[p("direction", Vector, ""), p("irradiance", Color, "1")], TO_WORLD], &[]),
    plugin("emitter", "constant", &[&[p("radiance", Color, "1")]], &[]),
    plugin(
        "emitter",
        "envmap",
        &[&[p("filename", Text, ""), p("scale", Float, "1"), ignored("mis_compensation", Boolean)], TO_WORLD],
        &[],
    ),
    plugin("sensor", "perspective", &[FOV, PRINCIPAL_POINT, SENSOR], SENSOR_PARTS),
    plugin(
        "sensor",
        "thinlens",
        &[FOV, &[p("aperture_radius", Float, ""), p("focus_distance", Float, "far_clip, 10000")], SENSOR],
        SENSOR_PARTS,
    ),
    plugin("sensor", "orthographic", &[SENSOR], SENSOR_PARTS),
    plugin(
        "film",
        "hdrfilm",
        &[&[
            p("width", Integer, "768"),
            p("height", Integer, "576"),
            p("crop_offset_x", Integer, "0"),
            p("crop_offset_y", Integer, "0"),
            p("crop_width", Integer, "width"),
            p("crop_height", Integer, "height"),
            ignored("file_format", Text),
            ignored("pixel_format", Text),
            ignored("component_format", Text),
            ignored("sample_border", Boolean),
            ignored("compensate", Boolean),
        ]],
        &["rfilter"],
    ),
    plugin("rfilter", "box", &[&[p("radius", Float, "0.5")]], &[]),
    plugin("rfilter", "tent", &[&[p("radius", Float, "1")]], &[]),
    plugin("rfilter", "gaussian", &[&[p("stddev", Float, "0.5")]], &[]),
    plugin("rfilter", "mitchell", &[&[p("B", Float, "1/3"), p("C", Float, "1/3")]], &[]),
    plugin("rfilter", "catmullrom", &[], &[]),
    plugin("rfilter", "lanczos", &[&[p("lobes", Integer, "3")]], &[]),
    plugin("sampler", "independent", &[SAMPLER], &[]),
    plugin("sampler", "stratified", &[SAMPLER, JITTER], &[]),
    plugin("sampler", "multijitter", &[SAMPLER, JITTER], &[]),
    plugin("sampler", "orthogonal", &[SAMPLER, JITTER, &[ignored("strength", Integer)]], &[]),
    plugin("sampler", "ldsampler", &[SAMPLER], &[]),
    plugin("integrator", "path", &[PATH, PASSES], &[]),
    plugin("integrator", "volpath", &[PATH, PASSES], &[]),
    plugin("integrator", "ptracer", &[PATH, PASSES], &[]),
    plugin("integrator", "volpathmis", &[PATH, PASSES, &[ignored("use_spectral_mis", Boolean)]], &[]),
    plugin(
        "integrator",
        "direct",
        &[
            &[
                ignored("shading_samples", Integer),
                ignored("emitter_samples", Integer),
                ignored("bsdf_samples", Integer),
                p("hide_emitters", Boolean, "false"),
            ],
            PASSES,
        ],
        &[],
    ),
    plugin("integrator", "moment", &[], &["integrator"]),
    plugin("integrator", "aov", &[&[ignored("aovs", Text)]], &["integrator"]),
    plugin(
        "texture",
        "bitmap",
        &[&[
            p("filename", Text, ""),
            p("filter_type", Text, "bilinear"),
            p("wrap_mode", Text, "repeat"),
            p("raw", Boolean, "false"),
            p("to_uv", Transform, "identity"),
            ignored("format", Text),
            ignored("accel", Boolean),
        ]],
        &[],
    ),
    plugin(
        "texture",
        "checkerboard",
        &[&[p("color0", Color, "0.4"), p("color1", Color, "0.2"), p("to_uv", Transform, "identity")]],
        &[],
    ),
    plugin("texture", "rawconstant", &[&[p("value", Numbers, "")]], &[]),
    plugin("texture", "mesh_attribute", &[&[p("name", Text, "vertex_color"), p("scale", Float, "1")]], &[]),
    plugin("spectrum", "uniform", &[&[p("value", Float, "1")]], &[]),
    plugin(
        "spectrum",
        "regular",
        &[&[p("wavelength_min", Float, ""), p("wavelength_max", Float, ""), p("values", Text, "")]],
        &[],
    ),
    plugin("spectrum", "irregular", &[&[p("wavelengths", Text, ""), p("values", Text, "")]], &[]),
    plugin(
        "spectrum",
        "blackbody",
        &[&[p("temperature", Float, ""), p("wavelength_min", Float, "360"), p("wavelength_max", Float, "830")]],
        &[],
    ),
    plugin("spectrum", "d65", &[&[p("scale", Float, "1"), p("color", Color, "1")]], &[]),
    plugin("spectrum", "srgb", &[&[p("color", Color, "")]], &[]),
];

/// Plug-ins of Mitsuba 3.9.1 that are not read, and why: (element, type, reason).
pub const REFUSED: &[(&str, &str, &str)] = &[
    ("bsdf", "principledthin", "gonio has no thin surface that scatters light to both of its sides"),
    ("shape", "sdfgrid", "gonio traces triangles and spheres, no distance fields; a mesh of its surface is read"),
];

/// The tables of scenes/README.md: (class, rows).
pub fn tables() -> Vec<(&'static str, String)> {
    let mut tables: Vec<(&'static str, String)> = Vec::new();
    for plugin in PLUGINS {
        if tables.last().is_none_or(|(class, _)| *class != plugin.class) {
            tables.push((plugin.class, "| type | properties and their defaults | holds |\n|---|---|---|\n".to_owned()));
        }
        let (read, unread): (Vec<_>, Vec<_>) = plugin.properties().partition(|property| property.default != NO_EFFECT);
        let mut cells: Vec<String> = read.iter().map(describe).collect();
        if !unread.is_empty() {
            let names: Vec<String> = unread.iter().map(|property| format!("`{}`", property.name)).collect();
            cells.push(format!("without effect: {}", names.join(", ")));
        }
        let row = format!("| `{}` | {} | {} |\n", plugin.name, cells.join("; "), plugin.nested.join(", "));
        if let Some((_, rows)) = tables.last_mut() {
            rows.push_str(&row);
        }
    }
    tables
}

fn describe(property: &Property) -> String {
    match property.default {
        "" => format!("`{}` {}", property.name, property.kind.noun()),
        default => format!("`{}` {} ({default})", property.name, property.kind.noun()),
    }
}
