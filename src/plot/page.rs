//! The gallery's page: one HTML file that needs nothing else.

use super::lecture::{Row, row_of};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use pulldown_latex::config::DisplayMode;
use pulldown_latex::{Parser, RenderConfig, Storage, push_mathml};

/// What the page shows of one scene.
pub struct Content {
    /// The file's stem.
    pub name: String,
    pub caption: String,
    /// How it was rendered.
    pub settings: String,
    /// PNG files and their labels; a picture that is not divided has one without.
    pub pictures: Vec<(Option<String>, Vec<u8>)>,
    /// Pictures in a row, where there is room for them.
    pub columns: usize,
    /// SVG files.
    pub plots: Vec<String>,
    /// The scene file.
    pub text: String,
}

/// A scene of the page.
pub struct Entry {
    /// The file's stem.
    pub name: String,
    pub row: Option<u32>,
    /// The name without the row's number.
    pub title: String,
    /// Stands for all that the scene's HTML depends on.
    pub key: String,
    /// HTML, by `body` now or when the page was last made.
    pub body: String,
}

/// A part of the page: a row of the lecture, or a scene that belongs to none.
pub struct Part {
    pub entries: Vec<Entry>,
}

impl Part {
    fn row(&self) -> Option<&'static Row> {
        self.entries.first().and_then(|entry| entry.row).and_then(row_of)
    }

    /// The row's number and name, else the first scene's.
    fn heading(&self) -> String {
        let first = self.entries.first();
        match (self.row(), first) {
            (Some(row), _) => format!("{} · {}", row.number, escaped(row.title)),
            (None, Some(entry)) => escaped(&entry.title),
            (None, None) => String::new(),
        }
    }

    fn id(&self) -> String {
        self.entries.first().map_or(String::new(), |entry| match entry.row {
            Some(row) => format!("row-{row}"),
            None => escaped(&entry.name),
        })
    }
}

const STYLE: &str = "\
:root{color-scheme:light}\
*{box-sizing:border-box}\
body{margin:0 auto;padding:1rem;max-width:68rem;font:1rem/1.5 'Noto Sans',system-ui,sans-serif;color:#1e1e1e;background:#fff}\
h1{font-size:1.8rem;line-height:1.2;margin:.5rem 0 1rem}h2{font-size:1.4rem;line-height:1.25;margin:0 0 .6rem}\
h3{font-size:1.05rem;margin:1.6rem 0 .3rem}p{margin:.5rem 0;max-width:58rem}\
dialog{border:0;padding:0;width:100vw;height:100vh;max-width:none;max-height:none;background:#111}dialog img{width:100%;height:100%;object-fit:contain}dialog p{position:fixed;bottom:.5rem;left:1rem;margin:0;color:#ddd}\
.panels img{cursor:zoom-in}.facts{color:#666;font-size:.9rem}\
section{border-top:1px solid #ccc;padding:1.6rem 0}\
nav{columns:17rem;line-height:1.8}nav a{display:block}a{color:#0b57a4}\
.formula{background:#f4f4f4;padding:.5rem .8rem;overflow-x:auto;overflow-y:hidden}\
math{font-family:'STIX Two Math','Cambria Math','Latin Modern Math','DejaVu Math TeX Gyre','Noto Sans Math',math;font-size:1.15rem;margin:.45rem 0}math[display=block]{text-align:left;width:max-content}\
.panels{display:grid;gap:.5rem;grid-template-columns:repeat(var(--columns),minmax(0,1fr));margin:.7rem 0}\
figure{margin:0}figcaption{text-align:center;font-size:.95rem;line-height:1.3;padding:.2rem 0}\
img,svg{display:block;max-width:100%;height:auto;margin:0 auto}\
.panels.several img{width:100%}\
.plots{display:grid;gap:1rem;grid-template-columns:repeat(auto-fit,minmax(min(100%,28rem),1fr));margin:1rem 0}\
@media(max-width:40rem){math{font-size:.88rem}.panels{grid-template-columns:repeat(var(--narrow),minmax(0,1fr));gap:.3rem}figcaption{font-size:.8rem}}\
pre{overflow-x:auto;background:#f4f4f4;padding:.7rem;font-size:.85rem;line-height:1.4}summary{cursor:pointer;color:#555}";

/// Text as HTML shows it.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Text whose words between backticks are code.
fn quoted(text: &str) -> String {
    let parts = escaped(text);
    let part = |(i, part): (usize, &str)| if i % 2 == 1 { format!("<code>{part}</code>") } else { part.to_owned() };
    parts.split('`').enumerate().map(part).collect()
}

/// A formula in LaTeX as MathML. What is no LaTeX is shown in red.
pub fn mathml(latex: &str) -> String {
    let storage = Storage::new();
    let config = RenderConfig { display_mode: DisplayMode::Block, ..RenderConfig::default() };
    let mut math = String::new();
    let pushed = push_mathml(&mut math, Parser::new(latex, &storage), config);
    debug_assert!(pushed.is_ok(), "{latex}: {pushed:?}");
    math
}

/// A picture fills the screen when it is clicked; arrow keys go on to others, Escape goes back.
const SCRIPT: &str = "\
const all=[...document.querySelectorAll('.panels img')],d=document.querySelector('dialog'),i=d.querySelector('img'),p=d.querySelector('p');let n=0;\
const show=k=>{n=(k+all.length)%all.length;i.src=all[n].src;p.textContent=all[n].alt;if(!d.open)d.showModal()};\
all.forEach((e,k)=>e.onclick=()=>show(k));d.onclick=()=>d.close();\
d.onkeydown=e=>{const s={ArrowRight:1,ArrowDown:1,ArrowLeft:-1,ArrowUp:-1}[e.key];if(s){e.preventDefault();show(n+s)}};";

/// The page of `parts`, in their order. `facts`: what all scenes have in common, such as the version. `to_come`: headings of what
/// has no pictures yet.
pub fn page(title: &str, facts: &str, parts: &[Part], to_come: &[String]) -> String {
    let title = escaped(title);
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n<p class=\"facts\">{}</p>\n<nav>\n",
        escaped(facts)
    );
    for part in parts {
        page.push_str(&format!("<a href=\"#{}\">{}</a>\n", part.id(), part.heading()));
    }
    page.push_str("</nav>\n");
    if !to_come.is_empty() {
        let names: Vec<String> = to_come.iter().map(|name| escaped(name)).collect();
        page.push_str(&format!("<p class=\"facts\">To come: {}.</p>\n", names.join("; ")));
    }
    for part in parts {
        page.push_str(&section(part));
    }
    page.push_str(&format!("<dialog><img alt=\"\"><p></p></dialog>\n<script>{SCRIPT}</script>\n</body>\n</html>\n"));
    page
}

/// What stands before and behind a scene's HTML.
fn marks(name: &str, key: &str) -> [String; 2] {
    let name = escaped(name).replace("--", "- -");
    [format!("<!-- scene {name} {key} -->\n"), format!("<!-- end of {name} -->\n")]
}

/// The HTML of the scene `name` in a page that was made before, if it was made for the same `key`.
pub fn kept(page: &str, name: &str, key: &str) -> Option<String> {
    let [start, end] = marks(name, key);
    let (_, rest) = page.split_once(&start)?;
    rest.split_once(&end).map(|(body, _)| body.to_owned())
}

fn section(part: &Part) -> String {
    let mut html = format!("<section id=\"{}\">\n<h2>{}</h2>\n", part.id(), part.heading());
    if let Some(row) = part.row() {
        let formulae: String = row.formulae.iter().map(|latex| mathml(latex) + "\n").collect();
        html.push_str(&format!("<div class=\"formula\">\n{formulae}</div>\n"));
    }
    for entry in &part.entries {
        if part.entries.len() > 1 {
            html.push_str(&format!("<h3>{}</h3>\n", escaped(&entry.title)));
        }
        let [start, end] = marks(&entry.name, &entry.key);
        html.push_str(&(start + &entry.body + &end));
    }
    html + "</section>\n"
}

/// The HTML of a scene.
pub fn body(entry: &Content) -> String {
    let name = escaped(&entry.name);
    let several = if entry.pictures.len() > 1 { " several" } else { "" };
    let columns = entry.columns.clamp(1, entry.pictures.len().max(1));
    // On a telephone three small ones side by side compare better than large ones below each other.
    let narrow = if columns > 3 { columns.div_ceil(2) } else { columns };
    let mut html = format!(
        "<p>{}</p>\n<div class=\"panels{several}\" style=\"--columns:{columns};--narrow:{narrow}\">\n",
        quoted(&entry.caption)
    );
    for (label, png) in &entry.pictures {
        let label = label.as_deref().map(escaped);
        let alt = label.as_ref().map_or_else(|| name.clone(), |label| format!("{name}: {label}"));
        let caption = label.map_or(String::new(), |label| format!("<figcaption>{label}</figcaption>"));
        let picture = STANDARD.encode(png);
        html.push_str(&format!(
            "<figure><img alt=\"{alt}\" src=\"data:image/png;base64,{picture}\">{caption}</figure>\n"
        ));
    }
    html.push_str(&format!("</div>\n<p class=\"facts\">{}</p>\n", escaped(&entry.settings)));
    let plots: String = entry.plots.iter().map(|plot| format!("<div class=\"plot\">{plot}</div>\n")).collect();
    if !plots.is_empty() {
        html.push_str(&format!("<div class=\"plots\">\n{plots}</div>\n"));
    }
    html + &format!("<details>\n<summary>{name}.toml</summary>\n<pre>{}</pre>\n</details>\n", escaped(&entry.text))
}
