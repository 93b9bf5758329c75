//! Mitsuba's XML as a tree of elements: includes read, `<default>`s filled in, ids and paths known, every element with its
//! place. What elements mean is not known here.

use super::upgrade;
use crate::scene::load::confine;
use crate::scene::load::text::{read_bytes, utf8};
use crate::scene::load::toml::nearest;
use crate::scene::{Location, SceneError};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};

pub type Result<T> = std::result::Result<T, SceneError>;

/// Files within files, as in Mitsuba.
const INCLUDE_DEPTH_MAX: usize = 15;
/// Bytes of XML in all: scenes list their meshes and pictures, they do not hold them.
const BYTES_MAX: usize = 64 << 20;
/// Elements in all.
const ELEMENTS_MAX: usize = 1 << 20;
/// Elements within elements.
const NESTING_MAX: usize = 64;

/// Beyond this, columns count bytes.
const COUNTED_MAX: usize = 4096;

/// Index of an element of a `Document`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Node(u32);

/// Where an element or the value of an attribute begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    file: u32,
    line: u32,
    column: u32,
}

#[derive(Debug)]
struct Attribute {
    name: String,
    /// With the values of parameters.
    value: String,
    place: Place,
}

#[derive(Debug)]
struct Element {
    tag: String,
    attributes: Vec<Attribute>,
    children: Vec<Node>,
    place: Place,
}

/// A whole scene description.
#[derive(Debug)]
pub struct Document {
    files: Vec<PathBuf>,
    elements: Vec<Element>,
    ids: HashMap<String, Node>,
    /// Where files are looked for, in this order.
    folders: Vec<PathBuf>,
    pub root: Node,
}

/// What reading needs beside the document.
struct Loader {
    document: Document,
    /// Of the command line first, then of `<default>`.
    parameters: BTreeMap<String, String>,
    /// Parameters that the scene names, for messages and to find misspelt ones.
    named: BTreeSet<String>,
    bytes: usize,
    /// The file being read is of a version before 2.
    old: bool,
}

impl Document {
    /// Reads the file and all that it includes. `defines`: parameters from the command line.
    pub fn read(path: &Path, defines: &[(String, String)]) -> Result<Self> {
        let root = Element {
            tag: "scene".to_owned(),
            attributes: Vec::new(),
            children: Vec::new(),
            place: Place { file: 0, line: 1, column: 1 },
        };
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let document =
            Self { files: Vec::new(), elements: vec![root], ids: HashMap::new(), folders: vec![folder], root: Node(0) };
        let parameters = defines.iter().cloned().collect();
        let mut loader = Loader { document, parameters, named: BTreeSet::new(), bytes: 0, old: false };
        loader.read_file(path, Node(0), 0)?;
        for (name, _) in defines {
            if !loader.named.contains(name) {
                let names: Vec<&str> = loader.named.iter().map(String::as_str).collect();
                let known =
                    if names.is_empty() { "it has none".to_owned() } else { format!("it has {}", names.join(", ")) };
                let message = format!("-D {name}: the scene has no parameter {name:?}; {known}");
                return Err(SceneError::bad(Location::file(path), message));
            }
        }
        Ok(loader.document)
    }

    fn element(&self, node: Node) -> &Element {
        &self.elements[node.0 as usize]
    }

    pub fn tag(&self, node: Node) -> &str {
        &self.element(node).tag
    }

    pub fn children(&self, node: Node) -> &[Node] {
        &self.element(node).children
    }

    /// An attribute that may be left out.
    pub fn attribute(&self, node: Node, name: &str) -> Option<&str> {
        self.element(node).attributes.iter().find(|a| a.name == name).map(|a| a.value.as_str())
    }

    /// An attribute that must be there.
    pub fn required(&self, node: Node, name: &str) -> Result<&str> {
        self.attribute(node, name)
            .ok_or_else(|| self.bad(node, format!("<{}> needs the attribute {name:?}", self.tag(node))))
    }

    /// Refuses attributes other than these.
    pub fn check_attributes(&self, node: Node, allowed: &[&str]) -> Result<()> {
        let element = self.element(node);
        match element.attributes.iter().find(|a| !allowed.contains(&a.name.as_str())) {
            None => Ok(()),
            Some(attribute) => {
                let hint = hint(&attribute.name, allowed.iter().copied());
                let message = format!(
                    "<{}> has no attribute {:?}; it has {}{hint}",
                    element.tag,
                    attribute.name,
                    allowed.join(", ")
                );
                Err(SceneError::bad(self.location(attribute.place), message))
            }
        }
    }

    pub fn location(&self, place: Place) -> Location {
        Location { file: self.files[place.file as usize].clone(), line: place.line, column: place.column }
    }

    pub fn location_of(&self, node: Node) -> Location {
        self.location(self.element(node).place)
    }

    /// An error at the element.
    pub fn bad(&self, node: Node, message: impl Into<String>) -> SceneError {
        SceneError::bad(self.location_of(node), message)
    }

    /// An error at the attribute's value, or at the element if it has none of this name.
    pub fn bad_value(&self, node: Node, attribute: &str, message: impl Into<String>) -> SceneError {
        let found = self.element(node).attributes.iter().find(|a| a.name == attribute);
        SceneError::bad(self.location(found.map_or(self.element(node).place, |a| a.place)), message)
    }

    /// The element that a `<ref>` names, itself for any other element.
    pub fn resolve(&self, node: Node) -> Result<Node> {
        if self.tag(node) != "ref" {
            return Ok(node);
        }
        self.check_attributes(node, &["id", "name"])?;
        let id = self.required(node, "id")?;
        self.ids.get(id).copied().ok_or_else(|| {
            let hint = hint(id, self.ids.keys().map(String::as_str));
            self.bad_value(node, "id", format!("there is no object with the id {id:?}{hint}"))
        })
    }

    /// The file that the attribute `value` of `node` names: in the folders of `<path>` (the last one first), then beside the scene.
    pub fn find_file(&self, node: Node, attribute: &str) -> Result<PathBuf> {
        let name = self.required(node, attribute)?;
        let relative = Path::new(name);
        let beside = self.files[self.element(node).place.file as usize].parent().unwrap_or(Path::new("")).to_owned();
        let mut places = self.folders.iter().rev().chain(std::iter::once(&beside)).map(|folder| folder.join(relative));
        match places.find(|path| confine::is_file(path)) {
            Some(path) => Ok(path),
            None => Err(SceneError::Io {
                location: self.location_of(node),
                source: std::io::Error::new(
                    std::io::ErrorKind::NotFound,
                    format!("no file {name:?} beside the scene or in a <path> of it"),
                ),
            }),
        }
    }
}

/// `; did you mean "x"?`, if one of `names` looks like `word`.
pub fn hint<'n>(word: &str, names: impl Iterator<Item = &'n str>) -> String {
    nearest(word, names).map_or(String::new(), |name| format!("; did you mean {name:?}?"))
}

impl Loader {
    /// Adds what the file holds to the children of `parent`.
    fn read_file(&mut self, path: &Path, parent: Node, depth: usize) -> Result<()> {
        let bytes = read_bytes(path)?;
        self.bytes += bytes.len();
        if self.bytes > BYTES_MAX {
            return Err(SceneError::bad(
                Location::file(path),
                format!("a scene of more than {BYTES_MAX} bytes of XML"),
            ));
        }
        let file = self.document.files.len() as u32;
        self.document.files.push(path.to_owned());
        let text = utf8(path, bytes)?;
        let options = roxmltree::ParsingOptions { nodes_limit: 8 * ELEMENTS_MAX as u32, ..Default::default() };
        let xml = roxmltree::Document::parse_with_options(&text, options).map_err(|error| {
            let at = error.pos();
            let location = Location { file: path.to_owned(), line: at.row, column: at.col };
            SceneError::bad(location, format!("not well-formed XML: {}", without_position(&error)))
        })?;
        let source = Source { xml: &xml, file, lines: line_starts(&text) };
        let root = xml.root_element();
        if root.tag_name().name() != "scene" {
            return match depth {
                0 => Err(self.document_error(
                    &source,
                    root,
                    format!("the root of a scene is <scene>, found <{}>", root.tag_name().name()),
                )),
                _ => self.read_element(&source, root, parent, depth, 1),
            };
        }
        let place = source.place(root.range().start);
        if depth == 0 {
            self.document.elements[0].place = place;
        }
        let before = self.old;
        match root.attribute("version") {
            Some(version) => match version.split('.').next().and_then(|major| major.parse::<u32>().ok()) {
                Some(major) => self.old = major < 2,
                None => {
                    let message = format!("a scene has a version such as \"3.0.0\", found {version:?}");
                    return Err(self.document_error(&source, root, message));
                }
            },
            None if depth > 0 => {}
            None => {
                return Err(self.document_error(
                    &source,
                    root,
                    "<scene> needs the attribute \"version\" (\"3.0.0\")".to_owned(),
                ));
            }
        }
        for child in root.children() {
            self.read_element(&source, child, parent, depth, 1)?;
        }
        self.old = before;
        Ok(())
    }

    fn document_error(&self, source: &Source, node: roxmltree::Node, message: String) -> SceneError {
        SceneError::bad(self.document.location(source.place(node.range().start)), message)
    }

    /// Adds one element with all it holds to the children of `parent`; `nesting`: elements around it.
    fn read_element(
        &mut self,
        source: &Source,
        xml: roxmltree::Node,
        parent: Node,
        depth: usize,
        nesting: usize,
    ) -> Result<()> {
        if xml.is_text() && !xml.text().unwrap_or("").trim().is_empty() {
            return Err(self.document_error(source, xml, "text between elements has no meaning".to_owned()));
        }
        if !xml.is_element() {
            return Ok(());
        }
        let place = source.place(xml.range().start);
        if nesting > NESTING_MAX {
            return Err(SceneError::bad(
                self.document.location(place),
                format!("more than {NESTING_MAX} elements within each other"),
            ));
        }
        if self.document.elements.len() >= ELEMENTS_MAX {
            return Err(SceneError::bad(self.document.location(place), format!("more than {ELEMENTS_MAX} elements")));
        }
        let mut attributes = Vec::new();
        for attribute in xml.attributes() {
            let place = source.place(attribute.range_value().start);
            let mut value = self.substitute(attribute.value(), place)?;
            if self.old && attribute.name() == "name" && xml.tag_name().name() != "default" {
                value = upgrade::name(&value, self.document.attribute(parent, "type"));
            }
            attributes.push(Attribute { name: attribute.name().to_owned(), value, place });
        }
        let node = Node(self.document.elements.len() as u32);
        let written = xml.tag_name().name();
        let tag = if self.old { upgrade::tag(written) } else { written }.to_owned();
        self.document.elements.push(Element { tag: tag.clone(), attributes, children: Vec::new(), place });
        match tag.as_str() {
            "default" => return self.read_default(node),
            "path" => return self.read_path(node, nesting),
            "include" => return self.read_include(node, parent, depth),
            "alias" => return self.read_alias(node),
            _ => {}
        }
        if tag != "ref"
            && let Some(id) = self.document.attribute(node, "id").map(str::to_owned)
        {
            self.add_id(id, node, node)?;
        }
        for child in xml.children() {
            self.read_element(source, child, node, depth, nesting + 1)?;
        }
        if self.old {
            self.upgrade_children(node);
            if upgrade::is_gone(&tag, self.document.attribute(node, "name")) {
                return Ok(());
            }
        }
        self.document.elements[parent.0 as usize].children.push(node);
        Ok(())
    }

    /// Makes a transform of the places that textures of old scenes say number by number.
    fn upgrade_children(&mut self, node: Node) {
        let is_place = |document: &Document, child: Node, name: &str| {
            document.tag(child) == "float" && document.attribute(child, "name") == Some(name)
        };
        let children = self.document.children(node).to_vec();
        let value = |name: &str| {
            let child = children.iter().find(|child| is_place(&self.document, **child, name))?;
            self.document.attribute(*child, "value").map(str::to_owned)
        };
        let steps = upgrade::steps(value);
        if steps.is_empty() {
            return;
        }
        let place = self.document.element(node).place;
        let attribute = |name: &str, value: String| Attribute { name: name.to_owned(), value, place };
        let mut add = |tag: &str, attributes: Vec<Attribute>, children: Vec<Node>| {
            self.document.elements.push(Element { tag: tag.to_owned(), attributes, children, place });
            Node(self.document.elements.len() as u32 - 1)
        };
        let steps =
            steps.into_iter().map(|(tag, [x, y])| add(tag, vec![attribute("x", x), attribute("y", y)], Vec::new()));
        let steps = steps.collect();
        let transform = add("transform", vec![attribute("name", "to_uv".to_owned())], steps);
        let mut kept = children;
        kept.retain(|child| !upgrade::PLACES.iter().any(|name| is_place(&self.document, *child, name)));
        kept.push(transform);
        self.document.elements[node.0 as usize].children = kept;
    }

    /// `value` with each `$name` or `${name}` replaced.
    fn substitute(&mut self, value: &str, place: Place) -> Result<String> {
        let mut result = String::new();
        let mut rest = value;
        while let Some((before, after)) = rest.split_once('$') {
            result.push_str(before);
            let braced = after.strip_prefix('{').and_then(|inner| inner.split_once('}'));
            let word = after.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(after.len());
            let (name, next) = braced.unwrap_or_else(|| after.split_at(word));
            let Some(parameter) = self.parameters.get(name) else {
                let hint = hint(name, self.parameters.keys().map(String::as_str));
                let message = format!(
                    "the parameter \"${name}\" has no value: give it with <default> before or with -D {name}=...{hint}"
                );
                return Err(SceneError::bad(self.document.location(place), message));
            };
            self.named.insert(name.to_owned());
            result.push_str(parameter);
            if result.len() > BYTES_MAX {
                return Err(SceneError::bad(self.document.location(place), "parameters make this value too long"));
            }
            rest = next;
        }
        result.push_str(rest);
        Ok(result)
    }

    fn read_default(&mut self, node: Node) -> Result<()> {
        let document = &self.document;
        document.check_attributes(node, &["name", "value"])?;
        let (name, value) = (document.required(node, "name")?.to_owned(), document.required(node, "value")?.to_owned());
        if name.is_empty() {
            return Err(document.bad_value(node, "name", "a parameter needs a name"));
        }
        self.named.insert(name.clone());
        self.parameters.entry(name).or_insert(value);
        Ok(())
    }

    fn read_path(&mut self, node: Node, nesting: usize) -> Result<()> {
        let document = &self.document;
        document.check_attributes(node, &["value"])?;
        let value = document.required(node, "value")?;
        if nesting != 1 {
            return Err(document.bad(node, "<path> stands directly in <scene>"));
        }
        let beside = document.files[document.element(node).place.file as usize].parent().unwrap_or(Path::new(""));
        let mut places = std::iter::once(beside)
            .chain(document.folders.iter().rev().map(PathBuf::as_path))
            .map(|folder| folder.join(value));
        let Some(folder) = places.find(|folder| confine::is_dir(folder)) else {
            return Err(document.bad_value(node, "value", format!("there is no folder {value:?}")));
        };
        self.document.folders.push(folder);
        Ok(())
    }

    fn read_include(&mut self, node: Node, parent: Node, depth: usize) -> Result<()> {
        self.document.check_attributes(node, &["filename"])?;
        if depth + 1 > INCLUDE_DEPTH_MAX {
            return Err(self.document.bad(
                node,
                format!("more than {INCLUDE_DEPTH_MAX} files within each other; does one include itself?"),
            ));
        }
        let path = self.document.find_file(node, "filename")?;
        self.read_file(&path, parent, depth + 1)
    }

    fn read_alias(&mut self, node: Node) -> Result<()> {
        self.document.check_attributes(node, &["id", "as"])?;
        let id = self.document.required(node, "id")?;
        let Some(target) = self.document.ids.get(id).copied() else {
            let hint = hint(id, self.document.ids.keys().map(String::as_str));
            return Err(self.document.bad_value(
                node,
                "id",
                format!("there is no object with the id {id:?} above{hint}"),
            ));
        };
        let name = self.document.required(node, "as")?.to_owned();
        self.add_id(name, target, node)
    }

    /// Makes `id` a name of `target`; `at` says so.
    fn add_id(&mut self, id: String, target: Node, at: Node) -> Result<()> {
        if let Some(other) = self.document.ids.get(&id) {
            let message = format!(
                "the id {id:?} is taken by <{}> at {}",
                self.document.tag(*other),
                self.document.location_of(*other)
            );
            return Err(self.document.bad_value(at, "id", message));
        }
        self.document.ids.insert(id, target);
        Ok(())
    }
}

/// A parsed file on its way into the document.
struct Source<'t> {
    xml: &'t roxmltree::Document<'t>,
    file: u32,
    lines: Vec<usize>,
}

impl Source<'_> {
    /// Of a byte offset. roxmltree's own `text_pos_at` counts lines from the start every time.
    fn place(&self, offset: usize) -> Place {
        let line = self.lines.partition_point(|start| *start <= offset);
        let text = self.xml.input_text();
        let before = &text[self.lines[line - 1]..offset];
        // Counting characters of a file that is one line would take time quadratic in it.
        let column = if before.len() > COUNTED_MAX { before.len() } else { before.chars().count() } + 1;
        Place { file: self.file, line: line as u32, column: column as u32 }
    }
}

/// Byte offsets at which lines begin.
fn line_starts(text: &str) -> Vec<usize> {
    std::iter::once(0).chain(text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i + 1)).collect()
}

/// roxmltree ends its messages with the place, which we tell in front.
fn without_position(error: &roxmltree::Error) -> String {
    let text = error.to_string();
    let at = format!(" at {}", error.pos());
    text.strip_suffix(&at).map_or(text.clone(), str::to_owned)
}
