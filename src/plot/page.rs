//! The gallery's page: one HTML file that needs nothing else.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// What the page shows of one scene.
pub struct Entry {
    /// The file's stem.
    pub name: String,
    pub row: Option<u32>,
    pub caption: String,
    pub formula: Option<&'static str>,
    /// A PNG file.
    pub picture: Vec<u8>,
    /// An SVG file.
    pub plot: Option<String>,
    /// The scene file.
    pub text: String,
}

const STYLE: &str = "\
:root{color-scheme:light}\
body{margin:0 auto;padding:1rem;max-width:60rem;font:1rem/1.5 'Noto Sans',system-ui,sans-serif;color:#1e1e1e;background:#fff}\
h1{font-size:1.6rem;line-height:1.2}h2{font-size:1.2rem;margin:0 0 .3rem}\
section{border-top:1px solid #ccc;padding:1.2rem 0}\
nav{line-height:2}nav a{margin-right:.8rem;white-space:nowrap}a{color:#0b57a4}\
img,svg{display:block;max-width:100%;height:auto;margin:.6rem 0}\
.plot{overflow-x:auto}.plot svg{min-width:36rem}\
.formula{font-style:italic;background:#f4f4f4;padding:.5rem .7rem;overflow-wrap:anywhere}\
pre{overflow-x:auto;background:#f4f4f4;padding:.7rem;font-size:.85rem}summary{cursor:pointer}";

/// Text as HTML shows it.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The row and the name; a number that the file's name begins with is that row's.
fn heading(entry: &Entry) -> String {
    match entry.row {
        Some(row) => {
            let name = entry.name.trim_start_matches(|c: char| c.is_ascii_digit()).trim_start_matches('-');
            format!("{row} · {}", escaped(name))
        }
        None => escaped(&entry.name),
    }
}

/// The page of `entries`, in their order.
pub fn page(title: &str, entries: &[Entry]) -> String {
    let title = escaped(title);
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n<nav>\n"
    );
    for entry in entries {
        page.push_str(&format!("<a href=\"#{}\">{}</a>\n", escaped(&entry.name), heading(entry)));
    }
    page.push_str("</nav>\n");
    for entry in entries {
        page.push_str(&section(entry));
    }
    page.push_str("</body>\n</html>\n");
    page
}

fn section(entry: &Entry) -> String {
    let name = escaped(&entry.name);
    let mut html =
        format!("<section id=\"{name}\">\n<h2>{}</h2>\n<p>{}</p>\n", heading(entry), escaped(&entry.caption));
    if let Some(formula) = entry.formula {
        html.push_str(&format!("<p class=\"formula\">{}</p>\n", escaped(formula)));
    }
    let picture = STANDARD.encode(&entry.picture);
    html.push_str(&format!("<img alt=\"{name}\" src=\"data:image/png;base64,{picture}\">\n"));
    if let Some(plot) = &entry.plot {
        // A narrow screen scrolls it: smaller, its words could not be read.
        html.push_str(&format!("<div class=\"plot\">{plot}</div>\n"));
    }
    html.push_str(&format!(
        "<details>\n<summary>{name}.toml</summary>\n<pre>{}</pre>\n</details>\n</section>\n",
        escaped(&entry.text)
    ));
    html
}
