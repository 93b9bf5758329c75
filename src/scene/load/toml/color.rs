//! Colours: linear numbers, sRGB hexadecimal, names.

use super::document::{Node, Value};
use super::keys::Range;
use super::reader::{in_range, numbers};
use crate::scene::Rgb;
use crate::scene::load::image::srgb_to_linear;

/// The CSS Color Module Level 4 values of the common names, sRGB.
const NAMES: &[(&str, u32)] = &[
    ("black", 0x00_00_00),
    ("blue", 0x00_00_ff),
    ("brown", 0xa5_2a_2a),
    ("cyan", 0x00_ff_ff),
    ("gray", 0x80_80_80),
    ("green", 0x00_80_00),
    ("grey", 0x80_80_80),
    ("lime", 0x00_ff_00),
    ("magenta", 0xff_00_ff),
    ("navy", 0x00_00_80),
    ("orange", 0xff_a5_00),
    ("pink", 0xff_c0_cb),
    ("purple", 0x80_00_80),
    ("red", 0xff_00_00),
    ("teal", 0x00_80_80),
    ("white", 0xff_ff_ff),
    ("yellow", 0xff_ff_00),
];

/// A number (grey), `[r, g, b]` (linear), `"#rgb"`, `"#rrggbb"` or a name (sRGB), each channel in `range`.
pub fn color(node: &Node, range: Range) -> Option<Rgb> {
    let channels = match &node.value {
        Value::String(text) => srgb_text(text)?,
        Value::Array(_) => return numbers::<3>(node, range).map(|c| Rgb::from_array(c.map(|x| x as f32))),
        _ => return in_range(node, range).map(|grey| Rgb::splat(grey as f32)),
    };
    let linear = channels.map(|code| srgb_to_linear(f64::from(code) / 255.0));
    linear.iter().all(|channel| range.contains(*channel)).then(|| Rgb::from_array(linear.map(|x| x as f32)))
}

/// A colour as a scene file writes it, or the same without its quotation marks.
pub fn color_from_text(text: &str) -> Option<Rgb> {
    let place = super::document::Place::Override(0);
    let quoted = || super::document::parse_value(&format!("{text:?}"), place).ok();
    let node = super::document::parse_value(text, place).ok().or_else(quoted)?;
    color(&node, Range::NOT_NEGATIVE)
}

fn srgb_text(text: &str) -> Option<[u8; 3]> {
    let code = match text.strip_prefix('#') {
        None => NAMES.iter().find(|(name, _)| name.eq_ignore_ascii_case(text))?.1,
        Some(digits) if digits.bytes().all(|digit| digit.is_ascii_hexdigit()) => {
            let code = u32::from_str_radix(digits, 16).ok()?;
            match digits.len() {
                6 => code,
                // Each digit stands for two: #f80 is #ff8800.
                3 => (code >> 8 & 15) * 0x11_00_00 + (code >> 4 & 15) * 0x11_00 + (code & 15) * 0x11,
                _ => return None,
            }
        }
        Some(_) => return None,
    };
    let [_, r, g, b] = code.to_be_bytes();
    Some([r, g, b])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::load::toml::document::{Place, parse_value};

    fn read(text: &str) -> Option<Rgb> {
        color(&parse_value(text, Place::Text(0)).unwrap(), Range::UNIT)
    }

    #[test]
    fn a_colour_can_be_written_in_five_ways() {
        assert_eq!(read("0.5"), Some(Rgb::splat(0.5)));
        assert_eq!(read("[0.25, 0.5, 1]"), Some(Rgb::new(0.25, 0.5, 1.0)));
        assert_eq!(read("white"), Some(Rgb::ONE));
        assert_eq!(read("#F80"), read("#ff8800"));
        // IEC 61966-2-1: code 188 is 0.502886, within the rounding of 8 bits the middle of the linear scale.
        assert!((read("#bcbcbc").unwrap().x - 0.502_886_5).abs() < 1e-6);
    }

    #[test]
    fn what_is_no_colour_is_refused() {
        for text in
            ["#12", "#1234567", "#gg0000", "#+12", "#é1", "octarine", "[1, 2]", "[0, 0, 1.5]", "-0.1", "nan", "true"]
        {
            assert_eq!(read(text), None, "{text}");
        }
    }
}
