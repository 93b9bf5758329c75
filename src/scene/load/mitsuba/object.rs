//! One object of a scene: an element with a plug-in type, all of whose properties are known.

use super::document::{Document, Node, Result, hint};
use super::plugin::{PLUGINS, Plugin, REFUSED};
use super::transform::transform;
use crate::scene::load::toml::LARGEST;
use crate::scene::{SceneError, Transform};
use glam::DVec3;

/// Elements that are objects.
pub const CLASSES: &[&str] = &[
    "shape",
    "bsdf",
    "emitter",
    "sensor",
    "film",
    "rfilter",
    "sampler",
    "integrator",
    "texture",
    "spectrum",
    "medium",
    "phase",
    "volume",
];

/// Elements that are properties.
const VALUES: &[&str] =
    &["float", "integer", "boolean", "string", "point", "vector", "rgb", "spectrum", "transform", "texture"];

/// A child of an object: the name it goes by and the element, references followed.
#[derive(Clone, Copy, Debug)]
pub struct Child<'a> {
    pub name: &'a str,
    pub node: Node,
    /// The element that stands in the object: `node`, or the `<ref>` to it.
    pub written: Node,
}

/// One object, opened.
#[derive(Clone, Debug)]
pub struct Object<'a> {
    pub document: &'a Document,
    pub node: Node,
    pub plugin: &'static Plugin,
    properties: Vec<Child<'a>>,
    nested: Vec<Child<'a>>,
}

impl<'a> Object<'a> {
    /// Opens an element of a known class; an unknown plug-in, property or nested object is an error at its place.
    pub fn open(document: &'a Document, node: Node) -> Result<Self> {
        let class = document.tag(node);
        if class == "spectrum" {
            document.check_attributes(node, &["type", "id", "name", "value"])?;
        } else {
            document.check_attributes(node, &["type", "id", "name"])?;
        }
        let name = document.required(node, "type")?;
        let of_class = || PLUGINS.iter().filter(|plugin| plugin.class == class);
        // Mitsuba up to 3.6 took capitals for small letters.
        let Some(plugin) = of_class().find(|plugin| plugin.name.eq_ignore_ascii_case(name)) else {
            if let Some((.., why)) =
                REFUSED.iter().find(|(of, known, _)| *of == class && known.eq_ignore_ascii_case(name))
            {
                return Err(document.bad_value(node, "type", format!("the {class} {name:?} is not supported: {why}")));
            }
            let names: Vec<&str> = of_class().map(|plugin| plugin.name).collect();
            let message = match names.is_empty() {
                true => format!("<{class}> is not supported: {}", super::NO_MEDIA),
                false => {
                    let hint = hint(name, names.iter().copied());
                    format!("the {class} {name:?} is not supported; supported are {}{hint}", names.join(", "))
                }
            };
            return Err(document.bad_value(node, "type", message));
        };
        let mut object = Self { document, node, plugin, properties: Vec::new(), nested: Vec::new() };
        for child in document.children(node) {
            object.add(*child)?;
        }
        Ok(object)
    }

    fn add(&mut self, written: Node) -> Result<()> {
        let document = self.document;
        let node = document.resolve(written)?;
        let tag = document.tag(node);
        let name = document.attribute(written, "name").unwrap_or("");
        let child = Child { name, node, written };
        let property = self.plugin.properties().find(|property| property.name == name);
        match property {
            Some(property) if VALUES.contains(&tag) => {
                if !property.kind.tags().contains(&tag) {
                    let message = format!("{name:?} is a {}, found <{tag}>", property.kind.noun());
                    return Err(document.bad(written, message));
                }
                if self.properties.iter().any(|other| other.name == name) {
                    return Err(document.bad(written, format!("{name:?} is written twice")));
                }
                self.properties.push(child);
                Ok(())
            }
            _ if self.plugin.nested.contains(&tag) => {
                self.nested.push(child);
                Ok(())
            }
            _ => Err(self.unknown(child, tag)),
        }
    }

    fn unknown(&self, child: Child, tag: &str) -> SceneError {
        let (class, plugin) = (self.plugin.class, self.plugin.name);
        if !VALUES.contains(&tag) {
            let known = if CLASSES.contains(&tag) { "" } else { "; Mitsuba has no such element" };
            let holds = match self.plugin.nested {
                [] => "holds no objects".to_owned(),
                classes => format!("holds {}", classes.join(", ")),
            };
            return self
                .document
                .bad(child.written, format!("<{tag}> in the {class} {plugin:?}, which {holds}{known}"));
        }
        let names: Vec<&str> = self.plugin.properties().map(|property| property.name).collect();
        let hint = hint(child.name, names.iter().copied());
        let names = if names.is_empty() { "it has none".to_owned() } else { format!("it has {}", names.join(", ")) };
        let message = match child.name {
            "" => format!("<{tag}> in the {class} {plugin:?} needs a name; {names}"),
            name => format!("the {class} {plugin:?} has no property {name:?}; {names}{hint}"),
        };
        self.document.bad_value(child.written, "name", message)
    }

    /// The element that writes a property, if it is written.
    pub fn property(&self, name: &str) -> Option<Node> {
        debug_assert!(self.plugin.properties().any(|p| p.name == name), "{name} is not in the table");
        self.properties.iter().find(|child| child.name == name).map(|child| child.node)
    }

    pub fn has(&self, name: &str) -> bool {
        self.property(name).is_some()
    }

    /// The nested objects of a class, in order.
    pub fn nested(&self, class: &str) -> Vec<Child<'a>> {
        self.nested.iter().filter(|child| self.document.tag(child.node) == class).copied().collect()
    }

    /// The only nested object of a class; more than one is an error.
    pub fn only(&self, class: &str) -> Result<Option<Child<'a>>> {
        match self.nested(class).as_slice() {
            [] => Ok(None),
            [child] => Ok(Some(*child)),
            [_, second, ..] => Err(self
                .document
                .bad(second.written, format!("a second {class} in the {} {:?}", self.plugin.class, self.plugin.name))),
        }
    }

    /// An error at the property, or at the object where it is not written.
    pub fn bad(&self, name: &str, message: impl Into<String>) -> SceneError {
        match self.properties.iter().find(|child| child.name == name) {
            Some(child) => self.document.bad(child.node, message),
            None => self.document.bad(self.node, message),
        }
    }

    /// `value`, or the error that `name` is missing.
    pub fn required<T>(&self, name: &str, value: Option<T>) -> Result<T> {
        value.ok_or_else(|| self.bad(name, format!("the {} {:?} needs {name:?}", self.plugin.class, self.plugin.name)))
    }

    /// Refuses two properties that say the same.
    pub fn exclusive(&self, name: &str, other: &str) -> Result<()> {
        match self.has(name) && self.has(other) {
            true => Err(self.bad(other, format!("{name:?} and {other:?} exclude each other"))),
            false => Ok(()),
        }
    }

    pub fn float(&self, name: &str) -> Result<Option<f64>> {
        self.property(name).map(|node| number(self.document, node)).transpose()
    }

    /// A number within `low` and `high`.
    pub fn float_in(&self, name: &str, low: f64, high: f64) -> Result<Option<f64>> {
        match self.float(name)? {
            Some(value) if !(low..=high).contains(&value) => {
                Err(self.bad(name, format!("{name:?} must be a number from {low} to {high}, found {value}")))
            }
            value => Ok(value),
        }
    }

    pub fn integer(&self, name: &str, low: i64, high: i64) -> Result<Option<i64>> {
        let Some(node) = self.property(name) else { return Ok(None) };
        let text = value(self.document, node)?;
        match text.trim().parse::<i64>() {
            Ok(number) if (low..=high).contains(&number) => Ok(Some(number)),
            _ => Err(self.document.bad_value(
                node,
                "value",
                format!("{name:?} must be an integer from {low} to {high}, found {text:?}"),
            )),
        }
    }

    pub fn boolean(&self, name: &str) -> Result<Option<bool>> {
        let Some(node) = self.property(name) else { return Ok(None) };
        match value(self.document, node)?.to_lowercase().as_str() {
            "true" => Ok(Some(true)),
            "false" => Ok(Some(false)),
            other => {
                Err(self.document.bad_value(node, "value", format!("{name:?} must be true or false, found {other:?}")))
            }
        }
    }

    pub fn text(&self, name: &str) -> Result<Option<&'a str>> {
        self.property(name).map(|node| value(self.document, node)).transpose()
    }

    /// One of the words, with its meaning.
    pub fn choice<T: Copy>(&self, name: &str, meanings: &[(&str, T)]) -> Result<Option<T>> {
        let Some(word) = self.text(name)? else { return Ok(None) };
        match meanings.iter().find(|(known, _)| *known == word) {
            Some((_, meaning)) => Ok(Some(*meaning)),
            None => {
                let words: Vec<&str> = meanings.iter().map(|(known, _)| *known).collect();
                let hint = hint(word, words.iter().copied());
                let message = format!("{name:?} must be one of {}, found {word:?}{hint}", words.join(", "));
                Err(self.bad(name, message))
            }
        }
    }

    pub fn vector(&self, name: &str) -> Result<Option<DVec3>> {
        self.property(name).map(|node| super::transform::vector(self.document, node, 0.0, &["name"])).transpose()
    }

    /// The identity where it is not written.
    pub fn transform(&self, name: &str) -> Result<Transform> {
        self.property(name).map_or(Ok(Transform::default()), |node| transform(self.document, node))
    }
}

/// The attribute `value` of a property that has no other.
pub fn value(document: &Document, node: Node) -> Result<&str> {
    document.check_attributes(node, &["name", "value", "id"])?;
    if let Some(child) = document.children(node).first() {
        return Err(document.bad(*child, format!("<{}> holds nothing", document.tag(node))));
    }
    document.required(node, "value")
}

/// The number that a `<float>` or `<integer>` writes.
pub fn number(document: &Document, node: Node) -> Result<f64> {
    let text = value(document, node)?;
    parse(text).ok_or_else(|| document.bad_value(node, "value", no_number(text)))
}

/// What is wrong with a text that `parse` refuses.
pub fn no_number(text: &str) -> String {
    let why = match text.trim().parse::<f64>() {
        Ok(number) if number.is_nan() => ", which is no number",
        Ok(number) if number < 0.0 => "; numbers are at least -1e12",
        Ok(_) => "; numbers are at most 1e12",
        Err(_) => "",
    };
    format!("expected a number, found {text:?}{why}")
}

/// A finite number of a size that single precision can work with.
pub fn parse(text: &str) -> Option<f64> {
    text.trim().parse::<f64>().ok().filter(|number| number.abs() <= LARGEST)
}

/// The words of a list: separated by spaces or commas.
pub fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty())
}
