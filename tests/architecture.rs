//! ARCHITECTURE.md is true: who may use whom, what has a twin, how long files are, where `unsafe` and printing live.

use std::collections::{BTreeMap, BTreeSet};

#[path = "architecture/source.rs"]
mod source;
#[path = "architecture/strict_text.rs"]
mod strict_text;
#[path = "architecture/through.rs"]
mod through;

use source::{Function, Source, root, set, sources, tokens};
use through::THROUGH;

/// Folders whose files exist twice, in `src/` and in `shaders/`.
const TWINS: [&str; 3] = ["shading", "trace", "transport"];

/// Functions whose twins differ or that have none: (folder and stem, function, why).
const ALONE: [(&str, &str, &str); 7] = [
    ("trace/ray", "lanes", "a register of the host"),
    ("shading/math", "rcp_each", "the host computes three at a time"),
    ("trace/traverse", "enter_instance", "`deepest` measures the stack, on the host only"),
    ("trace/traverse", "stack_used", "measures the stack for tests of bake's bound"),
    ("trace/traverse", "traverse", "`deepest` measures the stack, on the host only"),
    ("trace/traverse", "walk_mesh", "`deepest` measures the stack, on the host only"),
    ("trace/triangle", "signed_area", "the host computes three at a time"),
];

/// What of the house each folder may use, from the table in ARCHITECTURE.md; `None` stands for everything.
fn table() -> BTreeMap<String, Option<BTreeSet<String>>> {
    let text = std::fs::read_to_string(root().join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    let mut rules = BTreeMap::new();
    for line in text.lines().filter_map(|line| line.strip_prefix("| `src/")) {
        let columns: Vec<&str> = line.split('|').map(str::trim).collect();
        let [name, _, may_use, ..] = columns[..] else { panic!("a row of three columns: {line}") };
        let name = name.trim_end_matches('`').trim_end_matches('/').trim_end_matches(".rs");
        let rule = match without_brackets(may_use).trim() {
            "all" => None,
            "nothing" | "nothing of ours" => Some(BTreeSet::new()),
            list => Some(list.split(',').map(|folder| folder.trim().to_owned()).collect()),
        };
        rules.insert(name.to_owned(), rule);
    }
    rules
}

/// `bake (its data), layout` says `bake, layout`.
fn without_brackets(text: &str) -> String {
    let mut depth = 0;
    let mut keep = |c| {
        depth += i32::from(c == '(');
        let outside = depth == 0;
        depth -= i32::from(c == ')');
        outside
    };
    text.chars().filter(|c| keep(*c)).collect()
}

/// `src/render/cpu/mod.rs` belongs to `render`, `src/shaders.rs` to `shaders`.
fn folder_of(path: &str) -> &str {
    let below = path.split_once('/').map_or(path, |(_, below)| below);
    below.split(['/', '.']).next().unwrap_or_default()
}

/// Modules of the crate that a file names by `crate::a::b`, `use crate::{a, b::c}` or enough `super::`, with the place.
fn used_modules(file: &Source, modules: &BTreeSet<String>) -> Vec<(String, usize)> {
    let tokens = tokens(&file.code);
    let mut found = Vec::new();
    let is_path = |at: usize| tokens.get(at + 1).is_some_and(|t| t.text == "::");
    for (i, token) in tokens.iter().enumerate() {
        if token.text == "crate" && is_path(i) {
            // `pub(crate)` has no path behind it.
            found.extend(first_names(&tokens[i + 2..]).into_iter().map(|name| (name, token.at)));
        }
        let starts_chain = token.text == "super" && (i < 2 || tokens[i - 2].text != "super");
        if starts_chain && is_path(i) {
            let supers = tokens[i..].iter().step_by(2).take_while(|t| t.text == "super").count();
            // From `src/a/b.rs`, whose module is `crate::a::b`, two steps up is the crate.
            let depth = file.path.split('/').count() - if file.stem() == "mod" { 2 } else { 1 };
            if supers >= depth {
                let names = first_names(&tokens[i + 2 * supers..]);
                found.extend(names.into_iter().filter(|name| modules.contains(name)).map(|name| (name, token.at)));
            }
        }
    }
    found
}

/// The name at the start of a path, or those of a `{a::b, c}` group.
fn first_names(tokens: &[source::Token]) -> Vec<String> {
    let Some(first) = tokens.first() else { return Vec::new() };
    if first.text != "{" {
        return vec![first.text.to_owned()];
    }
    let mut depth = 0;
    let mut names = Vec::new();
    for (i, token) in tokens.iter().enumerate() {
        match token.text {
            "{" => depth += 1,
            "}" => depth -= 1,
            _ if depth == 1 && matches!(tokens[i - 1].text, "{" | ",") => names.push(token.text.to_owned()),
            _ => {}
        }
        if depth == 0 {
            break;
        }
    }
    names
}

/// What breaks the table in one file.
fn forbidden_uses(file: &Source, rules: &BTreeMap<String, Option<BTreeSet<String>>>) -> Vec<String> {
    let own = folder_of(&file.path);
    let Some(rule) = rules.get(own) else { return vec![format!("{}: src/{own} is not in the table", file.path)] };
    let Some(allowed) = rule else { return Vec::new() };
    let modules = rules.keys().cloned().collect();
    let uses = used_modules(file, &modules).into_iter();
    uses.filter(|(name, _)| name != own && !allowed.contains(name))
        .map(|(name, at)| format!("{}: src/{own} may not use {name}", file.place(at)))
        .collect()
}

#[test]
fn the_table_names_every_folder_and_only_what_exists() {
    let rules = table();
    let folders: BTreeSet<String> = sources("src", &["rs"])
        .iter()
        .map(|file| folder_of(&file.path).to_owned())
        .filter(|name| name != "lib" && name != "main")
        .collect();
    assert_eq!(rules.keys().cloned().collect::<BTreeSet<_>>(), folders, "the table (left) and src");
    for (name, rule) in &rules {
        let unknown: Vec<_> = rule.iter().flatten().filter(|used| !folders.contains(*used)).collect();
        assert!(unknown.is_empty(), "src/{name} may use {unknown:?}, which do not exist");
    }
}

#[test]
fn no_folder_uses_what_the_table_does_not_allow() {
    let rules = table();
    let files = sources("src", &["rs"]);
    let inside = files.iter().filter(|file| !matches!(folder_of(&file.path), "lib" | "main"));
    let found: Vec<_> = inside.flat_map(|file| forbidden_uses(file, &rules)).collect();
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn forbidden_uses_are_seen_however_they_are_written() {
    let rules = table();
    let uses = |path: &str, text: &str| forbidden_uses(&Source::new(path, text), &rules).len();
    assert_eq!(uses("src/layout/a.rs", "use crate::film::Film;"), 1);
    assert_eq!(uses("src/layout/a.rs", "use crate::{film::{Film, Rect}, layout::Node, scene::Scene};"), 2);
    assert_eq!(uses("src/layout/a.rs", "fn f(x: &crate::film::Film) {}"), 1);
    assert_eq!(uses("src/layout/a.rs", "use super::super::film::Film;"), 1);
    assert_eq!(uses("src/layout/mod.rs", "use super::film::Film;"), 1);
    assert_eq!(uses("src/layout/mod.rs", "mod tests { use super::*; }"), 0);
    assert_eq!(uses("src/layout/a.rs", "use crate::layout::b; pub(crate) fn f() {}"), 0);
    assert_eq!(uses("src/layout/a.rs", "// use crate::film::Film;\nconst A: &str = \"crate::film\";"), 0);
    assert_eq!(uses("src/cli/a.rs", "use crate::film::Film;"), 0);
    assert_eq!(uses("src/unheard_of/a.rs", ""), 1);
}

/// What GLSL includes from folders that its Rust twin may not use.
fn forbidden_includes(file: &Source, rules: &BTreeMap<String, Option<BTreeSet<String>>>) -> Vec<String> {
    let own = folder_of(&file.path);
    let allowed = rules[own].clone().unwrap_or_default();
    let includes = file.text.lines().filter_map(|line| line.strip_prefix("#include \""));
    let folders = includes.map(|rest| rest.split('/').next().unwrap_or_default());
    folders
        .filter(|folder| *folder != own && !allowed.contains(*folder))
        .map(|folder| format!("{}: shaders/{own} may not include {folder}", file.path))
        .collect()
}

#[test]
fn no_shader_includes_what_the_table_does_not_allow() {
    let rules = table();
    let files = TWINS.iter().flat_map(|folder| sources(&format!("shaders/{folder}"), &["glsl"]));
    let found: Vec<_> = files.flat_map(|file| forbidden_includes(&file, &rules)).collect();
    assert!(found.is_empty(), "{found:#?}");
    let wrong = Source::new("shaders/shading/a.glsl", "#include \"trace/b.glsl\"\n#include \"layout/mod.glsl\"\n");
    assert_eq!(forbidden_includes(&wrong, &rules), ["shaders/shading/a.glsl: shaders/shading may not include trace"]);
}

#[test]
fn every_shader_file_has_its_include_guard() {
    for file in sources("shaders", &["glsl"]) {
        let below = file.path.trim_start_matches("shaders/").trim_end_matches(".glsl");
        // `box_` has its underscore because `box` is a word of Rust.
        let guard = format!("{}_GLSL", below.trim_end_matches('_').replace('/', "_").to_uppercase());
        let lines = format!("#ifndef {guard}\n#define {guard}\n");
        assert!(file.text.contains(&lines), "{} lacks the guard {guard}", file.path);
    }
}

/// Whether a kernel reads what its lanes share before any of them is masked (ARCHITECTURE.md, "What lanes share").
fn begins(kernel: &str) -> bool {
    kernel.contains("void main() {\n    begin();\n") || kernel.contains("void main() {\n    begin_round();\n")
}

#[test]
fn every_kernel_that_reads_a_scene_begins_by_reading_what_lanes_share() {
    let kernels = sources("shaders/kernels", &["comp"]);
    let wrong: Vec<_> = kernels
        .iter()
        .filter(|file| file.text.contains("#include \"kernels/bindings.glsl\"") && !begins(&file.text))
        .map(|file| &file.path)
        .collect();
    assert!(wrong.is_empty(), "{wrong:?} do not");
    assert!(!begins("void main() {\n    if (header.aovs != 0u) return;\n    begin();\n"));
}

#[test]
fn no_file_is_longer_than_500_lines_and_no_kernel_than_80() {
    let mut found = Vec::new();
    for folder in ["src", "shaders", "tests", "build.rs"] {
        for file in sources(folder, &["rs", "glsl", "comp"]) {
            let lines = file.text.lines().count();
            let is_kernel = file.path.starts_with("shaders/kernels/") && file.path.matches('/').count() == 2;
            let is_entry = is_kernel && file.path.ends_with(".comp");
            let limit = if is_entry { 79 } else { 500 };
            if lines > limit {
                found.push(format!("{}: {lines} lines, at most {limit}", file.path));
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

/// Rust and GLSL files of a twin folder by stem, `mod` left out.
fn pairs(folder: &str) -> (BTreeMap<String, Source>, BTreeMap<String, Source>) {
    let by_stem = |files: Vec<Source>| {
        let named = files.into_iter().map(|file| (file.stem().to_owned(), file));
        named.filter(|(stem, _)| stem != "mod").collect::<BTreeMap<_, _>>()
    };
    (by_stem(sources(&format!("src/{folder}"), &["rs"])), by_stem(sources(&format!("shaders/{folder}"), &["glsl"])))
}

#[test]
fn every_twin_file_exists_on_both_sides() {
    for folder in TWINS {
        let (rust, glsl) = pairs(folder);
        assert!(rust.keys().eq(glsl.keys()), "{folder}: {:?} and {:?}", rust.keys(), glsl.keys());
    }
}

/// Functions by name.
fn functions(file: &Source) -> BTreeMap<String, Function> {
    file.functions().into_iter().map(|function| (function.name.clone(), function)).collect()
}

/// Arguments both twins must have, in their order: the scene, its header and the queues are global in GLSL, and a few
/// Rust names are words of GLSL.
fn common_arguments(function: &Function) -> Vec<String> {
    let plain = |name: &String| name.trim_start_matches('_').trim_end_matches("_record").to_owned();
    let names = function.arguments.iter().map(plain);
    names.filter(|name| !matches!(name.as_str(), "scene" | "header" | "queues")).collect()
}

/// How the functions of two twins differ.
fn differences(place: &str, rust: &Source, glsl: &Source) -> Vec<String> {
    let (rust, glsl) = (functions(rust), functions(glsl));
    // What is approximate steers the work and never decides: each side writes it as it is fastest there.
    let is_exempt = |name: &str| {
        name.starts_with("approx_") || ALONE.iter().any(|(at, function, _)| *at == place && *function == name)
    };
    let mut found = Vec::new();
    for name in rust.keys().chain(glsl.keys()).collect::<BTreeSet<_>>() {
        match (rust.get(name), glsl.get(name)) {
            _ if is_exempt(name) => {}
            (Some(_), None) => found.push(format!("{place}: `{name}` has no GLSL twin")),
            (None, _) => found.push(format!("{place}: `{name}` has no Rust twin")),
            (Some(rust), Some(glsl)) => {
                let (left, right) = (common_arguments(rust), common_arguments(glsl));
                if left != right {
                    found.push(format!("{place}: `{name}` takes {left:?} in Rust and {right:?} in GLSL"));
                }
                if rust.doc != glsl.doc {
                    found.push(format!("{place}: `{name}` says {:#?} in Rust and {:#?} in GLSL", rust.doc, glsl.doc));
                }
            }
        }
    }
    found
}

#[test]
fn twins_define_the_same_functions_with_the_same_arguments_and_words() {
    let mut found = Vec::new();
    for folder in TWINS {
        let (rust, glsl) = pairs(folder);
        for (stem, rust) in &rust {
            if let Some(glsl) = glsl.get(stem) {
                found.extend(differences(&format!("{folder}/{stem}"), rust, glsl));
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
    for (place, name, why) in ALONE {
        let (rust, _) = pairs(place.split('/').next().unwrap_or_default());
        let exists =
            rust.values().any(|file| file.path == format!("src/{place}.rs") && functions(file).contains_key(name));
        assert!(exists, "{place}: `{name}` is gone ({why}); remove it from ALONE");
    }
}

#[test]
fn a_twin_that_differs_in_a_name_an_argument_or_a_word_is_seen() {
    let compare = |rust: &str, glsl: &str| {
        differences("a", &Source::new("src/shading/a.rs", rust), &Source::new("shaders/shading/a.glsl", glsl)).len()
    };
    let rust = "pub fn f(scene: &SceneView, a: f32, _b: [f32; 3]) -> f32 {\n    a\n}\n";
    assert_eq!(compare(rust, "float f(float a, float b[3]) {\n    return a;\n}\n"), 0);
    assert_eq!(compare(rust, "float f(float b, float a) {\n    return a;\n}\n"), 1);
    assert_eq!(compare(rust, "float g(float a, float b) {\n    return a;\n}\n"), 2);
    assert_eq!(compare("fn private(a: f32) {}\n", "// float private(float a) {}\n"), 1);
    assert_eq!(compare("// nothing\n", "void f() {}\n"), 1);
    let glsl = "// One.\n// Two.\nfloat f(float a) {\n    return a;\n}\n";
    assert_eq!(compare("/// One.\n/// Two.\n#[inline]\nfn f(a: f32) -> f32 {\n    a\n}\n", glsl), 0);
    assert_eq!(compare("/// One.\n/// 2.\nfn f(a: f32) -> f32 {\n    a\n}\n", glsl), 1);
}

/// The code of a GLSL file with `#ifdef GONIO_FETCH ... #endif` blanked: what needs no scene.
fn without_scene(file: &Source) -> Source {
    let mut depth = 0;
    let lines = file.text.lines().map(|line| {
        match line.split(' ').next() {
            Some("#ifdef") if depth > 0 || line == "#ifdef GONIO_FETCH" => depth += 1,
            Some("#ifndef" | "#if") if depth > 0 => depth += 1,
            Some("#endif") if depth > 0 => depth -= 1,
            _ if depth == 0 => return line,
            _ => {}
        }
        ""
    });
    Source::new(file.path.clone(), lines.collect::<Vec<_>>().join("\n"))
}

#[test]
fn every_public_twin_that_needs_no_scene_is_run_by_a_parity_kernel() {
    let kernels = sources("shaders/kernels/parity", &["comp"]);
    let named: BTreeSet<String> =
        kernels.iter().flat_map(|file| tokens(&file.code)).map(|token| token.text.to_owned()).collect();
    let mut calls = BTreeMap::new();
    let mut public = BTreeSet::new();
    for folder in ["shading", "trace"] {
        let (rust, glsl) = pairs(folder);
        for (stem, file) in &glsl {
            let file = without_scene(file);
            for function in file.functions() {
                let is_public = |start: &str| rust[stem].code.contains(&format!("{start} {}(", function.name));
                if is_public("pub fn") || is_public("pub const fn") {
                    public.insert(function.name.clone());
                }
                let body: BTreeSet<_> = tokens(&file.code[function.body]).iter().map(|t| t.text.to_owned()).collect();
                calls.insert(function.name, body);
            }
        }
    }
    assert!(public.len() > 80, "the functions are not found any more: {public:?}");
    let through: BTreeMap<_, _> = THROUGH.into_iter().collect();
    let is_run = |name: &str| named.contains(name) || through.contains_key(name);
    let missing: Vec<_> = public.iter().filter(|name| !is_run(name)).collect();
    assert!(missing.is_empty(), "no parity kernel runs {missing:?}");
    for (name, caller) in THROUGH {
        assert!(public.contains(name) && !named.contains(name), "`{name}` has no place in THROUGH");
        if !name.starts_with("approx_") {
            assert!(is_run(caller) && calls[caller].contains(name), "`{caller}` does not run `{name}`");
        }
    }
}

#[test]
fn functions_that_read_the_scene_are_told_from_those_that_do_not() {
    let text = "float a() { return 1.0; }\n#ifdef GONIO_FETCH\n#ifdef X\n#endif\nfloat b() { return 2.0; }\n#endif\nfloat c() { return 3.0; }\n";
    let names = |file: Source| file.functions().into_iter().map(|function| function.name).collect::<Vec<_>>();
    assert_eq!(names(without_scene(&Source::new("shaders/shading/a.glsl", text))), ["a", "c"]);
}

/// Places where a word stands in code.
fn places_of(file: &Source, words: &BTreeSet<String>) -> Vec<String> {
    let tokens = tokens(&file.code);
    tokens.iter().filter(|token| words.contains(token.text)).map(|token| file.place(token.at)).collect()
}

/// Where `unsafe` may stand beside the Vulkan backend, and why.
const UNSAFE: [(&str, &str); 1] = [("src/cli/closed.rs", "only before `main` can a closed standard output be told")];

/// `unsafe` outside the Vulkan backend and `UNSAFE`, or without a `SAFETY:` comment on its line or the few above.
fn unjustified(file: &Source) -> Vec<String> {
    let lines: Vec<&str> = file.text.lines().collect();
    let mut found = Vec::new();
    for token in tokens(&file.code).iter().filter(|token| token.text == "unsafe") {
        let line = file.text[..token.at].matches('\n').count();
        // A statement may begin a few lines before its `unsafe`; a blank line ends what a comment speaks of.
        let above = lines[..=line].iter().rev().take(8).take_while(|text| !text.trim().is_empty());
        let is_justified = above.into_iter().any(|text| text.contains("// SAFETY:") || text.contains("/// # Safety"));
        let is_allowed =
            file.path.starts_with("src/render/vulkan/") || UNSAFE.iter().any(|(path, _)| *path == file.path);
        if !is_allowed || !is_justified {
            found.push(file.place(token.at));
        }
    }
    found
}

#[test]
fn unsafe_code_lives_in_the_vulkan_backend_and_says_why_it_is_sound() {
    let files = ["src", "tests", "shaders/build", "build.rs"].into_iter().flat_map(|folder| sources(folder, &["rs"]));
    let found: Vec<_> = files.flat_map(|file| unjustified(&file)).collect();
    assert!(found.is_empty(), "{found:#?}");
    let count = |path: &str, text: &str| unjustified(&Source::new(path, text)).len();
    let justified = "// SAFETY: the device is alive.\nlet a =\n    unsafe { f() };\n";
    assert_eq!(count("src/render/vulkan/a.rs", justified), 0);
    assert_eq!(count("src/render/vulkan/a.rs", "let a = unsafe { f() };\n"), 1);
    assert_eq!(count("src/render/vulkan/a.rs", "// SAFETY: no more.\n\nlet a = unsafe { f() };\n"), 1);
    assert_eq!(count("src/film/a.rs", justified), 1);
}

/// Files outside `src/cli` that may name a stream, and why.
const PRINTING: [(&str, &str); 1] = [("src/film/output.rs", "`-o -` writes the picture itself to standard output")];

#[test]
fn nothing_but_the_command_line_prints() {
    let words = set(&["print", "println", "eprint", "eprintln", "dbg", "stdout", "stderr"]);
    let mut found = Vec::new();
    for file in sources("src", &["rs"]) {
        let is_exempt = PRINTING.iter().any(|(path, _)| *path == file.path);
        if !matches!(folder_of(&file.path), "cli" | "main") && !is_exempt {
            let outside_tests = Source { code: file.strict_code(), ..file };
            found.extend(places_of(&outside_tests, &words));
        }
    }
    assert!(found.is_empty(), "printing outside src/cli: {found:#?}");
}

#[test]
fn only_bake_knows_the_bvh_builder() {
    let words = set(&["obvhs"]);
    let files = sources("src", &["rs"]);
    let outside = files.iter().filter(|file| folder_of(&file.path) != "bake");
    let found: Vec<_> = outside.flat_map(|file| places_of(file, &words)).collect();
    assert!(found.is_empty(), "obvhs outside src/bake: {found:#?}");
}

#[test]
fn words_in_comments_and_strings_are_not_code() {
    let text =
        "// unsafe\n/* unsafe\n*/ let a = \"unsafe \\\" unsafe\"; let b = r#\"unsafe\"#; let c = '\"'; fn f<'a>() {}\n";
    let file = Source::new("src/film/a.rs", text);
    assert!(places_of(&file, &set(&["unsafe"])).is_empty());
    assert_eq!(places_of(&file, &set(&["b", "f"])), ["src/film/a.rs:3", "src/film/a.rs:3"]);
    let file = Source::new("src/film/a.rs", "fn f() {\n    unsafe { g() }\n}\n");
    assert_eq!(places_of(&file, &set(&["unsafe"])), ["src/film/a.rs:2"]);
}
