//! The rules of strict arithmetic are proved on SPIR-V: what must be refused is refused, with function and line, and
//! what the build embeds is decorated (ARCHITECTURE.md, "Strict arithmetic").

use std::collections::{BTreeSet, HashSet};
use std::path::Path;

use gonio::shaders::{self, Fetch};
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::grammar::INSTRUCTION_TABLE;
use rspirv::spirv::{GlslStd450Op, Op};

#[path = "../shaders/build/compile.rs"]
mod compile;
#[path = "../shaders/build/strict.rs"]
mod strict;

const FETCHES: [Fetch; 2] = [Fetch::Texel, Fetch::Storage];

/// Compiles a shader around `functions`, whose first line is line 12 of `shaders/kernels/probe.comp`, and which must
/// define `float victim(float a, vec4 v, int i)`.
fn probe(functions: &str) -> Module {
    let text = format!(
        "#version 460\n\
         #extension GL_EXT_shader_explicit_arithmetic_types : require\n\
         #extension GL_KHR_shader_subgroup_arithmetic : require\n\
         #extension GL_EXT_shader_atomic_float : require\n\
         #extension GL_EXT_control_flow_attributes : require\n\
         layout(local_size_x = 1) in;\n\
         layout(set = 0, binding = 0) buffer Data {{ vec4 data; int number; float sum; }};\n\
         layout(set = 0, binding = 1) uniform samplerBuffer texels;\n\
         layout(set = 0, binding = 2) uniform sampler2D picture;\n\
         layout(set = 0, binding = 3, r32f) uniform image2D canvas;\n\
         layout(constant_id = 9) const float KNOB = 1.0;\n\
         {functions}\n\
         void main() {{ data.x = victim(data.y, data, number); }}\n"
    );
    let words = compile::glsl_to_spirv(&text, "shaders/kernels/probe.comp", &[Path::new(".")], &[])
        .unwrap_or_else(|e| panic!("{functions}\n{e}"));
    strict::load(&words).expect("shaderc writes valid modules")
}

/// A shader whose `victim` returns one expression.
fn probe_expression(expression: &str) -> Module {
    probe(&format!("float victim(float a, vec4 v, int i) {{\n  return {expression};\n}}"))
}

#[test]
fn every_inexact_glsl_expression_is_refused_with_function_and_line() {
    let cases = [
        ("a / v.x", "FDiv"),
        ("(v / a).x", "FDiv"),
        ("mod(a, v.x)", "FMod"),
        ("dot(v, v)", "Dot"),
        ("(mat2(v) * v.xy).x", "MatrixTimesVector on a matrix"),
        ("(v.xy * mat2(v)).x", "VectorTimesMatrix on a matrix"),
        ("(mat2(v) * mat2(v))[0].x", "MatrixTimesMatrix on a matrix"),
        ("(mat2(v) * a)[0].x", "MatrixTimesScalar on a matrix"),
        ("outerProduct(v.xy, v.zw)[0].x", "OuterProduct on a matrix"),
        ("transpose(mat2(v))[0].x", "Transpose on a matrix"),
        ("inverse(mat2(v))[0].x", "GLSL.std.450 MatrixInverse"),
        ("determinant(mat2(v))", "GLSL.std.450 Determinant"),
        ("isnan(a) ? 1.0 : 0.0", "IsNan"),
        ("isinf(a) ? 1.0 : 0.0", "IsInf"),
        ("float(i % number)", "SMod"),
        ("texelFetch(texels, i).x", "ImageFetch"),
        ("textureLod(picture, v.xy, 0.0).x", "ImageSampleExplicitLod"),
        ("imageLoad(canvas, ivec2(i)).x", "ImageRead"),
        ("subgroupAdd(a)", "GroupNonUniformFAdd"),
        ("atomicAdd(sum, a)", "AtomicFAddEXT"),
        ("min(a, v.x)", "GLSL.std.450 FMin"),
        ("max(a, v.x)", "GLSL.std.450 FMax"),
        ("clamp(a, v.x, v.y)", "GLSL.std.450 FClamp"),
        ("fma(a, v.x, v.y)", "GLSL.std.450 Fma"),
        ("sqrt(a)", "GLSL.std.450 Sqrt"),
        ("inversesqrt(a)", "GLSL.std.450 InverseSqrt"),
        ("sin(a)", "GLSL.std.450 Sin"),
        ("cos(a)", "GLSL.std.450 Cos"),
        ("tan(a)", "GLSL.std.450 Tan"),
        ("asin(a)", "GLSL.std.450 Asin"),
        ("acos(a)", "GLSL.std.450 Acos"),
        ("atan(a)", "GLSL.std.450 Atan"),
        ("atan(a, v.x)", "GLSL.std.450 Atan2"),
        ("sinh(a)", "GLSL.std.450 Sinh"),
        ("exp(a)", "GLSL.std.450 Exp"),
        ("exp2(a)", "GLSL.std.450 Exp2"),
        ("log(a)", "GLSL.std.450 Log"),
        ("log2(a)", "GLSL.std.450 Log2"),
        ("pow(a, v.x)", "GLSL.std.450 Pow"),
        ("mix(a, v.x, v.y)", "GLSL.std.450 FMix"),
        ("step(a, v.x)", "GLSL.std.450 Step"),
        ("smoothstep(a, v.x, v.y)", "GLSL.std.450 SmoothStep"),
        ("length(v)", "GLSL.std.450 Length"),
        ("distance(v.xy, v.zw)", "GLSL.std.450 Distance"),
        ("normalize(v).x", "GLSL.std.450 Normalize"),
        ("cross(v.xyz, v.yzw).x", "GLSL.std.450 Cross"),
        ("reflect(v.xyz, v.yzw).x", "GLSL.std.450 Reflect"),
        ("refract(v.xyz, v.yzw, a).x", "GLSL.std.450 Refract"),
        ("faceforward(v.xy, v.yz, v.zw).x", "GLSL.std.450 FaceForward"),
        ("sign(a)", "GLSL.std.450 FSign"),
        ("fract(a)", "GLSL.std.450 Fract"),
        ("ceil(a)", "GLSL.std.450 Ceil"),
        ("round(a)", "GLSL.std.450 Round"),
        ("modf(a, data.z)", "GLSL.std.450 Modf"),
        ("ldexp(a, i)", "GLSL.std.450 Ldexp"),
        ("frexp(a, number)", "GLSL.std.450 Frexp"),
        ("radians(a)", "GLSL.std.450 Radians"),
        ("degrees(a)", "GLSL.std.450 Degrees"),
        ("float(packHalf2x16(v.xy))", "GLSL.std.450 PackHalf2x16"),
        ("unpackUnorm4x8(uint(i)).x", "GLSL.std.450 UnpackUnorm4x8"),
    ];
    for (expression, operation) in cases {
        let found = strict::check(&probe_expression(expression));
        // Newer compilers write the variant that returns a structure.
        let refused = found.iter().find(|v| [operation, &format!("{operation}Struct")].contains(&&*v.operation));
        let refused = refused.unwrap_or_else(|| panic!("{expression}: {operation} not in {found:?}"));
        assert_eq!(refused.function, "victim", "{expression}");
        assert_eq!(refused.line, 13, "{expression}");
        assert_eq!(refused.file, "shaders/kernels/probe.comp", "{expression}");
        let message = refused.to_string();
        let start = format!("shaders/kernels/probe.comp:13: {} in `victim` is not strict: ", refused.operation);
        assert!(message.starts_with(&start), "{message}");
    }
}

#[test]
fn every_exact_glsl_expression_is_accepted() {
    let exact = [
        "a + v.x * v.y - a",
        "(-v * a + v.wzyx * v).x",
        "(v + a).x",
        "abs(a) + floor(a) + trunc(a) + roundEven(a)",
        "a < v.x && a >= v.y && a != v.z ? a : v.w",
        "float(i) + float(uint(i)) + float(int(a)) + float(uint(a))",
        "uintBitsToFloat(floatBitsToUint(a) ^ 1u)",
        "v[i] + float(min(i, 3)) + float(findMSB(i)) + float(bitCount(i))",
        "float(uint(i) % 3u) + float(i / 3)",
        "float(subgroupAdd(i)) + float(atomicAdd(number, i))",
        "KNOB * a",
    ];
    for expression in exact {
        assert_eq!(strict::check(&probe_expression(expression)), [], "{expression}");
    }
}

#[test]
fn every_core_operation_outside_the_list_is_refused() {
    // Written out a second time on purpose: a slip in shaders/build/strict.rs must not pass for the rule.
    let allowed = "FAdd FSub FMul FNegate VectorTimesScalar \
        ConvertFToU ConvertFToS ConvertSToF ConvertUToF Bitcast \
        FOrdEqual FUnordEqual FOrdNotEqual FUnordNotEqual FOrdLessThan FUnordLessThan FOrdGreaterThan \
        FUnordGreaterThan FOrdLessThanEqual FUnordLessThanEqual FOrdGreaterThanEqual FUnordGreaterThanEqual \
        Select Phi Variable Load Store CopyObject CopyLogical CopyMemory CompositeConstruct CompositeExtract \
        CompositeInsert VectorShuffle VectorExtractDynamic VectorInsertDynamic FunctionCall ReturnValue";
    let negation = probe_expression("-a");
    let mut accepted = BTreeSet::new();
    for class in INSTRUCTION_TABLE.iter() {
        // GLSL.std.450 has a test of its own; line markers are no operations.
        if matches!(class.opcode, Op::ExtInst | Op::Line | Op::NoLine) {
            continue;
        }
        let mut module = negation.clone();
        let is_negation = |i: &&mut Instruction| i.class.opcode == Op::FNegate;
        let replaced = module.all_inst_iter_mut().find(is_negation);
        replaced.expect("the expression negates").class = class;
        if strict::check(&module).is_empty() {
            accepted.insert(class.opname);
        }
    }
    assert_eq!(accepted, allowed.split_whitespace().collect());
}

#[test]
fn every_extended_operation_outside_the_list_is_refused() {
    let allowed = "FAbs Floor Trunc RoundEven \
        SAbs SSign UMin SMin UMax SMax UClamp SClamp FindILsb FindSMsb FindUMsb";
    let absolute = probe_expression("abs(a)");
    let mut accepted = BTreeSet::new();
    for number in (0..=100).filter(|n| *n != GlslStd450Op::FAbs as u32) {
        let mut module = absolute.clone();
        let is_absolute = |i: &&mut Instruction| i.class.opcode == Op::ExtInst;
        let replaced = module.all_inst_iter_mut().find(is_absolute);
        replaced.expect("the expression takes abs").operands[1] = Operand::LiteralExtInstInteger(number);
        if strict::check(&module).is_empty() {
            accepted.insert(format!("{:?}", GlslStd450Op::from_u32(number).expect("known")));
        }
    }
    accepted.insert("FAbs".to_owned());
    assert!(strict::check(&absolute).is_empty());
    assert_eq!(accepted, allowed.split_whitespace().map(str::to_owned).collect());
}

#[test]
fn approximate_functions_may_use_any_operation() {
    let text = "float approx_it(float a) {\n  return sqrt(a) / (a * a + a);\n}\n\
                float victim(float a, vec4 v, int i) { return approx_it(a); }";
    assert_eq!(strict::check(&probe(text)), []);
}

#[test]
fn only_the_approximate_function_itself_is_exempt() {
    let text = "float helper(float a) {\n  return 1.0 / a;\n}\n\
                float approx_it(float a) { return helper(a) / a; }\n\
                float not_approx_it(float a) { return 2.0 / a; }\n\
                float victim(float a, vec4 v, int i) { return approx_it(a) + not_approx_it(a); }";
    let found = strict::check(&probe(text));
    let places: Vec<_> = found.iter().map(|v| (v.function.as_str(), v.line)).collect();
    assert_eq!(places, [("helper", 13), ("not_approx_it", 16)]);
}

#[test]
fn a_violation_in_an_included_file_names_that_file() {
    let shaders = tempfile::tempdir().expect("a temporary folder");
    let folder = shaders.path().join("shading");
    std::fs::create_dir(&folder).expect("a folder");
    let included = "float bad(float a) {\n    float b = a + a;\n    return b / a;\n}\n";
    std::fs::write(folder.join("bad.glsl"), included).expect("a file");
    let text = "#version 460\n#extension GL_GOOGLE_include_directive : require\n\
                #include \"shading/bad.glsl\"\n\
                layout(set = 0, binding = 0) buffer Data { float data; };\n\
                void main() { data = bad(data); }\n";
    let words = compile::glsl_to_spirv(text, "shaders/kernels/x.comp", &[shaders.path()], &[]);
    let module = strict::load(&words.expect("valid GLSL")).expect("valid SPIR-V");
    let found = strict::check(&module);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].file.as_str(), found[0].line), ("shaders/shading/bad.glsl", 3));
}

#[test]
fn a_glsl_error_names_file_line_and_cause() {
    let compile = |text| {
        compile::glsl_to_spirv(text, "shaders/kernels/x.comp", &[Path::new("no such folder")], &[])
            .expect_err("the text is wrong")
    };
    let undeclared = compile("#version 460\nvoid main() {\n  nothing();\n}\n");
    assert!(undeclared.starts_with("shaders/kernels/x.comp:3: error: 'nothing'"), "{undeclared}");
    let missing = compile(
        "#version 460\n#extension GL_GOOGLE_include_directive : require\n\
         #include \"shading/none.glsl\"\nvoid main() {}\n",
    );
    assert!(missing.contains("shaders/kernels/x.comp:3: error"), "{missing}");
    assert!(missing.contains("shaders/shading/none.glsl"), "{missing}");
}

#[test]
fn a_definition_chooses_the_fetch_path() {
    let text = "#version 460\n#ifndef FETCH_TEXEL\n#error storage\n#endif\nvoid main() {}\n";
    let compile = |defines| compile::glsl_to_spirv(text, "x.comp", &[Path::new(".")], defines);
    assert!(compile(&[]).is_err());
    assert!(compile(&["FETCH_TEXEL"]).is_ok());
}

#[test]
fn other_widths_and_relaxed_precision_are_refused_for_the_whole_module() {
    let cases = [
        ("float(double(a))", "TypeFloat 64"),
        ("float(float16_t(a))", "TypeFloat 16"),
        ("approx_half(a)", "TypeFloat 16"),
        ("relaxed(a)", "RelaxedPrecision"),
    ];
    for (expression, operation) in cases {
        let module = probe(&format!(
            "float approx_half(float a) {{ return float(float16_t(a)); }}\n\
             float relaxed(mediump float a) {{ mediump float b = a + a; return b; }}\n\
             float victim(float a, vec4 v, int i) {{ return {expression}; }}"
        ));
        let found = strict::check(&module);
        let refused = found.iter().find(|v| v.operation == operation);
        let refused = refused.unwrap_or_else(|| panic!("{expression}: {found:?}"));
        assert_eq!(refused.function, "(module)");
    }
}

#[test]
fn every_float_result_outside_approximate_functions_is_decorated() {
    let text = "float approx_it(float a) { return a * a + a; }\n\
                float victim(float a, vec4 v, int i) { return (v * a - v).x * -a + approx_it(a); }";
    let mut module = probe(text);
    // v * a, - v, * -a, -a, + approx_it
    assert_eq!(strict::decorate(&mut module), 5);
    let decorated = strict::no_contraction(&module);
    assert_eq!(decorated, float_results(&module));
    let in_approximate = |name: &str| name.starts_with("approx_it");
    let skipped = arithmetic_in(&module, in_approximate);
    assert_eq!(skipped.len(), 2);
    assert!(decorated.is_disjoint(&skipped));
}

#[test]
fn decorating_twice_changes_nothing() {
    let mut module = probe_expression("a * v.x + v.y");
    assert!(strict::decorate(&mut module) > 0);
    let once = strict::assemble(&module);
    let mut again = strict::load(&once).expect("valid");
    assert_eq!(strict::decorate(&mut again), 0);
    assert_eq!(strict::assemble(&again), once);
}

#[test]
fn stripping_removes_lines_and_source_and_keeps_names() {
    let mut module = probe_expression("a * v.x + v.y");
    assert!(module.all_inst_iter().any(|i| i.class.opcode == Op::Line));
    let names = module.debug_names.clone();
    strict::strip_lines(&mut module);
    let text_of = [Op::Line, Op::NoLine, Op::Source, Op::SourceContinued, Op::String];
    assert!(!module.all_inst_iter().any(|i| text_of.contains(&i.class.opcode)));
    assert_eq!(module.debug_names, names);
    strict::load(&strict::assemble(&module)).expect("still valid");
}

/// Results of float arithmetic in functions whose full name passes.
fn arithmetic_in(module: &Module, wanted: impl Fn(&str) -> bool) -> HashSet<u32> {
    let name_of = |id| {
        let names = module.debug_names.iter().filter(|i| i.class.opcode == Op::Name);
        names
            .filter(|i| i.operands[0] == Operand::IdRef(id))
            .map(|i| i.operands[1].unwrap_literal_string().to_owned())
            .next()
            .expect("every function has a name")
    };
    let functions = module.functions.iter();
    functions
        .filter(|f| wanted(&name_of(f.def_id().expect("a function has an id"))))
        .flat_map(|f| f.all_inst_iter())
        .filter(|i| {
            let arithmetic = [Op::FAdd, Op::FSub, Op::FMul, Op::FNegate, Op::VectorTimesScalar];
            arithmetic.contains(&i.class.opcode)
        })
        .map(|i| i.result_id.expect("arithmetic has a result"))
        .collect()
}

/// Results that must be decorated.
fn float_results(module: &Module) -> HashSet<u32> {
    arithmetic_in(module, |name| !name.starts_with("approx_"))
}

#[test]
fn every_embedded_kernel_is_strict_decorated_and_stripped() {
    let (mut kernels, mut decorated) = (0, 0);
    for name in shaders::names() {
        for fetch in FETCHES {
            let words = shaders::kernel(name, fetch).expect("a listed kernel exists");
            let module = strict::load(words).expect("valid");
            assert_eq!(strict::check(&module), [], "{name}");
            assert_eq!(strict::no_contraction(&module), float_results(&module), "{name}");
            assert!(!module.all_inst_iter().any(|i| i.class.opcode == Op::Line), "{name}");
            assert_eq!(module.header.as_ref().expect("a header").version(), (1, 5), "{name}");
            kernels += 1;
            decorated += float_results(&module).len();
        }
    }
    assert!(kernels > 0 && decorated > 0, "nothing was tested");
}

#[test]
fn every_kernel_file_is_embedded() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders/kernels");
    let mut files = Vec::new();
    for (below, prefix) in [("", ""), ("parity", "parity/")] {
        for entry in std::fs::read_dir(folder.join(below)).expect("a folder of kernels") {
            let path = entry.expect("readable").path();
            if path.extension().is_some_and(|e| e == "comp") {
                let stem = path.file_stem().and_then(|s| s.to_str()).expect("plain names");
                files.push(format!("{prefix}{stem}"));
            }
        }
    }
    files.sort();
    assert_eq!(shaders::names().collect::<Vec<_>>(), files);
    assert_eq!(shaders::kernel("no such kernel", Fetch::Texel), None);
}
