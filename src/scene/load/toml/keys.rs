//! Every key of the TOML format: its type, its range, its default, when it counts and what it says.
//!
//! The reader takes names, types and ranges from here and refuses what is not listed; scenes/README.md holds the same
//! tables as text, and a test keeps them equal. A key is added here and in the one place that reads it.

/// One table of the format.
#[derive(Debug)]
pub struct Section {
    /// As a file writes it.
    pub name: &'static str,
    /// What a message calls it, with its article.
    pub noun: &'static str,
    pub keys: &'static [Key],
}

/// One key of a section.
#[derive(Debug)]
pub struct Key {
    pub name: &'static str,
    pub kind: Kind,
    /// As a reader of the documentation wants it; `required` if there is none.
    pub default: &'static str,
    /// The values of the section's switch (`Section::switch`) under which the key counts; empty: always.
    pub only: &'static [&'static str],
    /// Meaning and unit.
    pub what: &'static str,
}

/// The type of a value.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    Boolean,
    Integer {
        min: i64,
        max: i64,
    },
    Number(Range),
    Text,
    Choice(&'static [&'static str]),
    /// A number, `[r, g, b]`, `"#rrggbb"` or a name; each channel in the range.
    Color(Range),
    /// Three numbers.
    Vector,
    /// Read by hand; the words say what is allowed.
    Special(&'static str),
}

/// Finite numbers from `min` to `max`; `open`: without `min` itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub min: f64,
    pub max: f64,
    pub open: bool,
}

/// No number of a scene file is larger in magnitude: squares and products of three stay finite in single precision.
pub const LARGEST: f64 = 1.0e12;

impl Range {
    pub const ANY: Self = Self::new(-LARGEST, LARGEST);
    pub const POSITIVE: Self = Self { min: 0.0, max: LARGEST, open: true };
    pub const NOT_NEGATIVE: Self = Self::new(0.0, LARGEST);
    pub const UNIT: Self = Self::new(0.0, 1.0);

    /// Both ends included.
    pub const fn new(min: f64, max: f64) -> Self {
        Self { min, max, open: false }
    }

    /// Above `min`, up to and including `max`.
    pub const fn above(min: f64, max: f64) -> Self {
        Self { min, max, open: true }
    }

    /// NaN is in no range.
    pub fn contains(&self, number: f64) -> bool {
        number <= self.max && if self.open { number > self.min } else { number >= self.min }
    }

    /// Such as ` from 0 to 1`, with a leading space; nothing where every number is allowed.
    pub fn describe(&self) -> String {
        let high = self.max >= LARGEST;
        match (self.min <= -LARGEST, self.open, high) {
            (true, _, true) => String::new(),
            (true, _, false) => format!(" up to {}", self.max),
            (false, false, true) => format!(" >= {}", self.min),
            (false, true, true) => format!(" > {}", self.min),
            (false, false, false) => format!(" from {} to {}", self.min, self.max),
            (false, true, false) => format!(" above {} and up to {}", self.min, self.max),
        }
    }
}

impl Kind {
    /// What is allowed, such as `a number from 0 to 1`.
    pub fn describe(&self) -> String {
        match self {
            Self::Boolean => "true or false".to_owned(),
            Self::Integer { min, max } => format!("an integer from {min} to {max}"),
            Self::Number(range) => format!("a number{}", range.describe()),
            Self::Text => "a non-empty string".to_owned(),
            Self::Choice(names) => list(names),
            Self::Color(range) => format!("a colour{}", range.describe()),
            Self::Vector => "three numbers [x, y, z]".to_owned(),
            Self::Special(words) => (*words).to_owned(),
        }
    }
}

/// `"a", "b" or "c"`.
pub fn list(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("{name:?}")).collect();
    match quoted.split_last() {
        None => "nothing".to_owned(),
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
    }
}

impl Section {
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// The section's rows in scenes/README.md.
    pub fn markdown(&self) -> String {
        let mut text = String::from("| key | value | default | meaning |\n|---|---|---|---|\n");
        for key in self.keys {
            let only = match key.only {
                [] => String::new(),
                only => format!(" *(only {})*", only.join(", ")),
            };
            let (name, kind, default, what) = (key.name, key.kind.describe(), key.default, key.what);
            text.push_str(&format!("| `{name}` | {kind} | {default} | {what}{only} |\n"));
        }
        text
    }
}

/// A key that always counts.
pub const fn key(name: &'static str, kind: Kind, default: &'static str, what: &'static str) -> Key {
    Key { name, kind, default, only: &[], what }
}

impl Key {
    /// The same key, counting only under these values of the section's switch.
    pub const fn only(self, only: &'static [&'static str]) -> Self {
        Self { name: self.name, kind: self.kind, default: self.default, only, what: self.what }
    }
}

/// Words of other programs for keys of ours, for "did you mean".
pub const SYNONYMS: &[(&str, &str)] = &[
    ("albedo", "color"),
    ("ambient_weight", "k_a"),
    ("angle", "outer_angle"),
    ("aperture", "lens_radius"),
    ("aperture_radius", "lens_radius"),
    ("base_color", "color"),
    ("bounces", "max_depth"),
    ("center", "translate"),
    ("centre", "translate"),
    ("colour", "color"),
    ("coneangle", "outer_angle"),
    ("cutoff_angle", "outer_angle"),
    ("depth", "max_depth"),
    ("diffuse", "k_d"),
    ("filename", "file"),
    ("focal_distance", "focus_distance"),
    ("fov_y", "fov"),
    ("from", "eye"),
    ("height_px", "size"),
    ("ior", "eta"),
    ("ka", "k_a"),
    ("kd", "k_d"),
    ("kind", "type"),
    ("kr", "k_r"),
    ("ks", "k_s"),
    ("kt", "k_t"),
    ("location", "translate"),
    ("look_at", "target"),
    ("lookat", "target"),
    ("origin", "eye"),
    ("path", "file"),
    ("power", "intensity"),
    ("radiance", "emission"),
    ("reflectance", "color"),
    ("reflection", "k_r"),
    ("resolution", "size"),
    ("shininess", "exponent"),
    ("specular", "k_s"),
    ("spp", "samples"),
    ("to", "target"),
    ("transparency", "k_t"),
    ("width", "size"),
];
