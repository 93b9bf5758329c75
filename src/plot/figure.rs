//! What a picture of curves says, before it is drawn: numbers with names.

/// 8-bit sRGB.
pub type Color = [u8; 3];

/// Colours that people tell apart who see few colours (Okabe and Ito 2008, "Color universal design").
pub const PALETTE: [Color; 7] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233], [60, 60, 60]];

/// The colour of curve number `index`.
pub fn palette(index: usize) -> Color {
    PALETTE[index % PALETTE.len()]
}

/// A line with its name in the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    pub name: String,
    pub color: Color,
    pub dashed: bool,
    /// Cartesian: x and y. Polar: degrees from the axis, to the right, and the length. A NaN interrupts the line.
    pub points: Vec<[f64; 2]>,
}

impl Curve {
    /// `value` at `count` + 1 equal steps from `low` to `high`.
    pub fn sampled(name: impl Into<String>, index: usize, range: [f64; 2], value: impl Fn(f64) -> f64) -> Self {
        let [low, high] = range;
        let at = |i: usize| low + (high - low) * i as f64 / STEPS as f64;
        let points = (0..=STEPS).map(|i| [at(i), value(at(i))]).collect();
        Self { name: name.into(), color: palette(index), dashed: index >= PALETTE.len(), points }
    }

    pub fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }

    pub fn colored(self, color: Color) -> Self {
        Self { color, ..self }
    }

    /// The largest finite y or length.
    pub fn highest(&self) -> f64 {
        self.points.iter().map(|p| p[1]).filter(|v| v.is_finite()).fold(0.0, f64::max)
    }
}

/// Intervals of a sampled curve: a quarter of a degree over a right angle.
pub const STEPS: usize = 360;

/// One axis of a Cartesian picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// With its unit.
    pub label: String,
    pub low: f64,
    pub high: f64,
    /// Between labelled ticks.
    pub step: f64,
}

impl Axis {
    /// From 0 to a round number not below `highest`.
    pub fn up_to(label: impl Into<String>, highest: f64) -> Self {
        let highest = if highest > 0.0 { highest } else { 1.0 };
        let step = nice_step(highest / 6.0);
        Self { label: label.into(), low: 0.0, high: (highest / step - 1e-9).ceil() * step, step }
    }

    /// Degrees.
    pub fn degrees(label: impl Into<String>, low: f64, high: f64) -> Self {
        Self { label: label.into(), low, high, step: 15.0 }
    }

    pub fn ticks(&self) -> Vec<f64> {
        let (first, last) =
            ((self.low / self.step - 1e-9).ceil() as i64, (self.high / self.step + 1e-9).floor() as i64);
        (first..=last).map(|i| i as f64 * self.step).collect()
    }
}

/// 1, 2 or 5 times a power of ten, not below `least`.
pub fn nice_step(least: f64) -> f64 {
    let power = libm::pow(10.0, libm::floor(libm::log10(least)));
    [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|step| *step >= least * (1.0 - 1e-9)).unwrap_or(power)
}

/// A number as a reader writes it: no more digits than it needs, at most four significant ones.
pub fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let digits = (3 - libm::floor(libm::log10(value.abs())) as i32).clamp(0, 12) as usize;
    let text = format!("{:.digits$}", value.abs());
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    // An en dash: a hyphen is too short for a minus.
    if value < 0.0 { format!("–{text}") } else { text.into() }
}

/// Which part of the circle a polar picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Above a surface.
    Upper,
    /// Below a lamp; angles are from straight down.
    Lower,
    /// Both sides of a surface.
    Full,
}

/// A direction drawn into a polar picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrow {
    pub name: String,
    /// Degrees from the axis, to the right.
    pub angle: f64,
    /// Towards the centre, as light that arrives; else a dashed line.
    pub inward: bool,
}

/// A vertical line at `x` of a Cartesian picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub name: String,
    pub x: f64,
}

/// A strip of colours along the x axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    pub name: String,
    pub colors: Vec<Color>,
}

/// A filled polygon, its corners in 0..1 of its panel, y up.
#[derive(Clone, Debug, PartialEq)]
pub struct Facet {
    pub corners: Vec<[f64; 2]>,
    pub color: Color,
}

/// One body of a picture in perspective, farthest facets first.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    pub name: String,
    pub facets: Vec<Facet>,
}

/// What the curves are drawn over.
#[derive(Clone, Debug, PartialEq)]
pub enum Frame {
    Cartesian { x: Axis, y: Axis, marks: Vec<Mark> },
    Polar { side: Side, unit: String, max: f64, arrows: Vec<Arrow> },
    Ramp { x: Axis, strips: Vec<Strip> },
    Bodies(Vec<Body>),
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    pub title: String,
    /// Below the title: what is held fixed, in small letters.
    pub note: String,
    pub frame: Frame,
    pub curves: Vec<Curve>,
}

impl Figure {
    /// Curves over x and an upward axis from 0 that holds them all.
    pub fn cartesian(title: &str, note: impl Into<String>, x: Axis, y: &str, curves: Vec<Curve>) -> Self {
        let highest = curves.iter().map(Curve::highest).fold(0.0, f64::max);
        let frame = Frame::Cartesian { x, y: Axis::up_to(y, highest), marks: Vec::new() };
        Self { title: title.into(), note: note.into(), frame, curves }
    }

    /// The numbers of all curves: one line for each point, `curve,x,y`.
    pub fn csv(&self) -> String {
        let (x, y) = match &self.frame {
            Frame::Cartesian { x, y, .. } => (x.label.as_str(), y.label.as_str()),
            Frame::Polar { unit, .. } => ("angle [°]", unit.as_str()),
            Frame::Ramp { .. } | Frame::Bodies(_) => ("x", "y"),
        };
        let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
        let mut text = format!("curve,{},{}\n", quoted(x), quoted(y));
        for curve in &self.curves {
            let name = quoted(&curve.name);
            curve.points.iter().for_each(|[x, y]| text.push_str(&format!("{name},{x},{y}\n")));
        }
        text
    }
}
