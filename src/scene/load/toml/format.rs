//! The tables of the format (see `keys`), in the order of scenes/README.md.

use super::keys::{Key, Kind, Range, Section, key};
use super::material_format::{LOBE, MATERIAL, TEXTURE};

const ONE_OR_MORE: &str = "one or more tables";

/// The whole file.
pub static SCENE: Section = Section {
    name: "scene",
    noun: "the scene",
    keys: &[
        key("render", Kind::Special("a table"), "all defaults", "How to compute the picture: `[render]`"),
        key("film", Kind::Special("a table"), "all defaults", "The image plane and how it is displayed: `[film]`"),
        key("camera", Kind::Special("a table"), "required", "Where the picture is taken from: `[camera]`"),
        key("background", Kind::Special("a table"), "black", "What rays that leave the scene see: `[background]`"),
        key("material", Kind::Special(ONE_OR_MORE), "none", "Surfaces: `[[material]]`"),
        key("object", Kind::Special(ONE_OR_MORE), "required", "Things: `[[object]]`"),
        key("light", Kind::Special(ONE_OR_MORE), "none", "Lights: `[[light]]`"),
        key("panel", Kind::Special(ONE_OR_MORE), "none", "The same scene side by side: `[[panel]]`"),
    ],
};

pub const SHADING_NAMES: [&str; 3] = ["flat", "gouraud", "phong"];

pub static RENDER: Section = Section {
    name: "[render]",
    noun: "[render]",
    keys: &[
        key(
            "integrator",
            Kind::Choice(&["local", "whitted", "direct", "path"]),
            "`\"whitted\"`",
            "`local`: the illumination model alone, with shadows. `whitted`: mirror and refracted rays as well (Whitted 1980). `path`: global illumination by path tracing; everything that glows lights the rest, ambient light is left out. `direct`: `path` with one scattering event",
        ),
        key("samples", Kind::Integer { min: 1, max: 1 << 24 }, "16", "Samples a pixel"),
        key("seed", Kind::Integer { min: 0, max: u32::MAX as i64 }, "0", "Another seed, another noise"),
        key(
            "sampler",
            Kind::Choice(&["sobol", "stratified", "independent"]),
            "`\"sobol\"`",
            "Owen-scrambled Sobol' points (Burley 2020), jittered strata, or plain random numbers",
        ),
        key(
            "max_depth",
            Kind::Integer { min: 0, max: 64 },
            "8",
            "Scattering events a path may have: 0 shows what glows, 1 adds light scattered once. Mitsuba counts one more (its -1 is our 64)",
        ),
        key(
            "min_weight",
            Kind::Number(Range::UNIT),
            "0.003",
            "Branches that add less than this share to the pixel are cut (local, whitted)",
        ),
        key(
            "rr_depth",
            Kind::Integer { min: 0, max: 65 },
            "5",
            "Scattering events after which a dim path may be ended at random, the rest made brighter (Russian roulette); more than `max_depth`: never (path)",
        ),
        key(
            "clamp",
            Kind::Number(Range::NOT_NEGATIVE),
            "0",
            "Largest channel that one contribution of scattered light may add, against bright specks; darkens the picture, and says how often. 0: no limit (path)",
        ),
        key(
            "shadows",
            Kind::Special("true, false or \"filtered\""),
            "true",
            "Trace shadow rays. true: panes (`k_t`, `opacity`) stop none, or under `path` and `direct`, which find the way through them by chance, all. `\"filtered\"`: each pane on the way weakens the light to k_t, or colours it by k_t O_t if it is a filter",
        ),
        key(
            "shading",
            Kind::Choice(&SHADING_NAMES),
            "`\"phong\"`",
            "How triangles are shaded under `local`. `flat`: once, at the centroid with the triangle's normal. `gouraud`: at the corners, each with its own normal, texture value and direction to the eye, and interpolated. `phong`: at every sample with the interpolated normal",
        ),
        key(
            "intensity",
            Kind::Choice(&["lecture", "radiometric"]),
            "`\"radiometric\"`",
            "What the `intensity` of lights means. `radiometric`: W/sr (directional: W/m²). `lecture`: the I_p of textbooks, that divided by π, so that a white surface facing the light shows I_p",
        ),
        key("ambient", Kind::Color(Range::NOT_NEGATIVE), "0", "I_a, the radiance of the ambient term k_a I_a O_d"),
    ],
};

pub static FILM: Section = Section {
    name: "[film]",
    noun: "[film]",
    keys: &[
        key("size", Kind::Special("two integers [width, height] from 1 to 65535"), "[1280, 720]", "Pixels"),
        key(
            "filter",
            Kind::Special(
                "\"box\", \"tent\", \"gaussian\", \"mitchell\", \"catmull-rom\", \"blackman-harris\", \"lanczos\" or a table",
            ),
            "`\"gaussian\"`",
            "Reconstruction filter; the table's keys are below. Mitchell, Catmull-Rom and Lanczos have negative lobes: sharper, and noisy below some 64 samples",
        ),
        key(
            "unit",
            Kind::Special("a power of two from 2^-40 to 2^40"),
            "1",
            "The radiance of one film unit: raise it for scenes brighter than about 65,000, lower it for very dim ones",
        ),
        key(
            "tonemap",
            Kind::Choice(&["clamp", "normalise", "reinhard", "aces", "agx"]),
            "`\"clamp\"`",
            "Display: cut at 1, divide by the image's maximum, L/(1+L) (Reinhard et al. 2002), ACES 1.0 (fit by Hill 2016) or AgX (Sobotka 2022)",
        ),
        key("exposure", Kind::Number(Range::new(-64.0, 64.0)), "0", "Display: stops; +1 doubles"),
        key(
            "gamma",
            Kind::Special("a number from 0.1 to 10 or \"srgb\""),
            "`\"srgb\"`",
            "Display: what integers store is light to the power 1/gamma, or the curve of the sRGB standard",
        ),
        key(
            "columns",
            Kind::Integer { min: 1, max: MAX_PANELS },
            "as many as panels",
            "Panels in a row of the picture",
        ),
    ],
};

pub const FILTER_NAMES: [&str; 7] =
    ["box", "tent", "gaussian", "mitchell", "catmull-rom", "blackman-harris", "lanczos"];

pub static FILTER: Section = Section {
    name: "filter = { … }",
    noun: "a filter",
    keys: &[
        key("type", Kind::Choice(&FILTER_NAMES), "required", "Its shape"),
        key(
            "radius",
            Kind::Number(Range::above(0.0, 16.0)),
            "box 0.5, tent 1, gaussian 1.5, mitchell 2, catmull-rom 2, blackman-harris 2, lanczos 3",
            "Half width, pixels; of lanczos also its number of lobes",
        ),
        key("sigma", Kind::Number(Range::above(0.0, 16.0)), "0.5", "Standard deviation, pixels").only(&["gaussian"]),
        key("b", Kind::Number(Range::UNIT), "1/3", "B of Mitchell and Netravali 1988").only(&["mitchell"]),
        key("c", Kind::Number(Range::UNIT), "1/3", "C of Mitchell and Netravali 1988").only(&["mitchell"]),
    ],
};

pub static CAMERA: Section = Section {
    name: "[camera]",
    noun: "[camera]",
    keys: &[
        key("eye", Kind::Vector, "required", "Position"),
        key("target", Kind::Vector, "[0, 0, 0]", "The point in the middle of the picture"),
        key("up", Kind::Vector, "[0, 1, 0]", "What points up in the picture; any length, not along the view"),
        key(
            "projection",
            Kind::Choice(&["perspective", "orthographic"]),
            "`\"perspective\"`",
            "Orthographic is the eye at infinity",
        ),
        key("fov", Kind::Number(Range::new(0.01, 179.0)), "45", "Full vertical field of view, degrees")
            .only(&["perspective"]),
        key(
            "fov_x",
            Kind::Number(Range::new(0.01, 179.0)),
            "none",
            "Full horizontal field of view, degrees, instead of `fov`",
        )
        .only(&["perspective"]),
        key("height", Kind::Number(Range::POSITIVE), "required", "Height of the view, scene units")
            .only(&["orthographic"]),
        key(
            "lens_radius",
            Kind::Number(Range::NOT_NEGATIVE),
            "0",
            "Radius of a thin lens, scene units: what is nearer or farther than `focus_distance` blurs, a point at distance z to a disk of `lens_radius` |1 - z / `focus_distance`| there. 0: a pinhole, all is sharp",
        ),
        key(
            "focus_distance",
            Kind::Number(Range::POSITIVE),
            "the distance to `target`",
            "From the lens along the view to the plane that is sharp, scene units",
        ),
    ],
};

pub static BACKGROUND: Section = Section {
    name: "[background]",
    noun: "[background]",
    keys: &[
        key("color", Kind::Color(Range::NOT_NEGATIVE), "0", "Radiance in every direction"),
        key(
            "bottom",
            Kind::Color(Range::NOT_NEGATIVE),
            "0",
            "Radiance straight down (-y), instead of `color`; between the two the gradient is linear in y",
        ),
        key("top", Kind::Color(Range::NOT_NEGATIVE), "0", "Radiance straight up (+y)"),
        key(
            "image",
            Kind::Text,
            "none",
            "Equirectangular picture all around, HDR or EXR as a rule, relative to the scene file: its top row is +y, its centre +z, a quarter from the left +x",
        ),
        key(
            "environment",
            Kind::Choice(&["studio", "sky", "white"]),
            "none",
            "Surroundings that need no file, which white paper on the floor shows as about 1: a photographer's studio, a clear sky, or white all around; seen from +z the light comes from the upper left",
        ),
        key("scale", Kind::Color(Range::NOT_NEGATIVE), "1", "Factor on `image` or `environment`"),
        key(
            "rotate",
            Kind::Special("four numbers [x, y, z, degrees]"),
            "none",
            "Turns `image` or `environment` about an axis, counter-clockwise seen from its tip",
        ),
    ],
};

/// The keys that place a thing, the same everywhere: scale, then rotate, then translate.
const SCALE: Key =
    key("scale", Kind::Special("a number or three numbers [x, y, z], none 0"), "1", "Applied first; negative mirrors");
const ROTATE: Key = key(
    "rotate",
    Kind::Special("four numbers [x, y, z, degrees]"),
    "none",
    "About an axis through the origin, counter-clockwise seen from its tip; applied second",
);
const TRANSLATE: Key = key("translate", Kind::Vector, "[0, 0, 0]", "Applied last");
const MATRIX: Key = key(
    "matrix",
    Kind::Special("four rows of four numbers"),
    "none",
    "Instead of the other three: column vectors, last row [0, 0, 0, 1]",
);
const TRANSFORM: Key = key(
    "transform",
    Kind::Special("an array of tables"),
    "none",
    "Steps in the order they are applied, instead of the keys above",
);

pub static OBJECT: Section = Section {
    name: "[[object]]",
    noun: "[[object]]",
    keys: &[
        key("name", Kind::Text, "its shape and number", "Unique"),
        key("shape", Kind::Choice(SHAPES), "required", "What it is; the shapes' own sizes are below"),
        key("material", Kind::Text, "a grey; a file's own", "Name of a `[[material]]`"),
        SCALE,
        ROTATE,
        TRANSLATE,
        MATRIX,
        TRANSFORM,
        key("casts_shadow", Kind::Boolean, "the material's", "Whether it stops shadow rays"),
        key("shading", Kind::Choice(&SHADING_NAMES), "that of `[render]`", "How its triangles are shaded under `local`; a sphere needs `segments` for `flat` and `gouraud`"),
        key("instances", Kind::Special("an array of tables"), "none", "Copies that share the geometry: each placed by its own keys below, after the object's"),
        key("grid", Kind::Special("a table"), "none", "A block of copies; its keys are below"),
        key("radius", Kind::Number(Range::POSITIVE), "1", "Scene units").only(&["sphere", "disk", "cylinder", "cone"]),
        key("size", Kind::Special("a number, or one for each axis: [x, z] (quad, heightfield) or [x, y, z] (box)"), "1", "Lengths of the sides, scene units").only(&["quad", "box", "heightfield"]),
        key("height", Kind::Number(Range::POSITIVE), "1", "Along y; of a heightfield the height of white").only(&["cylinder", "cone", "heightfield"]),
        key("capped", Kind::Boolean, "true", "With its disks, else a tube").only(&["cylinder", "cone"]),
        key("major_radius", Kind::Number(Range::POSITIVE), "1", "From the torus's centre to the middle of its tube").only(&["torus"]),
        key("minor_radius", Kind::Number(Range::POSITIVE), "0.25", "Of the tube, less than `major_radius`").only(&["torus"]),
        key("rings", Kind::Integer { min: 3, max: 4096 }, "32", "Segments around the tube").only(&["torus"]),
        key("coordinates", Kind::Choice(&["square", "polar"]), "`\"square\"`", "What u and v are: along x and -z of the square around it, or around it and from its middle to the rim").only(&["disk"]),
        key("profile", Kind::Special("2 to 4096 pairs [radius, height]"), "required", "What turns around the y axis: up along the outer wall, over the rim and down the inner one").only(&["lathe"]),
        key("curve", Kind::Choice(&["smooth", "polyline"]), "`\"smooth\"`", "How the profile's points are joined").only(&["lathe"]),
        key("steps", Kind::Integer { min: 1, max: 64 }, "8", "Rows between two points of a smooth profile").only(&["lathe"]),
        key("crease", Kind::Number(Range::new(0.0, 180.0)), "45", "Edges of a polyline or of smooth normals stay sharp above this angle, degrees").only(&["lathe", "mesh"]),
        key("segments", Kind::Integer { min: 1, max: 4096 }, "quad and box 1, teapot 8, heightfield 128, others 64; a sphere without it is analytic", "Around the axis (from 3), along each side, along each side of a teapot's patches (to 128), or cells of a heightfield from noise").only(&["sphere", "quad", "box", "disk", "cylinder", "cone", "torus", "lathe", "teapot", "heightfield"]),
        key("noise", Kind::Special("a table"), "all defaults", "The landscape of a heightfield without `file`; its keys are below").only(&["heightfield"]),
        key("triangles", Kind::Integer { min: 1, max: u32::MAX as i64 }, "200000", "About how many: of a terrain from 2 and to 33554432, of a hairball to 33554432, of a field of teapots all together to 4227858432").only(&["terrain", "hairball", "teapots"]),
        key("level", Kind::Integer { min: 0, max: 7 }, "4", "How often spheres carry nine smaller ones: (9^(level + 1) - 1) / 8 analytic spheres").only(&["sphereflake"]),
        key("file", Kind::Text, "required for a mesh", "mesh: OBJ, PLY, STL, glTF or GLB; heightfield: an image, white is high; relative to the scene file").only(&["mesh", "heightfield"]),
        key("normals", Kind::Choice(&["file", "flat", "smooth"]), "`\"file\"`", "The file's own normals, none, or the mean of the faces around each vertex").only(&["mesh"]),
    ],
};

pub static NOISE: Section = Section {
    name: "noise = { … }",
    noun: "noise",
    keys: &[
        key("features", Kind::Number(Range::new(0.1, 1024.0)), "4", "Hills along a side"),
        key("octaves", Kind::Integer { min: 1, max: 16 }, "6", "Each twice as fine as the last"),
        key("gain", Kind::Number(Range::UNIT), "0.5", "Height of an octave over that of the last"),
        key("seed", Kind::Integer { min: 0, max: u32::MAX as i64 }, "0", "Another seed, another landscape"),
    ],
};

pub const SHAPES: &[&str] = &[
    "sphere",
    "quad",
    "box",
    "disk",
    "cylinder",
    "cone",
    "torus",
    "lathe",
    "teapot",
    "heightfield",
    "terrain",
    "hairball",
    "sphereflake",
    "teapots",
    "mesh",
];

pub static STEP: Section =
    Section { name: "transform = [{ … }]", noun: "a transform step", keys: &[SCALE, ROTATE, TRANSLATE, MATRIX] };

pub static INSTANCE: Section = Section {
    name: "instances = [{ … }]",
    noun: "an instance",
    keys: &[
        key("material", Kind::Text, "the object's", "Name of a `[[material]]`"),
        SCALE,
        ROTATE,
        TRANSLATE,
        MATRIX,
        TRANSFORM,
    ],
};

pub static GRID: Section = Section {
    name: "grid = { … }",
    noun: "a grid",
    keys: &[
        key(
            "count",
            Kind::Special("three integers [x, y, z] from 1, at most 1048576 copies in all"),
            "required",
            "Copies along each axis",
        ),
        key(
            "spacing",
            Kind::Vector,
            "required",
            "Distance between copies, scene units; the block is centred on the object's place",
        ),
    ],
};

const PLACED: &[&str] = &["point", "spot"];

/// Flaps, one key an axis.
const fn flaps(name: &'static str, meaning: &'static str) -> Key {
    key(name, Kind::Special("two numbers [min, max]"), "none", meaning)
}

const FLAPS_X: Key =
    flaps("flaps_x", "Warn's flaps (barn doors): the light reaches only what has its x, in the world, between the two");
const FLAPS_Y: Key = flaps("flaps_y", "The same for y: light for the actor, none for the floor");
const FLAPS_Z: Key = flaps("flaps_z", "The same for z");

pub static LIGHT: Section = Section {
    name: "[[light]]",
    noun: "[[light]]",
    keys: &[
        key("name", Kind::Text, "its type and number", "Unique"),
        key("type", Kind::Choice(&["point", "directional", "spot"]), "required", "A point; parallel light from infinity; a directed point (Warn 1983)"),
        key("position", Kind::Vector, "required", "Where it is").only(PLACED),
        key("direction", Kind::Vector, "directional required, spot [0, -1, 0]", "The way the light travels; any length").only(&["directional", "spot"]),
        key("target", Kind::Vector, "none", "A point it shines at, instead of `direction`").only(&["spot"]),
        key("intensity", Kind::Color(Range::NOT_NEGATIVE), "1", "In the unit of `render.intensity`"),
        key("color", Kind::Color(Range::UNIT), "1", "Factor on `intensity`"),
        key("attenuation", Kind::Special("\"inverse-square\", \"none\" or three numbers [c1, c2, c3] >= 0"), "`\"inverse-square\"`; `\"none\"` with `render.intensity = \"lecture\"`", "Fall-off with distance d: 1/d², none, or min(1, 1/(c1 + c2 d + c3 d²))").only(PLACED),
        key("outer_angle", Kind::Number(Range::above(0.0, 90.0)), "30", "Half angle of the cone δ, degrees: no light beyond").only(&["spot"]),
        key("inner_angle", Kind::Number(Range::new(0.0, 90.0)), "`outer_angle`", "Half angle where the light begins to fall off towards the edge, degrees; equal to `outer_angle`: a hard edge").only(&["spot"]),
        key("exponent", Kind::Number(Range::new(0.0, 1.0e6)), "0", "Warn's p: the intensity is times cos^p of the angle off the axis").only(&["spot"]),
        FLAPS_X,
        FLAPS_Y,
        FLAPS_Z,
        key("casts_shadow", Kind::Boolean, "true", "Whether things stop it"),
    ],
};

/// Of one scene.
const MAX_PANELS: i64 = 64;

pub static PANEL: Section = Section {
    name: "[[panel]]",
    noun: "[[panel]]",
    keys: &[
        key("label", Kind::Text, "required", "Stands under it; unique"),
        key(
            "set",
            Kind::Special("an array of changes such as \"render.ambient=0\""),
            "none",
            "What is different here, each as `--set` takes it; the command line's own come after them",
        ),
    ],
};

/// All of them.
pub static SECTIONS: &[&Section] = &[
    &SCENE,
    &RENDER,
    &FILM,
    &FILTER,
    &CAMERA,
    &BACKGROUND,
    &MATERIAL,
    &TEXTURE,
    &LOBE,
    &OBJECT,
    &NOISE,
    &STEP,
    &INSTANCE,
    &GRID,
    &LIGHT,
    &PANEL,
];
