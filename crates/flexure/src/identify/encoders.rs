//! What encoders add to positions, and what they hide.

use crate::logs::Log;
use crate::logs::smooth::whiteness;

/// Per joint the white noise of the encoders of link and motor, infinite where there is none \[rad\].
pub(crate) fn position_noise(logs: &[Log], n: usize) -> Vec<[f64; 2]> {
    let of = |signal: Option<&Vec<f64>>, i: usize| {
        signal.map_or(f64::INFINITY, |signal| whiteness(signal, n, i).max(1e-9))
    };
    (0..n).map(|i| [of(logs[0].q_l.as_ref(), i), of(logs[0].q_m.as_ref(), i)]).collect()
}

/// Part of what a regression on rounded deflections would be off by that a stiffness may be off by: simulated springs that bend by 0.2 to
/// 0.6 counts were up to an eighth of it off.
const HIDDEN: f64 = 1.0 / 6.0;

/// Per joint the part of the stiffness that encoders of both sides may hide. Where a spring bends by less than a few counts, what is
/// rounded goes with what bends it and is no white noise. A regression on such deflections is off by the mean square of the noise over
/// that of the deflections (Sheppard, *Proc. London Math. Soc.* 29, 1897); predictions, which know what the torques do, by [less](HIDDEN).
/// Zero where links are not seen.
pub(crate) fn hidden(logs: &[Log], noise: &[[f64; 2]]) -> Vec<f64> {
    let bent = |i: usize| {
        let squares = logs.iter().filter_map(|log| {
            let (q_l, q_m) = (log.q_l.as_ref()?, log.q_m.as_ref()?);
            let deflections = q_l.iter().zip(q_m).skip(i).step_by(log.joints).map(|(q_l, q_m)| q_m - q_l);
            Some(deflections.map(|deflection| deflection * deflection).sum::<f64>())
        });
        squares.reduce(|a, b| a + b)
    };
    let samples: usize = logs.iter().map(Log::samples).sum();
    let of = |(i, [link, motor]): (usize, &[f64; 2])| {
        bent(i).map_or(0.0, |bent| {
            HIDDEN * (link * link + motor * motor) * samples as f64 / bent.max(f64::MIN_POSITIVE)
        })
    };
    noise.iter().enumerate().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::{HIDDEN, Log, hidden, position_noise};

    /// Positions that are rounded to counts, behind a spring that bends by a sine of `counts`: their noise is that of rounding,
    /// 1/12 of a squared count, and hides stiffness as the mean squares say.
    #[test]
    fn springs_that_hardly_bend_are_hidden() {
        let count = 5e-5;
        let log = |counts: f64| {
            let rounded = |x: f64| count * (x / count).round();
            let link = |t: f64| 0.05 * (1.7 * t).sin() + 0.02 * (5.3 * t).cos();
            let times = || (0..20_000).map(|k| 1e-3 * f64::from(k));
            let q_l = times().map(|t| rounded(link(t))).collect();
            let q_m = times().map(|t| rounded(link(t) + counts * count * (11.0 * t).sin())).collect();
            let name = "rounded".to_owned();
            Log {
                name,
                period: 1e-3,
                joints: 1,
                q_l: Some(q_l),
                q_m: Some(q_m),
                dq_l: None,
                dq_m: None,
                u_m: vec![0.0; 20_000],
            }
        };
        for counts in [3.0, 30.0] {
            let logs = [log(counts)];
            let noise = position_noise(&logs, 1);
            for side in noise[0] {
                assert!((side / count * 12.0_f64.sqrt() - 1.0).abs() < 0.1, "{side}");
            }
            // The mean square of what is seen: half the amplitude's, and the noise itself.
            let bent = 0.5 * counts * counts + 1.0 / 6.0;
            let part = hidden(&logs, &noise)[0];
            assert!((part / (HIDDEN / 6.0 / bent) - 1.0).abs() < 0.2, "{counts}: {part}");
        }
        let motors = [Log { q_l: None, ..log(0.1) }];
        assert_eq!(hidden(&motors, &position_noise(&motors, 1)), [0.0]);
    }
}
