//! GLSL to SPIR-V: one call of shaderc with the settings every kernel shares.
//!
//! Knows nothing of the build script, so that tests include it by `#[path]`.

use std::path::Path;

use shaderc::{
    CompileOptions, Compiler, EnvVersion, OptimizationLevel, ResolvedInclude, ShaderKind, SpirvVersion, TargetEnv,
};

/// Compiles a compute shader for Vulkan 1.2 (SPIR-V 1.5), unoptimised, with source lines.
///
/// * `text`: the GLSL source; `name`: how messages and `OpLine` call it, such as `shaders/kernels/extend.comp`.
/// * `folders`: where `#include "shading/math.glsl"` is looked for, in this order: `shaders`, and what the build has written.
/// * `defines`: macros set to nothing before the first line.
///
/// SPIR-V optimisers are kept out because they merge float constants and reassociate before the decorations are read.
/// The error is shaderc's text, one `file:line: error: message` a line.
pub fn glsl_to_spirv(text: &str, name: &str, folders: &[&Path], defines: &[&str]) -> Result<Vec<u32>, String> {
    let compiler = Compiler::new().map_err(|e| format!("{name}: no shader compiler: {e}"))?;
    let mut options = CompileOptions::new().map_err(|e| format!("{name}: {e}"))?;
    options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_2 as u32);
    options.set_target_spirv(SpirvVersion::V1_5);
    options.set_optimization_level(OptimizationLevel::Zero);
    options.set_generate_debug_info();
    for define in defines {
        options.add_macro_definition(define, None);
    }
    options.set_include_callback(|wanted, _kind, from, _depth| {
        let found = folders.iter().find_map(|folder| std::fs::read_to_string(folder.join(wanted)).ok());
        let content = found.ok_or(format!("no file shaders/{wanted}, wanted by {from}"))?;
        Ok(ResolvedInclude { resolved_name: format!("shaders/{wanted}"), content })
    });
    let artifact =
        compiler.compile_into_spirv(text, ShaderKind::Compute, name, "main", Some(&options)).map_err(|e| match e {
            shaderc::Error::CompilationError(_, messages) => messages.trim_end().to_owned(),
            other => format!("{name}: {other}"),
        })?;
    Ok(artifact.as_binary().to_vec())
}
