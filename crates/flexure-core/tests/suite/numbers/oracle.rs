//! What the tests compare with: tables from tools/number_oracle.py, random numbers, distances in ulp.

use flexure_core::scalar::Scalar;

/// The elementary functions by name, for tables.
pub fn apply<S: Scalar>(name: &str, x: S) -> S {
    match name {
        "sqrt" => x.sqrt(),
        "exp" => x.exp(),
        "ln" => x.ln(),
        "sin" => x.sin(),
        "cos" => x.cos(),
        "tanh" => x.tanh(),
        "ln_cosh" => x.ln_cosh(),
        "atan" => x.atan(),
        "recip" => x.recip(),
        _ => panic!("the table holds an unknown function {name}"),
    }
}

/// A line of a table: function, argument, values.
pub struct Row<const N: usize> {
    pub name: &'static str,
    pub x: f64,
    pub values: [f64; N],
}

/// The lines of a table.
pub fn rows<const N: usize>(table: &'static str) -> impl Iterator<Item = Row<N>> {
    table.lines().map(|line| {
        let (name, numbers) = line.split_once(',').unwrap();
        let mut numbers = numbers.split(',').map(|number| number.parse().unwrap());
        Row { name, x: numbers.next().unwrap(), values: std::array::from_fn(|_| numbers.next().unwrap()) }
    })
}

/// Values and derivatives of order 1 to 6 at 50 digits.
pub const DERIVATIVES: &str = include_str!("../../data/elementary.csv");
/// The floats on either side of exact values.
#[cfg(feature = "interval")]
pub const ENCLOSURES: &str = include_str!("../../data/enclosures.csv");

/// Sebastiano Vigna's splitmix64: every test has its own seed and is repeatable.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * f64::EPSILON / 2.0
    }

    pub fn uniform(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// An integer in `−bound..=bound`.
    pub fn integer(&mut self, bound: i32) -> f64 {
        let bound = f64::from(bound);
        self.uniform(-bound, bound + 1.0).floor()
    }

    pub fn choice<T: Copy, const N: usize>(&mut self, from: [T; N]) -> T {
        from[usize::try_from(self.bits() % N as u64).unwrap()]
    }

    /// Either sign, magnitude log-uniform between powers of two.
    #[cfg(any(feature = "interval", feature = "lanes"))]
    pub fn magnitude(&mut self, low: i32, high: i32) -> f64 {
        let sign = if self.bits() & 1 == 0 { 1.0 } else { -1.0 };
        sign * self.uniform(1.0, 2.0) * self.uniform(f64::from(low), f64::from(high)).floor().exp2()
    }
}

/// How many floats apart.
#[cfg(any(feature = "interval", feature = "lanes"))]
pub fn ulps(a: f64, b: f64) -> u64 {
    let ordered = |x: f64| {
        if x.to_bits() >> 63 == 0 { x.to_bits().cast_signed() } else { -(x.abs().to_bits().cast_signed()) }
    };
    ordered(a).abs_diff(ordered(b))
}
