//! The lowest place of a function of a few numbers, without its derivatives.
//!
//! Source: Nelder and Mead 1965, "A Simplex Method for Function Minimization".

/// A place and the value there.
type Vertex = (Vec<f64>, f64);

/// Evaluations at most.
const MOST: usize = 400;
/// The simplex is small enough once no vertex differs from the lowest by more in any number.
const SMALL: f64 = 1e-5;

/// A local minimum of `value` near `start`, searched in steps of about `step`; NaN counts as infinitely high.
pub fn minimise(start: &[f64], step: f64, value: impl Fn(&[f64]) -> f64) -> Vertex {
    let mut calls = 0;
    let mut at = |place: Vec<f64>| {
        calls += 1;
        let height = value(&place);
        ((place, if height.is_nan() { f64::INFINITY } else { height }), calls < MOST)
    };
    let mut vertices: Vec<Vertex> = vec![at(start.to_vec()).0];
    for i in 0..start.len() {
        let mut place = start.to_vec();
        place[i] += step;
        vertices.push(at(place).0);
    }
    loop {
        vertices.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (last, rest) = vertices.split_last_mut().expect("one vertex more than numbers");
        let lowest = &rest[0];
        let spread = |vertex: &Vertex| vertex.0.iter().zip(&lowest.0).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if spread(last) < SMALL && rest.iter().all(|vertex| spread(vertex) < SMALL) {
            break;
        }
        let centre: Vec<f64> =
            (0..start.len()).map(|i| rest.iter().map(|v| v.0[i]).sum::<f64>() / rest.len() as f64).collect();
        // `t` from the centre, -1 being the last vertex itself.
        let along =
            |last: &Vertex, t: f64| centre.iter().zip(&last.0).map(|(c, l)| c + t * (c - l)).collect::<Vec<_>>();
        let (reflected, more) = at(along(last, 1.0));
        if !more {
            break;
        }
        let (highest_kept, lowest) = (rest[rest.len() - 1].1, rest[0].1);
        if reflected.1 < lowest {
            let (expanded, _) = at(along(last, 2.0));
            *last = if expanded.1 < reflected.1 { expanded } else { reflected };
        } else if reflected.1 < highest_kept {
            *last = reflected;
        } else {
            let (contracted, _) = at(along(last, if reflected.1 < last.1 { 0.5 } else { -0.5 }));
            if contracted.1 < last.1.min(reflected.1) {
                *last = contracted;
            } else {
                let lowest = vertices[0].0.clone();
                for vertex in &mut vertices[1..] {
                    let half = vertex.0.iter().zip(&lowest).map(|(v, l)| 0.5 * (v + l)).collect();
                    *vertex = at(half).0;
                }
            }
        }
    }
    vertices.swap_remove(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bottom_of_a_curved_valley_is_found() {
        // Rosenbrock 1960.
        let valley = |p: &[f64]| 100.0 * (p[1] - p[0] * p[0]).powi(2) + (1.0 - p[0]).powi(2);
        let (place, value) = minimise(&[-1.2, 1.0], 0.5, valley);
        assert!((place[0] - 1.0).abs() < 1e-3 && (place[1] - 1.0).abs() < 1e-3, "{place:?}");
        assert!(value < 1e-6);
        let (place, _) = minimise(&[3.0], 1.0, |p| (p[0] + 0.25).abs());
        assert!((place[0] + 0.25).abs() < 1e-4, "{place:?}");
    }

    #[test]
    fn where_there_is_no_number_is_no_minimum_and_a_plain_ends_the_search() {
        let (place, _) = minimise(&[2.0], 1.0, |p| if p[0] > 1.0 { p[0] } else { f64::NAN });
        assert!((place[0] - 1.0).abs() < 1e-3, "{place:?}");
        assert_eq!(minimise(&[2.0, 3.0], 1.0, |_| 1.0).1, 1.0);
    }
}
