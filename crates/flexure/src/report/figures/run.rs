//! The paper's four-panel figure of one closed-loop run.
//!
//! Positions and torques are on linear axes. Where a short excursion would flatten the rest (the first torque peak is
//! a hundred times what follows), the axis shows the bulk and a narrow frame beside it shows the excursion whole.
//! Errors and momentum errors are absolute values on a logarithmic axis: an exponential decay is a straight line.

use super::joint_panels::joint_panels;
use crate::files::number::{short, significant, small};
use crate::prove::decay::Decay;
use crate::report::draw::curve::Curve;
use crate::report::draw::falling::Falling;
use crate::report::draw::marks::{self, Happening, JointMarks, What};
use crate::report::draw::panel::{self, HEIGHT, Limit, Panel, Scale, View};
use crate::report::draw::range::Range;
use crate::report::draw::scene::Scene;
use crate::report::draw::sheet::{MARGIN, line_legend, page};
use crate::report::draw::style::{INK, LIMIT, Stroke, hue};
use crate::report::{Sketch, Ultimate};
use crate::robot::JointKind;
use crate::units::{self, of_joints};

/// What is written above the panels.
#[derive(Clone, Debug, Default)]
pub struct FigureOptions {
    /// First line, bold.
    pub title: String,
    /// Second line; may be empty.
    pub subtitle: String,
    /// The joints; those that are missing are numbered and have no limits.
    pub joints: Vec<JointMarks>,
    /// What happens to the robot when, beside what the run itself tells.
    pub happenings: Vec<Happening>,
    /// Time after which the links stay within 1 mrad of the reference \[s\], if they do.
    pub settled: Option<f64>,
    /// What is proved of the position errors of this loop, if anything is.
    pub decay: Option<Decay>,
    /// Whether the torque is held for a control period, which what is proved leaves out.
    pub held: bool,
    /// What its position errors come down to, of a loop that converges practically.
    pub ultimate: Option<Ultimate>,
}

impl FigureOptions {
    /// The joint with this index, from 0.
    pub(crate) fn joint(&self, index: usize) -> JointMarks {
        self.joints.get(index).cloned().unwrap_or_else(|| JointMarks::named(format!("joint {}", index + 1)))
    }

    /// The unit of position errors of all joints, with a prefix.
    pub(crate) fn angles(&self, prefix: &str) -> String {
        let kinds: Vec<JointKind> = self.joints.iter().map(|joint| joint.kind).collect();
        of_joints(units::ANGLE, prefix, &kinds)
    }

    /// Limits of the joints, each in its colour.
    fn limits(&self, of: impl Fn(&JointMarks) -> [f64; 2]) -> Vec<Limit> {
        let each = |(i, joint): (usize, &JointMarks)| {
            of(joint).map(|value| Limit {
                value,
                of: joint.name.clone(),
                stroke: Stroke { color: hue(i), ..LIMIT },
            })
        };
        self.joints.iter().enumerate().flat_map(each).collect()
    }

    /// All that happens, in the order of kinds.
    pub(crate) fn happenings(&self, run: &Sketch) -> Vec<Happening> {
        let stops = run.stops().map(|Range { low: from, high: to }| Happening { from, to, what: What::Stop });
        self.happenings.iter().copied().chain(stops).collect()
    }
}

/// Joints up to which all are drawn in the same panels.
const FEW: usize = 3;

/// The figure of a run: [`four_panel`] of three joints or fewer that all turn, [`joint_panels`] of others.
pub fn run_figure(run: &Sketch, options: &FigureOptions) -> Scene {
    let slides = options.joints.iter().any(|joint| joint.kind == JointKind::Prismatic);
    if run.joints("q_l") > FEW || slides { joint_panels(run, options) } else { four_panel(run, options) }
}

const WIDTH: f64 = 1200.0;
pub(crate) const BOUND: Stroke = Stroke { color: INK, width: 1.8, dash: &[8.0, 4.0, 2.0, 4.0] };
/// Of links and of motors.
const BOUNDS: [Stroke; 2] = [BOUND, Stroke { width: 1.0, dash: &[4.0, 3.0, 1.0, 3.0], ..BOUND }];
/// The same of what was measured.
const LEVELS: [Stroke; 2] =
    [Stroke { dash: &[14.0, 4.0], ..BOUND }, Stroke { width: 1.0, dash: &[7.0, 2.0], ..BOUND }];

/// Positions, errors, momentum errors and torques of `run` over time.
///
/// A run that diverged is drawn up to its last finite sample, which is marked. Columns that are missing leave their
/// panel empty.
pub fn four_panel(run: &Sketch, options: &FigureOptions) -> Scene {
    let joints = run.joints("q_l").max(run.joints("u_m"));
    let dotted = |prefix| run.curves(prefix, |_, _| Stroke::reference());
    let link = |prefix| run.curves(prefix, Stroke::link);
    let motor = |prefix| run.curves(prefix, Stroke::motor);

    let positions = over(over(motor("q_m"), link("q_l")), dotted("q_ld"));
    let panels = [
        Panel {
            title: "(a) positions qₗ, qₘ and reference of qₗ",
            quantity: "position",
            unit: units::ANGLE.raised,
            scale: Scale::Linear,
            window: None,
            limits: options.limits(|joint| joint.positions),
            curves: positions,
            bounds: Vec::new(),
        },
        Panel {
            title: "(b) position errors eₗ, eₘ",
            quantity: "|error|",
            unit: units::ANGLE.raised,
            scale: Scale::Decades,
            window: None,
            limits: Vec::new(),
            curves: over(motor("e_m"), link("e_l")),
            bounds: bounds(options),
        },
        Panel {
            title: "(c) momentum errors σₗ, σₘ",
            quantity: "|momentum error|",
            unit: units::MOMENTUM.raised,
            scale: Scale::Decades,
            window: None,
            limits: Vec::new(),
            curves: over(motor("sigma_m"), link("sigma_l")),
            bounds: Vec::new(),
        },
        Panel {
            title: "(d) motor torques uₘ",
            quantity: "torque",
            unit: units::TORQUE.raised,
            scale: Scale::Linear,
            window: None,
            limits: options.limits(|joint| [-joint.torque_limit, joint.torque_limit]),
            curves: link("u_m"),
            bounds: Vec::new(),
        },
    ];
    let view = View {
        t: run.span(),
        diverged: run.diverged(),
        thinned: run.thinned(),
        buckets: buckets(&panels),
        happenings: options.happenings(run),
    };
    four(&view, &panels, options, &legend(joints, options, &view.happenings))
}

/// What bounds the errors of all links and of all motors: the bounds of the joints that have the largest.
fn bounds(options: &FigureOptions) -> Vec<Falling> {
    bounds_of(options, |errors| Some(largest(errors)))
}

/// The bounds of errors of links and of motors, each the one that `of` chooses from those of the joints: what is proved, and what the
/// errors came down to.
pub(crate) fn bounds_of(options: &FigureOptions, of: impl Fn(&[f64]) -> Option<f64>) -> Vec<Falling> {
    let lines = |errors: [&Vec<f64>; 2], from, rate, strokes: [Stroke; 2]| {
        let chosen = errors.map(|errors| of(errors).filter(|&bound| bound > 0.0));
        let line =
            |(start, stroke): (Option<f64>, Stroke)| Some(Falling { start: start?, from, rate, stroke });
        chosen.into_iter().zip(strokes).filter_map(line).collect::<Vec<_>>()
    };
    let proved =
        options.decay.as_ref().map(|decay| lines([&decay.links, &decay.motors], 0.0, decay.rate, BOUNDS));
    let measured = options
        .ultimate
        .as_ref()
        .map(|ultimate| lines([&ultimate.links, &ultimate.motors], ultimate.from, 0.0, LEVELS));
    [proved, measured].into_iter().flatten().flatten().collect()
}

/// Bounds in the legend: none of a run of which nothing is proved, and that has no imperfections.
pub(crate) fn legend_of_bounds(options: &FigureOptions) -> Vec<(String, Stroke)> {
    let proved = options.decay.as_ref().map(|decay| {
        let rate = significant(decay.rate, 3);
        let hold = if options.held { " (here torques are held)" } else { "" };
        [
            (format!("proved bound of eₗ in continuous time{hold}, shrinking at {rate} 1/s"), BOUNDS[0]),
            ("the same of eₘ".to_owned(), BOUNDS[1]),
        ]
    });
    let measured = options.ultimate.iter().flat_map(|ultimate| {
        let from = short(ultimate.from, 4);
        let sides = [("eₗ", &ultimate.links), ("eₘ", &ultimate.motors)].into_iter().zip(LEVELS);
        sides.filter(|((_, errors), _)| !errors.is_empty()).map(move |((name, errors), stroke)| {
            let (error, prefix) = small(largest(errors));
            (format!("largest {name} from {from} s on: {error} {}", options.angles(prefix)), stroke)
        })
    });
    proved.into_iter().flatten().chain(measured).collect()
}

fn largest(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(0.0, f64::max)
}

/// Four panels on one page, with a title and one legend.
pub(crate) fn four(
    view: &View,
    panels: &[Panel; 4],
    options: &FigureOptions,
    legend: &[(String, Stroke)],
) -> Scene {
    let (mut scene, top) = page(WIDTH, &options.title, &options.subtitle);
    let top = top + line_legend(&mut scene, top, legend);
    scene.height = top + 2.0 * HEIGHT + 8.0;
    let width = (WIDTH - MARGIN) / 2.0;
    for (index, panel) in panels.iter().enumerate() {
        let (row, column) = (index / 2, index % 2);
        let corner = [MARGIN / 2.0 + column as f64 * width, top + row as f64 * HEIGHT];
        panel.draw(&mut scene, corner, width, view);
    }
    scene
}

pub(crate) fn over(mut below: Vec<Curve>, above: Vec<Curve>) -> Vec<Curve> {
    below.extend(above);
    below
}

/// Runs of samples that are drawn as two points each.
pub(crate) fn buckets(panels: &[Panel]) -> usize {
    panel::buckets(panels.iter().map(|panel| panel.curves.len()).sum())
}

/// Hue names the joint, line style the side: one legend serves all panels.
fn legend(joints: usize, options: &FigureOptions, happenings: &[Happening]) -> Vec<(String, Stroke)> {
    let joint = |joint| (options.joint(joint).name, Stroke::swatch(joint, joints));
    let side = |name: &str, stroke: Stroke| (name.to_owned(), Stroke { color: INK, ..stroke });
    let sides = [
        side("link side", Stroke::link(0, 1)),
        side("motor side", Stroke::motor(0, 1)),
        side("reference", Stroke::reference()),
    ];
    (0..joints)
        .map(joint)
        .chain(sides)
        .chain(legend_of_bounds(options))
        .chain(marks::legend(happenings))
        .collect()
}
