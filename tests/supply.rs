//! What the program is built of: licences that fit its own, one version of each crate, one source. `deny.toml` has the lists; a
//! line of it that is needed no more fails too.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// Every crate that a build for this machine takes, tests included, as `cargo metadata` tells.
fn packages() -> Vec<Value> {
    let cargo = |program: &str, args: &[&str]| {
        let output = Command::new(program).args(args).current_dir(env!("CARGO_MANIFEST_DIR")).output();
        let output = output.unwrap_or_else(|error| panic!("{program}: {error}"));
        assert!(output.status.success(), "{program} {args:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("UTF-8")
    };
    let version = cargo("rustc", &["-vV"]);
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).expect("a host");
    let args = ["metadata", "--format-version", "1", "--locked", "--offline", "--filter-platform", host];
    let told: Value = serde_json::from_str(&cargo(env!("CARGO"), &args)).expect("JSON");
    let packages = told["packages"].as_array().expect("packages").clone();
    assert!(packages.len() > 100, "{} crates", packages.len());
    packages
}

fn deny() -> toml::Table {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/deny.toml");
    std::fs::read_to_string(path).expect("deny.toml").parse().expect("TOML")
}

fn text<'a>(package: &'a Value, key: &str) -> &'a str {
    package[key].as_str().unwrap_or_default()
}

/// Whether the licences of `allowed` are enough for an SPDX expression, and which of them it takes. An older form of `OR` is `/`.
fn is_allowed(expression: &str, allowed: &BTreeSet<String>) -> Option<BTreeSet<String>> {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let tokens: Vec<&str> = spaced.split_whitespace().collect();
    let (taken, rest) = alternatives(&tokens, allowed);
    assert!(rest.is_empty(), "{expression}: {rest:?} is left over");
    taken
}

type Taken<'a, 'b> = (Option<BTreeSet<String>>, &'a [&'b str]);

/// `a AND b OR c`: the first alternative that is allowed, and the tokens behind all of them.
fn alternatives<'a, 'b>(tokens: &'a [&'b str], allowed: &BTreeSet<String>) -> Taken<'a, 'b> {
    let (mut found, mut rest) = together(tokens, allowed);
    while let ["OR", next @ ..] = rest {
        let (other, behind) = together(next, allowed);
        (found, rest) = (found.or(other), behind);
    }
    (found, rest)
}

fn together<'a, 'b>(tokens: &'a [&'b str], allowed: &BTreeSet<String>) -> Taken<'a, 'b> {
    let (mut found, mut rest) = one(tokens, allowed);
    while let ["AND", next @ ..] = rest {
        let (other, behind) = one(next, allowed);
        found = found.zip(other).map(|(mut all, more)| {
            all.extend(more);
            all
        });
        rest = behind;
    }
    (found, rest)
}

fn one<'a, 'b>(tokens: &'a [&'b str], allowed: &BTreeSet<String>) -> Taken<'a, 'b> {
    let named = |name: String| allowed.contains(&name).then(|| BTreeSet::from([name]));
    match tokens {
        ["(", inner @ ..] => match alternatives(inner, allowed) {
            (found, [")", rest @ ..]) => (found, rest),
            (_, rest) => panic!("no closing parenthesis before {rest:?}"),
        },
        [name, "WITH", exception, rest @ ..] => (named(format!("{name} WITH {exception}")), rest),
        [name, rest @ ..] => (named((*name).to_owned()), rest),
        [] => panic!("a licence is missing"),
    }
}

#[test]
fn every_crate_has_a_licence_that_is_allowed_and_no_licence_is_allowed_in_vain() {
    let listed = deny()["licenses"]["allow"].as_array().expect("a list").clone();
    let allowed: BTreeSet<String> = listed.iter().filter_map(|name| Some(name.as_str()?.to_owned())).collect();
    let mut taken = BTreeSet::new();
    for package in packages() {
        let name = text(&package, "name");
        let licence = text(&package, "license");
        assert!(!licence.is_empty(), "{name} tells no licence");
        taken.extend(is_allowed(licence, &allowed).unwrap_or_else(|| panic!("{name}: {licence} is not allowed")));
    }
    assert_eq!(taken, allowed, "allowed in deny.toml and taken by a crate");
}

#[test]
fn licences_are_read_as_spdx_means_them() {
    let allowed = BTreeSet::from(["A".to_owned(), "B".to_owned(), "C WITH x".to_owned()]);
    for (expression, is_enough) in [
        ("A", true),
        ("D", false),
        ("D OR A", true),
        ("D/B", true),
        ("A AND D", false),
        ("A AND B", true),
        ("D AND A OR B", true),
        ("D AND (A OR B)", false),
        ("(D OR A) AND B", true),
        ("C WITH x OR D", true),
        ("C", false),
        ("A WITH x", false),
    ] {
        assert_eq!(is_allowed(expression, &allowed).is_some(), is_enough, "{expression}");
    }
}

#[test]
fn every_crate_comes_from_the_one_registry() {
    for package in packages() {
        let (name, source) = (text(&package, "name"), text(&package, "source"));
        let is_ours = name == env!("CARGO_PKG_NAME") && source.is_empty();
        assert!(is_ours || source == "registry+https://github.com/rust-lang/crates.io-index", "{name}: {source:?}");
    }
}

#[test]
fn a_crate_has_one_version_but_for_those_that_are_listed_and_those_are_needed() {
    let mut versions: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for package in packages() {
        versions.entry(text(&package, "name").into()).or_default().insert(text(&package, "version").into());
    }
    versions.retain(|_, versions| versions.len() > 1);
    let skipped = deny()["bans"]["skip"].as_array().expect("a list").clone();
    for skip in &skipped {
        let (name, version) = skip["crate"].as_str().and_then(|text| text.split_once('@')).expect("NAME@VERSION");
        let found = versions.get_mut(name).unwrap_or_else(|| panic!("{name} has one version: no need to list it"));
        let before = found.len();
        found.retain(|other| other != version && !other.starts_with(&format!("{version}.")));
        assert!(found.len() < before, "{name}@{version} is not there");
    }
    versions.retain(|_, versions| versions.len() > 1);
    assert!(versions.is_empty(), "several versions: {versions:#?}");
}
