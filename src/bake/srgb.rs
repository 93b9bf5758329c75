//! The table that turns sRGB-encoded bytes into linear values.

/// Linear value of each byte 0..255, 0..1: the first 256 entries of the table array.
/// Computed in double precision with libm, so that every machine has the same bits.
/// Source: IEC 61966-2-1:1999, section 5.2.
pub fn srgb_table() -> Vec<f32> {
    (0..256)
        .map(|byte| {
            let encoded = f64::from(byte) / 255.0;
            let linear = if encoded <= 0.040_45 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) };
            linear as f32
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_srgb_table_has_the_standards_values() {
        let table = srgb_table();
        assert_eq!(table.len(), 256);
        assert_eq!((table[0], table[255]), (0.0, 1.0));
        // The last byte of the straight part and the first of the curve: 10/255 and 11/255 lie on either side of .04045.
        assert!((f64::from(table[10]) - 10.0 / 255.0 / 12.92).abs() < 1e-9);
        assert!((f64::from(table[11]) - 0.003_346_535_8).abs() < 1e-9);
        assert!((f64::from(table[128]) - 0.215_860_5).abs() < 1e-7);
        assert!(table.windows(2).all(|pair| pair[0] < pair[1]));
    }
}
