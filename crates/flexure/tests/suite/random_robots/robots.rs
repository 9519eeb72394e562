//! Robots and gains at random, as files: one to seven joints, chains and trees, joints that slide, payloads, bodies of next to
//! no inertia, gains over eight decades.

use std::fmt::Write as _;
use std::path::Path;

use flexure::scenario::{Scenario, scenario_from_text};

use crate::common::Random;

/// What a robot is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Style {
    Chain,
    Tree,
    Planar,
    /// Axes and turns along the coordinate axes, as in many arms.
    Upright,
    /// The same with 30 kg on the last joint.
    Payload,
    Sliding,
    /// Inertias of 1e-10 to 1e-7 kg m².
    Tiny,
}

const STYLES: [Style; 7] =
    [Style::Chain, Style::Tree, Style::Planar, Style::Upright, Style::Payload, Style::Sliding, Style::Tiny];

/// Powers of ten that are as likely as each other.
fn decades(noise: &mut Random, low: f64, high: f64) -> f64 {
    10_f64.powf(0.5 * (low + high) + 0.5 * (high - low) * noise.next())
}

fn vector(noise: &mut Random, size: f64) -> [f64; 3] {
    [(); 3].map(|()| size * noise.next())
}

fn unit(noise: &mut Random) -> [f64; 3] {
    let v = vector(noise, 1.0);
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length < 0.1 { [0.0, 0.0, 1.0] } else { v.map(|x| x / length) }
}

/// One of the six directions of the coordinate axes.
fn upright(noise: &mut Random) -> [f64; 3] {
    let mut axis = [0.0; 3];
    axis[noise.below(3)] = if noise.next() < 0.0 { 1.0 } else { -1.0 };
    axis
}

/// xx, xy, xz, yy, yz, zz of matter somewhere, of this size: tr(S) 1 − S with S = A Aᵀ.
fn inertia(noise: &mut Random, size: f64) -> [f64; 6] {
    let a = [vector(noise, 1.0), vector(noise, 1.0), vector(noise, 1.0)];
    let s = |i: usize, j: usize| size * (0..3).map(|k| a[i][k] * a[j][k]).sum::<f64>();
    let trace = s(0, 0) + s(1, 1) + s(2, 2);
    [trace - s(0, 0), -s(0, 1), -s(0, 2), trace - s(1, 1), -s(1, 2), trace - s(2, 2)]
}

fn list(numbers: impl IntoIterator<Item = f64>) -> String {
    let numbers: Vec<_> = numbers.into_iter().map(|x| format!("{x:?}")).collect();
    format!("[{}]", numbers.join(", "))
}

/// A scenario at random, by number: the same for the same number.
pub fn scenario(number: u64) -> (Style, Scenario) {
    of(number, None, false)
}

/// The same with the shaping function `phi`, and with a link metric that hardens if asked for.
pub fn scenario_under(number: u64, phi: &str, hardens: bool) -> (Style, Scenario) {
    of(number, Some(phi), hardens)
}

fn of(number: u64, phi: Option<&str>, hardens: bool) -> (Style, Scenario) {
    let mut noise = Random(1000 + number);
    let (n, style) = (1 + noise.below(7), STYLES[noise.below(STYLES.len())]);
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("robot.toml"), robot(&mut noise, n, style)).unwrap();
    let text = law(&mut noise, n, phi, hardens);
    let scenario = scenario_from_text("scenario.toml", &text, Path::new(folder.path()));
    (style, scenario.unwrap_or_else(|problems| panic!("{number}, {style:?}: {problems}\n{text}")))
}

fn robot(noise: &mut Random, n: usize, style: Style) -> String {
    let mut text = "name = 'random'\ngravity = [0.0, 0.0, -9.81]\n[links]\nkind = 'tree'\n".to_owned();
    let (mut lower, mut upper) = (Vec::new(), Vec::new());
    for i in 0..n {
        let slides = style == Style::Sliding && noise.next() < 0.0;
        let length = decades(noise, -1.3, 0.0);
        let planar = style == Style::Planar;
        let straight = matches!(style, Style::Upright | Style::Payload);
        let quarter = std::f64::consts::FRAC_PI_2;
        let (axis, xyz, rpy) = match style {
            Style::Planar => ([0.0, 0.0, 1.0], [length, 0.0, 0.0], [0.0; 3]),
            _ if straight => {
                let turn = [(); 3].map(|()| [0.0, quarter, -quarter][noise.below(3)]);
                (upright(noise), vector(noise, 0.6 * length), turn)
            }
            _ => (unit(noise), vector(noise, 0.6 * length), vector(noise, 3.0)),
        };
        let tiny = style == Style::Tiny;
        let size = if tiny { decades(noise, -10.0, -7.0) } else { decades(noise, -4.0, -1.0) };
        let mass = match style {
            Style::Payload if i + 1 == n => 30.0,
            Style::Tiny => decades(noise, -4.0, -1.0),
            _ => decades(noise, -1.0, 1.2),
        };
        let com = match noise.below(10) {
            0 => [0.0; 3],
            _ if planar => [0.5 * length, 0.05 * noise.next(), 0.02],
            _ => vector(noise, 0.5 * length),
        };
        let kind = if slides { "prismatic" } else { "revolute" };
        writeln!(text, "[[links.joint]]\nname = 'j{i}'\nkind = '{kind}'").unwrap();
        writeln!(text, "axis = {}\nxyz = {}\nrpy = {}", list(axis), list(xyz), list(rpy)).unwrap();
        writeln!(text, "mass = {mass:?}\ncom = {}\ninertia = {}", list(com), list(inertia(noise, size)))
            .unwrap();
        let parent = match style {
            _ if i == 0 => None,
            Style::Tree if noise.below(7) == 0 => None,
            Style::Tree => Some(noise.below(i)),
            _ => Some(i - 1),
        };
        if let Some(parent) = parent {
            writeln!(text, "parent = 'j{parent}'").unwrap();
        }
        let low = -0.5 * noise.next().abs();
        lower.push(if slides { low } else { -3.0 });
        upper.push(if slides { low + noise.next().abs() } else { 3.0 });
    }
    let mut numbers = |low, high| list((0..n).map(|_| decades(noise, low, high)));
    writeln!(text, "[joints]\nstiffness = {}\nmotor_inertia = {}", numbers(1.0, 4.3), numbers(-3.0, 0.0))
        .unwrap();
    writeln!(text, "link_damping = {}\nmotor_damping = 0.0", numbers(-3.0, 1.0)).unwrap();
    writeln!(text, "position_lower = {}\nposition_upper = {}", list(lower), list(upper)).unwrap();
    text
}

fn law(noise: &mut Random, n: usize, phi: Option<&str>, hardens: bool) -> String {
    let drawn = ["tanh", "linear", "coupled-tanh"][noise.below(3)];
    let phi = phi.unwrap_or(drawn);
    let mut text = format!(
        "robot = 'robot.toml'\nduration = 1.0\ncontrol_period = 0.001\n\
         [initial]\nq_l = 0.0\nq_m = 0.0\n\
         [reference]\nkind = 'sine'\namplitude = 0.1\nfrequency = 1.0\n\
         [controller]\nkind = 'vcbc'\nphi = '{phi}'\n"
    );
    for side in ["link", "motor"] {
        let mut gains = |middle: f64| list((0..n).map(|_| decades(noise, middle - 4.0, middle + 4.0)));
        let (metric, shaping, damping, kappa) = (gains(2.0), gains(1.0), gains(1.0), gains(1.0));
        // With a metric of its own, the coupling of joints is often too strong: refuted, and no certificate to look at.
        let shaping = if phi == "coupled-tanh" && noise.below(8) > 0 { &metric } else { &shaping };
        writeln!(text, "[controller.{side}]\nmetric = {metric}\nshaping = {shaping}\ndamping = {damping}")
            .unwrap();
        if hardens && side == "link" {
            let hardening = list((0..n).map(|_| decades(noise, -2.0, 6.0)));
            writeln!(text, "metric_hardening = {hardening}").unwrap();
        }
        if phi == "coupled-tanh" {
            writeln!(text, "kappa = {kappa}").unwrap();
        }
    }
    text
}
