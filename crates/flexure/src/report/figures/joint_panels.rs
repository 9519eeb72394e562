//! The figure of a run with many joints: a row of small panels for each.

use super::run::{FigureOptions, bounds_of, legend_of_bounds};
use crate::files::number::{power_of_ten, significant};
use crate::report::Sketch;
use crate::report::draw::axes::{Axes, Axis};
use crate::report::draw::curve::Curve;
use crate::report::draw::falling::Falling;
use crate::report::draw::marks::{self, Happening, JointMarks, shade};
use crate::report::draw::panel::buckets;
use crate::report::draw::range::{Linear, Range, decades};
use crate::report::draw::scene::{Anchor, Lettering, Scene};
use crate::report::draw::sheet::{MARGIN, line_legend, page};
use crate::report::draw::style::{INK, LIMIT, MUTED, Stroke, bold, letters};
use crate::report::draw::ticks;
use crate::simulate::SETTLED;
use crate::units;

const WIDTH: f64 = 1200.0;
/// Height of a row, and of the frames in it [px].
const ROW: f64 = 132.0;
const FRAME: f64 = 96.0;
/// Room for the numbers left of a frame [px].
const LEFT: f64 = 66.0;
const RIGHT: f64 = 14.0;
/// Room for the headings of the columns above the first row [px].
const HEADING: f64 = 40.0;
/// Room for the time axis below the last row [px].
const BELOW: f64 = 40.0;
const NOTES: Lettering = letters(12.0, MUTED);
const DOTTED: Stroke = Stroke { color: MUTED, width: 1.2, dash: &[1.5, 3.0] };

/// What a column shows of each joint.
const COLUMNS: [&str; 3] = ["position", "|position error|", "motor torque"];

/// Positions, errors and torques of `run`, a row of three panels a joint, with its name, its limits and its own scales. Errors are absolute, on
/// logarithmic axes. Torques are parts of the joint's limit, if it has one.
pub fn joint_panels(run: &Sketch, options: &FigureOptions) -> Scene {
    let joints = run.joints("q_l").max(run.joints("u_m"));
    let happenings = options.happenings(run);
    let (mut scene, under_title) = page(WIDTH, &options.title, &options.subtitle);
    let mut marked = Marked { limit: true, settled: true };
    let entries = legend(marked, options, &happenings);
    let top = under_title + line_legend(&mut scene.clone(), under_title, &entries) + HEADING - 14.0;
    marked = Marked { limit: false, settled: false };
    scene.height = top + ROW * joints as f64 + BELOW;
    let width = (WIDTH - MARGIN) / COLUMNS.len() as f64;
    for (column, heading) in COLUMNS.iter().enumerate() {
        let left = 0.5 * MARGIN + width * column as f64 + LEFT;
        scene.text([left, top - 14.0], heading, bold(15.0, INK), Anchor::Start);
    }
    let positions = [("q_m", side(MOTOR)), ("q_l", side(LINK)), ("q_ld", Stroke::reference())];
    let errors = [("e_m", side(MOTOR)), ("e_l", side(LINK))];
    let drawn = |signals: &[(&str, Stroke)], joint: usize| {
        let of_joint =
            |(prefix, stroke): &(&str, Stroke)| run.curves(prefix, |_, _| *stroke).into_iter().nth(joint);
        signals.iter().filter_map(of_joint).collect::<Vec<Curve>>()
    };
    for joint in 0..joints {
        let marks = options.joint(joint);
        let row = Row { run, happenings: &happenings, last: joint + 1 == joints };
        let place = |column: usize| [0.5 * MARGIN + width * column as f64, top + ROW * joint as f64, width];
        marked.limit |= row.linear(
            &mut scene,
            place(0),
            &marks.name,
            &drawn(&positions, joint),
            units::ANGLE.of(marks.kind).raised,
            &marks.positions,
        );
        let seen = Errors {
            curves: &drawn(&errors, joint),
            bounds: &bounds_of(options, |errors| errors.get(joint).copied()),
            settled: options.settled,
        };
        marked.settled |= row.errors(&mut scene, place(1), &seen, &marks);
        let (torques, unit, limits) = share(drawn(&[("u_m", side(LINK))], joint), &marks);
        marked.limit |= row.linear(&mut scene, place(2), "", &torques, unit, &limits);
    }
    line_legend(&mut scene, under_title, &legend(marked, options, &happenings));
    scene
}

const LINK: f64 = 2.0;
const MOTOR: f64 = 1.4;

/// The line of one side: with a joint a row, hue need not say which.
fn side(width: f64) -> Stroke {
    if width < LINK { Stroke::motor(1, 2) } else { Stroke { width, ..Stroke::link(0, 1) } }
}

/// Torques in % of the limit, if there is one, with what a frame is to mark.
fn share(mut curves: Vec<Curve>, marks: &JointMarks) -> (Vec<Curve>, &'static str, [f64; 2]) {
    if !marks.torque_limit.is_finite() {
        return (curves, units::TORQUE.of(marks.kind).raised, [f64::NEG_INFINITY, f64::INFINITY]);
    }
    curves
        .iter_mut()
        .flat_map(|curve| &mut curve.values)
        .for_each(|value| *value *= 100.0 / marks.torque_limit);
    (curves, "% of the limit", [-100.0, 100.0])
}

/// What the panel of a joint's errors shows.
struct Errors<'a> {
    curves: &'a [Curve],
    bounds: &'a [Falling],
    /// Time after which the links stay within what counts as settled \[s\].
    settled: Option<f64>,
}

/// The panels of a joint.
struct Row<'a> {
    run: &'a Sketch,
    happenings: &'a [Happening],
    /// Whether the time axis is below it.
    last: bool,
}

impl Row<'_> {
    /// A frame with a linear axis: `name` and unit above it, `limits` marked where they are inside. Returns whether one is.
    fn linear(
        &self,
        scene: &mut Scene,
        place: [f64; 3],
        name: &str,
        curves: &[Curve],
        unit: &str,
        limits: &[f64; 2],
    ) -> bool {
        let mut values = curves.iter().flat_map(|curve| curve.values.iter().copied());
        let of = if self.run.diverged().is_some() { Linear::of_diverged } else { Linear::of };
        let Linear { range, clipped } = of(&mut values);
        let power = ticks::power(range);
        let axes = self.axes(place, range, ticks::several(range, 4, power));
        shade(scene, &axes, self.happenings);
        axes.draw(scene);
        for limit in limits.iter().filter(|limit| range.contains(**limit)) {
            axes.level(scene, *limit, LIMIT);
        }
        self.draw(scene, &axes, curves);
        let unit = if power == 0 { unit.to_owned() } else { format!("{} {unit}", power_of_ten(power)) };
        let peak = clipped.then(|| {
            let values = curves.iter().flat_map(|curve| &curve.values);
            let peak = values.fold(0.0, |peak: f64, value| peak.max(value.abs()));
            format!("peak {}", significant(peak / 10f64.powi(power), 3))
        });
        head(scene, &axes, name, &unit, peak.as_deref().unwrap_or(""));
        limits.iter().any(|limit| range.contains(*limit))
    }

    /// A frame with absolute errors in decades, and when they have settled below what counts as settled. Returns
    /// whether either is inside.
    fn errors(
        &self,
        scene: &mut Scene,
        place: [f64; 3],
        Errors { curves, bounds, settled }: &Errors<'_>,
        marks: &JointMarks,
    ) -> bool {
        let mut exponents: Vec<Curve> =
            curves.iter().map(|curve| curve.exponents(buckets(2 * COLUMNS.len()))).collect();
        let range = decades(&exponents);
        let range = Range { low: range.low.max(range.high - 9.0), ..range };
        let range = bounds.iter().fold(range, |range, bound| bound.seen_on(range));
        exponents.extend(bounds.iter().map(|bound| bound.line(self.run.span(), range)));
        let axes = self.axes(place, range, every_other(ticks::decades(range)));
        shade(scene, &axes, self.happenings);
        axes.draw(scene);
        let is_level = range.contains(SETTLED.log10());
        if is_level {
            axes.level(scene, SETTLED.log10(), DOTTED);
        }
        let settled = settled.filter(|time| *time > axes.x.range.low && axes.x.range.contains(*time));
        if let Some(time) = settled {
            axes.mark(scene, time, DOTTED);
        }
        self.draw(scene, &axes, &exponents);
        head(scene, &axes, "", units::ANGLE.of(marks.kind).raised, "");
        is_level || settled.is_some()
    }

    fn axes(&self, [left, top, width]: [f64; 3], range: Range, ticks: Vec<ticks::Tick>) -> Axes<'static> {
        let frame = [left + LEFT, top + 22.0, width - LEFT - RIGHT, FRAME];
        let t = self.run.span();
        let mut times = ticks::even(t, (frame[2] / 55.0).clamp(2.0, 8.0));
        if !self.last {
            for tick in &mut times {
                tick.name.clear();
            }
        }
        let label = if self.last { crate::report::draw::panel::TIME } else { "" };
        Axes {
            frame,
            left: LEFT,
            x: Axis { range: t, ticks: times, label },
            y: Axis { range, ticks, label: "" },
        }
    }

    fn draw(&self, scene: &mut Scene, axes: &Axes, curves: &[Curve]) {
        for curve in curves {
            axes.curve(scene, curve, buckets(3 * COLUMNS.len()));
        }
        if let Some(t) = self.run.diverged() {
            axes.mark(scene, t, DOTTED);
        }
    }
}

/// What stands above a frame: the name on its left, the unit after it, a note on its right.
fn head(scene: &mut Scene, axes: &Axes, name: &str, unit: &str, note: &str) {
    let [left, top, width, _] = axes.frame;
    let after =
        if name.is_empty() { 0.0 } else { crate::report::draw::text::width(name, bold(13.0, INK)) + 8.0 };
    if !name.is_empty() {
        scene.text([left, top - 6.0], name, bold(13.0, INK), Anchor::Start);
    }
    scene.text([left + after, top - 6.0], &format!("[{unit}]"), NOTES, Anchor::Start);
    if !note.is_empty() {
        scene.text([left + width, top - 6.0], note, NOTES, Anchor::End);
    }
}

/// Low frames have room for every other number of many.
fn every_other(ticks: Vec<ticks::Tick>) -> Vec<ticks::Tick> {
    let step = if ticks.len() > 4 { 2 } else { 1 };
    ticks.into_iter().step_by(step).collect()
}

/// What frames mark.
#[derive(Clone, Copy)]
struct Marked {
    limit: bool,
    settled: bool,
}

fn legend(marked: Marked, options: &FigureOptions, happenings: &[Happening]) -> Vec<(String, Stroke)> {
    let entry = |name: &str, stroke: Stroke| (name.to_owned(), stroke);
    let mut entries = vec![
        entry("link side", side(LINK)),
        entry("motor side", side(MOTOR)),
        entry("reference", Stroke::reference()),
    ];
    if marked.settled {
        let within = format!("1 {}", options.angles("m"));
        let when = if options.settled.is_some() { ", and settled below it" } else { "" };
        entries.push((within + when, DOTTED));
    }
    if marked.limit {
        entries.push(entry("limit", LIMIT));
    }
    entries.extend(legend_of_bounds(options));
    entries.extend(marks::legend(happenings));
    entries
}
