//! Scenes of Mitsuba before version 2, as Mitsuba 3 itself reads them: other names for the same things.

/// Properties that are gone; what they chose is always so, or has no meaning here.
const GONE: [&str; 3] = ["banner", "attach_log", "strict_normals"];

/// The tag of an element of an old scene today.
pub fn tag(tag: &str) -> &str {
    if tag == "lookAt" { "lookat" } else { tag }
}

/// Whether an element of an old scene has no meaning any more.
pub fn is_gone(tag: &str, name: Option<&str>) -> bool {
    matches!(tag, "boolean" | "float" | "string" | "integer") && name.is_some_and(|name| GONE.contains(&name))
}

/// The name of a property of an old scene today: `toWorld` is `to_world`. `parent`: the type of the object that has it.
pub fn name(name: &str, parent: Option<&str>) -> String {
    let mut result = String::with_capacity(name.len() + 4);
    let mut lower = false;
    for c in name.chars() {
        if lower && c.is_ascii_uppercase() {
            result.push('_');
            result.push(c.to_ascii_lowercase());
        } else {
            result.push(c);
        }
        lower = c.is_ascii_lowercase();
    }
    // A run of capitals is one word: `intIOR` is `int_ior`.
    let result = match result.find('_') {
        Some(_) => result.to_ascii_lowercase(),
        None => result,
    };
    match (parent, result.as_str()) {
        (Some("diffuse"), "diffuse_reflectance") => "reflectance".to_owned(),
        _ => result,
    }
}

/// What `uoffset`, `voffset`, `uscale` and `vscale` of a texture are: steps of `to_uv`, (tag, [x, y]).
pub fn steps(value: impl Fn(&str) -> Option<String>) -> Vec<(&'static str, [String; 2])> {
    let pair = |tag: &'static str, names: [&str; 2], default: &str| {
        let values = names.map(&value);
        let written = values.iter().any(Option::is_some);
        written.then(|| (tag, values.map(|value| value.unwrap_or_else(|| default.to_owned()))))
    };
    [pair("translate", ["uoffset", "voffset"], "0"), pair("scale", ["uscale", "vscale"], "1")]
        .into_iter()
        .flatten()
        .collect()
}

/// The names that `steps` takes.
pub const PLACES: [&str; 4] = ["uoffset", "voffset", "uscale", "vscale"];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn camel_case_becomes_words_and_names_without_stay() {
        for (old, new) in [
            ("toWorld", "to_world"),
            ("intIOR", "int_ior"),
            ("fovAxis", "fov_axis"),
            ("alphaU", "alpha_u"),
            ("alpha", "alpha"),
            ("B", "B"),
            ("sampleCount", "sample_count"),
        ] {
            assert_eq!(name(old, None), new);
        }
        assert_eq!(name("diffuseReflectance", Some("diffuse")), "reflectance");
        assert_eq!(name("diffuseReflectance", Some("plastic")), "diffuse_reflectance");
    }
}
