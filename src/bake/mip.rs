//! Mip chains: each level half as large as the last, by a box filter in linear light.

use crate::scene::TextureData;
use rayon::prelude::*;
use std::sync::Arc;

/// A level's size and texels.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    pub width: u32,
    pub height: u32,
    pub data: TextureData,
}

/// An image in single precision, linear.
struct Linear {
    width: usize,
    height: usize,
    texels: Vec<[f32; 4]>,
}

/// Levels 1 and up of an image, down to a single texel. Averages are taken of what was not yet rounded to bytes.
/// `table`: linear values of sRGB-encoded bytes.
pub fn mip_levels(width: u32, height: u32, data: &TextureData, table: &[f32]) -> Vec<Level> {
    let mut levels = Vec::new();
    let mut linear = match data {
        TextureData::Srgb8(texels) => {
            let decode = |c: u8| table[usize::from(c)];
            let texel = |[r, g, b, a]: [u8; 4]| [decode(r), decode(g), decode(b), f32::from(a) / 255.0];
            halve(width as usize, height as usize, |at| texel(texels[at]))
        }
        TextureData::Linear8(texels) => {
            halve(width as usize, height as usize, |at| texels[at].map(|c| f32::from(c) / 255.0))
        }
        TextureData::Float(texels) => halve(width as usize, height as usize, |at| texels[at]),
        TextureData::Pattern(_) => return levels,
    };
    while let Some(level) = linear {
        linear = halve(level.width, level.height, |at| level.texels[at]);
        let (width, height) = (level.width as u32, level.height as u32);
        levels.push(Level { width, height, data: encode(level, data, table) });
    }
    levels
}

/// What of a row of `size` falls to each of the `half` parts it is divided into: first index and weights.
/// An odd size divides texels in the middle, so that every texel counts alike.
fn shares(size: usize, half: usize) -> Vec<(usize, Vec<f64>)> {
    (0..half)
        .map(|part| {
            // In units of 1 / half of a texel.
            let (begin, end) = (part * size, (part + 1) * size);
            let (first, last) = (begin / half, end.div_ceil(half));
            let weight = |i: usize| ((i + 1) * half).min(end) - (i * half).max(begin);
            (first, (first..last).map(|i| weight(i) as f64 / size as f64).collect())
        })
        .collect()
}

/// The next level; none after a single texel.
fn halve(width: usize, height: usize, texel: impl Fn(usize) -> [f32; 4] + Sync) -> Option<Linear> {
    if width <= 1 && height <= 1 {
        return None;
    }
    let (half_width, half_height) = ((width / 2).max(1), (height / 2).max(1));
    let columns = shares(width, half_width);
    let rows = shares(height, half_height);
    let mean = |(first_column, column_weights): &(usize, Vec<f64>), (first_row, row_weights): &(usize, Vec<f64>)| {
        let mut sum = [0.0f64; 4];
        for (j, row_weight) in row_weights.iter().enumerate() {
            for (i, column_weight) in column_weights.iter().enumerate() {
                let value = texel((first_row + j) * width + first_column + i);
                for lane in 0..4 {
                    sum[lane] += row_weight * column_weight * f64::from(value[lane]);
                }
            }
        }
        sum.map(|v| v as f32)
    };
    let mut texels = vec![[0.0; 4]; half_width * half_height];
    texels.par_chunks_mut(half_width).zip(&rows).for_each(|(out, row)| {
        out.iter_mut().zip(&columns).for_each(|(out, column)| *out = mean(column, row));
    });
    Some(Linear { width: half_width, height: half_height, texels })
}

/// The level as the image stores its texels.
fn encode(level: Linear, like: &TextureData, table: &[f32]) -> TextureData {
    let byte = |v: f32| (v * 255.0 + 0.5).clamp(0.0, 255.0) as u8;
    match like {
        TextureData::Srgb8(_) => {
            let thresholds: Vec<f32> = (0..255).map(|code| srgb_midpoint(code, table)).collect();
            let code = |v: f32| thresholds.partition_point(|&t| t <= v) as u8;
            let encoded = level.texels.par_iter().map(|&[r, g, b, a]| [code(r), code(g), code(b), byte(a)]);
            TextureData::Srgb8(Arc::new(encoded.collect()))
        }
        TextureData::Linear8(_) => {
            TextureData::Linear8(Arc::new(level.texels.par_iter().map(|texel| texel.map(byte)).collect()))
        }
        TextureData::Float(_) | TextureData::Pattern(_) => TextureData::Float(Arc::new(level.texels)),
    }
}

/// Linear values from here on are nearer to `code` + 1 than to `code`.
fn srgb_midpoint(code: usize, table: &[f32]) -> f32 {
    ((f64::from(table[code]) + f64::from(table[code + 1])) * 0.5) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bake::srgb::srgb_table;

    fn levels(width: u32, height: u32, data: TextureData) -> Vec<Level> {
        mip_levels(width, height, &data, &srgb_table())
    }

    #[test]
    fn a_chain_halves_both_sides_down_to_one_texel() {
        let data = TextureData::Float(Arc::new(vec![[0.25; 4]; 7 * 3]));
        let chain = levels(7, 3, data);
        assert_eq!(chain.iter().map(|l| (l.width, l.height)).collect::<Vec<_>>(), [(3, 1), (1, 1)]);
        for level in chain {
            let TextureData::Float(texels) = level.data else { panic!("another format") };
            assert!(texels.iter().flatten().all(|v| (v - 0.25).abs() < 1e-7), "{texels:?}");
        }
        assert!(levels(1, 1, TextureData::Linear8(Arc::new(vec![[9; 4]]))).is_empty());
    }

    #[test]
    fn every_texel_of_an_odd_image_counts_alike() {
        // One bright texel anywhere in 5 x 1 leaves a fifth of it in the single texel at the end.
        for at in 0..5 {
            let mut texels = vec![[0.0; 4]; 5];
            texels[at] = [1.0; 4];
            let chain = levels(5, 1, TextureData::Float(Arc::new(texels)));
            let TextureData::Float(last) = &chain.last().unwrap().data else { panic!("another format") };
            assert!((last[0][0] - 0.2).abs() < 1e-7, "texel {at}: {last:?}");
        }
        let shares = shares(5, 2);
        assert_eq!(shares[0], (0, vec![0.4, 0.4, 0.2]));
        assert_eq!(shares[1], (2, vec![0.2, 0.4, 0.4]));
    }

    #[test]
    fn encoded_colours_are_averaged_in_linear_light() {
        // Black and white make 0.5 in linear light, which is 188 in sRGB and not 128; alpha is linear as it is.
        let data = TextureData::Srgb8(Arc::new(vec![[0, 0, 0, 0], [255, 255, 255, 255]]));
        let chain = levels(2, 1, data);
        assert_eq!(chain[0].data, TextureData::Srgb8(Arc::new(vec![[188, 188, 188, 128]])));
        let data = TextureData::Linear8(Arc::new(vec![[0; 4], [255; 4]]));
        assert_eq!(levels(2, 1, data)[0].data, TextureData::Linear8(Arc::new(vec![[128; 4]])));
    }

    #[test]
    fn every_byte_survives_its_own_average() {
        for code in 0..=255u8 {
            let chain = levels(2, 2, TextureData::Srgb8(Arc::new(vec![[code, 255 - code, code, code]; 4])));
            assert_eq!(chain[0].data, TextureData::Srgb8(Arc::new(vec![[code, 255 - code, code, code]])));
        }
    }
}
