//! Virtual-contraction based control: a metric, a shaping function and damping on either side of the springs.

use flexure_core::control::{self, Command, Input, LinkGains, Metric, MotorGains};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::{Jet, Scalar};

use crate::files::field::{Field, Joints};
use crate::laws::gain::{GainSet, ReadGains};
use crate::laws::registry::{Claim, LawKind, constants};
use crate::laws::side::{self, SideGains};
use crate::laws::starting::Starting;
use crate::laws::{AnyShaping, Drive, Extra, Phi};
use crate::robot::Robot;

/// The kind `vcbc`: [`control::Vcbc`] with any registered φ.
pub struct Vcbc;

impl LawKind for Vcbc {
    const NAME: &'static str = "vcbc";
    const SUMMARY: &'static str = "virtual-contraction law of flexible-joint robots: (φ, Π, K_d) per side";
    const CLAIM: Claim = Claim::Tracking;

    type Gains = VcbcGains;
    const GAINS: () = ();

    type Core<C: Scalar, const N: usize> = Law<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &VcbcGains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Law<C, N> {
        made(gains, &vector)
    }
}

/// The law with these gains; `vector` makes constants of a gain.
pub(super) fn made<C: Scalar, const N: usize>(
    gains: &VcbcGains,
    vector: &impl Fn(&Vec<f64>) -> Vector<C, N>,
) -> Law<C, N> {
    let VcbcGains { phi, link, motor } = gains;
    let base = vector(&link.metric);
    let metric = match &link.metric_hardening {
        Some(hardening) => Metric::Hardening { base, hardening: vector(hardening) },
        None => Metric::Constant(base),
    };
    let shaping = |side: &SideGains| {
        let extra =
            |extra: &Extra| vector(side.extra(extra.key).expect("the reader asks for what φ has beside Λ"));
        AnyShaping::new(*phi, side.metric.len(), vector(&side.shaping), &extra)
    };
    control::Vcbc {
        link: LinkGains { metric, shaping: shaping(link), damping: vector(&link.damping) },
        motor: MotorGains {
            metric: vector(&motor.metric),
            shaping: shaping(motor),
            damping: vector(&motor.damping),
        },
    }
}

/// The v-CBC law over the registered shaping functions, with gains of type `C`.
pub type Law<C, const N: usize> = control::Vcbc<C, AnyShaping<C, N>, AnyShaping<C, N>, N>;

/// The gains of virtual-contraction based control.
#[derive(Clone, Debug, PartialEq)]
pub struct VcbcGains {
    /// Shaping function φ of both sides.
    pub phi: Phi,
    /// Link side.
    pub link: SideGains,
    /// Motor side.
    pub motor: SideGains,
}

impl VcbcGains {
    /// The same with another φ, whose gains beside Λ are those that tuning starts from.
    pub fn shaped_by(mut self, phi: Phi) -> Self {
        self.phi = phi;
        self.link.start_extra(phi);
        self.motor.start_extra(phi);
        self
    }
}

impl GainSet for VcbcGains {
    type Shape = ();

    /// With φ linear: Π_l = m ω², Π_m = K, Λ = ω, K_d = J ω with J the inertia of that side, m of the links with the other
    /// joints free.
    fn start((): &(), drives: &[Drive]) -> Self {
        let of = |start: &dyn Fn(&Drive) -> f64| drives.iter().map(start).collect::<Vec<_>>();
        let side = |inertia: fn(&Drive) -> f64, metric: &dyn Fn(&Drive) -> f64| SideGains {
            metric: of(metric),
            shaping: of(&Drive::bandwidth),
            damping: of(&|drive| inertia(drive) * drive.bandwidth()),
            extra: Vec::new(),
            metric_hardening: None,
        };
        let link = side(|drive| drive.free_inertia, &|drive| drive.free_inertia * drive.bandwidth().powi(2));
        let motor = side(|drive| drive.motor_inertia, &|drive| drive.stiffness);
        Self { phi: Phi::Linear, link, motor }
    }

    fn restart(&self, (): &(), drives: &[Drive]) -> Self {
        Self::start(&(), drives).shaped_by(self.phi)
    }

    fn named<'a>(&'a self, (): &()) -> Vec<(String, &'a [f64])> {
        let side = |name: &'static str, gains: &'a SideGains| {
            let entries = gains.entries(self.phi).into_iter();
            entries.map(move |(key, _, values)| (format!("{name}.{key}"), values.as_slice()))
        };
        side("link", &self.link).chain(side("motor", &self.motor)).collect()
    }

    fn speed_powers(&self, (): &()) -> Vec<i32> {
        let entries = [&self.link, &self.motor].map(|side| side.entries(self.phi));
        entries.iter().flatten().map(|(_, quantity, _)| quantity.per_second()).collect()
    }

    fn slots(&mut self) -> Vec<&mut Vec<f64>> {
        self.link.slots().chain(self.motor.slots()).collect()
    }

    fn phi(&self) -> Option<&'static str> {
        Some(self.phi.name())
    }
}

impl ReadGains for VcbcGains {
    fn read((): &(), field: &Field<'_>, joints: &Joints, starting: &Starting<'_>) -> Option<Self> {
        field.table(&KEYS)?;
        Self::within(field, joints, starting)
    }
}

/// The keys of `[controller]`.
pub(super) const KEYS: [&str; 4] = ["kind", "phi", "link", "motor"];

impl VcbcGains {
    /// Reads them from a `[controller]` whose keys are known to be good.
    pub(super) fn within(field: &Field<'_>, joints: &Joints, starting: &Starting<'_>) -> Option<Self> {
        let table = field.any_table()?;
        let known: Vec<_> = Phi::ALL.iter().map(|phi| (phi.name(), *phi)).collect();
        if ["link", "motor"].iter().all(|side| table.get(side).is_none()) {
            let phi = table.optional("phi", |field| field.choice(&known))?.unwrap_or(Phi::Linear);
            return Some(Self::start(&(), &starting.drives(field)?).shaped_by(phi));
        }
        let phi = table.choice("phi", &known);
        let link = table
            .required("link", "gains of the link side")
            .and_then(|field| side::read(&field, phi, joints, starting));
        let motor = table.required("motor", "gains of the motor side").and_then(|field| {
            refuse_hardening(&field)?;
            side::read(&field, phi, joints, starting)
        });
        Some(Self { phi: phi?, link: link?, motor: motor? })
    }
}

fn refuse_hardening(motor: &Field<'_>) -> Option<()> {
    let Some(field) = motor.any_table()?.get("metric_hardening") else { return Some(()) };
    field.error(
        "motor-metric",
        format!("{} is given, but Π_m must be constant", field.path),
        "the term −Π_m⁻¹KᵀM_l⁻¹σ_l of the motor's reference velocity is not integrable otherwise; \
         only the link side may have it",
    );
    None
}

/// The v-CBC law with the gains of a scenario.
pub fn law<const N: usize>(gains: &VcbcGains) -> Law<f64, N> {
    law_over(gains, |x| x)
}

/// The v-CBC law with every gain of a scenario through `number`: [`Scenario::bounds`] for the law over intervals that
/// encloses what the decimals in the file say.
///
/// [`Scenario::bounds`]: crate::scenario::Scenario::bounds
pub fn law_over<C: Scalar, const N: usize>(gains: &VcbcGains, number: impl Fn(f64) -> C) -> Law<C, N> {
    made(gains, &constants(&number))
}

/// What the v-CBC `law` commands the robot at `x` to do, following `q_ld`, the reference in rad to order 4. Compiled once
/// per robot: it is much code, wanted in many places.
#[inline(never)]
pub fn command<L: Links<f64, N>, const N: usize>(
    law: &Law<f64, N>,
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
) -> Command<f64, N> {
    law.command(robot, x, q_ld, &Input::ZERO)
}
