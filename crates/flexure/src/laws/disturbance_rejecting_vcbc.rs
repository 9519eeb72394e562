//! v-CBC that holds against constant torques nobody knows.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::field::{Field, Joints};
use crate::laws::disturbance_rejecting::{BANDWIDTH, MEMORY};
use crate::laws::gain::{GainSet, ReadGains};
use crate::laws::registry::{Claim, LawKind};
use crate::laws::starting::Starting;
use crate::laws::vcbc::{self, VcbcGains};
use crate::laws::{AnyShaping, Drive};
use crate::robot::Robot;

/// The kind `disturbance-rejecting-vcbc`: [`control::DisturbanceRejectingVcbc`] with any registered φ.
pub struct DisturbanceRejectingVcbc;

impl LawKind for DisturbanceRejectingVcbc {
    const NAME: &'static str = "disturbance-rejecting-vcbc";
    const SUMMARY: &'static str = "vcbc with the momentum residuals of both sides inside";
    const CLAIM: Claim = Claim::Errors;
    const MEMORY: &'static [(&'static str, &'static str)] = &MEMORY;

    type Gains = RejectingVcbcGains;
    const GAINS: () = ();

    type Core<C: Scalar, const N: usize> =
        control::DisturbanceRejectingVcbc<C, AnyShaping<C, N>, AnyShaping<C, N>, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &RejectingVcbcGains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let RejectingVcbcGains { law, bandwidth } = gains;
        control::DisturbanceRejecting { law: vcbc::made(law, &vector), bandwidth: vector(bandwidth) }
    }
}

/// The gains of v-CBC with residuals.
#[derive(Clone, Debug, PartialEq)]
pub struct RejectingVcbcGains {
    /// Those of v-CBC.
    pub law: VcbcGains,
    /// ω, how fast residuals follow, > 0 [1/s].
    pub bandwidth: Vec<f64>,
}

impl GainSet for RejectingVcbcGains {
    type Shape = ();

    fn start((): &(), drives: &[Drive]) -> Self {
        let law = VcbcGains::start(&(), drives);
        Self { law, bandwidth: drives.iter().map(BANDWIDTH.start).collect() }
    }

    fn restart(&self, (): &(), drives: &[Drive]) -> Self {
        Self { law: self.law.restart(&(), drives), ..Self::start(&(), drives) }
    }

    fn named<'a>(&'a self, (): &()) -> Vec<(String, &'a [f64])> {
        let own = (BANDWIDTH.key.to_owned(), self.bandwidth.as_slice());
        std::iter::once(own).chain(self.law.named(&())).collect()
    }

    fn speed_powers(&self, (): &()) -> Vec<i32> {
        std::iter::once(BANDWIDTH.per_second()).chain(self.law.speed_powers(&())).collect()
    }

    fn slots(&mut self) -> Vec<&mut Vec<f64>> {
        std::iter::once(&mut self.bandwidth).chain(self.law.slots()).collect()
    }

    fn phi(&self) -> Option<&'static str> {
        self.law.phi()
    }
}

impl ReadGains for RejectingVcbcGains {
    /// The sides as those of v-CBC; a bandwidth that is not given is the starting one.
    fn read((): &(), field: &Field<'_>, joints: &Joints, starting: &Starting<'_>) -> Option<Self> {
        let keys: Vec<_> = vcbc::KEYS.into_iter().chain([BANDWIDTH.key]).collect();
        let bandwidth = field.table(&keys)?.optional(BANDWIDTH.key, |field| BANDWIDTH.read(field, joints))?;
        let law = VcbcGains::within(field, joints, starting)?;
        let start = || Some(starting.drives(field)?.iter().map(BANDWIDTH.start).collect());
        Some(Self { law, bandwidth: bandwidth.or_else(start)? })
    }
}
