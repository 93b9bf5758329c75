//! What the gallery says of each row of the lecture: its formula, its plot, and how its picture is divided.

use super::curves::{self, FACETS, Interface};
use super::edge::edge_figure;
use super::{Figure, PlotError};

/// The formula of a row, as text.
pub fn formula(row: u32) -> Option<&'static str> {
    Some(match row {
        1 => "I = k_d I_p (N·L)",
        2 => "I = k_a I_a + k_d I_p (N·L) + k_s I_p (V·R)ⁿ,  R = 2N(N·L) − L",
        3 => "I_s = k_s I_p (N·H)ⁿ,  H = (L + V) / |L + V|",
        4 => "I = k_a I_a O_d",
        5 => {
            "I = I_a k_a O_d + Σ f_att,i I_p,i [k_d O_d (N·L_i) + k_s O_s (N·H_i)ⁿ],  f_att = min(1, 1 / (c₁ + c₂d + c₃d²))"
        }
        6 => "L_display = T(2^exposure L),  Reinhard: T = L / (1 + L)",
        7 => "ρ = I_r / E_i,  E_i = I_i cos θ_i dω",
        8 => "flat: I(centroid);  Gouraud: I = b₀I(p₀) + b₁I(p₁) + b₂I(p₂);  Phong: N = b₀N₀ + b₁N₁ + b₂N₂",
        10 => "ρ = ρ_d/π + ρ_s exp[−tan²δ (cos²φ/α_x² + sin²φ/α_y²)] / (4π α_x α_y √(cos θ_i cos θ_r))",
        11 => "L, V constant; H constant",
        14..=18 => {
            "R_s = D G F / (π (N·V)(N·L));  D = exp[−(tan α / m)²] / (4m² cos⁴ α),  G = min(1, 2(N·H)(N·V)/(V·H), 2(N·H)(N·L)/(V·H))"
        }
        21 => "I_L = I_L' (−L·L')ᵖ,  0 where γ > δ",
        22 => "I = (1 − k_t1) I_1 + k_t1 I_2;  filtered: I = I_1 + k_t1 O_t1 I_2",
        23 => "η_i sin θ_i = η_t sin θ_t,  T = (η_it cos θ_i − cos θ_t) N − η_it L,  I = I_0 exp(−σ d)",
        24 => "I = I_local + k_s I_mirror + k_t I_refracted",
        25 => "L_o = L_e + ∫ ρ L_i cos θ_i dω",
        26 => "I(x) = Σ w f(x − x_i) L(x_i) / Σ w f(x − x_i)",
        27 => "O_d(u, v): bilinear between texels",
        _ => return None,
    })
}

/// The plot of a row.
pub fn plot(row: u32) -> Option<Result<Figure, PlotError>> {
    Some(match row {
        2 => Ok(curves::cos_power_figure(&[1.0, 8.0, 64.0])),
        6 => Ok(curves::tone_figure(0.0)),
        8 => edge_figure(),
        14..=18 => Ok(curves::distribution_figure(&FACETS[..1], &[0.2, 0.3, 0.4, 0.6])),
        21 => Ok(curves::spot_figure(&[1.0, 8.0, 64.0], 40.0)),
        23 => Ok(curves::fresnel_figure(&[Interface::dielectric(1.5), Interface::dielectric(2.417)])),
        _ => return None,
    })
}

/// How a scene's picture is shown: names under equal parts of it, or the same scene several times, each with one key
/// changed.
pub enum Panels {
    Columns(&'static [&'static str]),
    /// Name and `key.path=value`.
    Variants(&'static [(&'static str, &'static str)]),
}

/// The panels of the scene file with this stem.
pub fn panels(stem: &str) -> Panels {
    match stem {
        "02-phong" => Panels::Columns(&["n = 1", "n = 8", "n = 64"]),
        "08-shading-models" => Panels::Columns(&["flat", "Gouraud", "Phong"]),
        "14-cook-torrance" => Panels::Columns(&["copper", "gold", "silver", "plastic"]),
        "ambient" => {
            Panels::Variants(&[("without ambient term", "render.ambient=0"), ("with it", "render.shadows=true")])
        }
        "26-zone-plate" => Panels::Variants(&[
            ("box", "film.filter=box"),
            ("gaussian", "film.filter=gaussian"),
            ("blackman-harris", "film.filter=blackman-harris"),
            ("mitchell", "film.filter=mitchell"),
        ]),
        "06-tone-curves" => Panels::Variants(&[
            ("clamp", "film.tonemap=clamp"),
            ("normalise", "film.tonemap=normalise"),
            ("reinhard", "film.tonemap=reinhard"),
            ("aces", "film.tonemap=aces"),
            ("agx", "film.tonemap=agx"),
        ]),
        _ => Panels::Columns(&[]),
    }
}

/// What the comment at the head of a scene file says: the row it belongs to, if any, and the rest.
pub fn caption(text: &str) -> (Option<u32>, String) {
    let lines = text.lines().take_while(|line| line.starts_with('#'));
    let comment = lines.map(|line| line.trim_start_matches('#').trim()).collect::<Vec<_>>().join(" ");
    let Some((head, rest)) = comment.split_once(". ").filter(|(head, _)| head.starts_with("Row")) else {
        return (None, comment);
    };
    let row = head.split(' ').nth(1).and_then(|number| number.parse().ok());
    (row, rest.to_owned())
}
