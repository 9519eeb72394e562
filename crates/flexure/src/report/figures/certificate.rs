//! A proof as a picture: the storage W along the run of the file; for each joint its link error in the funnel over time, if there is one, and the
//! plane of its errors with the region, the level set, the tube and the run in them.

use super::error_path::ErrorPath;
use super::run::BOUND;
use crate::files::Problems;
use crate::files::number::{engineering, power_of_ten, rounded_down, rounded_up, short, significant};
use crate::progress::Progress;
use crate::prove::decay::ROUNDING;
use crate::prove::robust::Profile;
use crate::prove::sampled_data::TubeProfile;
use crate::prove::summary::{FunnelSummary, ProofSummary, SampledTubeSummary};
use crate::report::draw::axes::{Axes, Axis, BOTTOM};
use crate::report::draw::curve::Curve;
use crate::report::draw::panel::{LEFT, TIME, buckets, over_time, span};
use crate::report::draw::range::{Range, decades};
use crate::report::draw::scene::{Anchor, Point, Scene, Shape};
use crate::report::draw::sheet::{MARGIN, line_legend, page};
use crate::report::draw::style::{HOLDS, INK, MUTED, Stroke, WHITE, bold, hue};
use crate::report::draw::ticks;
use crate::robot::JointKind;
use crate::scenario::Scenario;
use crate::units;

const WIDTH: f64 = 1200.0;
/// Height of W over time [px].
const STORAGE: f64 = 380.0;
/// Planes in a row, and the height of one [px].
const COLUMNS: usize = 4;
const PLANE: f64 = 330.0;
/// Height of a link error over time [px].
const BAND: f64 = 280.0;
/// So many times what is proved is shown of a run that leaves it.
const OUTSIDE: f64 = 3.0;
/// The region is shown where it is no more than so many times the level set.
const FAR: f64 = 2.5;
/// Decades of W below its largest that are shown.
const DECADES: f64 = 25.0;

const REGION: Stroke = Stroke { color: MUTED, width: 1.6, dash: &[6.0, 4.0] };
const LEVEL: Stroke = Stroke::solid(HOLDS, 2.4);

fn funnel_stroke() -> Stroke {
    Stroke::solid(hue(3), 2.0)
}

fn tube_stroke() -> Stroke {
    Stroke::solid(hue(1), 2.0)
}

fn run_stroke() -> Stroke {
    Stroke::solid(hue(0), 2.2)
}

/// Runs `scenario` as its file says, and draws what `summary` tells of it around that run.
///
/// # Errors
/// If W is not defined or jumps, as with a reference whose third derivative does, and if the loop cannot be run.
pub fn certificate_figure(
    scenario: &Scenario,
    summary: &ProofSummary,
    progress: Progress<'_>,
) -> Result<Scene, Problems> {
    let path = ErrorPath::of(scenario, progress)?;
    let (t, values) = path.storage();
    let run = Curve { t, values, stroke: run_stroke() };
    let told = Told::new(summary);
    let decay = told.start.zip(told.rate).map(|(level, rate)| proved_decay(level, rate, &run));

    let subtitle = if told.tube.is_some() {
        "the run and the tube are of the loop in the file; all else is proved of the law in continuous time, with exact measurements and without limits of torques"
    } else {
        "the run is that of the file, with all that it has; what is proved is proved of the law in continuous time, with exact measurements \
         and without limits of torques"
    };
    let (mut scene, top) = page(WIDTH, &format!("{}: {}", scenario.name, told.title()), subtitle);
    let mut top = top + line_legend(&mut scene, top, &told.legend()) + 8.0;
    draw_storage(&mut scene, top, &told, &run, decay.as_ref());
    top += STORAGE + 14.0;
    let joints = scenario.robot.joint_count();
    let columns = joints.clamp(1, COLUMNS);
    let width = (WIDTH - MARGIN) / columns as f64;
    let rows = joints.div_ceil(columns) as f64;
    let place = |i: usize, top: f64, height: f64| {
        [MARGIN / 2.0 + width * (i % columns) as f64, top + height * (i / columns) as f64]
    };
    let all = || 0..joints;
    let funnel = told.funnel.map(|profile| all().map(|i| of_funnel(profile, i)).collect::<Vec<_>>());
    let tube = told.tube.map(|profile| all().map(|i| of_tube(profile, i)).collect());
    for bands in [funnel, tube].into_iter().flatten() {
        for ((i, joint), ends) in scenario.robot.joints.iter().enumerate().zip(bands) {
            let band = Band::new(&path, ends, i);
            band.draw(&mut scene, place(i, top, BAND), width, &joint.name, joint.kind);
        }
        top += BAND * rows;
    }
    for (i, joint) in scenario.robot.joints.iter().enumerate() {
        let place = place(i, top, PLANE);
        Plane::new(&path, &told, i, joints).draw(&mut scene, place, width, &joint.name, joint.kind);
    }
    scene.height = top + PLANE * rows + 6.0;
    Ok(scene)
}

/// What a proof says of the errors.
struct Told<'a> {
    /// The region: largest |q̃_i|, links then motors.
    region: Option<&'a [f64]>,
    /// Levels of W.
    levels: Vec<Set<'a>>,
    /// Bound of W at the start, in J, if that is inside.
    start: Option<f64>,
    /// Rate at which √W decays \[1/s\].
    rate: Option<f64>,
    funnel: Option<&'a Profile>,
    /// The tube of the sampled loop.
    tube: Option<&'a TubeProfile>,
}

/// The states up to a level of W.
struct Set<'a> {
    what: &'static str,
    /// In J.
    level: f64,
    /// |q̃_i| there, links then motors.
    error: &'a [f64],
    stroke: Stroke,
    /// To the side on which it still holds.
    rounded: fn(f64, usize) -> f64,
}

impl<'a> Told<'a> {
    fn new(summary: &'a ProofSummary) -> Self {
        let region = summary.region.as_ref();
        let set = |what, stroke, rounded| move |(level, error)| Set { what, level, error, stroke, rounded };
        let dotted = |index| Stroke { color: hue(index), width: 2.2, dash: &[2.0, 3.0] };
        let invariant = region.and_then(|region| region.level.zip(region.error_at_level.as_deref()));
        let tube = summary.tube.as_ref().map(|tube| (tube.level, tube.error.as_slice()));
        let within = summary.within.as_ref().and_then(|within| within.settles.zip(within.error.as_deref()));
        let levels = [
            invariant.map(set("invariant", LEVEL, rounded_down as fn(f64, usize) -> f64)),
            tube.map(set("tube of the disturbance", dotted(1), rounded_up)),
            within.map(set("where robots within the tolerances settle", dotted(5), rounded_up)),
        ];
        Self {
            region: region.and_then(|region| region.error.as_deref()),
            levels: levels.into_iter().flatten().filter(|set| set.level > 0.0).collect(),
            start: summary
                .start
                .filter(|start| start.inside && start.level > ROUNDING)
                .map(|start| start.level),
            rate: summary.convergence_rate.filter(|rate| *rate > 0.0),
            funnel: summary.funnel.as_ref().and_then(|funnel| match funnel {
                FunnelSummary::Proved(robust) => Some(&robust.profile),
                FunnelSummary::Undecided(_) => None,
            }),
            tube: summary.sampled_tube.as_ref().and_then(|tube| match tube {
                SampledTubeSummary::Proved(tube) => Some(&tube.profile),
                SampledTubeSummary::Undecided(_) => None,
            }),
        }
    }

    fn title(&self) -> &'static str {
        if self.rate.is_none() && self.levels.is_empty() {
            "errors of the run"
        } else {
            "errors, and what is proved of them"
        }
    }

    fn legend(&self) -> Vec<(String, Stroke)> {
        let decay = self.start.zip(self.rate).map(|(_, rate)| {
            (
                format!(
                    "W(0) e^(−2 · {} t), proved in continuous time",
                    significant(rounded_down(rate, 3), 3)
                ),
                BOUND,
            )
        });
        let region = self.region.map(|errors| (region_in_words(errors), REGION));
        let levels = self.levels.iter().map(|Set { what, level, stroke, rounded, .. }| {
            (format!("W = {} J, {what}", engineering(rounded(*level, 3))), *stroke)
        });
        let funnel = self.funnel.map(|_| {
            ("funnel: link errors under every torque, of every robot asked about".to_owned(), funnel_stroke())
        });
        let tube = self.tube.map(|_| {
            (
                "tube of the loop as sampled: link errors of all motions that start in it".to_owned(),
                tube_stroke(),
            )
        });
        std::iter::once(("the run".to_owned(), run_stroke()))
            .chain(funnel)
            .chain(tube)
            .chain(decay)
            .chain(region)
            .chain(levels)
            .collect()
    }
}

/// How far the region goes, if that is the same in all directions: it may lie outside of a frame.
fn region_in_words(errors: &[f64]) -> String {
    match errors {
        [first, rest @ ..] if rest.iter().all(|error| error.total_cmp(first).is_eq()) => {
            format!("region of the proof, errors up to {}", short(*first, 3))
        }
        _ => "region of the proof".to_owned(),
    }
}

/// What W cannot exceed from `level` on, over the time of the run.
fn proved_decay(level: f64, rate: f64, run: &Curve) -> Curve {
    let Range { low, high } = span(&run.t);
    let t: Vec<f64> = (0..=400).map(|k| low + (high - low) * f64::from(k) / 400.0).collect();
    let values = t.iter().map(|t| level * (-2.0 * rate * (t - low)).exp()).collect();
    Curve { t, values, stroke: BOUND }
}

fn draw_storage(scene: &mut Scene, top: f64, told: &Told, run: &Curve, decay: Option<&Curve>) {
    let count = buckets(3);
    let time = span(&run.t);
    let run = run.exponents(count);
    let levels: Vec<(f64, Stroke)> = told.levels.iter().map(|set| (set.level.log10(), set.stroke)).collect();
    let of_run = decades(std::slice::from_ref(&run));
    let range = levels.iter().fold(of_run, |range, (level, _)| Range {
        low: range.low.min(level - 0.5),
        high: range.high.max(level + 0.5),
    });
    // What the legend names is seen.
    let start = told.start.zip(told.rate).map_or(range.low, |(start, _)| start.log10());
    let range = Range { low: range.low.min(start - 0.5), high: range.high.max(start + 0.5) };
    let range = Range { low: range.low.max(range.high - DECADES), ..range };
    let y = Axis { range, ticks: ticks::decades(range), label: "storage W [J]" };
    let axes = over_time([MARGIN / 2.0, top, WIDTH - MARGIN, STORAGE], LEFT, time, TIME, y);
    axes.draw(scene);
    for (level, stroke) in levels.into_iter().filter(|(level, _)| axes.y.range.contains(*level)) {
        axes.level(scene, level, stroke);
    }
    for curve in decay.map(|decay| decay.exponents(count)).iter().chain([&run]) {
        axes.curve(scene, curve, count);
    }
}

/// What the link error of a joint stays within in a funnel, constant over each part, either way.
fn of_funnel(profile: &Profile, joint: usize) -> [Curve; 2] {
    let values = |sign: f64| profile.error[joint].iter().map(move |error| sign * error);
    [1.0, -1.0].map(|sign| steps(&profile.end, values(sign), funnel_stroke()))
}

/// The same in a tube of the sampled loop.
fn of_tube(profile: &TubeProfile, joint: usize) -> [Curve; 2] {
    [&profile.highest, &profile.lowest]
        .map(|errors| steps(&profile.end, errors[joint].iter().copied(), tube_stroke()))
}

/// A curve of `values`, each up to its `end`.
fn steps(end: &[f64], values: impl Iterator<Item = f64>, stroke: Stroke) -> Curve {
    let begins = std::iter::once(&0.0).chain(end);
    let t = begins.zip(end).flat_map(|(from, to)| [*from, *to]).collect();
    Curve { t, values: values.flat_map(|value| [value; 2]).collect(), stroke }
}

/// The link error of a joint over time.
struct Band {
    run: Curve,
    /// What it stays within, either way.
    ends: [Curve; 2],
}

impl Band {
    fn new(path: &ErrorPath, ends: [Curve; 2], joint: usize) -> Self {
        let (t, values) = path.of_link(joint);
        Self { run: Curve { t, values, stroke: run_stroke() }, ends }
    }

    fn draw(&self, scene: &mut Scene, [left, top]: Point, width: f64, name: &str, kind: JointKind) {
        let unit = units::ANGLE.of(kind).raised;
        let size = |curve: &Curve| curve.values.iter().map(|e| e.abs()).fold(0.0, f64::max);
        let within = self.ends.iter().map(size).fold(0.0, f64::max);
        let most = 1.12 * within.max(size(&self.run).min(OUTSIDE * within)).max(1e-15);
        let range = Range { low: -most, high: most };
        // Numbers half as large have to fit beside the frame, too.
        let power = ticks::power(Range { low: 0.5 * range.low, high: 0.5 * range.high });
        let label = match power {
            0 => format!("link error [{unit}]"),
            power => format!("link error [{} {unit}]", power_of_ten(power)),
        };
        scene.text([left + LEFT, top + 16.0], name, bold(15.0, INK), Anchor::Start);
        let y = Axis { range, ticks: ticks::several(range, 6, power), label: &label };
        let time = span(&self.ends[0].t);
        let axes = over_time([left, top + 20.0, width, BAND - 26.0], LEFT, time, TIME, y);
        axes.draw(scene);
        for curve in self.ends.iter().chain([&self.run]) {
            axes.curve(scene, curve, buckets(3));
        }
    }
}

/// The errors of a joint: of the link to the right, of the motor upwards.
struct Plane {
    run: Curve,
    /// Largest error of the region either way.
    region: Option<Point>,
    /// The same of levels.
    levels: Vec<(Point, Stroke)>,
}

impl Plane {
    fn new(path: &ErrorPath, told: &Told, joint: usize, joints: usize) -> Self {
        let (e_l, e_m) = path.of_joint(joint);
        let of = |errors: &[f64]| Some([*errors.get(joint)?, *errors.get(joints + joint)?]);
        Self {
            run: Curve { t: e_l, values: e_m, stroke: Stroke { width: 1.3, ..run_stroke() } },
            region: told.region.and_then(of),
            levels: told.levels.iter().filter_map(|set| Some((of(set.error)?, set.stroke))).collect(),
        }
    }

    fn draw(&self, scene: &mut Scene, [left, top]: Point, width: f64, name: &str, kind: JointKind) {
        let unit = units::ANGLE.of(kind).raised;
        let [x, y] = [0, 1].map(|side| self.range(side));
        let label = |of: &str, range: Range| match ticks::power(range) {
            0 => format!("{of} [{unit}]"),
            power => format!("{of} [{} {unit}]", power_of_ten(power)),
        };
        let labels = [label("link error", x), label("motor error", y)];
        let ticks = |range: Range, most: u8| ticks::several(range, most, ticks::power(range));
        scene.text([left + LEFT, top + 16.0], name, bold(15.0, INK), Anchor::Start);
        let axes = Axes {
            frame: [left + LEFT, top + 26.0, width - LEFT - 14.0, PLANE - 26.0 - BOTTOM - 8.0],
            left: LEFT,
            x: Axis { range: x, ticks: ticks(x, 4), label: &labels[0] },
            y: Axis { range: y, ticks: ticks(y, 6), label: &labels[1] },
        };
        axes.draw(scene);
        let region = self.region.map(|[a, b]| rectangle(a, b));
        let levels = self.levels.iter().map(|([a, b], stroke)| ellipse(*a, *b, *stroke));
        for curve in region.into_iter().chain(levels).chain([self.run.clone()]) {
            axes.curve(scene, &curve, curve.t.len());
        }
        if let (Some(&e_l), Some(&e_m)) = (self.run.t.first(), self.run.values.first()) {
            let rim = Stroke::solid(hue(0), 2.0);
            scene.shapes.push(Shape::Circle { center: axes.place(e_l, e_m), radius: 4.5, fill: WHITE, rim });
        }
    }

    /// Symmetric, with everything in it, but for a run that goes far beyond what is proved, and a region far beyond its level set.
    fn range(&self, side: usize) -> Range {
        let run = if side == 0 { &self.run.t } else { &self.run.values };
        let inner = self.levels.iter().map(|(point, _)| point[side]).fold(0.0, f64::max);
        let region =
            self.region.map(|point| point[side]).filter(|region| inner == 0.0 || *region <= FAR * inner);
        let proved = region.unwrap_or(0.0).max(inner);
        let farthest = if proved > 0.0 { OUTSIDE * proved } else { f64::INFINITY };
        let run = run.iter().map(|e| e.abs()).fold(0.0, f64::max).min(farthest);
        let most = 1.12 * run.max(proved).max(1e-15);
        Range { low: -most, high: most }
    }
}

fn rectangle(a: f64, b: f64) -> Curve {
    Curve { t: vec![-a, a, a, -a, -a], values: vec![-b, -b, b, b, -b], stroke: REGION }
}

/// The shadow of a level set of W on a plane of errors: Π is diagonal, and momenta may be 0.
fn ellipse(a: f64, b: f64, stroke: Stroke) -> Curve {
    let angles = (0..=120).map(|k| std::f64::consts::TAU * f64::from(k) / 120.0);
    let (t, values) = angles.map(|angle| (a * angle.cos(), b * angle.sin())).unzip();
    Curve { t, values, stroke }
}
