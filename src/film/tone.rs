//! Tone curves: how much light a display shows for the light of the film. Row 6 of the lecture.

use crate::scene::ToneMap;

/// Names of the tone curves, as scene files and flags write them.
pub const TONEMAP_NAMES: [(&str, ToneMap); 5] = [
    ("clamp", ToneMap::Clamp),
    ("normalise", ToneMap::Normalise),
    ("reinhard", ToneMap::Reinhard),
    ("aces", ToneMap::Aces),
    ("agx", ToneMap::Agx),
];

/// The curve of that name; an error names what is allowed.
pub fn tonemap_from_name(name: &str) -> Result<ToneMap, String> {
    let named = TONEMAP_NAMES.iter().find(|(n, _)| *n == name);
    named.map(|(_, curve)| *curve).ok_or_else(|| format!("allowed: {}", TONEMAP_NAMES.map(|(name, _)| name).join(", ")))
}

/// The name of a curve.
pub fn tonemap_name(tonemap: ToneMap) -> &'static str {
    TONEMAP_NAMES.iter().find(|(_, curve)| *curve == tonemap).map_or("", |(name, _)| name)
}

/// Rec. 709 luminance.
fn luminance(rgb: [f64; 3]) -> f64 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

/// Rows times column.
fn transform(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Linear Rec. 709 light, finite and not negative, exposure included, to linear light of the display, 0 to 1. `Normalise`
/// is a matter of exposure: here it clamps.
pub fn tone_curve(tonemap: ToneMap, light: [f64; 3]) -> [f64; 3] {
    let shown = match tonemap {
        ToneMap::Clamp | ToneMap::Normalise => light,
        // equation 3: L_d = L / (1 + L), with hue and saturation kept (Reinhard et al. 2002)
        ToneMap::Reinhard => {
            let scale = 1.0 / (1.0 + luminance(light));
            light.map(|v| v * scale)
        }
        ToneMap::Aces => aces(light),
        ToneMap::Agx => agx(light),
    };
    shown.map(|v| v.clamp(0.0, 1.0))
}

/// Rec. 709 to the colours the ACES fit works in: to AP1, with the RRT's desaturation. Each row's sum is 1.
const ACES_IN: [[f64; 3]; 3] = [[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]];
/// And back: the ODT's desaturation, to Rec. 709.
const ACES_OUT: [[f64; 3]; 3] =
    [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]];

/// The reference rendering transform and the output transform for a display of 100 nits, fitted: .18 is shown as .105.
/// Renderers that multiply by 1/.6 before the curve (three.js) are matched by an exposure of .737 stops.
/// Source: Hill 2016, BakingLab, ACES.hlsl (RRTAndODTFit), after AMPAS, ACES 1.0.
fn aces(light: [f64; 3]) -> [f64; 3] {
    // Beyond this the fit is flat, and its squares must stay finite.
    let fit = |v: f64| {
        let v = v.min(1.0e9);
        (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951_0) + 0.238_081)
    };
    transform(&ACES_OUT, transform(&ACES_IN, light).map(fit))
}

/// Rec. 709 to AgX's wider primaries. Each row's sum is 1: grey stays grey.
const AGX_IN: [[f64; 3]; 3] = [
    [0.842_479_062_253_094, 0.078_433_599_999_999_2, 0.079_223_745_147_764_3],
    [0.042_328_242_261_012_3, 0.878_468_636_469_772, 0.079_166_127_460_543_4],
    [0.042_375_654_905_705_1, 0.078_433_6, 0.879_142_973_793_104],
];
/// Its inverse.
const AGX_OUT: [[f64; 3]; 3] = [
    [1.196_879_005_120_17, -0.098_020_881_140_136_8, -0.099_029_744_079_720_5],
    [-0.052_896_851_757_456_2, 1.151_903_129_904_17, -0.098_961_176_844_843_3],
    [-0.052_971_635_514_443_8, -0.098_043_450_117_124_1, 1.151_073_672_641_16],
];
/// log2 of the darkest and the brightest light that AgX tells apart.
const AGX_STOPS: [f64; 2] = [-12.473_93, 4.026_069];

/// AgX's base look: light in stops on wider primaries, a sigmoid, back to Rec. 709. Bright colours fade to white.
/// Source: Sobotka 2022, AgX; sigmoid as the polynomial of Wrensch 2023, Minimal AgX Implementation (sixth degree,
/// squared error 3.7e-6).
fn agx(light: [f64; 3]) -> [f64; 3] {
    let [low, high] = AGX_STOPS;
    let sigmoid = |v: f64| {
        let x = (libm::log2(v).clamp(low, high) - low) / (high - low);
        (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.002_32
    };
    let encoded = transform(&AGX_OUT, transform(&AGX_IN, light).map(sigmoid));
    // The sigmoid's result is meant for a display of gamma 2.2.
    encoded.map(|v| libm::pow(v.max(0.0), 2.2))
}
