//! OpenEXR: linear f32, and the auxiliary channels as layers by name in one part.

use super::{Aov, Film, facts};
use crate::film::Aovs;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Compression, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds,
    Layer, LayerAttributes, LineOrder, Text, Vec2, WritableImage,
};
use std::io::{self, Cursor, Write};

/// R, G, B, A (coverage where transparent, else 1), premultiplied, and the channels of `wanted` that the film
/// has: depth.Z, normal.X Y Z, albedo.R G B (f32), object.id, material.id, samples (u32). The data window is the crop
/// in the full frame. Lossless ZIP, lines from the top.
pub fn write(film: &Film, wanted: &[Aov], out: &mut dyn Write) -> io::Result<()> {
    let spec = film.spec();
    let image = film.resolve();
    let plane = |lane: usize| FlatSamples::F32(image.pixels.iter().map(|pixel| pixel[lane]).collect());
    let alpha = match spec.transparent {
        true => plane(3),
        false => FlatSamples::F32(vec![1.0; image.pixels.len()]),
    };
    let mut channels = vec![
        AnyChannel::new("R", plane(0)),
        AnyChannel::new("G", plane(1)),
        AnyChannel::new("B", plane(2)),
        AnyChannel::new("A", alpha),
    ];
    let aovs = film.resolve_aovs();
    for &aov in wanted {
        add_aov(&mut channels, film, aovs.as_ref(), aov);
    }

    let layer_position = Vec2(spec.crop.x as i32, spec.crop.y as i32);
    let mut attributes = LayerAttributes { layer_position, ..Default::default() };
    let facts = facts(film);
    let value = |key: &str| facts.iter().find(|(k, _)| *k == key).map_or("", |(_, v)| v.as_str());
    attributes.software_name = Some(text(value("Software")));
    let lines: Vec<String> = facts[1..].iter().map(|(key, value)| format!("{key}: {value}")).collect();
    attributes.comments = Some(text(&lines.join("\n")));
    // One custom attribute only: the crate writes them in the order of a hash map, which changes from run to run.
    attributes.other.insert(text("filmHash"), AttributeValue::Text(text(value("Film-Hash"))));
    let frame = IntegerBounds::from_dimensions(Vec2(spec.width as usize, spec.height as usize));

    let size = Vec2(image.width as usize, image.height as usize);
    let layer = Layer::new(size, attributes, ENCODING, AnyChannels::sort(channels.into_iter().collect()));
    let mut picture = Image::from_layer(layer);
    picture.attributes = ImageAttributes::new(frame);
    write_picture(&picture, out)
}

/// R, G, B of an image as f32, whatever their range.
pub fn write_linear(image: &crate::film::Image, out: &mut dyn Write) -> io::Result<()> {
    let plane = |lane: usize| FlatSamples::F32(image.pixels.iter().map(|pixel| pixel[lane]).collect());
    let channels = ["R", "G", "B"].iter().enumerate().map(|(lane, name)| AnyChannel::new(*name, plane(lane)));
    let size = Vec2(image.width as usize, image.height as usize);
    let layer = Layer::new(size, LayerAttributes::default(), ENCODING, AnyChannels::sort(channels.collect()));
    write_picture(&Image::from_layer(layer), out)
}

const ENCODING: Encoding = Encoding {
    compression: Compression::ZIP16,
    blocks: exr::image::Blocks::ScanLines,
    line_order: LineOrder::Increasing,
};

fn write_picture(picture: &Image<Layer<AnyChannels<FlatSamples>>>, out: &mut dyn Write) -> io::Result<()> {
    // The offset table is filled in last: it needs a seekable place, which a stream is not.
    let mut bytes = Cursor::new(Vec::new());
    picture.write().to_buffered(&mut bytes).map_err(|error| match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })?;
    out.write_all(bytes.get_ref())
}

fn add_aov(channels: &mut Vec<AnyChannel<FlatSamples>>, film: &Film, aovs: Option<&Aovs>, aov: Aov) {
    let mut add = |name: &str, samples: FlatSamples| channels.push(AnyChannel::new(name, samples));
    if aov == Aov::Samples {
        let count = film.samples().total() as u32;
        return add("samples", FlatSamples::U32(vec![count; film.crop().area()]));
    }
    let Some(aovs) = aovs else { return };
    let lane = |plane: &[[f32; 3]], i: usize| FlatSamples::F32(plane.iter().map(|v| v[i]).collect());
    match aov {
        Aov::Depth => add("depth.Z", FlatSamples::F32(aovs.depth.clone())),
        Aov::Normal => ["normal.X", "normal.Y", "normal.Z"]
            .iter()
            .enumerate()
            .for_each(|(i, name)| add(name, lane(&aovs.normal, i))),
        Aov::Albedo => ["albedo.R", "albedo.G", "albedo.B"]
            .iter()
            .enumerate()
            .for_each(|(i, name)| add(name, lane(&aovs.albedo, i))),
        Aov::Object => add("object.id", FlatSamples::U32(aovs.object.clone())),
        Aov::Material => add("material.id", FlatSamples::U32(aovs.material.clone())),
        Aov::Samples => {}
    }
}

/// EXR text is Latin-1: other characters become `?`.
fn text(value: &str) -> Text {
    let latin: String = value.chars().map(|c| if u32::from(c) < 256 { c } else { '?' }).collect();
    Text::new_or_none(latin).unwrap_or_default()
}
