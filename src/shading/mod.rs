//! Light at a point: mathematics, sampling, models, lights, textures, camera; twins in `shaders/shading/`.
//!
//! Conventions of light:
//!
//! * Directions `wo` (to the viewer), `wi` (to the light), `wm` (microfacet normal) are unit and leave the surface.
//! * Local frame: z is the shading normal. `cos_theta(w) = w.z`.
//! * `eval_x(material, wo, wi)` returns BSDF times cosine (|wi.z|), per steradian; for models of one side zero unless wo
//!   and wi are on the upper side. Lobes of zero width add nothing to it.
//! * `sample_x(material, wo, u)` returns a direction and its pdf (`BsdfSample`: with f |cos| / pdf and what kind it is);
//!   `pdf_x(material, wo, wi)` is per solid angle.
//! * Radiance is carried, not importance: transmission into index eta scales it by 1 / eta^2.
//! * Radiometric units: a light gives `LightSample.radiance` = the factor L such that outgoing radiance is `eval * L`
//!   (intensity times attenuation). Phong as printed, I = k_s I_p (V.R)^n with I_p = intensity / pi, is
//!   `eval = k_s O_s (V.R)^n / pi`; the lecture's k_d I_p (N.L) is `k_d O_d / pi * cos`.
//! * `eta` = index on the transmitted side over index on the incident side only in `Refraction` results; in records it
//!   is the index of the medium relative to the outside.
//! * `roughness` is what users write; `alpha`/`m` is what distributions take.
//! * `Spectrum` is `vec4`/`Vec4`: lanes 0-2 are linear Rec. 709 in RGB mode, lane 3 is 0.

pub mod albedo;
pub mod ashikhmin;
pub mod blinn_phong;
pub mod bsdf;
pub mod camera;
pub mod closure;
pub mod cook_torrance;
pub mod coordinate;
pub mod delta;
pub mod dielectric;
pub mod distribution;
pub mod environment;
pub mod eon;
pub mod filter;
pub mod footprint;
pub mod frame;
pub mod fresnel;
pub mod interior;
pub mod kelemen;
pub mod lambert;
pub mod light;
pub mod lobe;
pub mod material;
pub mod math;
pub mod measured;
pub mod microfacet;
pub mod oren_nayar;
pub mod parameter;
pub mod pattern;
pub mod phong;
pub mod plastic;
pub mod principled;
pub mod rough_conductor;
pub mod rough_dielectric;
pub mod sampling;
pub mod slide;
pub mod spectrum;
pub mod tabulated;
pub mod texture;
pub mod ward;
pub mod warp;
