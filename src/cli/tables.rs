//! Tables of a scene file as a user types them on a command line: `type=point, position=[0,3,2]`.

use crate::scene::load::toml::quoted;

/// The keys of a table, a line each; none if `text` is no list of keys and values. Braces around it may be there.
pub fn lines(text: &str) -> Option<String> {
    let text = text.trim();
    let text = text.strip_prefix('{').and_then(|text| text.strip_suffix('}')).unwrap_or(text);
    let line = |entry: String| {
        let (key, value) = entry.split_once('=')?;
        let (key, value) = (key.trim(), value.trim());
        let is_key = !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
        (is_key && !value.is_empty()).then(|| format!("{key} = {}", self::value(value)))
    };
    let lines: Option<Vec<String>> = entries(text).into_iter().map(line).collect();
    lines.map(|lines| lines.join("\n")).filter(|text| !text.is_empty())
}

/// A value; words need no quotation marks.
pub fn value(text: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "#_-./ ".contains(c);
    let starts = text.starts_with(|c: char| c.is_alphabetic() || "#/.".contains(c));
    let is_number = text.parse::<f64>().is_ok();
    let is_word = starts && text.chars().all(is_plain) && !is_number && !["true", "false"].contains(&text);
    if is_word { quoted(text) } else { text.to_owned() }
}

/// What stands between commas that are in no brackets and no quotation marks.
fn entries(text: &str) -> Vec<String> {
    let (mut entries, mut depth, mut quote) = (vec![String::new()], 0, None);
    for character in text.chars() {
        match (quote, character) {
            (Some(open), _) if character == open => quote = None,
            (None, '"' | '\'') => quote = Some(character),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            _ => {}
        }
        if character == ',' && quote.is_none() && depth == 0 {
            entries.push(String::new());
        } else if let Some(entry) = entries.last_mut() {
            entry.push(character);
        }
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_stand_on_lines_of_their_own_and_words_in_quotation_marks() {
        let text = "type=point, position=[0, 3,2], name=\"a, b\", casts_shadow=false, intensity=4e1";
        let expected = "type = \"point\"\nposition = [0, 3,2]\nname = \"a, b\"\ncasts_shadow = false\nintensity = 4e1";
        assert_eq!(lines(text).as_deref(), Some(expected));
        assert_eq!(lines(&format!("{{ {text} }}")).as_deref(), Some(expected));
        assert_eq!(lines("texture={pattern=\"checker\", scale=[2,2]}").expect("keys").lines().count(), 1);
        for wrong in ["", "point", "=3", "a=", "a=1,,b=2", "a b=1"] {
            assert_eq!(lines(wrong), None, "{wrong}");
        }
    }
}
