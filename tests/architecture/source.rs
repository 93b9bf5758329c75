//! Source text as the architecture tests see it: without comments and strings, cut into tokens and functions.

use std::collections::BTreeSet;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// One file.
pub struct Source {
    /// Path from the root of the project, with `/`.
    pub path: String,
    pub text: String,
    /// The text with comments, strings and character literals blanked: same length, same lines.
    pub code: String,
}

/// A free function.
#[derive(Clone, Debug)]
pub struct Function {
    pub name: String,
    /// Names of the arguments.
    pub arguments: Vec<String>,
    /// Lines of the comment above, without markers.
    pub doc: Vec<String>,
    /// Bytes of the body, braces included.
    pub body: Range<usize>,
}

/// A word, number or operator, and where it starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token<'a> {
    pub text: &'a str,
    pub at: usize,
}

pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Every file below `folder` (or the file itself) whose extension is listed, sorted by path.
pub fn sources(folder: &str, extensions: &[&str]) -> Vec<Source> {
    let mut paths = Vec::new();
    collect(&root().join(folder), &mut paths);
    paths.sort();
    let wanted = |path: &PathBuf| path.extension().and_then(|e| e.to_str()).is_some_and(|e| extensions.contains(&e));
    paths.into_iter().filter(wanted).map(|path| Source::read(&path)).collect()
}

fn collect(path: &Path, into: &mut Vec<PathBuf>) {
    if path.is_file() {
        into.push(path.to_owned());
    } else if let Ok(entries) = fs::read_dir(path) {
        entries.for_each(|entry| collect(&entry.expect("readable").path(), into));
    }
}

impl Source {
    fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let below = path.strip_prefix(root()).expect("below the root");
        let path = below.iter().map(|part| part.to_str().expect("plain names")).collect::<Vec<_>>().join("/");
        Self::new(path, text)
    }

    pub fn new(path: impl Into<String>, text: impl Into<String>) -> Self {
        let (path, text) = (path.into(), text.into());
        let code = blank_comments_and_strings(&text);
        Source { path, text, code }
    }

    /// `fresnel` for `src/shading/fresnel.rs`.
    pub fn stem(&self) -> &str {
        let file = self.path.rsplit('/').next().unwrap_or_default();
        file.split('.').next().unwrap_or_default()
    }

    /// `path:line` of a byte.
    pub fn place(&self, at: usize) -> String {
        format!("{}:{}", self.path, self.text[..at].matches('\n').count() + 1)
    }

    /// The whole line a byte is in, comments included.
    pub fn line(&self, at: usize) -> &str {
        let start = self.text[..at].rfind('\n').map_or(0, |i| i + 1);
        self.text[start..].lines().next().unwrap_or_default()
    }

    /// The code with the bodies of items under `#[cfg(test)]` and of functions named `approx_*` blanked.
    pub fn strict_code(&self) -> String {
        let mut code = self.code.clone();
        let tests = self
            .code
            .match_indices("#[cfg(test)]")
            .filter_map(|(at, attribute)| body(&self.code, at + attribute.len()));
        let approximate = self.functions().into_iter().filter(|f| f.name.starts_with("approx_")).map(|f| f.body);
        for range in tests.chain(approximate) {
            let blank = blanked(&code[range.clone()]);
            code.replace_range(range, &blank);
        }
        code
    }

    /// Functions defined at the left margin, outside `impl` and test modules.
    pub fn functions(&self) -> Vec<Function> {
        let is_rust = self.path.ends_with(".rs");
        let mut found = Vec::new();
        let mut at = 0;
        for line in self.code.split_inclusive('\n') {
            let name = if is_rust { rust_function(line) } else { glsl_function(line) };
            if let Some(name) = name {
                let open = at + self.code[at..].find('(').expect("arguments");
                let close = matching(&self.code, open).expect("closed arguments");
                found.push(Function {
                    name: name.to_owned(),
                    arguments: arguments(&self.code[open + 1..close], is_rust),
                    doc: self.doc_above(at),
                    body: body(&self.code, close + 1).expect("a body"),
                });
            }
            at += line.len();
        }
        found
    }

    fn doc_above(&self, at: usize) -> Vec<String> {
        let above = self.text[..at].lines().rev().filter(|line| !line.starts_with("#["));
        let comment = |line: &str| line.trim_start_matches('/').trim().to_owned();
        let mut doc: Vec<_> = above.take_while(|line| line.starts_with("//")).map(comment).collect();
        doc.reverse();
        doc
    }
}

fn rust_function(line: &str) -> Option<&str> {
    let mut rest = line;
    if let Some(after) = rest.strip_prefix("pub") {
        rest = after.strip_prefix("(crate)").or_else(|| after.strip_prefix("(super)")).unwrap_or(after).trim_start();
    }
    rest = rest.strip_prefix("const ").unwrap_or(rest);
    let name = rest.strip_prefix("fn ")?;
    Some(&name[..name.find(['(', '<'])?])
}

/// `vec3 name(` at the left margin; a declaration without a body is no definition.
fn glsl_function(line: &str) -> Option<&str> {
    let (head, rest) = line.split_once('(')?;
    let (kind, name) = head.split_once(' ')?;
    let is_word = |word: &str| !word.is_empty() && word.chars().all(|c| c.is_alphanumeric() || c == '_');
    let is_definition = !rest.trim_end().ends_with(';') || rest.contains('{');
    (is_word(kind) && is_word(name) && kind != "layout" && is_definition).then_some(name)
}

/// Names of the arguments in `a: f32, b: &mut Vec3` or `float a, inout vec3 b`.
fn arguments(list: &str, is_rust: bool) -> Vec<String> {
    let mut depth = 0;
    let mut found = vec![String::new()];
    for c in list.chars() {
        match c {
            '(' | '[' | '<' => depth += 1,
            ')' | ']' | '>' => depth -= 1,
            ',' if depth == 0 => {
                found.push(String::new());
                continue;
            }
            _ => {}
        }
        found.last_mut().expect("never empty").push(c);
    }
    let name = |argument: String| {
        if is_rust {
            argument.split(':').next().unwrap_or_default().trim().trim_start_matches("mut ").to_owned()
        } else {
            let last = argument.split_whitespace().last().unwrap_or_default();
            last.split('[').next().unwrap_or_default().to_owned()
        }
    };
    found.into_iter().map(name).filter(|name| !name.is_empty() && name != "void").collect()
}

/// Where the bracket that closes the one at `open` stands.
pub fn matching(code: &str, open: usize) -> Option<usize> {
    let mut depth = 0;
    for (at, c) in code[open..].char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(open + at);
        }
    }
    None
}

/// The next `{ ... }` from a byte on, unless a `;` outside brackets (`[f32; 3]`) comes first.
fn body(code: &str, from: usize) -> Option<Range<usize>> {
    let mut depth = 0;
    for (at, c) in code[from..].char_indices() {
        match c {
            '[' => depth += 1,
            ']' => depth -= 1,
            ';' if depth == 0 => return None,
            '{' if depth == 0 => return matching(code, from + at).map(|close| from + at..close + 1),
            _ => {}
        }
    }
    None
}

fn blanked(text: &str) -> String {
    text.bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }).collect()
}

/// The same number of bytes, with comments, strings and characters replaced by blanks.
fn blank_comments_and_strings(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    let mut at = 0;
    while at < text.len() {
        let rest = &text[at..];
        let length = hidden_length(rest, result.ends_with(|c: char| c.is_alphanumeric() || c == '_'));
        let step = length.unwrap_or_else(|| rest.chars().next().map_or(1, char::len_utf8));
        match length {
            Some(_) => result.push_str(&blanked(&rest[..step])),
            None => result.push_str(&rest[..step]),
        }
        at += step;
    }
    result
}

/// Bytes of the comment, string or character at the start of the text, if there is one.
fn hidden_length(text: &str, in_word: bool) -> Option<usize> {
    if text.starts_with("//") {
        return Some(text.find('\n').unwrap_or(text.len()));
    }
    if text.starts_with("/*") {
        return Some(text.find("*/").map_or(text.len(), |end| end + 2));
    }
    if !in_word && (text.starts_with("r\"") || text.starts_with("r#")) {
        let hashes = text[1..].bytes().take_while(|b| *b == b'#').count();
        let end = format!("\"{}", "#".repeat(hashes));
        let start = 1 + hashes;
        if text[start..].starts_with('"') {
            return Some(text[start + 1..].find(&end).map_or(text.len(), |i| start + 1 + i + end.len()));
        }
    }
    if text.starts_with('"') {
        let mut escaped = false;
        for (at, c) in text.char_indices().skip(1) {
            match c {
                _ if escaped => escaped = false,
                '\\' => escaped = true,
                '"' => return Some(at + 1),
                _ => {}
            }
        }
        return Some(text.len());
    }
    if let Some(rest) = text.strip_prefix('\'') {
        // A lifetime has no closing quote.
        if rest.starts_with('\\') {
            return rest[2..].find('\'').map(|end| end + 4);
        }
        let first = rest.chars().next()?;
        return rest[first.len_utf8()..].starts_with('\'').then(|| first.len_utf8() + 2);
    }
    None
}

/// Words, numbers and operators of code without comments and strings.
pub fn tokens(code: &str) -> Vec<Token<'_>> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(c) = code[at..].chars().next() {
        let rest = &code[at..];
        let length = if c.is_alphabetic() || c == '_' {
            rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len())
        } else if c.is_ascii_digit() || (c == '.' && rest[1..].starts_with(|d: char| d.is_ascii_digit())) {
            number_length(rest)
        } else {
            let two = rest.get(..2).filter(|two| OPERATORS.contains(two));
            two.map_or(c.len_utf8(), str::len)
        };
        if !c.is_whitespace() {
            found.push(Token { text: &rest[..length], at });
        }
        at += length;
    }
    found
}

const OPERATORS: [&str; 20] = [
    "+=", "-=", "*=", "/=", "%=", "==", "!=", "<=", ">=", "&&", "||", "<<", ">>", "->", "=>", "::", "..", "++", "--",
    "^=",
];

fn number_length(text: &str) -> usize {
    let is_hex = text.starts_with("0x");
    let mut previous = ' ';
    for (at, c) in text.char_indices() {
        let sign_of_exponent = matches!(c, '+' | '-') && !is_hex && matches!(previous, 'e' | 'E');
        // `1..n` is a range and `1.max(2)` a call.
        let next = text[at + c.len_utf8()..].chars().next().unwrap_or(' ');
        let point = c == '.' && next != '.' && !next.is_alphabetic() && next != '_';
        if !(c.is_alphanumeric() || c == '_' || sign_of_exponent || point) {
            return at;
        }
        previous = c;
    }
    text.len()
}

/// A number with a point or an exponent.
pub fn is_float_literal(token: &str) -> bool {
    let number = token.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    number && !token.starts_with("0x") && token.contains(['.', 'e', 'E'])
}

/// A number without.
pub fn is_integer_literal(token: &str) -> bool {
    token.starts_with(|c: char| c.is_ascii_digit()) && !is_float_literal(token) && !token.ends_with("f32")
}

pub fn set(names: &[&str]) -> BTreeSet<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}
