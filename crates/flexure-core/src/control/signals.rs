//! What a law measures.

/// Which parts of the motion of a robot a law reads. What it does not read may be anything, not a number included: a test of every law sees to
/// it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "four signals, each read or not")]
pub struct Signals {
    /// Link positions.
    pub q_l: bool,
    /// Motor positions.
    pub q_m: bool,
    /// Link velocities.
    pub v_l: bool,
    /// Motor velocities.
    pub v_m: bool,
}

impl Signals {
    /// The whole motion: full state feedback.
    pub const ALL: Self = Self { q_l: true, q_m: true, v_l: true, v_m: true };
    /// Positions and velocities of the motors.
    pub const MOTORS: Self = Self { q_l: false, q_m: true, v_l: false, v_m: true };
    /// Positions of both sides: two encoders a joint.
    pub const POSITIONS: Self = Self { q_l: true, q_m: true, v_l: false, v_m: false };
    /// Positions of the motors alone: what every drive has.
    pub const MOTOR_POSITIONS: Self = Self { q_l: false, q_m: true, v_l: false, v_m: false };
    /// Positions of the links alone.
    pub const LINK_POSITIONS: Self = Self { q_l: true, q_m: false, v_l: false, v_m: false };
}
