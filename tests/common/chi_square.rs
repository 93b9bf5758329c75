//! Pearson's chi-square test for samplers of directions, a generator of random numbers, and quadrature over directions.
#![allow(dead_code, reason = "each test binary uses its own part")]

use glam::{Vec2, Vec3};
use gonio::layout::SceneView;
use gonio::shading::bsdf::{BsdfSample, SAMPLE_DELTA};
use gonio::shading::closure::Closure;
use gonio::shading::material::{pdf_closure, sample_closure};

/// Random numbers for tests: SplitMix64 (Steele, Lea and Flood 2014), the same on every machine.
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1), 24 bits.
    pub fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / 16_777_216.0
    }

    pub fn unit2(&mut self) -> Vec2 {
        Vec2::new(self.unit(), self.unit())
    }

    /// Uniform over the upper hemisphere, unit to rounding.
    pub fn upper_direction(&mut self) -> Vec3 {
        let z = f64::from(self.unit());
        let phi = std::f64::consts::TAU * f64::from(self.unit());
        direction(z, phi)
    }
}

/// The unit vector of cosine `z` and azimuth `phi` in radians.
pub fn direction(z: f64, phi: f64) -> Vec3 {
    let sin = libm::sqrt((1.0 - z * z).max(0.0));
    Vec3::new((sin * libm::cos(phi)) as f32, (sin * libm::sin(phi)) as f32, z as f32)
}

/// Outcome of a chi-square test.
#[derive(Clone, Copy, Debug)]
pub struct ChiSquare {
    pub statistic: f64,
    pub degrees_of_freedom: usize,
    /// Probability of a statistic at least this large if the samples follow the density.
    pub p_value: f64,
}

/// Compares counts with expected counts, cell by cell. Cells expecting fewer than 5 are pooled.
pub fn chi_square(observed: &[u64], expected: &[f64]) -> ChiSquare {
    assert_eq!(observed.len(), expected.len());
    let mut order: Vec<usize> = (0..expected.len()).collect();
    order.sort_by(|&a, &b| expected[a].total_cmp(&expected[b]));
    let (mut statistic, mut cells) = (0.0, 0usize);
    let (mut pooled_observed, mut pooled_expected) = (0.0, 0.0);
    for &i in &order {
        pooled_observed += observed[i] as f64;
        pooled_expected += expected[i];
        if pooled_expected >= 5.0 {
            statistic += (pooled_observed - pooled_expected).powi(2) / pooled_expected;
            cells += 1;
            (pooled_observed, pooled_expected) = (0.0, 0.0);
        }
    }
    // What is left expects fewer than 5 in all; many counts there are wrong whatever the rest says.
    if pooled_observed > 30.0 {
        statistic = f64::INFINITY;
    }
    let degrees_of_freedom = cells.saturating_sub(1);
    assert!(degrees_of_freedom > 0, "too few samples for any cell");
    ChiSquare { statistic, degrees_of_freedom, p_value: upper_gamma(0.5 * degrees_of_freedom as f64, 0.5 * statistic) }
}

/// Significance of one of `count` tests so that the chance of any false alarm is `overall` (Sidak 1967).
pub fn sidak(overall: f64, count: usize) -> f64 {
    1.0 - libm::pow(1.0 - overall, 1.0 / count as f64)
}

/// Regularised upper incomplete gamma function Q(a, x).
/// Source: Press et al. 2007, "Numerical Recipes", section 6.2: series below a + 1, Lentz's continued fraction above.
pub fn upper_gamma(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    if !x.is_finite() {
        return 0.0;
    }
    let front = libm::exp(a * libm::log(x) - x - libm::lgamma(a));
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-15 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return 1.0 - front * sum;
    }
    let mut b = x + 1.0 - a;
    let mut c = 1e300;
    let mut d = 1.0 / b;
    let mut h = d;
    for i in 1..100_000 {
        let an = -f64::from(i) * (f64::from(i) - a);
        b += 2.0;
        d = 1.0 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (d * c - 1.0).abs() < 1e-15 {
            break;
        }
    }
    front * h
}

/// Integral over the part `z0..z1`, `phi0..phi1` of the sphere: Gauss's three points on `parts` x `parts` subcells.
pub fn integrate_cell(f: &dyn Fn(Vec3) -> f64, (z0, z1): (f64, f64), (phi0, phi1): (f64, f64), parts: usize) -> f64 {
    const POINTS: [(f64, f64); 3] =
        [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];
    let (dz, dphi) = ((z1 - z0) / parts as f64, (phi1 - phi0) / parts as f64);
    let mut sum = 0.0;
    for i in 0..parts {
        for j in 0..parts {
            for (x, wx) in POINTS {
                for (y, wy) in POINTS {
                    let z = z0 + dz * (i as f64 + 0.5 + 0.5 * x);
                    let phi = phi0 + dphi * (j as f64 + 0.5 + 0.5 * y);
                    sum += wx * wy * f(direction(z, phi));
                }
            }
        }
    }
    sum * 0.25 * dz * dphi
}

/// Integral over the upper hemisphere.
pub fn integrate_hemisphere(f: &dyn Fn(Vec3) -> f64, parts: usize) -> f64 {
    integrate_cell(f, (0.0, 1.0), (0.0, std::f64::consts::TAU), parts)
}

/// Cells in cosine and azimuth of the upper hemisphere, and one for samples that were dropped.
const Z_CELLS: usize = 24;
const PHI_CELLS: usize = 48;

/// Tests a sampler of the upper hemisphere against its density. `sample` returns None for a dropped sample; the share
/// of those must be 1 minus the density's integral. Also returns that integral.
pub fn test_sampler(samples: u32, sample: impl FnMut() -> Option<Vec3>, pdf: &dyn Fn(Vec3) -> f64) -> (ChiSquare, f64) {
    test_cells(0, samples, sample, pdf)
}

/// Tests a sampler of directions whose cosine is at least -`below` / `Z_CELLS`.
fn test_cells(
    below: usize,
    samples: u32,
    mut sample: impl FnMut() -> Option<Vec3>,
    pdf: &dyn Fn(Vec3) -> f64,
) -> (ChiSquare, f64) {
    let tau = std::f64::consts::TAU;
    let rows = below + Z_CELLS;
    let mut observed = vec![0u64; rows * PHI_CELLS + 1];
    for _ in 0..samples {
        let cell = match sample() {
            Some(w) => {
                let z = ((f64::from(w.z) * Z_CELLS as f64 + below as f64) as usize).min(rows - 1);
                let turn = libm::atan2(f64::from(w.y), f64::from(w.x)) / tau;
                let phi = (((turn - turn.floor()) * PHI_CELLS as f64) as usize).min(PHI_CELLS - 1);
                z * PHI_CELLS + phi
            }
            None => rows * PHI_CELLS,
        };
        observed[cell] += 1;
    }
    let mut expected = vec![0.0; rows * PHI_CELLS + 1];
    let mut integral = 0.0;
    for z in 0..rows {
        for phi in 0..PHI_CELLS {
            let z_range = [z, z + 1].map(|z| (z as f64 - below as f64) / Z_CELLS as f64);
            let phi_range = [phi, phi + 1].map(|phi| tau * phi as f64 / PHI_CELLS as f64);
            let part = integrate_cell(pdf, z_range.into(), phi_range.into(), 3);
            integral += part;
            expected[z * PHI_CELLS + phi] = part * f64::from(samples);
        }
    }
    expected[rows * PHI_CELLS] = (1.0 - integral).max(0.0) * f64::from(samples);
    (chi_square(&observed, &expected), integral)
}

/// Draws of `sample_closure` for one viewer.
pub struct Draws<'a> {
    view: SceneView<'a>,
    closure: Closure,
    wo: Vec3,
    samples: Vec<BsdfSample>,
}

/// The mean of a number over draws, its standard error, and the deviation of a single one.
#[derive(Clone, Copy, Debug)]
pub struct Mean {
    pub value: f64,
    pub error: f64,
    pub deviation: f64,
}

impl<'a> Draws<'a> {
    pub fn new(view: SceneView<'a>, closure: Closure, wo: Vec3, count: usize) -> Self {
        let mut random = Random(17);
        let draw = |_| sample_closure(&view, &closure, wo, random.unit2(), random.unit());
        Self { samples: (0..count).map(draw).collect(), view, closure, wo }
    }

    /// How many went into a lobe of zero width.
    pub fn deltas(&self) -> usize {
        self.samples.iter().filter(|sample| sample.flags & SAMPLE_DELTA != 0).count()
    }

    /// The draws against `pdf_closure` over the sphere, those of lobes of zero width counted as dropped; and its integral.
    pub fn against_density(&self) -> (ChiSquare, f64) {
        let mut samples = self.samples.iter();
        let kept = |sample: &BsdfSample| sample.pdf > 0.0 && sample.flags & SAMPLE_DELTA == 0;
        let next = || samples.next().filter(|sample| kept(sample)).map(|sample| sample.wi);
        let pdf = |wi| f64::from(pdf_closure(&self.view, &self.closure, self.wo, wi));
        test_cells(Z_CELLS, self.samples.len() as u32, next, &pdf)
    }

    /// The mean of `weight` over all draws, dropped ones counted as 0.
    pub fn mean(&self, weight: impl Fn(&BsdfSample) -> f64) -> Mean {
        let (mut sum, mut squares) = (0.0, 0.0);
        for sample in self.samples.iter().filter(|sample| sample.pdf > 0.0) {
            let w = weight(sample);
            (sum, squares) = (sum + w, squares + w * w);
        }
        let count = self.samples.len() as f64;
        let value = sum / count;
        let deviation = libm::sqrt((squares / count - value * value).max(0.0));
        Mean { value, error: deviation / libm::sqrt(count), deviation }
    }
}
