//! Proofs as rows of one table.

use serde::Serialize;

/// How a proof ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    Proved,
    /// It was tried and is not so.
    Unproved,
    /// It could not be tried; why is in the row.
    Skipped,
}

/// One proof of one thing on one backend.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The kind of proof.
    pub proof: &'static str,
    /// What it is about: a scene, a function.
    pub subject: String,
    pub backend: String,
    pub outcome: Outcome,
    /// What was measured and what was demanded, or why it was not tried.
    pub finding: String,
    /// Numbers of the measurement, for `--json`.
    #[serde(skip_serializing_if = "serde_json::Value::is_null")]
    pub measures: serde_json::Value,
    pub seconds: f64,
}

impl Row {
    fn mark(&self) -> &'static str {
        match self.outcome {
            Outcome::Proved => "ok",
            Outcome::Unproved => "FAIL",
            Outcome::Skipped => "skip",
        }
    }
}

/// Rows and a summary as text: columns as wide as they need.
pub fn table(rows: &[Row]) -> String {
    let width = |text: fn(&Row) -> &str| rows.iter().map(|row| text(row).chars().count()).max().unwrap_or(0);
    let (proof, subject) = (width(|row| row.proof), width(|row| &row.subject));
    let mut text = String::new();
    for row in rows {
        text.push_str(&format!(
            "{:4}  {:proof$}  {:subject$}  {:>7.2} s  {}\n",
            row.mark(),
            row.proof,
            row.subject,
            row.seconds,
            row.finding
        ));
    }
    let count = |outcome: Outcome| rows.iter().filter(|row| row.outcome == outcome).count();
    let (proved, unproved, skipped) = (count(Outcome::Proved), count(Outcome::Unproved), count(Outcome::Skipped));
    text.push_str(&format!("{proved} proved, {unproved} not, {skipped} skipped\n"));
    text
}

/// True if something was proved and nothing was refuted.
pub fn all_proved(rows: &[Row]) -> bool {
    rows.iter().any(|row| row.outcome == Outcome::Proved) && rows.iter().all(|row| row.outcome != Outcome::Unproved)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(outcome: Outcome) -> Row {
        Row {
            proof: "z-test",
            subject: "a.xml".to_owned(),
            backend: "cpu".to_owned(),
            outcome,
            finding: "99.9 %".to_owned(),
            measures: serde_json::Value::Null,
            seconds: 1.0,
        }
    }

    #[test]
    fn nothing_proved_is_not_all_proved() {
        assert!(!all_proved(&[]) && !all_proved(&[row(Outcome::Skipped)]));
        assert!(all_proved(&[row(Outcome::Proved), row(Outcome::Skipped)]));
        assert!(!all_proved(&[row(Outcome::Proved), row(Outcome::Unproved)]));
    }

    #[test]
    fn the_table_counts_its_rows() {
        let text = table(&[row(Outcome::Proved), row(Outcome::Unproved)]);
        assert_eq!(
            text,
            "ok    z-test  a.xml     1.00 s  99.9 %\nFAIL  z-test  a.xml     1.00 s  99.9 %\n1 proved, 1 not, 0 skipped\n"
        );
    }
}
