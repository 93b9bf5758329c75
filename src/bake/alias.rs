//! Walker's alias method: a choice in proportion to weights by one look-up.

/// Fractions of a cell that choose the cell itself, and what the rest chooses instead.
#[derive(Clone, Debug, PartialEq)]
pub struct AliasTable {
    pub thresholds: Vec<f32>,
    pub aliases: Vec<u32>,
}

/// The table of `probabilities`, which add up to 1. Source: Vose 1991, "A Linear Algorithm For Generating Random Numbers
/// With a Given Distribution". In double precision; thresholds are rounded once, so the probability of an entry is off by
/// at most 2^-25 / n for each of the cells that choose it.
pub fn alias_table(probabilities: &[f64]) -> AliasTable {
    let count = probabilities.len();
    let mut rest: Vec<f64> = probabilities.iter().map(|p| p * count as f64).collect();
    let mut table = AliasTable { thresholds: vec![1.0; count], aliases: (0..count as u32).collect() };
    let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..count).partition(|&i| rest[i] < 1.0);
    while let (Some(&poor), Some(&rich)) = (small.last(), large.last()) {
        small.pop();
        table.thresholds[poor] = rest[poor] as f32;
        table.aliases[poor] = rich as u32;
        rest[rich] -= 1.0 - rest[poor];
        if rest[rich] < 1.0 {
            large.pop();
            small.push(rich);
        }
    }
    // What remains is full up to rounding.
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shares(table: &AliasTable) -> Vec<f64> {
        let count = table.thresholds.len();
        let mut shares = vec![0.0; count];
        for (i, (&threshold, &alias)) in table.thresholds.iter().zip(&table.aliases).enumerate() {
            shares[i] += f64::from(threshold) / count as f64;
            shares[alias as usize] += (1.0 - f64::from(threshold)) / count as f64;
        }
        shares
    }

    #[test]
    fn every_entry_keeps_its_probability() {
        for count in [1usize, 2, 3, 7, 1000] {
            for kind in 0..3 {
                let weight = |i: usize| match kind {
                    0 => 1.0,
                    1 => (i + 1) as f64,
                    _ => libm::exp(-(i as f64) * 0.7),
                };
                let total: f64 = (0..count).map(weight).sum();
                let wanted: Vec<f64> = (0..count).map(|i| weight(i) / total).collect();
                for (i, (found, wanted)) in shares(&alias_table(&wanted)).iter().zip(&wanted).enumerate() {
                    // An entry is chosen from n cells at most, each threshold rounded to 2^-25.
                    assert!((found - wanted).abs() <= 3.0e-8, "{i} of {count}: {found} instead of {wanted}");
                }
            }
        }
    }

    #[test]
    fn what_has_no_probability_is_never_chosen() {
        let table = alias_table(&[0.0, 0.5, 0.0, 0.5]);
        assert_eq!(shares(&table), [0.0, 0.5, 0.0, 0.5]);
    }
}
