//! Elementary functions whose result is the float nearest to the exact value.
//!
//! The C files in `c/` are those of the [CORE-MATH project](https://core-math.gitlabpages.inria.fr) (commit 85430b3e of
//! <https://gitlab.inria.fr/core-math/core-math>, folder `src/binary64`), unchanged, under the licence beside them. The
//! crate `core-math` binds all of its functions and compiles 85 files; enclosures need these eight.
#![no_std]

macro_rules! functions {
    ($($(#[$doc:meta])* $name:ident = $c:ident;)*) => {
        // SAFETY: pure functions of one number, defined for every bit pattern; `build.rs` compiles them into this crate.
        unsafe extern "C" {
            $(safe fn $c(x: f64) -> f64;)*
        }
        $(
            $(#[$doc])*
            #[inline]
            pub fn $name(x: f64) -> f64 {
                $c(x)
            }
        )*
    };
}

functions! {
    /// `eˣ`.
    exp = cr_exp;
    /// `ln x`; −∞ at zero, NaN below.
    log = cr_log;
    /// `ln (1 + x)`; −∞ at −1, NaN below.
    log1p = cr_log1p;
    /// `sin x`, x in rad.
    sin = cr_sin;
    /// `cos x`, x in rad.
    cos = cr_cos;
    /// `tanh x`.
    tanh = cr_tanh;
    /// `sinh x`.
    sinh = cr_sinh;
    /// `atan x` in rad, within ±π/2.
    atan = cr_atan;
}
