//! `<integrator>`.

use super::document::{Document, Node, Result};
use super::object::Object;
use crate::scene::{Integrator, Scene, Shadows};

/// Integrators within integrators.
const NESTING_MAX: u32 = 4;
/// The house's own limit of scattering events.
const DEPTH_MAX: u32 = 64;

/// Reads how light is followed.
pub fn read_integrator(document: &Document, node: Node, scene: &mut Scene) -> Result<()> {
    read(document, node, scene, 0)
}

fn read(document: &Document, node: Node, scene: &mut Scene, nesting: u32) -> Result<()> {
    let object = Object::open(document, node)?;
    match object.plugin.name {
        kind @ ("moment" | "aov") => {
            if kind == "aov" {
                let location = document.location_of(node);
                scene
                    .warnings
                    .push(format!("{location}: the integrator \"aov\" is left out; --aov gives further layers"));
            }
            match object.only("integrator")? {
                Some(child) if nesting < NESTING_MAX => read(document, child.node, scene, nesting + 1),
                Some(child) => Err(document.bad(child.written, "too many integrators within each other")),
                None => Err(document.bad(node, format!("the integrator {kind:?} holds an integrator"))),
            }
        }
        kind => {
            if kind == "ptracer" {
                let location = document.location_of(node);
                let message =
                    "the integrator \"ptracer\" is read as \"path\", whose pictures are the same but for noise";
                scene.warnings.push(format!("{location}: {message}"));
            }
            // Mitsuba counts the edges of a path, gonio the surfaces it scatters at: one less. -1 has no end there.
            let edges =
                if kind == "direct" { Some(2) } else { object.integer("max_depth", -1, i64::from(i32::MAX))? };
            let depth = match edges {
                Some(edges) if edges >= 0 => (edges - 1).max(0).min(i64::from(DEPTH_MAX)) as u32,
                _ => DEPTH_MAX,
            };
            scene.settings.integrator = if kind == "direct" { Integrator::Direct } else { Integrator::Path };
            scene.settings.max_depth = depth;
            if kind != "direct"
                && let Some(rr_depth) = object.integer("rr_depth", 0, i64::from(i32::MAX))?
            {
                scene.settings.rr_depth = rr_depth.min(i64::from(DEPTH_MAX) + 1) as u32;
            }
            // Light without a size passes holes under the volumetric path tracers only; other light finds its way by itself.
            let passes = kind.starts_with("volpath");
            scene.settings.shadows = if passes { Shadows::Filtered } else { Shadows::Opaque };
            scene.settings.hide_emitters = object.boolean("hide_emitters")?.unwrap_or(false);
            Ok(())
        }
    }
}
