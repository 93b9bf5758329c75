//! What the gallery says of each row of the lecture: its name, its formulae, its plots.

use super::curves::{self, FACETS, Interface};
use super::edge::edge_figure;
use super::fit::{FIT_MODELS, fit, fit_figure};
use super::shelf::Shelf;
use super::{Figure, PlotError, lobes};
use crate::scene::load::toml::METALS;
use crate::scene::{Fresnel, Material, Model, Scene};

/// A row of the lecture.
pub struct Row {
    pub number: u32,
    pub title: &'static str,
    /// LaTeX, one line each.
    pub formulae: &'static [&'static str],
}

const fn row(number: u32, title: &'static str, formulae: &'static [&'static str]) -> Row {
    Row { number, title, formulae }
}

/// The rows that have scenes, in order.
pub const ROWS: &[Row] = &[
    row(1, "Lambert's law", &[r"I = k_d\, I_p\, (N \cdot L)"]),
    row(
        2,
        "Phong's highlight",
        &[r"I = k_a I_a + k_d I_p (N \cdot L) + k_s I_p (V \cdot R)^n", r"R = 2 N (N \cdot L) - L"],
    ),
    row(3, "Blinn's highlight", &[r"I_s = k_s I_p (N \cdot H)^n", r"H = \frac{L + V}{\lvert L + V \rvert}"]),
    row(4, "Ambient light", &[r"I = k_a I_a O_d"]),
    row(
        5,
        "Several lights, and how they fall off",
        &[
            r"I = I_a k_a O_d + \sum_i f_{\mathrm{att},i}\, I_{p,i} \left[ k_d O_d (N \cdot L_i) + k_s O_s (N \cdot H_i)^n \right]",
            r"f_{\mathrm{att}} = \min\left(1, \frac{1}{c_1 + c_2 d + c_3 d^2}\right)",
        ],
    ),
    row(
        6,
        "The range of a display",
        &[r"L_{\mathrm{display}} = T(2^{\mathrm{exposure}} L)", r"T_{\mathrm{Reinhard}}(L) = \frac{L}{1 + L}"],
    ),
    row(
        7,
        "The BRDF",
        &[
            r"\rho(\lambda, \theta_r, \phi_r, \theta_i, \phi_i) = \frac{I_r}{E_i}",
            r"E_i = I_i \cos\theta_i\, d\omega_i",
        ],
    ),
    row(
        8,
        "Flat, Gouraud and Phong shading",
        &[
            r"I_{\mathrm{flat}} = I(p_c, N_c)",
            r"I_{\mathrm{Gouraud}} = b_0 I(p_0, N_0) + b_1 I(p_1, N_1) + b_2 I(p_2, N_2)",
            r"I_{\mathrm{Phong}} = I(p, N), \quad N \propto b_0 N_0 + b_1 N_1 + b_2 N_2",
        ],
    ),
    row(
        9,
        "Measured BRDFs",
        &[r"\rho(\theta_h, \theta_d, \phi_d)", r"\rho_{\mathrm{fit}} = \arg\min_m \sum (\rho_m - \rho)^2"],
    ),
    row(
        10,
        "Ward's Gaussian",
        &[
            r"\rho = \frac{\rho_d}{\pi} + \rho_s \frac{1}{\sqrt{\cos\theta_i \cos\theta_r}} \frac{\exp\left[-{\tan}^2\delta \left({\cos}^2\phi / \alpha_x^2 + {\sin}^2\phi / \alpha_y^2\right)\right]}{4\pi \alpha_x \alpha_y}",
        ],
    ),
    row(
        11,
        "Light and eye at infinity",
        &[r"L,\; V \text{ constant} \;\Rightarrow\; H = \frac{L + V}{\lvert L + V \rvert} \text{ constant}"],
    ),
    row(
        14,
        "Cook and Torrance's model",
        &[
            r"R_s = \frac{D\, G\, F}{\pi\, (N \cdot V)(N \cdot L)}",
            r"I = k_a I_a O_d + \sum_i I_i\, d\omega_i \left( k_d R_d (N \cdot L_i) + k_s R_s (N \cdot L_i) \right), \quad k_d + k_s = 1",
        ],
    ),
    row(
        15,
        "Distributions of facets",
        &[
            r"D_{\mathrm{Beckmann}} = \frac{1}{4 m^2 {\cos}^4\alpha}\, e^{-(\tan\alpha / m)^2}",
            r"D_{\mathrm{Gauss}} = c\, e^{-(\alpha / m)^2}",
            r"D_{\mathrm{Trowbridge\text{-}Reitz}} = \left( \frac{c^2}{{\cos}^2\alpha\,(c^2 - 1) + 1} \right)^2, \quad D_{\mathrm{Phong}} = {\cos}^c \alpha",
        ],
    ),
    row(
        16,
        "Masking and shadowing",
        &[
            r"G = \min\left( 1,\; \frac{2 (N \cdot H)(N \cdot V)}{V \cdot H},\; \frac{2 (N \cdot H)(N \cdot L)}{V \cdot H} \right)",
        ],
    ),
    row(
        17,
        "Fresnel reflectance",
        &[
            r"F = \frac{1}{2} \frac{(g - c)^2}{(g + c)^2} \left( 1 + \frac{(c (g + c) - 1)^2}{(c (g - c) + 1)^2} \right), \quad c = V \cdot H, \; g^2 = \eta^2 + c^2 - 1",
        ],
    ),
    row(
        18,
        "What is reflected of the light",
        &[r"k_s + k_d = 1", r"a(\theta) = \int_\Omega \rho \cos\theta_i \, d\omega_i \le 1"],
    ),
    row(
        19,
        "Limits of the model, lifted",
        &[
            r"D(h) = \frac{1}{\pi \alpha_x \alpha_y {\cos}^4\theta_h}\, e^{-{\tan}^2\theta_h \left( {\cos}^2\phi_h / \alpha_x^2 + {\sin}^2\phi_h / \alpha_y^2 \right)}",
            r"\rho_d(\theta_i, \theta_r) = c\, \left(1 - a(\theta_i)\right)\left(1 - a(\theta_r)\right)",
        ],
    ),
    row(21, "Directed light", &[r"I_L = I_{L'} (-L \cdot L')^p", r"I_L = 0 \text{ where } \gamma > \delta"]),
    row(
        22,
        "Transparency without refraction",
        &[r"I = (1 - k_{t1}) I_1 + k_{t1} I_2", r"I = I_1 + k_{t1} O_{t1} I_2 \quad \text{(filtered)}"],
    ),
    row(
        23,
        "Refraction",
        &[
            r"\eta_i \sin\theta_i = \eta_t \sin\theta_t",
            r"{\cos}^2\theta_t = 1 - \left(\frac{\eta_i}{\eta_t}\right)^2 (1 - {\cos}^2\theta_i)",
            r"T = \left( \frac{\eta_i}{\eta_t} \cos\theta_i - \cos\theta_t \right) N - \frac{\eta_i}{\eta_t} L",
            r"I = I_0\, e^{-\sigma d}",
        ],
    ),
    row(
        24,
        "Whitted's ray tracing",
        &[r"I = I_{\mathrm{local}} + k_r I_{\mathrm{mirror}} + k_t I_{\mathrm{refracted}}"],
    ),
    row(25, "Global illumination", &[r"L_o = L_e + \int_\Omega \rho\, L_i \cos\theta_i \, d\omega_i"]),
    row(26, "Anti-aliasing", &[r"I(x) = \frac{\sum_i f(x - x_i)\, L(x_i)}{\sum_i f(x - x_i)}"]),
    row(27, "Textures", &[r"O_d = \sum_{i, j} w_i(u)\, w_j(v)\, T_{i j}"]),
];

/// The row with this number.
pub fn row_of(number: u32) -> Option<&'static Row> {
    ROWS.iter().find(|row| row.number == number)
}

/// The row that a scene file's stem begins with, as in `02-phong`, and the rest of its name.
pub fn numbered(stem: &str) -> (Option<u32>, &str) {
    let rest = stem.trim_start_matches(|c: char| c.is_ascii_digit());
    match (stem[..stem.len() - rest.len()].parse(), rest.strip_prefix('-')) {
        (Ok(number), Some(name)) => (Some(number), name),
        _ => (None, stem),
    }
}

/// The plots that belong to the scene `title` of a row; some show the materials of it.
pub fn plots(row: u32, title: &str, scene: &Scene) -> Result<Vec<Figure>, PlotError> {
    let shelf = || Shelf::of(scene).map_err(PlotError::new);
    let shown = |shelf: &Shelf| (0..shelf.names().len()).filter(|i| shelf.reflects(*i)).collect::<Vec<_>>();
    let of_shelf = |figures: &dyn Fn(&Shelf, &[usize]) -> Vec<Figure>| {
        let shelf = shelf()?;
        let materials = shown(&shelf);
        Ok(figures(&shelf, &materials))
    };
    match (row, title) {
        (1, _) => of_shelf(&|shelf, materials| vec![lobes::polar_figure(shelf, materials, 45.0)]),
        (2, _) => Ok(vec![curves::cos_power_figure(&[1.0, 8.0, 64.0])]),
        (3, _) => of_shelf(&|shelf, materials| vec![lobes::cartesian_figure(shelf, materials, 45.0)]),
        (5, "attenuation") => Ok(vec![curves::attenuation_figure(curves::CAPPED)]),
        (6, _) => Ok(vec![curves::tone_figure(0.0)]),
        (7, _) => of_shelf(&|shelf, materials| {
            let bodies = materials.chunks(3).map(|three| lobes::bodies_figure(shelf, three, 45.0));
            std::iter::once(lobes::polar_figure(shelf, materials, 45.0)).chain(bodies).collect()
        }),
        (8, _) => Ok(vec![edge_figure()?]),
        (9, _) => fits(scene, &shelf()?),
        (10, _) => of_shelf(&|shelf, materials| vec![lobes::cartesian_figure(shelf, materials, 60.0)]),
        (14, _) => of_shelf(&|shelf, materials| {
            let kinds = by_kind(shelf.names(), materials);
            kinds.iter().map(|kind| lobes::cartesian_figure(shelf, kind, 60.0)).collect()
        }),
        (15, _) => Ok(vec![
            curves::distribution_figure(&FACETS[..1], &[0.2, 0.3, 0.4, 0.6]),
            curves::distribution_figure(&FACETS, &[0.3]),
        ]),
        (16, _) => Ok(vec![curves::masking_figure(&[0.0, 30.0, 60.0], 0.6)]),
        (17, _) => Ok(vec![
            curves::fresnel_figure(&metals()),
            curves::ramp_figure(&metals()),
            curves::ramp_figure(&metals()[..1]),
        ]),
        (18, _) => of_shelf(&|shelf, materials| vec![lobes::albedo_figure(shelf, materials)]),
        (19, "coupled") => of_shelf(&|shelf, materials| {
            let glossy = |index: &&usize| scene.materials[**index].model != Model::Lambert;
            vec![lobes::albedo_figure(shelf, &materials.iter().filter(glossy).copied().collect::<Vec<_>>())]
        }),
        (19, "anisotropy") => of_shelf(&|shelf, materials| {
            let rough = |index: &&usize| is_rough_metal(&scene.materials[**index]);
            vec![lobes::bodies_figure(shelf, &materials.iter().filter(rough).copied().collect::<Vec<_>>(), 45.0)]
        }),
        (19, "interreflection") => Ok(vec![before_and_after(scene)?]),
        (21, "directed") => Ok(vec![curves::spot_figure(&[1.0, 8.0, 64.0], 40.0)]),
        (23, "glass") => Ok(vec![curves::fresnel_figure(&[Interface::dielectric(1.5), Interface::dielectric(2.417)])]),
        (26, "zone-plate") => Ok(vec![curves::filter_figure()]),
        _ => Ok(Vec::new()),
    }
}

fn is_rough_metal(material: &Material) -> bool {
    matches!(material.model, Model::RoughConductor { .. })
}

/// The scene's first rough metal at any roughness, without and with what its facets send to each other.
fn before_and_after(scene: &Scene) -> Result<Figure, PlotError> {
    let metal = |compensated: bool, name: &str| {
        let mut metal = scene.materials.iter().find(|material| is_rough_metal(material)).cloned();
        if let Some(Model::RoughConductor { compensate, .. }) = metal.as_mut().map(|metal| &mut metal.model) {
            *compensate = compensated;
        }
        metal.map(|metal| Material { name: name.into(), ..metal })
    };
    let metals: Vec<Material> = metal(false, "before").into_iter().chain(metal(true, "after")).collect();
    lobes::albedo_by_roughness_figure(&metals, &[0.0, 60.0]).map_err(PlotError::new)
}

/// What is fitted to the scene's first measured material (row 10 beside row 9).
fn fits(scene: &Scene, shelf: &Shelf) -> Result<Vec<Figure>, PlotError> {
    let measured = |material: &Material| matches!(material.model, Model::Measured { .. });
    let Some(index) = scene.materials.iter().position(measured) else { return Ok(Vec::new()) };
    let fitting = fit(shelf, index, &FIT_MODELS.map(|(_, model)| model)).map_err(PlotError::new)?;
    Ok(vec![fit_figure(scene, index, &fitting, 45.0, true).map_err(PlotError::new)?])
}

/// Materials whose names begin with the same word before a comma, as in "copper, Phong"; those without a comma in none.
fn by_kind(names: &[String], materials: &[usize]) -> Vec<Vec<usize>> {
    let mut kinds: Vec<(&str, Vec<usize>)> = Vec::new();
    for &index in materials {
        let Some((kind, _)) = names[index].split_once(',') else { continue };
        match kinds.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, members)) => members.push(index),
            None => kinds.push((kind, vec![index])),
        }
    }
    kinds.into_iter().map(|(_, members)| members).collect()
}

fn metals() -> Vec<Interface> {
    let interface = |(name, metal): &(&str, crate::scene::load::toml::Metal)| match metal.fresnel() {
        Fresnel::Conductor { eta, k } => {
            Some(Interface { name: (*name).into(), kind: curves::InterfaceKind::Conductor { eta, k } })
        }
        _ => None,
    };
    METALS.iter().filter_map(interface).collect()
}

/// What the comment at the head of a scene file says, without the row it begins with.
pub fn caption(text: &str) -> String {
    let lines = text.lines().take_while(|line| line.starts_with('#'));
    let comment = lines.map(|line| line.trim_start_matches('#').trim()).collect::<Vec<_>>().join(" ");
    match comment.split_once(". ") {
        Some((head, rest)) if head.starts_with("Row") => rest.to_owned(),
        _ => comment,
    }
}
