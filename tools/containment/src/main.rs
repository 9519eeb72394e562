//! Is the exact value inside? Every interval operation against MPFR, which rounds down and up as it is told.
//!
//!     cargo run --release --manifest-path tools/containment/Cargo.toml [DRAWS [SEED]]
//!
//! wants libmpfr-dev. Draws are those of `flexure-core/tests/suite/numbers/containment.rs`: intervals, half of them points,
//! of ordinary and of extreme magnitudes, and a number inside, half the time at an end. For each the two floats next to
//! the exact value must both be inside. Exit code 1 where one is not.

use std::ffi::{CStr, c_char};
use std::process::ExitCode;

use flexure_core::scalar::{Interval, Scalar};

unsafe extern "C" {
    fn exact(operation: u32, x: f64, y: f64, below: *mut f64, above: *mut f64);
    fn version() -> *const c_char;
}

/// In the order of src/exact.c: name, the interval operation, and the powers of two that arguments lie between.
type Operation = (&'static str, fn(Interval, Interval) -> Interval, i32, i32);

const ALL: (i32, i32) = (-1022, 1023);

const OPERATIONS: [Operation; 14] = [
    ("square", |x, _| x.square(), ALL.0, ALL.1),
    ("1/x", |x, _| x.recip(), ALL.0, ALL.1),
    ("sqrt", |x, _| x.sqrt(), ALL.0, ALL.1),
    ("exp", |x, _| x.exp(), ALL.0, 11),
    ("ln", |x, _| x.ln(), ALL.0, ALL.1),
    ("sin", |x, _| x.sin(), ALL.0, 30),
    ("cos", |x, _| x.cos(), ALL.0, 30),
    ("tanh", |x, _| x.tanh(), ALL.0, 40),
    ("atan", |x, _| x.atan(), ALL.0, ALL.1),
    ("ln cosh", |x, _| x.ln_cosh(), ALL.0, ALL.1),
    ("x + y", |x, y| x + y, ALL.0, ALL.1),
    ("x - y", |x, y| x - y, ALL.0, ALL.1),
    ("x y", |x, y| x * y, ALL.0, ALL.1),
    ("x / y", |x, y| x / y, ALL.0, ALL.1),
];

const LN_COSH: usize = 9;

/// The floats next to the exact value, from below and from above; the same where it is one.
fn floats_around(operation: usize, x: f64, y: f64) -> (f64, f64) {
    let (mut below, mut above) = (0.0, 0.0);
    let number = u32::try_from(operation).expect("few");
    // SAFETY: the function reads two numbers and writes two; nothing else runs beside it.
    unsafe { exact(number, x, y, &raw mut below, &raw mut above) };
    (below, above)
}

/// Sebastiano Vigna's splitmix64.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn uniform(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * ((self.bits() >> 11) as f64 * f64::EPSILON / 2.0)
    }

    /// Either sign, log-uniform between powers of two.
    fn magnitude(&mut self, low: i32, high: i32) -> f64 {
        let sign = if self.bits() & 1 == 0 { 1.0 } else { -1.0 };
        sign * self.uniform(1.0, 2.0) * self.uniform(f64::from(low), f64::from(high)).floor().exp2()
    }

    /// An interval, a point every other time, and a number inside, at an end every other time.
    fn draw(&mut self, low: i32, high: i32) -> (Interval, f64) {
        let a = self.magnitude(low, high);
        let b = match self.bits() % 4 {
            0 => self.magnitude(low, high),
            1 => a * (1.0 + 1e-3 * self.uniform(0.0, 1.0)),
            _ => a,
        };
        let x = match self.bits() % 4 {
            0 => self.uniform(a, b).clamp(a.min(b), a.max(b)),
            1 => b,
            _ => a,
        };
        (Interval::new(a.min(b), a.max(b)).expect("numbers"), x)
    }
}

/// How many floats apart.
fn steps(a: f64, b: f64) -> u64 {
    let ordered = |x: f64| {
        if x.is_sign_positive() { x.to_bits().cast_signed() } else { -(x.abs().to_bits().cast_signed()) }
    };
    ordered(a).abs_diff(ordered(b))
}

#[derive(Default)]
struct Count {
    draws: u64,
    /// Exact values outside.
    misses: u64,
    points: u64,
    /// Of points: as narrow as intervals of floats can be.
    tightest: u64,
    /// Of points: most floats between the bounds and the exact value, both sides together.
    widest: u64,
}

fn sweep(operation: usize, draws: u64, seed: u64) -> Count {
    let (name, apply, least, most) = OPERATIONS[operation];
    let mut random = Random(seed.wrapping_mul(0x2545_f491_4f6c_dd1d).wrapping_add(operation as u64));
    let mut count = Count::default();
    let mut turn = 0;
    while count.draws < draws {
        let (low, high) = [(-4, 5), (-40, 40), (-1022, 1023)][turn % 3];
        turn += 1;
        let (low, high) = (low.max(least), high.min(most));
        let ((xs, x), (ys, y)) = (random.draw(low, high), random.draw(low, high));
        let (below, above) = floats_around(operation, if operation == LN_COSH { x.abs() } else { x }, y);
        // Roots and logarithms of what has none.
        if below.is_nan() || above.is_nan() {
            continue;
        }
        count.draws += 1;
        let bounds = apply(xs, ys);
        if !(bounds.lo() <= below && above <= bounds.hi()) {
            count.misses += 1;
            eprintln!("{name} of {x:e}, {y:e}: [{below:e}, {above:e}] is not in {bounds:?}");
        }
        let binary = operation > LN_COSH;
        if xs.lo() == xs.hi()
            && (!binary || ys.lo() == ys.hi())
            && bounds.lo().is_finite()
            && bounds.hi().is_finite()
        {
            let excess = steps(bounds.lo(), below) + steps(above, bounds.hi());
            count.points += 1;
            count.tightest += u64::from(excess == 0);
            count.widest = count.widest.max(excess);
        }
    }
    count
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1).map(|argument| argument.parse().expect("a whole number"));
    let (draws, seed) = (arguments.next().unwrap_or(10_000_000), arguments.next().unwrap_or(0));
    // SAFETY: MPFR's own constant text.
    let version = unsafe { CStr::from_ptr(version()) }.to_string_lossy();
    println!("MPFR {version}, {draws} draws an operation, seed {seed}\n");
    println!("| operation | draws | misses | points | of which tightest, % | widest: floats too many |");
    println!("| --- | --- | --- | --- | --- | --- |");
    let mut misses = 0;
    for (operation, (name, ..)) in OPERATIONS.iter().enumerate() {
        let Count { draws, misses: missed, points, tightest, widest } = sweep(operation, draws, seed);
        let share = 100.0 * tightest as f64 / points as f64;
        println!("| {name} | {draws} | {missed} | {points} | {share:.2} | {widest} |");
        misses += missed;
    }
    if misses == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
