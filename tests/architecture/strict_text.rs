//! What the SPIR-V cannot show: divisions on the Rust side, and what GLSL front ends compute before SPIR-V exists
//! (ARCHITECTURE.md, "Strict arithmetic"). Methods of f32 and glam are clippy's part (clippy.toml).

use std::collections::BTreeSet;

use super::source::{Source, Token, is_float_literal, is_integer_literal, set, sources, tokens};

/// Folders whose results must be the same bits everywhere.
const STRICT: [&str; 3] = ["shading", "trace", "transport"];

/// Behind a division or remainder of integers whose operands do not show it.
const INTEGER_MARK: &str = "// integer";

fn strict_rust() -> impl Iterator<Item = Source> {
    STRICT.into_iter().flat_map(|folder| sources(&format!("src/{folder}"), &["rs"]))
}

/// Kernels too: they have no Rust twin, but they compute.
fn strict_glsl() -> impl Iterator<Item = Source> {
    let folders = STRICT.into_iter().chain(["kernels"]);
    folders.flat_map(|folder| sources(&format!("shaders/{folder}"), &["glsl", "comp"]))
}

/// Divisions and remainders that may be of floats: all but those with an integer literal or the mark on their line.
fn divisions(file: &Source) -> Vec<String> {
    let code = file.strict_code();
    let tokens = tokens(&code);
    let is_operator = |token: &Token| matches!(token.text, "/" | "/=" | "%" | "%=");
    let mut found = Vec::new();
    for (i, token) in tokens.iter().enumerate().filter(|(_, token)| is_operator(token)) {
        let is_integer =
            |at: Option<usize>| at.and_then(|at| tokens.get(at)).is_some_and(|t| is_integer_literal(t.text));
        // Rust converts nothing, so one integer operand makes both integers.
        let literal = is_integer(i.checked_sub(1)) || is_integer(Some(i + 1));
        if !literal && !file.line(token.at).contains(INTEGER_MARK) {
            found.push(format!("{}: {}", file.place(token.at), file.line(token.at).trim()));
        }
    }
    found
}

#[test]
fn no_float_is_divided_in_the_strict_folders() {
    let found: Vec<_> = strict_rust().flat_map(|file| divisions(&file)).collect();
    assert!(found.is_empty(), "use div of shading/math, or mark the line `{INTEGER_MARK}`: {found:#?}");
}

#[test]
fn a_division_is_seen_wherever_floats_may_be_divided() {
    let count = |text: &str| divisions(&Source::new("src/shading/a.rs", text)).len();
    assert_eq!(count("fn f(a: f32) -> f32 {\n    a / 2.0\n}\n"), 1);
    assert_eq!(count("fn f(a: f32, b: f32) -> f32 {\n    a / b\n}\n"), 1);
    assert_eq!(count("fn f(a: &mut f32) {\n    *a /= 3f32;\n    *a %= 2.5;\n}\n"), 2);
    assert_eq!(count("fn f(a: Vec3) -> Vec3 {\n    a\n        / a.x\n}\n"), 1);
    assert_eq!(count("fn f(a: u32) -> u32 {\n    a / 2 + a % 0x10\n}\n"), 0);
    assert_eq!(count("fn f(a: u32, b: u32) -> u32 {\n    a / b // integer\n}\n"), 0);
    assert_eq!(count("// a / b\n/// c / d\nconst A: &str = \"a / b\";\n"), 0);
    assert_eq!(count("fn approx_f(a: f32) -> f32 {\n    1.0 / a\n}\n"), 0);
    assert_eq!(count("fn not_approx_f(a: f32) -> f32 {\n    1.0 / a\n}\n"), 1);
    assert_eq!(count("#[cfg(test)]\nmod tests {\n    const A: f32 = 1.0 / 3.0;\n}\n"), 0);
}

/// Types whose operators round in ways of their own, wider floats, and the host's mathematics.
fn foreign_words(file: &Source) -> Vec<String> {
    let code = file.strict_code();
    let foreign = set(&[
        "f64", "libm", "Mat2", "Mat3", "Mat3A", "Mat4", "Affine2", "Affine3", "Affine3A", "Quat", "Vec3A", "DVec2",
        "DVec3", "DVec4", "DMat3", "DMat4",
    ]);
    let tokens = tokens(&code);
    let mut found = Vec::new();
    for (i, token) in tokens.iter().enumerate() {
        // `1.0f64` is one token.
        let is_wide_literal = token.text.ends_with("f64") && is_float_literal(token.text);
        if foreign.contains(token.text) || is_wide_literal {
            found.push(format!("{}: {}", file.place(token.at), token.text));
        }
        let is_call = tokens.get(i + 1).is_some_and(|next| matches!(next.text, "(" | "::"));
        let is_fold = matches!(token.text, "sum" | "product") && is_call && i > 0 && tokens[i - 1].text == ".";
        if is_fold {
            found.push(format!("{}: .{}() has no GLSL twin", file.place(token.at), token.text));
        }
    }
    found
}

#[test]
fn the_strict_folders_know_no_wider_floats_matrices_or_folds() {
    let found: Vec<_> = strict_rust().flat_map(|file| foreign_words(&file)).collect();
    assert!(found.is_empty(), "{found:#?}");
    let count = |text: &str| foreign_words(&Source::new("src/shading/a.rs", text)).len();
    assert_eq!(count("fn f(a: f32) -> f64 { a as f64 }"), 2);
    assert_eq!(count("fn f(a: Mat3, v: Vec3) -> f32 { libm::sqrtf(1.0f64) + [v.x].iter().sum() }"), 4);
    assert_eq!(count("fn f(v: [f32; 2]) -> f32 { v.iter().product::<f32>() }"), 1);
    assert_eq!(count("fn f(sum: &Queues) -> f32 { sum.sum }"), 0);
    assert_eq!(count("#[cfg(test)]\nmod tests {\n    fn f(a: f64) {}\n}\n"), 0);
}

/// Names of float constants in GLSL.
fn float_constants(files: &[Source]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for file in files {
        let tokens = tokens(&file.code);
        for window in tokens.windows(3) {
            if window[0].text == "const" && matches!(window[1].text, "float" | "vec2" | "vec3" | "vec4") {
                found.insert(window[2].text.to_owned());
            }
        }
    }
    found
}

/// Places where a front end computes: both operands of a float operation are constants, so glslang folds it in double.
fn folded(file: &Source, constants: &BTreeSet<String>) -> Vec<String> {
    let code = file.strict_code();
    let tokens = tokens(&code);
    let text = |at: usize| tokens.get(at).map_or("", |token| token.text);
    let is_constant = |at: usize| is_float_literal(text(at)) || constants.contains(text(at));
    let is_tight = |operator: &str| matches!(operator, "*" | "/");
    let is_loose = |operator: &str| matches!(operator, "+" | "-");
    let ends_operand = |text: &str| {
        let last = text.chars().last();
        last.is_some_and(|c| c.is_alphanumeric() || matches!(c, '_' | ')' | ']')) && text != "return"
    };
    let mut found = Vec::new();
    for i in (1..tokens.len()).filter(|i| is_tight(text(*i)) || is_loose(text(*i))) {
        let mut right = i + 1;
        while matches!(text(right), "-" | "(") {
            right += 1;
        }
        if !is_constant(i - 1) || !is_constant(right) || text(right + 1) == "(" {
            continue;
        }
        // The left operand belongs to an operation before it: `x * 2.0 + 1.0` is no constant.
        let before = i.checked_sub(2).map_or("", text);
        let is_binary = i.checked_sub(3).is_some_and(|at| ends_operand(text(at)));
        let taken = is_binary && (is_tight(before) || (is_loose(before) && is_loose(text(i))));
        // The right operand belongs to a tighter operation after it: `1.0 + 2.0 * x`.
        let given = is_loose(text(i)) && is_tight(text(right + 1));
        if !taken && !given {
            found.push(format!("{}: {}", file.place(tokens[i].at), file.line(tokens[i].at).trim()));
        }
    }
    found
}

#[test]
fn no_glsl_constant_is_arithmetic_on_constants() {
    let files: Vec<_> = strict_glsl().collect();
    let constants = float_constants(&files);
    let found: Vec<_> = files.iter().flat_map(|file| folded(file, &constants)).collect();
    assert!(found.is_empty(), "write the rounded f32 in decimal: {found:#?}");
}

#[test]
fn arithmetic_on_constants_is_seen_and_arithmetic_on_values_is_not() {
    let count = |expression: &str| {
        let text = format!("const float PI = 3.14159274;\nfloat f(float x) {{\n    return {expression};\n}}\n");
        let file = Source::new("shaders/shading/a.glsl", text);
        let constants = float_constants(std::slice::from_ref(&file));
        folded(&file, &constants).len()
    };
    for constant in
        ["2.0 * PI", "1.0 / 3.0", "x + 2.0 * PI", "x * (1.0 - PI)", "-1.0 + 2.0", "PI - -1.0e-3", "PI * (PI + x)"]
    {
        // The last is no constant, but nobody can tell at a glance either.
        assert_eq!(count(constant), 1, "{constant}");
    }
    for value in
        ["x * 2.0 + 1.0", "x + PI - 1.0", "1.0 + 2.0 * x", "x * PI * 2.0", "PI * x", "-PI", "min(1.0, 2.0) * x"]
    {
        assert_eq!(count(value), 0, "{value}");
    }
}

/// Built-in functions that round; with constant arguments they would be computed by the front end, unseen by the check
/// on SPIR-V.
const ROUNDING_BUILT_INS: &str = "sqrt inversesqrt sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh exp exp2 \
    log log2 pow length distance normalize dot cross reflect refract faceforward mix step smoothstep fract mod fma ldexp \
    radians degrees determinant inverse";

fn rounding_calls(file: &Source) -> Vec<String> {
    let names: BTreeSet<&str> = ROUNDING_BUILT_INS.split_whitespace().collect();
    let code = file.strict_code();
    let tokens = tokens(&code);
    let calls = tokens.windows(2).filter(|pair| names.contains(pair[0].text) && pair[1].text == "(");
    calls.map(|pair| format!("{}: {}", file.place(pair[0].at), pair[0].text)).collect()
}

#[test]
fn no_glsl_function_calls_a_rounding_built_in() {
    let found: Vec<_> = strict_glsl().flat_map(|file| rounding_calls(&file)).collect();
    assert!(found.is_empty(), "use shading/math: {found:#?}");
    let count = |text: &str| rounding_calls(&Source::new("shaders/shading/a.glsl", text)).len();
    assert_eq!(count("float f(float x) {\n    return sqrt(2.0) + dot (x, x);\n}\n"), 2);
    assert_eq!(count("float f(float x) {\n    return sqrt_(2.0) + x.length; // sqrt(2.0)\n}\n"), 0);
    assert_eq!(count("float approx_f(float x) {\n    return sqrt(x);\n}\n"), 0);
}
