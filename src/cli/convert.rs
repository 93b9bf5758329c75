//! `gonio convert`: the stage of a model as a scene file.

use super::output::print_report;
use super::setup::SceneFlags;
use super::{ExitCode, exposure, strict};
use crate::bake::Baker;
use crate::film::{FilmError, OutputFile};
use crate::scene::Scene;
use crate::scene::load;
use clap::Args;
use std::io::Write;
use std::path::{Component, Path, PathBuf};

#[derive(Args)]
#[command(after_help = "\
Examples:
  gonio convert bunny.obj -o bunny.toml                  what `gonio render bunny.obj` shows, to be edited
  gonio convert chair.glb --environment sky -o chair.toml
  gonio convert part.stl --up z --azimuth 120 -o part.toml")]
pub struct ConvertArgs {
    /// .obj, .ply, .stl, .gltf or .glb.
    model: PathBuf,
    /// The scene file, .toml; `-` is standard output.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    scene_flags: SceneFlags,
}

pub fn run(args: &ConvertArgs) -> anyhow::Result<ExitCode> {
    let mut output = OutputFile::open(&args.output)?;
    let (overrides, _, controls) = args.scene_flags.changes()?;
    load::confine::begin(&args.model);
    let exposed = |scene: &mut Scene| -> anyhow::Result<()> {
        let adjusted = args.scene_flags.adjusted(std::mem::replace(scene, load::staging::bare_scene(Path::new(""))))?;
        *scene = adjusted;
        match scene.metered {
            true => exposure::expose(scene, &mut Baker::default(), None, &|| false),
            false => Ok(()),
        }
    };
    let file = relative(&args.model, &args.output);
    let (text, scene) = load::convert(&args.model, &file, &overrides, &controls, exposed)?;
    strict::check(&scene.warnings)?;
    let name = args.model.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let written = write!(output, "# {name}, staged by gonio {}.\n{text}", env!("CARGO_PKG_VERSION"));
    written.and_then(|()| output.flush()).map_err(|error| FilmError::write(&args.output, error))?;
    let piped = output.is_stdout();
    output.commit()?;
    print_report(&format!("scene {}\n", args.output.display()), piped)?;
    Ok(ExitCode::SUCCESS)
}

/// `file` as a scene in `scene` names it: from that scene's folder. On standard output the folder is the current one.
fn relative(file: &Path, scene: &Path) -> String {
    let folder = scene.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (Ok(file_there), Ok(folder)) = (file.canonicalize(), folder.canonicalize()) else {
        return file.display().to_string();
    };
    let (from, to): (Vec<Component>, Vec<Component>) =
        (folder.components().collect(), file_there.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let mut path = PathBuf::new();
    from[common..].iter().for_each(|_| path.push(".."));
    path.extend(&to[common..]);
    path.display().to_string()
}
