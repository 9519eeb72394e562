//! How each joint answers a torque of its motor, over frequency: the picture that drive engineers draw.

use std::f64::consts::TAU;

use crate::files::number::{short, significant};
use crate::report::draw::axes::{Axes, Axis};
use crate::report::draw::curve::Curve;
use crate::report::draw::range::{Range, decades};
use crate::report::draw::scene::{Anchor, Scene};
use crate::report::draw::sheet::{MARGIN, line_legend, page};
use crate::report::draw::style::{INK, MUTED, Stroke, bold, hue, letters};
use crate::report::draw::ticks;
use crate::robot::JointRow;

const WIDTH: f64 = 1200.0;
const ROW: f64 = 250.0;
const FRAME: f64 = 158.0;
const LEFT: f64 = 84.0;
const RIGHT: f64 = 16.0;
/// Frequencies of a curve.
const POINTS: usize = 600;
/// How far a figure goes beyond the slowest and the fastest of a joint's own frequencies.
const BEYOND: f64 = 20.0;

const LINK: Stroke = Stroke { color: INK, width: 2.2, dash: &[] };
const MOTOR: Stroke = Stroke { color: INK, width: 1.7, dash: &[7.0, 4.0] };
const LOCKED: Stroke = Stroke { color: INK, width: 1.5, dash: &[1.5, 2.5] };
const MARK: Stroke = Stroke { color: MUTED, width: 1.0, dash: &[1.5, 3.0] };

/// A joint as two inertias with a spring between them, dampers to the base on both: the others held at q = 0.
#[derive(Clone, Copy)]
struct Joint {
    stiffness: f64,
    motor_inertia: f64,
    link_inertia: f64,
    motor_damping: f64,
    link_damping: f64,
}

/// A complex number.
type Complex = [f64; 2];

/// Magnitude and phase of both positions over the torque of the motor, free, and of the motor with the link locked, a row a joint. Gravity is
/// left out, and so is what couples joints.
pub fn response_figure(robot: &str, joints: &[JointRow]) -> Scene {
    let subtitle = "position over motor torque, with the other joints held at q = 0, without gravity; dotted lines: where the motor stands still \
                    while its link swings (antiresonance), and where both swing against each other (resonance)";
    let (mut scene, top) = page(WIDTH, &format!("{robot}: frequency response of the joints"), subtitle);
    let legend = [("link, free", LINK), ("motor, free", MOTOR), ("motor, link locked", LOCKED)];
    let top = top + line_legend(&mut scene, top, &legend.map(|(name, stroke)| (name.to_owned(), stroke)));
    scene.height = top + ROW * joints.len() as f64 + 4.0;
    for (i, row) in joints.iter().enumerate() {
        draw(&mut scene, top + ROW * i as f64, i, row);
    }
    scene
}

fn draw(scene: &mut Scene, top: f64, index: usize, row: &JointRow) {
    let joint = Joint {
        stiffness: row.stiffness,
        motor_inertia: row.motor_inertia,
        link_inertia: row.link_inertia,
        motor_damping: row.motor_damping,
        link_damping: row.link_damping,
    };
    let own = [joint.antiresonance(), joint.locked_resonance(), row.resonance];
    let (slowest, fastest) = (own[0].min(own[1]), own[2]);
    let x = Range { low: (slowest / BEYOND).log10(), high: (fastest * BEYOND).log10() };
    let [antiresonance, locked, resonance] = own.map(|f| significant(f, 3));
    let words = format!(
        "antiresonance {antiresonance} Hz, resonance {resonance} Hz, with the link locked {locked} Hz"
    );
    scene.text([0.5 * MARGIN + LEFT, top + 20.0], &row.name, bold(15.0, INK), Anchor::Start);
    let after = crate::report::draw::text::width(&row.name, bold(15.0, INK)) + 14.0;
    scene.text([0.5 * MARGIN + LEFT + after, top + 20.0], &words, letters(13.0, MUTED), Anchor::Start);

    let answers: [(Stroke, &dyn Fn(f64) -> Complex); 3] =
        [(LOCKED, &|f| joint.motor_locked(f)), (MOTOR, &|f| joint.free(f)[1]), (LINK, &|f| joint.free(f)[0])];
    let curve = |of: &dyn Fn(Complex) -> f64| {
        answers.each_ref().map(|(stroke, answer)| {
            let at = |k: usize| x.low + x.span() * k as f64 / (POINTS - 1) as f64;
            let t: Vec<f64> = (0..POINTS).map(at).collect();
            let values = t.iter().map(|exponent| of(answer(10f64.powf(*exponent)))).collect();
            Curve { t, values, stroke: Stroke { color: hue(index), ..*stroke } }
        })
    };
    let magnitudes = curve(&|[re, im]| re.hypot(im).log10());
    let phases = curve(&|[re, im]| {
        let degrees = im.atan2(re).to_degrees();
        // All of them lag: from 0 to −360°.
        if degrees > 1e-9 { degrees - 360.0 } else { degrees }
    });
    let half = 0.5 * (WIDTH - MARGIN);
    let place =
        |side: usize| [0.5 * MARGIN + half * side as f64 + LEFT, top + 32.0, half - LEFT - RIGHT, FRAME];
    let angle = if row.kind == "prismatic" { "m/N" } else { "rad/(N m)" };
    let label = format!("|position / torque| [{angle}]");
    let range = decades(&magnitudes);
    let numbers = ticks::decades(range).into_iter().step_by(if range.span() > 5.0 { 2 } else { 1 }).collect();
    let magnitude = Axis { range, ticks: numbers, label: &label };
    let range = Range { low: -380.0, high: 20.0 };
    let degrees = [-360.0, -270.0, -180.0, -90.0, 0.0].map(|at: f64| ticks::Tick { at, name: short(at, 3) });
    let phase = Axis { range, ticks: degrees.into_iter().collect(), label: "phase [°]" };
    for (side, (y, curves)) in [(magnitude, magnitudes), (phase, phases)].into_iter().enumerate() {
        let axes = Axes {
            frame: place(side),
            left: LEFT,
            x: Axis { range: x, ticks: ticks::logarithmic(x, 8.0), label: "frequency [Hz]" },
            y,
        };
        axes.draw(scene);
        for frequency in [own[0], own[2]] {
            axes.mark(scene, frequency.log10(), MARK);
        }
        for curve in &curves {
            axes.curve(scene, curve, POINTS);
        }
    }
}

impl Joint {
    /// Where the link swings on its spring while the motor stands still, in Hz.
    fn antiresonance(&self) -> f64 {
        (self.stiffness / self.link_inertia).sqrt() / TAU
    }

    /// Where the motor swings on the spring with the link locked, in Hz.
    fn locked_resonance(&self) -> f64 {
        (self.stiffness / self.motor_inertia).sqrt() / TAU
    }

    /// M s² + D s + K of the two sides at a frequency in Hz.
    fn sides(&self, frequency: f64) -> [Complex; 2] {
        let omega = TAU * frequency;
        let side = |inertia: f64, damping: f64| [self.stiffness - inertia * omega * omega, damping * omega];
        [side(self.link_inertia, self.link_damping), side(self.motor_inertia, self.motor_damping)]
    }

    /// Positions of link and motor over the torque of the motor: K / Δ and (M_l s² + D_l s + K) / Δ.
    fn free(&self, frequency: f64) -> [Complex; 2] {
        let [link, motor] = self.sides(frequency);
        let [re, im] = times(link, motor);
        let determinant = [re - self.stiffness * self.stiffness, im];
        [over([self.stiffness, 0.0], determinant), over(link, determinant)]
    }

    fn motor_locked(&self, frequency: f64) -> Complex {
        over([1.0, 0.0], self.sides(frequency)[1])
    }
}

fn times([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

fn over(a: Complex, [c, d]: Complex) -> Complex {
    let square = c * c + d * d;
    times(a, [c / square, -d / square])
}

#[cfg(test)]
mod tests {
    use super::{Joint, TAU};

    const JOINT: Joint = Joint {
        stiffness: 400.0,
        motor_inertia: 0.5,
        link_inertia: 2.0,
        motor_damping: 0.0,
        link_damping: 0.0,
    };

    #[test]
    fn limits_are_those_of_rigid_bodies_and_springs() {
        let magnitude = |[re, im]: [f64; 2]| re.hypot(im);
        let slow: f64 = 1e-3;
        // As one body of both inertias; as a spring; as a motor alone.
        for position in JOINT.free(slow) {
            assert!((magnitude(position) * 2.5 * (TAU * slow).powi(2) - 1.0).abs() < 1e-4);
        }
        assert!((magnitude(JOINT.motor_locked(slow)) * 400.0 - 1.0).abs() < 1e-4);
        let fast: f64 = 1e4;
        assert!((magnitude(JOINT.free(fast)[1]) * 0.5 * (TAU * fast).powi(2) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn the_motor_stands_still_at_the_antiresonance() {
        let [link, motor] = JOINT.free(JOINT.antiresonance());
        assert!(motor[0].abs() < 1e-12 * link[0].abs(), "{motor:?} {link:?}");
        // There the link's spring takes the whole torque.
        assert!((link[0] + 1.0 / 400.0).abs() < 1e-12, "{link:?}");
        assert!((JOINT.locked_resonance() - 800f64.sqrt() / TAU).abs() < 1e-12);
    }

    /// With dampers: the equations of motion hold for what is drawn.
    #[test]
    fn positions_solve_the_equations_of_motion() {
        let joint = Joint { motor_damping: 3.0, link_damping: 0.7, ..JOINT };
        for frequency in [0.3, 2.0, 4.9, 30.0] {
            let [link, motor] = joint.free(frequency);
            let s = TAU * frequency;
            let side = |[re, im]: [f64; 2], inertia: f64, damping: f64| {
                [-inertia * s * s * re - damping * s * im, -inertia * s * s * im + damping * s * re]
            };
            let spring = [400.0 * (motor[0] - link[0]), 400.0 * (motor[1] - link[1])];
            let (of_link, of_motor) = (side(link, 2.0, 0.7), side(motor, 0.5, 3.0));
            for k in 0..2 {
                let torque = if k == 0 { 1.0 } else { 0.0 };
                assert!((of_link[k] - spring[k]).abs() < 1e-12, "{frequency} Hz");
                assert!((of_motor[k] + spring[k] - torque).abs() < 1e-12, "{frequency} Hz");
            }
        }
    }
}
