//! Phases that keep the peaks of a joint low, and what a joint does over a period.

use std::f64::consts::{PI, TAU};

use crate::imperfections::stages::Random;
use crate::linalg::Complex;

/// Instants of a period at which peaks are looked for.
const INSTANTS: usize = 4096;

/// A line with its magnitudes: harmonic number, amplitude of the link \[rad\], and shares of four limits per rad.
#[derive(Clone, Debug)]
pub(super) struct Harmonic {
    pub number: usize,
    pub amplitude: f64,
    pub shares: [Complex; 4],
}

fn unit(angle: f64) -> Complex {
    Complex { re: angle.cos(), im: angle.sin() }
}

/// Σ over lines of the imaginary part of `phasor` e^{iωt}, at every instant of a period: sines.
fn course(lines: &[Harmonic], phasor: impl Fn(usize, &Harmonic) -> Complex) -> Vec<f64> {
    let mut sum = vec![0.0; INSTANTS];
    for (k, line) in lines.iter().enumerate() {
        let phasor = phasor(k, line);
        let turn = unit(TAU * line.number as f64 / INSTANTS as f64);
        let mut now = phasor;
        for value in &mut sum {
            *value += now.im;
            now = now * turn;
        }
    }
    sum
}

/// The largest share of any limit over a period.
pub(super) fn peak(lines: &[Harmonic], phases: &[f64]) -> f64 {
    (0..4).fold(0.0, |peak: f64, limit| {
        let course = course(lines, |k, line| line.shares[limit].scaled(line.amplitude) * unit(phases[k]));
        course.iter().fold(peak, |peak, share| peak.max(share.abs()))
    })
}

/// Phases of the lowest peak: Schroeder's (*IEEE Transactions on Information Theory* 16, 1970), or the best of `budget` sets with
/// them. Random sets are those of `seed` and `joint`.
pub(super) fn phases(lines: &[Harmonic], budget: usize, seed: u64, joint: u64) -> Vec<f64> {
    let power: f64 = lines.iter().map(|line| line.amplitude * line.amplitude).sum();
    let (mut before, mut slope) = (0.0, 0.0);
    let schroeder = lines.iter().map(|line| {
        let phase = before;
        slope += TAU * line.amplitude * line.amplitude / power;
        before -= slope;
        phase
    });
    let mut best: Vec<f64> = schroeder.collect();
    let mut lowest = peak(lines, &best);
    let mut random = Random::new(seed, "excite", joint);
    for _ in 1..budget {
        let tried: Vec<f64> = lines.iter().map(|_| PI * (2.0 * random.uniform() - 1.0)).collect();
        let found = peak(lines, &tried);
        if found < lowest {
            (best, lowest) = (tried, found);
        }
    }
    best.iter().map(|phase| phase.sin().atan2(phase.cos())).collect()
}

/// Each line of the sign of the motor's speed: `motor` is its position per rad of the link.
pub(super) fn signs(lines: &[Harmonic], phases: &[f64], motor: &[Complex]) -> Vec<Complex> {
    let speed = course(lines, |k, line| {
        let rate = Complex { re: 0.0, im: line.number as f64 };
        motor[k] * rate.scaled(line.amplitude) * unit(phases[k])
    });
    let line = |line: &Harmonic| {
        let turn = unit(-TAU * line.number as f64 / INSTANTS as f64);
        let mut now = Complex { re: 0.0, im: 2.0 / INSTANTS as f64 };
        let mut sum = Complex::ZERO;
        for speed in &speed {
            let sign = if *speed == 0.0 { 0.0 } else { speed.signum() };
            sum = sum + now.scaled(sign);
            now = now * turn;
        }
        sum
    };
    lines.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::{Harmonic, peak, phases, signs};
    use crate::linalg::Complex;

    fn lines(count: usize) -> Vec<Harmonic> {
        let unit = Complex::real(1.0);
        (1..=count).map(|number| Harmonic { number, amplitude: 1.0, shares: [unit; 4] }).collect()
    }

    /// All in phase, 16 sines of equal size peak near 14; Schroeder's phases and a search stay near √(2·16).
    #[test]
    fn peaks_are_low() {
        let lines = lines(16);
        let aligned = peak(&lines, &[0.0; 16]);
        let schroeder = peak(&lines, &phases(&lines, 1, 0, 0));
        let searched = peak(&lines, &phases(&lines, 300, 7, 0));
        assert!(
            aligned > 11.0 && schroeder < 7.0 && searched <= schroeder,
            "{aligned} {schroeder} {searched}"
        );
        assert_eq!(phases(&lines, 300, 7, 0), phases(&lines, 300, 7, 0));
    }

    /// The sign of a cosine has the line 4/π, in its phase.
    #[test]
    fn square_waves() {
        let lines = lines(1);
        for phase in [0.0, 0.7] {
            // The position sin(t + phase) has the speed cos: a quarter of a turn ahead.
            let line = signs(&lines, &[phase], &[Complex::real(1.0)])[0];
            let expected = [(phase + 0.5 * PI).cos(), (phase + 0.5 * PI).sin()].map(|part| 4.0 / PI * part);
            assert!((line.re - expected[0]).hypot(line.im - expected[1]) < 2e-3, "{line:?} {expected:?}");
        }
    }
}
