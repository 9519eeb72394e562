//! SIMD lanes: a batch of numbers in one register.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Over, Piecewise, Scalar, assign_ops, leaf};

/// `W` numbers in one SIMD register: running code on it gives a batch of rollouts.
///
/// `+ − × ÷`, square root and [`Piecewise`] are those of the scalar, bit for bit, in every lane. The elementary functions
/// come from `wide`, within these distances of the correctly rounded value at a million random arguments:
///
/// | | `f64` | ulp | `f32` | ulp |
/// | --- | --- | --- | --- | --- |
/// | `exp` | ±700 | 1 | −87 to 88 | 1 |
/// | `ln` | 1e-300 to 1e300 | 1 | 1e-30 to 1e30 | 1 |
/// | `sin`, `cos` | ±1000 | 2 | ±100 | 2 |
/// | `tanh` | all | 6 | all | 4 |
/// | `ln_cosh` | all | 10 | all | 8 |
/// | `atan` | all | 1 | all | 1 |
///
/// Angles far beyond those lose digits, and a sine or cosine that nearly vanishes is good to an absolute 1e-16 only. The
/// last bits depend on whether the target has fused multiply-add, and `ln` of a subnormal is −∞. A lane never looks at
/// its neighbours.
///
/// ```
/// use flexure_core::scalar::{Lanes, Scalar};
/// let x = Lanes::<f64, 4>::from_array([0.0, 1.0, 4.0, 9.0]);
/// assert_eq!((x.sqrt() + Lanes::ONE).to_array(), [1.0, 2.0, 3.0, 4.0]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Lanes<S: Lane<W>, const W: usize> {
    register: S::Register,
}

/// Numbers that come `W` to a register: `f64` by 2, 4 or 8, `f32` by 4 or 8.
///
/// Sealed: the widths are those of the hardware.
pub trait Lane<const W: usize>: sealed::Simd<W> {}

mod sealed {
    use core::fmt::Debug;
    use core::ops::{Add, Div, Mul, Neg, Sub};

    /// The operations of the register behind `W` numbers.
    pub trait Simd<const W: usize>: super::Piecewise + PartialEq {
        /// The SIMD type.
        type Register: Copy
            + Debug
            + Add<Output = Self::Register>
            + Sub<Output = Self::Register>
            + Mul<Output = Self::Register>
            + Div<Output = Self::Register>
            + Neg<Output = Self::Register>;
        const ZEROS: Self::Register;
        const ONES: Self::Register;
        fn pack(values: [Self; W]) -> Self::Register;
        fn unpack(register: Self::Register) -> [Self; W];
        /// `then` where `x ≥ y`, `otherwise` where `x < y`, NaN where they do not compare.
        fn blend(
            x: Self::Register,
            y: Self::Register,
            then: Self::Register,
            otherwise: Self::Register,
        ) -> Self::Register;
        fn absolute(x: Self::Register) -> Self::Register;
        fn root(x: Self::Register) -> Self::Register;
        fn exponential(x: Self::Register) -> Self::Register;
        fn logarithm(x: Self::Register) -> Self::Register;
        fn sine_cosine(x: Self::Register) -> (Self::Register, Self::Register);
        fn hyperbolic_tangent(x: Self::Register) -> Self::Register;
        fn log_cosh(x: Self::Register) -> Self::Register;
        fn arc_tangent(x: Self::Register) -> Self::Register;
    }
}

macro_rules! lane {
    ($t:ident, $w:literal, $simd:ident) => {
        impl Lane<$w> for $t {}

        impl sealed::Simd<$w> for $t {
            type Register = wide::$simd;
            const ZEROS: wide::$simd = wide::$simd::ZERO;
            const ONES: wide::$simd = wide::$simd::ONE;
            #[inline]
            fn pack(values: [Self; $w]) -> wide::$simd {
                wide::$simd::new(values)
            }
            #[inline]
            fn unpack(register: wide::$simd) -> [Self; $w] {
                register.to_array()
            }
            #[inline]
            fn blend(
                x: wide::$simd,
                y: wide::$simd,
                then: wide::$simd,
                otherwise: wide::$simd,
            ) -> wide::$simd {
                x.simd_ge(y).select(then, x.simd_lt(y).select(otherwise, x + y))
            }
            #[inline]
            fn absolute(x: wide::$simd) -> wide::$simd {
                x.abs()
            }
            #[inline]
            fn root(x: wide::$simd) -> wide::$simd {
                x.sqrt()
            }
            #[inline]
            fn exponential(x: wide::$simd) -> wide::$simd {
                x.exp()
            }
            #[inline]
            fn logarithm(x: wide::$simd) -> wide::$simd {
                x.ln()
            }
            #[inline]
            fn sine_cosine(x: wide::$simd) -> (wide::$simd, wide::$simd) {
                x.sin_cos()
            }
            #[inline]
            fn hyperbolic_tangent(x: wide::$simd) -> wide::$simd {
                x.tanh()
            }
            /// `ln(1 + 2 sinh² (x/2))` where `|x| < 1`, `|x| − ln 2 + ln(1 + e^(−2|x|))` beyond: neither cancels in its
            /// domain, and the other, computed too, is thrown away.
            #[inline]
            fn log_cosh(x: wide::$simd) -> wide::$simd {
                let (one, two) = (wide::$simd::ONE, wide::$simd::splat(2.0));
                let a = x.abs();
                let sinh = (a / two).sinh();
                let near = (two * sinh * sinh).ln_1p();
                let far = (a - wide::$simd::splat(core::$t::consts::LN_2)) + (-two * a).exp().ln_1p();
                a.simd_lt(one).select(near, far)
            }
            #[inline]
            fn arc_tangent(x: wide::$simd) -> wide::$simd {
                x.atan()
            }
        }
    };
}

lane!(f64, 2, f64x2);
lane!(f64, 4, f64x4);
lane!(f64, 8, f64x8);
lane!(f32, 4, f32x4);
lane!(f32, 8, f32x8);

impl<S: Lane<W>, const W: usize> Lanes<S, W> {
    /// One number a lane.
    #[inline]
    pub fn from_array(values: [S; W]) -> Self {
        Self { register: S::pack(values) }
    }

    /// The same number in every lane.
    #[inline]
    pub fn splat(value: S) -> Self {
        Self::from_array([value; W])
    }

    /// The number in each lane.
    #[inline]
    pub fn to_array(self) -> [S; W] {
        S::unpack(self.register)
    }

    #[inline]
    fn map(self, f: impl Fn(S::Register) -> S::Register) -> Self {
        Self { register: f(self.register) }
    }

    #[inline]
    fn zip(self, rhs: Self, f: impl Fn(S::Register, S::Register) -> S::Register) -> Self {
        Self { register: f(self.register, rhs.register) }
    }
}

/// Equal in every lane.
impl<S: Lane<W>, const W: usize> PartialEq for Lanes<S, W> {
    fn eq(&self, other: &Self) -> bool {
        self.to_array() == other.to_array()
    }
}

impl<S: Lane<W>, const W: usize> Add for Lanes<S, W> {
    type Output = Self;
    #[inline]
    fn add(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a + b)
    }
}

impl<S: Lane<W>, const W: usize> Sub for Lanes<S, W> {
    type Output = Self;
    #[inline]
    fn sub(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a - b)
    }
}

impl<S: Lane<W>, const W: usize> Mul for Lanes<S, W> {
    type Output = Self;
    #[inline]
    fn mul(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a * b)
    }
}

impl<S: Lane<W>, const W: usize> Div for Lanes<S, W> {
    type Output = Self;
    #[inline]
    fn div(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a / b)
    }
}

impl<S: Lane<W>, const W: usize> Neg for Lanes<S, W> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

assign_ops!([S: Lane<W>, const W: usize] Lanes<S, W>);
leaf!([S: Lane<W>, const W: usize] Lanes<S, W>);

/// Lanes extend their scalar: a robot with `f64` constants runs on them as it is.
impl<S: Lane<W>, const W: usize> Over<S> for Lanes<S, W> {
    #[inline]
    fn constant(c: S) -> Self {
        Self::splat(c)
    }
    #[inline]
    fn scale(self, c: S) -> Self {
        self * Self::splat(c)
    }
}

impl<S: Lane<W>, const W: usize> Scalar for Lanes<S, W> {
    const ZERO: Self = Self { register: S::ZEROS };
    const ONE: Self = Self { register: S::ONES };

    #[inline]
    fn from_f64(x: f64) -> Self {
        Self::splat(S::from_f64(x))
    }
    #[inline]
    fn from_ratio(numerator: i32, denominator: i32) -> Self {
        Self::splat(S::from_ratio(numerator, denominator))
    }
    #[inline]
    fn sqrt(self) -> Self {
        self.map(S::root)
    }
    #[inline]
    fn exp(self) -> Self {
        self.map(S::exponential)
    }
    #[inline]
    fn ln(self) -> Self {
        self.map(S::logarithm)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = S::sine_cosine(self.register);
        (Self { register: sin }, Self { register: cos })
    }
    #[inline]
    fn tanh(self) -> Self {
        self.map(S::hyperbolic_tangent)
    }
    #[inline]
    fn ln_cosh(self) -> Self {
        self.map(S::log_cosh)
    }
    #[inline]
    fn atan(self) -> Self {
        self.map(S::arc_tangent)
    }
}

impl<S: Lane<W>, const W: usize> Piecewise for Lanes<S, W> {
    #[inline]
    fn select(self, then: Self, otherwise: Self) -> Self {
        self.zip(Self::ZERO, |x, zero| S::blend(x, zero, then.register, otherwise.register))
    }
    #[inline]
    fn lowest(self) -> f64 {
        self.to_array().into_iter().map(Piecewise::lowest).fold(f64::INFINITY, f64::min)
    }
    #[inline]
    fn highest(self) -> f64 {
        self.to_array().into_iter().map(Piecewise::highest).fold(f64::NEG_INFINITY, f64::max)
    }
    #[inline]
    fn abs(self) -> Self {
        self.map(S::absolute)
    }
    #[inline]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| S::blend(b, a, a, b))
    }
    #[inline]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| S::blend(a, b, a, b))
    }
}
