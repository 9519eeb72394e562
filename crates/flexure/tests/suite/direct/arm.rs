//! The paper's arm and gains in any number, and regions.

use flexure::prove::engine::direct::{StateBox, VcbcLoop};
use flexure::prove::engine::direct::{Twins, vcbc};
use flexure_core::control::{CoupledTanh, Linear, LinkGains, Metric, MotorGains, Shaping, Tanh, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::Fjr;
use flexure_core::robots::PlanarTwoLink;
use flexure_core::scalar::{Interval, Over, Scalar};

/// A constant from its decimal.
pub trait Decimal: Scalar + Over<Self> {
    fn decimal(text: &str) -> Self;

    fn decimals<const N: usize>(texts: [&str; N]) -> Vector<Self, N> {
        Vector(texts.map(Self::decimal))
    }
}

impl Decimal for f64 {
    fn decimal(text: &str) -> Self {
        text.parse().expect("a decimal")
    }
}

impl Decimal for Interval {
    fn decimal(text: &str) -> Self {
        Interval::from_decimal(text).expect("a decimal")
    }
}

/// `robots/quanser-2dof.toml`.
pub fn robot<C: Decimal>() -> Fjr<C, PlanarTwoLink<C>, 2> {
    Fjr {
        links: PlanarTwoLink::new(
            C::decimals(["1.510", "0.873"]).0,
            C::decimal("0.343"),
            C::decimals(["0.159", "0.055"]).0,
            C::decimals(["0.0392", "0.00808"]).0,
        ),
        motor_inertia: C::decimals(["0.23", "0.01"]),
        stiffness: C::decimals(["9.0", "4.0"]),
        link_damping: C::decimals(["0.8", "0.55"]),
        motor_damping: C::decimals(["0.2", "90.0"]),
    }
}

/// The gains of `scenarios/two-link-*.toml`; `shaping` gets Λ.
pub fn law<C: Decimal, P>(shaping: impl Fn(Vector<C, 2>) -> P) -> Vcbc<C, P, P, 2> {
    let (link, motor) = (C::decimals(["55.0", "30.0"]), C::decimals(["70.0", "60.0"]));
    Vcbc {
        link: LinkGains {
            metric: Metric::Constant(link),
            shaping: shaping(link),
            damping: C::decimals(["15.0", "10.0"]),
        },
        motor: MotorGains { metric: motor, shaping: shaping(motor), damping: C::decimals(["10.0", "5.0"]) },
    }
}

pub type Arm<C, P> = VcbcLoop<C, PlanarTwoLink<C>, P, P, 2>;
pub type ArmFlow<PI, P> = Twins<Arm<Interval, PI>, Arm<f64, P>>;

pub fn closed_loop<C: Decimal, P>(shaping: impl Fn(Vector<C, 2>) -> P) -> Arm<C, P> {
    VcbcLoop { robot: robot(), law: law(shaping) }
}

/// |q̃_i| ≤ 3, all q_l.
pub fn region() -> StateBox<2> {
    StateBox::within(3.0)
}

pub fn flow<PI, P>(
    bounds: impl Fn(Vector<Interval, 2>) -> PI,
    point: impl Fn(Vector<f64, 2>) -> P,
    region: &StateBox<2>,
) -> ArmFlow<PI, P>
where
    PI: Shaping<Interval, 2>,
    P: Shaping<f64, 2>,
{
    vcbc(closed_loop(bounds), closed_loop(point), region)
}

pub fn tanh<C: Decimal>(gain: Vector<C, 2>) -> Tanh<C, 2> {
    Tanh { gain }
}

pub fn linear<C: Decimal>(gain: Vector<C, 2>) -> Linear<C, 2> {
    Linear { gain }
}

pub fn coupled_tanh<C: Decimal>(gain: Vector<C, 2>) -> CoupledTanh<C, 2> {
    CoupledTanh::new(C::decimals(["10.0", "8.0"]), &gain)
}

/// [−radius, radius].
pub fn around(centre: f64, radius: f64) -> Interval {
    Interval::new(centre - radius, centre + radius).expect("ordered")
}
