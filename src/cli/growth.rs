//! `gonio plot growth`: how the cost of a ray grows with the scene, from what `gonio bench` and other ray tracers measured.

use crate::bench::rays::RayKind;
use crate::bench::report::Report;
use crate::film::FilmError;
use crate::plot::Figure;
use crate::plot::figure::{Axis, Curve, palette};
use anyhow::Context;
use clap::Args;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct GrowthArgs {
    /// Results of `gonio bench --json`; and, of other ray tracers on rays that it exported, lines of scene, kind of rays, name,
    /// millions of rays a second, separated by tabs, as benches/embree prints them.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Which rays: primary, diffuse, second, occlusion, shadow.
    #[arg(long, default_value = "diffuse", value_parser = kind)]
    kind: RayKind,
}

fn kind(name: &str) -> Result<RayKind, String> {
    let known = RayKind::ALL.map(RayKind::name).join(", ");
    RayKind::ALL.into_iter().find(|kind| kind.name() == name).ok_or_else(|| format!("allowed: {known}"))
}

/// Microseconds a ray against the logarithm of the number of triangles, by sort of scene and tracer.
type Lines = BTreeMap<(String, String), Vec<[f64; 2]>>;

impl GrowthArgs {
    pub fn figure(&self) -> anyhow::Result<Figure> {
        let mut texts = Vec::new();
        let mut reports = Vec::new();
        for path in &self.files {
            let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
            match path.extension().is_some_and(|extension| extension == "json") {
                true => reports.push(Report::from_json(&text).map_err(|message| bad(path, message))?),
                false => texts.push((path, text)),
            }
        }
        let mut lines = Lines::new();
        let mut sizes = BTreeMap::new();
        for scene in reports.iter().flat_map(|report| &report.scenes) {
            let size = libm::log10(scene.size.placed as f64);
            sizes.insert(scene.scene.replace(':', "-"), size);
            for rays in scene.rays.iter().filter(|rays| rays.kind == self.kind) {
                for result in &rays.results {
                    let key = (family(&scene.scene).to_owned(), format!("gonio {}", result.on));
                    lines.entry(key).or_default().push([size, 1e6 / result.rate(rays.rays).median]);
                }
            }
        }
        for (path, text) in &texts {
            read_lines(text, self.kind, &sizes, &mut lines).map_err(|message| bad(path, message))?;
        }
        let is_empty = lines.values().all(|points| points.len() < 2);
        if is_empty {
            let message = format!(
                "fewer than two scenes of one sort (as terrain:10k, terrain:1M) with {} rays",
                self.kind.name()
            );
            return Err(bad(&self.files[0], message).into());
        }
        Ok(figure(lines, self.kind))
    }
}

fn bad(path: &Path, message: String) -> FilmError {
    FilmError::Bad { file: path.display().to_string(), message }
}

/// `terrain` of `terrain:4M`.
fn family(scene: &str) -> &str {
    scene.split([':', '-']).next().unwrap_or(scene)
}

/// Adds what other ray tracers did with the scenes in `sizes`.
fn read_lines(text: &str, kind: RayKind, sizes: &BTreeMap<String, f64>, lines: &mut Lines) -> Result<(), String> {
    let mut found: BTreeMap<(&str, &str), Vec<f64>> = BTreeMap::new();
    for (number, line) in (1..).zip(text.lines()) {
        let [scene, of, tracer, rate] = line.split('\t').collect::<Vec<_>>()[..] else {
            return Err(format!("line {number}: expected four fields with tabs between them, found {line:?}"));
        };
        let rate: f64 = rate.parse().map_err(|_| format!("line {number}: expected a number, found {rate:?}"))?;
        if of == kind.name() && rate > 0.0 {
            found.entry((scene, tracer)).or_default().push(rate);
        }
    }
    for ((scene, tracer), mut rates) in found {
        let size =
            sizes.get(scene).ok_or_else(|| format!("no result of `gonio bench --json` has a scene {scene:?}"))?;
        rates.sort_by(f64::total_cmp);
        let key = (family(scene).to_owned(), tracer.to_owned());
        lines.entry(key).or_default().push([*size, 1.0 / rates[rates.len() / 2]]);
    }
    Ok(())
}

fn figure(lines: Lines, kind: RayKind) -> Figure {
    let ends = lines.values().flatten().map(|point| point[0]);
    let (low, high) = ends.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
    let x = Axis {
        label: "triangles, powers of ten".to_owned(),
        low: libm::floor(low + 0.05),
        high: libm::ceil(high - 0.05),
        step: 1.0,
    };
    let mixed = lines.keys().any(|(family, _)| lines.keys().any(|(other, _)| family != other));
    let family = lines.keys().next().map_or(String::new(), |(family, _)| family.clone());
    let mut curves = Vec::new();
    for ((family, tracer), mut points) in lines {
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let name = if mixed { format!("{family}, {tracer}") } else { tracer.clone() };
        let color = palette(curves.len());
        curves.push(Curve { name, color, dashed: !tracer.starts_with("gonio"), points });
    }
    let note = if mixed { format!("{} rays", kind.name()) } else { format!("{} rays, {family}", kind.name()) };
    Figure::cartesian("Time a ray against the size of the scene", note, x, "µs a ray, all cores", curves)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_tracers_lines_stand_beside_ours_as_the_median_of_its_runs() {
        let sizes = BTreeMap::from([("terrain-1k".to_owned(), 3.0), ("terrain-10k".to_owned(), 4.0)]);
        let text = "terrain-10k\tdiffuse\tembree robust\t2\nterrain-10k\tdiffuse\tembree robust\t4\n\
                    terrain-10k\tdiffuse\tembree robust\t1\nterrain-1k\tdiffuse\tembree robust\t5\n\
                    terrain-1k\tprimary\tembree robust\t9\n";
        let mut lines = Lines::from([(("terrain".to_owned(), "gonio cpu".to_owned()), vec![[4.0, 0.5], [3.0, 0.25]])]);
        read_lines(text, RayKind::Diffuse, &sizes, &mut lines).expect("four fields a line");
        let figure = figure(lines, RayKind::Diffuse);
        assert_eq!(figure.note, "diffuse rays, terrain");
        let [embree, gonio] = &figure.curves[..] else { panic!("{figure:?}") };
        assert_eq!((embree.name.as_str(), embree.dashed), ("embree robust", true));
        assert_eq!(embree.points, [[3.0, 0.2], [4.0, 0.5]]);
        assert_eq!((gonio.name.as_str(), gonio.dashed), ("gonio cpu", false));
        assert_eq!(gonio.points, [[3.0, 0.25], [4.0, 0.5]]);
    }

    #[test]
    fn a_line_that_is_none_and_a_scene_that_is_unknown_are_told() {
        let read = |text| read_lines(text, RayKind::Diffuse, &BTreeMap::new(), &mut Lines::new());
        assert_eq!(read("a b\n"), Err("line 1: expected four fields with tabs between them, found \"a b\"".to_owned()));
        assert_eq!(read("a\tdiffuse\tc\tfast\n"), Err("line 1: expected a number, found \"fast\"".to_owned()));
        assert!(read("a\tdiffuse\tc\t1\n").expect_err("unknown").ends_with("has a scene \"a\""));
        assert_eq!(read("a\tprimary\tc\t1\n"), Ok(()), "other kinds do not matter");
    }
}
