//! `gonio verify`: what can be asked of it.

use super::support::{Folder, has_device};

#[test]
fn functions_are_compared_on_as_many_arguments_as_asked_for() {
    if !has_device() {
        return;
    }
    let folder = Folder::new();
    let out = folder.done(&["verify", "--functions", "300000", "--only", "fresnel_dielectric", "--json"]);
    let rows: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    let rows = rows.as_array().expect("rows");
    assert_eq!(rows.len(), 1, "{out}");
    let row = &rows[0];
    assert_eq!((&row["proof"], &row["outcome"]), (&"functions".into(), &"proved".into()), "{row}");
    assert_eq!((&row["measures"]["count"], &row["measures"]["differ"]), (&300_000.into(), &0.into()), "{row}");
    let table = folder.done(&["verify", "--functions", "100", "--only", "asin_"]);
    assert!(table.ends_with("1 proved, 0 not, 0 skipped\n"), "{table}");
}

#[test]
fn nothing_to_verify_is_wrong_usage() {
    let folder = Folder::new();
    assert!(folder.fails(2, &["verify"]).contains("--functions or --mitsuba DIR"));
    folder.fails(2, &["verify", "--functions", "0"]);
    assert!(folder.fails(2, &["verify", "--functions", "--backend", "cpu"]).contains("--backend cpu"));
    if has_device() {
        let message = folder.fails(2, &["verify", "--functions", "10", "--only", "frensel"]);
        assert!(message.contains("named frensel"), "{message}");
    }
}

#[test]
fn folder_without_references_is_refused_with_what_was_expected() {
    let folder = Folder::new();
    let message = folder.fails(2, &["verify", "--mitsuba", "."]);
    assert!(message.starts_with("error: .: no scene with a reference; expected NAME_INTEGRATOR.xml"), "{message}");
}
