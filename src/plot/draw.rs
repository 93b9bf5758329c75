//! Figures on a canvas: frames, curves and a legend beside them, which so covers none.

use super::canvas::{Anchor, Canvas, Pen, Result, text_width};
use super::figure::{Arrow, Axis, Body, Color, Curve, Figure, Frame, Mark, Side, Strip, nice_step, number};
use plotters::prelude::DrawingBackend;

const INK: Color = [30, 30, 30];
const GREY: Color = [110, 110, 110];
const GRID: Color = [222, 222, 222];
/// Of titles, of names and numbers, of notes; pixels.
const TITLE: f64 = 25.0;
const TEXT: f64 = 19.0;
const NOTE: f64 = 17.0;
/// Of a curve, pixels.
const CURVE: f64 = 2.2;

/// A rectangle in pixels.
#[derive(Clone, Copy, Debug)]
struct Panel {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

impl Panel {
    fn width(&self) -> f64 {
        self.right - self.left
    }

    fn height(&self) -> f64 {
        self.bottom - self.top
    }

    fn centre(&self) -> [f64; 2] {
        [(self.left + self.right) / 2.0, (self.top + self.bottom) / 2.0]
    }
}

/// Pictures less wide than this have their legend below, in rows, and their note in several lines: for telephones.
const NARROW: f64 = 600.0;
const LINE: f64 = TEXT * 1.5;

/// Draws `figure` into a canvas of `size` pixels.
pub fn draw<DB: DrawingBackend>(canvas: &Canvas<DB>, figure: &Figure, size: [u32; 2]) -> Result<()> {
    let [width, height] = size.map(f64::from);
    let narrow = width < NARROW;
    let title = TITLE.min((width - 16.0) / text_width(&figure.title, 1.0).max(1.0));
    canvas.text(&figure.title, [width / 2.0, 22.0], title, Anchor::Centre, INK)?;
    let lines = if narrow { wrapped(&figure.note, width - 16.0) } else { vec![figure.note.clone()] };
    let mut top = 45.0;
    for line in &lines {
        canvas.text(line, [width / 2.0, top], NOTE, Anchor::Centre, GREY)?;
        top += NOTE * 1.25;
    }
    let named: Vec<&Curve> = figure.curves.iter().filter(|curve| !curve.name.is_empty()).collect();
    let longest = named.iter().map(|curve| text_width(&curve.name, TEXT)).fold(0.0, f64::max);
    let legend = if longest > 0.0 && !narrow { longest + 58.0 } else { 20.0 };
    let places = if narrow { rows(&named, width) } else { column(&named, width - legend + 14.0) };
    let below = if narrow { places.last().map_or(0.0, |place| place[1] + LINE) } else { 0.0 };
    let bottom = height - 14.0 - below;
    let panel = Panel { left: 20.0, top: top - 4.0, right: width - legend, bottom };
    match &figure.frame {
        Frame::Cartesian { x, y, marks } => cartesian(canvas, panel, x, y, marks, &figure.curves)?,
        Frame::Polar { side, unit, max, arrows } => polar(canvas, panel, *side, unit, *max, arrows, &figure.curves)?,
        Frame::Ramp { x, strips } => ramp(canvas, panel, x, strips)?,
        Frame::Bodies(shown) => bodies(canvas, panel, shown)?,
    }
    let from = if narrow { bottom + LINE / 2.0 } else { 84.0 };
    for (curve, [x, y]) in named.into_iter().zip(places) {
        let y = from + y;
        let pen = Pen { color: curve.color, width: CURVE, dashed: curve.dashed };
        canvas.line(&[[x, y], [x + 26.0, y]], pen)?;
        canvas.text(&curve.name, [x + 34.0, y], TEXT, Anchor::Left, INK)?;
    }
    Ok(())
}

/// Words in lines that are no wider than `width`.
fn wrapped(text: &str, width: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.len() - 1;
        let longer = if lines[last].is_empty() { word.to_owned() } else { format!("{} {word}", lines[last]) };
        if lines[last].is_empty() || text_width(&longer, NOTE) <= width {
            lines[last] = longer;
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

/// Places of a legend's entries one below the other.
fn column(named: &[&Curve], x: f64) -> Vec<[f64; 2]> {
    (0..named.len()).map(|i| [x, i as f64 * LINE]).collect()
}

/// Places of a legend's entries in rows of a picture of this width.
fn rows(named: &[&Curve], width: f64) -> Vec<[f64; 2]> {
    let (mut x, mut y) = (24.0, 0.0);
    let mut places = Vec::new();
    for curve in named {
        let length = 34.0 + text_width(&curve.name, TEXT);
        if x > 24.0 && x + length > width - 12.0 {
            (x, y) = (24.0, y + LINE);
        }
        places.push([x, y]);
        x += length + 22.0;
    }
    places
}

/// The x axis under `panel`, with its ticks' grid lines.
fn x_axis<DB: DrawingBackend>(canvas: &Canvas<DB>, panel: Panel, x: &Axis, unit: &str) -> Result<()> {
    for tick in x.ticks() {
        let at = panel.left + panel.width() * (tick - x.low) / (x.high - x.low);
        canvas.line(&[[at, panel.top], [at, panel.bottom]], Pen::new(GRID, 1.0))?;
        canvas.line(&[[at, panel.bottom], [at, panel.bottom + 5.0]], Pen::new(INK, 1.0))?;
        canvas.text(&format!("{}{unit}", number(tick)), [at, panel.bottom + 17.0], TEXT, Anchor::Centre, INK)?;
    }
    canvas.text(&x.label, [panel.centre()[0], panel.bottom + 40.0], TEXT, Anchor::Centre, INK)
}

/// The degree sign, where the label says that the axis has degrees.
fn unit_of(axis: &Axis) -> &'static str {
    if axis.label.contains("[°]") { "°" } else { "" }
}

fn cartesian<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    panel: Panel,
    x: &Axis,
    y: &Axis,
    marks: &[Mark],
    curves: &[Curve],
) -> Result<()> {
    let labels = y.ticks().into_iter().map(|tick| text_width(&number(tick), TEXT)).fold(0.0, f64::max);
    let top = panel.top + if marks.is_empty() { 8.0 } else { 24.0 };
    let panel = Panel { left: panel.left + 30.0 + labels, top, right: panel.right - 14.0, bottom: panel.bottom - 46.0 };
    x_axis(canvas, panel, x, unit_of(x))?;
    let height = |v: f64| panel.bottom - panel.height() * (v - y.low) / (y.high - y.low);
    let place = |[a, b]: [f64; 2]| [panel.left + panel.width() * (a - x.low) / (x.high - x.low), height(b)];
    for tick in y.ticks() {
        let at = height(tick);
        canvas.line(&[[panel.left, at], [panel.right, at]], Pen::new(GRID, 1.0))?;
        canvas.text(&number(tick), [panel.left - 8.0, at], TEXT, Anchor::Right, INK)?;
    }
    canvas.upward(&y.label, [panel.left - labels - 24.0, panel.centre()[1]], TEXT, INK)?;
    for mark in marks {
        let [at, _] = place([mark.x, y.low]);
        let pen = Pen { color: GREY, width: 1.2, dashed: true };
        canvas.line(&[[at, panel.bottom], [at, panel.top]], pen)?;
        canvas.text(&mark.name, [at, panel.top - 11.0], NOTE, Anchor::Centre, GREY)?;
    }
    for curve in curves {
        let pen = Pen { color: curve.color, width: CURVE, dashed: curve.dashed };
        for piece in clipped(&curve.points, [x.low, x.high], [y.low, y.high]) {
            canvas.line(&piece.into_iter().map(place).collect::<Vec<_>>(), pen)?;
        }
    }
    let [l, t, r, b] = [panel.left, panel.top, panel.right, panel.bottom];
    canvas.line(&[[l, t], [l, b], [r, b]], Pen::new(INK, 1.4))
}

/// The parts of a line that lie in a rectangle (Liang and Barsky 1984); points that are no numbers interrupt it.
fn clipped(points: &[[f64; 2]], xs: [f64; 2], ys: [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let mut pieces: Vec<Vec<[f64; 2]>> = Vec::new();
    for ends in points.windows(2) {
        let [a, b] = [ends[0], ends[1]];
        let (mut enter, mut leave) = (0.0f64, 1.0f64);
        for (axis, [low, high]) in [(0, xs), (1, ys)] {
            let step = b[axis] - a[axis];
            for (towards, room) in [(-step, a[axis] - low), (step, high - a[axis])] {
                if towards < 0.0 {
                    enter = enter.max(room / towards);
                } else if towards > 0.0 {
                    leave = leave.min(room / towards);
                } else if room < 0.0 || towards.is_nan() {
                    leave = -1.0;
                }
            }
        }
        if enter > leave || !(b[1] - a[1]).is_finite() {
            continue;
        }
        let at = |t: f64| [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
        match pieces.last_mut() {
            Some(piece) if enter == 0.0 && piece.last() == Some(&a) => piece.push(at(leave)),
            _ => pieces.push(vec![at(enter), at(leave)]),
        }
    }
    pieces
}

fn polar<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    panel: Panel,
    side: Side,
    unit: &str,
    max: f64,
    arrows: &[Arrow],
    curves: &[Curve],
) -> Result<()> {
    // Room for the numbers of the spokes, and for the unit.
    let room =
        Panel { left: panel.left + 34.0, top: panel.top + 26.0, right: panel.right - 34.0, bottom: panel.bottom };
    let radius = match side {
        Side::Full => (room.width() / 2.0).min((room.height() - 60.0) / 2.0),
        _ => (room.width() / 2.0).min(room.height() - 56.0),
    };
    let [middle, _] = room.centre();
    // In the middle of what is left below.
    let spare = match side {
        Side::Full => room.height() - 60.0 - 2.0 * radius,
        _ => room.height() - 56.0 - radius,
    };
    let room = Panel { top: room.top + (spare / 2.0).max(0.0), ..room };
    let [centre, up] = match side {
        Side::Upper => [[middle, room.top + radius], [0.0, -1.0]],
        Side::Lower => [[middle, room.top], [0.0, 1.0]],
        Side::Full => [[middle, room.top + radius], [0.0, -1.0]],
    };
    let at = |angle: f64, length: f64| {
        let a = angle.to_radians();
        [centre[0] + length * libm::sin(a), centre[1] + up[1] * length * libm::cos(a)]
    };
    let reach: i32 = if side == Side::Full { 180 } else { 90 };
    let step = nice_step(max / 5.0);
    let rings = (max / step + 1e-9).floor() as i32;
    let circle = |length: f64| (-reach..=reach).map(|a| at(f64::from(a), length)).collect::<Vec<_>>();
    for ring in 1..=rings {
        canvas.line(&circle(radius * f64::from(ring) * step / max), Pen::new(GRID, 1.0))?;
    }
    canvas.line(&circle(radius), Pen::new(GREY, 1.0))?;
    for spoke in (-reach..=reach).step_by(if side == Side::Full { 30 } else { 15 }) {
        let angle = f64::from(spoke);
        canvas.line(&[centre, at(angle, radius)], Pen::new(GRID, 1.0))?;
        if spoke > -180 {
            canvas.text(&format!("{}°", spoke.abs()), at(angle, radius + 15.0), NOTE, Anchor::Centre, GREY)?;
        }
    }
    for arrow in arrows {
        if arrow.inward {
            inward(canvas, &at, arrow.angle, radius)?;
        } else {
            let pen = Pen { color: GREY, width: 1.4, dashed: true };
            canvas.line(&[centre, at(arrow.angle, radius)], pen)?;
        }
        let anchor = if arrow.angle < 0.0 { Anchor::Right } else { Anchor::Left };
        let beside = at(arrow.angle, radius * 0.93);
        let shift = if arrow.angle < 0.0 { -10.0 } else { 10.0 };
        canvas.text(&arrow.name, [beside[0] + shift, beside[1] + 13.0], NOTE, anchor, INK)?;
    }
    for curve in curves {
        let pen = Pen { color: curve.color, width: CURVE, dashed: curve.dashed };
        let points: Vec<[f64; 2]> = curve.points.iter().map(|[a, v]| at(*a, radius * v / max)).collect();
        canvas.line(&points, pen)?;
    }
    canvas.line(&[at(-90.0, radius), at(90.0, radius)], Pen::new(INK, 1.6))?;
    // The rings' lengths, below the horizon (above it, if the picture hangs down).
    let scale = if side == Side::Full { centre[1] + radius + 36.0 } else { centre[1] + 36.0 };
    let scale = if side == Side::Lower { centre[1] + radius + 40.0 } else { scale };
    for ring in 0..=rings {
        let x = centre[0] + radius * f64::from(ring) * step / max;
        canvas.line(&[[x, scale - 13.0], [x, scale - 8.0]], Pen::new(INK, 1.0))?;
        canvas.text(&number(f64::from(ring) * step), [x, scale], NOTE, Anchor::Centre, INK)?;
    }
    canvas.line(&[[centre[0], scale - 13.0], [centre[0] + radius, scale - 13.0]], Pen::new(INK, 1.0))?;
    canvas.text(unit, [centre[0] - 16.0, scale], NOTE, Anchor::Right, INK)
}

/// A ray that arrives at the centre: from `radius` along `angle` to two fifths of it.
fn inward<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    at: &impl Fn(f64, f64) -> [f64; 2],
    angle: f64,
    radius: f64,
) -> Result<()> {
    let tip = at(angle, radius * 0.4);
    canvas.line(&[at(angle, radius), tip], Pen::new(INK, 2.0))?;
    let (back, side) = (at(angle, radius * 0.4 + 13.0), 5.0);
    let direction = [(back[0] - tip[0]) / 13.0, (back[1] - tip[1]) / 13.0];
    let across = [-direction[1] * side, direction[0] * side];
    canvas.polygon(&[tip, [back[0] + across[0], back[1] + across[1]], [back[0] - across[0], back[1] - across[1]]], INK)
}

fn ramp<DB: DrawingBackend>(canvas: &Canvas<DB>, panel: Panel, x: &Axis, strips: &[Strip]) -> Result<()> {
    let names = strips.iter().map(|strip| text_width(&strip.name, TEXT)).fold(0.0, f64::max);
    let panel = Panel { left: panel.left + names + 18.0, top: panel.top + 8.0, right: panel.right - 14.0, ..panel };
    let panel = Panel { bottom: panel.bottom - 46.0, ..panel };
    x_axis(canvas, panel, x, unit_of(x))?;
    let row = panel.height() / strips.len() as f64;
    for (i, strip) in strips.iter().enumerate() {
        let [top, bottom] = [panel.top + row * i as f64 + 3.0, panel.top + row * (i + 1) as f64 - 3.0];
        let count = strip.colors.len() as f64;
        for (k, color) in strip.colors.iter().enumerate() {
            // Each over the rest of the one before: no seams.
            let (left, right) = (panel.left + panel.width() * k as f64 / count, panel.right);
            canvas.polygon(&[[left, top], [right, top], [right, bottom], [left, bottom]], *color)?;
        }
        canvas.text(&strip.name, [panel.left - 10.0, (top + bottom) / 2.0], TEXT, Anchor::Right, INK)?;
    }
    Ok(())
}

/// In rows of up to three.
fn bodies<DB: DrawingBackend>(canvas: &Canvas<DB>, panel: Panel, bodies: &[Body]) -> Result<()> {
    let columns = bodies.len().clamp(1, 3);
    let rows = bodies.len().div_ceil(columns).max(1);
    let (width, height) = (panel.width() / columns as f64, panel.height() / rows as f64);
    for (i, body) in bodies.iter().enumerate() {
        let (left, top) = (panel.left + width * (i % columns) as f64, panel.top + height * (i / columns) as f64);
        let side = width.min(height - 30.0);
        let corner = [left + (width - side) / 2.0, top + (height - 30.0 - side) / 2.0];
        let place = |p: &[f64; 2]| [corner[0] + side * p[0], corner[1] + side * (1.0 - p[1])];
        for facet in &body.facets {
            canvas.polygon(&facet.corners.iter().map(place).collect::<Vec<_>>(), facet.color)?;
        }
        let size = TEXT.min(width / text_width(&body.name, 1.0).max(1.0));
        canvas.text(&body.name, [left + width / 2.0, top + height - 12.0], size, Anchor::Centre, INK)?;
    }
    Ok(())
}
