//! A scene's report as text.

use super::report::{Report, RunsOn, SceneReport};
use super::run::Plan;
use super::stats::Rate;
use std::fmt::Write as _;

/// What was measured, and how often.
pub struct Table<'a> {
    pub plan: Plan,
    /// An earlier run to compare with.
    pub baseline: Option<&'a Report>,
}

impl Table<'_> {
    /// The whole block of a scene, ending in a new line.
    pub fn scene(&self, report: &SceneReport) -> String {
        let mut text = head(report);
        for setup in &report.setup {
            let (upload, compile) = (setup.setup.upload_s, setup.setup.compile_s);
            line(
                &mut text,
                format_args!("  {}: upload {upload:.2} s, compile {compile:.2} s, both excluded below", setup.on),
            );
        }
        for rays in &report.rays {
            let share = 100.0 * rays.hits as f64 / (rays.rays as f64).max(1.0);
            let count = grouped(rays.rays);
            line(&mut text, format_args!("  {:<10} {count} rays, {share:.1} % hit", rays.kind.name()));
            self.results(&mut text, report, rays.kind.name(), rays.rays, &rays.results, "Mrays/s");
        }
        if !report.rays.is_empty() {
            verdict(
                &mut text,
                "hits",
                report.rays.iter().flat_map(|rays| rays.results.iter().map(|r| (rays.kind.name(), r))),
            );
        }
        for image in &report.images {
            line(&mut text, format_args!("  {:<10} {} samples", image.integrator, grouped(image.samples)));
            self.results(&mut text, report, &image.integrator, image.samples, &image.results, "Msamples/s");
        }
        if !report.images.is_empty() {
            let results =
                report.images.iter().flat_map(|image| image.results.iter().map(|r| (image.integrator.as_str(), r)));
            verdict(&mut text, "films", results);
        }
        text
    }

    fn results(
        &self,
        text: &mut String,
        report: &SceneReport,
        what: &str,
        amount: u64,
        results: &[RunsOn],
        unit: &str,
    ) {
        let width = results.iter().map(|result| result.on.len()).max().unwrap_or(0);
        for result in results {
            let rate = result.rate(amount);
            let mut row = format!("    {:<width$}  {}", result.on, self.rate(&rate, unit));
            if result.device_s.is_some() {
                let wall = Rate::of(amount as f64, &result.wall_s);
                let _ = write!(row, "; wall {} ({})", mega(wall.median), range(&wall));
            }
            if let Some(share) = &result.kernel_share {
                let _ = write!(row, "; {:.0} % in traversal and shading", 100.0 * share.median());
            }
            let before = self.baseline.and_then(|baseline| baseline.rate(&report.scene, what, &result.on));
            if let Some(before) = before.filter(|before| *before > 0.0) {
                let _ = write!(row, "; x{:.3} of the baseline", rate.median / before);
            }
            line(text, format_args!("{row}"));
        }
    }

    /// `median 412 Mrays/s (398-420, n = 10, 1 warm-up)`.
    fn rate(&self, rate: &Rate, unit: &str) -> String {
        let Plan { runs, warmup } = self.plan;
        format!("median {} {unit} ({}, n = {runs}, {warmup} warm-up)", mega(rate.median), range(rate))
    }

    /// Runs of a scene that should not be trusted, one sentence each.
    pub fn warnings(&self, report: &SceneReport) -> Vec<String> {
        let rays = report.rays.iter().flat_map(|rays| rays.results.iter().map(|result| (rays.kind.name(), result)));
        let images = report
            .images
            .iter()
            .flat_map(|image| image.results.iter().map(|result| (image.integrator.as_str(), result)));
        let of = |(what, result): (&str, &RunsOn)| {
            let runs = result.best();
            let outliers = runs.outliers();
            let first = outliers.first()?;
            let remedy = match self.plan.warmup {
                0 => "the first runs fill caches: use --warmup",
                _ if *first == 0 => "caches may still have been cold: raise --warmup",
                _ => "something else may have been running: repeat on a quiet machine",
            };
            Some(format!(
                "{}, {what} on {}: {} of {} runs are outliers (run {} took {:.4} s, the median is {:.4} s); {remedy}",
                report.scene,
                result.on,
                outliers.len(),
                runs.0.len(),
                first + 1,
                runs.0[*first],
                runs.median()
            ))
        };
        rays.chain(images).filter_map(of).collect()
    }
}

fn head(report: &SceneReport) -> String {
    let (size, bake) = (&report.size, &report.bake);
    let mut text = String::new();
    line(
        &mut text,
        format_args!(
            "{}: {}x{}, {} triangles, {} instances ({} primitives placed), {} nodes, SAH cost {:.1}",
            report.scene,
            report.width,
            report.height,
            grouped(size.triangles),
            grouped(size.instances),
            grouped(size.placed),
            grouped(size.nodes),
            size.sah
        ),
    );
    let peak = report.peak_bytes.map_or(String::new(), |bytes| format!("; peak {}", megabytes(bytes)));
    let arrays = size.node_bytes + size.triangle_bytes + size.data_bytes;
    let baking = |bytes| format!("; baking {} ({:.2} times that)", megabytes(bytes), bytes as f64 / arrays as f64);
    let baking = report.bake_bytes.map_or(String::new(), baking);
    line(
        &mut text,
        format_args!(
            "  memory: nodes {}, triangles {}, other {}{baking}{peak}",
            megabytes(size.node_bytes),
            megabytes(size.triangle_bytes),
            megabytes(size.data_bytes)
        ),
    );
    line(
        &mut text,
        format_args!(
            "  load {:.3} s; bake {:.3} s (materials {:.3}, geometry {:.3}, binary tree {:.3}, wide tree {:.3}, top level {:.3}, packing {:.3})",
            report.load_s,
            bake.whole_s,
            bake.materials_s,
            bake.geometry_s,
            bake.binary_s,
            bake.wide_s,
            bake.top_s,
            bake.pack_s
        ),
    );
    text
}

/// `hits: equal`, or which are not and the first that is not.
fn verdict<'a>(text: &mut String, what: &str, results: impl Iterator<Item = (&'a str, &'a RunsOn)>) {
    let mut equal = true;
    for (kind, result) in results.filter(|(_, result)| result.differ > 0) {
        equal = false;
        let first = result.first.as_deref().unwrap_or("unknown");
        line(text, format_args!("  {what}: {} differ ({kind} on {}), the first is {first}", result.differ, result.on));
    }
    if equal {
        line(text, format_args!("  {what}: equal"));
    }
}

fn line(text: &mut String, arguments: std::fmt::Arguments) {
    let _ = writeln!(text, "{arguments}"); // a String takes everything
}

/// Millions, three significant digits.
fn mega(rate: f64) -> String {
    let millions = rate * 1e-6;
    let digits = if millions >= 100.0 {
        0
    } else if millions >= 10.0 {
        1
    } else if millions >= 1.0 {
        2
    } else {
        3
    };
    format!("{millions:.digits$}")
}

fn range(rate: &Rate) -> String {
    format!("{}-{}", mega(rate.low), mega(rate.high))
}

fn megabytes(bytes: u64) -> String {
    format!("{:.1} MB", bytes as f64 * 1e-6)
}

/// `1,234,567`.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::rays::RayKind;
    use crate::bench::report::{ImageReport, RayReport, SCHEMA};
    use crate::bench::stats::Runs;

    fn runs_on(on: &str, wall: f64, device: Option<f64>, differ: u64) -> RunsOn {
        let three = |seconds: f64| Runs(vec![seconds, seconds * 1.1, seconds * 0.9]);
        RunsOn {
            on: on.to_owned(),
            wall_s: three(wall),
            device_s: device.map(three),
            differ,
            first: (differ > 0).then(|| "ray 7".to_owned()),
            dispatch: None,
            kernel_share: None,
        }
    }

    fn report(results: Vec<RunsOn>) -> SceneReport {
        let rays = vec![RayReport { kind: RayKind::Primary, rays: 1_000_000, hits: 250_000, results }];
        SceneReport {
            scene: "a.toml".to_owned(),
            width: 1000,
            height: 1000,
            seed: 0,
            size: Default::default(),
            load_s: 0.0,
            bake: Default::default(),
            peak_bytes: None,
            bake_bytes: None,
            setup: Vec::new(),
            rays,
            images: Vec::new(),
        }
    }

    const PLAN: Plan = Plan { runs: 3, warmup: 1 };

    #[test]
    fn rates_count_on_the_device_s_clock_and_wall_clock_stands_beside() {
        let table = Table { plan: PLAN, baseline: None };
        let text = table.scene(&report(vec![runs_on("cpu", 0.5, None, 0), runs_on("vulkan", 0.25, Some(0.2), 0)]));
        assert!(text.contains("  primary    1,000,000 rays, 25.0 % hit\n"), "{text}");
        assert!(text.contains("    cpu     median 2.00 Mrays/s (1.82-2.22, n = 3, 1 warm-up)\n"), "{text}");
        let vulkan = "    vulkan  median 5.00 Mrays/s (4.55-5.56, n = 3, 1 warm-up); wall 4.00 (3.64-4.44)\n";
        assert!(text.contains(vulkan), "{text}");
        assert!(text.contains("  hits: equal\n"), "{text}");
    }

    #[test]
    fn an_image_s_row_says_how_much_of_the_time_was_in_the_kernels_that_matter() {
        let mut result = runs_on("vulkan", 0.25, Some(0.2), 0);
        result.kernel_share = Some(Runs(vec![0.7, 0.912, 0.95]));
        let mut report = report(Vec::new());
        let (integrator, film_hash) = ("path".to_owned(), String::new());
        report.images = vec![ImageReport { integrator, samples: 1_000_000, film_hash, results: vec![result] }];
        let text = Table { plan: PLAN, baseline: None }.scene(&report);
        assert!(text.contains("wall 4.00 (3.64-4.44); 91 % in traversal and shading\n"), "{text}");
    }

    #[test]
    fn hits_that_differ_are_told_and_not_called_equal() {
        let table = Table { plan: PLAN, baseline: None };
        let report = report(vec![runs_on("cpu", 0.5, None, 0), runs_on("vulkan", 0.25, None, 3)]);
        assert!(!report.is_equal());
        let text = table.scene(&report);
        assert!(text.contains("  hits: 3 differ (primary on vulkan), the first is ray 7\n"), "{text}");
        assert!(!text.contains("equal"), "{text}");
    }

    #[test]
    fn a_baseline_gives_ratios_of_the_same_rows() {
        let whole = |scene| Report {
            schema: SCHEMA,
            gonio: String::new(),
            platform: String::new(),
            threads: 1,
            warmup: 1,
            runs: 3,
            backends: Vec::new(),
            scenes: vec![scene],
        };
        let before = whole(report(vec![runs_on("cpu", 0.5, None, 0)]));
        let json = serde_json::to_string(&before).expect("JSON");
        let before = Report::from_json(&json).expect("what was written is read");
        let table = Table { plan: PLAN, baseline: Some(&before) };
        let text = table.scene(&report(vec![runs_on("cpu", 0.25, None, 0), runs_on("vulkan", 0.25, None, 0)]));
        assert!(text.contains("1 warm-up); x2.000 of the baseline\n"), "{text}");
        assert_eq!(text.matches("baseline").count(), 1, "{text}");
        assert!(Report::from_json("{\"schema\": 99}").expect_err("another schema").starts_with("schema 99; "));
        assert!(Report::from_json("{}").is_err() && Report::from_json("[").is_err());
    }

    #[test]
    fn outliers_are_warned_of_with_a_remedy_not_yet_in_use() {
        let mut result = runs_on("cpu", 0.5, None, 0);
        result.wall_s = Runs(vec![9.0, 0.5, 0.51, 0.49, 0.5]);
        let report = report(vec![result]);
        let warning = |plan| Table { plan, baseline: None }.warnings(&report).join("\n");
        assert!(warning(Plan { runs: 5, warmup: 0 }).ends_with("use --warmup"), "{}", warning(PLAN));
        assert!(warning(Plan { runs: 5, warmup: 1 }).contains("run 1 took 9.0000 s, the median is 0.5000 s"));
    }

    #[test]
    fn numbers_have_three_digits_that_mean_something() {
        assert_eq!([412.3e6, 41.23e6, 4.123e6, 0.4123e6].map(mega), ["412", "41.2", "4.12", "0.412"]);
        assert_eq!([7, 1234, 1_234_567].map(grouped), ["7", "1,234", "1,234,567"]);
    }
}
