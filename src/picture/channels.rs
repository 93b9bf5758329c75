//! Which channels of an OpenEXR file are the picture.

use super::Purpose;
use exr::meta::header::Header;
use std::collections::BTreeMap;

/// What the chosen channels are together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Red, green and blue, or some of them.
    Rgb,
    /// X, Y and Z of CIE 1931.
    Xyz,
    /// One channel for all three.
    Grey,
}

/// The channels of one part that are read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    pub part: usize,
    pub kind: Kind,
    /// By channel of the part: which of r, g, b, alpha it fills (0 to 3), all of r, g, b (`GREY`), or none.
    pub lanes: Vec<Option<usize>>,
}

/// All of r, g and b.
pub const GREY: usize = 4;

/// Layers of these names are the whole picture where others hold parts of it (Blender's passes, Nuke's, Arnold's).
const WHOLE: [&str; 5] = ["combined", "beauty", "rgba", "rgb", "color"];

/// One layer: the channels whose names are equal up to the last dot.
struct Layer<'a> {
    part: usize,
    /// Empty for channels without a dot.
    name: &'a str,
    /// Last word of the name in capitals, and index in the part.
    channels: BTreeMap<String, usize>,
    /// Channels of the part in all.
    count: usize,
}

impl Layer<'_> {
    fn has(&self, name: &str) -> bool {
        self.channels.contains_key(name)
    }

    fn colors(&self) -> usize {
        ["R", "G", "B"].iter().filter(|name| self.has(name)).count()
    }

    fn is_xyz(&self) -> bool {
        ["X", "Y", "Z"].iter().all(|name| self.has(name))
    }

    /// The only channel beside alpha.
    fn lone(&self) -> Option<&str> {
        let mut others = self.channels.keys().filter(|name| *name != "A");
        others.next().filter(|_| others.next().is_none()).map(String::as_str)
    }

    fn choose(&self, kind: Kind, fills: &[(&str, usize)]) -> Choice {
        let mut lanes = vec![None; self.count];
        for (name, lane) in fills.iter().chain(&[("A", 3)]) {
            if let Some(index) = self.channels.get(*name) {
                lanes[*index] = Some(*lane);
            }
        }
        Choice { part: self.part, kind, lanes }
    }

    /// How well this layer is what somebody wants to see, the lowest first; none if it is not.
    fn rank(&self, purpose: Purpose) -> Option<u32> {
        let main = self.name.is_empty();
        let whole = WHOLE.contains(&self.name.rsplit('.').next().unwrap_or("").to_lowercase().as_str());
        let lone = |name: &str| self.lone() == Some(name);
        if main && self.colors() > 0 {
            return Some(0);
        }
        if self.colors() == 3 {
            return Some(if whole { 1 } else { 2 });
        }
        if main && self.has("Y") {
            return Some(3);
        }
        if lone("Y") {
            return Some(4);
        }
        (purpose != Purpose::Compared && self.lone().is_some()).then_some(5)
    }

    /// A lone channel fills all three, whatever its name; of pictures that are compared only Y does.
    fn chosen(&self, purpose: Purpose) -> Result<Choice, String> {
        if self.has("RY") || self.has("BY") {
            return Err(
                "EXR channels of luminance and chroma (Y, RY, BY) are not supported; write it as RGB".to_owned()
            );
        }
        match self.lone() {
            Some(name) if name == "Y" || purpose != Purpose::Compared => Ok(self.choose(Kind::Grey, &[(name, GREY)])),
            _ if self.colors() > 0 => Ok(self.choose(Kind::Rgb, &[("R", 0), ("G", 1), ("B", 2)])),
            _ if self.is_xyz() => Ok(self.choose(Kind::Xyz, &[("X", 0), ("Y", 1), ("Z", 2)])),
            _ => Ok(self.choose(Kind::Grey, &[("Y", GREY)])),
        }
    }
}

/// What of a file is the picture: of the first part that has the best, R, G and B (those it lacks are 0), or a layer of all
/// three, one that is called the whole first; else Y, which is grey; else, where nothing is compared, the only channel of a
/// layer. X, Y and Z together are colours. Alpha belongs to its layer.
pub fn choose(headers: &[Header], purpose: Purpose) -> Result<Choice, String> {
    let mut layers: Vec<Layer> = Vec::new();
    let mut names = Vec::new();
    let texts: Vec<Vec<String>> =
        headers.iter().map(|header| header.channels.list.iter().map(|c| c.name.to_string()).collect()).collect();
    for (part, header) in headers.iter().enumerate().filter(|(_, header)| !header.deep) {
        for (index, text) in texts[part].iter().enumerate() {
            let (name, last) = text.rsplit_once('.').unwrap_or(("", text));
            let known = layers.iter().position(|layer| layer.part == part && layer.name == name);
            let at = known.unwrap_or_else(|| {
                layers.push(Layer { part, name, channels: BTreeMap::new(), count: header.channels.list.len() });
                layers.len() - 1
            });
            layers[at].channels.insert(last.to_uppercase(), index);
            names.push(text.as_str());
        }
    }
    let ranked = layers.iter().filter_map(|layer| Some((layer.rank(purpose)?, layer)));
    match ranked.min_by_key(|(rank, _)| *rank) {
        Some((_, layer)) => layer.chosen(purpose),
        None if names.is_empty() => Err("every part of this EXR is deep, which is not supported".to_owned()),
        None => {
            let most = 16;
            let more = if names.len() > most { ", ..." } else { "" };
            names.truncate(most);
            Err(format!("no part of this EXR has channels R, G, B or Y; it has {}{more}", names.join(", ")))
        }
    }
}
