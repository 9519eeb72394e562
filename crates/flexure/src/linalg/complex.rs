//! Complex numbers, as far as eigenvalues need them.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// re + i im.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Complex {
    /// 0.
    pub const ZERO: Self = Self { re: 0.0, im: 0.0 };

    /// A real number.
    pub const fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    /// Modulus.
    pub fn abs(self) -> f64 {
        self.re.hypot(self.im)
    }

    /// Complex conjugate.
    pub fn conjugate(self) -> Self {
        Self { im: -self.im, ..self }
    }

    /// `self` times a real number.
    pub fn scaled(self, factor: f64) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }

    /// The root with a real part ≥ 0.
    pub fn sqrt(self) -> Self {
        let r = self.abs();
        let im = (0.5 * (r - self.re)).max(0.0).sqrt();
        Self { re: (0.5 * (r + self.re)).max(0.0).sqrt(), im: if self.im < 0.0 { -im } else { im } }
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self { re: self.re + rhs.re, im: self.im + rhs.im }
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self { re: self.re - rhs.re, im: self.im - rhs.im }
    }
}

impl Neg for Complex {
    type Output = Self;
    fn neg(self) -> Self {
        Self { re: -self.re, im: -self.im }
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, rhs: Self) -> Self {
        Self { re: self.re * rhs.re - self.im * rhs.im, im: self.re * rhs.im + self.im * rhs.re }
    }
}

/// By the larger part of the divisor first: nothing overflows that need not.
impl Div for Complex {
    type Output = Self;
    fn div(self, rhs: Self) -> Self {
        let scale = rhs.re.abs().max(rhs.im.abs());
        let (re, im) = (rhs.re / scale, rhs.im / scale);
        let square = re * re + im * im;
        let numerator = self * Self { re, im: -im };
        numerator.scaled(1.0 / (square * scale))
    }
}
