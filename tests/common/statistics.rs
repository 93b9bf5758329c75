//! Means of noisy pictures, and how far they may lie from what is expected.
#![allow(dead_code, reason = "each test binary uses its own part")]

/// A mean and its standard error.
#[derive(Clone, Copy, Debug)]
pub struct Mean {
    pub value: f64,
    pub error: f64,
}

impl Mean {
    /// Of values that are independent of one another.
    pub fn of(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let value = values.iter().sum::<f64>() / count;
        let variance = values.iter().map(|v| (v - value) * (v - value)).sum::<f64>() / (count - 1.0);
        Self { value, error: (variance / count).sqrt() }
    }

    /// Of a channel over a picture.
    pub fn of_channel(pixels: &[[f32; 4]], channel: usize) -> Self {
        Self::of(&pixels.iter().map(|pixel| f64::from(pixel[channel])).collect::<Vec<f64>>())
    }

    /// Fails beyond five standard errors, one in two million, and `rounding` of the wanted value.
    #[track_caller]
    pub fn assert_is(self, wanted: f64, rounding: f64, what: &str) {
        let tolerance = 5.0 * self.error + rounding * wanted;
        assert!((self.value - wanted).abs() <= tolerance, "{what}: {self:?} instead of {wanted}");
    }
}
