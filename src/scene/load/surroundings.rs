//! What can stand around a scene without a file: a photographer's studio, an afternoon's sky, or white all around. The images
//! are computed here, with `libm`, so that they are the same bits everywhere.

use crate::scene::{Background, Environment, Rgb, Texture, TextureData, Transform, Wrap};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

/// Texels of an image: one is 0.7 degrees high and wide.
const SIZE: [u32; 2] = [512, 256];

/// The surroundings of our own making.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surroundings {
    /// A large soft box at the upper left, a weak one on the right, a narrow one behind, and grey walls.
    Studio,
    /// A clear sky with a sun at the upper left, over dull ground.
    Sky,
    /// Radiance 1 in every direction.
    White,
}

/// Names of the surroundings, as scene files and flags write them.
pub const NAMES: [(&str, Surroundings); 3] =
    [("studio", Surroundings::Studio), ("sky", Surroundings::Sky), ("white", Surroundings::White)];

impl Surroundings {
    /// By its name.
    pub fn from_name(name: &str) -> Option<Self> {
        NAMES.iter().find(|(known, _)| *known == name).map(|(_, surroundings)| *surroundings)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        NAMES.iter().find(|(_, known)| *known == self).map_or("", |(name, _)| name)
    }

    /// As a background of `scale` times its radiance, turned by `to_world`. Unturned, it is made for a viewer at +z. Adds an
    /// image to `textures` where there is one.
    pub fn background(self, textures: &mut Vec<Texture>, scale: Rgb, to_world: Transform) -> Background {
        // Computed once, however many scenes stand in them: that takes as long as reading a small model.
        static IMAGES: [OnceLock<Texture>; 2] = [OnceLock::new(), OnceLock::new()];
        let image = match self {
            Self::Studio => IMAGES[0].get_or_init(|| image(self.name(), studio)),
            Self::Sky => IMAGES[1].get_or_init(|| image(self.name(), sky)),
            Self::White => return Background::flat(scale),
        };
        let texture = super::texture_files::intern(textures, image.clone());
        Background::Image(Environment { texture, scale, to_world })
    }
}

/// A turn by `degrees` about +y, counter-clockwise seen from above, in thousandths of a degree: so `turn_of` finds it again.
pub fn turn(degrees: f64) -> Transform {
    Transform::rotate(Vec3::Y, thousandths(degrees).to_radians())
}

/// The degrees of a `turn`, -180 to 180.
pub fn turn_of(environment: &Environment) -> f64 {
    let z = environment.to_world.0.matrix3.z_axis;
    thousandths(libm::atan2(z.x, z.z).to_degrees())
}

fn thousandths(degrees: f64) -> f64 {
    // Turns beyond half of one would be found again as others.
    let degrees = degrees - 360.0 * libm::round(degrees / 360.0);
    libm::round(degrees * 1000.0) / 1000.0
}

/// The equirectangular image of `radiance`: its top row is +y, its centre +z, a quarter from the left +x.
fn image(name: &str, radiance: fn(DVec3) -> DVec3) -> Texture {
    let [width, height] = SIZE;
    let texel = |row: u32, column: u32| {
        let theta = PI * (f64::from(row) + 0.5) / f64::from(height);
        let phi = PI - 2.0 * PI * (f64::from(column) + 0.5) / f64::from(width);
        let (sine, cosine) = (libm::sin(theta), libm::cos(theta));
        let light = radiance(DVec3::new(sine * libm::sin(phi), cosine, sine * libm::cos(phi)));
        light.as_vec3().extend(1.0).to_array()
    };
    let texels = (0..height).flat_map(|row| (0..width).map(move |column| texel(row, column))).collect();
    let texture = Texture::new(name, width, height, TextureData::Float(Arc::new(texels)));
    Texture { wrap_v: Wrap::Clamp, ..texture }
}

/// Unit vector towards `azimuth` (from +z to +x) and `elevation`, radians.
pub(super) fn towards(azimuth: f64, elevation: f64) -> DVec3 {
    let c = libm::cos(elevation);
    DVec3::new(libm::sin(azimuth) * c, libm::sin(elevation), libm::cos(azimuth) * c)
}

/// 0 up to 0, 1 from 1 on, smooth between.
fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// A rectangle of light: where it is (degrees), tangents of its half angles to the sides and up, radiance.
struct SoftBox {
    azimuth: f64,
    elevation: f64,
    half: [f64; 2],
    radiance: f64,
}

const BOXES: [SoftBox; 3] = [
    // The key stands high, so that shadows are short and end soon.
    SoftBox { azimuth: -40.0, elevation: 56.0, half: [0.75, 0.6], radiance: 2.6 },
    SoftBox { azimuth: 82.0, elevation: 24.0, half: [0.4, 0.85], radiance: 0.35 },
    SoftBox { azimuth: 168.0, elevation: 36.0, half: [0.95, 0.24], radiance: 0.7 },
];

/// White paper that lies on the floor shows about 1. Below the horizon is what is seen behind models that stand on no ground.
fn studio(direction: DVec3) -> DVec3 {
    let up = direction.y;
    let walls = if up > 0.0 { 0.15 + 0.05 * smooth(up) } else { 0.1 + 0.05 * smooth(1.0 + up) };
    let boxes = BOXES.iter().map(|b| {
        let centre = towards(b.azimuth.to_radians(), b.elevation.to_radians());
        let right = towards((b.azimuth + 90.0).to_radians(), 0.0);
        let facing = direction.dot(centre);
        if facing < 0.05 {
            return 0.0;
        }
        let [x, y] = [right, centre.cross(right)].map(|axis| (direction.dot(axis) / facing).abs());
        // Its edge is soft over a tenth of its half width, so that reflections of it have no steps.
        let edge = |at: f64, half: f64| smooth((1.1 - at / half) / 0.2);
        b.radiance * edge(x, b.half[0]) * edge(y, b.half[1])
    });
    DVec3::splat(walls + boxes.sum::<f64>())
}

/// Pale at the horizon, blue above; the sun is ten times as wide as the real one, so that shadows have soft edges.
fn sky(direction: DVec3) -> DVec3 {
    let up = direction.y;
    if up < 0.0 {
        return DVec3::new(0.32, 0.30, 0.28) * (0.25 + 0.75 * smooth(1.0 + up * 4.0));
    }
    let haze = libm::exp(-up / 0.22);
    let air = DVec3::new(0.32, 0.60, 1.24).lerp(DVec3::new(1.24, 1.40, 1.60), haze);
    let sun = direction.dot(towards(-50.0_f64.to_radians(), 44.0_f64.to_radians())).clamp(-1.0, 1.0);
    let angle = libm::acos(sun).to_degrees();
    let disc = 236.0 * smooth((3.2 - angle) / 1.4);
    let glow = 1.0 * libm::exp(-angle / 9.0);
    air + DVec3::new(1.0, 0.93, 0.82) * (disc + glow)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::TextureId;

    /// Radiance of white paper on the floor: irradiance from above over pi.
    fn paper(radiance: fn(DVec3) -> DVec3) -> f64 {
        let texture = image("test", radiance);
        let TextureData::Float(texels) = &texture.data else { panic!("floats") };
        let (width, height) = (texture.width as usize, texture.height as usize);
        let mut sum = 0.0;
        for (index, texel) in texels.iter().enumerate() {
            let theta = PI * ((index / width) as f64 + 0.5) / height as f64;
            let cell = 2.0 * PI * PI / (width * height) as f64 * libm::sin(theta);
            sum += f64::from(texel[1]) * libm::cos(theta).max(0.0) * cell;
        }
        sum / PI
    }

    #[test]
    fn white_paper_is_white_in_the_studio_and_under_the_sky() {
        for (name, radiance) in [("studio", studio as fn(DVec3) -> DVec3), ("sky", sky)] {
            let shown = paper(radiance);
            assert!((0.8..1.25).contains(&shown), "{name}: {shown}");
        }
    }

    #[test]
    fn key_and_sun_stand_at_the_upper_left_of_who_looks_from_the_front() {
        for radiance in [studio as fn(DVec3) -> DVec3, sky] {
            let left = radiance(towards(-45.0_f64.to_radians(), 50.0_f64.to_radians())).y;
            let right = radiance(towards(45.0_f64.to_radians(), 50.0_f64.to_radians())).y;
            let below = radiance(DVec3::NEG_Y).y;
            assert!(left > right && right > below && below > 0.0, "{left} {right} {below}");
        }
        let texture = image("test", |direction| direction);
        let TextureData::Float(texels) = &texture.data else { panic!("floats") };
        let at = |column: usize, row: usize| texels[row * 512 + column];
        assert!(at(256, 128)[2] > 0.99 && at(128, 128)[0] > 0.99 && at(0, 0)[1] > 0.99);
    }

    #[test]
    fn a_turn_is_found_again() {
        for degrees in [0.0, 30.0, -179.999, 12.3456, 720.25, -540.5] {
            let environment = Environment { texture: TextureId(0), scale: Rgb::ONE, to_world: turn(degrees) };
            assert_eq!(turn(turn_of(&environment)), environment.to_world, "{degrees}");
        }
    }

    #[test]
    fn names_lead_there_and_back() {
        assert!(NAMES.iter().all(|(name, it)| Surroundings::from_name(name) == Some(*it) && it.name() == *name));
        assert_eq!(Surroundings::from_name("night"), None);
    }
}
